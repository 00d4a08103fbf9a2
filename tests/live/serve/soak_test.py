"""Many heads, clients of all kinds, load and redeploys.  soak_test.py PROGRAM [SECONDS [HEADS
[REDEPLOYS]]]

Lines and sound are said, viewers come and go, lines are interrupted and heads change, and the
server is replaced by a new process now and then. Every accepted line ends exactly once, viewers
come back, memory stays. Times are printed, not tested."""

import http.client
import json
import os
import random
import signal
import socket
import subprocess
import sys
import threading
import time

from client import Server, Socket, ask, free_port, until

PROGRAM = sys.argv[1]
SECONDS = float(sys.argv[2]) if len(sys.argv) > 2 else 60
HEADS = int(sys.argv[3]) if len(sys.argv) > 3 else 12
REDEPLOYS = int(sys.argv[4]) if len(sys.argv) > 4 else 3


class Owner:
    """Of a head: says things, reads all events, and reconnects."""

    def __init__(self, name, port, seed):
        self.name, self.port, self.random = name, port, random.Random(seed)
        self.accepted, self.ended, self.problems = 0, 0, []
        self.over = False
        self.drained = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.over:
            try:
                self.session()
            except (OSError, http.client.HTTPException):
                time.sleep(0.1)

    def session(self):
        ask(f"http://127.0.0.1:{self.port}/heads/{self.name}", "PUT", json.dumps({"seed": 1}),
            timeout=20)
        told = Socket(self.port, f"/heads/{self.name}/say?pcm=16000", timeout=30)
        if told.status != 101:
            return time.sleep(0.1)
        lines = {}
        reader = threading.Thread(target=self.read, args=(told, lines), daemon=True)
        reader.start()
        while reader.is_alive() and not self.over:
            try:
                self.act(told)
            except OSError:
                break
            reader.join(self.random.uniform(0.2, 1.5))
        if self.over:
            told.send('{"do": "stop"}')
            end = time.monotonic() + 30
            while time.monotonic() < end and any(count == 0 for count in list(lines.values())):
                time.sleep(0.1)
            told.socket.shutdown(socket.SHUT_RDWR)
        reader.join(40)
        for line, count in lines.items():
            if count != 1:
                self.problems.append(f"{self.name}: line {line} ended {count} times")

    def act(self, told):
        what = self.random.random()
        if what < 0.45:
            told.send(json.dumps({"do": "say",
                "text": "One, two, three, four, five, and so on." * self.random.randint(1, 3)}))
        elif what < 0.7:
            for _ in range(5):
                told.send(os.urandom(3200))
        elif what < 0.8:
            told.send('{"done": true}')
        elif what < 0.95:
            told.send('{"do": "stop"}')
        else:
            told.send(json.dumps({"do": "mood",
                "mood": self.random.choice(["joy", "anger:0.3", "neutral"])}))

    def read(self, told, lines):
        while True:
            try:
                message = told.next()
            except OSError:
                break
            if message is None:
                break
            event = json.loads(message)
            if event["event"] == "queued":
                lines[event["line"]] = 0
                self.accepted += 1
            elif event["event"] in ("done", "cancelled") and event.get("line") in lines:
                lines[event["line"]] += 1
                self.ended += 1


class Viewer:
    """Of a head: reads its planes, and comes back."""

    def __init__(self, name, port):
        self.name, self.port, self.planes, self.away = name, port, 0, []
        self.over = False
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        lost = None
        while not self.over:
            try:
                viewer = Socket(self.port, f"/heads/{self.name}/face", timeout=10)
                if viewer.status != 101:
                    time.sleep(0.2)
                    continue
                while not self.over and (message := viewer.next()) is not None:
                    if message[:1] != b"A" and not message.startswith(b"{"):
                        self.planes += 1
                        if lost is not None:
                            self.away.append(time.monotonic() - lost)
                            lost = None
                lost = lost or time.monotonic()
            except OSError:
                lost = lost or time.monotonic()
                time.sleep(0.2)


