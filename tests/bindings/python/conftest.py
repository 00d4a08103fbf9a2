"""What the tests share: where things are, clips made at random, a corpus that is quick to learn."""
import os
from pathlib import Path

import numpy as np
import pytest

import animeme

SOURCE = Path(os.environ["ANIMEME_SOURCE_DIR"])
BINARY = Path(os.environ["ANIMEME_BINARY_DIR"])
SAMPLE = SOURCE / "tests/data/grid_s1_sample"
CASES = BINARY / "conformance/cases"
PROGRAM = BINARY / "bin/animeme"


def random_clip(seed, frames=40, largest=400, rate=25):
    """A clip in which a random set of FAPs walks at random."""
    random = np.random.default_rng(seed)
    steps = random.integers(-largest // 8, largest // 8 + 1, (frames, 68))
    values = np.clip(np.cumsum(steps, axis=0), -largest, largest)
    mask = random.random(68) < 0.5
    mask[:2] = False
    mask[2] = True
    return animeme.Clip(values * mask, mask, rate)


@pytest.fixture(scope="session")
def sample_clip():
    return animeme.load(SAMPLE / "fap/prac8p.csv")


@pytest.fixture(scope="session")
def corpus():
    return animeme.Corpus(SAMPLE)


@pytest.fixture(scope="session")
def few(corpus):
    """Three sentences: learned in an instant."""
    return [corpus[i] for i in range(3)]
