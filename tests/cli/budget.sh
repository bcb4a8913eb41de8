#!/bin/sh
# noh budget of a stage: sums of parts, limits and reported concessions, --desc, JSON, refused input. json.sh tests the
# budget of a load, without --actors and --desc.
. "$(dirname "$0")/lib.sh"

puppet=$build/demo/puppet_levels.noh
mask=$build/mask_levels.noh

# ---- a kind ----

# The rows between the head and "sum" exist and add up to it, CPU and GPU.
adds_up() {
    awk 'NR > 1 && $1 == "sum" { exit !(cpu == $2 && gpu == $3 && cpu > 0 && NR > 5) }
         NR > 1 { cpu += $(NF - 1); gpu += $NF }' "$1"
}
sum_of() { # COLUMN FILE
    awk -v column="$1" '$1 == "sum" { print $column; exit }' "$2"
}

noh budget "$build/mask.noh" --nominal
expect 0 'a mask'
check 'what a material has and costs' grep -q "^material 'paint': plain, 4 textures of 223952 bytes, a pixel makes 2 fetches, 7 under a light with a shadow" "$work/out"
noh budget "$build/mask.noh" --nominal --why
expect 0 'why this path'
# The nominal device is no software rasteriser: the cheapest of mrt, gather and direct is used.
check 'the path named is the cheapest one' awk '
    /^why: / { taken = $2; sub(":", "", taken) } $1 == "mrt" { mrt = $2 } $1 == "gather" { gather = $2 }
    $1 == "direct" { direct = $2 }
    END { sums = gather <= mrt ? "gather" : "mrt"; least = gather <= mrt ? gather : mrt
          exit !(mrt > 0 && gather > 0 && direct > 0 && taken == (direct < least ? "direct" : sums)) }' "$work/out"
check 'the most that an update sends is reported' grep -q '^an update of all instances sends at most [1-9]' "$work/out"
if [ -n "$json" ]; then
    noh budget "$build/mask.noh" --nominal --why --json
    check 'as JSON, too' sh -c '[ -s "$1" ]' - "$work/out"
    check 'with every cost' $json 'j.why.costs.mrt > 0 && j.why.costs.gather > 0 && j.why.costs.direct > 0 && j.why.draws == 1 && j.why.costs.per_layer > 0 && j.why.costs.cpu > 0 && j.why.update_bytes > 0' <"$work/out"
fi
for tier in full phone; do
    noh budget "$build/mask.noh" --nominal --gpu g52 --size 1280x720 --tier $tier
    expect 0 "the share of a frame on a phone's GPU, $tier"
    check "of the material with maps, $tier" grep -q 'paint .* of a frame .* 1280x720: plain-maps-lit' "$work/out"
done
noh budget "$build/mask.noh" --nominal --gpu v3d --json
expect 0 'the same as JSON'
check 'JSON has it' grep -q '"program": "plain-maps-lit"' "$work/out"
noh budget "$build/mask.noh" --nominal --gpu g99
expect 2 'an unknown GPU'
noh budget "$puppet" --actors 20 --why
expect 2 'of a stage it is refused'
noh budget "$puppet" --actors 20 --nominal
expect 0 'a stage of twenty'
cp "$work/out" "$work/whole"
check 'the parts add up' adds_up "$work/whole"
check 'nothing is given up' sh -c '! grep -q "^gave up" "$1"' - "$work/whole"
check 'the kind is reported' grep -q "^kind 'puppet_levels': 20 actors, 2 meshes, 47 joints, " "$work/whole"
check 'with the levels of its meshes' grep -q '^  0 .* 0 0$' "$work/whole"
check 'its slots are as many as its actors' awk '
    /^  level / { inside = 1; next } inside && !/^  [0-7] / { exit } inside { slots += $4 } END { exit slots != 20 }' "$work/whole"
check 'and the bytes of the pack' grep -q "the packs themselves  *$(wc -c <"$puppet") " "$work/whole"
noh budget "$puppet" --actors 20 --nominal
check 'twice the same' cmp "$work/out" "$work/whole"

