#!/usr/bin/env python3
"""The samples that are computed: points on lips, landmarks of a face, marks of a speech service, and our
head with few triangles. Called by make.sh in a folder with curves.csv, voice.tsv, woman.glb, woman.obj."""

import csv
import json
import math
import struct

# Where FAPs move which point: the point, the axis, the sign, the unit (MW or MNS). x to the left of the
# face, y up.
MOVES = {
    3: ("2.1", 1, -1, "MNS"), 4: ("2.2", 1, -1, "MNS"), 5: ("2.3", 1, 1, "MNS"), 6: ("2.4", 0, 1, "MW"),
    7: ("2.5", 0, -1, "MW"), 8: ("2.6", 1, -1, "MNS"), 9: ("2.7", 1, -1, "MNS"), 10: ("2.8", 1, 1, "MNS"),
    11: ("2.9", 1, 1, "MNS"), 12: ("2.4", 1, 1, "MNS"), 13: ("2.5", 1, 1, "MNS"), 51: ("8.1", 1, -1, "MNS"),
    52: ("8.2", 1, 1, "MNS"), 53: ("8.3", 0, 1, "MW"), 54: ("8.4", 0, -1, "MW"), 55: ("8.5", 1, -1, "MNS"),
    56: ("8.6", 1, -1, "MNS"), 57: ("8.7", 1, 1, "MNS"), 58: ("8.8", 1, 1, "MNS"), 59: ("8.3", 1, 1, "MNS"),
    60: ("8.4", 1, 1, "MNS"),
}
UNITS = {"MW": 50 / 1024, "MNS": 24 / 1024}  # millimetres
LIPS = {
    "2.1": (0, -42), "2.2": (0, 0.2), "2.3": (0, -0.2), "2.4": (24, 0), "2.5": (-24, 0), "2.6": (12, 0.2),
    "2.7": (-12, 0.2), "2.8": (12, -0.2), "2.9": (-12, -0.2), "8.1": (0, 9), "8.2": (0, -11), "8.3": (25, 0),
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
        points += [(side + x, 76 + y) for x, y in ((-14, 0), (-5, 5), (5, 5), (14, 0), (5, -5), (-5, -5))]
    points += [(-25, 0), (-16, 6), (-7, 9), (0, 8.5), (7, 9), (16, 6), (25, 0), (16, -7), (7, -10), (0, -11),
               (-7, -10), (-16, -7)]
    points += [(-21, 0), (-7, 0.2), (0, 0.2), (7, 0.2), (21, 0), (7, -0.2), (0, -0.2), (-7, -0.2)]
    return points


# Which point of the lips each landmark of the mouth goes with, from 48 on.
GOES_WITH = ["8.4", "8.6", "8.1", "8.1", "8.1", "8.5", "8.3", "8.7", "8.2", "8.2", "8.2", "8.8", "2.5", "2.7", "2.2",
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
    "P": "p", "B": "p", "M": "p", "T": "t", "D": "t", "N": "t", "L": "t", "TH": "T", "DH": "T", "F": "f", "V": "f",
    "K": "k", "G": "k", "NG": "k", "HH": "k", "SH": "S", "ZH": "S", "CH": "S", "JH": "S", "S": "s", "Z": "s", "R": "r",
    "ER": "r", "IY": "i", "IH": "i", "Y": "i", "EY": "e", "EH": "E", "AE": "a", "AA": "a", "AY": "a", "AW": "a",
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
            lines.append({"time": time, "type": "word", "start": start, "end": at, "value": text[start:at]})
        last = word
        phone = row["phone"].rstrip("012")
        lines.append({"time": time, "type": "viseme", "value": POLLY.get(phone, "sil")})
    with open("polly.json", "w") as out:
        for line in lines:
            out.write(json.dumps(line, separators=(",", ":")) + "\n")


class Glb:
    """A .glb as our exporter writes it: floats, whole numbers of 16 and 32 bit, sparse where much is zero."""

    def __init__(self, path):
        data = open(path, "rb").read()
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + length])
        self.bin = data[28 + length:]

    def place_of(self, name):
        """Where the node of this name stands: all of them are moved, none is turned. What has a skin stands
        where its bones do."""
        nodes = self.json["nodes"]
        index = next(i for i, n in enumerate(nodes) if n["name"] == name)
        place = [0.0] * 3
        if "skin" in nodes[index]:
            return place
        while index is not None:
            place = [a + b for a, b in zip(place, nodes[index].get("translation", (0, 0, 0)))]
            index = next((i for i, n in enumerate(nodes) if index in n.get("children", ())), None)
        return place

    def unpack(self, at, count, width, component):
        kind = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}[component]
        view = self.json["bufferViews"][at["bufferView"]]
        step = view.get("byteStride", struct.calcsize(kind) * width)
        start = view.get("byteOffset", 0) + at.get("byteOffset", 0)
        return [struct.unpack_from("<%d%s" % (width, kind), self.bin, start + i * step) for i in range(count)]

    def read(self, index):
        accessor = self.json["accessors"][index]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        values = [(0.0,) * width] * accessor["count"]
        if "bufferView" in accessor:
            values = self.unpack(accessor, accessor["count"], width, accessor["componentType"])
        if "sparse" in accessor:
            few = accessor["sparse"]
            places = self.unpack(few["indices"], few["count"], 1, few["indices"]["componentType"])
            for (i,), value in zip(places, self.unpack(few["values"], few["count"], width, 5126)):
                values[i] = value
        return values


