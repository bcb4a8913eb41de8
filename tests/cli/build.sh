#!/bin/sh
# noh build: the same bytes every time and for every form of the same targets; the requested error; info.
. "$(dirname "$0")/lib.sh"

mask=$build/mask.glb

noh build "$mask" -o "$work/a.noh" --quiet
expect 0 'build'
check '--quiet prints nothing' test ! -s "$work/out"
cp "$mask" "$work/renamed.glb"
cp "$build/wig.noh" "$work/b.noh"
(cd "$work" && "$build/noh" build renamed.glb -o b.noh) >"$work/out" 2>"$work/err"
code=$?
expect 0 'build over another pack, from another folder and under another name'
check 'and reports' test -s "$work/out"
check 'the same bytes' cmp "$work/a.noh" "$work/b.noh"
check 'no other file is left in its folder' sh -c 'test "$(ls "$1" | grep -c noh)" = 2' - "$work"

# ---- the error and the rectangles asked for ----

# The largest position_error_um that info prints, rounded up.
worst() {
    noh info "$1" --json
    sed -n 's/.*"position_error_um": \([0-9.e+-]*\).*/\1/p' "$work/out" | awk '$1 > m { m = $1 } END { print m + 0 }'
}
for asked in '100 1' '1 4'; do
    um=${asked% *} rects=${asked#* }
    noh build "$mask" -o "$work/e.noh" --error-um $um --rects $rects --quiet
    expect 0 "build --error-um $um --rects $rects"
    error=$(worst "$work/e.noh")
    check "its certified errors are at most $um um ($error)" awk "BEGIN { exit !($error > 0 && $error <= $um) }"
    most=$(awk '/"position_bits"/ { inside = 1 } /"rects":/ { gsub(/[^0-9]/, ""); v = $0 } inside { if (v > m) m = v; inside = 0 } END { print m + 0 }' "$work/out")
    check "no target has more than $rects rectangles ($most)" test "$most" -ge 1 -a "$most" -le $rects
done

# ---- one head in three containers ----

if [ -f "$assets/hero/head.glb" ] && [ -f "$assets/hero/head_sparse.glb" ]; then
    noh build "$assets/hero/head.glb" -o "$work/dense.noh" --quiet
    expect 0 'build of head.glb'
    noh build "$assets/hero/head_sparse.glb" -o "$work/sparse.noh" --quiet
    expect 0 'build of head_sparse.glb'
    check 'dense and sparse targets give the same pack' cmp "$work/dense.noh" "$work/sparse.noh"
else
    skip 'dense and sparse targets give the same pack' 'no hero/head.glb in NOH_ASSETS'
fi

# ---- a head and a body ----

noh build "$mask" --seam maybe -o "$work/x.noh"
expect 2 '--seam wants check, mend or off'
noh build "$mask" --attach "$work/nobody.glb" -o "$work/x.noh"
expect 1 'what is attached must be there'
check 'and is named' grep -q nobody.glb "$work/err"
noh build "$build/demo/arm.glb" --attach "$build/demo/puppet.glb" -o "$work/x.noh"
expect 1 'joints of other names'
check 'are reported' grep -q 'none of its joints has the name' "$work/err"
noh build "$build/demo/arm.glb" --attach "$build/demo/arm.glb" --only mesh -o "$work/two.noh"
expect 0 'what is attached shares the joints'
# A face without joints, on a joint: the head's, or one that is named.
sh "$(dirname "$0")/../support/small_glb.sh" >"$work/small.glb"
noh build "$work/small.glb" --attach "$mask" --only mesh -o "$work/x.noh"
expect 0 'a face that nothing moves'
check 'is a warning' grep -q "no joint moves it, as none of the model's joints has 'head' in its name" "$work/out" "$work/err"
noh build "$work/small.glb" --attach "$mask" --attach-joint b --only mesh -o "$work/x.noh"
expect 0 'a face on a joint'
check 'without a warning' sh -c '! grep -q "nothing moves it" "$1" "$2"' - "$work/out" "$work/err"
noh info "$work/x.noh"
check 'is moved by it' grep -q "skin 'mask': 1 joint" "$work/out"
noh build "$work/small.glb" --attach "$mask" --attach-joint c --only mesh -o "$work/x.noh"
expect 1 'a face on no joint'
check 'is reported' grep -q "no joint 'c'" "$work/err"
noh build "$mask" --attach-joint b -o "$work/x.noh"
expect 2 'a joint without a face'
noh build "$work/small.glb" --seam mend --only mesh -o "$work/x.noh"
expect 0 'nothing to mend'
check 'is a warning' grep -q 'no seam was closed' "$work/out" "$work/err"

# ---- textures without what no triangle reads ----

# A triangle over a corner of a picture of 64 x 64 texels.
printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0' >"$work/corner.bin"
printf '\315\314\314\75\315\314\314\75\315\314\114\76\315\314\314\75\315\314\314\75\315\314\114\76' >>"$work/corner.bin"
noh render "$build/mask.noh" -o "$work/corner.png" --size 64x64
expect 0 'a picture to be a texture'
cat >"$work/corner.gltf" <<'END'
{"asset": {"version": "2.0"}, "buffers": [{"uri": "corner.bin", "byteLength": 60}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
 "images": [{"uri": "corner.png"}], "textures": [{"source": 0}],
 "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
 "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}
END
noh build "$work/corner.gltf" -o "$work/corner.noh"
expect 0 'build of a corner of a texture'
check 'the report says what is left' grep -q '1 of 1 textures trimmed to what triangles read: 10%' "$work/out"
noh info "$work/corner.noh"
check 'and info what it was' grep -q ': 20 x 20, .*, trimmed from 64 x 64' "$work/out"
noh info "$work/corner.noh" --json
check 'in JSON, too' grep -q '"whole_width": 64' "$work/out"
noh verify "$work/corner.noh"
expect 0 'it verifies'
noh build "$work/corner.gltf" -o "$work/corner.noh" --textures pvrtc
expect 2 'build with textures of an unknown format'
says "--textures must be etc2, astc or raw, not 'pvrtc'"
if command -v astcenc >/dev/null 2>&1; then
    noh build "$work/corner.gltf" -o "$work/astc.noh" --textures astc --quiet
    expect 0 'build --textures astc'
    noh info "$work/astc.noh"
    check 'and info says its blocks' grep -q ': 20 x 20, .*, ASTC [4-8]x[4-8] [0-9.]* dB, .* bytes on the GPU$' "$work/out"
    noh budget "$work/astc.noh"
    check 'and so does the budget' grep -q "^texture .*, ASTC [4-8]x" "$work/out"
    noh pack "$work/astc.noh" -o "$work/astc.nohz"
    noh info "$work/astc.nohz"
    check 'its wire form keeps them' grep -q "^texture .*, ASTC [4-8]x" "$work/out"
    noh verify "$work/astc.noh"
    expect 0 'it verifies'
else
    skip 'build --textures astc' 'astcenc is not installed'
fi
noh build "$work/corner.gltf" -o "$work/corner.noh" --whole-textures
expect 0 'build --whole-textures'
noh info "$work/corner.noh"
check 'keeps all of it' grep -q ': 64 x 64, ' "$work/out"

# ---- a cutoff that cuts nothing ----

# 64 x 64 texels, red and solid on the left, clear on the right.
{
    printf '\211PNG\r\n\032\n\0\0\0\015IHDR\0\0\0\100\0\0\0\100\1\3\0\0\0\220\247\343\235'
    printf '\0\0\0\6PLTE\310\40\20\20\40\310\0\0\0\0\0\0\0\2tRNS\377\0\0\0\0\0\0\0\2\113IDAT\170\1\1\100\2\277\375'
    for _ in 0 1 2 3 4 5 6 7; do
        for _ in 0 1 2 3 4 5 6 7; do printf '\0\0\0\0\0\377\377\377\377'; done
    done
    printf '\0\0\0\0\0\0\0\0\0\0\0\0IEND\256B\140\202'
} >"$work/half.png"
sed 's/corner.png/half.png/; s/"pbrMetallicRoughness"/"alphaMode": "MASK", &/' "$work/corner.gltf" >"$work/solid.gltf"
sed 's/"asset"/"extensionsUsed": ["KHR_texture_transform"], &/
s/"index": 0}/"index": 0, "extensions": {"KHR_texture_transform": {"scale": [4, 4]}}}/' "$work/solid.gltf" >"$work/cut.gltf"
for name in solid cut; do
    noh build "$work/$name.gltf" -o "$work/$name.noh"
    expect 0 "build of a material with a cutoff: $name"
    noh info "$work/$name.noh"
    cp "$work/out" "$work/$name.info"
    noh render "$work/$name.noh" -o "$work/$name.png" --size 64x64
    noh build "$work/$name.gltf" -o "$work/whole.noh" --whole-textures --quiet
    noh render "$work/whole.noh" -o "$work/whole.png" --size 64x64
    check 'its picture is of the whole texture with its cutoff' cmp "$work/$name.png" "$work/whole.png"
done
check 'a material that reads solid texels alone is opaque' grep -q "^material .*, opaque" "$work/solid.info"
check 'and has blocks without alpha' grep -q 'ETC2 RGB [0-9]' "$work/solid.info"
check 'one that is moved to clear texels is not' grep -q "^material .*, mask" "$work/cut.info"
finish
