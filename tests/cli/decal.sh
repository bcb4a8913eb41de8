#!/bin/sh
# noh render --decal: marks are visible and stay in place in other poses and LOD levels; refused input.
. "$(dirname "$0")/lib.sh"

pack=$build/mask_levels.noh
noh render "$pack" -o "$work/plain.png" --size 128x128 --camera 0,0
expect 0 'render without marks'
noh render "$pack" -o "$work/mark.png" --size 128x128 --camera 0,0 --decal 0.5,0.35,0.02,22aa44
expect 0 'with one'
check 'which shows' sh -c '! cmp -s "$1" "$2"' - "$work/plain.png" "$work/mark.png"
noh render "$pack" -o "$work/again.png" --size 128x128 --camera 0,0 --decal 0.5,0.35,0.02,22aa44
check 'the same picture again' cmp "$work/mark.png" "$work/again.png"
for more in '--weight smile=1' '--lod 3' '--light none' '--debug light' '--path per-layer'; do
    # shellcheck disable=SC2086
    noh render "$pack" -o "$work/more.png" --size 128x128 --camera 0,0 --decal 0.5,0.35 --decal 0.45,0.6,0.01 $more
    expect 0 "with $more"
done
noh render "$build/demo/puppet_levels.noh" -o "$work/walk.png" --size 128x128 --decal 0.5,0.4 --clip walk --time 0.4
expect 0 'on a figure that walks'
for kind in rest grown; do
    noh sheet "$pack" -o "$work/$kind.png" --tile 96 --target smile --decal 0.5,0.35,0.02,22aa44 --decal-kind $kind
    expect 0 "a sheet with --decal-kind $kind"
    noh render "$pack" -o "$work/one_$kind.png" --size 128x128 --camera 0,0 --decal 0.5,0.35,0.02,22aa44 --decal-kind $kind
    expect 0 "a picture with --decal-kind $kind"
done
check 'a mark without folds is the same, grown' cmp "$work/one_rest.png" "$work/one_grown.png"
noh render "$pack" -o "$work/bad.png" --decal 0.5,0.35 --decal-kind other
expect 2 'an unknown kind of mark'
says 'rest or grown'
noh render "$pack" -o "$work/miss.png" --size 128x128 --camera 0,0 --decal 0.01,0.01
expect 1 'next to the figure'
says 'the figure at rest is not at 0.01,0.01 in the picture'
for bad in 0.5 1.5,0.5 0.5,0.5,-1 0.5,0.5,0.1,red 0.5,0.5,0.1,aabbcc,1 ''; do
    noh render "$pack" -o "$work/bad.png" --decal "$bad"
    expect 2 "--decal '$bad'"
done
finish