def cells(places, normals, opening, size_of):
    """A number for each vertex: those in a cell that look the same way are one. Lips and lids that are close stay
    apart by what jawOpen and blinks do."""
    number_of, of_vertex, members = {}, [], []
    for i, place in enumerate(places):
        size = size_of(place)
        key = tuple(math.floor(v / size) for v in place) + (size, math.floor(opening[i] / 0.004))
        if size < 0.01:
            key += tuple(round(0.8 * v) for v in normals[i])
        if key not in number_of:
            number_of[key] = len(members)
            members.append([])
        of_vertex.append(number_of[key])
        members[number_of[key]].append(i)
    return of_vertex, members


def mean(values, members):
    return tuple(sum(values[i][k] for i in members) / len(members) for k in range(3))


class Writer:
    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def view(self, data):
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data + b"\0" * (-len(data) % 4)
        return len(self.views) - 1

    def triples(self, values):
        self.accessors.append({
            "bufferView": self.view(b"".join(struct.pack("<3f", *v) for v in values)), "componentType": 5126,
            "count": len(values), "type": "VEC3", "min": [min(v[k] for v in values) for k in range(3)],
            "max": [max(v[k] for v in values) for k in range(3)]})
        return len(self.accessors) - 1

    def few(self, values, least):
        """Only what is not about zero."""
        some = [i for i, v in enumerate(values) if max(map(abs, v)) > least]
        if not some:
            return None
        self.accessors.append({
            "componentType": 5126, "count": len(values), "type": "VEC3", "sparse": {
                "count": len(some),
                "indices": {"bufferView": self.view(struct.pack("<%dH" % len(some), *some)), "componentType": 5123},
                "values": {"bufferView": self.view(b"".join(struct.pack("<3f", *values[i]) for i in some))}},
            "min": [min(0, min(values[i][k] for i in some)) for k in range(3)],
            "max": [max(0, max(values[i][k] for i in some)) for k in range(3)]})
        return len(self.accessors) - 1

    def indices(self, values):
        self.accessors.append({"bufferView": self.view(struct.pack("<%dH" % len(values), *values)),
                               "componentType": 5123, "count": len(values), "type": "SCALAR"})
        return len(self.accessors) - 1


