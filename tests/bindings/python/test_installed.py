"""The package where others have it: installed, without the build tree."""
import importlib.util
import os
import shutil
import subprocess
import sys
import zipfile

import pytest

from conftest import BINARY, SAMPLE, SOURCE

PROGRAM = """
import sys
import animeme
assert animeme.__file__.startswith(sys.argv[1]), animeme.__file__
clip = animeme.load(sys.argv[2])
clip.save(sys.argv[3])
print(len(animeme.load(sys.argv[3])), animeme.Head().name, animeme.builtin_model().method)
"""


def check(folder, tmp_path):
    """It is whole in this folder, and the one that Python finds there."""
    files = {path.name.split(".")[0] for path in (folder / "animeme").iterdir()}
    assert files == {"__init__", "_animeme", "_types",
        "py"} and (folder / "animeme/__init__.pyi").exists()
    run = [sys.executable, "-B", "-c", PROGRAM, folder, SAMPLE / "fap/prac8p.csv",
        tmp_path / "a.mp4"]
    done = subprocess.run(run, capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(folder)})
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["75", "woman", "dam"]


def test_installed(tmp_path):
    prefix = tmp_path / "made"
    install = [os.environ["ANIMEME_CMAKE"], "--install", BINARY, "--component", "python",
        "--prefix", prefix]
    subprocess.run(install, check=True, capture_output=True)
    prefix.rename(tmp_path / "prefix")  # it works where it is found
    check(tmp_path / "prefix" / os.environ["ANIMEME_PYTHON_DIR"], tmp_path)


def test_a_wheel_of_pip(tmp_path):
    """Of what CMake has built; to build all of it takes minutes."""
    for name, package in {"pip": "python3-pip", "setuptools": "python3-setuptools",
        "wheel": "python3-wheel"}.items():
        if importlib.util.find_spec(name) is None:
            pytest.skip(f"{name} is missing (Debian: {package})")
    # pip leaves its files there
    shutil.copytree(SOURCE / "tools/bindings/python", tmp_path / "source")
    pip = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "--no-index",
        "-w", tmp_path, "."]
    done = subprocess.run(pip, capture_output=True, text=True, cwd=tmp_path / "source",
                          env={**os.environ, "ANIMEME_BUILD_DIR": str(BINARY)})
    assert done.returncode == 0, done.stdout + done.stderr
    (made,) = tmp_path.glob("animeme-*.whl")
    zipfile.ZipFile(made).extractall(tmp_path / "made")
    check(tmp_path / "made", tmp_path)
