"""Every wait of `animeme stream`, `serve` and `receive` ends on SIGTERM.  waits.py PROGRAM [NAME
...]

Some cases run at a time. Each brings the program to one wait (the table in README.md), makes sure
that it is still there, and ends it as a service manager does. It has to go within LIMIT seconds,
with an exit code of its own."""

import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

from ports import free_port

PROGRAM = sys.argv[1]
LIMIT = 40  # seconds; beside other tests, under a sanitizer
SETTLE = 1.5
AT_ONCE = 4  # cases: most of their time they wait


class Case:
    """A program that waits, and what it is connected to."""

    def __init__(self, folder):
        self.folder = folder
        self.held = []  # open as long as the case
        self.environment = dict(os.environ)

    def path(self, name):
        return os.path.join(self.folder, name)

    def rtp(self):
        return ["--to", f"rtp://127.0.0.1:{free_port()}", "--sdp", self.path("a.sdp")]

    def start(self, arguments, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=None):
        self.log = open(self.path("log"), "wb")
        self.process = subprocess.Popen([PROGRAM, *arguments], stdin=stdin, stdout=stdout,
            stderr=stderr or self.log,
                                        env=self.environment)
        return self.process

    def full_pipe(self):
        """A descriptor of a pipe that nobody reads and that takes nothing more."""
        read, write = os.pipe()
        self.held.append(read)
        os.set_blocking(write, False)
        try:
            while True:
                os.write(write, b"x" * 4096)
        except BlockingIOError:
            pass
        os.set_blocking(write, True)
        return write

    def silent_server(self):
        """A port where connections are taken, and nothing is ever answered."""
        server = socket.create_server(("127.0.0.1", 0))
        self.held.append(server)
        return server.getsockname()[1]


def open_pipe(case, first=b""):
    read, write = os.pipe()
    case.held.append(write)
    os.write(write, first)
    return read


def say(case, first=b"", *more):
    return case.start(["stream", "--say", "-", *case.rtp(), *more], stdin=open_pipe(case, first))


def stuck(case):
    """A --tts program that reads and never ends."""
    script = case.path("voice.sh")
    with open(script, "w") as out:
        out.write("#!/bin/sh\nexec sleep 600\n")
    os.chmod(script, 0o700)
    return script + " {wav} --text={text}"


def stdin_without_a_line(case):
    say(case)


def stdin_with_half_a_line(case):
    say(case, b"Hello, I am")


def audio_without_a_header(case):
    case.start(["stream", "--say-audio", "-", *case.rtp()], stdin=open_pipe(case))


def audio_that_stops(case):
    case.start(["stream", "--say-audio", "-", "--pcm", "16000", *case.rtp()],
        stdin=open_pipe(case, b"\0" * 16000))


def json_without_a_line(case):
    case.start(["stream", "--say-json", "-", *case.rtp()], stdin=open_pipe(case))


def json_that_stops(case):
    case.start(["stream", "--say-json", "-", *case.rtp()], stdin=open_pipe(case, b'{"text": "Hel'))


def script_that_stops(case):
    case.start(["stream", "--script", "-", *case.rtp()], stdin=open_pipe(case, b"0 0.1 SIL\n"))


def clip_that_stops(case):
    fifo = case.path("clip.fap")
    os.mkfifo(fifo)
    case.held.append(os.open(fifo, os.O_RDWR))
    case.start(["stream", fifo, *case.rtp()])


def voice_that_hangs(case):
    say(case, b"Hello.\n", "--tts", stuck(case))


def voice_of_a_text_that_hangs(case):
    case.start(["stream", "--text", "Hello.", "--tts", stuck(case), *case.rtp()])


def control_socket_without_a_client(case):
    case.start(["stream", "--control", case.path("control"), *case.rtp()])


def control_client_that_does_not_read(case):
    path = case.path("control")
    case.start(["stream", "--control", path, *case.rtp()])
    end = time.monotonic() + LIMIT
    client = socket.socket(socket.AF_UNIX)
    while client.connect_ex(path) != 0 and time.monotonic() < end:
        time.sleep(0.05)
    client.setblocking(False)
    case.held.append(client)
    try:
        while True:
            client.send(b'{"do": "say", "text": "One two three."}\n' * 20)
    except OSError:
        pass


def events_into_a_full_pipe(case):
    out = case.full_pipe()
    case.start(["stream", "--say", "-", "--events", "-", *case.rtp()],
        stdin=open_pipe(case, b"Hello, hello.\n" * 50),
               stdout=out)
    os.close(out)


def statistics_into_a_full_pipe(case):
    out = case.full_pipe()
    case.start(["stream", "--say", "-", "--stats", *case.rtp()], stdin=open_pipe(case, b"Hello.\n"),
        stdout=out,
               stderr=out)
    os.close(out)


def srt_peer_that_is_not_there(case):
    case.start(["stream", "--say", "-", "--to", f"srt://127.0.0.1:{free_port()}"],
        stdin=open_pipe(case, b"Hello.\n"))


def srt_far_away(case):
    case.start(["stream", "--say", "-", "--to", "srt://192.0.2.1:5000"],
        stdin=open_pipe(case, b"Hello.\n"))