def write_obj(places, faces, index_of):
    """The skin alone, in centimetres, and which of its vertices is which feature point."""
    with open("me.obj", "w") as out:
        for x, y, z in places:
            out.write("v %.2f %.2f %.2f\n" % (100 * x, 100 * y, 100 * z))
        for i in range(0, len(faces), 3):
            out.write("f %d %d %d\n" % tuple(v + 1 for v in faces[i:i + 3]))
    with open("woman.points.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    with open("landmarks.csv", "w") as out:
        out.write("feature_point,vertex\n")
        for row in rows:
            if int(row["vertex"]) < SKIN:
                out.write("%s,%d\n" % (row["feature_point"], index_of(int(row["vertex"]))))


SKIN = 23206  # vertices of the skin, the first of woman.obj
SHAPES = {"jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthRollLower", "mouthRollUpper", "browInnerUp",
          "tongueOut"}  # few, so that the file is small
SHAPES |= {"%s%s" % (name, side) for side in ("Left", "Right")
           for name in ("mouthStretch", "mouthSmile", "mouthLowerDown", "mouthUpperUp", "eyeBlink")}
MOUTH = (0, -0.06, 0.092)
EYES = ((-0.0315, 0, 0.08), (0.0315, 0, 0.08))  # lids
COLOURS = {"skin": (0.75, 0.5, 0.4), "upper_teeth": (0.85, 0.85, 0.8), "lower_teeth": (0.85, 0.85, 0.8),
           "tongue": (0.7, 0.3, 0.3), "hair": (0.15, 0.08, 0.04), "brows": (0.15, 0.08, 0.04),
           "left_eye": (0.9, 0.9, 0.9), "right_eye": (0.9, 0.9, 0.9)}


def write_small_head():
    head, out = Glb("woman.glb"), Writer()
    meshes, materials = [], []
    for mesh in head.json["meshes"]:
        name = mesh["name"]
        if name not in COLOURS:
            continue
        part = mesh["primitives"][0]
        moved = head.place_of(name)
        places = [tuple(p + d for p, d in zip(v, moved)) for v in head.read(part["attributes"]["POSITION"])]
        shapes = mesh.get("extras", {}).get("targetNames", [])
        moves = [head.read(t["POSITION"]) for t in part.get("targets", [])]
        opening = [sum(moves[shapes.index(s)][i][1] for s in ("jawOpen", "eyeBlinkLeft", "eyeBlinkRight")
                       if s in shapes) for i in range(len(places))]
        def size_of(place, name=name):
            if name != "skin":
                return 0.03 if name == "hair" else 0.012
            near = math.dist(place, MOUTH)
            eye = min(math.dist(place, e) for e in EYES)
            return 0.006 if near < 0.034 or eye < 0.02 else 0.012 if near < 0.08 else 0.026

        of_vertex, members = cells(places, head.read(part["attributes"]["NORMAL"]), opening, size_of)
        faces = [v[0] for v in head.read(part["indices"])]
        kept = []
        for i in range(0, len(faces), 3):
            three = [of_vertex[v] for v in faces[i:i + 3]]
            if len(set(three)) == 3:
                kept += three
        used = sorted(set(kept))
        again = {old: new for new, old in enumerate(used)}
        new_part = {"attributes": {"POSITION": out.triples([mean(places, members[m]) for m in used])},
                    "indices": out.indices([again[v] for v in kept]), "material": len(materials), "targets": []}
        names = []
        for shape, values in zip(shapes, moves):
            if shape not in SHAPES:
                continue
            index = out.few([mean(values, members[m]) for m in used], 0.0006)
            if index is not None:
                names.append(shape)
                new_part["targets"].append({"POSITION": index})
        new_mesh = {"name": name, "primitives": [new_part]}
        if names:
            new_mesh["extras"] = {"targetNames": names}
        else:
            del new_part["targets"]
        if name == "skin":
            write_obj([mean(places, members[m]) for m in used], [again[v] for v in kept],
                      lambda v, of=of_vertex, to=again: to[of[v]])
        meshes.append(new_mesh)
        materials.append({"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": list(COLOURS[name]) + [1], "metallicFactor": 0, "roughnessFactor": 0.6}})
    document = {
        "asset": {"version": "2.0", "generator": "tools/release/samples/make.py"}, "scene": 0,
        "scenes": [{"nodes": list(range(len(meshes)))}],
        "nodes": [{"mesh": i, "name": m["name"]} for i, m in enumerate(meshes)], "meshes": meshes,
        "materials": materials, "accessors": out.accessors, "bufferViews": out.views,
        "buffers": [{"byteLength": len(out.data)}]}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open("me.glb", "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(out.data)))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(out.data), 0x004E4942) + out.data)
    print({m["name"]: out.accessors[m["primitives"][0]["attributes"]["POSITION"]]["count"] for m in meshes})


frames = motion()
write_lips(frames)
write_open_face(frames)
write_polly()
write_small_head()
