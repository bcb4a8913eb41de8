#!/bin/sh
# The matrix: `noh verify` and one picture on every driver found, and on llvmpipe with reduced capabilities. float32
# must equal the CPU in every bit; so must float16 if the driver's rounding is modelled, else it must stay within the
# pack's bound. The picture is compared with llvmpipe's: the mean difference is at most 0.25/255, and at most 1 % of the
# pixels differ by more than 8 (edges and mip levels differ between rasterisers). tests/gl/test_gl_depth.c,
# test_gl_light.c, test_gl_wrinkles.c and a part of test_gl_share.c run on each other rasteriser too, and on llvmpipe with
# the fewest capabilities; with all of them they are tests of their own, and OSMesa is llvmpipe without EGL (NOH_LONG:
# everywhere). Prints a table of what ran.
. tests/cli/lib.sh
if [ -n "${NOH_SAN:-}" ]; then
    skip 'the matrix' 'other drivers run no other code of ours: the build without sanitizers compares them'
    finish
fi
mask=$build/mask.noh
table=$work/table
: >"$table"

noh render "$mask" --light none -o "$work/reference.png" --size 256x256 --weight smile=1 --path cpu
if [ $code != 0 ]; then
    skip 'the matrix' 'no EGL context here'
    finish
fi

ran() { # LOG: it has tests that passed; one that skips, or a filter that fits none, ends with 0, too
    check "$name: tests of it ran" sh -c 'grep -q "^\[ *OK \]\|^ok [0-9]* - " "$1" && ! grep -q "context here" "$1"' - \
        "$work/$1"
}
programs() { # ENVIRONMENT...
    env "$@" NOH_TEST_DRIVER="$driver" "$build/tests/gl/test_gl_depth" >"$work/depth" 2>&1
    code=$?
    expect 0 "$name: depth without colour is equal in every bit"
    ran depth
    check "$name: all of that ran" sh -c '! grep -q "SKIP\|skipped" "$1" || grep -q RGBA32UI "$1"' - "$work/depth"
    env "$@" NOH_TEST_DRIVER="$driver" "$build/tests/gl/test_gl_light" >"$work/light" 2>&1
    code=$?
    expect 0 "$name: light is the closed forms'"
    ran light
    env "$@" NOH_TEST_DRIVER="$driver" "$build/tests/gl/test_gl_wrinkles" >"$work/wrinkles" 2>&1
    code=$?
    expect 0 "$name: wrinkles are the CPU's, areas the triangles'"
    ran wrinkles
    env "$@" NOH_TEST_DRIVER="$driver" "$build/tests/gl/test_gl_share" slots_lend_and_borrow >"$work/share" 2>&1
    code=$?
    expect 0 "$name: stages that share are drawn as they are alone"
    ran share
}
row() { # NAME DRIVER LACKING programs|verify-alone ENVIRONMENT...: LACKING paths cannot run there ('' none)
    name=$1 driver=$2 lacking=$3 more=$4
    shift 4
    env "$@" "$build/noh" verify "$mask" --driver "$driver" --json >"$work/out" 2>"$work/err"
    code=$?
    if [ $code != 0 ] && grep -q 'no GL context' "$work/err"; then
        reason=$(grep . "$work/err" | tail -n 1 | cut -c 1-120)
        [ "$driver" != angle ] || reason=$(cat "$build/angle/missing.txt" 2>/dev/null || echo "$reason")
        skip "$name" "$reason"
        printf '%-34s not here\n' "$name" >>"$table"
        return
    fi
    expect 0 "$name: verify"
    # one line for each path that ran: "mrt f32 0"
    awk -F'"' '/"path":/ { path = $4 } /"accumulate":/ { format = $4 } /"available": true/ { on = 1 }
        /"available": false/ { on = 0 } /"differing":/ { gsub(/[^0-9]/, "", $3); if (on) print path, format, $3 }' "$work/out" >"$work/ran"
    check "$name: float32 is equal in every bit" sh -c 'grep -q " f32 0$" "$1" && ! grep " f32 " "$1" | grep -v " 0$"' - "$work/ran"
    for path in layered mrt per-layer gather direct cpu streams; do
        here=0
        grep -q "^$path f32 " "$work/ran" && here=1
        case " $lacking " in
        *" $path "*) check "$name: $path cannot run" test $here = 0 ;;
        *) check "$name: $path runs" test $here = 1 ;;
        esac
    done
    [ "$more" = verify-alone ] && [ -z "${NOH_LONG:-}" ] || programs "$@"
    auto=mrt
    case " $lacking " in *" mrt "*) auto=gather ;; esac
    env "$@" "$build/noh" render "$mask" --light none -o "$work/picture.png" --size 256x256 --weight smile=1 --driver "$driver" \
        --path $auto >"$work/out.txt" 2>"$work/err"
    code=$?
    expect 0 "$name: a picture with $auto"
    check "$name: it is llvmpipe's picture" "$build/tests/gl/picture_diff" "$work/reference.png" "$work/picture.png" 0.25 0.01
    printf '%-34s %-40s %2d ways, f16 %s; picture: %s\n' "$name" \
        "$(sed -n 's/.*"driver": "\([^"]*\)".*/\1/p' "$work/out" | cut -c 1-40)" "$(wc -l <"$work/ran")" \
        "$(if grep ' f16 ' "$work/ran" | grep -qv ' 0$'; then echo 'within the bound'; else echo equal; fi)" \
        "$(cat "$work/check")" >>"$table"
}

none='NOH_MATRIX=1'
row 'EGL' egl '' verify-alone $none
if grep -q 'llvmpipe' "$table"; then
    no_geometry='-GL_EXT_geometry_shader -GL_OES_geometry_shader'
    no_blend="$no_geometry -GL_EXT_float_blend"
    no_floats="$no_blend -GL_EXT_color_buffer_float -GL_EXT_color_buffer_half_float"
    row 'ES 3.1 without geometry shaders' egl layered verify-alone "MESA_GLES_VERSION_OVERRIDE=3.1" "MESA_EXTENSION_OVERRIDE=$no_geometry"
    row 'ES 3.0 without float blending' egl 'layered mrt per-layer' verify-alone MESA_GLES_VERSION_OVERRIDE=3.0 "MESA_EXTENSION_OVERRIDE=$no_blend"
    row 'ES 3.0 without float targets' egl 'layered mrt per-layer' programs MESA_GLES_VERSION_OVERRIDE=3.0 "MESA_EXTENSION_OVERRIDE=$no_floats"
else
    skip 'lesser devices' 'this GL is not llvmpipe, whose capabilities can be taken away'
fi
# libOSMesa and ANGLE keep what they allocated
row 'OSMesa' osmesa '' verify-alone "ASAN_OPTIONS=detect_leaks=0:${ASAN_OPTIONS:-}"
row 'ANGLE on SwiftShader' angle layered programs "ASAN_OPTIONS=detect_leaks=0:${ASAN_OPTIONS:-}"
lavapipe=$(ls /usr/share/vulkan/icd.d/lvp_icd.*.json 2>/dev/null | head -n 1)
if [ -z "$lavapipe" ]; then
    skip 'zink on lavapipe' 'no lavapipe here (mesa-vulkan-drivers)'
    printf '%-34s not here\n' 'zink on lavapipe' >>"$table"
else
    mkdir -m 700 "$work/runtime"
    row 'zink on lavapipe' egl '' programs GALLIUM_DRIVER=zink LIBGL_ALWAYS_SOFTWARE=1 "VK_ICD_FILENAMES=$lavapipe" \
        "XDG_RUNTIME_DIR=$work/runtime" "ASAN_OPTIONS=detect_leaks=0:${ASAN_OPTIONS:-}"
fi

sed 's/^/# /' "$table"
finish
