"""`animeme serve` as clients use and misuse it.  http_test.py PROGRAM"""

import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.error
import urllib.request

from client import Server, Socket, ask, until

PROGRAM = sys.argv[1]
INTRA = 1  # bit of the flags of a unit of /face (tools/live/web/README.md)


class Events:
    """What is told of lines on a socket."""

    def __init__(self, told):
        self.socket, self.all = told, []

    def wait(self, name):
        """Until an event of that name; None: to the end."""
        while (message := self.socket.next()) is not None:
            told = json.loads(message)
            if "event" not in told:
                continue
            self.all.append(told)
            if told["event"] == name:
                return told
        return None

    def count(self, name):
        return sum(event["event"] == name for event in self.all)


def ask_with_headers(url, method, body):
    request = urllib.request.Request(url, data=body.encode(), method=method)
    try:
        with urllib.request.urlopen(request, timeout=30) as answer:
            return answer.status, answer.read().decode(), answer.headers
    except urllib.error.HTTPError as refused:
        return refused.code, refused.read().decode(), refused.headers


def descendants(process):
    """Processes below a process."""
    found = []
    for entry in os.listdir("/proc"):
        try:
            with open(f"/proc/{entry}/stat") as file:
                parent = int(file.read().rsplit(")", 1)[1].split()[1])
        except (OSError, IndexError, ValueError):
            continue
        if entry.isdigit() and parent == process:
            found += [int(entry), *descendants(int(entry))]
    return found


def planes_of(viewer, count):
    """Flags and times of so many messages behind the first one."""
    planes = []
    for _ in range(count):
        message = viewer.unit()
        planes.append((message[12], int.from_bytes(message[:8], "big")))
    return planes


