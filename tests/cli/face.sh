#!/bin/sh
# noh face and noh build --recipe: an artist's recipe has priority over the built-in ones; bad lines are reported.
. "$(dirname "$0")/lib.sh"

mask=$build/mask.glb
cat >"$work/mask.recipe" <<'END'
# what the mask's targets are for
blink "smile"     # both lids, by a strange target
aa smile 0.75
joy-mouth smile -0.5
PP noSuchTarget
END
noh build "$mask" -o "$work/with.noh" --plain --wrinkles face --recipe "$work/mask.recipe"
expect 0 'a recipe is built in'
check 'a target that is not there is a warning' grep -q "mask.recipe:5: no mesh has the target 'noSuchTarget'" "$work/out"
noh build "$mask" -o "$work/without.noh" --plain --wrinkles face --quiet
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
check 'the built-in one holds' test "$(grep -c " pack " "$work/out")" = 0
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
refused 'wink smile' "'wink' is not a channel"
refused 'PP' 'the target is missing'
refused 'PP smile 5' 'must be -4 to 4'
refused 'PP smile x' 'not a number'
refused 'PP smile 1 2' 'one word too many'
refused 'PP "smile' 'quote is not closed'
refused 'aa smile' 'has this target twice; the first is in line 1'
printf '# nothing\n' >"$work/empty.recipe"
noh build "$mask" -o "$work/bad.noh" --recipe "$work/empty.recipe"
expect 1 'an empty recipe'
check 'says so' grep -q 'the recipe is empty' "$work/err"
noh build "$mask" -o "$work/bad.noh" --recipe "$work/none.recipe"
expect 1 'no such file'

noh build "$mask" -o "$work/eyes.noh" --eyes
expect 0 'eyes of the mask'
check 'both are reported' sh -c 'grep -q "left eye, a sphere of radius 0.018" "$1" && grep -q "right eye" "$1"' - "$work/out"
noh info "$work/eyes.noh"
check 'their joints are there' grep -q "skin 'face': 3 joints" "$work/out"
noh build "$build/demo_none.glb" -o "$work/bad.noh" --eyes
expect 1 'no such model'

# Correctives: by a text, by names, by glTF extras; a triangle; each target moves one corner by 1 along x.
triangle=$(printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0' | base64 | tr -d '\n')
cat >"$work/both.gltf" <<END
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},
"targets":[{"POSITION":1},{"POSITION":1},{"POSITION":1},{"POSITION":1}]}],
"extras":{"targetNames":["jaw","grin","jaw_grin","jaw50"],"recipe":["aa jaw 0.8","wink jaw","PP grin"]}}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,$triangle"}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]}
END
printf 'PP jaw_grin 0.25\ncorrective grin jaw 0.5 jaw50\n' >"$work/both.recipe"
noh build "$work/both.gltf" -o "$work/both.noh"
expect 0 'correctives by name'
check 'they are counted' grep -q '^2 correctives by target names' "$work/out"
check 'a malformed line of extras is a warning' grep -q "'wink jaw' was left out: 'wink' is not a channel" "$work/out"
noh face "$work/both.noh"
expect 0 'face of that'
check 'extras give a recipe' grep -q '^  aa  *pack  *jaw 0.8$' "$work/out"
check 'a combination' grep -q '^  corrective jaw_grin: jaw grin$' "$work/out"
check 'an in-between' grep -q '^  corrective jaw50: jaw at 0.5 (0 to 1)$' "$work/out"
noh face "$work/both.noh" --json
check 'in JSON' sh -c 'tr -d " \n" <"$1" | grep -q "{\"target\":\"jaw_grin\",\"drivers\":\[{\"name\":\"jaw\",\"from\":0,\"peak\":1"' - "$work/out"
shown() { # X WEIGHT...
    want=$1
    shift
    noh dump "$work/both.noh" -o "$work/both.obj" "$@"
    expect 0 "dump $*"
    check "the corner is at $want" test "$(awk '/^v /{ if ($2 > x) x = $2 } END { printf "%.3g", x }' "$work/both.obj")" = "$want"
}
shown 2 --weight jaw=1
shown 4 --weight jaw=1 --weight grin=1
shown 2.5 --weight jaw=0.5
shown 3 --weight jaw=1 --weight grin=1 --weight jaw_grin=0
noh build "$work/both.gltf" -o "$work/plain.noh" --no-correctives
check 'none by name where they are not wanted' sh -c '! grep -q "correctives by" "$1"' - "$work/out"
noh build "$work/both.gltf" -o "$work/both.noh" --recipe "$work/both.recipe"
expect 0 'a text beside extras'
noh face "$work/both.noh"
check 'the text goes first' grep -q '^  PP  *pack  *jaw_grin 0.25$' "$work/out"
check 'what it lacks is of extras' grep -q '^  aa  *pack  *jaw 0.8$' "$work/out"
check 'its correctives' grep -q '^  corrective grin: jaw at 0.5 (0 to 1) jaw50$' "$work/out"
refused 'corrective smile' 'corrective TARGET DRIVER'
refused 'corrective smile smile' 'cannot drive itself'
refused 'corrective smile blink 1.5' 'must be above 0 and at most 1'

