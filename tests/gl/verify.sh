#!/bin/sh
# `noh verify`: every path and format against the CPU, on every model, and with capabilities disabled: every path that
# runs must give equal values. For drivers see matrix.sh.
. tests/cli/lib.sh

# Run `env VARIABLE=VALUE... noh verify PACK` and report the result.
verify() { # NAME PACK ENVIRONMENT...
    name=$1 pack=$2
    shift 2
    env "$@" "$build/noh" verify "$pack" --json $options >"$work/out" 2>"$work/err"
    code=$?
    expect 0 "$name"
    check "$name: it says ok" grep -q '"ok": true' "$work/out"
    check "$name: nothing differs" sh -c 'grep -q "\"differing\": 0" "$1" && ! grep "\"differing\"" "$1" | grep -qv ": 0,"' - "$work/out"
}
options=

# ---- models ----

verify 'the mask' "$build/mask.noh" >"$work/said"
if [ $code != 0 ] && grep -q 'no GL context' "$work/err"; then
    tests=0 failures=0
    skip 'verify' 'no GL context here'
    finish
fi
cat "$work/said"
cp "$work/out" "$work/all"
options='--seed 2'
verify 'the mask, seed 2' "$build/mask.noh"

options=--without-tangents
verify 'the mask without tangents' "$build/mask.noh"
verify 'the mask with levels, without tangents' "$build/mask_levels.noh"
options=

# Vertices that name their delta texels themselves: with LOD levels, and split by palettes.
verify 'the mask with levels' "$build/mask_levels.noh"
noh build "$build/demo/puppet.glb" -o "$work/split.noh" --plain --wrinkles face --quiet --only mesh --palette 6
expect 0 'build of a puppet that is split'
verify 'a puppet that is split' "$work/split.noh"

for model in hero/head.glb hero/head_sparse.glb hero/head_meshopt.glb hero/identity.glb hero/body.glb \
             khronos/AnimatedMorphCube/glTF/AnimatedMorphCube.gltf khronos/AnimatedMorphSphere/glTF/AnimatedMorphSphere.gltf \
             khronos/MorphPrimitivesTest/glTF/MorphPrimitivesTest.gltf khronos/SimpleMorph/glTF/SimpleMorph.gltf \
             khronos/three-vrm-cube/cube.gltf khronos/MorphStressTest.glb khronos/RobotExpressive.glb khronos/Fox.glb \
             khronos/SimpleSkin.gltf khronos/SimpleSparseAccessor.gltf; do
    if [ ! -f "$assets/$model" ]; then
        skip "$model" 'not in NOH_ASSETS'
        continue
    fi
    noh build "$assets/$model" -o "$work/model.noh" --plain --wrinkles face --effort 1 --quiet
    expect 0 "build of $model"
    verify "$model" "$work/model.noh"
done

# ---- skins: joints as they were stored, split, and by dual quaternions; without clips, in random poses ----

skinned() { # MODEL, OPTIONS OF noh build
    model=$1
    shift
    if [ ! -f "$assets/$model" ]; then
        skip "$model $*" 'not in NOH_ASSETS'
        return
    fi
    noh build "$assets/$model" -o "$work/skin.noh" --plain --wrinkles face --quiet --only mesh "$@"
    expect 0 "build of $model $*"
    verify "$model $*" "$work/skin.noh"
    check "and skinned vertices were compared" sh -c 'test "$(grep -c "\"path\": \"skin/" "$1")" = 2' - "$work/out"
}
skinned hero/body_8inf.glb
skinned hero/body_quantized.glb
skinned hero/body_8inf.glb --influences 1
skinned hero/body.glb --palette 12
skinned hero/body.glb --dual-quaternion all
skinned khronos/SimpleSkin.gltf --influences 1 --dual-quaternion all

# ---- disabled capabilities ----

missing() { # the last run's JSON tells of a path that is not here, for this reason
    check "and tells that $1 is missing" sh -c 'grep -A1 "\"available\": false" "$1" | grep -F -q "$2"' - "$work/out" "$1"
}
full() { # all ten are here
    check 'and all paths are here' sh -c 'test "$(grep -c "\"available\": true" "$1")" -ge 10' - "$work/all"
}
if grep -q '"driver": "llvmpipe' "$work/all"; then
    full
    verify 'ES 3.0' "$build/mask.noh" MESA_GLES_VERSION_OVERRIDE=3.0
    verify 'ES 3.1' "$build/mask.noh" MESA_GLES_VERSION_OVERRIDE=3.1
    verify 'no float blending' "$build/mask.noh" MESA_EXTENSION_OVERRIDE=-GL_EXT_float_blend
    missing EXT_float_blend
    verify 'no geometry shaders' "$build/mask.noh" MESA_EXTENSION_OVERRIDE='-GL_EXT_geometry_shader -GL_OES_geometry_shader'
    missing geometry
    verify 'no float targets' "$build/mask.noh" MESA_EXTENSION_OVERRIDE=-GL_EXT_color_buffer_float
    missing RGBA32F
    verify 'bare ES 3.0' "$build/mask.noh" MESA_GLES_VERSION_OVERRIDE=3.0 \
        MESA_EXTENSION_OVERRIDE='-GL_EXT_color_buffer_float -GL_EXT_color_buffer_half_float -GL_EXT_float_blend -GL_EXT_geometry_shader -GL_OES_geometry_shader'
    missing RGBA32F
    options=--without-tangents
    verify 'bare ES 3.0 without tangents' "$build/mask.noh" MESA_GLES_VERSION_OVERRIDE=3.0 \
        MESA_EXTENSION_OVERRIDE='-GL_EXT_color_buffer_float -GL_EXT_color_buffer_half_float -GL_EXT_float_blend -GL_EXT_geometry_shader -GL_OES_geometry_shader'
    options=
    if [ -f "$work/skin.noh" ]; then
        verify 'a skin on bare ES 3.0' "$work/skin.noh" MESA_GLES_VERSION_OVERRIDE=3.0 \
            MESA_EXTENSION_OVERRIDE='-GL_EXT_color_buffer_float -GL_EXT_color_buffer_half_float -GL_EXT_float_blend'
    fi
else
    skip 'capabilities taken away' 'this GL is not llvmpipe, whose switches the test knows'
fi

finish
