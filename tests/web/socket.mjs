/* A bus on a WebSocket, for the test of the page: sends the lines of a log to whoever connects, some
 * every 20 ms. Usage: node socket.mjs LOG; prints its port. */
import fs from 'node:fs';
import http from 'node:http';

import {acceptSockets, frameOf} from './ws_server.mjs';

const LINES = 14; // a message: 700 frames a second
const lines = fs.readFileSync(process.argv[2], 'utf8').trim().split('\n');

const server = http.createServer();
acceptSockets(server, (socket) => {
    let at = 0;
    return setInterval(() => {
        socket.write(frameOf(lines.slice(at, at + LINES).join('\n')));
        at = (at + LINES) % lines.length;
    }, 20);
});
server.listen(0, '127.0.0.1', () => console.log(server.address().port));
