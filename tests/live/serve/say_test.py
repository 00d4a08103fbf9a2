"""Sound, pieces and lines for heads of `animeme serve`, who may watch them, and changes of heads.

say_test.py PROGRAM SAMPLES"""

import base64
import hashlib
import hmac
import http.client
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import wave

from client import Server, Socket, ask, until

PROGRAM, SAMPLES = sys.argv[1:3]
RATE = 24000


def voice():
    """Samples of 16 bits of a voice, and their seconds."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "voice.wav")
        subprocess.run(["ffmpeg", "-v", "error", "-i", os.path.join(SAMPLES, "voice.wav"), "-ar",
            str(RATE), "-ac",
                        "1", "-c:a", "pcm_s16le", path], check=True)
        with open(path, "rb") as file:
            whole = file.read()
        with wave.open(path) as sound:
            return sound.readframes(sound.getnframes()), sound.getnframes() / RATE, whole


class Told:
    """Events of a socket, read in a thread; times as they came."""

    def __init__(self, told):
        self.socket, self.all, self.planes = told, [], []
        self.thread = threading.Thread(target=self.read, daemon=True)
        self.thread.start()

    def read(self):
        while (message := self.socket.next()) is not None:
            if not message.startswith(b"{"):
                continue
            told = json.loads(message)
            (self.all if "event" in told else self.planes).append(told)

    def names(self, name):
        return [event for event in list(self.all) if event["event"] == name]

    def until(self, name, count=1, seconds=60):
        return until(lambda: len(self.names(name)) >= count, seconds)


def opened(planes):
    return max((-plane["values"].get("5", 0) for plane in planes if "values" in plane), default=0)


class Sound(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(PROGRAM)
        cls.samples, cls.seconds, cls.wav = voice()

    @classmethod
    def tearDownClass(cls):
        code, _ = cls.server.end()
        assert code == 0, code

    def make(self, name, settings="{}"):
        self.assertEqual(self.server.ask("/heads/" + name, "PUT", settings)[0], 201)
        return Told(Socket(self.server.port, f"/heads/{name}/faps"))

    def chunked(self, path, blocks, kind):
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=60)
        connection.request("POST", path, body=iter(blocks), headers={"Content-Type": kind},
            encode_chunked=True)
        answer = connection.getresponse()
        return answer.status, json.loads(answer.read())

    def test_samples_by_a_socket_move_the_face(self):
        viewer = self.make("ada")
        owner = Socket(self.server.port, f"/heads/ada/say?pcm={RATE}&id=greeting")
        self.assertEqual(owner.status, 101)
        told = Told(owner)
        step = RATE // 10 * 2
        for at in range(0, len(self.samples), step):
            owner.send(self.samples[at:at + step])
        owner.send('{"done": true}')
        self.assertTrue(until(lambda: told.names("queued")
            and len(told.names("queued")) == len(told.names("done")) and
                              told.names("done")[-1]["time"] - told.names("started")[0][
                              "time"] > self.seconds - 0.5))
        self.assertEqual({event["id"] for event in told.names("done")}, {"greeting"})
        self.assertEqual(told.names("cancelled"), [])
        self.assertEqual(told.names("error"), [])
        spoken = told.names("done")[-1]["time"] - told.names("started")[0]["time"]
        self.assertAlmostEqual(spoken, self.seconds, delta=0.35)
        self.assertGreater(opened(viewer.planes), 60)
        owner.send("And now a text.")
        self.assertTrue(until(lambda: any(e["text"] == "And now a text." for e
            in told.names("started"))))
        owner.send('{"do": "stop"}')
        self.assertTrue(told.until("stopped"))

    def test_a_stop_ends_sound_that_waits(self):
        self.make("bo")
        owner = Socket(self.server.port, f"/heads/bo/say?pcm={RATE}")
        told = Told(owner)
        for _ in range(4):
            owner.send(self.samples[:RATE])
        self.assertTrue(told.until("started"))
        owner.send('{"do": "stop"}')
        self.assertTrue(told.until("stopped"))
        self.assertTrue(until(lambda: len(told.names("cancelled")) + len(told.names("done")) ==
                              len(told.names("queued"))))
        self.assertTrue(told.names("cancelled"))

    def test_bodies_of_any_length_and_kind(self):
        told = self.make("cy")
        blocks = [self.wav[at:at + 1777] for at in range(0, len(self.wav), 1777)]
        status, answer = self.chunked("/heads/cy/say?id=one", blocks, "audio/wav")
        self.assertEqual((status, answer["ids"]), (202, ["one"]))
        self.assertAlmostEqual(answer["seconds"], self.seconds, delta=0.01)
        swapped = b"".join(bytes([self.samples[i + 1], self.samples[i]]) for i in range(0, RATE, 2))
        for path, kind, body, seconds in [
                (f"/heads/cy/say?pcm={RATE}", "application/octet-stream", self.samples[:RATE], 0.5),
                ("/heads/cy/say", f"audio/L16; rate={RATE}", swapped, 0.5),
                ("/heads/cy/say", "audio/PCMU", b"\x7f\x80" * 2000, 0.5),
                ("/heads/cy/say", "application/octet-stream", self.wav, self.seconds)]:
            status, text = ask(self.server.url + path, "POST", body, {"Content-Type": kind})
            self.assertEqual(status, 202, text)
            self.assertAlmostEqual(json.loads(text)["seconds"], seconds, delta=0.01)
        for path, kind, body in [("/heads/cy/say", "audio/mpeg", b"no sound at all"),
                                 ("/heads/cy/say", "audio/wav", b"RIFF no sound at all"),
                                 ("/heads/cy/say?pcm=1", "audio/wav", self.wav)]:
            status, text = ask(self.server.url + path, "POST", body, {"Content-Type": kind})
            self.assertEqual(status, 400, text)
        for path, status in [("/heads/nobody/say", 404), ("/heads/cy/say?pcm=x", 400)]:
            self.assertEqual(self.chunked(path, [b"x" * 100], "audio/wav")[0], status)
        self.server.ask("/heads/cy/say", "POST", '{"do": "stop"}')
        self.assertTrue(until(lambda: len(told.names("cancelled")) + len(told.names("done")) ==
                              len(told.names("queued"))))

    def test_lines_in_chunks_are_said_as_they_come(self):
        told = self.make("di")

        def lines():
            yield b"First line.\n{\"text\": \"Second"
            self.assertTrue(told.until("started"))
            yield b" line.\", \"id\": \"two\"}\n"
            yield b"Third line."
        status, answer = self.chunked("/heads/di/say", lines(), "text/plain")
        self.assertEqual((status, answer["lines"]), (202, 3))
        self.assertEqual(answer["ids"][1], "two")
        self.assertTrue(told.until("done", 3))

    def test_chunks_that_are_none(self):
        self.make("dot")
        import socket as sockets
        for body in [b"zz\r\nHello", b"5\r\nHelloX\r\n0\r\n\r\n", b"ffffffffff\r\n", b"\r\n\r\n"]:
            raw = sockets.create_connection(("127.0.0.1", self.server.port), 30)
            raw.sendall(
                b"POST /heads/dot/say HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\n" + body)
            raw.settimeout(30)
            self.assertNotIn(b"202", raw.recv(4096).split(b"\r\n")[0])
            raw.close()
        self.assertEqual(self.server.ask("/health")[0], 200)

    def test_pieces_are_lines_too(self):
        told = self.make("eve", '{"voice_rate": 24000}')
        sound = base64.b64encode(self.samples[:RATE * 2]).decode()
        pieces = [{"utterance": "u1", "audio": sound, "sample_rate": RATE, "id": "u1"},
                  {"utterance": "u1", "words": [{"word": "one", "start": 0.1, "end": 0.6}],
                  "done": True}]
        status, answer = self.server.json("/heads/eve/say", "POST", json.dumps(pieces))
        self.assertEqual((status, answer["ids"][0]), (202, "u1"))
        self.assertTrue(told.until("done"))
        # A text has no sound: it is spoken by the voice. Members that nobody knows are named.
        self.assertEqual(self.server.ask("/heads/eve/say", "POST",
            '{"text": "Hello", "id": "b"}')[0], 202)
        status, answer = self.server.json("/heads/eve/say", "POST",
            '{"text": "Hello", "colour": "red"}')
        self.assertEqual(status, 400)
        self.assertIn("colour", answer["error"])
        # Files are those of the server: nobody gets at them.
        self.server.ask("/heads/eve/say", "POST",
            json.dumps({"file": os.path.join(SAMPLES, "voice.wav"), "id": "f"}))
        self.assertTrue(until(lambda: any(e["id"] == "f" and "base64" in e["why"] for e
            in told.names("cancelled"))))

    def test_what_is_not_spoken_yet_is_for_the_owner(self):
        viewer = self.make("fay")
        owner = Told(Socket(self.server.port, "/heads/fay/say"))
        body = "I could say this for a while, one two three four five.\nA secret."
        self.assertEqual(self.server.ask("/heads/fay/say", "POST", body)[0], 202)
        self.assertTrue(owner.until("queued", 2))
        self.assertTrue(viewer.until("queued", 2))
        self.assertIn("A secret.", [event["text"] for event in owner.names("queued")])
        self.server.ask("/heads/fay/say", "POST", '{"do": "stop"}')
        self.assertTrue(viewer.until("cancelled", 2))
        self.assertNotIn("secret", json.dumps(viewer.all))


class Changes(unittest.TestCase):
    def test_a_head_changes(self):
        server = Server(PROGRAM)
        server.ask("/heads/anna", "PUT", '{"lang": "en", "seed": 3}')
        viewer = Told(Socket(server.port, "/heads/anna/faps"))
        said = Told(Socket(server.port, "/heads/anna/say"))
        server.ask("/heads/anna/say", "POST",
            "I am being changed while I speak, and nobody notices.")
        self.assertTrue(said.until("started"))
        self.assertEqual(server.json("/heads/anna", "PATCH",
            '{"lang": "de", "mood": "joy:0.5"}')[0], 200)
        settings = server.json("/heads/anna")[1]["settings"]
        self.assertEqual((settings["lang"], settings["seed"]), ("de", 3))
        self.assertTrue(said.until("done"))
        self.assertEqual(said.names("cancelled"), [])
        self.assertIsNone(viewer.socket.closed)
        # What cannot change while it lives makes it anew; viewers come back.
        self.assertEqual(server.json("/heads/anna", "PUT", '{"quant": 3}')[0], 200)
        self.assertTrue(until(lambda: viewer.socket.closed is not None))
        self.assertEqual(viewer.socket.closed, 1001)
        settings = server.json("/heads/anna")[1]["settings"]
        self.assertEqual((settings["lang"], settings["seed"], settings["quant"]), ("en", 1, 3))
        again = Socket(server.port, "/heads/anna/faps")
        self.assertIn("faps", json.loads(again.next()))
        for wrong in ['{"tts": "none"}', '{"head": "none"}', '{"lang": "no such"}',
            '{"model": "x"}']:
            self.assertEqual(server.ask("/heads/anna", "PATCH", wrong)[0], 400, wrong)
        self.assertEqual(server.json("/heads/anna")[1]["settings"], settings)
        self.assertEqual(server.end()[0], 0)

    def test_voices_of_the_operator(self):
        with tempfile.TemporaryDirectory() as folder:
            slow = os.path.join(folder, "slow.sh")
            with open(slow, "w") as file:
                file.write(f"#!/bin/sh\nsleep 1\ncp {os.path.join(SAMPLES, 'voice.wav')} \"$1\"\n")
            os.chmod(slow, 0o755)
            server = Server(PROGRAM, "--tts", f"slow={slow} {{wav}}")
            status, answer = server.json("/heads/a", "PUT", '{"tts": "/bin/true"}')
            self.assertEqual(status, 400)
            self.assertIn("there are slow", answer["error"])
            for name in "abc":
                self.assertEqual(server.ask("/heads/" + name, "PUT", '{"tts": "slow"}')[0], 201)
            server.ask("/heads/fast", "PUT")
            told = {name: Told(Socket(server.port, f"/heads/{name}/say")) for name
                in ("a", "b", "c", "fast")}
            begun = time.monotonic()
            for name in ("a", "b", "c", "fast"):
                server.ask(f"/heads/{name}/say", "POST", "My mouth moves by numbers.")
            self.assertTrue(told["fast"].until("started"))
            # nobody waits for a slow voice but its head
            self.assertFalse(told["a"].names("started"))
            for name in "abc":
                self.assertTrue(told[name].until("started"), name)
            print("three voices of a second each:", round(time.monotonic() - begun, 2))
            self.assertEqual(server.end()[0], 0)
        for wrong in ["slow", "=x", "a=", "a=prog {nothing}"]:
            done = subprocess.run([PROGRAM, "serve", "--tts", wrong], capture_output=True,
                timeout=60)
            self.assertEqual(done.returncode, 2, wrong)


class Viewers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(PROGRAM, "--viewers", "token", env={"ANIMEME_TOKEN": "secret"})
        cls.right = {"Authorization": "bearer secret"}
        assert cls.server.ask("/heads/anna", "PUT", "{}", headers=cls.right)[0] == 201

    @classmethod
    def tearDownClass(cls):
        assert cls.server.end()[0] == 0

    def ticket(self, seconds=60):
        status, told = self.server.json("/heads/anna/ticket", "POST",
            json.dumps({"seconds": seconds}),
                                        headers=self.right)
        self.assertEqual(status, 200)
        return told

    def test_nobody_learns_which_heads_there_are(self):
        for ticket in ["", "?ticket=", "?ticket=x", "?ticket=9999999999-" + "0" * 64,
                       "?ticket=" + self.ticket()["ticket"].replace("-", "0-")]:
            for what in ["info.json", "talk.mp4", "face", "faps", "audio", "nothing", "whep"]:
                answers = set()
                for name in ("anna", "nobody"):
                    answers.add(self.server.ask(f"/heads/{name}/{what}{ticket}"))
                self.assertEqual(len(answers), 1, what)
                self.assertEqual(answers.pop()[0], 403)
            for name in ("anna", "nobody"):
                for path in ("face", "faps", "audio"):
                    self.assertEqual(Socket(self.server.port,
                        f"/heads/{name}/{path}{ticket}").status, 403)
                self.assertEqual(Socket(self.server.port, f"/heads/{name}/say{ticket}").status, 401)
                offer = self.server.ask(f"/heads/{name}/whep{ticket}", "POST", "v=0", headers={
                    "Content-Type": "application/sdp"})
                self.assertEqual(offer[0], 403)
        # What is the same for all heads is for everybody.
        for what in ("", "live.js", "live.css"):
            self.assertEqual(self.server.ask("/heads/anna/" + what),
                self.server.ask("/heads/nobody/" + what))
            self.assertEqual(self.server.ask("/heads/nobody/" + what)[0], 200)
        self.assertEqual(self.server.ask("/heads/anna")[0], 401)
        self.assertEqual(self.server.ask("/heads/anna/ticket", "POST", "")[0], 401)

    def test_a_ticket_opens_one_head_for_some_time(self):
        ticket = self.ticket()
        self.assertEqual(ticket["path"], "/heads/anna/?ticket=" + ticket["ticket"])
        made = hmac.new(b"secret", f"animeme ticket\nanna\n{ticket['expires']}".encode(),
            hashlib.sha256).hexdigest()
        self.assertEqual(ticket["ticket"], f"{ticket['expires']}-{made}")
        # A program with the token makes tickets by the lines of requests.md.
        page = os.path.join(os.path.dirname(__file__), "../../../tools/live/serve/requests.md")
        with open(page) as file:
            block = file.read().split("```python\n")[1].split("```")[0]
        own = {"time": time, "hmac": hmac, "hashlib": hashlib, "token": b"secret", "name": "anna"}
        exec(block, own)
        self.assertEqual(self.server.ask("/heads/anna/info.json?ticket=" + own["ticket"])[0], 200)
        query = "?ticket=" + ticket["ticket"]
        self.assertEqual(self.server.ask("/heads/anna/info.json" + query)[0], 200)
        self.assertEqual(self.server.ask("/heads/ben/info.json" + query)[0], 403)
        face = Socket(self.server.port, "/heads/anna/faps?binary&" + query[1:])
        self.assertEqual(face.status, 101)
        with_token = Socket(self.server.port, "/heads/anna/faps",
            headers="Authorization: Bearer secret\r\n")
        self.assertEqual(with_token.status, 101)
        self.assertEqual(Socket(self.server.port, "/heads/nobody/faps",
                                headers="Authorization: Bearer secret\r\n").status, 404)
        with tempfile.TemporaryDirectory() as folder:
            address = self.server.url.replace("http", "ws") + "/heads/anna/" + query
            done = subprocess.run([PROGRAM, "receive", address, "-o", os.path.join(folder, "a.fba"),
                "--duration", "1"],
                                  capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
        short = "?ticket=" + self.ticket(1)["ticket"]
        self.assertTrue(until(lambda: self.server.ask("/heads/anna/info.json" + short)[0] == 403))
        for wrong in ['{"seconds": 0}', '{"seconds": 1e9}', '{"second": 1}', "[]",
            '{"seconds": "1"}']:
            self.assertEqual(self.server.ask("/heads/anna/ticket", "POST", wrong,
                headers=self.right)[0], 400)

    def test_the_list_of_heads_is_a_page(self):
        status, page = self.server.ask("/")
        self.assertEqual(status, 200)
        self.assertIn("<title>Animeme heads</title>", page)
        self.assertNotIn("anna", page)
        for part in ("/index.js", "/index.css"):
            self.assertEqual(self.server.ask(part)[0], 200)


class Http(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(PROGRAM)

    @classmethod
    def tearDownClass(cls):
        assert cls.server.end()[0] == 0

    def raw(self, text):
        import socket as sockets
        with sockets.create_connection(("127.0.0.1", self.server.port), 30) as raw:
            raw.sendall(text.encode())
            raw.settimeout(30)
            answer = b""
            while b"\r\n\r\n" not in answer and (block := raw.recv(65536)):
                answer += block
        return answer.decode()

    def test_a_blank_in_front_of_a_colon(self):
        for header in ["Content-Length : 2", "Host : 127.0.0.1", "Transfer-Encoding : chunked",
                       "Authorization : Bearer x"]:
            answer = self.raw(f"GET /health HTTP/1.1\r\nHost: 127.0.0.1\r\n{header}\r\n\r\n")
            self.assertIn(" 400 ", answer.split("\r\n")[0], header)

    def test_other_methods_are_told_which_there_are(self):
        self.server.ask("/heads/anna", "PUT")
        for method, path, allow in [("DELETE", "/heads", "GET, HEAD"),
            ("PUT", "/heads/anna/say", "POST"),
                                    ("OPTIONS", "/heads/anna", "GET, HEAD")]:
            answer = self.raw(
                f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\n\r\n").lower()
            self.assertIn(" 405 ", answer.split("\r\n")[0])
            self.assertIn("allow: " + allow.lower() + "\r\n", answer)

    def test_a_connection_that_closes_says_so(self):
        import socket as sockets
        for request in ["OPTIONS /heads/anna HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
                        "DELETE /heads HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\n\r\n",
                        "DELETE /heads HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"]:
            with sockets.create_connection(("127.0.0.1", self.server.port), 30) as raw:
                raw.settimeout(3)
                raw.sendall(request.encode())
                answer = raw.recv(65536).decode().lower()
                said = "connection: close" in answer
                try:
                    while raw.recv(65536):
                        pass
                    closed = True
                except TimeoutError:
                    closed = False
                self.assertEqual(said, closed, request)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2, warnings="ignore")
