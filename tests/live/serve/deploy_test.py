"""`animeme serve` as it is deployed: settings, nginx and HAProxy with TLS, the unit of systemd,
files for containers.

deploy_test.py PROGRAM FOLDER"""

import http.client
import json
import os
import re
import shutil
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
import time
import unittest

from client import Server, Socket, free_port, until

PROGRAM, FOLDER = sys.argv[1:3]
NAME = "heads.example.org"


def find(program):
    return shutil.which(program, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


class Secure:
    """A proxy with TLS at a port, reached by its name."""

    def __init__(self, folder, port):
        self.port = port
        self.context = ssl.create_default_context(cafile=os.path.join(folder, "cert.pem"))

    @staticmethod
    def certificate(folder):
        key, cert = os.path.join(folder, "key.pem"), os.path.join(folder, "cert.pem")
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt",
            "ec_paramgen_curve:prime256v1", "-nodes",
                        "-keyout", key, "-out", cert, "-days", "2", "-subj", "/CN=" + NAME,
                        "-addext",
                        "subjectAltName=DNS:" + NAME], check=True, capture_output=True)
        both = os.path.join(folder, "both.pem")
        with open(both, "w") as file:
            for path in (cert, key):
                with open(path) as part:
                    file.write(part.read())
        return cert, key, both

    def connect(self):
        raw = socket.create_connection(("127.0.0.1", self.port), 30)
        return self.context.wrap_socket(raw, server_hostname=NAME)

    def ask(self, method, path, body=None, headers=None, chunked=False):
        connection = http.client.HTTPConnection(NAME, timeout=30)
        connection.sock = self.connect()
        connection.request(method, path, body=body, headers=headers or {}, encode_chunked=chunked)
        answer = connection.getresponse()
        return answer.status, answer.read().decode()

    def socket(self, path, headers=""):
        return Socket(self.port, path, host=NAME, headers=headers, connection=self.connect())


