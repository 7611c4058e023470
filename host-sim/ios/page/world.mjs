/* What the bus says, as the displays understand it: drawn from frames alone, whoever sent them. */
import {ALL, FLAG_WORDS, KINDS, MALFUNCTIONS, SWITCHES} from './frames.mjs';
import {ahead, between, clockWords, placeWords} from './geo.mjs';

export const STALE_US = 3e6, DEAD_US = 10e6; // of what the exercise tells
export const OWN_STALE_US = 1e6, OWN_DEAD_US = 2e6;
const TRACK_MOST = 3000, TRACK_STEP_M = 50, EVENTS_MOST = 10000, NOTICE_US = 10e6;
const JUMP_M = 20000; // the track is broken there

/* What a fact is about: what another node may not tell while the first one does. */
export function subjectOf(fact) {
    const {what} = fact;
    return what === 'target' || what === 'rain' || what === 'jammer' ? `${what} ${fact.number}`
        : what === 'sea' || what === 'wind' ? what
        : what.startsWith('exercise') ? 'clock' : what === 'malfunction' ? 'malfunction' : null;
}

export class World {
    constructor() {
        Object.assign(this, {nowUs: 0, own: {}, track: [], targets: new Map(), rain: new Map(), jammer: new Map(),
            sea: null,
            wind: null, clock: null, malfunctions: new Map(), displays: new Map(), events: [], holders: new Map(),
                noticed: new Map()});
    }

    /* The bus's clock was set back: what was told before says nothing about now. */
    restart(nowUs) {
        const {events, noticed} = this;
        Object.assign(this, new World(), {events, nowUs});
        noticed.clear();
        this.event('the time on the bus was set back: all begins anew', 'this page');
    }

    /* ---- times ---- */

    /* Milliseconds of the exercise, or null while nobody has told. */
    exerciseMs(atUs = this.nowUs) {
        const c = this.clock;
        return c === null || c.timeMs === null ? null : c.timeMs + c.rate * Math.max(atUs - c.timeUs, 0) / 1000;
    }

    isStale(thing) {
        return this.nowUs - thing.timeUs > STALE_US;
    }

    /* Seconds that the exercise went on since a thing was told. */
    secondsSince(thing) {
        const nowMs = this.exerciseMs();
        return Math.max(nowMs === null || thing.exerciseMs === null ? (this.nowUs - thing.timeUs) / 1e6
            : (nowMs - thing.exerciseMs) / 1000, 0);
    }

    /* Where a target has got to by its dead reckoning. */
    reckoned(target) {
        return target.speedMs > 0 ? ahead(target, target.courseDeg, target.speedMs * this.secondsSince(target))
            : target;
    }

    /* ---- own aircraft ---- */

    takeOwn({field, value, preference, timeUs}) {
        const held = this.own[field];
        if (held && held.preference < preference && timeUs - held.timeUs < OWN_STALE_US) {
            return;
        }
        this.own[field] = {value, preference, timeUs};
        if (field === 'longitude') {
            this.addToTrack();
        }
    }

    /* {latitude, longitude, ageUs, ...}: null before there is a position. */
    ownAircraft() {
        const {latitude, longitude} = this.own;
        if (!latitude || !longitude) {
            return null;
        }
        const fresh = (name) => this.own[name] && this.nowUs - this.own[name].timeUs < OWN_DEAD_US
            ? this.own[name].value : null;
        const headingDeg = fresh('headingDeg') ?? fresh('trackDeg');
        return {latitude: latitude.value, longitude: longitude.value, headingDeg, heightM: fresh('heightM'),
            speedMs: fresh('speedMs'),
            ageUs: this.nowUs - Math.min(latitude.timeUs, longitude.timeUs)};
    }

    addToTrack() {
        const own = this.ownAircraft(), last = this.track.at(-1);
        const wayM = own && last ? between(last, own).distanceM : Infinity;
        if (own && own.ageUs < OWN_STALE_US && wayM > TRACK_STEP_M) {
            this.track.push({latitude: own.latitude, longitude: own.longitude, isBreak: wayM > JUMP_M});
            this.track.splice(0, this.track.length - TRACK_MOST);
        }
    }

    /* ---- facts ---- */

