/* A server's side of WebSocket (RFC 6455) for tests: text goes out, and nothing is read. */
import crypto from 'node:crypto';

const GUID = '258EAFA5-E914-47DA-95CA-C5AB0DC85B11'; // RFC 6455, 1.3

/* An unmasked text frame (RFC 6455, 5.2). */
export function frameOf(text) {
    const bytes = Buffer.from(text), n = bytes.length, head = Buffer.alloc(n < 126 ? 2 : n < 65536 ? 4 : 10);
    head.writeUInt16BE(0x8100 | Math.min(n, n < 65536 ? 126 : 127));
    if (head.length === 4) {
        head.writeUInt16BE(n, 2);
    } else if (head.length === 10) {
        head.writeBigUInt64BE(BigInt(n), 2);
    }
    return Buffer.concat([head, bytes]);
}

/* Accept each socket that is asked of a node:http server. `begin` gets the socket and the request, and
 * returns the timer that ends with the socket; or 0. */
export function acceptSockets(server, begin) {
    server.on('upgrade', (request, socket) => {
        const {'sec-websocket-key': key, 'sec-websocket-protocol': protocol} = request.headers;
        const accept = crypto.createHash('sha1').update(key + GUID).digest('base64');
        socket.write(['HTTP/1.1 101 Switching Protocols', 'Upgrade: websocket', 'Connection: Upgrade',
            `Sec-WebSocket-Accept: ${accept}`, ...protocol ? [`Sec-WebSocket-Protocol: ${protocol}`] : [], '', ''].join('\r\n'));
        const timer = begin(socket, request);
        socket.on('error', () => {}).on('close', () => clearInterval(timer));
    });
}
