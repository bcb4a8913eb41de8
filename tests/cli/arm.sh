#!/bin/sh
# demo_assets --arm: every kind of skinning on the same arm (Direct3D 9, "Geometry Blending") and two streams: info of
# the packs, and positions of vertices when the arm bends and twists.
. "$(dirname "$0")/lib.sh"

check 'the arm is made' "$build/demo_assets" --arm "$work/arm.glb"
check 'the same bytes every time' cmp "$work/arm.glb" "$build/demo/arm.glb"

noh build "$work/arm.glb" -o "$work/arm.noh" --dual-quaternion twisted_dual --two-stream stream_a=stream_b
expect 0 'the converter takes it'
check 'without a warning' sh -c '! grep -q warning "$1"' - "$work/err"
check 'the segments become one mesh' grep -q "joined 2 rigid and 0 skinned meshes of skeleton 'segmented'" "$work/out"

# ---- info ----

noh info "$work/arm.noh"
expect 0 'info'
check 'six meshes: the second stream is a target now' grep -q ' 6 meshes, .* 5 skeletons, 5 clips' "$work/out"
skin() { # NAME JOINTS INFLUENCES... HOW
    check "skin '$1': $3 of $2 joints, with $4" grep -q "^  skin '$1': $2 joints, $3 per vertex, 1 palette, with $4\$" "$work/out"
}
skin segmented 2 '1 influence' matrices
skin bent 2 '2 influences' matrices
skin four 4 '4 influences' matrices
skin twisted_linear 2 '2 influences' matrices
skin twisted_dual 2 '2 influences' 'dual quaternions'
check 'the second stream is the target' grep -q '^    stream_b  *5960 pairs' "$work/out"
if [ -n "$json" ]; then
    noh info "$work/arm.noh" --json
    holds() {
        check "info --json: $1" $json "$1" <"$work/out"
    }
    holds 'j.meshes[1].skin.name === "four" && j.meshes[1].skin.joints === 4 && j.meshes[1].skin.influences === 4'
    holds 'j.meshes[2].skin.palettes === 1 && j.meshes[2].skin.dual_quaternion === false && j.meshes[3].skin.dual_quaternion === true'
    holds 'j.meshes[4].name === "stream_a" && j.meshes[4].skin === null'
else
    skip 'info --json' 'neither node nor python3 is here'
fi

noh build "$work/arm.glb" -o "$work/two.noh" --influences 2 --quiet
expect 0 'fewer joints a vertex'
noh info "$work/two.noh"
skin four 4 '2 influences' matrices
noh build "$work/arm.glb" -o "$work/x.noh" --dual-quaternion stream_a
expect 1 'a rigid mesh has no kind of skinning'
says "no skinned mesh is named 'stream_a'"
noh build "$work/arm.glb" -o "$work/x.noh" --two-stream stream_a=bent
expect 1 'two streams of different triangles are refused'
says 'must have the same'

# ---- where the vertices are ----

dump() { # FILE OPTIONS
    to=$1
    shift
    noh dump "$work/arm.noh" -o "$work/$to.obj" "$@"
    expect 0 "dump $to"
}
dump rest
dump twisted --clip twist --time 1.5
dump bent --clip bend --time 1.5
dump open --weight stream_b=1
dump half --weight stream_b=0.5

# Smallest and largest distance of a ring from the arm's axis, over the arm's radius of 0.14: the vertices of object $1
# at height $3 about the axis x = $2.
ring() { # OBJECT X Y FILE
    awk -v want="$1" -v x="$2" -v y="$3" '
        $1 == "o" { inside = $2 == want }
        inside && $1 == "v" && $3 > y - 1e-3 && $3 < y + 1e-3 {
            r = sqrt(($2 - x) ^ 2 + $4 ^ 2) / 0.14
            low = !n || r < low ? r : low
            high = r > high ? r : high
            n++
        }
        END { print n + 0, low + 0, high + 0 }' "$work/$4.obj"
}
is_ring() { # NAME CONDITION-ON-low-AND-high OBJECT X Y FILE
    found=$(ring "$3" "$4" "$5" "$6")
    echo "# $3, $6: vertices of the ring, smallest and largest radius: $found"
    # shellcheck disable=SC2086
    set -- "$1" "$2" $found
    check "$1" awk -v n="$3" -v low="$4" -v high="$5" "BEGIN { exit !(n >= 32 && $2) }"
}
is_ring 'the wrist at rest' 'low > 0.999 && high < 1.001' twisted_linear -1.05 0.75 rest
is_ring 'twisted by half a turn, linear blending has collapsed there' 'high < 0.1' twisted_linear -1.05 0.75 twisted
is_ring 'dual quaternions keep the radius' 'low > 0.95 && high < 1.05' twisted_dual -0.45 0.75 twisted
is_ring 'beyond the wrist both keep it' 'low > 0.95 && high < 1.05' twisted_linear -1.05 1 twisted

