"""Animeme in Blender: File > Import of faces (.fba, .fap, .mp4 ...) onto meshes with shape keys.

The program `animeme` reads the files; here its curves become keyframes. `operators.py` has what
Blender calls, the other modules what it needs.
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

import importlib
import sys

# In the order in which they import each other; all anew after an update of the add-on or Reload
# Scripts.
for _name in "program names clip bones character keys sound own_head apply operators".split():
    _name = f"{__name__}.{_name}"
    if _name in sys.modules:
        importlib.reload(sys.modules[_name])

from . import operators


def register():
    operators.register()


def unregister():
    operators.unregister()
