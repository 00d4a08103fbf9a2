#!/usr/bin/env python3
"""The samples that are computed: points on lips, landmarks of a face, marks of a speech service.
Called by
make.sh in a folder with curves.csv and voice.tsv."""

import csv
import json
import math

# Where FAPs move which point: the point, the axis, the sign, the unit (MW or MNS). x to the left of
# the face, y up.
MOVES = {
    3: ("2.1", 1, -1, "MNS"), 4: ("2.2", 1, -1, "MNS"), 5: ("2.3", 1, 1, "MNS"),
    6: ("2.4", 0, 1, "MW"),
    7: ("2.5", 0, -1, "MW"), 8: ("2.6", 1, -1, "MNS"), 9: ("2.7", 1, -1, "MNS"),
    10: ("2.8", 1, 1, "MNS"),
    11: ("2.9", 1, 1, "MNS"), 12: ("2.4", 1, 1, "MNS"), 13: ("2.5", 1, 1, "MNS"),
    51: ("8.1", 1, -1, "MNS"),
    52: ("8.2", 1, 1, "MNS"), 53: ("8.3", 0, 1, "MW"), 54: ("8.4", 0, -1, "MW"),
    55: ("8.5", 1, -1, "MNS"),
    56: ("8.6", 1, -1, "MNS"), 57: ("8.7", 1, 1, "MNS"), 58: ("8.8", 1, 1, "MNS"),
    59: ("8.3", 1, 1, "MNS"),
    60: ("8.4", 1, 1, "MNS"),
}
UNITS = {"MW": 50 / 1024, "MNS": 24 / 1024}  # millimetres
LIPS = {
    "2.1": (0, -42), "2.2": (0, 0.2), "2.3": (0, -0.2), "2.4": (24, 0), "2.5": (-24, 0),
    "2.6": (12, 0.2),
    "2.7": (-12, 0.2), "2.8": (12, -0.2), "2.9": (-12, -0.2), "8.1": (0, 9), "8.2": (0, -11),
    "8.3": (25, 0),
    "8.4": (-25, 0), "8.5": (13, 7), "8.6": (-13, 7), "8.7": (13, -8), "8.8": (-13, -8),
}


def motion():
    """Per frame of curves.csv: the time, and how far each point of the lips is from its place."""
    with open("curves.csv", newline="") as file:
        rows = list(csv.reader(file))
    fap_of = {}
    for column, name in enumerate(rows[0]):
        if name.startswith("fap"):
            fap_of[column] = int(name[3:].split("_")[0])
    frames = []
    for row in rows[1:]:
        away = {name: [0.0, 0.0] for name in LIPS}
        for column, fap in fap_of.items():
            if fap in MOVES:
                point, axis, sign, unit = MOVES[fap]
                away[point][axis] += sign * UNITS[unit] * float(row[column])
        frames.append((float(row[0]), away))
    return frames


def number(value):
    text = ("%.2f" % value).rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def write_lips(frames):
    with open("lips.csv", "w") as out:
        out.write(",".join(["time_s"] + ["%s_%s" % (p, a) for p in LIPS for a in "xy"]) + "\n")
        for time, away in frames:
            places = [LIPS[p][k] + away[p][k] for p in LIPS for k in range(2)]
            out.write(",".join([number(time)] + [number(v) for v in places]) + "\n")