noh budget "$puppet" --actors 20 --nominal --path mrt --bytes 2097152
expect 0 'in 2 MiB'
cp "$work/out" "$work/small"
check 'the parts add up' adds_up "$work/small"
check 'it keeps the bound' test $(($(sum_of 2 "$work/small") + $(sum_of 3 "$work/small"))) -le 2097152
noh budget "$puppet" --actors 20 --nominal --bytes 2097152 --strict
expect 1 'strictly, that does not fit'
check 'and the message says so' grep -q 'the stage meets its limit only by giving up [1-9]' "$work/err"
noh budget "$puppet" --actors 20 --nominal --strict
expect 0 'strictly, without a bound'
noh budget "$puppet" --actors 20 --nominal --bytes 2097152
check 'and says what that cost' sh -c 'grep -q "^gave up finest level (kind puppet_levels): now [1-7], at most [0-9.]* pixels, for [1-9][0-9]* bytes$" "$1"' - "$work/small"
noh budget "$puppet" --actors 20 --nominal --cpu-bytes 700000 --gpu-bytes 3000000
expect 0 'bounds apart'
check 'are kept' test "$(sum_of 2 "$work/out")" -le 700000 -a "$(sum_of 3 "$work/out")" -le 3000000
check 'and the parts add up' adds_up "$work/out"

noh budget "$puppet" --actors 400 --nominal
expect 0 'a crowd'
cp "$work/out" "$work/crowd"
less() { # ARGUMENTS: fewer bytes on the GPU than without
    noh budget "$puppet" --actors 400 --nominal "$@"
    expect 0 "$*"
    check 'takes less' test "$(sum_of 3 "$work/out")" -lt "$(sum_of 3 "$work/crowd")"
}
less --f16
less --finest 4
check 'begins at that level' sh -c 'grep -q "^  4 " "$1" && ! grep -q "^  3 " "$1"' - "$work/out"
less --pixels 4
less --height 270
noh budget "$puppet" --actors 20 --nominal --near 3 --middle 5
cp "$work/out" "$work/fewer"
noh budget "$puppet" --actors 20 --nominal --near 3 --middle 5 --jobs 4
expect 0 '--near, --middle and --jobs'
check 'have their slots' sh -c 'grep -q "^  0 .* 3   0 0$" "$1" && grep -q "^  1 .* 5   0 1$" "$1"' - "$work/out"
check 'and more jobs more memory' test "$(sum_of 2 "$work/out")" -gt "$(sum_of 2 "$work/fewer")"
noh budget "$puppet" --actors 20 --no-gpu
expect 0 '--no-gpu'
check 'has no byte there' test "$(sum_of 3 "$work/out")" = 0
check 'and says so' grep -qx 'nothing is drawn' "$work/out"
noh budget "$puppet" --actors 20 --nominal --path cpu
check '--path' grep -q '^cpu, float accumulators, on a nominal' "$work/out"
noh budget "$puppet" --actors 20 --driver null
expect 0 'by the capabilities of a driver'
check 'it is named' sh -c '! grep -q nominal "$1"' - "$work/out"
noh build "$build/demo/puppet.glb" -o "$work/clips.noh" --plain --only anim --quiet
noh budget "$puppet" --actors 20 --nominal --clips "$work/clips.noh"
expect 0 '--clips'
check 'of the same clips, the same sum' test "$(sum_of 2 "$work/out")" = "$(sum_of 2 "$work/whole")"
noh budget "$build/demo/puppet.noh" --actors 1 --nominal
expect 0 'a pack without levels'
check 'has one' sh -c 'test "$(grep -c "^  [0-7]  " "$1")" = 1' - "$work/out"

noh budget "$puppet" --actors 20 --nominal --ragdolls 4
expect 0 '--ragdolls'
check 'have a line for the pool and one for what actors remember: 1,488 bytes each' sh -c 'grep -q "^  ragdoll pool .* [1-9][0-9]* *0$" "$1" && grep -q "^  ragdoll states .* 29760 *0$" "$1"' - "$work/out"
check 'and the parts add up' adds_up "$work/out"
noh budget "$puppet" --actors 20 --nominal --place tools/demo_assets/festival/festival.place
expect 0 '--place'
check 'has lines of its own, and the parts add up' adds_up "$work/out"
noh budget "$puppet" --actors 20 --nominal --place "$work/none.place"
expect 1 'a place that is not there'
says none.place

