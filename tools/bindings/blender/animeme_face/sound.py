"""The clip's sound as a strip of the sequencer."""

import json
import os
import wave

from .program import Trouble, run

SOUNDS = (".wav", ".flac", ".mp3", ".m4a", ".aac", ".ogg", ".opus")


def find(program, path, given, folder):
    """A sound file that begins when the face does, None for silence: the one given, the clip
    itself, one of its name
    beside it. Where Blender would be late or early by itself, one in `folder`."""
    if given:
        return given
    start = _starts(program, path)
    if "audio" not in start:
        base = os.path.splitext(path)[0]
        return next((base + ending for ending in SOUNDS if os.path.isfile(base + ending)), None)
    if start["format"] == "mp4" and abs(start["audio"] - start["face"]) < 1e-4:
        return path
    return _cut(program, path, folder)


def _starts(program, path):
    """Seconds at which each kind of track begins, and the format."""
    info = json.loads(run(program, "info", "--json", path))
    start = {track["kind"]: track["start"] for track in reversed(info.get("tracks", []))}
    return {**start, "format": info.get("format")}


def _cut(program, path, folder):
    """Fragments, Matroska and streams have the samples before the sound in ways of their own, which
    Blender does not
    know: the program writes an MP4 that has them in one, and what is before the face is cut off or
    filled up."""
    plain, out = os.path.join(folder, "plain.mp4"), os.path.join(folder,
        os.path.basename(path) + ".wav")
    try:
        run(program, "mux", path, path, "--audio-codec", "copy", "-o", plain)
    except Trouble:
        run(program, "mux", path, path, "-o", plain)  # coded in other ways than MP4 takes
    run(program, "demux", plain, "--audio", out)
    start = _starts(program, plain)
    with wave.open(out) as file:
        form, samples = file.getparams(), file.readframes(file.getnframes())
    late = round(
        (start["audio"] - start["face"]) * form.framerate) * form.nchannels * form.sampwidth
    with wave.open(out, "wb") as file:
        file.setparams(form)
        file.writeframes(bytes(max(late, 0)) + samples[max(-late, 0):])
    return out


def strips_of(editor):
    """Its strips; Blender 4.4 renamed them."""
    return editor.strips if hasattr(editor, "strips") else editor.sequences


def add(scene, name, path, frame, pack):
    """A strip from `frame` on, in the lowest channel that is free there. Packed, the .blend file
    has it inside."""
    editor = scene.sequence_editor or scene.sequence_editor_create()
    strips = strips_of(editor)
    strip = strips.new_sound(name, path, 1, frame)
    if pack:
        strip.sound.pack()
    taken = {other.channel for other in strips if other != strip
        and other.frame_final_start < strip.frame_final_end
             and strip.frame_final_start < other.frame_final_end}
    strip.channel = next(channel for channel in range(1, 129) if channel not in taken)
    # Without it the picture lags behind the sound where drawing takes long.
    scene.sync_mode = "AUDIO_SYNC"
    return strip
