"""Bones of a head: which they are, and how they turn.

A character looks along -Y with Z up in Blender; where it is turned in the scene is told by its
eyes.
"""

from mathutils import Matrix, Vector

from .names import words_of

_HELPERS = set(
    "end top nub target ctrl control ik pole mesh hair twist offset physics collider brow eyebrow lid eyelid lash "
    "eyelash lids blink upper lower inner outer bottom corner look socket bag bags pupil iris highlight squint "
    "cheek".split()
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
        part.group == group.index and part.weight > 0.05 for vertex in mesh.data.vertices for part
        in vertex.groups
    )


def _world(armature, bone):
    """Its axes at rest, in the scene, without sizes."""
    return (armature.matrix_world.to_3x3() @ armature.data.bones[bone].matrix_local.to_3x3(
        )).normalized()


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
    """Quaternion of a pose bone for angles in radians: down, to the person's left, to the person's
    right."""
    # Yaw outermost, as the program has it (fap/semantics.md, section 1).
    wanted = Matrix.Rotation(yaw, 3, "Z") @ Matrix.Rotation(pitch, 3, "X") @ Matrix.Rotation(-roll,
        3, "Y")
    rest = _world(armature, bone)
    return (rest.inverted() @ frame @ wanted @ frame.transposed() @ rest).to_quaternion()


class Jaw:
    """A jaw bone that follows the shape of the jaw: teeth stay with the lip that is drawn down."""

    # Teeth go down by less than the skin of the chin.
    SHARE = 0.8

    def __init__(self, armature, bone, frame, mesh, opening):
        """`opening`: the shape key of the open jaw. Its turn is that nearest to what moves by half
        of the most."""
        self.armature, self.bone, self.frame, self.mesh = armature, bone, frame, mesh
        joint = _place(armature, bone)
        into = frame.transposed() @ mesh.matrix_world.to_3x3()
        arms = [frame.transposed() @ (mesh.matrix_world @ point.co - joint) for point
            in opening.relative_key.data]
        steps = [into @ step for step in _steps(opening)]
        most = max(step.length for step in steps)
        self.vertices = [v for v, step in enumerate(steps) if step.length > most / 2]
        # About the axis to the left: what lies ahead (-Y) goes down by a positive angle.
        moved = sum(arms[v].y * steps[v].z - arms[v].z * steps[v].y for v in self.vertices)
        size = sum(arms[v].y ** 2 + arms[v].z ** 2 for v in self.vertices)
        self.angle = self.SHARE * moved / size if size else 0.0

    def turn(self, weight):
        return turn(self.armature, self.bone, self.frame, self.angle * weight, 0, 0)

    def shift(self, key):
        """How far the bone goes for a further key of the jaw at 1 (forward, aside), in its own
        axes."""
        steps = _steps(key)
        step = sum((steps[v] for v in self.vertices), Vector()) / max(len(self.vertices), 1)
        axes_ = self.armature.matrix_world.to_3x3() @ self.armature.data.bones[
            self.bone].matrix_local.to_3x3()
        return axes_.inverted() @ self.mesh.matrix_world.to_3x3() @ step


def _steps(key):
    return [point.co - rest.co for point, rest in zip(key.data, key.relative_key.data)]
