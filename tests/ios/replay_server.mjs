/* A station for the tests of repeater and debrief: serves a site, the image, recordings, and each
 * recording once more as that of a display which is writing it: its lines go out when the unit's
 * clock has come to them. Usage: node replay_server.mjs SITE IMAGE FOLDER SPEED; prints its address.
 *
 *     GET /pause/NAME, /resume/NAME, /hold/NAME?ms=N    the display's lines stop, go on, come later */
import fs from 'node:fs';
import path from 'node:path';

import {serve} from '../../bsp/web/serve.mjs';
import {acceptSockets, frameOf} from '../web/ws_server.mjs';

const TICK_MS = 20;
const [site, image, folder, speed] = [...process.argv.slice(2, 5), Number(process.argv[5])];
const displays = new Map(); // by name: {lines, isPaused, holdMs}

const usOf = (line) => {
    const m = /^\((\d+)\.(\d{6})\) unit /.exec(line);
    return m ? Number(m[1]) * 1e6 + Number(m[2]) : NaN;
};

for (const name of fs.readdirSync(folder).filter((file) => file.endsWith('.log'))) {
    const lines = fs.readFileSync(path.join(folder, name), 'latin1').split('\n').slice(0, -1);
    displays.set(name.replace('.log', ''), {name, lines, isPaused: false, holdMs: 0});
}

/* Send what the unit has done by now. */
function stream(display, socket) {
    const begunMs = performance.now(), zeroUs = usOf(display.lines[0]);
    let at = 0, pausedMs = 0;
    return setInterval(() => {
        if (display.isPaused) {
            pausedMs += TICK_MS;
            return;
        }
        const nowUs = zeroUs + (performance.now() - begunMs - pausedMs - display.holdMs) * 1000 * speed;
        let end = at;
        while (end < display.lines.length && !(usOf(display.lines[end]) > nowUs)) {
            end++;
        }
        if (end > at) {
            socket.write(frameOf(display.lines.slice(at, end).join('\n') + '\n'));
        }
        at = end;
    }, TICK_MS);
}

const json = (response, value) => response.writeHead(200, {'Content-Type': 'application/json'}).end(JSON.stringify(value));

fs.copyFileSync(image, path.join(site, 'image'));
fs.cpSync(folder, path.join(site, 'recordings'), {recursive: true});
const server = await serve(site, 0), files = server.listeners('request')[0];
server.removeAllListeners('request');
server.on('request', (request, response) => {
    const {pathname, searchParams} = new URL(request.url, 'http://x'), [, first, second] = pathname.split('/');
    const display = displays.get(second ?? '');
    if (first === 'station.json') {
        return json(response, {bus: 'log', may_send: false, version: '0',
            displays: [...[...displays.keys()].map((name) => ({name, node: 20, recording: `${name}.log`})),
                {name: 'bus', node: 21, recording: null}]});
    }
    if (first === 'recordings.json') {
        return json(response, [...displays.values()].map(({name, lines}) => ({name, start_utc: null,
            bytes: fs.statSync(path.join(folder, name)).size, seconds: (usOf(lines.at(-1)) - usOf(lines[0])) / 1e6})));
    }
    if (display && ['pause', 'resume', 'hold'].includes(first)) {
        display.isPaused = first === 'pause';
        display.holdMs = Number(searchParams.get('ms') ?? 0);
        return json(response, true);
    }
    return files(request, response);
});
acceptSockets(server, (socket, {url}) => {
    const display = displays.get(decodeURIComponent(url.split('/')[2] ?? ''));
    return display ? stream(display, socket) : 0;
});
console.log(`http://127.0.0.1:${server.address().port}/`);
