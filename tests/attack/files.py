"""Mutated and cut files through the commands that read them.  files.py PROGRAM [--number N] [--seed
S]

A mutation flips, repeats, removes or replaces bytes, or cuts the end. Whatever comes of it: the
program ends by itself with an exit code of its own and, if it refuses, with a sentence; within a
limit of memory and CPU time."""

import argparse
import os
import random
import resource
import subprocess
import sys
import tempfile

MEMORY = 400_000 << 10
DATA = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SECONDS = 60  # of CPU

SPECIAL = [b"\0" * 4, b"\xff" * 4, b"\x7f\xff\xff\xff", b"\x80\0\0\0", b"1e999", b"-1", b"nan",
    b"\0\0\x01\xb1", b"{", b"]", b"\n"]


def mutated(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 5, 20))):
        if not data:
            break
        at = rng.randrange(len(data))
        kind = rng.randrange(6)
        if kind == 0:
            data[at] ^= 1 << rng.randrange(8)
        elif kind == 1:
            data[at] = rng.randrange(256)
        elif kind == 2:
            del data[at:at + rng.randrange(1, 64)]
        elif kind == 3:
            data[at:at] = data[at:at + rng.randrange(1, 64)] * rng.choice((1, 1, 1, 50))
        elif kind == 4:
            special = rng.choice(SPECIAL)
            data[at:at + len(special)] = special
        else:
            del data[at:]
    return bytes(data)


def main():
    reading = argparse.ArgumentParser()
    reading.add_argument("program")
    reading.add_argument("--number", type=int, default=120)
    reading.add_argument("--seed", type=int, default=47)
    options = reading.parse_args()

    def run(*arguments):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))

        return subprocess.run([options.program, *arguments], preexec_fn=limit, capture_output=True,
            timeout=600)

    with tempfile.TemporaryDirectory(prefix="files-") as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        path = lambda name: os.path.join(folder, name)
        with open(path("s.tsv"), "w") as out:
            out.write("0 0.1 SIL\n0.1 0.3 B\n0.3 0.8 AA\n0.8 1.0 M\n")
        kinds = ["fap", "fba", "csv", "mp4", "mkv", "ts"]
        for kind in kinds:
            made = run("speak", "--script", path("s.tsv"), "-o", path("a." + kind))
            assert made.returncode == 0, made.stderr
        two = run("mux", "--track", f"lang=en,face={path('a.fba')}", "--track",
            f"lang=de,speaker=Ann,face={path('a.fba')}", "-o",
                  path("two.mp4"))
        files = {path("a." + kind): ["info", "edit", "over"] for kind in kinds}
        files[path("a.fap")] += ["encode"]
        files[path("a.fba")] += ["decode"]
        files[path("a.mp4")] += ["demux"]
        files[path("a.csv")] = ["import"]
        files[path("s.tsv")] = ["speak"]
        if two.returncode == 0:
            files[path("two.mp4")] = ["info", "track"]
        files = {name: what for name, what in files.items() if os.path.isfile(name)}
        own = list(files)
        for place in ("fuzz/corpus/c3d", "data/captures_broken"):
            for found in sorted(os.listdir(os.path.join(DATA, place))):
                if found.endswith((".c3d", ".csv", ".json", ".npy")):
                    files[os.path.join(DATA, place, found)] = ["import"]
        commands = {"info": ["info", "IN"], "encode": ["encode", "IN", "-o", path("o.fba")],
                    "decode": ["decode", "IN", "-o", path("o.fap")],
                    "demux": ["demux", "IN", "--face", path("o.fba")],
                    "import": ["import", "IN", "-o", path("o.fap")],
                    "speak": ["speak", "--script", "IN", "-o", path("o.fap")],
                    "edit": ["edit", "IN", "--from", "0.1", "--scale", "lips=0.5", "-o",
                    path("o.fba")],
                    "over": ["speak", "--script", path("s.tsv"), "--over", "IN", "-o",
                    path("o.fap")],
                    "track": ["demux", "IN", "--track", "lang=de", "--face", path("o.fba")]}
        seeds = {}
        for name in files:
            with open(name, "rb") as file:
                seeds[name] = file.read()
        rng = random.Random(options.seed)
        refused = 0
        for number in range(options.number):
            name = rng.choice(rng.choice((own, sorted(files))))
            command = commands[rng.choice(files[name])]
            given = path("in" + os.path.splitext(name)[1])
            data = mutated(seeds[name], rng)
            with open(given, "wb") as out:
                out.write(data)
            done = run(*[given if word == "IN" else word for word in command])
            said = done.stderr.decode(errors="replace").strip()
            if done.returncode not in (0, 1, 2, 3) or (done.returncode > 1 and not said):
                kept = f"attack-{options.seed}-{number}{os.path.splitext(name)[1]}"
                with open(kept, "wb") as out:
                    out.write(data)
                raise SystemExit(
                    f"{' '.join(command)}: exit code {done.returncode}: {said[-300:]}; see {kept}")
            refused += done.returncode != 0
        print(f"{options.number} files, {refused} of them refused")


sys.exit(main())
