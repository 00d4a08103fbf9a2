"""Corpora, training and evaluation; other threads and Ctrl-C meanwhile."""
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import animeme
from conftest import PROGRAM, SAMPLE

pytestmark = pytest.mark.filterwarnings("ignore::animeme.InputWarning")


@pytest.fixture(scope="module")
def model(few):
    return animeme.train(few)


def test_corpora_are_sequences_of_sentences(corpus):
    assert len(corpus) == 24 and corpus.ids == [sentence.id for sentence in corpus]
    sentence = corpus["prac8p"]
    assert sentence.id == corpus[corpus.ids.index("prac8p")].id == "prac8p"
    assert corpus[-1].id == corpus.ids[-1] and corpus.duration > 60
    assert sentence.values.shape == (75, len(sentence.names)) and sentence.measured.shape == (75,)
    assert sentence.names[0] == "fap3_open_jaw" and sentence.rate == 25
    assert sentence.fields["id"] == "prac8p" and isinstance(sentence.phones[0], animeme.Phone)
    assert (sentence.clip["open_jaw"] == np.round(sentence.values[:, 0])).all()
    for wrong, kind in ((24, IndexError), (-25, IndexError), ("nobody", KeyError),
        (1.5, TypeError)):
        with pytest.raises(kind):
            corpus[wrong]


def test_controls_by_number_or_name():
    corpus = animeme.Corpus(SAMPLE, controls=[3, "fap5_raise_b_midlip"])
    assert corpus[0].names == ["fap3_open_jaw", "fap5_raise_b_midlip"]
    with pytest.raises(ValueError):
        animeme.Corpus(SAMPLE, controls=[2])
    with pytest.raises(animeme.Error) as caught:
        animeme.Corpus(SAMPLE, controls=["nose"])
    assert caught.value.code == "not_found" and caught.value.position.file


def test_late_scripts(corpus):
    late = animeme.Corpus(SAMPLE, lag=0.1)
    assert late[0].phones[3].start == pytest.approx(corpus[0].phones[3].start + 0.1)


@pytest.mark.skipif(not PROGRAM.exists(), reason="the program is not built")
def test_the_model_is_that_of_the_program(tmp_path):
    corpus = animeme.Corpus(SAMPLE, controls=[3, 4, 5])
    ours = animeme.train(corpus, method="viseme")
    subprocess.run([PROGRAM, "train", SAMPLE, "--controls", "3-5", "--method", "viseme", "-o",
        tmp_path / "m.dam"],
                   check=True, capture_output=True)
    assert ours.to_bytes() == (tmp_path / "m.dam").read_bytes()
    assert ours == animeme.load_model(tmp_path / "m.dam")


def test_sentences_made_of_arrays_teach_the_same(few, model):
    made = [animeme.Sentence(s.id, s.phones, s.values, s.names, rate=s.rate, measured=s.measured)
        for s in few]
    assert animeme.train(made[::-1], threads=1) == model
    of_clips = [animeme.Sentence(s.id, [tuple(p) for p in s.phones], s.clip) for s in few]
    assert animeme.train(of_clips, method="mean").controls == model.controls


def test_models_say_what_they_are(model, tmp_path):
    assert model.method == "dam" and model.rate == 25 and "SIL" in model.phones
    assert model.training["utterances"] == 3 and "3 utterances" in model.provenance
    model.save(tmp_path / "m.dam")
    again = animeme.load_model(tmp_path / "m.dam")
    assert again == model and again.training == {} and pickle.loads(pickle.dumps(model)) == model
    assert animeme.Model.from_bytes(memoryview(model.to_bytes())) == model
    assert "GRID" in animeme.builtin_model().attribution
    with pytest.raises(animeme.Error) as caught:
        animeme.Model.from_bytes(model.to_bytes()[:-1])
    assert caught.value.code in ("syntax", "truncated")
    with pytest.raises(animeme.Error) as caught:
        animeme.load_model(tmp_path / "none.dam")
    assert caught.value.code == "not_found" and caught.value.position.file == str(
        tmp_path / "none.dam")


def test_a_base_is_bent(few):
    bent = animeme.train(few, base=animeme.builtin_model(), attribution="me")
    assert bent.method == "dam" and "me" in bent.attribution and "GRID" in bent.attribution


