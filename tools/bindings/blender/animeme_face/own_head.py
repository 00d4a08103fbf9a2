"""A head of Animeme's own, where nothing to move is selected."""

import os
import tempfile

import bpy

from .program import Trouble, run


def _old_names():
    """Blender 3.4's glTF importer asks for names that the numpy of Debian 12 has no longer."""
    import warnings

    import numpy

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for kind in (bool, int, float, object):
            if not hasattr(numpy, kind.__name__):
                setattr(numpy, kind.__name__, kind)


def make(program, which):
    """Imports the head woman, man or child, with its shapes and bones; its objects."""
    if not hasattr(bpy.types, "IMPORT_SCENE_OT_gltf"):
        raise Trouble(
            "Heads are glTF files: enable the add-on glTF 2.0, or select a mesh with shape keys")
    _old_names()
    before, actions = set(bpy.data.objects), set(bpy.data.actions)
    with tempfile.TemporaryDirectory(prefix="animeme_") as folder:
        file = os.path.join(folder, which + ".glb")
        run(program, "head", which, "-o", file)
        bpy.ops.import_scene.gltf(filepath=file)
    made = [item for item in bpy.data.objects if item not in before]
    # The file has an animation of a frame at rest.
    for item in made:
        item.animation_data_clear()
        if item.type == "MESH" and item.data.shape_keys:
            item.data.shape_keys.animation_data_clear()
    for action in set(bpy.data.actions) - actions:
        bpy.data.actions.remove(action)
    return made
