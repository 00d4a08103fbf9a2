"""Reads messages as receivers of others do, by Python's struct and json: read_carriers.py FOLDER;
prints JSON."""
import json
import struct
import sys
from pathlib import Path

folder = Path(sys.argv[1])


def osc_string(data, at):
    end = data.index(0, at)
    return data[at:end].decode(), end + 4 - end % 4


def live_link(data):
    """1 version, FString device, FString subject, FQualifiedFrameTime, count, float32."""
    version, length = struct.unpack_from(">bi", data)
    at = 5
    device = data[at:at + length].decode()
    at += length
    length, = struct.unpack_from(">i", data, at)
    subject = data[at + 4:at + 4 + length].decode()
    at += 4 + length
    frame, part, rate, one, count = struct.unpack_from(">ifiib", data, at)
    values = struct.unpack_from(f">{count}f", data, at + 17)
    assert at + 17 + 4 * count == len(data) and version == 6 and part == 0 and one == 1
    return {"device": device, "subject": subject, "frame": frame, "rate": rate, "values": values}


def vmc(data):
    name, at = osc_string(data, 0)
    assert name == "#bundle" and struct.unpack_from(">Q", data, at) == (1,)
    at += 8
    values, applied = {}, False
    while at < len(data):
        size, = struct.unpack_from(">i", data, at)
        element, at = data[at + 4:at + 4 + size], at + 4 + size
        address, inner = osc_string(element, 0)
        tags, inner = osc_string(element, inner)
        assert not applied and size % 4 == 0
        if address == "/VMC/Ext/Blend/Apply":
            applied = tags == "," and inner == size
            continue
        assert address == "/VMC/Ext/Blend/Val" and tags == ",sf"
        shape, inner = osc_string(element, inner)
        values[shape], = struct.unpack_from(">f", element, inner)
        assert inner + 4 == size
    assert applied
    return values


def arf(data):
    kind, length, time, shapes, flags, last = struct.unpack_from(">BIIHBH", data)
    assert kind >> 1 == 1 and length == len(data) - 5 and flags >> 7 == 0
    entries = [struct.unpack_from(">Hf", data, 14 + 6 * i) for i in range(last + 1)]
    assert 14 + 6 * len(entries) == len(data)
    return {"time": time, "set": shapes, "entries": entries}


print(json.dumps({
    "floats": struct.unpack(">52f", (folder / "floats").read_bytes()),
    "live_link": live_link((folder / "live_link").read_bytes()),
    "vmc": vmc((folder / "vmc").read_bytes()),
    "arf": arf((folder / "arf").read_bytes()),
    "azure": json.loads((folder / "azure").read_text()),
}))
