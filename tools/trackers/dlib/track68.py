#!/usr/bin/env python3
"""68 face landmarks of a video as a table: ffmpeg decodes, dlib looks."""

import json
import os
import subprocess
import sys
from fractions import Fraction

POINTS = 68


def fail(text):
    sys.exit("track68.py: " + text)


def probe(video):
    """Frames a second of the first picture track."""
    try:
        done = subprocess.run(
            ["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries",
             "stream=avg_frame_rate,r_frame_rate", "-of", "json", video],
            capture_output=True, check=False)
    except FileNotFoundError:
        fail("ffprobe cannot be started; install ffmpeg")
    if done.returncode != 0:
        fail(done.stderr.decode(errors="replace").strip())
    streams = json.loads(done.stdout).get("streams") or fail("there is no picture in " + video)
    for name in ("avg_frame_rate", "r_frame_rate"):
        number, _, divisor = streams[0].get(name, "0/0").partition("/")
        if int(number) > 0 and int(divisor or 1) > 0:
            return Fraction(int(number), int(divisor or 1))
    return fail("ffprobe does not tell the frame rate of " + video)


def header(stream):
    """Width and height of the next picture (PAM), or nothing at the end."""
    size = {}
    while True:
        line = stream.readline()
        if not line:
            return None
        words = line.split()
        if words[:1] == [b"ENDHDR"]:
            return size[b"WIDTH"], size[b"HEIGHT"]
        if len(words) == 2 and words[0] in (b"WIDTH", b"HEIGHT"):
            size[words[0]] = int(words[1])


def frames(video, rate, numpy):
    """Pictures as they are shown: upright, square pixels, a constant rate, from the first one on."""
    command = ["ffmpeg", "-v", "error", "-nostdin", "-i", video, "-map", "0:v:0", "-vf",
               "setpts=PTS-STARTPTS,fps=%s:start_time=0,scale=iw*sar:ih,setsar=1" % rate,
               "-f", "image2pipe", "-c:v", "pam", "-pix_fmt", "rgb24", "-"]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as ffmpeg:
        while True:
            size = header(ffmpeg.stdout)
            if size is None:
                break
            width, height = size
            pixels = ffmpeg.stdout.read(width * height * 3)
            yield numpy.frombuffer(pixels, numpy.uint8).reshape(height, width, 3)
    if ffmpeg.returncode != 0:
        fail("ffmpeg failed")


def main():
    if len(sys.argv) != 4:
        fail("usage: track68.py MODEL VIDEO TABLE.csv")
    model, video, out = sys.argv[1:]
    if not os.path.exists(model):
        fail("there is no model %s; fetch shape_predictor_68_face_landmarks.dat (see README.md)" % model)
    try:
        import dlib
        import numpy
    except ImportError as error:
        fail("a Python module is missing (%s); pip install dlib numpy" % error.name)
    detector = dlib.get_frontal_face_detector()
    predictor = dlib.shape_predictor(model)
    rate = probe(video)
    found = 0
    part = out + ".part"
    with open(part, "w", encoding="ascii") as table:
        columns = ["x_%d,y_%d" % (i, i) for i in range(POINTS)]
        table.write("time_s,confidence," + ",".join(columns) + "\n")
        for number, picture in enumerate(frames(video, rate, numpy)):
            time = "%.6f" % float(number / rate)
            faces = detector(picture, 1)
            if len(faces) == 0:
                table.write(time + ",0" + "," * (2 * POINTS) + "\n")
                continue
            found += 1
            shape = predictor(picture, max(faces, key=lambda face: face.area()))
            points = ["%d,%d" % (shape.part(i).x, shape.part(i).y) for i in range(POINTS)]
            table.write(time + ",1," + ",".join(points) + "\n")
    if found == 0:
        os.remove(part)
        fail("no face was found in any frame")
    os.replace(part, out)


if __name__ == "__main__":
    main()
