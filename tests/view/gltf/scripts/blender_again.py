# Reads a .glb file into Blender and exports it again: blender --background --python THIS -- IN OUT
import sys
import bpy
import numpy
# Blender 3.4 asks for names that the numpy of Debian 12 has no longer.
for name in ("bool", "int", "float", "object"):
    if not hasattr(numpy, name):
        setattr(numpy, name, {"bool": bool, "int": int, "float": float, "object": object}[name])
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=sys.argv[-2])
bpy.ops.export_scene.gltf(filepath=sys.argv[-1], export_format="GLB")
