/* A bus for the test of the instructor's page, as landmass-ios has one: what pages send and a log of
 * navigation go to every page and to a file, as lines of `candump -L`. A page that comes hears the last
 * frame of each identifier and number first. SIGUSR1 silences the log, or lets it go on.
 *
 * Usage: node loop.mjs SITE LOG OUT [PORT]; prints where it listens. */
import crypto from 'node:crypto';
import fs from 'node:fs';

import {serve} from '../../bsp/web/serve.mjs';

const GUID = '258EAFA5-E914-47DA-95CA-C5AB0DC85B11'; // RFC 6455, 1.3
const [site, log, out, port] = process.argv.slice(2);
const pages = new Set(), past = new Map(), file = fs.openSync(out, 'a');
const stamp = () => `(${(Date.now() / 1000).toFixed(6)})`;
let isSilent = false;

/* A frame of RFC 6455, 5.2: text, not masked, its length in as few bytes as can be. */
function textFrame(text) {
    const bytes = Buffer.from(text), size = bytes.length, more = size < 126 ? 0 : size < 65536 ? 2 : 8;
    const head = Buffer.alloc(2 + more);
    head[0] = 0x81;
    head[1] = more === 0 ? size : more === 2 ? 126 : 127;
    if (more > 0) {
        head.writeUIntBE(size, more === 2 ? 2 : 4, more === 2 ? 2 : 6);
    }
    return Buffer.concat([head, bytes]);
}

/* Frames, as ID#DATA, go out in one piece. */
function tell(frames) {
    const now = stamp();
    fs.writeSync(file, frames.map((frame) => `${now} loop ${frame}\n`).join(''));
    frames.forEach((frame) => {
        const [id, data] = frame.split('#'), number = parseInt(id, 16);
        if ((number >= 1530 && number <= 1549) || (number >= 1800 && number <= 1829)) {
            past.set(id + data.slice(4, 6), `${now} past ${frame}`);
        }
    });
    pages.forEach((socket) => socket.write(textFrame(frames.map((frame) => `${now} loop ${frame}`).join('\n'))));
}

/* The texts of a client's frames, which are masked; the rest of the bytes. */
function takeFrames(bytes, each) {
    for (;;) {
        const isLong = bytes.length > 1 && (bytes[1] & 127) === 126, at = isLong ? 4 : 2;
        const size = bytes.length < at ? Infinity : isLong ? bytes.readUInt16BE(2) : bytes[1] & 127;
        if (bytes.length < at + 4 + size) {
            return bytes;
        }
        const mask = bytes.subarray(at, at + 4), body = Buffer.from(bytes.subarray(at + 4, at + 4 + size)).map((b, i) =>
            b ^ mask[i & 3]);
        each(bytes[0] & 15, body.toString());
        bytes = bytes.subarray(at + 4 + size);
    }
}

function join(request, socket) {
    const accept = crypto.createHash('sha1').update(request.headers['sec-websocket-key'] + GUID).digest('base64');
    socket.write('HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
        + `Sec-WebSocket-Protocol: landmass-bus\r\nSec-WebSocket-Accept: ${accept}\r\n\r\n`);
    socket.write(textFrame([...past.values(), `${stamp()} past 7FF#`].join('\n')));
    pages.add(socket);
    let rest = Buffer.alloc(0);
    socket.on('data', (bytes) => {
        rest = takeFrames(Buffer.concat([rest, bytes]), (kind, text) => {
            if (kind === 1) {
                tell(text.split('\n').map((line) => line.split(' ')[2]));
            } else if (kind === 8) {
                socket.end();
            }
        });
    }).on('error', () => {}).on('close', () => pages.delete(socket));
}

const lines = fs.readFileSync(log, 'utf8').trim().split('\n').map((line) => line.split(' '));
const begin = Date.now(), first = parseFloat(lines[0][0].slice(1));
let next = 0;
setInterval(() => {
    const due = [];
    for (const seconds = (Date.now() - begin) / 1000; next < lines.length
        && parseFloat(lines[next][0].slice(1)) - first <= seconds; next++) {
        due.push(lines[next][2]);
    }
    if (due.length > 0 && !isSilent) {
        tell(due);
    }
}, 20);
process.on('SIGUSR1', () => { isSilent = !isSilent; });
const server = await serve(site, Number(port ?? 0));
server.on('upgrade', join);
console.log(`http://127.0.0.1:${server.address().port}/`);
