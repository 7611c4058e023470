/* The worker of a player (player.mjs): flies a recording, for reads of files and servers may wait
 * here, and the page stays quick.
 *
 * Two replays share the work. One is shown. The other, the scout, flies ahead while there is time
 * left, keeps moments to go back to, and notes what happened. */
import {FeedLines, joined, LogLines, Moments, Replay, spanOf, waitingFileSource, waitingHttpSource} from './recording.mjs';
import {Marks} from './marks.mjs';

const SLICE_MS = 12, PICTURE_MS = 15, TELL_MS = 200, BACK_MS = 250;
const MOMENTS_BYTES = 512 << 20;

const say = (what, rest = {}, transfer = []) => postMessage({say: what, ...rest}, transfer);
const sourceOf = ({file, url}) => file ? waitingFileSource(file) : waitingHttpSource(url);

const desk = {
    replay: null, scout: null, moments: null, marks: null, feed: null,
    speed: 0,         // times real time; 0: paused; below: backwards, by moments
    base: null,       // {us, ms}: time of flight and of the clock since when it plays
    goal: null,       // {isReached, begunMs}: what a jump steps towards
    paintedMs: 0, toldMs: 0, backMs: 0,
    isEvery: false,   // each picture of one that grows is sent, also while catching up
    lastPicture: -1,  // number of the picture that the page has
};

/* ---- pictures and words ---- */

function sendPicture(more = {}) {
    const {replay} = desk;
    const pixels = replay.paint().slice().buffer;
    replay.shown = desk.lastPicture = replay.value('pictures');
    desk.paintedMs = performance.now();
    say('picture', {pixels, widthPx: replay.widthPx, heightPx: replay.heightPx, us: replay.nowUs,
        picture: replay.shown, steps: replay.value('steps'), ...more}, [pixels]);
}

function tell(isAlways) {
    const now = performance.now(), {replay, scout, feed} = desk;
    if (!replay || (!isAlways && now - desk.toldMs < TELL_MS)) {
        return;
    }
    desk.toldMs = now;
    const words = replay.widthPx ? {words: replay.describe(), problem: replay.problem(), remark: replay.remark()} : {};
    const seen = scout ? {scoutUs: scout.nowUs, isScouted: scout.isOver, marks: desk.marks.take(),
        momentsBytes: desk.moments.bytes, moments: desk.moments.all.length, apartUs: desk.moments.apartUs} : {};
    const live = feed ? {silentMs: now - feed.cameMs, behindUs: replay.widthPx ? Math.max(feed.lastUs - feed.zeroUs - replay.nowUs, 0) : 0,
        lateUs: lateness(now)} : {};
    say('state', {us: replay.nowUs, isOver: replay.isOver, speed: desk.speed, ...words, ...seen, ...live});
}

/* ---- a recording that is whole ---- */

async function open({module, image, log, isAny}) {
    stop();
    const flash = sourceOf(image), lines = joined([log].flat().map(sourceOf));
    const replay = await Replay.load(module, flash), scout = await Replay.load(module, flash);
    scout.blocks = replay.blocks; // one cache for both
    replay.open(new LogLines(lines), isAny);
    const marks = new Marks(scout);
    scout.open(new LogLines(lines), isAny);
    const [firstUs, lastUs] = spanOf(lines);
    Object.assign(desk, {replay, scout, marks, moments: new Moments(MOMENTS_BYTES)});
    say('opened', {widthPx: replay.widthPx, heightPx: replay.heightPx, firstUs, lengthUs: lastUs - firstUs});
    sendPicture();
}

function stop() {
    desk.feed?.socket.close();
    Object.assign(desk, {replay: null, scout: null, feed: null, speed: 0, base: null, goal: null});
}

/* Fly on until a time, or until the slice is over. */
function playUntil(us, endMs) {
    const {replay} = desk;
    while (replay.nowUs < us && performance.now() < endMs) {
        if (!replay.step()) {
            desk.speed = 0;
            tell(true);
            return;
        }
    }
    if (replay.nowUs < us) {
        desk.base = {us: replay.nowUs, ms: performance.now()}; // as fast as this machine can
    }
}

function play(endMs) {
    const now = performance.now();
    desk.base ??= {us: desk.replay.nowUs, ms: now};
    if (desk.speed > 0) {
        playUntil(desk.base.us + (now - desk.base.ms) * 1000 * desk.speed, endMs);
    } else if (now - desk.backMs >= BACK_MS) {
        desk.backMs = now;
        const {us} = desk.replay, before = desk.moments.last((m) => m.us < desk.replay.nowUs);
        desk.replay.restore(before);
        sendPicture();
        desk.speed = before === desk.moments.all[0] ? 0 : desk.speed;
    }
}

