#!/bin/sh
# render, sheet and dump: files of the right kind and size, which depend on the weights but not on the path.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh

is_png() { # FILE WIDTH HEIGHT
    test "$(od -An -tx1 -N8 "$1" | tr -d ' \n')" = 89504e470d0a1a0a &&
        test "$(od -An -tu1 -j16 -N8 "$1" | awk '{ print (($1 * 256 + $2) * 256 + $3) * 256 + $4, (($5 * 256 + $6) * 256 + $7) * 256 + $8 }')" = "$2 $3"
}

noh render "$pack" -o "$work/rest.png" --size 96x64
if [ $code != 0 ] && grep -q 'no GL context' "$work/err"; then
    skip 'render, sheet and dump' 'no GL context here'
    finish
fi
expect 0 'render'
check 'a picture of the size asked for' is_png "$work/rest.png" 96 64
noh render "$pack" -o "$work/again.png" --size 96x64
check 'the same picture again' cmp "$work/rest.png" "$work/again.png"
noh render "$pack" -o "$work/smile.png" --size 96x64 --weight smile=1
expect 0 'render with a weight'
check 'another picture' sh -c '! cmp -s "$1" "$2"' - "$work/rest.png" "$work/smile.png"
noh render "$pack" -o "$work/zero.png" --size 96x64 --weight smile=1 --weight smile=0
check 'the last weight of a name counts' cmp "$work/rest.png" "$work/zero.png"

# Debug views of the plain renderer: each gives a different picture.
for view in none position normal tangent lod; do
    noh render "$pack" -o "$work/view_$view.png" --size 96x64 --debug $view
    expect 0 "render --debug $view"
done
check 'none is the picture' cmp "$work/view_none.png" "$work/rest.png"
check 'five different pictures' test "$(cksum "$work"/view_*.png | cut -d' ' -f1 | sort -u | wc -l)" = 5

# Equal sums make equal pictures, on the driver's every path; the path cpu hands finished vertices to the GPU, whose
# shader rounds nothing more, where it adds sums to a base in the others.
noh render "$pack" -o "$work/gather.png" --size 96x64 --weight smile=1 --path gather
for path in layered mrt per-layer cpu; do
    noh render "$pack" -o "$work/path.png" --size 96x64 --weight smile=1 --path $path
    if [ $code = 1 ] && grep -q 'not supported here' "$work/err"; then
        skip "render --path $path" "$(sed 's/^noh: [^:]*: //' "$work/err")"
        continue
    fi
    expect 0 "render --path $path"
    if [ $path = cpu ]; then
        check 'the picture of --path gather, except for a rounding' "$build/tests/gl/picture_diff" "$work/path.png" "$work/gather.png" 0.02 0
    else
        check 'the picture of --path gather' cmp "$work/path.png" "$work/gather.png"
    fi
done

noh sheet "$pack" -o "$work/sheet.png"
expect 0 'sheet'
check 'a picture' sh -c 'test "$(od -An -tx1 -N4 "$1" | tr -d " \n")" = 89504e47' - "$work/sheet.png"

# ---- dump ----

noh dump "$pack" -o "$work/rest.obj"
expect 0 'dump'
noh info "$pack" --json
vertices=$(sed -n '/"lods"/,/]/d; s/.*"vertices": \([0-9]*\).*/\1/p' "$work/out" | awk '{ n += $1 } END { print n }')
triangles=$(sed -n 's/.*"indices": \([0-9]*\).*/\1/p' "$work/out" | awk '{ n += $1 } END { print n / 3 }')
check "all $vertices vertices" test "$(grep -c '^v ' "$work/rest.obj")" = "$vertices"
check "all $triangles triangles" test "$(grep -c '^f ' "$work/rest.obj")" = "$triangles"
noh dump "$pack" -o "$work/smile.obj" --weight smile=1
check 'a weight moves vertices' sh -c '! cmp -s "$1" "$2"' - "$work/rest.obj" "$work/smile.obj"
noh dump "$pack" -o "$work/half.obj" --weight smile=0.5
# a target is linear: half way lies in the middle, within what floats and their text round
check 'half a weight moves them half as far' sh -c '
    for f in rest half smile; do grep "^v " "$1/$f.obj" >"$1/$f.v"; done
    paste "$1/rest.v" "$1/half.v" "$1/smile.v" | awk "
        { for (c = 2; c <= 4; c++) { d = \$c + \$(c + 14) - 2 * \$(c + 7); if (d > 1e-7 || d < -1e-7) bad++; if (\$c != \$(c + 14)) moved++ } }
        END { exit !(bad == 0 && moved > 100) }"' - "$work"
check 'every number is one' sh -c '! grep -q "nan\|inf" "$1"' - "$work/smile.obj"
finish
