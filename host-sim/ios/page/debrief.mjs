/* Debrief: recordings of a display, flown again in the page. */
import {saveAs} from './dom.mjs';
import {Player} from './web/player.mjs';

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8, 16, 64];
const TICKS_MOST = 400, LISTED_MOST = 400;

const find = (id) => document.getElementById(id);

/* Seconds as minutes and seconds. */
export function clockOf(us) {
    const tenths = Math.round(us / 1e5), minutes = Math.floor(tenths / 600);
    return `${minutes}:${String(Math.floor(tenths / 10) % 60).padStart(2, '0')}.${tenths % 10}`;
}

/* Recordings of a list, each with its parts in their order: NAME-000.log, NAME-001.log, ... */
export function sessionsOf(all) {
    const sessions = new Map();
    for (const one of [...all].sort((a, b) => (a.name < b.name ? -1 : 1))) {
        const key = /^(.*)-\d{3}\.log$/.exec(one.name)?.[1] ?? `/${one.name}`;
        sessions.set(key, [...sessions.get(key) ?? [], one]);
    }
    return [...sessions.values()];
}

class Debrief {
    async start() {
        this.image = {url: new URL('image', document.baseURI).href};
        this.speedAt = SPEEDS.indexOf(1);
        this.marks = [];
        this.listed = new Set();
        this.connect();
        this.module = await (await fetch('web/landmass.wasm')).arrayBuffer();
        await this.list();
        const live = new URLSearchParams(location.search).get('live');
        if (live) {
            location.replace(`repeater.html?display=${encodeURIComponent(live)}`);
        }
    }

    say(text) {
        find('message').textContent = text;
    }

    /* ---- recordings ---- */

    async list() {
        const answer = await fetch('recordings.json').catch(() => null);
        const all = answer?.ok ? await answer.json() : null;
        find('no-list').textContent = all === null ? 'The station lists no recordings.' : all.length === 0 ? 'There are none yet.' : '';
        find('recordings').replaceChildren(...sessionsOf(all ?? []).map((parts) => {
            const button = document.createElement('button'), item = document.createElement('li');
            const [{name, start_utc: start}] = parts, sum = (key) => parts.reduce((total, part) => total + part[key], 0);
            button.type = 'button';
            button.textContent = `${name}: ${start ?? 'time unknown'}, ${clockOf(1e6 * sum('seconds'))}, ${(sum('bytes') / 1e6).toFixed(1)} MB`;
            const log = parts.map((part) => ({url: new URL(`recordings/${encodeURIComponent(part.name)}`, document.baseURI).href}));
            button.addEventListener('click', () => this.open(log, name));
            item.append(button);
            return item;
        }));
    }

    open(log, name) {
        this.player?.close();
        this.log = log;
        this.name = name.replace(/\.log$/, '');
        this.marks = [];
        this.listed = new Set();
        this.lengthUs = 0;
        this.jumps = {count: 0, worstMs: 0};
        this.pace = null;
        find('marks').replaceChildren();
        document.querySelectorAll('.tick').forEach((tick) => tick.remove());
        this.say('');
        this.player = new Player(find('glass'), {
            onOpened: ({lengthUs}) => this.opened(lengthUs),
            onPicture: (picture) => this.pictured(picture),
            onState: (state) => this.state(state),
            onError: (text) => this.say(`${name}: ${text}`),
        });
        this.player.open(this.module, this.image, log);
    }

    opened(lengthUs) {
        this.lengthUs = lengthUs;
        find('time').max = lengthUs / 1e6;
        find('time').disabled = false;
        find('play').focus();
    }

    /* An image, or a recording, whose parts may come together. */
    takeFiles(files) {
        const image = files.find(({name}) => name.endsWith('.lmdb'));
        const [log] = sessionsOf(files.filter((file) => file !== image));
        this.image = image ? {file: image} : this.image;
        if (log) {
            this.open(log.map((file) => ({file})), log[0].name);
        } else if (image && this.log) {
            this.open(this.log, this.name);
        }
    }

    /* ---- what the player tells ---- */

    pictured({us, picture, jumpMs}) {
        this.us = us;
        this.picture = picture;
        if (jumpMs !== undefined) {
            this.jumps = {count: this.jumps.count + 1, worstMs: Math.max(this.jumps.worstMs, jumpMs), lastMs: jumpMs};
        }
        this.showTime(us);
    }

    showTime(us) {
        if (document.activeElement !== find('time') || !this.isDragging) {
            find('time').value = us / 1e6;
        }
        find('time').setAttribute('aria-valuetext', clockOf(us));
        find('clock').textContent = `${clockOf(us)} of ${clockOf(this.lengthUs)}`;
    }

    state(state) {
        if (state.speed === 0 && this.player.speed !== 0 && state.isOver) {
            this.player.speed = 0;
        }
        this.lastState = state;
        this.add(state.marks ?? []);
        find('words').textContent = [state.words, state.remark].filter(Boolean).join('; ');
        if (state.problem) {
            this.say(`${this.name}: ${state.problem}`);
        }
        find('scouted').textContent = state.isScouted ? (this.marks.length ? '' : 'Nothing is marked.')
            : `Looking ahead: ${clockOf(state.scoutUs)} of ${clockOf(this.lengthUs)}`;
        this.pressed();
        this.figures(state);
    }

