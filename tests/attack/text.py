"""Texts of repeated characters: time and memory grow as they do.  text.py PROGRAM [--number N]
[--seed S]

Each pattern is repeated to three sizes, each twice the one before, and spoken with at most 400 MB.
The CPU time of the program and its children grows at most 2.5 times from size to size, and the
longest text that is documented (100,000 characters) is spoken or refused within SECONDS of CPU
time. A sentence about memory is a refusal. Without --number all patterns run, some minutes."""

import argparse
import os
import random
import resource
import subprocess
import sys
import tempfile

SIZES = (5_000, 10_000, 20_000)
MOST = 100_000
SECONDS = 30  # of CPU; an hour of speech takes 5 on an idle machine
MEMORY = 400_000 << 10
QUICK = 0.4  # seconds of CPU that say nothing of growth
GROWTH = 2.5
TRIES = 4

SINGLE = list("0179.,:;!?-_+*/\\=<>()[]{}&%$#@^~|\"'` \n\tabzAZ") + list("éßøžДаλאع中あア한กऀ") + [
    "\u00a0", "\u200b", "\u200d", "\u0301", "\ufeff", "\ufffd", "\U0001f600", "\U0001f1e9",
    "\u2026", "\u2014", "½", "²", "€"]
LONGER = ["1,", "1.", "1-", "-1", "1/", "1:", "1 ", "10 ", "1e", "1%", "$1", "1st ", "0x", "1'",
    "1\n", "1,000", "1.5 ",
          "1-2 ", "12:30 ", "1/2/3 ", "a.", "a-", "a'", "a ", "ab ", "A.", "Dr. ", "St. ", "a@b.c ",
          "www.a.b ", "http://",
          "http://a.b/c ", "#a ", "@a ", "&a;", "&amp;", "&#1;", "<a>", "</a>", "<a", "a>", "<b/>",
          "<!--", "-->", "<?", "?>",
          "<![CDATA[", "]]>", "[[", "]]", "[[a]]", "{a}", "(a)", "(((", ")))", "[a] ", "*a* ", "**",
          "_a_", "~a~", "a\n", "\n\n",
          "a\t", "...", "?!", "!!", ", ", ". ", "; ", "-- ", "- ", " -", "a- ", "“", "”a", "«a»",
          "a’b ", "'a' ", "\"a\" ", "…a",
          "0.", ".0", "00", "01 ", "1a", "a1", "1A2b", "IV ", "XVII ", "km ", "1km ", "5°C ", "€5 ",
          "5€", "100% ", "+49 ",
          "+1-800-", "1,2,3", "1;2", "1_000", "1’000 ", "１", "١", "१", "中1", "1中", "中。", "中 a ",
          "あア", "한 ", "ก ", "אa",
          "عa ", "é ", "e\u0301", "a\u0301\u0301", "\u200da", "\U0001f600 ",
          "\U0001f468\u200d\U0001f469\u200d", "\U0001f1e9\U0001f1ea",
          "☺", "♪", "♪ a ", ":) ", ":-) ", "<3 ", "->", "=> ", "==", "!=", "a=b ", "a+b ", "a*b",
          "a/b ", "a\\b ", "a|b", "{{", "}}",
          "%20", "\\n", "\\u0041", "$a ", "${a}", "`a` ", "the ", "I ", "a, ", "a. ", "a! ", "a? ",
          "no. ", "No. 1 ", "1 000 ", "1.000.",
          "1/2 ", "½ ", "2² ", "12.12.2012 ", "2012-12-12 ", "12:30:30 ", "1h ", "1 h ", "1 - 1 ",
          "1+1=2 ", "x^2 ", "H2O ", "C++ ",
          "A/B ", "24/7 ", "9-5 ", "MP4 ", "v1.2.3 ", "ISBN 1-", "127.0.0.1 ", "::1 ",
          "00:00:00,000 --> ", "\r\n", "\f", "a\fb "]


def run(program, text, folder):
    """CPU seconds of the program and its children."""
    path = os.path.join(folder, "a.txt")
    with open(path, "w", encoding="utf-8", newline="") as out:
        out.write(text)

    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (4 * SECONDS, 4 * SECONDS))

    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, "speak", "--text-file", path, "-o",
        os.path.join(folder, "a.fap")],
                          preexec_fn=limit, capture_output=True, text=True, errors="replace",
                          timeout=900)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    refused = done.returncode == 3 and "error: " in done.stderr or "not enough memory" in done.stderr
    if done.returncode and not refused:
        raise SystemExit(
            f"{text[:20]!r} x {len(text)}: exit code {done.returncode}: {done.stderr[-300:]}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def repeated(pattern, size):
    return (pattern * (size // len(pattern) + 1))[:size]


def main():
    reading = argparse.ArgumentParser()
    reading.add_argument("program")
    reading.add_argument("--number", type=int)
    reading.add_argument("--seed", type=int, default=47)
    options = reading.parse_args()
    patterns = SINGLE + LONGER
    assert len(patterns) >= 200, len(patterns)
    if options.number:
        patterns = random.Random(options.seed).sample(patterns, options.number)
    with tempfile.TemporaryDirectory(prefix="text-") as folder:
        os.environ["XDG_CACHE_HOME"] = folder
        for pattern in patterns:
            times = [run(options.program, repeated(pattern, size), folder) for size in SIZES]
            for i in range(1, len(SIZES)):
                for _ in range(TRIES):  # what else the machine does is not ours
                    if times[i] <= max(QUICK, GROWTH * times[i - 1]):
                        break
                    for k in (i - 1, i):
                        times[k] = min(times[k], run(options.program, repeated(pattern, SIZES[k]),
                            folder))
                else:
                    raise SystemExit(
                        f"{pattern!r}: {times[i - 1]:.2f} s for {SIZES[i - 1]} characters, {times[i]:.2f} s "
                                     f"for {SIZES[i]}")
            longest = run(options.program, repeated(pattern, MOST), folder)
            if longest > SECONDS:
                raise SystemExit(f"{pattern!r}: {longest:.1f} s for {MOST} characters")
            print(f"{pattern!r}: " + ", ".join(f"{one:.2f}" for one in [*times, longest]) + " s",
                flush=True)


main()