    /* Take a fact. `by` names who told it; null: it is of the past, and no event. Returns false where the displays do
     * not hear it, as another node tells that thing. */
    take(fact, by) {
        if (fact.what === 'own') {
            this.takeOwn(fact);
            return true;
        }
        const subject = subjectOf(fact);
        if (subject !== null && !this.holds(subject, fact)) {
            return false;
        }
        const told = {...fact, exerciseMs: this.exerciseMs(fact.timeUs), by};
        const [name] = fact.what.split('-');
        const takers = {target: 'takeTarget', rain: 'takeCircle', jammer: 'takeCircle', weather: 'clearWeather',
            sea: 'takeSea', wind: 'takeSea',
            exercise: 'takeClock', malfunction: 'takeMalfunction', display: 'takeDisplay', control: 'takeControl'};
        this[takers[name]](told, by);
        return true;
    }

    holds(subject, {node, timeUs}) {
        const held = this.holders.get(subject);
        if (held && held.node !== node && timeUs - held.timeUs < STALE_US) {
            this.notice(`${subject}: node ${node} is not heard, as node ${held.node} tells it`);
            return false;
        }
        this.holders.set(subject, {node, timeUs});
        return true;
    }

    takeTarget(t, by) {
        if (t.what === 'target-clear') {
            this.event(this.targets.size > 0 ? 'all live targets removed' : null, by);
            this.targets.clear();
        } else if (t.what === 'target-remove') {
            this.event(this.targets.delete(t.number) ? `target ${t.number} removed` : null, by);
            this.holders.delete(`target ${t.number}`);
        } else {
            this.event(this.targetWords(t, this.targets.get(t.number)), by);
            this.targets.set(t.number, t);
        }
    }

    /* What is new of a target; null where it goes on as reckoned. */
    targetWords(t, before) {
        const name = `target ${t.number}, ${KINDS[t.kind]}`;
        const motion = t.speedMs > 0
            ? `${t.speedMs.toFixed(0)} m/s on ${((t.courseDeg + 360) % 360).toFixed(0)} degrees` : 'stands';
        if (!before) {
            return `${name}, placed at ${placeWords(t)}, ${motion}`;
        }
        const clockMs = (thing) => thing.exerciseMs ?? thing.timeUs / 1000;
        const seconds = Math.max(clockMs(t) - clockMs(before), 0) / 1000;
        const wasAt = ahead(before, before.courseDeg, before.speedMs * seconds);
        const hasMoved = between(wasAt, t).distanceM > 50 + 0.5 * Math.max(before.speedMs, t.speedMs);
        const hasTurned = Math.hypot(t.eastMs - before.eastMs, t.northMs - before.northMs) > 0.2 + 0.02 * t.speedMs;
        const isOther = ['kind', 'heightM', 'rcsDbsm', 'signature'].some((key) => t[key] !== before[key]);
        return hasMoved ? `${name}, moved to ${placeWords(t)}, ${motion}` : hasTurned ? `${name}, ${motion}` : isOther
            ? `${name}, changed` : null;
    }

    takeCircle(circle, by) {
        const held = this[circle.what], before = held.get(circle.number), isRain = circle.what === 'rain';
        const at = placeWords(circle);
        const words = isRain
            ? `${circle.rateMmH.toFixed(0)} mm/h within ${(circle.radiusM / 1000).toFixed(1)} km of ${at}`
            : `${circle.ratioDb.toFixed(0)} dB at ${at}`;
        const same = before && ['latitude', 'longitude', 'radiusM', 'rateMmH',
            'ratioDb'].every((key) => before[key] === circle[key]);
        this.event(same ? null : `${circle.what} ${circle.number}: ${words}`, by);
        held.set(circle.number, circle);
    }

    clearWeather({bits}, by) {
        for (let n = 0; n < 4; n++) {
            this.event(bits >> n & 1 && this.rain.delete(n) ? `rain ${n} removed` : null, by);
            this.event(bits >> (4 + n) & 1 && this.jammer.delete(n) ? `jammer ${n} removed` : null, by);
        }
        if (bits === ALL) {
            this.event(this.sea || this.wind ? 'sea as in the image' : null, by);
            this.sea = this.wind = null;
        }
    }

    takeSea(told, by) {
        const before = this[told.what];
        const words = told.what === 'sea' ? `sea state ${told.value}`
            : `wind over the sea from ${told.value.toFixed(0)} degrees`;
        this.event(before?.value === told.value ? null : words, by);
        this[told.what] = told;
    }