    figures(state) {
        const now = performance.now();
        this.pace ??= {us: state.scoutUs, ms: now};
        if (!state.isScouted && now > this.pace.ms) {
            this.ahead = (state.scoutUs - this.pace.us) / 1000 / (now - this.pace.ms);
        }
        find('figures').textContent = `${state.moments} key pictures every ${state.apartUs / 1e6} s, `
            + `${(state.momentsBytes / 2 ** 20).toFixed(0)} MiB`
            + (this.ahead ? `; looked ahead at ${this.ahead.toFixed(0)} times real time` : '')
            + (this.jumps.count ? `; the last jump took ${this.jumps.lastMs.toFixed(0)} ms, the longest ${this.jumps.worstMs.toFixed(0)} ms` : '');
    }

    /* ---- marks ---- */

    add(marks) {
        for (const mark of marks) {
            this.marks.push(mark);
            if (this.marks.length <= TICKS_MOST) {
                const tick = document.createElement('span');
                tick.className = `tick ${mark.kind}`;
                tick.title = mark.text;
                tick.style.left = `${100 * mark.us / this.lengthUs}%`;
                find('line').append(tick);
            }
            const text = `${clockOf(mark.us)}  ${mark.text}`;
            // Two of one name would lead to one place.
            if (this.marks.length <= LISTED_MOST && !this.listed.has(text)) {
                this.listed.add(text);
                const button = document.createElement('button'), item = document.createElement('li');
                button.type = 'button';
                button.textContent = text;
                button.addEventListener('click', () => this.jump(mark.us));
                item.append(button);
                find('marks').append(item);
            }
        }
    }

    toMark(by) {
        const near = 0.05e6, {us} = this;
        const mark = by > 0 ? this.marks.find((m) => m.us > us + near) : this.marks.findLast((m) => m.us < us - near);
        if (mark) {
            this.jump(mark.us);
        }
    }

    /* ---- acts ---- */

    jump(us) {
        this.player?.toTime(Math.min(us, this.lengthUs));
    }

    play(speed) {
        this.player?.play(speed);
        this.pressed();
    }

    toggle() {
        this.play(this.player?.speed > 0 ? 0 : SPEEDS[this.speedAt]);
    }

    reverse() {
        this.play(this.player?.speed < 0 ? 0 : -1);
    }

    change(by) {
        this.speedAt = Math.min(Math.max(this.speedAt + by, 0), SPEEDS.length - 1);
        if (this.player?.speed > 0) {
            this.play(SPEEDS[this.speedAt]);
        }
        this.pressed();
    }

    pressed() {
        const speed = this.player?.speed ?? 0;
        find('play').setAttribute('aria-pressed', String(speed > 0));
        find('reverse').setAttribute('aria-pressed', String(speed < 0));
        find('play').textContent = `Play ${SPEEDS[this.speedAt]}x (Space)`;
    }

    step(by) {
        this.player?.byPictures(by);
        this.pressed();
    }

    save(blob, ending) {
        this.saved = saveAs(`${this.name ?? 'landmass'}-${clockOf(this.us ?? 0).replace(/\D/g, '-')}.${ending}`, blob);
    }

    png() {
        find('glass').toBlob((blob) => this.save(blob, 'png'), 'image/png');
    }

    /* What the canvas shows from now on, until it is pressed again. */
    video() {
        if (this.recorder) {
            this.recorder.stop();
            return;
        }
        const parts = [], type = ['video/webm;codecs=vp9', 'video/webm'].find((t) => globalThis.MediaRecorder?.isTypeSupported(t));
        if (!type) {
            this.say('This browser records no WebM.');
            return;
        }
        this.recorder = new MediaRecorder(find('glass').captureStream(30), {mimeType: type, videoBitsPerSecond: 8e6});
        this.recorder.ondataavailable = ({data}) => parts.push(data);
        this.recorder.onstop = () => {
            this.recorder = null;
            find('video').setAttribute('aria-pressed', 'false');
            this.save(new Blob(parts, {type: 'video/webm'}), 'webm');
        };
        this.recorder.start(1000);
        find('video').setAttribute('aria-pressed', 'true');
    }

    connect() {
        const acts = {play: () => this.toggle(), reverse: () => this.reverse(), slower: () => this.change(-1),
            faster: () => this.change(1), 'back-10': () => this.jump(this.us - 10e6), 'on-10': () => this.jump(this.us + 10e6),
            'picture-back': () => this.step(-1), 'picture-on': () => this.step(1), 'mark-back': () => this.toMark(-1),
            'mark-on': () => this.toMark(1), png: () => this.png(), video: () => this.video()};
        Object.entries(acts).forEach(([id, act]) => find(id).addEventListener('click', act));
        const keys = {' ': 'play', b: 'reverse', '[': 'slower', ']': 'faster', j: 'back-10', l: 'on-10', ',': 'picture-back',
            '.': 'picture-on', n: 'mark-back', m: 'mark-on', p: 'png', v: 'video'};
        window.addEventListener('keydown', (event) => {
            const id = keys[event.key.toLowerCase()], isPress = event.key === ' ' && event.target instanceof HTMLButtonElement;
            if (id && !isPress && !event.ctrlKey && !event.altKey && !event.metaKey) {
                event.preventDefault();
                acts[id]();
            }
        });
        const time = find('time');
        time.addEventListener('pointerdown', () => { this.isDragging = true; });
        time.addEventListener('pointerup', () => { this.isDragging = false; });
        time.addEventListener('input', () => this.jump(1e6 * Number(time.value)));
        ['file', 'image'].forEach((id) => find(id).addEventListener('change', () => this.takeFiles([...find(id).files])));
        document.addEventListener('dragover', (event) => event.preventDefault());
        document.addEventListener('drop', (event) => {
            event.preventDefault();
            this.takeFiles([...event.dataTransfer.files]);
        });
    }
}

const debrief = new Debrief();
globalThis.debrief = debrief; // for tests, and for whoever opens the browser's console
debrief.start().catch((error) => debrief.say(error.message));
