"""Mutated and cut files through the commands that read them.  files.py PROGRAM [--number N] [--seed S]

A mutation flips, repeats, removes or replaces bytes, or cuts the end. Whatever comes of it: the program ends by itself
with an exit code of its own and, if it refuses, with a sentence; within a limit of memory and CPU time."""

import argparse
import os
import random
import resource
import subprocess
import sys
import tempfile

MEMORY = 1_500_000 << 10
SECONDS = 60  # of CPU

SPECIAL = [b"\0" * 4, b"\xff" * 4, b"\x7f\xff\xff\xff", b"\x80\0\0\0", b"1e999", b"-1", b"nan", b"\0\0\x01\xb1", b"{", b"]", b"\n"]


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

        return subprocess.run([options.program, *arguments], preexec_fn=limit, capture_output=True, timeout=600)

    with tempfile.TemporaryDirectory(prefix="files-") as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        path = lambda name: os.path.join(folder, name)
        with open(path("s.tsv"), "w") as out:
            out.write("0 0.1 SIL\n0.1 0.3 B\n0.3 0.8 AA\n0.8 1.0 M\n")
        kinds = ["fap", "fba", "csv", "mp4", "mkv", "ts"]
        for kind in kinds:
            made = run("speak", "--script", path("s.tsv"), "-o", path("a." + kind))
            assert made.returncode == 0, made.stderr
        commands = {kind: ["info", "IN"] for kind in kinds}
        commands |= {"fap": ["encode", "IN", "-o", path("o.fba")], "fba": ["decode", "IN", "-o", path("o.fap")],
                     "mp4": ["demux", "IN", "--face", path("o.fba")], "csv": ["import", "IN", "-o", path("o.fap")],
                     "tsv": ["speak", "--script", "IN", "-o", path("o.fap")]}
        seeds = {}
        for kind in commands:
            with open(path(("s." if kind == "tsv" else "a.") + kind), "rb") as file:
                seeds[kind] = file.read()
        rng = random.Random(options.seed)
        refused = 0
        for number in range(options.number):
            kind = rng.choice(sorted(commands))
            data = mutated(seeds[kind], rng)
            with open(path("in." + kind), "wb") as out:
                out.write(data)
            done = run(*[path("in." + kind) if word == "IN" else word for word in commands[kind]])
            said = done.stderr.decode(errors="replace").strip()
            if done.returncode not in (0, 1, 2, 3) or (done.returncode > 1 and not said):
                kept = f"attack-{options.seed}-{number}.{kind}"
                with open(kept, "wb") as out:
                    out.write(data)
                raise SystemExit(f"{' '.join(commands[kind])}: exit code {done.returncode}: {said[-300:]}; see {kept}")
            refused += done.returncode != 0
        print(f"{options.number} files, {refused} of them refused")


sys.exit(main())
