"""The Python examples of the pages run as they stand, in a folder that has the files that they
name."""
import re
import shutil

import pytest

from conftest import SAMPLE, SOURCE


def block_of(page):
    return re.search(r"^```python\n(.*?)^```", (SOURCE / page).read_text(), re.S | re.M)[1]


def with_splits(folder):
    """The sample as a corpus with the splits that the page names."""
    shutil.copytree(SAMPLE, folder)
    table = folder / "utterances.tsv"
    assert "train" in table.read_text() and "test" in table.read_text()


@pytest.mark.parametrize("page", ["README.md", "tools/bindings/python/README.md"])
def test_page(page, tmp_path, monkeypatch, capsys):
    for name in ("talk.mp4", "hello.mp4"):
        shutil.copy(SOURCE / "tools/release/samples/talk.mp4", tmp_path / name)
    with_splits(tmp_path / "my_corpus")
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(compile(block_of(page), page, "exec"), names)
    capsys.readouterr()
    clip = names["clip"]
    import animeme
    assert (clip["open_jaw"] == 2 * animeme.load("talk.mp4")["open_jaw"]).all()
    written = [path.name for path in tmp_path.glob("*.livelink.csv")]
    assert len(written) == 1 and len(animeme.load(written[0])) == len(clip)
    if page != "README.md":
        assert names["vertices"].shape[0] == len(clip) and len(names["weights"]) == len(clip)