class Behind(unittest.TestCase):
    """What must pass every proxy."""

    def goes_through(self, proxy, right):
        self.assertEqual(proxy.ask("PUT", "/heads/anna", "{}", right)[0], 201)
        self.assertEqual(proxy.ask("GET", "/metrics", headers=right)[0], 403)
        self.assertEqual(proxy.ask("GET", "/heads/anna/info.json")[0], 403)
        ticket = json.loads(proxy.ask("POST", "/heads/anna/ticket", "", right)[1])["ticket"]
        self.assertEqual(proxy.ask("GET", f"/heads/anna/info.json?ticket={ticket}")[0], 200)
        viewer = proxy.socket(f"/heads/anna/faps?ticket={ticket}")
        self.assertEqual(viewer.status, 101)
        self.assertIn("faps", json.loads(viewer.next()))
        owner = proxy.socket("/heads/anna/say", "Authorization: Bearer secret\r\n")
        self.assertEqual(owner.status, 101)

        def lines():  # the first one is said before the second one is sent
            yield b"Hello there.\n"
            while json.loads(owner.next())["event"] != "started":
                pass
            yield b"Good bye.\n"
        status, text = proxy.ask("POST", "/heads/anna/say", lines(),
            {**right, "Content-Type": "text/plain"}, True)
        self.assertEqual((status, json.loads(text)["lines"]), (202, 2))
        moved = 0
        for _ in range(100):
            frame = json.loads(viewer.next())
            moved = max(moved, -frame.get("values", {}).get("5", 0))
        self.assertGreater(moved, 30)

    def servers(self, count):
        servers = [Server(PROGRAM, "--host-name", NAME, "--viewers", "token",
            env={"ANIMEME_TOKEN": "secret"})
                   for _ in range(count)]
        for server in servers:
            self.addCleanup(server.end)
        return servers

    def test_nginx(self):
        if not find("nginx"):
            self.skipTest("nginx is missing (apt-get install nginx)")
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        cert, key, _ = Secure.certificate(folder)
        server, = self.servers(1)
        port = free_port()
        with open(os.path.join(FOLDER, "nginx.conf")) as file:
            text = file.read()
        for old, new in [("listen 443", f"listen 127.0.0.1:{port}"),
            ("127.0.0.1:8080", f"127.0.0.1:{server.port}"),
                         ("/etc/ssl/animeme.pem", cert), ("/etc/ssl/animeme.key", key)]:
            self.assertIn(old, text)
            text = text.replace(old, new)
        paths = "".join(f"{name}_temp_path {folder}/{name};" for name in
                        ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
        whole = os.path.join(folder, "nginx.conf")
        with open(whole, "w") as file:
            file.write(f"daemon off; pid {folder}/pid; error_log {folder}/error.log;\nevents {{}}\n"
                       f"http {{ access_log off; {paths}\n{text}\n}}\n")
        os.chmod(folder, 0o755)
        nginx = subprocess.Popen([find("nginx"), "-p", folder, "-c", whole],
            stderr=subprocess.DEVNULL)
        self.addCleanup(nginx.wait, 30)
        self.addCleanup(nginx.terminate)
        proxy = Secure(folder, port)
        self.assertTrue(until(lambda: proxy.ask("GET", "/health")[0] == 200))
        self.goes_through(proxy, {"Authorization": "Bearer secret"})

    def test_haproxy(self):
        if not find("haproxy"):
            self.skipTest("haproxy is missing (apt-get install haproxy)")
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        _, _, both = Secure.certificate(folder)
        servers = self.servers(2)
        port = free_port()
        environment = {**os.environ, "FRONT": f"127.0.0.1:{port}", "CERTIFICATE": both,
                       "FIRST": f"127.0.0.1:{servers[0].port}",
                       "SECOND": f"127.0.0.1:{servers[1].port}"}
        haproxy = subprocess.Popen([find("haproxy"), "-db", "-f",
            os.path.join(FOLDER, "haproxy.cfg")], env=environment,
                                   stderr=subprocess.DEVNULL)
        self.addCleanup(haproxy.wait, 30)
        self.addCleanup(haproxy.kill)
        proxy = Secure(folder, port)
        self.assertTrue(until(lambda: proxy.ask("GET", "/health")[0] == 200))
        self.goes_through(proxy, {"Authorization": "Bearer secret"})


class Files(unittest.TestCase):
    def test_settings_are_options(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "serve.conf")

            def write(text):
                with open(path, "w") as file:
                    file.write(text)
            write("# a comment\n\nmax-heads = 2\nmake-on-say = true\nhost-name = one.example\nhost-name=two.example\n")
            server = Server(PROGRAM, "--settings", path, "--max-heads", "1")
            self.assertEqual(server.ask("/heads/a/say", "POST", "Hello.")[0], 202)
            self.assertEqual(server.ask("/heads/b", "PUT")[0], 429)  # the command line comes first
            for name in ("one.example", "two.example"):
                self.assertEqual(server.ask("/health", headers={"Host": name})[0], 200)
            self.assertEqual(server.ask("/health", headers={"Host": "three.example"})[0], 421)
            self.assertEqual(server.end()[0], 0)
            for text, sentence in [("max-head = 2\n", "did you mean max-heads?"),
                ("\nmax-heads\n", "line 2"),
                                   ("max-heads = many\n", "max-heads"),
                                   ("make-on-say = yes\n", "true or false"),
                                   ("drain = 1\ndrain = 2\n", "twice"),
                                   ("settings = x\n", "no setting"),
                                   ("max-heads = 0\n", "max-heads"), ("log = xml\n", "log")]:
                write(text)
                done = subprocess.run([PROGRAM, "serve", "--settings", path], capture_output=True,
                    text=True, timeout=60)
                self.assertEqual(done.returncode, 2, text)
                self.assertIn(sentence, done.stderr)
            done = subprocess.run([PROGRAM, "serve", "--settings", path + "x"], capture_output=True,
                timeout=60)
            self.assertEqual(done.returncode, 3)

    def test_sighup_reads_the_settings_again(self):
        with tempfile.TemporaryDirectory() as folder:
            path, token, heads = (os.path.join(folder, name)
                                  for name in ("serve.conf", "token", "heads.json"))

            def write(file, text):
                with open(file, "w") as out:
                    out.write(text)

            def right(secret):
                return {"Authorization": "Bearer " + secret}
            write(token, "one")
            write(heads, '{"heads": [{"name": "ann", "pitch": 40}]}')
            write(path, f"max-heads = 2\ntoken-file = {token}\nheads = {heads}\nlog = json\n")
            log = os.path.join(folder, "log")
            with open(log, "w") as errors:
                server = Server(PROGRAM, "--settings", path, stderr=errors)
            self.addCleanup(server.end)

            def logged(what):
                with open(log) as file:
                    return sum(f'"what":"{what}"' in line.replace(" ", "") for line in file)

            def reload(what):
                before = logged(what)
                server.process.send_signal(signal.SIGHUP)
                self.assertTrue(until(lambda: logged(what) > before))
            viewer = Socket(server.port, "/heads/ann/faps")
            self.assertEqual(viewer.status, 101)
            self.assertEqual(server.ask("/heads/b", "PUT", headers=right("one"))[0], 201)
            self.assertEqual(server.ask("/heads/c", "PUT", headers=right("one"))[0], 429)
            # What is wrong changes nothing.
            for text in ("max-heads = 0\n", "max-head = 9\n", "log = xml\n",
                         f"heads = {path}\n", f"token-file = {path}x\n", "viewers = token\n"):
                write(path, text)
                reload("refused")
                self.assertEqual(server.ask("/heads/c", "PUT", headers=right("one"))[0], 429, text)
            # Another token, more heads, a voice, and defaults of new heads.
            write(token, "two")
            write(heads, '{"defaults": {"pitch": 70}, "heads": [{"name": "ann", "pitch": 90},'
                         ' {"name": "dora"}]}')
            write(path, f"max-heads = 9\ntoken-file = {token}\nheads = {heads}\nlog = json\n"
                        "tts = mine=/bin/true {wav}\n")
            reload("readagain")
            self.assertEqual(server.ask("/heads", headers=right("one"))[0], 401)
            self.assertEqual(server.ask("/heads/c", "PUT", headers=right("two"))[0], 201)
            self.assertEqual(server.ask("/heads/e", "PUT", '{"tts": "mine"}',
                                        headers=right("two"))[0], 201)
            pitches = {name: json.loads(server.ask("/heads/" + name, headers=right("two"))[1])
                       ["settings"]["pitch"] for name in ("ann", "b", "c", "dora")}
            self.assertEqual(pitches, {"ann": 40, "b": 50, "c": 70, "dora": 70})
            # Viewers of heads that there were notice nothing.
            for _ in range(30):
                self.assertIsNotNone(viewer.next())
            self.assertEqual(server.end()[0], 0)
        # Without files to read again it ends a program, as the end of a terminal does.
        server = Server(PROGRAM)
        self.assertEqual(server.end(signal.SIGHUP)[0], -signal.SIGHUP)

    def test_the_example_of_settings_is_right(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(FOLDER, "serve.conf")) as file:
                lines = file.read().replace(":8080", ":0")
            path = os.path.join(folder, "serve.conf")
            with open(path, "w") as file:
                file.write(re.sub(r"listen = .*\n", "", lines))
            server = Server(PROGRAM, "--settings", path, env={"ANIMEME_TOKEN": "secret"})
            self.assertEqual(server.ask("/health", headers={"Host": NAME})[0], 200)
            self.assertEqual(server.end()[0], 0)

    def test_the_unit_of_systemd(self):
        if not find("systemd-analyze"):
            self.skipTest("systemd-analyze is missing (apt-get install systemd)")
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(FOLDER, "animeme-serve.service")) as file:
                text = file.read()
            self.assertIn("ExecStart=/usr/bin/animeme serve", text)
            self.assertIn("ExecReload=/bin/kill -HUP $MAINPID", text)
            path = os.path.join(folder, "animeme-serve.service")
            with open(path, "w") as file:
                file.write(text.replace("/usr/bin/animeme",
                    PROGRAM).replace("Documentation=man:animeme-serve(1)\n", ""))
            done = subprocess.run(["systemd-analyze", "verify", path], capture_output=True,
                text=True, timeout=60)
            ours = [line for line in done.stderr.splitlines() if "animeme-serve" in line]
            self.assertEqual(ours, [])
            done = subprocess.run(["systemd-analyze", "security", "--offline=true", path],
                capture_output=True, text=True,
                                  timeout=60)
            found = re.search(r"exposure level for animeme-serve.service: ([0-9.]+)", done.stdout)
            self.assertTrue(found, done.stdout + done.stderr)
            print("exposure:", found[1])
            self.assertLess(float(found[1]), 2)

    def test_files_for_containers(self):
        try:
            import yaml
        except ImportError:
            self.skipTest("python3-yaml is missing")
        with open(os.path.join(FOLDER, "kubernetes.yaml")) as file:
            parts = {part["kind"]: part for part in yaml.safe_load_all(file)}
        self.assertEqual(set(parts), {"ConfigMap", "Deployment", "Service", "Ingress"})
        with tempfile.TemporaryDirectory() as folder:  # its settings are some
            path = os.path.join(folder, "serve.conf")
            text = parts["ConfigMap"]["data"]["serve.conf"].replace("0.0.0.0:8080", "127.0.0.1:0")
            token = os.path.join(folder, "token")
            with open(token, "w") as file:
                file.write("secret")
            with open(path, "w") as file:
                file.write(re.sub(r"listen = .*\n", "", text).replace("/run/secrets/animeme/token",
                    token))
            server = Server(PROGRAM, "--settings", path)
            pod = parts["Deployment"]["spec"]["template"]["spec"]
            for probe in ("readinessProbe", "livenessProbe", "startupProbe"):
                get = pod["containers"][0][probe]["httpGet"]
                self.assertEqual(server.ask(get["path"], headers={"Host": "10.1.2.3"})[0], 200)
            self.assertGreater(pod["terminationGracePeriodSeconds"], 30)
            self.assertEqual(server.end()[0], 0)
        with open(os.path.join(FOLDER, "compose.yaml")) as file:
            service = yaml.safe_load(file)["services"]["heads"]
        with open(os.path.join(FOLDER, "Dockerfile")) as file:
            docker = file.read()
        entry = json.loads(re.search(r"ENTRYPOINT (\[.*\])", docker)[1])
        for words in (service["command"], json.loads(re.search(r"CMD (\[.*\])$", docker, re.M)[1])):
            given = [word for word in entry[2:] + words]
            with tempfile.NamedTemporaryFile("w", suffix="token") as token:
                token.write("secret")
                token.flush()
                given = [token.name if word == "/run/secrets/token"
                    else word.replace("0.0.0.0:8080", "127.0.0.1:0")
                         for word in given]
                process = subprocess.Popen([PROGRAM, "serve", *given, "--json"],
                    stdout=subprocess.PIPE,
                                           stderr=subprocess.DEVNULL, text=True)
                self.assertIn("address", process.stdout.readline())
                process.send_signal(signal.SIGTERM)
                process.communicate(timeout=60)
                self.assertEqual(process.returncode, 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2, warnings="ignore")
