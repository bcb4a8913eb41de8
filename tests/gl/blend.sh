#!/bin/sh
# The policy `--path blend`: layered draws where supported, per-layer passes otherwise, refused without float blending;
# and the line that `make demo` prints. The pictures equal gather's, which does not blend, byte for byte.
. tests/cli/lib.sh
mask=$build/mask.noh

noh render "$mask" --light none -o "$work/gather.png" --size 128x128 --weight smile=1 --path gather
if [ $code != 0 ]; then
    skip 'blending' 'no EGL context here'
    finish
fi
noh verify "$mask" --json
if ! grep -q '"driver": "llvmpipe' "$work/out"; then
    skip 'blending' 'this GL is not llvmpipe, whose switches the test knows'
    finish
fi

blends() { # NAME PATH ENVIRONMENT...
    name=$1 path=$2
    shift 2
    rm -f "$work/blend.png"
    env "$@" "$build/noh" render "$mask" --light none -o "$work/blend.png" --size 128x128 --weight smile=1 --path blend >"$work/out" 2>"$work/err"
    code=$?
    expect 0 "$name"
    check "$name: $path" grep -q " $path-f32 ($path: " "$work/out"
    check "$name: the picture is gather's" cmp "$work/gather.png" "$work/blend.png"
    env "$@" sh tools/demo_path.sh "$build/noh" "$mask" >"$work/out" 2>"$work/err"
    code=$?
    expect 0 "$name: demo_path.sh"
    check "$name: the demo draws by blending" sh -c 'test "$(sed -n 1p "$1")" = blend' - "$work/out"
    check "$name: and says so in one line" grep -q "^Drawn by $path-f32 (.*): 0 of [0-9]* values differ .*; auto would take cpu (.*software.*)\.\$" "$work/out"
}
blends 'everything' layered A=
blends 'no geometry shaders' per-layer MESA_GLES_VERSION_OVERRIDE=3.1 \
    MESA_EXTENSION_OVERRIDE='-GL_EXT_geometry_shader -GL_OES_geometry_shader'
blends 'ES 3.0' per-layer MESA_GLES_VERSION_OVERRIDE=3.0

export MESA_EXTENSION_OVERRIDE=-GL_EXT_float_blend
noh render "$mask" --light none -o "$work/none.png" --path blend
expect 1 'no float blending: refused'
says 'EXT_float_blend'
check 'and no picture is written' test ! -e "$work/none.png"
noh render "$mask" --light none -o "$work/half.png" --path blend --accumulate f16
expect 0 'halves still blend'
check 'and are layered' grep -q ' layered-f16 ' "$work/out"
sh tools/demo_path.sh "$build/noh" "$mask" >"$work/out" 2>"$work/err"
code=$?
expect 0 'demo_path.sh without float blending'
check 'the demo then draws by auto' sh -c 'test "$(sed -n 1p "$1")" = auto && grep -q "not by blending: .*EXT_float_blend" "$1"' - "$work/out"
unset MESA_EXTENSION_OVERRIDE
finish
