"""Plots a decoded clip: curves of the mouth, what coding does to them, and the head at its widest.

    python3 plot_clip.py talk.fba -o talk.png

Cells begin with "# %%": Spyder, VS Code and PyCharm run them one by one.
"""
# %% What to look at: a stream, FAP text, a talking .mp4, a capture of a phone ...
import argparse

import matplotlib

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("input", help="a face in any file that animeme reads")
parser.add_argument("-o", "--output",
    help="the picture (.png .svg .pdf); without it a window opens")
parser.add_argument("--faps", default="open_jaw,raise_b_midlip,lower_t_midlip,stretch_l_cornerlip")
parser.add_argument("--rms", type=float, default=4, help="error of the coded clip, FAP units")
options = parser.parse_args()
if options.output:
    matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

import animeme

# %% The clip: values and masks as arrays, absent FAPs resolved as a player does
clip = animeme.load(options.input).fill(complete=True)
print(clip, f"{clip.duration:.2f} s")

# %% Coded as small as an error allows, and decoded again
data = animeme.encode(clip, max_rms=options.rms)
coded = animeme.decode(data).fill(complete=True)
kbps = len(data) * 8e-3 / clip.duration
print(f"{len(data)} bytes, {kbps:.2f} kbit/s")

# %% Curves, before and after
names = options.faps.split(",")
figure = plt.figure(figsize=(10, 1.4 * len(names) + 0.8), layout="constrained")
grid = figure.add_gridspec(len(names), 2, width_ratios=(3, 2))
axes = [figure.add_subplot(grid[0, 0])]
axes += [figure.add_subplot(grid[row, 0], sharex=axes[0]) for row in range(1, len(names))]
for axis, name in zip(axes, names):
    axis.plot(clip.times, clip[name], color="0.7", linewidth=3, label="clip")
    axis.plot(coded.times, coded[name], color="C3", linewidth=1, label=f"{kbps:.2f} kbit/s")
    axis.set_ylabel(name.replace("_", "\n", 1), fontsize=8)
    axis.margins(x=0)
axes[0].legend(loc="upper right", fontsize=8)
axes[-1].set_xlabel("seconds")

# %% The head where the mouth is widest, seen from the front
head = animeme.Head("woman")
widest = int(np.argmax(clip["open_jaw"]))
vertices = head.pose(clip[widest : widest + 1])[0]
shade = figure.add_subplot(grid[:, 1])
order = np.argsort(vertices[head.triangles, 2].mean(axis=1))  # the nearest last
triangles = head.triangles[order]
a, b, c = (vertices[triangles[:, i]] for i in range(3))
normal = np.cross(b - a, c - a)
normal /= np.linalg.norm(normal, axis=1, keepdims=True) + 1e-9
facing = normal[:, 2] > 0
light = np.clip(normal @ (0.3, 0.4, 0.87), 0.25, 1)[facing, None]
colours = head.colours[triangles[facing, 0]] * light
shade.add_collection(matplotlib.collections.PolyCollection(
    vertices[triangles[facing], :2], facecolors=colours ** (1 / 2.2), edgecolors="face",
    linewidths=0.1))
shade.set_xlim(-9, 9)
shade.set_ylim(-14, 10)
shade.set_aspect("equal")
shade.axis("off")
shade.set_title(f"{clip.times[widest]:.2f} s", fontsize=9)

# %% The picture
if options.output:
    figure.savefig(options.output, dpi=120)
    print(options.output)
else:
    plt.show()
