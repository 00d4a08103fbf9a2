"""Hostile peers of `receive` and `serve`.  net.py PROGRAM [--seconds N] [--seed S]

RTP: the packets of a real sender, again and again, mutated, with timestamps that run ahead of time
in small steps. The receiver writes no more than time allows, stays small, and ends when it is told
to. HTTP: requests that are cut, mutated, too long or slow. The server still answers its next
client, and ends when it is told to."""

import argparse
import os
import random
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

from ports import free_port

MEMORY = 400  # MB of pages in use
PATIENCE = 60


def megabytes(process):
    with open(f"/proc/{process.pid}/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def end(process, codes, what):
    process.send_signal(signal.SIGTERM)
    code = process.wait(PATIENCE)
    if code not in codes:
        raise SystemExit(f"{what}: exit code {code}")


def packets_of(program, folder):
    """A description and the packets that come with it."""
    clip, sdp = os.path.join(folder, "a.fba"), os.path.join(folder, "a.sdp")
    with open(os.path.join(folder, "s.tsv"), "w") as out:
        out.write("0 0.5 SIL\n0.5 0.8 B\n0.8 2.8 AA\n2.8 4.0 M\n")
    subprocess.run([program, "speak", "--script", out.name, "-o", clip], check=True,
        capture_output=True)
    heard = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    port = free_port()
    heard.bind(("127.0.0.1", port))
    heard.settimeout(1)
    subprocess.run([program, "stream", clip, "--to", f"rtp://127.0.0.1:{port}", "--sdp", sdp,
        "--fast", "--intra-seconds",
                    "0.2"], check=True, capture_output=True, timeout=PATIENCE)
    packets = []
    try:
        while True:
            packets.append(heard.recv(65536))
    except TimeoutError:
        pass
    heard.close()
    with open(sdp) as file:
        return file.read(), packets, port


def attack_receiver(program, seconds, rng, mutate):
    with tempfile.TemporaryDirectory(prefix="net-") as folder:
        description, packets, port = packets_of(program, folder)
        assert packets, "nothing was sent"
        rate = next(int(line.split("/")[1]) for line in description.splitlines()
            if line.startswith("a=rtpmap:"))
        sdp = os.path.join(folder, "a.sdp")
        text = os.path.join(folder, "out.fap")
        receiver = subprocess.Popen([program, "receive", sdp, "-o", text, "--wait", "30",
            "--timeout", "0"],
                                    stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        time.sleep(1)
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        begun, number = time.monotonic(), 0
        first = struct.unpack(">HI", packets[0][2:8])
        while time.monotonic() - begun < seconds and receiver.poll() is None:
            packet = bytearray(packets[number % len(packets)])
            step = int(0.24 * rate) * number
            packet[2:8] = struct.pack(">HI", (first[0] + number) & 0xFFFF,
                (first[1] + step) & 0xFFFFFFFF)
            if mutate and rng.random() < 0.3:
                packet[rng.randrange(len(packet))] = rng.randrange(256)
            sender.sendto(packet, ("127.0.0.1", port))
            number += 1
            if number % 200 == 0:
                time.sleep(0.02)
        took = time.monotonic() - begun
        if receiver.poll() is not None:
            raise SystemExit(
                f"receive: exit code {receiver.returncode}: {receiver.stderr.read()[-300:]}")
        size = megabytes(receiver)
        end(receiver, (0, 1, 3, 130), "receive")
        frames = 0
        if os.path.exists(text):
            with open(text) as file:
                frames = max(0, (sum(1 for _ in file) - 1) // 2)
        print(f"receive: {number} packets that claim {0.24 * number:.0f} s in {took:.1f} s: {frames / 25:.1f} s of text, "
              f"{size:.0f} MB")
        if not mutate and frames / 25 > 2 * took + 15:
            raise SystemExit("more is written than time has passed")
        if not mutate and frames == 0:
            raise SystemExit("nothing arrived")
        if size > MEMORY:
            raise SystemExit("the receiver grows")


def attack_server(program, seconds, rng):
    port = free_port(socket.SOCK_STREAM)
    server = subprocess.Popen([program, "serve", "--listen", f"http://127.0.0.1:{port}",
        "--max-heads", "5", "--drain", "1"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

    def ask(data, wait=5.0):
        with socket.create_connection(("127.0.0.1", port), 5) as client:
            client.settimeout(wait)
            try:
                client.sendall(data)
                return client.recv(65536)
            except OSError:
                return b""

    health = f"GET /health HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n\r\n".encode()
    until = time.monotonic() + PATIENCE
    while True:
        try:
            if b"200" in ask(health):
                break
        except OSError:
            pass
        if time.monotonic() > until or server.poll() is not None:
            raise SystemExit("the server does not start")
        time.sleep(0.1)
    seeds = [
        f"PUT /heads/a HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 14\r\n\r\n{{\"lang\": \"en\"}}",
        f"POST /heads/a/say HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 6\r\n\r\nHello.",
        f"POST /heads/a/say HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 14\r\n\r\n{{\"do\": \"stop\"}}",
        f"GET /heads/a/faps HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n\x81\x05Hello",
        f"GET /heads HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n",
        f"POST /heads/a/say HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nTransfer-Encoding: chunked\r\n\r\nffffffff\r\n",
        f"POST /heads/a/say HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: -1\r\n\r\n",
        f"PUT /heads/{'a' * 5000} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n",
        f"PUT /heads/b HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 60000\r\n\r\n{'[' * 60000}",
    ]
    begun, number, slow = time.monotonic(), 0, []
    while time.monotonic() - begun < seconds and server.poll() is None:
        data = bytearray(rng.choice(seeds).encode("latin-1"))
        for _ in range(rng.choice((0, 1, 3, 10))):
            at = rng.randrange(len(data))
            if rng.random() < 0.3:
                data[at:at + 2] = rng.choice((b"\0", b"\r\n", b"\r\n\r\n", b"%00", b"\xff\xff",
                    b"../", b": "))
            else:
                data[at] = rng.randrange(256)
        if rng.random() < 0.1:
            data = data[:rng.randrange(len(data))]
        try:
            ask(bytes(data), 0.05)
            if len(slow) < 20 and rng.random() < 0.05:
                slow.append(socket.create_connection(("127.0.0.1", port), 5))
                slow[-1].sendall(b"POST /heads/a/say HTTP/1.1\r\nContent-Le")
        except OSError:
            pass
        number += 1
    if server.poll() is not None:
        raise SystemExit(f"serve: exit code {server.returncode}: {server.stderr.read()[-300:]}")
    for one in slow:
        one.close()
    until = time.monotonic() + PATIENCE
    while b"200" not in ask(health):
        if time.monotonic() > until:
            raise SystemExit("the server no longer answers")
        time.sleep(0.2)
    size = megabytes(server)
    end(server, (0,), "serve")
    print(f"serve: {number} requests in {time.monotonic() - begun:.1f} s, {size:.0f} MB")
    if size > MEMORY:
        raise SystemExit("the server grows")


def main():
    reading = argparse.ArgumentParser()
    reading.add_argument("program")
    reading.add_argument("--seconds", type=float, default=3)
    reading.add_argument("--seed", type=int, default=47)
    options = reading.parse_args()
    rng = random.Random(options.seed)
    attack_receiver(options.program, options.seconds, rng, mutate=False)
    attack_receiver(options.program, options.seconds, rng, mutate=True)
    attack_server(options.program, options.seconds, rng)


sys.exit(main())