# Rules for weights, kept where they are asked for.
cat >"$work/rules.recipe" <<'END'
range jaw 0 1
range grin -1 2
oppose jaw grin
share jaw grin
override joy-upper lids block
override anger-upper speech blend
binary fear-upper
expression jaw50 jaw 0.5
expression jaw50 grin
override jaw50 eyes blend
binary jaw50
END
noh build "$work/both.gltf" -o "$work/both.noh" --recipe "$work/rules.recipe" --no-correctives
expect 0 'rules for weights'
noh face "$work/both.noh"
check 'a range' grep -q '^  range grin: -1 to 2$' "$work/out"
check 'opposites' grep -q '^  opposed: jaw grin$' "$work/out"
check 'a group' grep -q '^  share 1: jaw grin$' "$work/out"
check 'an emotion over blinks' grep -q '^  override joy-upper lids block$' "$work/out"
check 'and one that shows whole' grep -q '^  binary fear-upper$' "$work/out"
check 'an expression by its name' grep -q '^  expression jaw50: jaw 0.5 grin 1$' "$work/out"
check 'which shows whole' grep -q '^  binary jaw50$' "$work/out"
check 'over looks' grep -q '^  override jaw50 eyes blend$' "$work/out"
check 'and one over speech' grep -q '^  override anger-upper speech blend$' "$work/out"
noh face "$work/both.noh" --json
check 'overrides in JSON' sh -c 'tr -d " \n" <"$1" | grep -qF "{\"channel\":\"joy-upper\",\"over\":\"lids\",\"how\":\"block\"}"' - "$work/out"
check 'in JSON' sh -c 'tr -d " \n" <"$1" | grep -q "{\"rule\":\"range\",\"target\":\"grin\",\"min\":-1,\"max\":2}"' - "$work/out"
shown 4 --weight jaw=3
shown 2 --weight jaw=3 --weight-rules
shown 1.75 --weight jaw=1.5 --weight grin=0.25 --weight-rules
shown 1 --weight jaw=1 --weight grin=1 --weight-rules
printf 'range jaw -2 0.5\n' >"$work/rules.recipe"
sed 's/"wink jaw"/"range jaw 0 3;range grin 0 0.25"/' "$work/both.gltf" >"$work/extras.gltf"
noh build "$work/extras.gltf" -o "$work/both.noh" --recipe "$work/rules.recipe" --no-correctives
noh face "$work/both.noh"
check 'a text goes before extras' grep -q '^  range jaw: -2 to 0.5$' "$work/out"
check 'which keep what it does not say' grep -q '^  range grin: 0 to 0.25$' "$work/out"
refused 'range jaw 0' 'range TARGET MIN MAX'
refused 'range jaw 0.5 1' 'needs MIN from -4 to 0'
refused 'range jaw 0 1 2' 'one word too many'
refused 'binary joy' 'such as `binary joy-upper`'
refused 'override joy lids block' 'such as `override joy-upper lids block`'
refused 'expression jaw' 'expression NAME TARGET'
refused 'override joy-upper lids' 'such as `override joy-upper lids block`'
refused 'override joy-upper lids block now' 'one word too many'
refused 'oppose jaw jaw' 'cannot exclude itself'
refused 'oppose jaw' 'oppose TARGET TARGET'
refused 'share jaw' 'share TARGET TARGET'

