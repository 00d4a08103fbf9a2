#!/usr/bin/env python3
"""What engines see of a stream: datagrams of Live Link Face, VMC or VRChat's OSC as JSON, a line a
frame.

Written from the public descriptions alone, with struct and nothing else: it shares no code with
tools/live/engines, which it checks.

  reader.py PROTOCOL FILE        datagrams from a file: f64 seconds, u32 length (little endian),
  bytes reader.py PROTOCOL --port N --seconds S   datagrams of this machine; N 0: any, which is told
  first

PROTOCOL is livelink, vmc or osc. A frame is {"at": seconds, "time": ..., "values": {name: weight},
...}; what does not follow the description ends it with a sentence and exit code 1.
"""
import json
import socket
import struct
import sys
import time

# EARFaceBlendShape of Unreal Engine's manual, in its order.
SIDES = ("Left", "Right")
EYE = "EyeBlink EyeLookDown EyeLookIn EyeLookOut EyeLookUp EyeSquint EyeWide".split()
SHAPES = [name + side for side in SIDES for name in EYE]
SHAPES += ["JawForward", "JawLeft", "JawRight", "JawOpen", "MouthClose", "MouthFunnel",
    "MouthPucker",
           "MouthLeft", "MouthRight"]
SHAPES += ["Mouth" + name + side for name in "Smile Frown Dimple Stretch".split() for side in SIDES]
SHAPES += ["MouthRollLower", "MouthRollUpper", "MouthShrugLower", "MouthShrugUpper"]
SHAPES += ["Mouth" + name + side for name in "Press LowerDown UpperUp".split() for side in SIDES]
SHAPES += ["BrowDownLeft", "BrowDownRight", "BrowInnerUp", "BrowOuterUpLeft", "BrowOuterUpRight",
           "CheekPuff", "CheekSquintLeft", "CheekSquintRight", "NoseSneerLeft", "NoseSneerRight",
           "TongueOut"]
SHAPES += [part + turn for part in ("Head", "LeftEye", "RightEye") for turn
    in ("Yaw", "Pitch", "Roll")]
assert len(SHAPES) == 61


class Wrong(Exception):
    pass


def must(truth, sentence):
    if not truth:
        raise Wrong(sentence)


def live_link(data):
    """One packet is one frame."""
    must(data[0] == 6, "version is not 6")
    at, names = 1, []
    for _ in range(2):
        (size,) = struct.unpack_from(">i", data, at)
        must(0 < size <= 256, "a name of %d bytes" % size)
        names.append(data[at + 4:at + 4 + size].decode())
        at += 4 + size
    frame, part, rate, denominator, count = struct.unpack_from(">ifiiB", data, at)
    must(count == 61, "%d values" % count)
    must(len(data) == at + 17 + 4 * 61, "the packet has %d bytes" % len(data))
    must(0 <= part < 1 and rate > 0 and denominator > 0, "the frame time is none")
    values = struct.unpack_from(">61f", data, at + 17)
    return {"device": names[0], "subject": names[1], "rate": rate / denominator,
            "time": (frame + part) * denominator / rate, "values": dict(zip(SHAPES, values))}


def osc_text(data, at):
    end = data.index(0, at)
    text = data[at:end].decode()
    after = at + (end - at) // 4 * 4 + 4
    must(not any(data[end:after]) and after <= len(data), "padding is not zeros")
    return text, after


def osc_messages(data):
    """(address, values) in their order, of a message or a bundle."""
    must(len(data) % 4 == 0, "no multiple of four bytes")
    if data.startswith(b"#bundle\0"):
        must(data[8:16] == b"\0\0\0\0\0\0\0\1", "the time tag is not 'now'")
        at = 16
        while at < len(data):
            (size,) = struct.unpack_from(">i", data, at)
            must(size > 0 and at + 4 + size <= len(data), "an element leaves its bundle")
            yield from osc_messages(data[at + 4:at + 4 + size])
            at += 4 + size
        return
    address, at = osc_text(data, 0)
    must(address.startswith("/"), "an address without slash")
    types, at = osc_text(data, at)
    must(types.startswith(","), "types without comma")
    values = []
    for kind in types[1:]:
        if kind == "s":
            text, at = osc_text(data, at)
            values.append(text)
        elif kind in "TF":
            values.append(kind == "T")
        else:
            must(kind in "if", "type " + kind)
            values.append(struct.unpack_from(">" + kind, data, at)[0])
            at += 4
    must(at == len(data), "bytes behind the values")
    yield address, values


