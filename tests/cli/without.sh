#!/bin/sh
# noh built without Draco and the viewer's libraries: it reports what is missing, and everything else works.
. "$(dirname "$0")/lib.sh"

if [ ! -x "$build/noh_without" ]; then
    skip 'noh without optional libraries' 'built without sanitizers alone'
    finish
    exit 0
fi
noh_without() {
    "$build/noh_without" "$@" >"$work/out" 2>"$work/err"
    code=$?
}

noh_without view "$build/mask.noh"
expect 1 'a window'
says 'noh was built without glfw3 and imgui (Debian: apt install libglfw3-dev libimgui-dev'

cat >"$work/draco.gltf" <<'GLTF'
{ "asset": { "version": "2.0" }, "extensionsUsed": ["KHR_draco_mesh_compression"],
  "extensionsRequired": ["KHR_draco_mesh_compression"], "scene": 0, "scenes": [{ "nodes": [0] }],
  "nodes": [{ "mesh": 0 }], "buffers": [{ "uri": "data:application/octet-stream;base64,AAAAAA==", "byteLength": 4 }],
  "bufferViews": [{ "buffer": 0, "byteLength": 4 }],
  "accessors": [{ "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1] },
                { "componentType": 5123, "count": 3, "type": "SCALAR" }],
  "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1,
      "extensions": { "KHR_draco_mesh_compression": { "bufferView": 0, "attributes": { "POSITION": 0 } } } }] }] }
GLTF
noh_without build "$work/draco.gltf" -o "$work/draco.noh"
expect 1 'a mesh compressed by Draco'
says 'or build noh with Draco (Debian: apt install libdraco-dev)'
check 'no half-written file' sh -c '! ls "$1"/*.noh' - "$work"

noh build "$build/mask.glb" -o "$work/with.noh"
expect 0 'a model, by the whole program'
noh_without build "$build/mask.glb" -o "$work/without.noh"
expect 0 'and by this one'
check 'gives the same bytes' cmp "$work/with.noh" "$work/without.noh"
if command -v readelf >/dev/null; then
    check 'GLFW is needed by noh view alone, when it opens a window' sh -c '! readelf -d "$1" | grep -q glfw' - "$build/noh"
else
    skip 'GLFW is needed by noh view alone' 'no readelf here'
fi

finish
