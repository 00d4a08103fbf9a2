"""What the names of shape keys mean: ARKit's shapes, visemes and FAPs, in the spellings of
exporters and rigs.

The same rules as the program's own reader of glTF (tools/view/gltf/shape_names.h), but for moods.
"""

import re
from dataclasses import dataclass

ARKIT = (
    "eyeBlinkLeft eyeLookDownLeft eyeLookInLeft eyeLookOutLeft eyeLookUpLeft eyeSquintLeft eyeWideLeft "
    "eyeBlinkRight eyeLookDownRight eyeLookInRight eyeLookOutRight eyeLookUpRight eyeSquintRight eyeWideRight "
    "jawForward jawRight jawLeft jawOpen mouthClose mouthFunnel mouthPucker mouthRight mouthLeft mouthSmileLeft "
    "mouthSmileRight mouthFrownLeft mouthFrownRight mouthDimpleLeft mouthDimpleRight mouthStretchLeft "
    "mouthStretchRight mouthRollLower mouthRollUpper mouthShrugLower mouthShrugUpper mouthPressLeft mouthPressRight "
    "mouthLowerDownLeft mouthLowerDownRight mouthUpperUpLeft mouthUpperUpRight browDownLeft browDownRight "
    "browInnerUp browOuterUpLeft browOuterUpRight cheekPuff cheekSquintLeft cheekSquintRight noseSneerLeft "
    "noseSneerRight tongueOut"
).split()

VISEMES = ["viseme_" + name for name in "sil PP FF TH DD kk CH SS nn RR aa E I O U".split()]

# FAP 3 to 68 with the ends of their usual ranges, in FAP units (angles: 1e-5 rad).
FAPS = dict(
    (name, int(end))
    for name, end in (
        row.split(":")
        for row in """
        open_jaw:4320 lower_t_midlip:1200 raise_b_midlip:3720 stretch_l_cornerlip:1200 stretch_r_cornerlip:1200
        lower_t_lip_lm:1200 lower_t_lip_rm:1200 raise_b_lip_lm:3720 raise_b_lip_rm:3720 raise_l_cornerlip:1200
        raise_r_cornerlip:1200 thrust_jaw:600 shift_jaw:1080 push_b_lip:1080 push_t_lip:1080 depress_chin:420
        close_t_l_eyelid:1080 close_t_r_eyelid:1080 close_b_l_eyelid:600 close_b_r_eyelid:600 yaw_l_eyeball:153600
        yaw_r_eyeball:153600 pitch_l_eyeball:115200 pitch_r_eyeball:115200 thrust_l_eyeball:600 thrust_r_eyeball:600
        dilate_l_pupil:420 dilate_r_pupil:420 raise_l_i_eyebrow:1800 raise_r_i_eyebrow:1800 raise_l_m_eyebrow:1800
        raise_r_m_eyebrow:1800 raise_l_o_eyebrow:1800 raise_r_o_eyebrow:1800 squeeze_l_eyebrow:900
        squeeze_r_eyebrow:900 puff_l_cheek:1800 puff_r_cheek:1800 lift_l_cheek:1200 lift_r_cheek:1200
        shift_tongue_tip:1080 raise_tongue_tip:1080 thrust_tongue_tip:1080 raise_tongue:1080 tongue_roll:552960
        head_pitch:316200 head_yaw:316200 head_roll:316200 lower_t_midlip_o:1200 raise_b_midlip_o:3720
        stretch_l_cornerlip_o:1200 stretch_r_cornerlip_o:1200 lower_t_lip_lm_o:1200 lower_t_lip_rm_o:1200
        raise_b_lip_lm_o:3720 raise_b_lip_rm_o:3720 raise_l_cornerlip_o:1200 raise_r_cornerlip_o:1200
        stretch_l_nose:540 stretch_r_nose:540 raise_nose:680 bend_nose:900 raise_l_ear:900 raise_r_ear:900
        pull_l_ear:900 pull_r_ear:900""".split()
    )
)