    takeClock(told, by) {
        const before = this.clock ?? {timeMs: null, rate: 1, seed: null, timeUs: told.timeUs},
            wasMs = this.exerciseMs(told.timeUs);
        this.clock = {...before, node: told.node, by, timeUs: told.timeUs, timeMs: wasMs};
        if (told.what === 'exercise-rate') {
            this.clock.rate = told.rate;
            this.event(told.rate === before.rate ? null : told.rate === 0 ? 'exercise frozen'
                : `exercise runs, rate ${told.rate}`, by);
        } else if (told.what === 'exercise-seed') {
            this.clock.seed = told.seed;
            this.event(told.seed === before.seed ? null : `seed ${told.seed}`, by);
        } else {
            this.clock.timeMs = told.timeMs;
            const hasJumped = wasMs === null || Math.abs(wasMs - told.timeMs) > 250;
            this.event(hasJumped ? `exercise clock set to ${clockWords(told.timeMs)}` : null, by);
        }
    }

    takeMalfunction(told, by) {
        if (told.what === 'malfunction-clear') {
            const ended = told.kind === ALL ? [...this.malfunctions.keys()] : this.malfunctions.has(told.kind)
                ? [told.kind] : [];
            ended.forEach((kind) => this.malfunctions.delete(kind));
            this.event(ended.length ? `mended: ${ended.map((kind) => MALFUNCTIONS[kind].name).join(', ')}` : null, by);
            return;
        }
        const of = MALFUNCTIONS[told.kind], before = this.malfunctions.get(told.kind);
        this.event(before?.amount === told.amount ? null
            : `broken: ${of.name}${of.unit ? `, ${told.amount.toFixed(0)} ${of.unit}` : ''}`, by);
        this.malfunctions.set(told.kind, told);
    }

    takeDisplay(told, by) {
        const {node, what} = told, display = this.displays.get(node) ?? {node, flags: 0};
        this.displays.set(node, display);
        display.timeUs = told.timeUs;
        if (what === 'display-state') {
            FLAG_WORDS.forEach((word, n) => {
                const is = told.flags >>> n & 1, was = display.flags >>> n & 1;
                this.event(is === was ? null : `display of node ${node}: ${word} ${is ? 'on' : 'off'}`, by);
            });
            display.flags = told.flags;
        } else if (what === 'display-cursor' || what === 'display-place') {
            display[what.slice(8)] = {...display[what.slice(8)], ...told};
        } else {
            display[what.slice(8)] = told;
        }
    }

    takeControl({item, values, service, node}, by) {
        const names = {1532: () => SWITCHES[values[0]] ?? values[0],
            1531: () => `key ${values[0]} ${service === 1 ? 'down' : 'up'}`,
            1536: () => 'mode and field', 1537: () => `range ${values[0]} NM`, 1538: () => `sector width ${values[0]}`,
            1539: () => `gain ${values[0]} dB`, 1541: () => 'cursor placed',
                1543: () => service === 1 ? 'steerpoint of the bus' : 'steerpoint',
            1546: () => `patch of ${values[0] / 1000} m`};
        const words = names[item]?.();
        const isNews = words && !(item === 1531 && service !== 1);
        this.event(isNews ? `${by === null || by.startsWith('node') ? `display of node ${node}` : 'control'}: ${words}`
            : null, by);
    }

    /* ---- time goes on ---- */

    /* What nobody repeated has ended: the displays have removed it, too. */
    tick(nowUs) {
        this.nowUs = nowUs;
        const isDead = (thing) => nowUs - thing.timeUs > DEAD_US;
        const drop = (held, words) => held.forEach((thing, key) => {
            if (isDead(thing)) {
                held.delete(key);
                this.event(`${words(key)} ended: not told for 10 s`, 'nobody');
            }
        });
        drop(this.targets, (n) => `target ${n}`);
        drop(this.rain, (n) => `rain ${n}`);
        drop(this.jammer, (n) => `jammer ${n}`);
        drop(this.malfunctions, (kind) => MALFUNCTIONS[kind].name);
        for (const name of ['sea', 'wind']) {
            if (this[name] && isDead(this[name])) {
                this[name] = null;
                this.event(`${name} ended: not told for 10 s`, 'nobody');
            }
        }
    }

    /* ---- events ---- */

    event(text, by) {
        if (text !== null && by !== null) {
            this.events.push({text, by, exerciseMs: this.exerciseMs(), busUs: this.nowUs});
            this.events.splice(0, this.events.length - EVENTS_MOST);
        }
    }

    /* An event that would come again and again. */
    notice(text) {
        if (this.nowUs - (this.noticed.get(text) ?? -Infinity) > NOTICE_US) {
            this.noticed.set(text, this.nowUs);
            this.event(text, 'this page');
        }
    }
}