# ---- a text ----

mkdir "$work/cast"
cp "$puppet" "$work/cast/puppet.noh"
cp "$mask" "$work/cast/mask.noh"
cat >"$work/cast/cast.txt" <<'END'
# twenty puppets and three faces
bytes_max 4194304
kind hero
mesh puppet.noh
actor_count 20
near_count 4
root_axes ground
inertia 1
layer body floats=
layer face over joints= tracks=1
layer nod joints="no_such_joint"    # names are looked up when there is a stage
kind face
mesh mask.noh
actor_count 3
END
noh budget --desc "$work/cast/cast.txt" --nominal
expect 0 '--desc'
check 'its paths are relative to it, and the parts add up' adds_up "$work/out"
check 'within its bound' test $(($(sum_of 2 "$work/out") + $(sum_of 3 "$work/out"))) -le 4194304
check 'of both kinds' sh -c 'grep -q "^kind .hero.: 20 actors, .* 5 tracks" "$1" && grep -q "^kind .face.: 3 actors" "$1"' - "$work/out"
noh budget --desc "$work/cast/cast.txt" --nominal --bytes 100000000
expect 0 'an option goes over the text'
check 'and nothing is given up' sh -c '! grep -q "^gave up" "$1"' - "$work/out"

printf 'kind hero\nmesh puppet.noh\nactor_count 20\n' >"$work/cast/whole.txt"
noh budget --desc "$work/cast/whole.txt" --nominal
whole=$(sum_of 2 "$work/out")
echo 'sample_rate_needed 15' | cat "$work/cast/whole.txt" - >"$work/cast/half.txt"
noh budget --desc "$work/cast/half.txt" --nominal
expect 0 'half of the frames of clips are enough'
check 'which takes fewer bytes' test "$(sum_of 2 "$work/out")" -lt "$whole"
check 'and the parts add up' adds_up "$work/out"

cp "$build/demo/roam.noh" "$work/cast/roam.noh"
printf 'kind hero\nmesh puppet.noh\nclips roam.noh\nactor_count 20\ninertia 1\nroot_axes ground\nmatch 1\n' >"$work/cast/match.txt"
noh budget --desc "$work/cast/match.txt" --nominal
expect 0 'motion matching is planned'
check 'with a line of its own' sh -c 'grep -q "^  motion matching .* [1-9][0-9]* *0$" "$1"' - "$work/out"
check 'and the parts add up' adds_up "$work/out"
sed 's/inertia 1/inertia 0/' "$work/cast/match.txt" >"$work/cast/stiff.txt"
noh budget --desc "$work/cast/stiff.txt" --nominal
expect 1 'without inertia it is refused'
says 'needs room for inertia'

printf 'share 1\nkind hero\nmesh puppet.noh\nactor_count 20\n' >"$work/cast/level.txt"
printf 'peer level.txt\nkind hero\nmesh puppet.noh\nactor_count 1\nkind face\nmesh mask.noh\nactor_count 1\n' >"$work/cast/room.txt"
noh budget --desc "$work/cast/room.txt" --nominal
expect 0 'a stage that shares with a peer'
check 'counts what the other has not' adds_up "$work/out"
cp "$work/out" "$work/shared"
sed 's/^peer .*/share 1/' "$work/cast/room.txt" >"$work/cast/alone.txt"
noh budget --desc "$work/cast/alone.txt" --nominal
shared=$(awk '$1 == "shared" { print $2 }' "$work/shared")
check 'and the line of what they share is the difference' test $(($(sum_of 3 "$work/shared") + shared)) = "$(sum_of 3 "$work/out")"
check 'which is not nothing' test "$shared" -gt 100000