# A target for f and v, where there are lips that touch and teeth behind them.
noh build "$mask" -o "$work/lips.noh" --lips
expect 0 'the mask, whose lips are a little apart'
check 'has a target' grep -q "^mesh 'mask': lipToTeeth brings the lower lip to" "$work/out"
noh build "$work/both.gltf" -o "$work/lips.noh" --lips
expect 0 'a triangle has no lips'
check 'a warning says so' grep -q "^warning: --lips: mesh 'mesh_0': .*; f and v use its recipe" "$work/out"
if [ -e "${NOH_ASSETS:-none}/hero/head.glb" ]; then
    noh build "$NOH_ASSETS/hero/head.glb" -o "$work/lips.noh" --lips
    expect 0 'a head with teeth'
    check 'the lip is brought to them' grep -q "^mesh 'head': lipToTeeth brings the lower lip to" "$work/out"
    noh face "$work/lips.noh"
    check 'and f and v take it' grep -q '^  FF  *pack  *.*lipToTeeth 1$' "$work/out"
else
    skip 'a head with teeth' 'NOH_ASSETS does not name a folder of models'
fi

noh bench "$build/mask.noh" --only face --quick --json
expect 0 'a bench of a thousand faces'
check 'compared with the step of a controller' sh -c 'tr -d " \n" <"$1" | grep -q "\"face/weights\",\"baseline\":\"noh_controller_step\""' - "$work/out"

# A live face without a clip: nothing stands still in more than a twentieth of the pictures; each moment looks different.
noh face "$build/mask.noh" --idle 10 --json
expect 0 'ten seconds of idle'
check 'nothing stands still' awk '/"(outline|brows|lids|eyes|mouth)"/ { sub(",", "", $2); n++; if ($2 >= 0.05) bad = 1 }
    END { exit bad || n != 5 }' "$work/out"
noh face "$build/mask.noh" --idle 1
expect 0 'in words'
check 'a row' grep -q '^idle for 1 s, 30 pairs of pictures; without motion: outline ' "$work/out"
noh face "$build/mask.noh" --idle 1000
expect 2 'at most ten minutes'
noh sheet "$build/mask.noh" -o "$work/idle.png" --face on --time 2 --tiles 4 --columns 4 --tile 64
expect 0 'a sheet of a live face'
noh sheet "$build/mask.noh" -o "$work/targets.png" --tile 64
check 'not of its targets' sh -c 'test "$(wc -c <"$1")" -lt "$(wc -c <"$2")"' - "$work/idle.png" "$work/targets.png"
noh sheet "$build/mask.noh" -o "$work/x.png" --time 2
expect 2 '--time needs --face'
for t in 0 1 2; do
    noh render "$build/mask.noh" -o "$work/at_$t.png" --face on --time $t --size 96x96
    expect 0 "a face at $t s"
done
check 'at 1 s it has moved' sh -c '! cmp -s "$1" "$2"' - "$work/at_0.png" "$work/at_1.png"
check 'at 2 s again' sh -c '! cmp -s "$1" "$2"' - "$work/at_1.png" "$work/at_2.png"
finish