# The largest stretch of an edge of object $1 when it bends: rigid parts do not stretch, a blended arm stretches at the
# outside of the elbow.
stretch() {
    awk -v want="$1" '
        function far(x, y, z, a, b) { return sqrt((x[a] - x[b]) ^ 2 + (y[a] - y[b]) ^ 2 + (z[a] - z[b]) ^ 2) }
        $1 == "o" { inside = $2 == want }
        $1 == "v" && FNR == NR { m++; u[m] = $2; v[m] = $3; w[m] = $4 }
        $1 == "v" && FNR != NR { n++; x[n] = $2; y[n] = $3; z[n] = $4 }
        $1 == "f" && FNR != NR && inside {
            for (i = 2; i <= 4; i++) {
                split($i, a, "/")
                split($(i == 4 ? 2 : i + 1), b, "/")
                grown = far(x, y, z, a[1], b[1]) / far(u, v, w, a[1], b[1])
                most = grown > most ? grown : most
            }
        }
        END { print most + 0 }' "$work/rest.obj" "$work/bent.obj"
}
segmented=$(stretch segmented) bent=$(stretch bent) four=$(stretch four)
echo "# edges grow by: segmented $segmented, bent $bent, four $four"
check 'segments are not stretched' awk -v s="$segmented" 'BEGIN { exit !(s > 0.999 && s < 1.001) }'
check 'the blended elbow is' awk -v s="$bent" 'BEGIN { exit !(s > 1.5) }'
check 'four joints spread it' awk -v s="$four" -v b="$bent" 'BEGIN { exit !(s > 1.1 && s < b) }'

# Half way lies in the middle of both shapes.
check 'half the weight is half way' sh -c '
    for f in rest half open; do grep "^v " "$1/$f.obj" >"$1/$f.v"; done
    paste "$1/rest.v" "$1/half.v" "$1/open.v" | awk "
        { for (c = 2; c <= 4; c++) { d = \$c + \$(c + 14) - 2 * \$(c + 7); if (d > 1e-6 || d < -1e-6) bad++; if (\$c != \$(c + 14)) moved++ } }
        END { exit !(bad == 0 && moved > 6000) }"' - "$work"

# ---- pictures ----

# Data textures need no GL: the pixels are tests/unit/tools/test_data_page.c's.
noh sheet "$work/arm.noh" -o "$work/data.png" --data
expect 0 'a sheet of data textures'
noh sheet "$work/arm.noh" -o "$work/less.png" --data --target stream_b=0.5
expect 0 'of one target'
noh sheet "$work/arm.noh" -o "$work/again.png" --data --target stream_b=0.25
check 'at another weight its sum is another' sh -c '! cmp -s "$1" "$2"' - "$work/less.png" "$work/again.png"
noh sheet "$work/arm.noh" -o "$work/x.png" --data --target stream_c
expect 1 'data of a target that is not there'
says "did you mean 'stream_b'"
noh sheet "$build/demo/puppet.noh" -o "$work/x.png" --data --clip walk
expect 2 'clips have none'

noh sheet "$work/arm.noh" -o "$work/streams.png" --target stream_b=0.5 --target stream_b --columns 3 --tile 64
if [ $code != 0 ] && grep -q 'no GL context' "$work/err"; then
    skip 'sheet --target NAME=V' 'no GL context here'
    finish
fi
expect 0 'a sheet of a target at two weights'
noh sheet "$work/arm.noh" -o "$work/full.png" --target stream_b --target stream_b --columns 3 --tile 64
check 'whose weights show' sh -c '! cmp -s "$1" "$2"' - "$work/streams.png" "$work/full.png"
# The source's demo: a weight that goes up and down with time.
noh sheet "$work/arm.noh" -o "$work/pong.png" --target stream_b --ping-pong 0.5 --tiles 4 --columns 4 --tile 64
expect 0 'a ping-pong'
noh sheet "$work/arm.noh" -o "$work/held.png" --target stream_b=0.5 --target stream_b --target stream_b=0.5 --columns 4 --tile 64
noh sheet "$work/arm.noh" -o "$work/late.png" --target stream_b --target stream_b=0.5 --target stream_b --columns 4 --tile 64
check 'there half way, whole, half way back: but for labels as tiles of these weights' \
    "$build/tests/gl/picture_diff" "$work/pong.png" "$work/held.png" 1.5 0.02
check 'and not as others' sh -c '! "$1" "$2" "$3" 1.5 0.02 >/dev/null' - "$build/tests/gl/picture_diff" "$work/pong.png" "$work/late.png"
noh sheet "$work/arm.noh" -o "$work/x.png" --ping-pong 0.5
expect 2 'a ping-pong of no target'
noh sheet "$work/arm.noh" -o "$work/x.png" --target stream_b --target stream_b --ping-pong 0.5
expect 2 'of two'
noh sheet "$work/arm.noh" -o "$work/x.png" --target stream_b --ping-pong -1
expect 2 'of a time below 0'
noh sheet "$work/arm.noh" -o "$work/x.png" --target stream_b --ping-pong 0.5 --data
expect 2 'of textures'
noh sheet "$work/arm.noh" -o "$work/x.png" --target stream_c=0.5
expect 1 'a target that is not there'
says "did you mean 'stream_b'"
finish
