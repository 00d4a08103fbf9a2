"""Finds and runs `animeme`."""

import os
import shutil
import subprocess
import sys


class Trouble(Exception):
    """What a person should read: the file, what is wrong, what helps."""


REMEDY = "set it in Edit > Preferences > Add-ons > Animeme faces"
NAME = "animeme.exe" if sys.platform == "win32" else "animeme"


def find(setting=""):
    """The program's path: the preference, then PATH, then beside the add-on. Trouble if it is
    nowhere."""
    if setting:
        path = os.path.expanduser(setting)
        if os.path.isdir(path):
            path = os.path.join(path, NAME)
        if os.path.isfile(path):
            return path
        raise Trouble(f"{setting}: no such program; " + REMEDY)
    folder = os.path.dirname(os.path.abspath(__file__))
    beside = (os.path.join(where, NAME) for where in (folder, os.path.join(folder, "bin"),
        os.path.dirname(folder)))
    found = shutil.which(NAME) or next(filter(os.path.isfile, beside), None)
    if found:
        return found
    raise Trouble("The program animeme is not in PATH; " + REMEDY)


def run(program, *arguments):
    """Standard output of a command. Trouble with its last words if it fails."""
    # No window of a console beside Blender's.
    options = {"creationflags": subprocess.CREATE_NO_WINDOW} if sys.platform == "win32" else {}
    try:
        done = subprocess.run([program, "-q", *arguments], stdin=subprocess.DEVNULL,
            capture_output=True, check=False,
                              **options)
    except OSError as error:
        raise Trouble(f"{program}: {error.strerror}; " + REMEDY) from error
    if done.returncode == 0:
        return done.stdout
    words = done.stderr.decode("utf-8",
        "replace").strip().splitlines() or [f"ended with {done.returncode}"]
    raise Trouble(words[-1].replace("animeme: error: ", ""))
