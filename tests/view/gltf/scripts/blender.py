# What Blender makes of a .glb file: blender --background --python blender.py -- FILE
import json
import sys

import bpy
import numpy

# The importer of Blender 3.4 asks for names that the numpy of Debian 12 has no longer.
for name in ("bool", "int", "float"):
    if not hasattr(numpy, name):
        setattr(numpy, name, {"bool": bool, "int": int, "float": float}[name])

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=sys.argv[-1])
report = {"objects": {}, "actions": {}}
for item in bpy.data.objects:
    entry = {"type": item.type}
    if item.type == "MESH":
        entry["vertices"] = len(item.data.vertices)
        keys = item.data.shape_keys
        entry["shape_keys"] = [key.name for key in keys.key_blocks] if keys else []
    report["objects"][item.name] = entry
for action in bpy.data.actions:
    report["actions"][action.name] = {
        curve.data_path: len(curve.keyframe_points) for curve in action.fcurves
    }
print("REPORT " + json.dumps(report))
