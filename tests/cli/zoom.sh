#!/bin/sh
# LOD levels are not noticeable in a slow zoom: silhouettes, surfaces, pops, flicker (tools/noh/zoom/zoom.h has the
# bounds); the cost of a level decreases with its vertices. NOH_ZOOM_FULL=1: 600 frames of every model, with silhouettes
# in each; otherwise only in some frames and at level changes, and without the body. Sanitized programs zoom only
# briefly.
. "$(dirname "$0")/lib.sh"

pack=$build/mask_levels.noh
mask="--weight smile=1 --weight eyeBlinkLeft=0.5 --weight eyeBlinkRight=0.5 --weight eyeSquintLeft=0.1 --weight eyeSquintRight=0.1"
face="--weight mouth-corner-puller=1 --weight eye-left-closure=0.5 --weight eye-right-closure=0.5 --weight nose-left-dilatation=0.2"
every="--every 30" few="--frames 160"
[ -z "${NOH_ZOOM_FULL:-}" ] || every= few=

field() { # NAME of the last run's JSON
    sed -n "s/.*\"$1\": \([^,]*\).*/\1/p" "$work/out"
}
holds() { # NAME, AWK EXPRESSION
    checked=$1
    shift
    check "$checked" awk "BEGIN { exit !($*) }"
}
tell() {
    echo "# $1: silhouettes $(field silhouette_px), slits $(field hole_px), surface $(field position_px) of claimed $(field claimed_px) pixels;" \
         "pops $(field pop), excess $(field excess) of 255; levels $(field levels_out) out, $(field levels_in) in"
}

noh lab zoom "$pack" --frames 4 --every 4 -o "$work/strip.png"
if [ $code != 0 ] && grep -q 'no GL context' "$work/err"; then
    skip 'zoom' 'no GL context here'
    finish
fi
expect 0 'a short one'
check 'a picture of it' sh -c 'test "$(od -An -tx1 -N4 "$1" | tr -d " \n")" = 89504e47' - "$work/strip.png"
if [ -n "${NOH_SAN:-}" ]; then
    skip 'zooms' 'a long one under a sanitizer'
    finish
fi

# ---- requirements ----

# NAME, LEVELS, PACK, OPTIONS: every level is entered once on each way, and what the runtime claims of the error is so
zooms() {
    name=$1 levels=$2
    shift 2
    noh lab zoom "$@" --json
    tell "$name"
    expect 0 "$name"
    holds "$name: every level, out and in" "$(field levels_out) == $levels - 1 && $(field levels_in) == $levels - 1 && $(field most_entered) == 1"
    holds "$name: no surface is farther off than claimed" "$(field position_px) <= $(field claimed_px) && $(field claimed_px) <= $(field pixels)"
    holds "$name: something was measured" "$(field position_px) > 0.05 && $(field silhouette_px) > 0 && $(field pop) > 0"
}
# LABEL PACK MOST_PAIRS: what levels cost, as shares of the full mesh's; tests/gl/test_level_costs.c holds the GPU to the
# same numbers
costs() {
    noh budget "$2" --nominal --json
    expect 0 "$1: budget"
    awk '/"levels": \[/ { on = 1 } /\]/ { on = 0 } on && /"(vertices|triangles|texels|pairs)":/ { gsub(/[",:]/, ""); v[$1] = $2 }
         on && /"gpu_bytes"/ { print v["vertices"], v["triangles"], v["texels"], v["pairs"] }' "$work/out" >"$work/levels"
    awk -v name="$1" 'NR == 1 { v = $1; t = $2; a = $3; p = $4 }
         { printf "# %s, level %d: vertices %.3f, triangles %.3f, accumulation texels %.3f, pairs %.3f\n", name, NR - 1, $1 / v, $2 / t, $3 / a, $4 / p }' "$work/levels"
    check "$1: four levels" test "$(wc -l <"$work/levels")" = 4
    # Seams and borders keep more of their vertices, the more the coarser: head.glb's last level has 1.251 times.
    check "$1: vertices fall as triangles" awk 'NR == 1 { v = $1; t = $2 } $1 / v > 1.3 * $2 / t { bad = 1 } END { exit bad }' "$work/levels"
    check "$1: accumulation texels fall as vertices, within a tenth" awk 'NR == 1 { v = $1; a = $3 } $3 / a > 1.1 * $1 / v { bad = 1 } END { exit bad }' "$work/levels"
    check "$1: and pairs, within $3 times" awk -v most="$3" 'NR == 1 { v = $1; p = $4 } $4 / p > most * $1 / v { bad = 1 } END { exit bad }' "$work/levels"
}

zooms 'the mask' 4 "$pack" $few $every $mask
holds 'targets were left out' "$(field targets_left_out) > 0"
costs 'the mask' "$pack" 1.1
models=head
[ -z "${NOH_ZOOM_FULL:-}" ] || models='head body'
for model in $models; do
    if [ ! -f "$assets/hero/$model.glb" ]; then
        skip "hero/$model.glb" 'not in NOH_ASSETS'
        continue
    fi
    noh build "$assets/hero/$model.glb" -o "$work/$model.noh" --plain --wrinkles face --lod 4 --lod-fast --quiet
    expect 0 "build of $model"
    [ $model = head ] && pose=$face || pose="--clip walk --time 0.5 --weight mouth-corner-puller=1"
    zooms $model 4 "$work/$model.noh" $few $every $pose
    # a face moved by targets keeps more than the rest
    costs $model "$work/$model.noh" 1.25
done

# ---- the measurements can fail ----

last="--frames 100 --near 3 --far 6 --every 100" # where the mask's last level is chosen
noh lab zoom "$pack" $last $mask --json
expect 0 'the last level, with fades'
noh lab zoom "$pack" $last $mask --json --no-fades --jitter 0.25
expect 1 'and without them'
holds 'levels that change at once pop' "$(field pop) > 1 && $(field excess) > 1"
holds 'and flicker where a camera shakes by more than the hysteresis' "$(field most_entered_shaken) > 1"
noh lab zoom "$pack" --frames 8 --near 0.45 --far 0.6 --size 512x512 --pixels 12 --weight smile=1 --json
holds 'a coarse level that is too near is off' "$(field silhouette_px) > 0.5 && $(field position_px) > 1.25"

# ---- what is refused ----

noh lab zoom "$build/mask.noh"
expect 1 'a pack without levels'
says 'noh build --lod'
for options in '--frames 3' '--frames 7.5' '--pixels 0' '--every 0' '--every 1.5' '--jitter 1' '--size 100x80' '--near 0.01'; do
    noh lab zoom "$pack" $options
    expect 2 "zoom $options"
done
noh lab zoom
expect 2 'zoom without a pack'

finish