def memory(process):
    with open(f"/proc/{process}/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def late_planes(server):
    """Planes of a process, and how many of them came more than 0.1 s late."""
    text = until(lambda: server.ask("/metrics", timeout=60)[1])  # a busy machine may drop it
    values = dict(line.rsplit(" ", 1) for line in text.splitlines() if not line.startswith("#"))
    planes = float(values["animeme_late_seconds_count"])
    return planes, planes - float(values['animeme_late_seconds_bucket{le="0.1"}'])


def main():
    port = free_port()
    arguments = ("--max-heads", str(HEADS + 5), "--drain", "5")
    server = Server(PROGRAM, *arguments, port=port)
    # Load from outside, at the priority of others.
    load = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    owners = [Owner(f"head{i}", port, i) for i in range(HEADS)]
    viewers = [Viewer(f"head{i}", port) for i in range(0, HEADS, 3)]
    health, sizes, codes, begun = [], [], [], time.monotonic()
    processes, late = [], []  # memory of each process after 10 s and at its end; late_planes()
    since = begun
    next_deploy = SECONDS / (REDEPLOYS + 1)
    deployed = 0
    try:
        while time.monotonic() - begun < SECONDS:
            asked = time.monotonic()
            try:
                status, _ = ask(f"http://127.0.0.1:{port}/health", timeout=10)
                health.append(time.monotonic() - asked)
                assert status == 200, status
            except OSError:
                pass  # between two processes
            time.sleep(0.1)
            sizes.append(memory(server.process.pid))
            if len(processes) <= deployed and time.monotonic() - since > 10:
                processes.append([sizes[-1]])
            back = all(len(viewer.away) >= deployed for viewer in viewers)
            if deployed < REDEPLOYS and back and time.monotonic() - begun > next_deploy * (deployed
                + 1):
                late.append(late_planes(server))
                if len(processes) <= deployed:
                    processes.append([])
                processes[-1].append(memory(server.process.pid))
                codes.append(server.end(signal.SIGTERM)[0])
                server = Server(PROGRAM, *arguments, port=port)
                since = time.monotonic()
                deployed += 1
        end = time.monotonic() + 90
        while time.monotonic() < end and any(len(viewer.away) < deployed for viewer in viewers):
            time.sleep(0.2)
        late.append(late_planes(server))
        if len(processes) <= deployed:
            processes.append([])
        processes[-1].append(memory(server.process.pid))
    finally:
        for process in load:
            process.kill()
            process.wait()
        for client in owners + viewers:
            client.over = True
        for owner in owners:
            owner.thread.join(60)
        codes.append(server.end(signal.SIGTERM)[0])
    health.sort()
    away = sorted(time for viewer in viewers for time in viewer.away)
    problems = [problem for owner in owners for problem in owner.problems]
    accepted = sum(owner.accepted for owner in owners)
    print(f"{HEADS} heads, {accepted} lines accepted, {sum(owner.ended for owner in owners)} ended, "
          f"{sum(viewer.planes for viewer in viewers)} planes seen")
    print(f"health: median {1e3 * health[len(health) // 2]:.1f} ms, 99 % {1e3 * health[int(len(health) * 0.99)]:.1f} ms, "
          f"worst {1e3 * health[-1]:.1f} ms of {len(health)}")
    print(f"viewers were back after {[round(time, 2) for time in away[-5:]]} s at worst, {len(away)} times")
    print(f"memory: {sizes[0]:.0f} MB at first, {max(sizes):.0f} MB at most; codes {codes}")
    print("memory of each process after 10 s and at its end: " +
          "; ".join(", ".join(f"{size:.1f} MB" for size in one) for one in processes))
    print("planes above 0.1 s late: " + "; ".join(f"{count:.0f} of {planes:.0f}"
                                                 for planes, count in late))
    assert set(codes) == {0}, codes
    assert not problems, problems[:5]
    assert accepted > HEADS, accepted
    assert all(len(viewer.away) >= deployed for viewer in viewers), [len(viewer.away) for viewer
        in viewers]
    assert all(viewer.planes > 0 for viewer in viewers)


main()