def whip_server_that_does_not_answer(case):
    url = f"whip://127.0.0.1:{case.silent_server()}/live"
    case.start(["stream", "--say", "-", "--to", url], stdin=open_pipe(case, b"Hello.\n"))


def web_viewer_that_does_not_read(case):
    port = free_port(socket.SOCK_STREAM)
    case.start(["stream", "--say", "-", "--to", f"http://127.0.0.1:{port}"],
        stdin=open_pipe(case, b"Hello.\n"))
    viewer(case, port, "/face")


def viewer(case, port, path):
    end = time.monotonic() + LIMIT
    while time.monotonic() < end:
        try:
            client = socket.create_connection(("127.0.0.1", port), 2)
            break
        except OSError:
            time.sleep(0.05)
    client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
    client.sendall(
        f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                   "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
    case.held.append(client)
    return client


def start_server(case, *more, **how):
    port = free_port(socket.SOCK_STREAM)
    case.start(["serve", "--listen", f"http://127.0.0.1:{port}", "--drain", "2", *more], **how)
    return port


def request(port, method, path, body=b""):
    end = time.monotonic() + LIMIT
    while time.monotonic() < end:
        try:
            with socket.create_connection(("127.0.0.1", port), 5) as client:
                client.sendall(f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n"
                               f"Content-Length: {len(body)}\r\nConnection: close\r\n\r\n".encode()
                               + body)
                return client.recv(65536)
        except OSError:
            time.sleep(0.05)
    raise SystemExit("the server does not answer")


def server_that_nobody_asks(case):
    request(start_server(case), "GET", "/health")


def server_that_speaks(case):
    port = start_server(case)
    request(port, "PUT", "/heads/anna")
    request(port, "POST", "/heads/anna/say", b"Hello, hello, hello.\n" * 500)
    viewer(case, port, "/heads/anna/face")


def server_with_half_a_request(case):
    port = start_server(case)
    request(port, "GET", "/health")
    client = socket.create_connection(("127.0.0.1", port), 5)
    client.sendall(
        b"POST /heads/anna/say HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 60000\r\n\r\nHello")
    case.held.append(client)


def server_without_voices(case):
    """espeak-ng finds no data: an error at the start, and no search without end."""
    empty = case.path("empty")
    os.mkdir(empty)
    case.environment["ESPEAK_DATA_PATH"] = empty
    start_server(case)


def server_with_a_full_pipe(case):
    out = case.full_pipe()
    port = start_server(case, "--stats", "--json", stdout=out, stderr=out)
    os.close(out)


def receiver_of_nobody(case):
    case.start(["receive", f"udp://127.0.0.1:{free_port()}", "-o", case.path("a.mp4"), "--wait",
        "0"])


def receiver_of_a_silent_server(case):
    case.start(["receive", f"ws://127.0.0.1:{case.silent_server()}/", "-o", case.path("a.mp4"),
        "--wait", "0"])


def receiver_of_a_missing_description(case):
    case.start(["receive", case.path("never.sdp"), "-o", case.path("a.mp4"), "--wait", "0"])


# With an error, in time.
MAY_END = (srt_peer_that_is_not_there, srt_far_away, whip_server_that_does_not_answer,
    server_without_voices)

CASES = [one for one in list(globals().values())
         if callable(one) and getattr(one, "__code__", None)
         and one.__code__.co_varnames[:1] == ("case",)
         and one.__code__.co_argcount == 1 and one.__name__ not in ("stuck",)]


def run(make):
    with tempfile.TemporaryDirectory(prefix="waits-") as folder:
        case = Case(folder)
        problem = ""
        try:
            make(case)
            process = case.process
            time.sleep(SETTLE)
            early = process.poll()
            if early is None:
                process.send_signal(signal.SIGTERM)
            elif make not in MAY_END:
                problem = f"does not wait: exit code {early}"
            begun = time.monotonic()
            try:
                code = process.wait(LIMIT)
                if early is None and code < 0 and code != -signal.SIGTERM:
                    problem = f"ended by signal {-code}"
            except subprocess.TimeoutExpired:
                problem = f"still there {LIMIT} s after SIGTERM"
                code = None
            took = time.monotonic() - begun
        finally:
            if case.process.poll() is None:
                case.process.kill()
                case.process.wait()
            for one in case.held:
                os.close(one) if isinstance(one, int) else one.close()
            case.log.close()
        with open(case.path("log"), "rb") as log:
            said = log.read().decode(errors="replace").strip().splitlines()
    state = f"ended by itself, exit code {early}" if early is not None else f"exit code {code} after {took:.2f} s"
    print(f"{make.__name__}: {problem or state}" + (f" [{said[0][:120]}]" if said
        and (problem or early) else ""),
          flush=True)
    return not problem


def main():
    wanted = sys.argv[2:]
    chosen = [make for make in CASES if not wanted or make.__name__ in wanted]
    with ThreadPoolExecutor(AT_ONCE) as pool:
        failed = [make.__name__ for make, fine in zip(chosen, pool.map(run, chosen)) if not fine]
    if failed:
        raise SystemExit("these do not end on SIGTERM: " + ", ".join(failed))


main()