class Heads(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(PROGRAM, "--max-heads", "12", "--max-clients", "30")

    @classmethod
    def tearDownClass(cls):
        code, out = cls.server.end()
        assert code == 0, code
        assert json.loads(out)["count"] >= 0

    def setUp(self):
        for head in self.server.json("/heads")[1]["heads"]:
            self.server.ask("/heads/" + head["name"], "DELETE")

    def figures(self, name):
        return self.server.json("/heads/" + name)[1]["figures"]

    def test_requests_before_an_answer_stop_nobody_else(self):
        body = b'{"lang": "en", "mood": "joy:0.5"}'
        length = b"Content-Length: %d\r\n\r\n" % len(body) + body
        host = b"\r\nHost: 127.0.0.1\r\n"
        put = b"PUT /heads/anna HTTP/1.1" + host + length
        for bytes_sent in [put + put, put + put[:60], put + b"GET /health HTTP/1.1" + host + b"\r\n",
                           b"GET /healvh HTTP/1.1\r\n\r\nGET /heads 1" + host + length,
                           b"GET /heads HTTP/1.1" + host + length + b"x" * 50]:
            with socket.create_connection(("127.0.0.1", self.server.port)) as client:
                client.sendall(bytes_sent)
                self.assertEqual(self.server.ask("/health")[0], 200, bytes_sent)
                client.shutdown(socket.SHUT_WR)
                self.assertEqual(self.server.ask("/health")[0], 200, bytes_sent)

    def test_a_head_is_made_talks_and_goes(self):
        made = self.server.json("/heads/anna", "PUT", '{"lang": "en+f3", "seed": 7}')
        self.assertEqual(made, (201, {"name": "anna", "path": "/heads/anna/"}))
        status, page = self.server.ask("/heads/anna/")
        self.assertEqual(status, 200)
        self.assertIn("<title>Animeme live</title>", page)
        self.assertEqual(self.server.json("/heads/anna")[1]["settings"]["lang"], "en+f3")
        face = Socket(self.server.port, "/heads/anna/face")
        sound = Socket(self.server.port, "/heads/anna/audio")
        self.assertEqual(face.next()[:2], b"A\x01")
        self.assertEqual(sound.next()[4:8], b"ftyp")
        said = self.server.json("/heads/anna/say", "POST", "Hello.\n\nHow are you?\r\n")
        self.assertEqual(said[0], 202)
        self.assertTrue(until(lambda: self.figures("anna")["lines_spoken"] == 2))
        self.assertIn(b"moof", sound.next())
        self.assertEqual(self.figures("anna")["viewers"], 1)
        self.assertEqual(self.server.json("/heads/anna", "DELETE"), (200, {"ended": "anna"}))
        while face.next() is not None:
            pass
        self.assertEqual(face.closed, 1000)  # told that it is over
        self.assertEqual(self.server.json("/heads/anna")[0], 404)
        self.assertEqual(Socket(self.server.port, "/heads/anna/face").status, 404)

    def test_receive_hears_one_of_many(self):
        for name in ("ida", "jan"):
            self.server.ask("/heads/" + name, "PUT")
        self.server.ask("/heads/ida/say", "POST", "Only Ida speaks.")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ida.mp4")
            address = self.server.url.replace("http", "ws") + "/heads/ida/"
            done = subprocess.run([PROGRAM, "receive", address, "-o", path, "--duration", "2",
                "--json"],
                                  capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertGreater(os.path.getsize(path), 1000)
        self.assertEqual(self.figures("jan")["planes"], 0)

    def test_a_mouth_moves_for_values(self):
        self.server.ask("/heads/ben", "PUT")
        values = Socket(self.server.port, "/heads/ben/faps")
        self.assertIn("faps", json.loads(values.next()))
        first = json.loads(values.next())
        self.assertTrue(first["intra"])
        self.server.ask("/heads/ben/say", "POST", '{"do": "say", "text": "Many mouths move."}')
        last, opened = first, 0
        for _ in range(100):
            frame = json.loads(values.next())
            if "event" in frame:
                continue
            self.assertAlmostEqual(frame["time"] - last["time"], 0.04, places=4)
            opened = max(opened, -frame["values"]["5"])  # raise_b_midlip
            last = frame
        self.assertGreater(opened, 50)

    def test_it_can_be_interrupted(self):
        self.server.ask("/heads/kim", "PUT")
        told = Socket(self.server.port, "/heads/kim/faps")
        def event(name):
            for _ in range(500):
                message = json.loads(told.next())
                if message.get("event") == name:
                    return message
            self.fail(name)
        self.server.ask("/heads/kim/say", "POST",
            "One, two, three, four, five, six, seven.\nEight.")
        self.assertIn("One", event("started")["text"])
        status, answer = self.server.json("/heads/kim/say", "POST", '{"do": "stop"}\nYes?')
        self.assertEqual(status, 202)
        self.assertTrue(event("cancelled"))
        self.assertEqual(event("started")["text"], "Yes?")
        event("done")
        self.assertEqual(self.server.ask("/heads/kim/say", "POST", '{"do": "dance"}')[0], 400)
        self.assertEqual(self.server.ask("/heads/kim/say", "POST", '{"do": "end"}')[0], 400)

    def test_one_that_nobody_watches_sleeps_and_wakes_with_an_intra_plane(self):
        self.server.ask("/heads/cleo", "PUT")
        asleep = lambda: self.figures("cleo")["asleep"]
        self.assertTrue(until(asleep))
        self.assertEqual(self.figures("cleo")["planes"], 0)
        for _ in range(2):
            viewer = Socket(self.server.port, "/heads/cleo/face")
            viewer.next()
            planes = planes_of(viewer, 30)
            self.assertTrue(planes[0][0] & INTRA)
            times = [time for _, time in planes]
            self.assertEqual(times, list(range(times[0], times[0] + 30 * 1000, 1000)))
            viewer.close()
            self.assertTrue(until(asleep))
        made = self.figures("cleo")["planes"]
        self.assertLess(made, 400)
        self.assertEqual(self.figures("cleo")["planes"], made)

    def test_values_come_to_who_joins_between_intra_planes(self):
        self.server.ask("/heads/dora", "PUT", '{"intra_seconds": 20}')
        face = Socket(self.server.port, "/heads/dora/face")
        face.next()
        planes_of(face, 20)
        values = Socket(self.server.port, "/heads/dora/faps")
        values.next()
        times = []
        for number in range(40):
            frame = json.loads(values.next())
            self.assertEqual(frame["intra"], number == 0)
            times.append(round(frame["time"] * 25))
        self.assertEqual(times, list(range(times[0], times[0] + 40)))

    def test_the_same_again_is_no_other_head(self):
        self.assertEqual(self.server.ask("/heads/eva", "PUT", '{"pitch": 60}')[0], 201)
        self.assertEqual(self.server.ask("/heads/eva", "PUT", '{"pitch": 60}')[0], 200)
        status, told = self.server.json("/heads/eva", "POST", '{"pitch": 61}')
        self.assertEqual(status, 409)
        self.assertIn("PUT", told["error"])

    def test_what_is_wrong_is_told(self):
        for body, sentence in [
                ('{"pitch": 101}', '"pitch" is a whole number from 0 to 100'),
                ('{"pitch": 1.5}', '"pitch" is a whole number'),
                ('{"idle_motion": 1}', '"idle_motion" is true or false'),
                ('{"colour": "red"}', 'no "colour"; there are articulate'), ('[1]', "JSON object"),
                ('{"pitch": ', "no JSON"), ('{"model": "../../etc/passwd"}', "there is no model"),
                ('{"lang": "no such language"}', "no such"), ('{"rate": "1e9"}', "rate"),
                ('{"audio_codec": "mp3"}', "opus"), ("[" * 60000, "no JSON"),
                ('{"seed": 1e999}', "no JSON"), ('{"seed": -1}', '"seed"')]:
            status, told = self.server.json("/heads/fred", "PUT", body)
            self.assertEqual(status, 400, body[:40])
            self.assertIn(sentence, told["error"], body[:40])
        for name in ["a b", "..", ".a", "%2e%2e", "x" * 65, "a%00b", "%F0%9F%98%80"]:
            path = "/heads/" + name.replace(" ", "%20")
            try:
                self.assertIn(self.server.ask(path, "PUT")[0], (400, 403, 404, 405), name)
            except ConnectionError:
                pass  # not worth an answer
        for method, path, status in [("GET", "/nothing", 404), ("DELETE", "/heads/nobody", 404),
                                     ("POST", "/heads/nobody/say", 404), ("PUT", "/heads", 405),
                                     ("PATCH", "/heads/a", 404), ("PUT", "/heads/a/say", 405),
                                     ("GET", "/heads/nobody/face", 404),
                                     ("POST", "/heads/a/say", 404)]:
            self.assertEqual(self.server.ask(path, method, "" if method == "POST" else None)[0],
                status, path)
        self.assertEqual(self.server.json("/heads")[1]["count"], 0)

    def test_json_is_a_line_too(self):
        self.server.ask("/heads/jo", "PUT")
        told = Events(Socket(self.server.port, "/heads/jo/faps"))
        for body in ['{"text": "Hello there.", "id": "greeting", "lang": "en-gb"}',
                     '["One.", {"text": "Two.", "id": "2"}]', 'Three.\n{"text": "Four."}\n']:
            self.assertEqual(self.server.ask("/heads/jo/say", "POST", body)[0], 202, body)
        self.assertTrue(all(told.wait("done") for _ in range(5)))
        ids = self.server.json("/heads/jo/say", "POST",
            '{"text": "Five.", "id": "last"}\nSix.')[1]["ids"]
        self.assertEqual(ids, ["last", "7"])
        self.assertTrue(all(told.wait("done") for _ in range(2)))
        texts = [event["text"] for event in told.all if event["event"] == "started"]
        self.assertEqual(texts, ["Hello there.", "One.", "Two.", "Three.", "Four.", "Five.",
            "Six."])
        self.assertEqual(told.all[0]["id"], "greeting")
        status, answer = self.server.json("/heads/jo/say", "POST", '{"text": "Hi.", "loud": true}')
        self.assertEqual(status, 400)
        self.assertIn('"loud"', answer["error"])

    def test_nothing_waits_for_long_lines(self):
        text = "I could go on like this for hours, and nobody would stop me. " * 1000
        for number in range(6):
            self.server.ask(f"/heads/l{number}", "PUT")
            self.assertEqual(self.server.ask(f"/heads/l{number}/say", "POST", text[:63000])[0], 202)
        slow = []
        for _ in range(20):
            begun = time.monotonic()
            self.assertEqual(self.server.ask("/health")[0], 200)
            slow.append(time.monotonic() - begun)
        print("health in the middle of six long lines:", sorted(slow)[10], flush=True)
        status, _, headers = ask_with_headers(self.server.url + "/heads/l0/say", "POST",
            "And more.")
        self.assertEqual(status, 429)
        self.assertGreaterEqual(int(headers["Retry-After"]), 1)
        # Stops are never refused; what follows them has room.
        told = Events(Socket(self.server.port, "/heads/l0/faps"))
        self.assertEqual(self.server.ask("/heads/l0/say", "POST", '{"do": "stop"}\nYes?')[0], 202)
        self.assertTrue(told.wait("cancelled"))
        self.assertTrue(told.wait("done"))
        self.assertEqual(told.count("cancelled"), 1)
        self.assertEqual(self.server.ask("/heads/another", "PUT")[0], 201)

    def test_there_are_limits(self):
        for i in range(12):
            self.assertEqual(self.server.ask(f"/heads/h{i}", "PUT")[0], 201)
        status, told = self.server.json("/heads/h12", "PUT")
        self.assertEqual(status, 429)
        self.assertIn("--max-heads", told["error"])
        self.assertEqual(self.server.ask("/heads/h0/say", "POST", "a.\n" * 1001)[0], 429)
        self.assertEqual(self.server.json("/heads/h0")[1]["figures"]["lines_waiting"], 0)
        try:
            self.assertEqual(self.server.ask("/heads/h0/say", "POST", "x" * 1_000_000)[0], 413)
        except OSError:
            pass  # it does not read all of that
        viewers = [Socket(self.server.port, f"/heads/h{i % 12}/face") for i in range(33)]
        self.assertEqual([viewer.status for viewer in viewers].count(101), 30)
        for viewer in viewers:
            viewer.close()

    def test_strangers_do_not_hurt_it(self):
        self.server.ask("/heads/gina", "PUT")
        viewer = Socket(self.server.port, "/heads/gina/face")
        viewer.next()
        bad = [b"\x00" * 5000, b"GET",
            b"PUT /heads/x HTTP/1.1\r\nHost: a\r\nContent-Length: -1\r\n\r\n",
               b"PUT /heads/x HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99999999999999999999\r\n\r\n",
               b"PUT /heads/x HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\nfff\r\n{}",
               b"PUT /heads/x HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 50\r\n\r\n{",
               b"POST /heads/gina/say HTTP/1.1\r\n" + b"X: y\r\n" * 3000 + b"\r\n",
               b"PUT " + b"/a" * 9000 + b" HTTP/1.1\r\n\r\n",
               b"DELETE /heads/gina HTTP/1.1\r\n\r\n",
               b"DELETE /heads/gina HTTP/1.1\r\nHost: evil.example\r\n\r\n",
               b"DELETE /heads/gina HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://evil.example\r\n\r\n"]
        kept = []
        for number in range(100):
            stranger = socket.create_connection(("127.0.0.1", self.server.port))
            stranger.sendall(bad[number % len(bad)])
            if number % 3:
                stranger.close()
            else:
                kept.append(stranger)
        self.assertIsNotNone(viewer.next())
        for stranger in kept:
            stranger.close()
        self.assertTrue(until(lambda: self.server.ask("/health")[0] == 200))
        self.assertEqual([head["name"] for head in self.server.json("/heads")[1]["heads"]],
            ["gina"])
        planes_of(viewer, 25)

    def test_many_ask_at_once(self):
        answers = []
        def make_and_talk(number):
            name = f"/heads/t{number % 8}"
            answers.append(self.server.ask(name, "PUT")[0])
            answers.append(self.server.ask(name + "/say", "POST", f"Number {number}.")[0])
            answers.append(self.server.ask(name, "DELETE" if number % 5 == 0 else "GET")[0])
        threads = [threading.Thread(target=make_and_talk, args=(i,)) for i in range(24)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(answers), 72)
        self.assertLessEqual(set(answers), {200, 201, 202, 404})

    def test_metrics_are_as_prometheus_reads_them(self):
        self.server.ask("/heads/hugo", "PUT")
        self.server.ask("/heads/hugo/say", "POST", "Count me.")
        self.assertTrue(until(lambda: self.figures("hugo")["planes"] > 20))
        status, text = self.server.ask("/metrics")
        self.assertEqual(status, 200)
        values = {}
        for line in text.splitlines():
            if not line.startswith("#"):
                name, value = line.rsplit(" ", 1)
                values[name] = float(value)
        self.assertEqual(values["animeme_heads"], 1)
        self.assertGreater(values["animeme_planes_total"], 20)
        bars = [values[name] for name in values if "late_seconds_bucket" in name]
        self.assertEqual(bars, sorted(bars))
        self.assertEqual(bars[-1], values["animeme_late_seconds_count"])
        self.assertTrue(until(lambda: "animeme_lines_total{end=\"done\"} 0" not
            in self.server.ask("/metrics")[1]))
        text = self.server.ask("/metrics")[1]
        self.assertIn("animeme_build_info{version=", text)
        self.assertRegex(text, r'http_requests_total\{status="201"\} [1-9]')
        self.assertRegex(text, r"text_to_face_seconds_count [1-9]")
        self.assertRegex(text, r"text_to_sound_seconds_count [1-9]")


class Ends(unittest.TestCase):
    def test_signals_and_viewers(self):
        for how, code in [(signal.SIGTERM, 0), (signal.SIGINT, 130)]:
            server = Server(PROGRAM)
            server.ask("/heads/anna", "PUT")
            viewer = Socket(server.port, "/heads/anna/face")
            viewer.next()
            planes_of(viewer, 3)
            server.process.send_signal(how)
            while viewer.next() is not None:
                pass
            self.assertEqual(viewer.closed, 1001)  # viewers come back to the next process
            self.assertEqual(server.end(None)[0], code)

    def test_what_was_accepted_is_spoken_before_the_end(self):
        server = Server(PROGRAM)
        self.assertEqual(server.json("/ready"), (200, {"ready": True}))
        server.ask("/heads/anna", "PUT")
        told = Socket(server.port, "/heads/anna/faps")
        self.assertEqual(server.ask("/heads/anna/say", "POST", "One, two, three.\nAnd four.")[0],
            202)
        events = Events(told)
        self.assertTrue(events.wait("started"))
        server.process.send_signal(signal.SIGTERM)
        self.assertTrue(until(lambda: server.ask("/ready")[0] == 503))
        self.assertEqual(server.json("/health")[1]["status"], "ending")
        status, answer, headers = ask_with_headers(server.url + "/heads/anna/say", "POST", "Five.")
        self.assertEqual(status, 503)
        self.assertEqual(headers["Retry-After"], "1")
        self.assertEqual(server.ask("/heads/ben", "PUT")[0], 503)
        events.wait(None)
        self.assertEqual(events.count("done"), 2)
        self.assertEqual(events.count("cancelled"), 0)
        self.assertEqual(told.closed, 1001)
        self.assertEqual(server.end(None)[0], 0)

    def test_what_takes_too_long_is_cancelled_with_events(self):
        server = Server(PROGRAM, "--drain", "0.2")
        for name in ("anna", "ben"):
            server.ask("/heads/" + name, "PUT")
        told = Events(Socket(server.port, "/heads/anna/faps"))
        gone = Events(Socket(server.port, "/heads/ben/faps"))
        for name in ("anna", "ben"):
            server.ask(f"/heads/{name}/say", "POST", "I could go on like this for hours. " * 20
                + "\nNext.")
        self.assertTrue(told.wait("started"))
        self.assertTrue(gone.wait("started"))
        server.ask("/heads/ben", "DELETE")
        gone.wait(None)
        self.assertEqual((gone.count("cancelled"), gone.count("done")), (2, 0))
        self.assertEqual(gone.socket.closed, 1000)
        server.process.send_signal(signal.SIGTERM)
        told.wait(None)
        self.assertEqual((told.count("cancelled"), told.count("done")), (2, 0))
        self.assertEqual(server.end(None)[0], 0)

    def test_who_cannot_keep_up_takes_no_more_heads(self):
        server = Server(PROGRAM)
        server.ask("/heads/anna", "PUT")
        face = Socket(server.port, "/heads/anna/face")
        face.next()
        planes_of(face, 50)
        os.kill(server.process.pid, signal.SIGSTOP)
        time.sleep(2)
        os.kill(server.process.pid, signal.SIGCONT)
        threading.Thread(target=lambda: planes_of(face, 1000), daemon=True).start()
        self.assertTrue(until(lambda: server.json("/health")[1]["status"] == "degraded"))
        status, _, headers = ask_with_headers(server.url + "/heads/ben", "PUT", "")
        self.assertEqual((status, headers["Retry-After"]), (503, "10"))
        self.assertEqual(server.ask("/heads/anna/say", "POST", "Go on.")[0], 202)
        self.assertEqual(server.end()[0], 0)

    def test_it_writes_what_happens(self):
        for how in ("json", "text"):
            with tempfile.TemporaryFile("w+") as log:
                process = subprocess.Popen([PROGRAM, "serve", "--listen", "http://127.0.0.1:0",
                    "--json", "--quiet",
                                            "--log", how], stdout=subprocess.PIPE, stderr=log,
                                            text=True)
                url = json.loads(process.stdout.readline())["address"].rstrip("/")
                ask(url + "/heads/anna", "PUT", "")
                ask(url + "/heads/anna/say", "POST", '{"text": "A secret.", "id": "one"}')
                ask(url + "/heads/nobody", "DELETE")
                process.send_signal(signal.SIGTERM)
                process.communicate(timeout=60)
                log.seek(0)
                text = log.read()
            self.assertNotIn("secret", text)
            if how == "text":
                self.assertRegex(text, r"Z request PUT /heads/anna status=201 ms=")
                self.assertRegex(text, r"Z line anna line=1 one done")
                continue
            entries = [json.loads(line) for line in text.splitlines()]
            self.assertIn(("head", "anna", "made"), [(e["kind"], e.get("head"), e.get("what")) for e
                in entries])
            self.assertEqual([e["status"] for e in entries if e["kind"] == "request"],
                [201, 202, 404])
            self.assertEqual([e["what"] for e in entries if e["kind"] == "line"],
                ["queued", "started", "done"])
            self.assertTrue(all(e["time"].endswith("Z") for e in entries))

    def test_a_voice_that_dies_loses_no_line(self):
        server = Server(PROGRAM)
        server.ask("/heads/anna", "PUT")
        told = Events(Socket(server.port, "/heads/anna/faps"))
        for number in range(6):
            for child in descendants(server.process.pid):
                try:
                    os.kill(child, signal.SIGKILL)
                except ProcessLookupError:
                    pass
            self.assertEqual(server.ask("/heads/anna/say", "POST", f"Line {number}.")[0], 202)
            self.assertTrue(told.wait("done"))
        self.assertEqual(told.count("cancelled"), 0)
        self.assertEqual(server.end()[0], 0)

    def test_a_token_is_needed(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "token")
            with open(path, "w") as file:
                file.write("secret-1\n")
            server = Server(PROGRAM, "--token-file", path)
            right = {"Authorization": "Bearer secret-1"}
            for wrong in [{}, {"Authorization": "Bearer secret-2"}, {"Authorization": "Bearer "},
                          {"Authorization": "Basic secret-1"},
                          {"Authorization": "Bearer secret-11"}]:
                for method, path in [("PUT", "/heads/a"), ("GET", "/heads"), ("GET", "/metrics"),
                                     ("POST", "/heads/a/say"), ("DELETE", "/heads/a")]:
                    body = "" if method in ("PUT", "POST") else None
                    self.assertEqual(server.ask(path, method, body, headers=wrong)[0], 401)
            self.assertEqual(server.ask("/heads/a", "PUT", "{}", headers=right)[0], 201)
            self.assertEqual(server.ask("/health")[0], 200)
            self.assertEqual(server.ask("/heads/a/")[0], 200)  # viewers need none
            self.assertEqual(server.end()[0], 0)

    def test_heads_of_a_file_and_those_that_are_forgotten(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "heads.json")
            with open(path, "w") as file:
                json.dump({"defaults": {"lang": "en-gb"}, "heads": [{"name": "anna", "seed": 3}]},
                    file)
            server = Server(PROGRAM, path, "--expire", "1", "--make-on-say")
            self.assertEqual(server.json("/heads/anna")[1]["settings"]["lang"], "en-gb")
            self.assertEqual(server.ask("/heads/new/say", "POST", "Hi.")[0], 202)
            self.assertEqual(server.json("/heads/new")[1]["settings"]["lang"], "en-gb")
            self.assertTrue(until(lambda: server.json("/heads")[1]["count"] == 1, 60))
            self.assertEqual(server.ask("/heads/anna")[0], 200)
            self.assertEqual(server.end()[0], 0)

    def test_pages_show_the_heads_that_are_given(self):
        with tempfile.TemporaryDirectory() as folder:
            avatar, other = (os.path.join(folder, name) for name in ("me.glb", "you.glb"))
            for name, path in [("child", avatar), ("man", other)]:
                subprocess.run([PROGRAM, "head", name, "-o", path], check=True, capture_output=True)
            server = Server(PROGRAM, "--head", avatar, "--head", other, "--shape-name", "jawOpen=-")
            self.assertEqual(server.ask("/heads/a", "PUT", "{}")[0], 201)
            _, info = server.ask("/heads/a/info.json")
            self.assertEqual(json.loads(info)["heads"], ["me", "you"])
            self.assertEqual(server.end()[0], 0)
            for wrong in [["--head", "nobody.glb"], ["--head", avatar, "--shape-name", "jawOpen"],
                          ["--head", avatar, "--shape-name", "noSuchShape=jawOpen"]]:
                done = subprocess.run([PROGRAM, "serve", "--listen", "http://127.0.0.1:0/", *wrong],
                                      capture_output=True, timeout=60)
                self.assertIn(done.returncode, (2, 3), wrong)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2, warnings="ignore")
