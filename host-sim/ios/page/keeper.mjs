/* What this page tells the displays, again and again, as docs/bus.md wants it: once a second.
 *
 * Several pages are one sender to the displays: one node, and message codes that go on from what came
 * back. The page whose frames were the last on the bus keeps the thing; when another page's frames of
 * the same thing come back, this page stops. What a page kept that has gone away is kept by another
 * one after two to three seconds, before the displays drop it. */
import {ALL, linesOf} from './frames.mjs';
import {subjectOf} from './world.mjs';

const REPEAT_MS = 1000, ECHO_MS = 5000, CLASH_MS = 300, SAME_SET_MS = 20, TAKE_OVER_US = 1.8e6, TAKE_OVER_MORE_US = 1e6,
    REMOVED_MS = 3000;

/* A thing that is kept. Malfunctions have a sender in common, but are kept one by one. */
export function keyOf(fact) {
    return fact.what === 'malfunction' ? `malfunction ${fact.kind}` : subjectOf(fact);
}

/* What counts its message codes together: [first identifier, last, name]. */
const GROUPS = [[1530, 1549, 'control'], [1800, 1803, 'rain'], [1804, 1806, 'jammer'], [1810, 1816, 'target'],
    [1819, 1819, 'target']];
const groupOf = (id) => GROUPS.find(([first, last]) => id >= first && id <= last)?.[2] ?? String(id);

/* Whether a fact that clears things clears the thing of a key. */
function clears(fact, key) {
    const [name, word] = key.split(' '), number = Number(word);
    const {what, bits, kind} = fact;
    const isCleared = {'target-clear': () => name === 'target',
        'target-remove': () => name === 'target' && number === fact.number,
        'malfunction-clear': () => name === 'malfunction' && (kind === ALL || kind === number),
        'weather-clear': () => (name === 'rain' && bits >> number & 1)
            || (name === 'jammer' && bits >> (4 + number) & 1)
            || ((name === 'sea' || name === 'wind') && bits === ALL)};
    return Boolean(isCleared[what]?.());
}

export class Keeper {
    /* `send(lines)` puts text on the bus, `nowMs()` is a clock that never goes back. */
    constructor({send, nowMs, node, random = Math.random}) {
        Object.assign(this, {send, nowMs, node, random, kept: new Map(), sent: new Map(), codes: new Map(),
            removed: new Map()});
    }

    /* ---- telling ---- */

    /* One set, or frames that stand alone, under one code for each of their groups. */
    tell(frames) {
        const groups = new Map();
        frames.forEach((f) => groups.set(groupOf(f.id), [...groups.get(groupOf(f.id)) ?? [], f]));
        const lines = [...groups].flatMap(([group, members]) => {
            const code = ((this.codes.get(group) ?? Math.floor(256 * this.random())) + 1) & 255;
            this.codes.set(group, code);
            members.forEach(({id, type, service, bytes}) =>
                this.sent.set(`${id}#${[this.node, type, service, code, ...bytes].join(',')}`, this.nowMs()));
            return linesOf(members, this.node, code);
        });
        this.send(lines.join('\n'));
    }

    /* From now on tell this, once a second. `frames()` gives what to tell at the moment. */
    keep(key, frames, more = {}) {
        this.removed.delete(key);
        this.kept.set(key, {...more, frames, wishedMs: this.nowMs(), sentMs: this.nowMs(), retriedMs: -Infinity,
            tries: 1});
        this.tell(frames());
    }

    /* Tell a kept thing at once. */
    refresh(key) {
        const item = this.kept.get(key);
        if (item) {
            item.sentMs = this.nowMs();
            this.tell(item.frames());
        }
    }

    /* Tell no more of these, and say so. */
    remove(keys, frames) {
        keys.forEach((key) => {
            this.kept.delete(key);
            this.removed.set(key, {frames, ms: this.nowMs(), tries: 1});
        });
        this.tell(frames);
    }

    /* ---- hearing ---- */

    isOwn(fact) {
        return fact.keys.every((key) => this.sent.has(key));
    }

    /* A fact that came back. `isHeard`: the displays listen to its node. Returns the key of what this page had to give
     * up, or null. */
    hear(fact, isHeard) {
        const isOwn = this.isOwn(fact), key = keyOf(fact);
        if (fact.node === this.node && !isOwn && fact.keys.length > 0) {
            this.codes.set(groupOf(Number(fact.keys[0].split('#')[0])), fact.code);
        }
        if (isOwn) {
            Object.assign(this.kept.get(key) ?? {}, {hasCome: true});
            return isHeard ? null : this.giveUp(key);
        }
        if (fact.node !== this.node) {
            return null;
        }
        return key === null ? this.hearRemoval(fact) : this.hearOther(key);
    }

    /* Keep nothing that never came back. Returns the keys. */
    dropUnheard() {
        const keys = [...this.kept].filter(([, item]) => !item.hasCome).map(([key]) => key);
        keys.forEach((key) => this.kept.delete(key));
        return keys;
    }

    giveUp(key) {
        return this.kept.delete(key) ? key : null;
    }

    /* Another page told something of what this page keeps, or has just removed. */
    hearOther(key) {
        const item = this.kept.get(key), removal = this.removed.get(key), now = this.nowMs();
        if (removal && now - removal.ms < CLASH_MS && removal.tries-- > 0) {
            this.tell(removal.frames);
            return null;
        }
        if (item && now - item.wishedMs < CLASH_MS && item.tries > 0) {
            item.tries--;
            item.retriedMs = now;
            this.refresh(key);
            return null;
        }
        if (item && now - item.retriedMs < SAME_SET_MS) {
            return null; // the other frames of what was answered just now
        }
        return item ? this.giveUp(key) : null;
    }

    /* Another page removed things. */
    hearRemoval(fact) {
        [...this.kept.keys()].filter((key) => clears(fact, key)).forEach((key) => this.kept.delete(key));
        return null;
    }

    /* ---- time goes on ---- */

    /* Repeat what is due. */
    tick() {
        const now = this.nowMs();
        this.kept.forEach((item, key) => now - item.sentMs >= REPEAT_MS && this.refresh(key));
        this.sent.forEach((ms, key) => now - ms > ECHO_MS && this.sent.delete(key));
    }

    /* Which of these things, {key, timeUs, node}, has nobody told for so long that this page has to. None that this
     * page has just removed: until the removal has come back, it still seems to be there. */
    orphans(things, nowUs) {
        const isRemoved = (key) => this.nowMs() - (this.removed.get(key)?.ms ?? -Infinity) < REMOVED_MS;
        return things.filter(({key, timeUs, node}) => {
            if (node !== this.node || this.kept.has(key) || isRemoved(key)) {
                return false;
            }
            this.patience ??= this.random(); // pages differ, so that one is the first
            return nowUs - timeUs > TAKE_OVER_US + TAKE_OVER_MORE_US * this.patience;
        });
    }

    get keys() {
        return [...this.kept.keys()];
    }
}
