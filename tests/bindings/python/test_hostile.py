"""Wrong types, shapes and sizes: each is an exception of Python, and none ends the interpreter."""
import itertools
import random
import subprocess
import sys

import numpy as np
import pytest

import animeme
from conftest import random_clip

ODD = [None, True, -1, 0, 1e308, float("nan"), float("inf"), 2**63, 2**200, "", "\0", "\ud800",
    "a" * 100_000, b"", b"\0" * 1000,
       [], [[]], {}, (), object(), object, np.zeros(0), np.zeros((0, 68)), np.zeros((3, 67)),
       np.zeros((2, 68, 2)),
       np.full((2, 68), np.nan), np.full((2, 68), 2.0**40), np.zeros((2, 68), dtype=complex),
       np.zeros((2, 68), dtype=object),
       np.zeros((2, 68), dtype="U3"), np.zeros((68, 2)).T, np.zeros((4, 68))[::-2], np.array("x"),
       np.ma.masked,
       np.broadcast_to(np.int32(1), (2**20, 2**20)), memoryview(b"abc"), range(10), iter([1, 2])]
ALLOWED = (animeme.Error, TypeError, ValueError, KeyError, IndexError, OverflowError, MemoryError,
    OSError, AttributeError,
           NotImplementedError, UnicodeError, BufferError)


def tried(call, *arguments, **named):
    try:
        return call(*arguments, **named)
    except ALLOWED as error:
        assert type(error) is not Exception
        return None


def test_each_function_answers_each_odd_value():
    functions = [animeme.load, animeme.read, animeme.decode, animeme.encode, animeme.read_script,
        animeme.load_model, animeme.Clip,
                 animeme.Corpus, animeme.Decoder, animeme.Encoder, animeme.Model, animeme.train]
    for function in functions:
        for value in ODD:
            tried(function, value)
        for first, second in itertools.product(ODD[:12], ODD[12:30]):
            tried(function, first, second)


def test_clips_take_no_wrong_arrays():
    clip = random_clip(3)
    kept = clip.values.copy()
    for name, value in itertools.product(("values", "mask", "viseme", "expression", "numbers",
        "rate"), ODD):
        try:
            setattr(clip, name, value)
        except ALLOWED:
            continue
        clip = random_clip(3)  # it was one of the right kind
    for key, value in itertools.product(["open_jaw", "x", 0, -1, 10**9, None, slice(None), 2.5],
        ODD[:20]):
        try:
            clip[key] = value
        except ALLOWED:
            continue
        clip = random_clip(3)
    assert (random_clip(3).values == kept).all() and len(clip) == len(kept)
    for key in (10**9, -10**9, "x", None, 1.5, slice(None, None, 0), object()):
        tried(clip.__getitem__, key)


def test_streams_that_are_cut_or_changed_anywhere():
    stream = bytes(animeme.encode(random_clip(5)))
    rng = random.Random(47)
    whole = animeme.decode(stream)
    for at in range(0, len(stream), 7):
        cut = tried(animeme.decode, stream[:at])
        assert cut is None or len(cut) <= len(whole)
    for _ in range(300):
        data = bytearray(stream)
        for _ in range(rng.choice((1, 3, 30))):
            data[rng.randrange(len(data))] = rng.randrange(256)
        tried(animeme.decode, bytes(data))
    # The bytes may change under a decoder that has been given them.
    data = bytearray(stream)
    decoder = animeme.Decoder()
    tried(decoder.push, memoryview(data)[::2])
    tried(decoder.push, data)
    data[:] = bytes(len(data))
    tried(list, decoder)


def test_an_interpreter_survives_the_lack_of_memory():
    """Under limits of the address space: exceptions, and no end of the process by a library."""
    code = """
import resource, sys
import numpy, animeme
def attempt(what):
    try:
        what()
    except (animeme.Error, MemoryError, OSError, ImportError) as error:
        print(type(error).__name__)
pages = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()
for more in (1, 4, 16, 40, 80, 160):
    resource.setrlimit(resource.RLIMIT_AS, (pages + (more << 20), resource.RLIM_INFINITY))
    attempt(lambda: animeme.Clip(numpy.zeros((100_000, 68))))
    attempt(lambda: animeme.builtin_model().speak([animeme.Phone(0.0, 1.0, 'AA')] if False else 'hello world'))
resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
print('alive')
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=250)
    assert done.returncode == 0 and done.stdout.rstrip().endswith("alive"), (done.returncode,
        done.stderr[-500:])
