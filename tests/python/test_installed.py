"""The package where others have it: installed, without the build tree."""
import os
import subprocess
import sys

from conftest import BINARY, SAMPLE

PROGRAM = """
import sys
import animeme
assert animeme.__file__.startswith(sys.argv[1]), animeme.__file__
clip = animeme.load(sys.argv[2])
clip.save(sys.argv[3])
print(len(animeme.load(sys.argv[3])), animeme.Head().name, animeme.builtin_model().method)
"""


def test_installed(tmp_path):
    prefix = tmp_path / "made"
    install = [os.environ["ANIMEME_CMAKE"], "--install", BINARY, "--component", "python", "--prefix", prefix]
    subprocess.run(install, check=True, capture_output=True)
    prefix.rename(tmp_path / "prefix")  # it works where it is found
    folder = tmp_path / "prefix" / os.environ["ANIMEME_PYTHON_DIR"]
    assert sorted(path.name.split(".")[0] for path in (folder / "animeme").iterdir()) == [
        "__init__", "__init__", "_animeme", "_types", "py"]
    run = [sys.executable, "-B", "-c", PROGRAM, folder, SAMPLE / "fap/prac8p.csv", tmp_path / "a.mp4"]
    done = subprocess.run(run, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(folder)})
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["75", "woman", "dam"]