refused() { # LINE MESSAGE : what is in $work/cast/bad.txt is refused so
    noh budget --desc "$work/cast/bad.txt" --nominal
    expect 1 "refused: $2"
    says "cast/bad.txt:$1: $2"
    check 'and nothing is printed' test ! -s "$work/out"
}
printf 'kind hero\nmesh puppet.noh\nactr_count 20\n' >"$work/cast/bad.txt"
refused 3 "there is no setting 'actr_count'; did you mean 'actor_count'?"
printf 'kind hero\nmesh pupet.noh\nactor_count 20\n' >"$work/cast/bad.txt"
refused 2 "$work/cast/pupet.noh: "
head -c 5000 "$mask" >"$work/cast/cut.noh"
printf 'kind hero\nmesh cut.noh\nactor_count 20\n' >"$work/cast/bad.txt"
refused 2 "$work/cast/cut.noh: "
printf 'peer bad.txt\nkind hero\nmesh puppet.noh\nactor_count 20\n' >"$work/cast/bad.txt"
refused 1 'more than 4 peers, or peers of each other'
noh budget --desc "$work/cast/none.txt"
expect 1 'a text that is not there'
says none.txt
# The example in the help is valid input.
noh help FORMATS
sed -n '/^stages (/,/^error bounds/{/^     bytes_max 2097152/,/^     layer face joints/p}' "$work/out" |
    sed 's/body\.noh/puppet.noh/; s/waves\.noh/puppet.noh/' >"$work/cast/help.txt"
check 'the help shows a text' test "$(wc -l <"$work/cast/help.txt")" = 9
noh budget --desc "$work/cast/help.txt" --nominal
expect 0 'which budget takes'

# ---- JSON ----

noh budget "$puppet" --actors 20 --nominal --path mrt --bytes 2097152 --json
expect 0 '--json'
cp "$work/out" "$work/one.json"
check 'the parts add up there, too' awk '
    /"parts"/ { parts = 1 }
    /"kinds"/ { exit }
    /"(cpu|gpu)_bytes"/ { n = $2 + 0; if (parts) sum += n; else whole += n }
    END { exit !(sum == whole && sum > 0) }' "$work/one.json"
noh budget --desc "$work/cast/cast.txt" --nominal --json
expect 0 '--desc --json'
cp "$work/out" "$work/cast.json"
noh budget "$puppet" --actors 20 --no-gpu --json
cp "$work/out" "$work/none.json"
if [ -n "$json" ]; then
    holds() { # FILE EXPRESSION
        check "JSON: $2" $json "$2" <"$work/$1.json"
    }
    holds one "j.cpu_bytes === $(sum_of 2 "$work/small") && j.gpu_bytes === $(sum_of 3 "$work/small")"
    holds one "j.state_bytes !== 0 && j.pack_bytes === $(wc -c <"$puppet") && j.half_floats === true"
    holds one 'j.parts[0].name !== "" && j.parts[0].kind === null && j.parts[0].cpu_bytes !== 0 && j.parts[0].gpu_bytes === 0'
    holds one 'j.kinds[0].name === "puppet_levels" && j.kinds[0].actors === 20 && j.kinds[0].joints === 47'
    holds one 'j.kinds[0].clip_segments === 44 && j.kinds[0].clip_segments_held !== 0'
    holds one 'j.kinds[0].levels[0].level === j.kinds[0].finest_level && j.kinds[0].levels[0].error_mm !== 0'
    holds one 'j.kinds[0].levels[0].triangles !== 0 && j.kinds[0].levels[0].slots !== 0 && j.kinds[0].levels[0].mesh_levels[1] === 3'
    holds one 'j.concessions[0].what === "half-float accumulators" && j.concessions[0].kind === null && j.concessions[0].value === 1'
    holds one 'j.concessions[0].gpu_bytes !== 0 && j.concessions[0].cpu_bytes === 0 && j.concessions[0].loss_pixels === 0'
    holds cast 'j.kinds.length === 2 && j.kinds[0].name === "hero" && j.kinds[1].name === "face"'
    holds none 'j.gpu_bytes === 0 && j.device === null && j.path === null && j.concessions.length === 0'
else
    skip 'JSON' 'neither node nor python3 is here'
fi

# ---- what is refused ----

