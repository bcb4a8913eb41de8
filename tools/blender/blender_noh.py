# blender_noh.py: an add-on for Blender 3.4 and later: File, Export, noh pack (.noh). It exports with Blender's own glTF
# exporter, runs `noh build` and `noh budget`, and lists what they say with the objects that it is about.
#
# Install it with Edit, Preferences, Add-ons, Install. Without a window:
#   blender -b hero.blend --python blender_noh.py --python-expr 'import bpy; bpy.ops.export_scene.noh(filepath="hero.noh")'
import json
import os
import re
import subprocess
import tempfile

import bpy
from bpy.props import BoolProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

bl_info = {
    "name": "noh packs",
    "blender": (3, 4, 0),
    "version": (0, 3, 0),
    "location": "File > Export; Properties > Scene > noh",
    "description": "Exports a character as a pack of noh, and shows what was left out and what it costs",
    "category": "Import-Export",
}

# Kinds in messages, and where Blender has their names.
NAMED = {"mesh": "meshes", "material": "materials", "animation": "actions", "clip": "actions", "node": "objects",
         "joint": "objects", "skin": "armatures", "camera": "cameras", "image": "images", "texture": "images"}


def of(kind, name):
    """The objects that a message about a thing of this kind and name is about."""
    found = getattr(bpy.data, NAMED.get(kind, "objects")).get(name)
    if isinstance(found, bpy.types.Object):
        return [found]
    if isinstance(found, bpy.types.Material):
        return [o for o in bpy.data.objects if any(s.material == found for s in o.material_slots)]
    if isinstance(found, bpy.types.Action):
        return [o for o in bpy.data.objects if o.animation_data and o.animation_data.action == found]
    if found is not None:
        return [o for o in bpy.data.objects if o.data == found]
    bones = [o for o in bpy.data.objects if o.type == "ARMATURE" and name in o.data.bones]
    return bones or [o for o in bpy.data.objects if o.name == name]


def objects_of(text):
    for kind, name in re.findall(r"(\w+) '([^']+)'", text):
        objects = of(kind, name)
        if objects:
            return objects
    return []


def run(program, *arguments):
    """The exit code, the text on stdout and the lines on stderr."""
    try:
        done = subprocess.run([program, *arguments], capture_output=True, text=True, errors="replace")
    except OSError as error:
        return 1, "", [f"{program} cannot be run ({error.strerror}): set its place in the add-on's preferences"]
    return done.returncode, done.stdout, [line for line in done.stderr.splitlines() if line.strip()]


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: StringProperty(name="noh", description="The program noh", subtype="FILE_PATH", default="noh")

    def draw(self, context):
        self.layout.prop(self, "program")


def program_of(context):
    added = context.preferences.addons.get(__name__)
    return bpy.path.abspath(added.preferences.program) if added else os.environ.get("NOH", "noh")


class Message(bpy.types.PropertyGroup):
    text: StringProperty()
    object: StringProperty()
    is_error: BoolProperty()


class ExportNoh(bpy.types.Operator, ExportHelper):
    """Export the scene as a pack of noh"""
    bl_idname = "export_scene.noh"
    bl_label = "Export noh pack"
    filename_ext = ".noh"
    filter_glob: StringProperty(default="*.noh", options={"HIDDEN"})
    levels: IntProperty(name="LOD levels", description="With the full mesh", min=1, max=8, default=1)
    selected: BoolProperty(name="Selected objects only", default=False)

    def tell(self, context, text, is_error=False):
        text = re.sub(r"^(noh|warning): ", "", text)
        objects = [] if is_error and "cannot be run" in text else objects_of(text)
        about = objects[0].name if objects else ""
        message = context.scene.noh_messages.add()
        message.text, message.object, message.is_error = text, about, is_error
        self.report({"ERROR" if is_error else "WARNING"}, f"{about}: {text}" if about else text)

    def execute(self, context):
        program, messages = program_of(context), context.scene.noh_messages
        messages.clear()
        context.scene.noh_budget = ""
        with tempfile.TemporaryDirectory() as folder:
            glb = os.path.join(folder, "scene.glb")
            bpy.ops.export_scene.gltf(filepath=glb, export_format="GLB", use_selection=self.selected,
                                      export_extras=True, export_all_influences=True)
            more = ["--lod", str(self.levels)]
            code, _, lines = run(program, "build", glb, "-o", self.filepath, "--warnings", *more)
        for line in lines:
            self.tell(context, line.replace(glb + ": ", ""), code != 0 and not line.startswith("warning: "))
        if code != 0:
            return {"CANCELLED"}
        code, text, lines = run(program, "budget", self.filepath, "--nominal", "--json")
        if code != 0:
            self.tell(context, lines[-1] if lines else "noh budget failed", True)
            return {"CANCELLED"}
        context.scene.noh_budget = self.costs(json.loads(text))
        self.report({"INFO"}, context.scene.noh_budget)
        return {"FINISHED"}

    def costs(self, budget):
        file_bytes = os.path.getsize(self.filepath)
        return f"{file_bytes:,} bytes; CPU {budget['cpu_bytes']:,}, GPU {budget['gpu_bytes']:,}"


class SelectNoh(bpy.types.Operator):
    """Select what the message is about"""
    bl_idname = "object.noh_select"
    bl_label = "Select"
    name: StringProperty()

    def execute(self, context):
        bpy.ops.object.select_all(action="DESELECT")
        bpy.data.objects[self.name].select_set(True)
        context.view_layer.objects.active = bpy.data.objects[self.name]
        return {"FINISHED"}


class PanelNoh(bpy.types.Panel):
    bl_label, bl_idname = "noh", "SCENE_PT_noh"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "scene"

    def draw(self, context):
        self.layout.operator(ExportNoh.bl_idname)
        if context.scene.noh_budget:
            self.layout.label(text=context.scene.noh_budget)
        for message in context.scene.noh_messages:
            row = self.layout.row()
            row.label(text=message.text, icon="ERROR" if message.is_error else "INFO")
            if message.object in bpy.data.objects:
                row.operator(SelectNoh.bl_idname, text=message.object).name = message.object


def menu(self, context):
    self.layout.operator(ExportNoh.bl_idname, text="noh pack (.noh)")


CLASSES = (Preferences, Message, ExportNoh, SelectNoh, PanelNoh)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.noh_messages = bpy.props.CollectionProperty(type=Message)
    bpy.types.Scene.noh_budget = StringProperty()
    bpy.types.TOPBAR_MT_file_export.append(menu)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(menu)
    del bpy.types.Scene.noh_messages, bpy.types.Scene.noh_budget
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)


if __name__ == "__main__":
    register()
