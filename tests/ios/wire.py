"""A browser's side of HTTP/1.1 and of WebSocket (RFC 6455), by hand: it can also misbehave."""
import base64
import hashlib
import os
import socket
import struct

GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # RFC 6455, 1.3
TEXT, BINARY, CLOSE = 1, 2, 8


def connect(port, seconds=5, tls=None):
    """A connection to this machine; `tls` is (a context of ssl, the server's name)."""
    plain = socket.create_connection(("127.0.0.1", port), timeout=seconds)
    return tls[0].wrap_socket(plain, server_hostname=tls[1]) if tls else plain


def ask(port, path, headers=None, method="GET", host=None, body=b"", tls=None):
    """(status, headers, body) of an answer; status 0: the server closed the connection."""
    with connect(port, tls=tls) as s:
        lines = [f"{method} {path} HTTP/1.1", f"Host: {host or f'127.0.0.1:{port}'}", "Connection: close"]
        lines += [f"{name}: {value}" for name, value in (headers or {}).items()]
        s.sendall("\r\n".join(lines).encode("latin1") + b"\r\n\r\n" + body)
        got = b""
        while True:
            try:
                more = s.recv(65536)
            except (ConnectionError, TimeoutError):
                more = b""
            got += more
            head, separator, rest = got.partition(b"\r\n\r\n")
            fields = dict(line.lower().split(": ", 1) for line in head.decode("latin1").split("\r\n")[1:] if ": " in line)
            if not more or (separator and method != "HEAD" and len(rest) >= int(fields.get("content-length", 1 << 60))):
                status = int(head.split(b" ")[1]) if head.startswith(b"HTTP/") else 0
                return status, fields, rest


class Page:
    """A socket of the server; `status` is 101 where it is open."""

    def __init__(self, port, path="/bus", protocol="landmass-bus", headers=None, host=None, tls=None):
        key = base64.b64encode(os.urandom(16))
        self.socket = connect(port, tls=tls)
        lines = [f"GET {path} HTTP/1.1", f"Host: {host or f'127.0.0.1:{port}'}", "Upgrade: websocket", "Connection: Upgrade",
                 f"Sec-WebSocket-Key: {key.decode()}", "Sec-WebSocket-Version: 13"]
        lines += [f"Sec-WebSocket-Protocol: {protocol}"] if protocol else []
        lines += [f"{name}: {value}" for name, value in (headers or {}).items()]
        self.socket.sendall("\r\n".join(lines).encode() + b"\r\n\r\n")
        self.rest = b""
        head = b""
        try:
            while b"\r\n\r\n" not in head:
                more = self.socket.recv(4096)
                if not more:
                    break
                head += more
        except (ConnectionError, TimeoutError):
            pass
        head, _, self.rest = head.partition(b"\r\n\r\n")
        self.status = int(head.split(b" ")[1]) if head.startswith(b"HTTP/") else 0
        accept = base64.b64encode(hashlib.sha1(key + GUID).digest())
        assert self.status != 101 or accept in head, "the server does not know the key"

    def send(self, text, kind=TEXT):
        """One masked message."""
        data = text if isinstance(text, bytes) else text.encode()
        size = len(data)
        head = bytes([0x80 | kind]) + (bytes([0x80 | size]) if size < 126 else bytes([0x80 | 126]) + struct.pack(">H", size)
                                       if size < 65536 else bytes([0x80 | 127]) + struct.pack(">Q", size))
        mask = os.urandom(4)
        self.socket.sendall(head + mask + bytes(b ^ mask[i & 3] for i, b in enumerate(data)))

    def _take(self, count):
        while len(self.rest) < count:
            more = self.socket.recv(1 << 16)
            if not more:
                raise ConnectionError("closed")
            self.rest += more
        taken, self.rest = self.rest[:count], self.rest[count:]
        return taken

    def message(self):
        """(kind, bytes) of the next message."""
        kind, data = 0, b""
        while True:
            first, second = self._take(2)
            size = second & 127
            size = struct.unpack(">H", self._take(2))[0] if size == 126 else struct.unpack(">Q", self._take(8))[0] if size == 127 else size
            kind = first & 15 or kind
            data += self._take(size)
            if first & 0x80:
                return kind, data

    def lines(self, until, seconds=5):
        """Lines that come, up to the first that `until` is true of, or to the end of the time."""
        self.socket.settimeout(seconds)
        heard = []
        try:
            while True:
                kind, data = self.message()
                if kind == CLOSE:
                    return heard + ["closed"]
                for line in data.decode().splitlines():
                    heard.append(line)
                    if until(line):
                        return heard
        except TimeoutError:
            return heard
        except ConnectionError:
            return heard + ["closed"]

    def close(self):
        self.socket.close()
