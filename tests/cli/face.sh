#!/bin/sh
# noh face and noh build --recipe: an artist's recipe goes first, what it lacks falls back, and bad lines are named.
. "$(dirname "$0")/lib.sh"

mask=$build/mask.glb
cat >"$work/mask.recipe" <<'END'
# what the mask's targets are for
blink "smile"     # both lids, by a strange target
aa smile 0.75
joy-mouth smile -0.5
PP noSuchTarget
END
noh build "$mask" -o "$work/with.noh" --recipe "$work/mask.recipe"
expect 0 'a recipe is built in'
check 'a target that is not there is a warning' grep -q "mask.recipe:5: no mesh has the target 'noSuchTarget'" "$work/out"
noh build "$mask" -o "$work/without.noh" --quiet
expect 0 'without one'
noh face "$work/with.noh"
expect 0 'face'
check 'its rows are counted' grep -q "own recipe has 5 rows" "$work/out"
check 'blink is the artist'"'"'s' grep -q "^  blink-left  *pack  *smile 1$" "$work/out"
check 'and both sides' grep -q "^  blink-right  *pack  *smile 1$" "$work/out"
check 'with its weight' grep -q "^  aa  *pack  *smile 0.75$" "$work/out"
check 'weights below 0 too' grep -q "^  joy-mouth  *pack  *smile -0.5$" "$work/out"
check 'what is missing falls back' sh -c '! grep -q "^  PP .*noSuchTarget" "$1"' - "$work/out"
noh face "$work/with.noh" --json
expect 0 'face --json'
check 'JSON' sh -c 'grep -q "\"recipe_rows\": *5" "$1" && grep -q "\"coverage\": *\"covered\"" "$1"' - "$work/out"
noh face "$work/without.noh"
expect 0 'without a recipe'
check 'the built-in one holds' sh -c '! grep -q " pack " "$1"' - "$work/out"
noh strip "$work/with.noh" -o "$work/stripped.noh" --from-level 0
expect 0 'strip keeps it'
noh face "$work/stripped.noh"
expect 0 'face of that'
check 'the recipe is there' grep -q "own recipe has 5 rows" "$work/out"

# line, wanted words
refused() {
    printf 'aa smile\n%s\n' "$1" >"$work/bad.recipe"
    noh build "$mask" -o "$work/bad.noh" --recipe "$work/bad.recipe"
    expect 1 "refused: $1"
    check "line and cause of: $1" grep -q "bad.recipe:2: .*$2" "$work/err"
    check 'no pack' test ! -e "$work/bad.noh"
}
refused 'wink smile' "'wink' is no channel"
refused 'PP' 'the target is missing'
refused 'PP smile 5' 'not within -4 to 4'
refused 'PP smile x' 'not a number'
refused 'PP smile 1 2' 'one word too many'
refused 'PP "smile' 'quote is not closed'
refused 'aa smile' 'has this target already, in line 1'
printf '# nothing\n' >"$work/empty.recipe"
noh build "$mask" -o "$work/bad.noh" --recipe "$work/empty.recipe"
expect 1 'an empty recipe'
check 'says so' grep -q 'the recipe has no row' "$work/err"
noh build "$mask" -o "$work/bad.noh" --recipe "$work/none.recipe"
expect 1 'no such file'

noh build "$mask" -o "$work/eyes.noh" --eyes
expect 0 'eyes of the mask'
check 'both are reported' sh -c 'grep -q "left eye, a ball of radius 0.018" "$1" && grep -q "right eye" "$1"' - "$work/out"
noh info "$work/eyes.noh"
check 'their joints are there' grep -q "skin 'face': 3 joints" "$work/out"
noh build "$build/demo_none.glb" -o "$work/bad.noh" --eyes
expect 1 'no such model'
finish