noh budget "$puppet" --actors 20 --nominal --bytes 1000
expect 1 'a bound that no stage keeps'
says 'keeps the bounds of a stage: raise them, lower actor_count or visible_max of its kinds, or build their packs with --lod; the smallest takes '
smallest=$(sed -n 's/.* (1000 bytes, \([0-9]*\) needed)$/\1/p' "$work/err")
noh budget "$puppet" --actors 20 --nominal --bytes "$smallest"
expect 0 'that smallest one is possible'
noh budget "$puppet" --actors 20 --nominal --bytes 1000 --json
check 'as JSON' sh -c 'grep -q "\"result\": \"memory\"" "$1" && grep -q "\"where\": 1000" "$1" && grep -q "\"need\": $2" "$1"' - "$work/out" "$smallest"
noh budget "$puppet" --actors 20 --nominal --cpu-bytes 1000
expect 1 'a bound of the CPU alone'
smallest=$(sed -n 's/.* (1000 bytes, \([0-9]*\) needed)$/\1/p' "$work/err")
noh budget "$puppet" --actors 20 --nominal --cpu-bytes "$smallest"
expect 0 'the smallest there is possible'
noh budget "$work/none.noh" --actors 20
expect 1 'a pack that is not there'
says none.noh
noh budget "$puppet" --actors 20 --clips "$work/none.noh"
expect 1 'clips that are not there'
says none.noh
noh budget "$work/clips.noh" --actors 20 --nominal --json
check 'a pack of clips alone is planned or refused, not more' test $code -le 1
for value in 0 65536 -1 2.5 many nan; do
    noh budget "$puppet" --actors "$value"
    expect 2 "--actors $value"
    says '--actors must be a whole number from 1 to 65535'
done
for option in --near --middle --finest --bytes --cpu-bytes --gpu-bytes --pixels --height --jobs; do
    noh budget "$puppet" --actors 20 $option -1
    expect 2 "$option -1"
    says "$option must be a"
    noh budget "$puppet" $option 1
    expect 2 "$option alone"
    says "$option has no effect without"
done
for option in --f16 --no-gpu '--clips x.noh' '--place x.place' '--ragdolls 2'; do
    # shellcheck disable=SC2086
    noh budget "$puppet" $option
    expect 2 "$option alone"
    says 'has no effect without'
done
for option in '--anim x.noh' '--instances 2' '--accumulate f16' '--lod 1'; do
    # shellcheck disable=SC2086
    noh budget "$puppet" --actors 2 $option
    expect 2 "$option of a stage"
    says 'has no effect with --actors'
done
for option in --nominal '--path cpu' '--driver egl' --f16; do
    # shellcheck disable=SC2086
    noh budget "$puppet" --actors 2 --no-gpu $option
    expect 2 "$option without a GPU"
    says 'has no effect with --no-gpu'
done
noh budget "$puppet" --desc "$work/cast/cast.txt"
expect 2 'a pack and a text'
says 'has no effect with --desc'
noh budget --desc "$work/cast/cast.txt" --actors 3
expect 2 '--actors and --desc'
says '--actors has no effect with --desc'
noh budget --nominal
expect 2 'neither a pack nor a text'
says 'noh budget needs PACK|MODEL or --desc'

# faces and graphs in a text
printf 'kind puppet\n mesh %s\n actor_count 2\n graphs "*"\n face 0.035 1.55 0.11 -0.035 1.55 0.11\n' \
    "$puppet" >"$work/cast/face.txt"
noh budget --desc "$work/cast/face.txt" --nominal
expect 0 'a kind whose faces live'
check 'which take bytes of their own' grep -q '^  faces  *puppet ' "$work/out"
sed 's/face 0.*/face joints/' "$work/cast/face.txt" >"$work/cast/joints.txt"
noh budget --desc "$work/cast/joints.txt" --nominal
expect 1 'eyes by joints that are not there'
says 'no joints for the eyes'
sed 's/face 0.*/face 1 2/' "$work/cast/face.txt" >"$work/cast/joints.txt"
noh budget --desc "$work/cast/joints.txt" --nominal
expect 1 'eyes without all numbers'
says "face must be 'joints'"
finish
