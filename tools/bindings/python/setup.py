"""What pyproject.toml cannot say: the module is made by CMake.

ANIMEME_BUILD_DIR names a tree in which it is built already, for this Python; CMAKE_ARGS are for a
new one.
"""
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parents[3]
SETTINGS = {"CMAKE_BUILD_TYPE": "Release", "CMAKE_UNITY_BUILD": "ON",
    "CMAKE_UNITY_BUILD_BATCH_SIZE": 16,
            "ANIMEME_BUILD_PYTHON": "ON", "ANIMEME_BUILD_TESTS": "OFF", "ANIMEME_BUILD_C": "OFF",
            "Python3_EXECUTABLE": sys.executable}


def cmake(*arguments):
    subprocess.run(["cmake", *map(str, arguments)], check=True)


class ByCMake(build_ext):
    def build_extension(self, extension):
        made = os.environ.get("ANIMEME_BUILD_DIR")
        tree = Path(made or Path(self.build_temp) / "cmake").resolve()
        if not made:
            settings = dict(SETTINGS)
            try:
                import pybind11
                settings["pybind11_DIR"] = pybind11.get_cmake_dir()
            except ImportError:
                pass  # that of the system, then
            cmake("-S", ROOT, "-B", tree, *(f"-D{name}={value}" for name,
                value in settings.items()),
                  *shlex.split(os.environ.get("CMAKE_ARGS", "")))
            cmake("--build", tree, "--target", "animeme_python", "--parallel", os.cpu_count() or 1)
        with tempfile.TemporaryDirectory() as prefix:
            cmake("--install", tree, "--component", "python", "--prefix", prefix)
            package = next(Path(prefix).rglob("__init__.py")).parent
            shutil.copytree(package, Path(self.build_lib) / "animeme", dirs_exist_ok=True)


def version():
    lists = ROOT / "CMakeLists.txt"
    cache = Path(os.environ.get("ANIMEME_BUILD_DIR", "")) / "CMakeCache.txt"
    if cache.exists():
        return re.search(r"CMAKE_PROJECT_VERSION:STATIC=(\S+)", cache.read_text())[1]
    return re.search(r"animeme VERSION (\S+)", lists.read_text())[1]


setup(version=version(), packages=[], ext_modules=[Extension("animeme._animeme", [])],
    cmdclass={"build_ext": ByCMake})
