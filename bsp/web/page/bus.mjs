/* The avionics bus: frames of a log, of a WebSocket, or made for a flight by hand.
 *
 * A frame is {id, isExtended, data, timeUs}: data bytes in an array, time on the unit's clock. */

const LINE = /^\((\d+)\.(\d{6})\) \S+ ([0-9A-Fa-f]{3}|[0-9A-Fa-f]{8})#((?:[0-9A-Fa-f]{2}){0,8})\s*$/;

/* A line of `candump -L`, or null where it is no data frame. Time is in microseconds of the log. */
export function parseLine(line) {
    const m = LINE.exec(line);
    if (!m) {
        return null;
    }
    const data = Array.from({length: m[4].length / 2}, (_, i) => parseInt(m[4].slice(2 * i, 2 * i + 2), 16));
    return {id: parseInt(m[3], 16), isExtended: m[3].length > 3, data, timeUs: Number(m[1]) * 1e6 + Number(m[2])};
}

/* A recorded bus, which begins anew behind its end. */
export class LogBus {
    constructor(text) {
        this.refused = 0;
        this.frames = [];
        for (const line of text.split('\n').filter((l) => l.trim() !== '')) {
            const frame = parseLine(line);
            if (frame) {
                this.frames.push(frame);
            } else {
                this.refused++;
            }
        }
        if (this.frames.length === 0) {
            throw new Error('the log has no frame in the form of candump -L');
        }
        this.startUs = this.frames[0].timeUs;
        this.next = 0;
        this.lapUs = 0; // time of the unit at which this lap began
    }

    get seconds() {
        return (this.frames.at(-1).timeUs - this.startUs) / 1e6;
    }

    /* Hand over what is due. */
    deliver(unit, nowUs) {
        for (;;) {
            if (this.next === this.frames.length) {
                this.next = 0;
                this.lapUs = nowUs + 12500;
            }
            const f = this.frames[this.next], timeUs = f.timeUs - this.startUs + this.lapUs;
            if (timeUs > nowUs) {
                return;
            }
            unit.frame({...f, timeUs});
            this.next++;
        }
    }
}

/* A live bus: each message of the socket is one or more lines of `candump -L`. A frame counts from
 * its arrival, as on a bus. What comes faster than a step takes it is dropped by the unit, which
 * counts it; lines that are no frame are counted here. */
export class SocketBus {
    constructor(url, onState, protocol = []) {
        this.refused = 0;
        this.waiting = [];
        this.socket = new WebSocket(url, protocol);
        this.socket.onopen = () => onState('connected');
        this.socket.onclose = () => onState('closed');
        this.socket.onmessage = ({data}) => this.take(data);
    }

    take(text) {
        const lines = typeof text === 'string' ? text.split('\n').filter((l) => l.trim() !== '') : [];
        for (const line of lines.slice(0, 512)) {
            const frame = parseLine(line);
            if (frame && this.waiting.length < 512) {
                this.waiting.push(frame);
            } else {
                this.refused++;
            }
        }
        this.refused += Math.max(lines.length - 512, 0);
    }

    deliver(unit, nowUs) {
        this.waiting.splice(0).forEach((f) => unit.frame({...f, timeUs: nowUs}));
    }

    close() {
        this.socket.close();
    }
}
