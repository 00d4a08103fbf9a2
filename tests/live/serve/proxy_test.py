"""Two processes behind HAProxy, one of them killed.  proxy_test.py PROGRAM HAPROXY.CFG

Skips (77) without haproxy."""

import os
import shutil
import signal
import subprocess
import sys

from client import Server, Socket, ask, free_port, until

PROGRAM, CONFIGURATION = sys.argv[1:3]


def check(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")
    print("ok:", what)


def main():
    haproxy = shutil.which("haproxy", path=os.environ.get("PATH", "") + ":/usr/sbin")
    if not haproxy:
        print("skipped: haproxy is missing (apt-get install haproxy)")
        sys.exit(77)
    servers = [Server(PROGRAM, "--host-name", "*") for _ in range(2)]
    port = free_port()
    front = f"http://127.0.0.1:{port}"
    environment = {**os.environ, "FRONT": f"127.0.0.1:{port}"}
    for name, server in zip(("FIRST", "SECOND"), servers):
        environment[name] = f"127.0.0.1:{server.port}"
    proxy = subprocess.Popen([haproxy, "-db", "-f", CONFIGURATION], env=environment,
                             stderr=subprocess.DEVNULL)
    try:
        check(until(lambda: ask(front + "/health")[0] == 200), "the proxy answers")
        names = [f"head{i}" for i in range(16)]
        for name in names:
            assert ask(f"{front}/heads/{name}", "PUT", "{}")[0] == 201, name
        where = {}
        for name in names:
            there = [ask(f"{server.url}/heads/{name}")[0] == 200 for server in servers]
            assert there.count(True) == 1, name
            where[name] = there.index(True)
        check({0, 1} == set(where.values()), "each head is in one process, and both have some")
        for name in names:
            assert ask(f"{front}/heads/{name}/say", "POST", "Hello.")[0] == 202, name
            assert ask(f"{front}/heads/{name}/info.json")[0] == 200, name
        check(True, "requests find the process of their head")

        kept, lost = (next(n for n in names if where[n] == i) for i in range(2))
        viewers = {name: Socket(port, f"/heads/{name}/face") for name in (kept, lost)}
        for viewer in viewers.values():
            assert viewer.status == 101 and viewer.next() and viewer.next()
        servers[1].process.send_signal(signal.SIGKILL)
        servers[1].process.wait()
        while viewers[lost].next() is not None:
            pass
        check(viewers[lost].closed == 0, "the killed one's viewers lose their connection")
        times = []
        for _ in range(75):
            message = viewers[kept].unit()
            assert message is not None
            times.append(int.from_bytes(message[:8], "big"))
        check(all(b - a == 1000 for a, b in zip(times, times[1:])),
              "those of the other one miss nothing for three seconds")

        # What its owner does when it is told 404: it makes the head again, by the same address.
        check(until(lambda: ask(f"{front}/heads/{lost}", "PUT", "{}")[0] in (200, 201)),
              "the head is made again, in the process that is left")
        back = Socket(port, f"/heads/{lost}/face")
        assert back.status == 101 and back.next()[:1] == b"A"
        check(back.unit()[12] & 1, "its viewer is back, and begins with an intra plane")
        assert ask(f"{front}/heads/{lost}/say", "POST", "I am back.")[0] == 202
        check(ask(f"{front}/heads/{kept}")[0] == 200, "the others are where they were")
    finally:
        proxy.kill()
        for server in servers:
            server.end()
    check(servers[0].process.returncode == 0, "the process that was left ends in good order")


main()
