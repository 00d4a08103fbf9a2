"""Runs one file of tests by pytest; exit code 77 with a reason where something is missing.

run.py FILE [MODULES...]: the modules of Python that it needs besides NumPy and pytest.
"""
import importlib
import sys

PACKAGES = {"numpy": "python3-numpy", "pytest": "python3-pytest",
    "matplotlib": "python3-matplotlib"}

for name in ["numpy", "pytest", *sys.argv[2:]]:
    try:
        importlib.import_module(name)
    except ImportError:
        print(f"python: Skipped\n{name} is missing (Debian: {PACKAGES[name]})")
        sys.exit(77)

import pytest


class Skips:
    """Tells why as other tests do, for tests/skipped.sh."""

    @staticmethod
    def pytest_runtest_logreport(report):
        if report.skipped:
            print(f"\n{report.nodeid}: Skipped\n{report.longrepr[2].removeprefix('Skipped: ')}")


sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", sys.argv[1]], plugins=[Skips()]))
