"""What the tests of `animeme serve` need and share nothing with it: Python's HTTP client, a reader
of
WebSockets written from RFC 6455, and the server as a child."""

import base64
import json
import os
import signal
import socket
import struct
import subprocess
import time
import urllib.error
import urllib.request


def ask(url, method="GET", body=None, headers=None, timeout=30):
    """Status and body."""
    data = body.encode() if isinstance(body, str) else body
    request = urllib.request.Request(url, data=data, method=method, headers=headers or {})
    try:
        with urllib.request.urlopen(request, timeout=timeout) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as refused:
        return refused.code, refused.read().decode()


def free_port():
    """A port of this machine that nobody has at the moment."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def until(condition, seconds=30):
    """What `condition` gives as soon as that is true; False: it never was."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            found = condition()
        except OSError:
            found = False
        if found:
            return found
        time.sleep(0.05)
    return False


class Socket:
    """A WebSocket: messages as bytes or text."""

    def __init__(self, port, path, host="127.0.0.1", timeout=30, headers="", connection=None):
        self.closed = None  # status of the end; 0: the connection broke
        self.rest = b""
        self.socket = connection or socket.create_connection(("127.0.0.1", port), timeout)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((
            f"GET {path} HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n{headers}\r\n").encode())
        while b"\r\n\r\n" not in self.rest:
            block = self.socket.recv(65536)
            if not block:
                break
            self.rest += block
        head, _, self.rest = self.rest.partition(b"\r\n\r\n")
        self.status = int(head.split()[1]) if head else 0

    def _read(self, size):
        while len(self.rest) < size:
            try:
                block = self.socket.recv(65536)
            except ConnectionError:
                block = b""
            if not block:
                return None
            self.rest += block
        taken, self.rest = self.rest[:size], self.rest[size:]
        return taken

    def next(self):
        """The next message; None: there is none any more."""
        whole = b""
        while self.closed is None:
            head = self._read(2)
            size = head and head[1] & 127
            if size == 126:
                more = self._read(2)
                size = more and struct.unpack(">H", more)[0]
            elif size == 127:
                more = self._read(8)
                size = more and struct.unpack(">Q", more)[0]
            body = self._read(size) if size is not None else None
            if body is None:
                self.closed = 0
                break
            kind = head[0] & 15
            if kind == 8:
                self.closed = struct.unpack(">H", body[:2])[0] if len(body) >= 2 else 1005
                break
            if kind in (9, 10):
                continue
            whole += body
            if head[0] & 128:
                return whole
        return None

    def send(self, message):
        """Text or bytes, in a frame with a mask, as clients send it."""
        text = isinstance(message, str)
        body = message.encode() if text else message
        head = bytes([0x81 if text else 0x82])
        if len(body) < 126:
            head += bytes([0x80 | len(body)])
        elif len(body) < 65536:
            head += bytes([0x80 | 126]) + struct.pack(">H", len(body))
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", len(body))
        mask = os.urandom(4)
        whole = (mask * (len(body) // 4 + 1))[:len(body)]
        masked = (int.from_bytes(body, "big") ^ int.from_bytes(whole, "big")).to_bytes(len(body),
            "big")
        self.socket.sendall(head + mask + masked)

    def unit(self):
        """The next one that is no event told in words."""
        message = self.next()
        while message and message.startswith(b"{"):
            message = self.next()
        return message

    def close(self):
        self.socket.close()


class Server:
    """`animeme serve` at a free port."""

    def __init__(self, program, *arguments, env=None, port=0, stderr=None):
        self.process = subprocess.Popen(
            [program, "serve", "--listen", f"http://127.0.0.1:{port}", "--json", "--quiet",
             *arguments], stdout=subprocess.PIPE, stderr=stderr, text=True, env={**os.environ, **(env or {})})
        line = self.process.stdout.readline()
        self.url = json.loads(line)["address"].rstrip("/") if line else ""
        self.port = int(self.url.rsplit(":", 1)[1]) if line else 0

    def ask(self, path, method="GET", body=None, **more):
        return ask(self.url + path, method, body, **more)

    def json(self, path, method="GET", body=None, **more):
        status, text = self.ask(path, method, body, **more)
        return status, json.loads(text)

    def end(self, how=signal.SIGTERM):
        """Its exit code, and what it wrote at the end."""
        if how and self.process.poll() is None:
            self.process.send_signal(how)
        out, _ = self.process.communicate(timeout=60)
        return self.process.returncode, out
