"""The clip's sound as a strip of the sequencer."""

import os

SOUNDS = (".wav", ".flac", ".mp3", ".m4a", ".aac", ".ogg", ".opus")


def find(path, has_sound, given=""):
    """The file whose sound it is: the one given, the clip itself, or one beside it of the same name. None: silence."""
    if given:
        return given
    if has_sound:
        return path
    base = os.path.splitext(path)[0]
    return next((base + ending for ending in SOUNDS if os.path.isfile(base + ending)), None)


def strips_of(editor):
    """Its strips; Blender 4.4 renamed them."""
    return editor.strips if hasattr(editor, "strips") else editor.sequences


def add(scene, name, path, frame):
    """A strip from `frame` on, which may lie between two. It gets the lowest channel that is free there."""
    editor = scene.sequence_editor or scene.sequence_editor_create()
    strips = strips_of(editor)
    strip = strips.new_sound(name, path, 1 + max((other.channel for other in strips), default=0), int(frame // 1))
    strip.frame_start = float(frame)
    taken = {other.channel for other in strips if other != strip and other.frame_final_start < strip.frame_final_end
             and strip.frame_final_start < other.frame_final_end}
    strip.channel = next(channel for channel in range(1, 129) if channel not in taken)
    # Without it the picture lags behind the sound where drawing takes long.
    scene.sync_mode = "AUDIO_SYNC"
    return strip
