"""Animeme in Blender: File > Import of faces (.fba, .fap, .mp4 ...) onto meshes with shape keys.

The program `animeme` reads the files; here its curves become keyframes. `operators.py` has what Blender
calls, the other modules what it needs.
"""

bl_info = {
    "name": "Animeme faces",
    "description": "Imports talking faces (.fba, .fap, .mp4) onto ARKit shapes, visemes or FAP keys, with their sound",
    "author": "Animeme",
    "version": (0, 1, 0),
    "blender": (3, 3, 0),
    "location": "File > Import > Talking face",
    "category": "Import-Export",
}

if "operators" in locals():  # Reload Scripts
    import importlib

    for module in (program, names, clip, bones, character, keys, sound, own_head, apply, operators):  # noqa: F821
        importlib.reload(module)
else:
    from . import apply, bones, character, clip, keys, names, operators, own_head, program, sound  # noqa: F401


def register():
    operators.register()


def unregister():
    operators.unregister()