def landmarks():
    """A face of 68 points in millimetres around the middle of its mouth, as above."""
    points = []
    for i in range(17):  # the jaw, from the right ear
        angle = math.pi * i / 16
        points.append((-68 * math.cos(angle), 25 - 67 * math.sin(angle) ** 0.8))
    points += [(-50 + 9 * i, 92 + 5 * math.sin(math.pi * i / 4)) for i in range(5)]  # brows
    points += [(14 + 9 * i, 92 + 5 * math.sin(math.pi * i / 4)) for i in range(5)]
    points += [(0, 76 - 14 * i) for i in range(4)]  # the nose
    points += [(-12 + 6 * i, 26 - 2 * math.sin(math.pi * i / 4)) for i in range(5)]
    for side in (-32, 32):  # eyes, from the outside of the right one
        points += [(side + x, 76 + y) for x, y in ((-14, 0), (-5, 5), (5, 5), (14, 0), (5, -5),
            (-5, -5))]
    points += [(-25, 0), (-16, 6), (-7, 9), (0, 8.5), (7, 9), (16, 6), (25, 0), (16, -7), (7, -10),
        (0, -11),
               (-7, -10), (-16, -7)]
    points += [(-21, 0), (-7, 0.2), (0, 0.2), (7, 0.2), (21, 0), (7, -0.2), (0, -0.2), (-7, -0.2)]
    return points


# Which point of the lips each landmark of the mouth goes with, from 48 on.
GOES_WITH = ["8.4", "8.6", "8.1", "8.1", "8.1", "8.5", "8.3", "8.7", "8.2", "8.2", "8.2", "8.8",
    "2.5", "2.7", "2.2",
             "2.6", "2.4", "2.8", "2.3", "2.9"]


def write_open_face(frames):
    face = landmarks()
    names = ["frame", "timestamp", "confidence", "success"]
    names += ["x_%d" % i for i in range(68)] + ["y_%d" % i for i in range(68)]
    with open("OpenFace.csv", "w") as out:
        out.write(", ".join(names) + "\n")
        for k, (time, away) in enumerate(frames[::2]):
            places = []
            for i, (x, y) in enumerate(face):
                dx, dy = away[GOES_WITH[i - 48]] if i >= 48 else (0, 0)
                if i < 17:  # the chin comes with the jaw
                    dy += away["2.1"][1] * max(0, 1 - abs(i - 8) / 8)
                # The picture has the face's left on its right, y down.
                places.append((320 + 2 * (x + dx), 260 - 2 * (y + dy)))
            row = ["%d" % (k + 1), "%.3f" % time, "0.98", "1"]
            row += ["%.1f" % x for x, _ in places] + ["%.1f" % y for _, y in places]
            out.write(",".join(row) + "\n")


# What Amazon Polly calls the visemes of ARPAbet.
POLLY = {
    "P": "p", "B": "p", "M": "p", "T": "t", "D": "t", "N": "t", "L": "t", "TH": "T", "DH": "T",
    "F": "f", "V": "f",
    "K": "k", "G": "k", "NG": "k", "HH": "k", "SH": "S", "ZH": "S", "CH": "S", "JH": "S", "S": "s",
    "Z": "s", "R": "r",
    "ER": "r", "IY": "i", "IH": "i", "Y": "i", "EY": "e", "EH": "E", "AE": "a", "AA": "a",
    "AY": "a", "AW": "a",
    "AH": "@", "AX": "@", "AO": "O", "OY": "O", "OW": "o", "UH": "u", "UW": "u", "W": "u",
}


def write_polly():
    with open("voice.tsv", newline="") as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    text = open("voice.txt").read().strip()
    at, last, lines = 0, "", []
    lines.append({"time": 0, "type": "sentence", "start": 0, "end": len(text), "value": text})
    for row in rows:
        time = round(1000 * float(row["start_s"]))
        word = (row.get("word") or "").strip()
        if word and word != last:
            start = text.lower().index(word.lower(), at)
            at = start + len(word)
            lines.append({"time": time, "type": "word", "start": start, "end": at,
                "value": text[start:at]})
        last = word
        phone = row["phone"].rstrip("012")
        lines.append({"time": time, "type": "viseme", "value": POLLY.get(phone, "sil")})
    with open("polly.json", "w") as out:
        for line in lines:
            out.write(json.dumps(line, separators=(",", ":")) + "\n")


frames = motion()
write_lips(frames)
write_open_face(frames)
write_polly()
