#!/bin/sh
# The add-on for Blender (tools/blender): a scene is exported, built and planned, and each message has the name of the
# object that it is about.
. "$(dirname "$0")/lib.sh"
if ! command -v blender >/dev/null 2>&1; then
    skip 'the add-on' 'no blender here'
    finish
fi
NOH=$(cd "$build" && pwd)/noh
export NOH
cat >"$work/scene.py" <<'PY'
import os, sys
import bpy
sys.path.insert(0, os.path.abspath("tools/blender"))
import blender_noh
blender_noh.register()
out = sys.argv[-1]

def export(name, **options):
    try:
        result = bpy.ops.export_scene.noh(filepath=os.path.join(out, name + ".noh"), **options)
    except RuntimeError as error:
        result = {"CANCELLED"}
    scene = bpy.context.scene
    print("result", name, *result)
    for m in scene.noh_messages:
        print("message", name, "|%s|%s|%s" % ("error" if m.is_error else "warning", m.object, m.text))
    print("budget", name, scene.noh_budget)

bpy.data.objects.remove(bpy.data.objects["Cube"])
bpy.ops.mesh.primitive_uv_sphere_add()
hat = bpy.context.object
hat.name = "hat"
export("plain")
hat.data.uv_layers.new(name="second")
hat.shape_key_add(name="Basis")
hat.shape_key_add(name="smile").data[0].co.x += 0.1
export("uvs", levels=2)
hat.data.name = "felt"
export("renamed")
bpy.ops.object.noh_select(name=bpy.context.scene.noh_messages[0].object)
print("selected", bpy.context.active_object.name, *[o.name for o in bpy.context.selected_objects])
bpy.ops.object.select_all(action="DESELECT")
export("none", selected=True)
os.environ["NOH"] = os.path.join(out, "nowhere")
export("missing")
blender_noh.unregister()
PY
blender -b --factory-startup --python-exit-code 3 --python "$work/scene.py" -- "$work" >"$work/said" 2>"$work/err"
code=$?
if grep -q "No module named 'numpy'" "$work/said" "$work/err"; then
    skip 'the add-on' "Blender's glTF exporter needs numpy (Debian: python3-numpy)"
    finish
fi
expect 0 'blender runs the add-on'
prints() { # LINE NAME
    check "$2" grep -qF -- "$1" "$work/said"
}
prints 'result plain FINISHED' 'a scene becomes a pack'
check 'without a message' sh -c '! grep -q "^message plain" "$1"' - "$work/said"
check 'with its bytes' grep -Eq '^budget plain [0-9,]+ bytes; CPU [0-9,]+, GPU [0-9,]+$' "$work/said"
noh info "$work/plain.noh"
expect 0 'which opens'
prints "message uvs |warning|hat|mesh 'Sphere' primitive 0: the attribute TEXCOORD_1 was left out" 'a warning has its object'
prints 'result uvs FINISHED' 'and the pack is there'
prints "message renamed |warning|hat|mesh 'felt' primitive" 'by the name of its data'
prints 'selected hat hat' 'which can be selected'
noh info "$work/uvs.noh"
check 'shape keys are targets' grep -q smile "$work/out"
check 'levels were made' grep -q 'level 1:' "$work/out"
prints 'result none CANCELLED' 'nothing is an error'
prints 'message none |error||the file has no triangle meshes' 'that is shown'
prints 'nowhere cannot be run' 'so is a program that is not there'
check 'which leaves no pack' test ! -e "$work/missing.noh"
finish