def test_progress_is_told_and_may_end_it(few):
    told = []
    animeme.train(few, progress=lambda share, stage: told.append((share, stage)))
    assert {stage for _, stage in told} >= {"dominance", "curves"} and all(0 <= s <= 1 for s,
        _ in told)

    def enough(share, stage):
        calls.append(stage)
        raise LookupError("enough")

    calls = []
    with pytest.raises(LookupError, match="enough"):
        animeme.train(few, progress=enough)
    with pytest.raises(LookupError, match="enough"):
        animeme.evaluate(animeme.builtin_model(), few, progress=enough)
    assert len(calls) == 2


def test_what_cannot_be_learned_is_an_error(few, tmp_path):
    with pytest.raises(animeme.Error) as caught:
        animeme.train([])
    assert caught.value.code == "invalid_argument"
    with pytest.raises(ValueError, match="method"):
        animeme.train(few, method="deep")
    with pytest.raises(animeme.Error):
        animeme.train(few, max_iterations=-1)
    for wrong in ([1, 2], "text", None):
        with pytest.raises(TypeError):
            animeme.train(wrong)
    with pytest.raises(ValueError):
        animeme.Sentence("a", [(0, 1, "P")], np.zeros((3, 2)), ["one"])
    (tmp_path / "utterances.tsv").write_text("id\ta\tb\nx\t1\n")
    with pytest.raises(animeme.Error) as caught:
        animeme.Corpus(tmp_path)
    assert caught.value.position.file.startswith(str(tmp_path))


def test_warnings_are_warnings(few):
    with pytest.warns(animeme.InputWarning, match="few examples"):
        animeme.train(few, method="mmm")


def test_evaluation(corpus, model, few):
    found = animeme.evaluate(model, corpus, sharpness=0, seen=few)
    assert found.sentences == 24 and 0.2 < found.nrmse < found.still_nrmse
    assert 0 <= found.closed <= 1 and 0 < found.correlation < 1 and "mean NRMSE" in str(found)
    assert found.to_dict()["mean"]["nrmse"] == found.nrmse if "mean" in found.to_dict() else True
    assert animeme.evaluate(model, few, threads=1).nrmse == animeme.evaluate(model, few,
        threads=3).nrmse


@pytest.mark.skipif(not PROGRAM.exists(), reason="the program is not built")
def test_the_evaluation_is_that_of_the_program(corpus):
    import json
    ours = animeme.evaluate(animeme.builtin_model(), corpus).to_dict()
    done = subprocess.run([PROGRAM, "evaluate", "builtin", SAMPLE, "--json"], check=True,
        capture_output=True)
    its = json.loads(done.stdout)
    ours.pop("system", None), its.pop("system", None), ours.pop("model", None), its.pop("model",
        None)
    assert ours == its


def test_other_threads_run_while_it_learns(few):
    count, stop, learning = [0], threading.Event(), threading.Event()

    def work():
        learning.wait()
        while not stop.is_set():
            count[0] += 1
            time.sleep(0.001)

    worker = threading.Thread(target=work)
    worker.start()
    learning.set()
    animeme.train(few)
    counted = count[0]
    stop.set()
    worker.join()
    assert counted > 20  # with the interpreter held: once, twice


INTERRUPTED = """
import os, signal, sys, threading, time, warnings
import animeme
warnings.simplefilter("ignore")
corpus = animeme.Corpus(sys.argv[1])
stages = {}
def interrupt():
    while not stages:
        time.sleep(0.001)
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt, daemon=True).start()
try:
    # A function of C, in which no signal is looked at: that is the module's own work.
    animeme.train(corpus, progress=stages.setdefault)
except KeyboardInterrupt:
    print("interrupted", len(stages))
    print(animeme.train([corpus[0], corpus[1]], method="mean").method)
"""


def test_ctrl_c_ends_a_training():
    run = subprocess.run([sys.executable, "-c", INTERRUPTED, str(SAMPLE)], capture_output=True,
        text=True, timeout=100)
    assert run.returncode == 0, run.stderr
    word, stages, method = run.stdout.split()
    assert word == "interrupted" and method == "mean"
    assert int(stages) < 7  # of ten that a whole training has
