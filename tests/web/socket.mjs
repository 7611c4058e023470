/* A bus on a WebSocket, for the test of the page: sends the lines of a log to whoever connects, some
 * every 20 ms. Usage: node socket.mjs LOG; prints its port. */
import crypto from 'node:crypto';
import fs from 'node:fs';
import http from 'node:http';

const GUID = '258EAFA5-E914-47DA-95CA-C5AB0DC85B11'; // RFC 6455, 1.3
const LINES = 14; // a message: 700 frames a second
const lines = fs.readFileSync(process.argv[2], 'utf8').trim().split('\n');

/* An unmasked text frame (RFC 6455, 5.2). */
function frameOf(text) {
    const bytes = Buffer.from(text), head = Buffer.alloc(4);
    head.writeUInt16BE(0x817e);
    head.writeUInt16BE(bytes.length, 2);
    return Buffer.concat([head, bytes]);
}

const server = http.createServer();
server.on('upgrade', (request, socket) => {
    const accept = crypto.createHash('sha1').update(request.headers['sec-websocket-key'] + GUID).digest('base64');
    socket.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${accept}\r\n\r\n`);
    let at = 0;
    const timer = setInterval(() => {
        socket.write(frameOf(lines.slice(at, at + LINES).join('\n')));
        at = (at + LINES) % lines.length;
    }, 20);
    socket.on('error', () => {}).on('close', () => clearInterval(timer));
});
server.listen(0, '127.0.0.1', () => console.log(server.address().port));