/* Towards the goal of a jump, for a slice. */
function goOn(endMs) {
    const {replay, goal} = desk;
    while (performance.now() < endMs) {
        if (goal.isReached(replay) || !replay.step()) {
            desk.goal = desk.base = null;
            sendPicture({jumpMs: performance.now() - goal.begunMs});
            tell(true);
            return;
        }
    }
}

/* A jump: from the last moment before the goal, unless what is shown is nearer. */
function jump(isBefore, isReached) {
    const begunMs = performance.now(), {replay, moments} = desk, moment = moments.last(isBefore);
    if (moment && (!isBefore(standOf(replay)) || moment.us > replay.nowUs)) {
        replay.restore(moment);
    }
    desk.goal = {isReached, begunMs};
}

const standOf = (replay) => ({us: replay.nowUs, pictures: replay.value('pictures')});

const jumpToTime = (us) => jump((m) => m.us <= us, (replay) => replay.nowUs >= us);

const jumpToPicture = (number) => jump((m) => m.pictures < number, (replay) => replay.value('pictures') >= number);

/* Ahead of what is shown, as long as the slice lasts. */
function scoutOn(endMs) {
    const {scout, moments, marks} = desk;
    while (!scout.isOver && performance.now() < endMs) {
        moments.keep(scout);
        for (let n = 0; n < 32 && scout.step(); n++) {
            marks.look(scout);
        }
    }
}

/* ---- one that grows ---- */

async function follow({module, image, url, protocol}) {
    stop();
    const replay = await Replay.load(module, sourceOf(image)), feed = new FeedLines();
    Object.assign(feed, {cameMs: performance.now(), leastUs: Infinity, socket: new WebSocket(url, protocol)});
    Object.assign(desk, {replay, feed});
    feed.socket.onopen = () => say('link', {isUp: true});
    feed.socket.onclose = () => desk.feed === feed && say('link', {isUp: false});
    feed.socket.onmessage = ({data}) => {
        if (typeof data === 'string') {
            feed.put(data);
            feed.cameMs = performance.now();
            wake();
        }
    };
}

/* How much later than the promptest line the last one came: what is held up on the way. */
function lateness(now) {
    const {feed} = desk, us = feed.cameMs * 1000 - feed.lastUs;
    feed.leastUs = feed.lastUs > 0 ? Math.min(feed.leastUs, us) : feed.leastUs;
    return Number.isFinite(feed.leastUs) ? Math.max(us - feed.leastUs, 0) : 0;
}

function followOn(endMs) {
    const {replay, feed} = desk;
    if (!replay.widthPx) {
        if (feed.steps === 0) {
            return false;
        }
        replay.open(feed);
        say('opened', {widthPx: replay.widthPx, heightPx: replay.heightPx});
    }
    while (replay.isReady()) {
        if (performance.now() >= endMs) {
            return true;
        }
        replay.step();
        if (replay.hasNewPicture() && (desk.isEvery || performance.now() - desk.paintedMs > PICTURE_MS)) {
            sendPicture();
        }
    }
    if (replay.value('pictures') !== desk.lastPicture) {
        sendPicture();
    }
    return false;
}

/* ---- turns ---- */

const wakeUp = new MessageChannel();
let isAwake = false, timer = 0;

function wake() {
    if (!isAwake) {
        isAwake = true;
        wakeUp.port2.postMessage(0);
    }
}

/* True if there is more to do at once. */
function turnOnce() {
    const endMs = performance.now() + SLICE_MS;
    if (!desk.replay) {
        return false;
    }
    if (desk.feed) {
        return followOn(endMs);
    }
    if (desk.goal) {
        goOn(endMs);
        return true;
    }
    if (desk.speed !== 0) {
        play(endMs);
        if (desk.replay.value('pictures') !== desk.lastPicture && performance.now() - desk.paintedMs >= PICTURE_MS) {
            sendPicture();
        }
    }
    scoutOn(endMs);
    return !desk.scout.isOver;
}

function turn() {
    isAwake = false;
    clearTimeout(timer);
    let isBusy = false;
    try {
        isBusy = turnOnce();
        tell(false);
    } catch (error) {
        stop();
        say('error', {text: error.message});
    }
    if (isBusy) {
        wake();
    } else if (desk.replay) {
        timer = setTimeout(wake, desk.speed !== 0 ? 4 : 50);
    }
}

wakeUp.port1.onmessage = turn;

const asks = {
    open, follow,
    close: stop,
    play: ({speed}) => Object.assign(desk, {speed, base: null, goal: null}),
    time: ({us}) => jumpToTime(Math.max(us, 0)),
    picture: ({by}) => {
        desk.speed = 0;
        jumpToPicture(Math.max((desk.lastPicture === -1 ? 0 : desk.lastPicture) + by, 1));
    },
    every: ({isEvery}) => { desk.isEvery = isEvery; },
};

onmessage = async ({data}) => {
    try {
        await asks[data.ask](data);
        tell(true);
    } catch (error) {
        stop();
        say('error', {text: error.message});
    }
    wake();
};