# Other usual names, and what of ARKit they do.
OTHERS = {
    "blink eyesclosed eyesclose eyeclose eyeclosed closeeyes まばたき": "eyeBlinkLeft eyeBlinkRight",
    "blinkleft winkleft eyecloseleft eyeclosedleft ウィンク": "eyeBlinkLeft",
    "blinkright winkright eyecloseright eyeclosedright ウィンク右": "eyeBlinkRight",
    "eyeswide eyesurprised びっくり": "eyeWideLeft eyeWideRight",
    "eyeslookup lookup": "eyeLookUpLeft eyeLookUpRight",
    "eyeslookdown lookdown": "eyeLookDownLeft eyeLookDownRight",
    "eyeslookleft lookleft": "eyeLookOutLeft eyeLookInRight",
    "eyeslookright lookright": "eyeLookInLeft eyeLookOutRight",
    "mouthopen openmouth": "jawOpen",
    "smile": "mouthSmileLeft mouthSmileRight",
    "smileleft": "mouthSmileLeft",
    "smileright": "mouthSmileRight",
    "frown": "mouthFrownLeft mouthFrownRight",
    "browsup browup browraise browsraise eyebrowsup brwsurprised 上": "browInnerUp browOuterUpLeft browOuterUpRight",
    "browraiseouterleft": "browOuterUpLeft",
    "browraiseouterright": "browOuterUpRight",
    "browsdown eyebrowsdown browsangry browangry brwangry 怒り 下": "browDownLeft browDownRight",
    "brwsorrow browssad browsad 困る": "browInnerUp",
    "brwjoy brwfun browshappy": "browOuterUpLeft browOuterUpRight",
}

_PREFIXES = set(
    "blendshape blend shape shapes bs arkit ak face head ctrl expressions morph morpher mesh wolf3d fcl expression "
    "facial key target bshp fap".split()
)
_ARKIT = {name.lower(): name for name in ARKIT}
_VISEMES = {name.split("_")[1].lower(): name for name in VISEMES}
_VOWELS = dict(a="aa", あ="aa", ee="E", eh="E", え="E", い="I", お="O", う="U")
_VISEMES.update((key, "viseme_" + name) for key, name in _VOWELS.items())
_FAPS = {name.replace("_", ""): name for name in FAPS}
_OTHERS = {key: shapes.split() for keys, shapes in OTHERS.items() for key in keys.split()}


@dataclass(frozen=True)
class Meaning:
    """A key follows the mean of these curves of a clip."""

    kind: str  # arkit, viseme, fap; other: a usual name, used where no key of ARKit does the same
    curves: tuple


def words_of(name):
    """Words in small letters: "Wolf3D_eyeBlink_L" is wolf3d, eye, blink, left."""
    text = re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ",
        name.replace("ARKit", "Arkit"))
    sides = {"l": "left", "r": "right"}
    return [sides.get(word, word) for word in re.sub(r"[\W_]+", " ", text).lower().split()]


def _readings(name):
    """The names that it may stand for, whole first, then without what exporters put before it."""
    parts = [name] + [name.rsplit(mark, 1)[1] for mark in ".:|" if mark in name]
    if "Fcl_" in name:
        parts.append(name.split("Fcl_", 1)[1])
    for part in parts:
        words = words_of(part)
        while words:
            yield words
            if words[0] not in _PREFIXES and not re.fullmatch(r"[a-z]?\d+|fap\d+", words[0]):
                break
            words = words[1:]


def _arkit(key):
    if key in _ARKIT:
        return (_ARKIT[key],)
    for side in ("left", "right"):  # split: "browInnerUp_L"
        if key.endswith(side) and key[: -len(side)] in _ARKIT:
            return (_ARKIT[key[: -len(side)]],)
    return ()


def meaning_of(name):
    """What a key does, None if that is unknown."""
    for words in _readings(name):
        key = "".join(words)
        plain = "".join({"left": "l", "right": "r"}.get(word, word) for word in words)
        if plain in _FAPS:
            return Meaning("fap", (_FAPS[plain],))
        if _arkit(key):
            return Meaning("arkit", _arkit(key))
        if key in _OTHERS:
            return Meaning("other", tuple(_OTHERS[key]))
        # Both sides in one: "mouthSmile"; "mouth" alone would be mouthLeft with mouthRight.
        if key + "left" in _ARKIT and key + "right" in _ARKIT and key not in ("mouth", "jaw"):
            return Meaning("other", (_ARKIT[key + "left"], _ARKIT[key + "right"]))
        while len(words) > 1 and words[0] in ("vrc", "viseme", "vis", "v", "mth"):
            words = words[1:]
        if len(words) == 1 and words[0] in _VISEMES:
            return Meaning("viseme", (_VISEMES[words[0]],))
    return None


def choose(names):
    """Which of the keys of a character are used: {name: Meaning}.

    ARKit's first. Visemes move the mouth where ARKit's jaw is missing. Other names only for what no
    shape of
    ARKit does.
    """
    known = {name: meaning_of(name) for name in names}
    shapes = {curve for meaning in known.values() if meaning and meaning.kind == "arkit" for curve
        in meaning.curves}
    visemes = any(meaning and meaning.kind == "viseme" for meaning
        in known.values()) and "jawOpen" not in shapes
    mouth = shapes | ({"jawOpen"} if visemes else set())

    def used(meaning):
        if meaning is None:
            return False
        if meaning.kind == "viseme":
            return visemes
        return meaning.kind != "other" or not mouth.intersection(meaning.curves)

    return {name: meaning for name, meaning in known.items() if used(meaning)}
