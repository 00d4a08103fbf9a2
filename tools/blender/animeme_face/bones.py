"""Bones of a head: which they are, and how they turn.

A character looks along -Y with Z up in Blender; where it is turned in the scene is told by its eyes.
"""

import math

from mathutils import Matrix, Vector

from .names import words_of

_HELPERS = set(
    "end top nub target ctrl control ik pole mesh hair twist offset physics collider brow eyebrow lid eyelid lash "
    "eyelash lids blink upper lower inner outer bottom corner look socket bag bags pupil iris highlight squint cheek".split()
)
_EYES = {"eye", "eyeball", "lefteye", "righteye", "eyeleft", "eyeright", "leye", "reye", "faceeye"}
_SIDES = {
    "left_eye": {"left", "lefteye", "eyeleft", "leye", "lf"},
    "right_eye": {"right", "righteye", "eyeright", "reye", "rt"},
}


def find(armature):
    """{role: bone name} of neck, head, jaw, left_eye, right_eye, as far as they are there."""
    found = {}
    for bone in armature.data.bones:
        words = set(words_of(bone.name))
        role = None
        if words & _HELPERS:
            continue
        if words & _EYES:
            role = next((side for side, marks in _SIDES.items() if words & marks), None)
        elif words & {"jaw", "jawroot", "mandible", "lowerjaw"}:
            role = "jaw"
        elif "head" in words:
            role = "head"
        elif "neck" in words:
            role = "neck"
        if role:
            found.setdefault(role, bone.name)
    return found


def carries(armature, bone, mesh):
    """True if a bone moves vertices of a mesh."""
    if mesh.parent == armature and mesh.parent_type == "BONE" and mesh.parent_bone == bone:
        return True
    group = mesh.vertex_groups.get(bone)
    return group is not None and any(
        part.group == group.index and part.weight > 0.05 for vertex in mesh.data.vertices for part in vertex.groups
    )


def _world(armature, bone):
    """Its axes at rest, in the scene, without sizes."""
    return (armature.matrix_world.to_3x3() @ armature.data.bones[bone].matrix_local.to_3x3()).normalized()


def _place(armature, bone):
    return armature.matrix_world @ armature.data.bones[bone].head_local


def axes(armature, roles):
    """Left, back and up of the character as columns; the scene's where eyes do not tell."""
    if "left_eye" not in roles or "right_eye" not in roles:
        return Matrix.Identity(3)
    left = _place(armature, roles["left_eye"]) - _place(armature, roles["right_eye"])
    up = Vector((0, 0, 1))
    if left.length < 1e-9 or abs(left.normalized().z) > 0.9:
        return Matrix.Identity(3)
    left = left.normalized()
    up = (up - left * left.z).normalized()
    return Matrix((left, up.cross(left), up)).transposed()


def turn(armature, bone, frame, pitch, yaw, roll):
    """Quaternion of a pose bone for angles in radians: down, to the person's left, to the person's right."""
    # Yaw outermost, as the program has it (fap/semantics.md, section 1).
    wanted = Matrix.Rotation(yaw, 3, "Z") @ Matrix.Rotation(pitch, 3, "X") @ Matrix.Rotation(-roll, 3, "Y")
    rest = _world(armature, bone)
    return (rest.inverted() @ frame @ wanted @ frame.transposed() @ rest).to_quaternion()


class Jaw:
    """A jaw bone that follows the shape of the jaw: teeth stay with the lip that is drawn down."""

    def __init__(self, armature, bone, frame, mesh, opening):
        """`opening`: the shape key of the open jaw. Its chin is what moves most."""
        self.armature, self.bone, self.frame = armature, bone, frame
        shape, rest = opening, opening.relative_key
        count = len(mesh.data.vertices)
        moved, still = [0.0] * (3 * count), [0.0] * (3 * count)
        shape.data.foreach_get("co", moved)
        rest.data.foreach_get("co", still)
        steps = [(moved[i] - still[i]) ** 2 + (moved[i + 1] - still[i + 1]) ** 2 + (moved[i + 2] - still[i + 2]) ** 2
                 for i in range(0, 3 * count, 3)]
        self.vertex = max(range(count), key=steps.__getitem__)
        into = frame.transposed() @ mesh.matrix_world.to_3x3()
        self.mesh_axes = into
        self.step = into @ (shape.data[self.vertex].co - rest.data[self.vertex].co)
        self.arm = frame.transposed() @ (mesh.matrix_world @ rest.data[self.vertex].co - _place(armature, bone))

    def turn(self, weight):
        there = self.arm + self.step * weight
        # About the axis to the left: what lies ahead (-Y) goes down by a positive angle.
        angle = math.atan2(-there.z, -there.y) - math.atan2(-self.arm.z, -self.arm.y)
        return turn(self.armature, self.bone, self.frame, angle, 0, 0)

    def shift(self, key):
        """How far the bone goes for a further key of the jaw at 1 (forward, aside), in its own axes."""
        step = self.mesh_axes @ (key.data[self.vertex].co - key.relative_key.data[self.vertex].co)
        sizes = (self.armature.matrix_world.to_3x3() @ self.armature.data.bones[self.bone].matrix_local.to_3x3())
        return sizes.inverted() @ (self.frame @ step)
