"""The example draws a picture of a clip."""
import os
import re
import subprocess
import sys

from conftest import SAMPLE, SOURCE


def test_plot_clip(tmp_path):
    picture = tmp_path / "talk.png"
    command = [sys.executable, SOURCE / "tools/bindings/examples/plot_clip.py",
        SAMPLE / "fap/prac8p.csv", "-o", picture]
    run = subprocess.run(command, capture_output=True, text=True,
        env={**os.environ, "MPLCONFIGDIR": str(tmp_path)})
    assert run.returncode == 0, run.stderr
    assert "75 frames" in run.stdout and re.search(r"\d kbit/s", run.stdout)
    import matplotlib.image
    image = matplotlib.image.imread(picture)
    assert image.shape[0] > 400 and image.shape[1] > 800 and image[..., :3].std() > 0.1