class Vmc:
    def __init__(self):
        self.values, self.bones, self.time, self.ok = {}, {}, None, None

    def take(self, data):
        must(len(data) <= 1472, "a datagram of %d bytes" % len(data))
        for address, values in osc_messages(data):
            if address == "/VMC/Ext/OK":
                self.ok = values
                if values == [0]:
                    yield {"end": True}
            elif address == "/VMC/Ext/T":
                (self.time,) = values
            elif address == "/VMC/Ext/Bone/Pos":
                must(len(values) == 8, "a bone has a name and seven numbers")
                self.bones[values[0]] = values[1:]
            elif address == "/VMC/Ext/Blend/Val":
                name, weight = values
                must(isinstance(name, str) and isinstance(weight, float), "a weight is s and f")
                self.values[name] = weight
            elif address == "/VMC/Ext/Blend/Apply":
                must(values == [] and self.ok == [1, 3, 0],
                    "Apply has no values and stands behind OK")
                yield {"time": self.time, "values": dict(self.values), "bones": dict(self.bones)}
                self.values, self.bones, self.time, self.ok = {}, {}, None, None
            else:
                raise Wrong("address " + address)


class Parameters:
    """All that came at one time is a frame; what does not come keeps its value."""

    def __init__(self):
        self.values = {}

    def take(self, data):
        must(len(data) <= 1472, "a datagram of %d bytes" % len(data))
        for address, values in osc_messages(data):
            must(all(isinstance(value, (float, bool)) for value in values),
                 "a parameter is a float or a flag")
            for name in ("/avatar/parameters/", "/tracking/eye/"):
                if address.startswith(name):
                    self.values[address[len(name):]] = values[0] if len(values) == 1 else values
                    break
            else:
                raise Wrong("address " + address)
        yield {"values": dict(self.values)}


def from_file(name):
    with open(name, "rb") as file:
        data = file.read()
    at = 0
    while at < len(data):
        seconds, size = struct.unpack_from("<dI", data, at)
        yield seconds, data[at + 12:at + 12 + size]
        at += 12 + size


def from_port(port, seconds):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as udp:
        udp.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        udp.bind(("127.0.0.1", port))
        print(json.dumps({"port": udp.getsockname()[1]}), flush=True)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            udp.settimeout(max(0.001, end - time.monotonic()))
            try:
                data = udp.recv(65536)
            except socket.timeout:
                return
            yield time.monotonic(), data


def told(frame):
    """A line; seven decimals are what 32 bits have of a weight."""
    for group in ("values", "bones"):
        for name, value in frame.get(group, {}).items():
            frame[group][name] = [round(x, 7) for x in value] if isinstance(value,
                (list, tuple)) else round(value, 7)
    print(json.dumps(frame))


def main(arguments):
    protocol = arguments[0]
    take = {"livelink": lambda data: [live_link(data)], "vmc": Vmc().take,
        "osc": Parameters().take}[protocol]
    if arguments[1] == "--port":
        datagrams = from_port(int(arguments[2]), float(arguments[4]))
    else:
        datagrams = from_file(arguments[1])
    last = None
    try:
        for at, data in datagrams:
            for frame in take(data):
                frame["at"] = at
                # Parts of one frame of parameters come at one time: the last of them has all.
                if protocol == "osc" and last is not None and last["at"] != at:
                    told(last)
                if protocol == "osc":
                    last = frame
                else:
                    told(frame)
                if frame.get("end"):
                    return 0
    except (Wrong, ValueError, IndexError, struct.error) as error:
        print("%s: %s" % (protocol, error), file=sys.stderr)
        return 1
    if last is not None:
        told(last)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
