/* Serve a folder to this machine's browsers: files, and ranges of bytes of them, over the loopback
 * interface alone. Usage: node serve.mjs FOLDER [PORT]. Any web server that knows ranges will do
 * instead. */
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';

const TYPES = {'.html': 'text/html; charset=utf-8', '.css': 'text/css', '.mjs': 'text/javascript',
    '.wasm': 'application/wasm'};

/* First and last byte that a request asks for; null if it asks for all; undefined if there are none. */
export function rangeOf(header, size) {
    if (header === undefined) {
        return null;
    }
    const m = /^bytes=(\d{1,15})-(\d{0,15})$/.exec(header);
    if (!m) {
        return null; // no such unit, or several ranges: a server may answer with all
    }
    const first = Number(m[1]), last = m[2] === '' ? size - 1 : Math.min(Number(m[2]), size - 1);
    return first <= last ? [first, last] : undefined;
}

export function serve(folder, port) {
    const root = path.resolve(folder);
    const server = http.createServer((request, response) => {
        const refuse = (status) => response.writeHead(status, {'Content-Type': 'text/plain'}).end(`${status}\n`);
        let name;
        try {
            name = decodeURIComponent(new URL(request.url, 'http://x').pathname);
        } catch {
            return refuse(400);
        }
        const file = path.join(root, name.endsWith('/') ? name + 'index.html' : name);
        const stat = file.startsWith(root + path.sep) ? fs.statSync(file, {throwIfNoEntry: false}) : undefined;
        if (!['GET', 'HEAD'].includes(request.method) || !stat?.isFile()) {
            return refuse(stat?.isFile() ? 405 : 404);
        }
        const range = rangeOf(request.headers.range, stat.size);
        if (range === undefined) {
            return response.writeHead(416, {'Content-Range': `bytes */${stat.size}`}).end();
        }
        const [first, last] = range ?? [0, stat.size - 1];
        const head = {'Content-Type': TYPES[path.extname(file)] ?? 'application/octet-stream', 'Accept-Ranges': 'bytes',
            'Content-Length': last - first + 1, 'Cache-Control': 'no-cache', 'X-Content-Type-Options': 'nosniff'};
        if (range) {
            head['Content-Range'] = `bytes ${first}-${last}/${stat.size}`;
        }
        response.writeHead(range ? 206 : 200, head);
        if (request.method === 'HEAD' || stat.size === 0) {
            return response.end();
        }
        return fs.createReadStream(file, {start: first, end: last}).on('error', () => response.destroy()).pipe(response);
    });
    return new Promise((ready) => server.listen(port, '127.0.0.1', () => ready(server)));
}

if (process.argv[1] && import.meta.url === `file://${path.resolve(process.argv[1])}`) {
    const [folder, port] = [process.argv[2], Number(process.argv[3] ?? 8124)];
    if (!folder || !fs.existsSync(folder) || !Number.isInteger(port)) {
        console.error('Usage: node serve.mjs FOLDER [PORT]');
        process.exit(2);
    }
    const server = await serve(folder, port);
    console.log(`http://127.0.0.1:${server.address().port}/  (Ctrl-C ends)`);
}
