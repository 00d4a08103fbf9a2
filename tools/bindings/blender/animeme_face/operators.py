"""What Blender calls: the operator, its entry in File > Import, a panel and the preferences."""

import os
import tempfile

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import character, clip, keys, own_head, program, sound
from .apply import Options, apply

ENDINGS = "*.fba;*.fap;*.mp4;*.mkv;*.ts;*.m3u8;*.mpd;*.csv"


def setting():
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences.program if addon else ""


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program", subtype="FILE_PATH",
        description="The program animeme, or its folder; empty: from PATH, or from the add-on's folder",
    )

    def draw(self, context):
        self.layout.prop(self, "program")
        try:
            self.layout.label(text="Found: " + program.find(self.program), icon="CHECKMARK")
        except program.Trouble as trouble:
            self.layout.label(text=str(trouble), icon="ERROR")


class ImportFace(bpy.types.Operator, ImportHelper):
    """Import a talking face onto the selected character: its shape keys, its bones, and the
    sound"""

    bl_idname = "import_scene.animeme"
    bl_label = "Import talking face"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    filter_glob: StringProperty(default=ENDINGS, options={"HIDDEN"})
    frame_start: IntProperty(name="Start frame", default=1,
        description="Frame of the scene at which the clip begins")
    rate: EnumProperty(
        name="Rate", default="KEEP",
        items=[("KEEP", "The scene's", "Keep the scene's frame rate; the clip is resampled"),
               ("SET", "The clip's", "Set the scene's frame rate to the clip's")],
    )
    use_range: BoolProperty(name="Extend the scene", default=True,
                            description="Extend the end of the scene to that of the clip")
    use_sound: BoolProperty(name="Sound", default=True,
        description="Put the sound into the sequencer")
    sound_path: StringProperty(
        name="Sound file", options={"SKIP_SAVE"},
        description="Empty: the clip's own, or a sound file of the same name next to it",
    )
    head: EnumProperty(
        name="Head turns", default="BOTH",
        items=[("BOTH", "Neck and head", "Half each; everything if there is only one bone"),
               ("NECK", "Neck", "The neck's bone"), ("HEAD", "Head", "The head's bone"),
               ("NONE", "None", "The head does not move")],
    )
    eyes: EnumProperty(
        name="Eyes", default="AUTO",
        items=[("AUTO", "Automatic", "By bones, unless shape keys move them"),
               ("BONES", "Bones", "Always by bones"), ("SHAPES", "Shapes", "By shape keys only"),
               ("NONE", "None", "The eyes do not move")],
    )
    use_jaw: BoolProperty(name="Jaw bone", default=True,
                          description="Rotate the jaw bone with the jaw shape, if teeth are attached to it")
    fap_scale: EnumProperty(
        name="FAP keys at 1", default="UNITS",
        items=[("UNITS", "Units", "A key named like a FAP shows this many FAP units at 1"),
               ("RANGE", "End of its range",
               "A key named like a FAP shows the end of its usual range at 1")],
    )
    fap_units: FloatProperty(name="Units", default=1024, min=1, soft_max=100000,
                             description="FAP units at 1: 1024 in heads that Animeme exports")
    own_head: EnumProperty(
        name="Head, if none is selected", default="woman",
        items=[("woman", "Woman", "Make this head"), ("man", "Man", "Make this head"),
               ("child", "Child", "Make this head"), ("none", "None",
               "Report that nothing is selected")],
    )

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        for name in ("frame_start", "rate", "use_range", "use_sound", "sound_path", "head", "eyes",
            "use_jaw",
                     "fap_scale"):
            layout.prop(self, name)
        if self.fap_scale == "UNITS":
            layout.prop(self, "fap_units")
        layout.prop(self, "own_head")

    def execute(self, context):
        window = context.window_manager
        window.progress_begin(0, 100)
        try:
            with tempfile.TemporaryDirectory(prefix="animeme_") as folder:
                line = self.run(context, folder,
                    lambda share: window.progress_update(int(100 * share)))
            self.report({"INFO"}, line)
        except program.Trouble as trouble:
            self.report({"ERROR"}, str(trouble))
            return {"CANCELLED"}
        finally:
            window.progress_end()
        return {"FINISHED"}

    def run(self, context, folder, progress):
        """Imports; returns messages. `folder` is for temporary files."""
        path = bpy.path.abspath(self.filepath)
        animeme = program.find(bpy.path.abspath(setting()))
        who = character.find(context.selected_objects)
        if who is None and context.selected_objects and any(map(character.keys_of,
            context.selected_objects)):
            raise program.Trouble(
                "The selected meshes have no shape key named like an ARKit shape, a viseme or "
                                  "a FAP (jawOpen, viseme_aa, open_jaw); rename some, or select nothing")
        if who is None and self.own_head == "none":
            raise program.Trouble(
                "Select a mesh with shape keys, or set 'Head, if none is selected'")
        # The file first: nothing is made for one that cannot be read.
        face = clip.read(animeme, path, who.wants() if who else set(),
            lambda share: progress(0.7 * share))
        heard = None
        if self.use_sound:
            try:
                heard = sound.find(animeme, path, bpy.path.abspath(self.sound_path), folder)
            except program.Trouble as trouble:  # the face is worth having alone
                self.report({"WARNING"}, f"Imported without sound; give it as a file: {trouble}")
        if heard and not os.path.isfile(heard):
            raise program.Trouble(f"{heard}: there is no such sound file")
        if who is None:
            who = character.find(own_head.make(animeme, self.own_head))
        scene = context.scene
        if self.rate == "SET":
            keys.set_rate(scene, face.rate)
        options = Options(head=self.head, eyes=self.eyes, jaw=self.use_jaw,
                          fap_units=self.fap_units if self.fap_scale == "UNITS" else None)
        name = os.path.splitext(os.path.basename(path))[0]
        last, curves = apply(scene, who, face, name, self.frame_start, options,
                             lambda share: progress(0.7 + 0.25 * share))
        if heard:
            strip = sound.add(scene, name, heard, self.frame_start, pack=heard.startswith(folder))
            last = max(last, strip.frame_final_end - 1)
        if self.use_range:
            scene.frame_end = max(scene.frame_end, last)
        return (f"{os.path.basename(path)}: {face.frames} frames at {float(face.rate):g} a second, {curves} curves on "
                f"{len(who.meshes)} meshes" + ("" if heard else ", no sound"))


class Panel(bpy.types.Panel):
    bl_idname = "VIEW3D_PT_animeme"
    bl_label = "Talking face"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Animeme"

    def draw(self, context):
        who = character.find(context.selected_objects)
        kinds = {meaning.kind for meaning in who.meanings.values()} if who else set()
        names = {"arkit": "ARKit", "viseme": "visemes", "fap": "FAPs", "other": "other names"}
        self.layout.label(text=f"{len(who.meanings)} shapes: "
            + ", ".join(names[kind] for kind in sorted(kinds))
                          if who else "No shapes selected: creates a head")
        self.layout.operator(ImportFace.bl_idname, icon="IMPORT")


def _entry(menu, context):
    menu.layout.operator(ImportFace.bl_idname, text="Talking face (.fba, .fap, .mp4)")


CLASSES = (Preferences, ImportFace, Panel)


def register():
    for kind in CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.TOPBAR_MT_file_import.append(_entry)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(_entry)
    for kind in reversed(CLASSES):
        bpy.utils.unregister_class(kind)
