/* The WebSocket to the server: lines of the bus both ways, and a connection that is tried again. */
import {parseLine} from './web/bus.mjs';

const RETRY_MS = [500, 1000, 2000, 5000];
const LINES_MOST = 20000; // of one message

export class Link {
    /* `on`: {frames(list), refused(text), state(isOpen)}. A frame of the snapshot has isPast. */
    constructor(url, on) {
        Object.assign(this, {url, on, tries: 0, unread: 0});
        this.connect();
    }

    connect() {
        this.socket = new WebSocket(this.url, 'landmass-bus');
        this.socket.onopen = () => {
            this.tries = 0;
            this.on.state(true);
        };
        this.socket.onmessage = ({data}) => this.take(data);
        this.socket.onclose = () => {
            this.on.state(false);
            setTimeout(() => this.connect(), RETRY_MS[Math.min(this.tries++, RETRY_MS.length - 1)]);
        };
    }

    take(text) {
        const frames = [];
        for (const line of typeof text === 'string' ? text.split('\n', LINES_MOST) : []) {
            const frame = parseLine(line);
            if (frame) {
                frames.push({...frame, isPast: line.includes(') past ')});
            } else if (line.startsWith('!')) {
                this.on.refused(line.slice(1).trim());
            } else if (line.trim() !== '') {
                this.unread++;
            }
        }
        this.on.frames(frames);
    }

    /* False where there is no connection. */
    send(lines) {
        const isOpen = this.socket.readyState === WebSocket.OPEN;
        if (isOpen) {
            this.socket.send(lines);
        }
        return isOpen;
    }
}
