/* What happened in a flight, for a time line: acts of the operator and of the instructor, and what
 * the display did about them. */
import {FOVS, MODES} from './unit.mjs';

const MOST = 5000;

/* Of lm/controls.h, by the number in a recording. */
const CONTROLS = {8: 'freeze', 13: 'designate', 14: 'drop'};
const PATCH = MODES.indexOf('SAR');
const LINE = / (can[01]|unit) ([0-9A-F]+)#([0-9A-F]*)/;
const CONTROL = '1F4C4D02';
const MALFUNCTION = 1825, CLEAR = 1826; // docs/bus.md
const isMalfunction = (id) => id === MALFUNCTION || id === CLEAR;
const isCommand = (id) => id >= 1530 && id <= 1549;

export class Marks {
    /* Listens to what a replay reads. Look after each of its steps. */
    constructor(replay) {
        this.count = 0;
        this.waiting = [];
        this.values = new Map(); // of frames that repeat: identifier and service code to data
        this.blobLeft = 0;       // bytes of a control that have yet to come
        this.happened = [];      // in the step under way
        this.before = null;
        replay.hear = (bytes) => this.hear(bytes);
    }

    hear(bytes) {
        const m = LINE.exec(String.fromCharCode(...bytes));
        if (!m) {
            return;
        }
        const [, iface, id, data] = m;
        if (iface === 'unit') {
            this.control(id, data);
        } else {
            this.frame(parseInt(id, 16), data);
        }
    }

    control(id, data) {
        if (id !== CONTROL) {
            this.blobLeft = 0;
        } else if (this.blobLeft > 0) {
            this.blobLeft -= data.length / 2;
        } else {
            this.blobLeft = parseInt(data.slice(0, 2), 16) + 1 - data.length / 2;
            const kind = CONTROLS[parseInt(data.slice(2, 4), 16)];
            this.happened.push(...kind ? [{kind, text: kind}] : []);
        }
    }

    /* One that says what it said before is none. */
    frame(id, data) {
        const kind = isMalfunction(id) ? 'malfunction' : isCommand(id) ? 'command' : null;
        const key = `${id} ${data.slice(4, 6)}`, value = data.slice(8);
        if (!kind || this.values.get(key) === value) {
            return;
        }
        this.values.set(key, value);
        const code = parseInt(data.slice(4, 6), 16);
        const text = id === MALFUNCTION ? `malfunction ${code}` : id === CLEAR ? 'malfunction cleared' : `command, frame ${id}`;
        this.happened.push({kind, text});
    }

    /* What the display shows now, beside what it showed before. */
    look(replay) {
        const now = {mode: replay.value('mode'), fov: replay.value('fov'), flags: replay.value('flags')};
        const {before} = this;
        if (before && (now.mode !== before.mode || now.fov !== before.fov)) {
            const isPatch = now.mode === PATCH;
            this.happened.push(isPatch ? {kind: 'patch', text: 'patch'}
                : {kind: 'mode', text: `${MODES[now.mode]} ${FOVS[now.fov]}`});
        }
        if (before && now.flags & ~before.flags) {
            this.happened.push({kind: 'warning', text: `warning ${replay.warnings().join(', ')}`});
        }
        this.before = now;
        for (const mark of this.happened.splice(0).slice(0, MOST - this.count)) {
            this.waiting.push({...mark, us: replay.nowUs});
            this.count++;
        }
    }

    /* Those since the last call. */
    take() {
        return this.waiting.splice(0);
    }
}
