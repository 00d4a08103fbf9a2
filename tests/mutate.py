#!/usr/bin/env python3
"""Can the tests of a module fail? Changes one operator of its sources at a time and runs the
module's own tests.

    tests/mutate.py fap --seed 1 --number 20            # in build/release
    tests/mutate.py tools/formats/exchange --tests test_exchange --build build/files
    tests/mutate.py tools/speech                        # the tests of each file's folder
    tests/mutate.py fap --at fap/arkit.cpp:118          # each operator of one line

Files whose folder has no tests of its own (tools/formats/inspect: test_tools) are left out unless
--tests names some. A change that no test notices is a survivor: a missing test, or no fault (a
guard that is reached by nothing, two ways to the same result). The file is put back after each
change, also on Ctrl-C and SIGTERM; a killed run is put back by the next one. Exit code 1: more
survivors than --most-survivors."""

import argparse
import json
import os
import random
import re
import signal
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
OTHER = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&",
    "+": "-", "-": "+",
         "*": "/", "/": "*", "%": "*", "+=": "-=", "-=": "+=", "&": "|", "|": "&"}
# Formatted code has blanks around the operators of two operands, and none in templates.
OPERATOR = re.compile(r"(?<= )(" + "|".join(re.escape(one) for one
    in sorted(OTHER, key=len, reverse=True)) + r")(?= )")
# As tests/CMakeLists.txt names them; others are called after the folder. The longest prefix counts.
TESTS = {"fap/head": ["test_head"], "fap/xml": ["test_xml"],
         "tools/formats/media": ["test_media", "test_live"],
         "tools/formats/inspect": [], "tools/formats/programs": [],
         "tools/speech/talking": ["test_speech"]}
# Folders of modules.
LAYERS = {"tools/formats", "tools/speech", "tools/view", "tools/live"}


def code_only(text):
    """The same length, without comments, texts and lines of the preprocessor."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match.group())

    text = re.sub(
        r'R"\((?:.|\n)*?\)"|//[^\n]*|/\*(?:.|\n)*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'',
        blank, text)
    return re.sub(r"^[ ]*(#|static_assert|template|using)[^\n]*", blank, text, flags=re.M)


def module_of(path):
    """The folder whose tests are those of a file: one of TESTS, of a layer, or at the top."""
    for folder in sorted(TESTS, key=len, reverse=True):
        if path.startswith(folder + "/"):
            return folder
    parts = path.split("/")
    return "/".join(parts[:3] if "/".join(parts[:2]) in LAYERS else parts[:1])


def tests_of(path):
    module = module_of(path)
    return TESTS.get(module, ["test_" + os.path.basename(module)])


def sources(module, tests):
    """Those of a module without modules below it that have tests of their own; of a layer all that
    have tests."""
    found = subprocess.run(["git", "ls-files", module], cwd=ROOT, capture_output=True, text=True,
        check=True).stdout.split()
    return [one for one in found if one.endswith(".cpp") and (tests or tests_of(one))
        and (module in LAYERS or module_of(one) == module_of(module + "/"))]


def places_in(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        text = file.read()
    for match in OPERATOR.finditer(code_only(text)):
        yield path, match.start(), match.group(), text.count("\n", 0, match.start()) + 1


class Changed:
    """A file with one operator changed, as long as the block lasts; a note of it is in the build
    folder."""

    def __init__(self, note, path, at, old):
        self.note, self.path = note, os.path.join(ROOT, path)
        self.at, self.old = at, old

    def __enter__(self):
        with open(self.path, encoding="utf-8", newline="") as file:
            self.text = file.read()
        assert self.text[self.at:self.at + len(self.old)] == self.old
        with open(self.note, "w", encoding="utf-8") as file:
            json.dump({"path": self.path, "text": self.text}, file)
            file.flush()
            os.fsync(file.fileno())
        changed = self.text[:self.at] + OTHER[self.old] + self.text[self.at + len(self.old):]
        with open(self.path, "w", encoding="utf-8", newline="") as file:
            file.write(changed)

    def __exit__(self, *_):
        put_back(self.note)


def put_back(note):
    if not os.path.exists(note):
        return
    with open(note, encoding="utf-8") as file:
        kept = json.load(file)
    with open(kept["path"], "w", encoding="utf-8", newline="") as file:
        file.write(kept["text"])
    os.remove(note)


def run(command, seconds):
    """Exit code; None: it took too long. Children end with it."""
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
                               start_new_session=True)
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        return None
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def main():
    reading = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    reading.add_argument("module")
    reading.add_argument("--seed", type=int, default=1)
    reading.add_argument("--number", type=int, default=10)
    reading.add_argument("--skip", type=int, default=0, help="so many of the sample were done")
    reading.add_argument("--at", help="FILE:LINE")
    reading.add_argument("--build", default="build/release")
    reading.add_argument("--tests", help="test programs, separated by commas")
    reading.add_argument("--filter", default="*", help="of GoogleTest")
    reading.add_argument("--jobs", default="2")
    reading.add_argument("--most-survivors", type=int)
    options = reading.parse_args()
    module = options.module.rstrip("/")
    given = options.tests.split(",") if options.tests else None
    build = os.path.join(ROOT, options.build)
    note = os.path.join(build, "mutated.json")
    put_back(note)  # of a run that was killed
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: sys.exit(130))  # by way of Changed.__exit__()

    all_places = [place for path in sources(module, given) for place in places_in(path)]
    if options.at:
        path, line = options.at.rsplit(":", 1)
        chosen = [place for place in all_places if place[0] == path and place[3] == int(line)]
    else:
        chosen = random.Random(options.seed).sample(all_places,
            min(options.number, len(all_places)))[options.skip:]

    def make(tests):
        return ["cmake", "--build", build, "-j", options.jobs, "--target", *tests]

    def test(one):
        return [os.path.join(build, "bin", one), "--gtest_filter=" + options.filter]

    used = given or sorted({one for place in chosen for one in tests_of(place[0])})
    if run(make(used), None) != 0:
        raise SystemExit("the module does not build as it is: " + " ".join(make(used)))
    patience = {}
    for one in used:
        begun = time.monotonic()
        if run(test(one), None) != 0:
            raise SystemExit(f"{one} fails as it is")
        patience[one] = 60 + 5 * (time.monotonic() - begun)

    noticed, survivors = 0, []
    for path, at, old, line in chosen:
        tests = given or tests_of(path)
        with Changed(note, path, at, old):
            how = ""
            if run(make(tests), None) != 0:
                how = "by the compiler"
            for one in tests if not how else ():
                code = run([*test(one), "--gtest_fail_fast"], patience[one])
                if code != 0:
                    how = "as it took too long" if code is None else f"by {one}"
                    break
        what = f"{path}:{line}: {old} to {OTHER[old]}"
        print(f"{what}: noticed {how}" if how else f"{what}: NOT NOTICED", flush=True)
        noticed += bool(how)
        if not how:
            survivors.append(what)
    run(make(used), None)
    print(f"{noticed} of {len(chosen)} changes noticed ({len(all_places)} operators)")
    if options.most_survivors is not None and len(survivors) > options.most_survivors:
        raise SystemExit("not noticed: " + "; ".join(survivors))


if __name__ == "__main__":
    main()
