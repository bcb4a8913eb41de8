#!/bin/sh
# noh lab light and noh build --transfer: figures and their order, JSON, refused input, strip and info.
. "$(dirname "$0")/lib.sh"

mask=$build/mask.glb
# A sheet of waves, 17 by 17 vertices: rays from every vertex of a demo model take a minute.
sheet=$work/sheet.obj
awk 'BEGIN {
    n = 16
    for (y = 0; y <= n; y++) for (x = 0; x <= n; x++) printf "v %.4f %.4f %.4f\n", x * 0.02, y * 0.02, 0.02 * sin(x * 0.7) * cos(y * 0.5)
    for (y = 0; y < n; y++) for (x = 0; x < n; x++) { a = y * (n + 1) + x + 1; printf "f %d %d %d %d\n", a, a + 1, a + n + 2, a + n + 1 }
}' >"$sheet"
noh build "$sheet" -o "$work/sheet.noh" --quiet
expect 0 'build without a transfer'
noh lab light "$work/sheet.noh"
expect 1 'a pack without transfers is refused'
says '--transfer 4 or 6'

noh build "$mask" -o "$work/x.noh" --transfer 5
expect 2 'an invalid order'
says "--transfer must be 4, 6, seed-4 or seed-6, not '5'"
noh build "$mask" -o "$work/x.noh" --transfer 4 --only anim
expect 2 'no transfer without meshes'

noh build "$sheet" -o "$work/sheet4.noh" --quiet --transfer 4 --lod 3 --lod-fast
expect 0 'build with a transfer'
noh info "$work/sheet4.noh"
expect 0 'info'
check 'shows it' grep -q 'transfer of order 4 about an axis of its own, 6 bytes a vertex' "$work/out"
noh info "$work/sheet4.noh" --json
check 'in JSON too' grep -q '"bytes_per_vertex": 6' "$work/out"
noh info "$work/sheet.noh" --json
check 'null where there is none' grep -q '"transfer": null' "$work/out"
noh strip "$work/sheet4.noh" -o "$work/small.noh" --from-level 1 --quiet
expect 0 'strip cuts it'
noh lab light "$work/small.noh" --rays 256
expect 0 'the stripped pack still has it'
noh render "$work/sheet4.noh" -o "$work/with.png" --size 100x100
expect 0 'render'
noh render "$work/sheet4.noh" -o "$work/without.png" --size 100x100 --transfer off
expect 0 'render without it'
check 'it changes the picture' sh -c '! cmp -s "$1" "$2"' - "$work/with.png" "$work/without.png"
noh render "$work/sheet.noh" -o "$work/lacks.png" --size 100x100
noh render "$work/sheet.noh" -o "$work/lacks_off.png" --size 100x100 --transfer off
check 'but not of a pack that has none' cmp "$work/lacks.png" "$work/lacks_off.png"
noh render "$work/sheet4.noh" -o "$work/x.png" --transfer soft
expect 2 'an unknown switch'
says "--transfer must be on or off, not 'soft'"
noh verify "$work/sheet4.noh"
expect 0 'verify'

noh lab light "$work/sheet4.noh" --rays 256
expect 0 'a table'
check 'of two poses' test "$(grep -c '^bind pose\|^posed' "$work/out")" = 2

noh build "$sheet" -o "$work/bounce.noh" --quiet --transfer 4 --bounce 0.5
expect 0 'build with one reflection'
noh info "$work/bounce.noh" --json
check 'it is in the pack, in 255ths' grep -q '"bounce": 128' "$work/out"
noh lab light "$work/bounce.noh" --rays 256
expect 0 'measure it'
noh build "$sheet" -o "$work/x.noh" --bounce 0.5
expect 2 'no reflection without a transfer'
says '--transfer'
noh build "$sheet" -o "$work/x.noh" --transfer 4 --bounce 1.5
expect 2 'more light than there is'
says '--bounce must be a number from 0 to 1'

noh lab light "$work/sheet4.noh" --rays 10
expect 2 'too few rays'
says '--rays must be a whole number from 64 to 65536'
noh lab light "$work/sheet4.noh" --rays 256 --weight no-such=1
expect 1 'a target that is not there'
says 'no-such'
noh lab light "$work/sheet4.noh" --rays 256 --weight nothing
expect 2 'no assignment'

# The figures of a head, if it is there: those that the README of the library states.
head=$assets/hero/head.glb
if [ ! -f "$head" ]; then
    skip 'figures of a head' "no $head"
elif [ -n "${NOH_SAN:-}" ]; then
    skip 'figures of a head' 'millions of rays take long under a sanitizer'
else
    for order in 4 6; do
        noh build "$head" -o "$work/head.noh" --plain --wrinkles face --quiet --transfer $order
        expect 0 "build a head with order $order"
        noh lab light "$work/head.noh" --json --rays 1024
        expect 0 'measure it'
        check 'within what is asked for, and better than about the normal' awk -F '[:, ]+' '
            /rms|bytes_per/ { gsub("\"", "", $2); v[$2] = $3 }
            END { exit !(v["bytes_per_vertex"] <= 8 && v["rms_soft"] <= 0.02 && v["rms_lamps"] <= 0.04 &&
                v["rms_morphed_soft"] <= 0.055 && v["rms_morphed_lamps"] <= 0.062 &&
                v["seed_rms_soft"] > 3 * v["rms_soft"] && v["seed_rms_morphed_soft"] > 1.5 * v["rms_morphed_soft"] &&
                v["rms_soft"] > 0 && v["rms_morphed_soft"] > v["rms_soft"]) }' "$work/out"
    done
    noh bench "$work/head.noh" --only look --quick --json
    expect 0 'a bench of looks'
    check 'with a row for the transfer' grep -q '"look/transfer"' "$work/out"
fi
finish
