"""Programs without memory end with a sentence and an exit code of their own.  memory.py PROGRAM
[--all]

Each command runs under limits of its address space (ulimit -v) that lead from none of its libraries
to all of them, also where a library would end the process itself. No limit may end it by a signal
or with a code that is none of ours."""

import os
import resource
import subprocess
import sys
import tempfile

PROGRAM = sys.argv[1]
CODES = {0, 1, 2, 3, 4}
SEARCHED = 8  # limits between those that fail and those that do


def run(arguments, kilobytes):
    def limit():
        if kilobytes:
            resource.setrlimit(resource.RLIMIT_AS, (kilobytes * 1024, kilobytes * 1024))

    return subprocess.run([PROGRAM, *arguments], preexec_fn=limit, capture_output=True, text=True,
        errors="replace",
                          timeout=300)


def check(name, arguments, kilobytes):
    """True: it had enough."""
    done = run(arguments, kilobytes)
    if done.returncode not in CODES:
        raise SystemExit(
            f"{name} with {kilobytes} kB: exit code {done.returncode}: {done.stderr[-300:]}")
    if done.returncode and not done.stderr.strip():
        raise SystemExit(f"{name} with {kilobytes} kB: exit code {done.returncode} and no word")
    return done.returncode == 0


def main():
    with tempfile.TemporaryDirectory(prefix="memory-") as folder:
        wav, fap = os.path.join(folder, "a.wav"), os.path.join(folder, "a.fap")
        text = "Hello world, my mouth moves by numbers."
        os.environ["XDG_CACHE_HOME"] = folder
        if run(["speak", "--text", text, "-o", os.path.join(folder, "a.mp4")], 0).returncode:
            print("SKIPPED: no voice; apt install espeak-ng-data")
            return 77
        run(["demux", os.path.join(folder, "a.mp4"), "-o", wav], 0)
        commands = {
            "speak": ["speak", "--text", text, "-o", fap],
            "align": ["align", wav, "--transcript", text, "-o", os.path.join(folder, "a.tsv")],
            "listen": ["align", wav, "-o", os.path.join(folder, "a.tsv")],
        }
        if "--all" in sys.argv:
            commands["decode"] = ["decode", os.path.join(folder, "a.mp4"), "-o", fap]
            commands["view"] = ["view", os.path.join(folder, "a.mp4"), "-o",
                os.path.join(folder, "a.html")]
        for name, arguments in commands.items():
            if not check(name, arguments, 0):
                print(f"{name}: left out, as it does not work here")
                continue
            few, enough = 20_000, 2_000_000
            while enough - few > 1_000:
                middle = (few + enough) // 2
                few, enough = (few, middle) if check(name, arguments, middle) else (middle, enough)
            # Where it nearly works, all is loaded, and allocations of each size fail.
            for i in range(SEARCHED):
                check(name, arguments, enough - 1_000 - i * 2_000)
            print(f"{name}: {enough} kB are enough; less ends it with a sentence", flush=True)
    return 0


sys.exit(main())
