#!/usr/bin/env python3
"""Makes the captures of this folder again: a small face that talks, and what can go wrong with it."""

import gzip
import json
import math
import os

HERE = os.path.dirname(os.path.abspath(__file__))
RATE = 25
FRAMES = 20

# Feature points of a face in millimetres: x to the right of the picture, y down, z to the camera.
FACE = {
    "2.1": (0, 76, 2), "2.2": (0, 34, 10), "2.3": (0, 34.5, 9), "3.1": (31, -39.5, -7),
    "3.2": (-31, -39.5, -7), "3.3": (31, -28.5, -8), "3.4": (-31, -28.5, -8), "3.7": (46, -33, -17),
    "3.8": (-17, -32, -11), "3.11": (17, -32, -11), "3.12": (-46, -33, -17), "8.3": (25, 34.5, -1),
    "8.4": (-25, 34.5, -1), "9.3": (0, -3, 28), "9.15": (0, 13, 14), "nasion": (0, -39, 4),
}
IDS = sorted(FACE)


def face(i):
    """The points of a frame in pixels: the mouth opens and closes, the head drifts a little."""
    opening = 0 if i < 6 else 8 * math.sin(math.pi * (i - 6) / 8) ** 2
    out = {}
    for name in IDS:
        x, y, z = FACE[name]
        if name in ("2.1", "2.3"):
            y += opening
        out[name] = (320 + 2 * x + 0.2 * i, 200 + 2 * y, 2 * z)
    return out


def fmt(value):
    text = "%.2f" % value
    return text.rstrip("0").rstrip(".")


def table(rows=range(FRAMES), change=None, header=True, depth=False, sep=",", time="time_s",
          clock=lambda i: i / RATE, axes=(1, 1, 1), ends="\n"):
    names = [time] + ["%s_%s" % (n, a) for n in IDS for a in ("xyz" if depth else "xy")]
    lines = [sep.join(names)] if header else []
    for i in rows:
        points = face(i)
        if change:
            points = change(i, points)
        fields = [fmt(clock(i)) if isinstance(clock(i), float) else str(clock(i))]
        for n in IDS:
            for axis in range(3 if depth else 2):
                value = points[n][axis] if points and points[n] else None
                fields.append("" if value is None else fmt(value * axes[axis]))
        lines.append(sep.join(fields))
    return ends.join(lines) + ends


def moved(points, dx, dy, scale=1):
    return {n: (x * scale + dx, y * scale + dy, z * scale) for n, (x, y, z) in points.items()}


def jump(i, points):
    return moved(points, 300, -100) if i in (11, 12) else points


def slip(i, points):
    if i == 10:
        points["2.3"] = (10, 10, 0)
    return points


def hidden(i, points):
    if i in (9, 10):
        points["2.1"] = None
    return points


def write(name, data):
    if isinstance(data, str):
        data = data.encode("utf-8")
    with open(os.path.join(HERE, name), "wb") as out:
        out.write(data)


def long_table():
    lines = ["frame,time_s,point,x,y"]
    for i in range(FRAMES):
        for n in IDS:
            x, y, _ = face(i)[n]
            lines.append("%d,%s,%s,%s,%s" % (i, fmt(i / RATE), n, fmt(x), fmt(y)))
    return "\n".join(lines) + "\n"


def main():
    whole = table()
    write("whole.csv", whole)
    lines = whole.splitlines(keepends=True)
    write("empty.csv", "")
    write("header_only.csv", lines[0])
    write("no_header.csv", "".join(lines[1:]))
    write("cut_off.csv", whole[:-40])
    write("word_in_number.csv", "".join(lines[:5] + [word_for_number(lines[5])] + lines[6:]))
    write("column_twice.csv", whole.replace("2.2_x", "2.1_x", 1))
    write("no_y.csv", whole.replace("2.2_y", "depth", 1))
    write("no_times.csv", whole.replace("time_s", "clock", 1))
    write("times_back.csv", "".join(lines[:8] + lines[4:6] + lines[8:]))
    write("same_time.csv", "".join(lines[:8] + lines[7:8] + lines[8:]))
    write("milliseconds.csv", table(time="timestamp_ms", clock=lambda i: 40 * i))
    write("no_eyes.csv", "\n".join(
        ",".join(f for n, f in zip(lines[0].strip().split(","), line.strip().split(","))
                 if not n.startswith("3.")) for line in lines) + "\n")
    write("gap.csv", "".join(lines[:12] + lines[14:]))
    write("long_gap.csv", "".join(lines[:10] + lines[17:]))
    write("jump.csv", table(change=jump))
    write("slip.csv", table(change=slip))
    write("hidden_point.csv", table(change=hidden))
    write("no_face_at_first.csv", "confidence," + lines[0] + "".join(
        ("0," if i < 4 else "1,") + line for i, line in enumerate(lines[1:])))
    write("unsure.csv", "confidence," + lines[0] + "".join("0.1," + line for line in lines[1:]))
    write("other_depth.csv", table(depth=True, axes=(1, 1, 0.001)))
    write("stretched.csv", table(axes=(1.8, 1, 1)))
    write("decimal_commas.csv", commas())
    write("windows.csv", ("\ufeff" + table(ends="\r\n")))
    write("utf16.csv", table().encode("utf-16"))
    write("a_row_a_point.csv", long_table())
    write("own_names.csv", whole.replace("2.3_", "lowerlip.").replace("time_s", "clock [s]"))
    write("packed.csv", gzip.compress(whole.encode(), mtime=0)[:200])
    write("spreadsheet.csv", b"PK\x03\x04\x14\x00\x06\x00")
    write("points.npy", b"\x93NUMPY\x01\x00v\x00{'descr': '<f8'}")
    write("picture.csv", b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR")
    write("words.csv", "This is what the tracker said.\nNothing else.\n")
    write("other_columns.csv", "time_s,left,right\n0,1,2\n0.04,1,2\n")
    write("mediapipe.json", json.dumps({"width": 640, "height": 480, "frames": [
        {"timestamp_ms": 40 * i, "faceLandmarks": []} for i in range(3)]}))
    write("cut_off.json", '{"frames": [{"time_s": 0, "landmarks": [[1, 2], [3, 4')
    write("no_landmarks.json", '{"people": [{"name": "Ann"}]}')
    write("transcript.TextGrid", 'File type = "ooTextFile"\nObject class = "TextGrid"\n')


def word_for_number(line):
    fields = line.split(",")
    fields[1] = "many"
    return ",".join(fields)


def commas():
    text = table(sep=";")
    head, _, rest = text.partition("\n")
    return head + "\n" + rest.replace(".", ",")


main()
