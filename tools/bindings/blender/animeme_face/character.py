"""Who talks: the meshes of a character, what their shape keys do, and the bones of its head."""

from dataclasses import dataclass, field

from . import bones
from .names import choose


@dataclass
class Character:
    meshes: list  # objects with shape keys, each set of keys once
    meanings: dict  # key name: Meaning
    armature: object = None
    bones: dict = field(default_factory=dict)  # neck, head, jaw, left_eye, right_eye: names

    def wants(self):
        """What a clip has to bring."""
        kinds = {meaning.kind for meaning in self.meanings.values()}
        return {name for kind, name in (("viseme", "visemes"), ("fap", "faps")) if kind in kinds}


def keys_of(item):
    """Its shape keys but the basis."""
    shapes = item.data.shape_keys if item.type == "MESH" else None
    return [key for key in shapes.key_blocks if key != shapes.reference_key] if shapes else []


def armature_of(item):
    for modifier in item.modifiers:
        if modifier.type == "ARMATURE" and modifier.object:
            return modifier.object
    while item and item.type != "ARMATURE":
        item = item.parent
    return item


def find(selected):
    """The character of the selected objects: what lies under them, or under the armature of one.
    None: nobody."""
    roots = {armature_of(item) or item for item in selected}
    found = []
    for item in sorted(roots, key=lambda root: root.name):
        found += [item, *item.children_recursive]
    armatures = [item for item in found if item.type == "ARMATURE"]
    # Meshes may hang on an armature by their modifier alone.
    for item in selected:
        if item not in found:
            found.append(item)
    meshes, seen = [], set()
    for item in found:
        if keys_of(item) and item.data.name not in seen:
            seen.add(item.data.name)
            meshes.append(item)
    meanings = choose(list(dict.fromkeys(key.name for mesh in meshes for key in keys_of(mesh))))
    meshes = [mesh for mesh in meshes if any(key.name in meanings for key in keys_of(mesh))]
    if not meshes:
        return None
    armature = next((armature_of(mesh) for mesh in meshes if armature_of(mesh)),
        armatures[0] if armatures else None)
    return Character(meshes, meanings, armature, bones.find(armature) if armature else {})
