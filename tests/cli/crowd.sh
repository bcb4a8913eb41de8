#!/bin/sh
# noh crowd, agents in its scenes, and the crowd and stage rows of noh bench: refused input, pictures, measurements.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh

noh crowd "$pack"
expect 2 'crowd without -o'
says '-o'
for value in 0 -1 nan many; do
    noh crowd "$pack" -o "$work/out.png" --pixels $value
    expect 2 "--pixels $value"
    says '--pixels must be'
done
noh crowd "$pack" -o "$work/out.png" --time -1
expect 2 'a time before the start'
says '--time must be'
noh crowd "$pack" -o "$work/out.png" --debug normal
expect 2 'a debug view that crowds do not have'
says '--debug must be lod'
noh crowd "$pack" -o "$work/out.png" --instances 0
expect 2 'a crowd of no bodies'
noh bench "$pack" --only crwod
expect 2 'an unknown group of rows'
says "did you mean 'crowd'"

# ---- scenes of agents, without a pack or GL ----

for refused in '--test circel250' '--test door200 --agents 0.5' '--test door200 --seconds -1' '--test door200 --seed 1e10' '--agents 10'; do
    # shellcheck disable=SC2086 # words
    noh crowd $refused
    expect 2 "crowd $refused"
done
noh crowd --test circel250
says "did you mean 'circle250'"
noh crowd "$pack" --test door200
expect 2 'a scene takes no pack'
noh crowd --test door200 --seconds 0.1 --dump "$work/none/agents.csv"
expect 1 'a dump that cannot be written'

# NAME CONDITION...: of the JSON of the last run, as an awk expression over its keys.
bound() {
    check "$1" awk -v RS=, '{ gsub(/[ \n{}"]/, ""); split($0, pair, ":"); value[pair[1]] = pair[2] } END { exit !('"$2"') }' "$work/out"
}
scenes() {
    noh crowd --test circle250 --seed 5 --json
    expect 0 'circle250'
    bound 'all are through in 250 s' 'value["done_s"] > 200 && value["done_s"] <= 250'
    bound 'overlapped by at most 8 %' 'value["overlap_max_pct"] <= 8'
    bound 'none stands still with room in front' 'value["stuck_max_s"] < 2'
    for seed in 1 5; do
        noh crowd --test door200 --seed $seed --json
        expect 0 "door200, seed $seed"
        bound 'all are out in 40 s' 'value["done_s"] > 10 && value["done_s"] <= 40'
        bound 'overlapped by at most 50 mm of 500' 'value["overlap_max_pct"] <= 10'
        bound 'none stands still with room in front' 'value["stuck_max_s"] < 2'
    done
    noh crowd --test dense1000 --seed 5 --json
    expect 0 'dense1000'
    bound 'progress of 60 %' 'value["progress_pct"] >= 60 && value["progress_pct"] < 100'
    bound 'overlapped by more than 5 % in less than a thousandth of steps' 'value["overlapped_pct"] < 0.1'
    bound 'none stands still with room in front' 'value["stuck_max_s"] < 2'
    noh crowd --test open10000 --seconds 12 --json
    expect 0 'open10000'
    bound 'progress of 90 %' 'value["progress_pct"] >= 90 && value["progress_pct"] < 100'
    bound 'none stands still with room in front' 'value["stuck_max_s"] < 2'
    bound 'ten thousand in 96 bytes each' 'value["agents"] == 10000 && value["bytes"] <= 960000'
    for seed in 1 2; do
        noh crowd --test maze400 --seed $seed --json
        expect 0 "maze400, seed $seed"
        bound 'progress of 70 %, by ways that no straight line finds' 'value["progress_pct"] >= 70 && value["progress_pct"] < 100'
        bound 'overlapped by at most 10 %' 'value["overlap_max_pct"] <= 10'
        bound 'none stands still with room in front' 'value["stuck_max_s"] < 2'
        bound 'flow fields of four goals: nine bytes a cell' 'value["field_bytes"] > 9 * 80 * 80 && value["field_bytes"] < 9 * 80 * 80 + 2400'
        noh crowd --test stalls600 --seed $seed --json
        expect 0 "stalls600, seed $seed"
        bound 'progress of 40 %, past those who stand at stalls' 'value["progress_pct"] >= 40 && value["progress_pct"] < 100'
        bound 'none stands still with room in front' 'value["stuck_max_s"] < 2'
    done
}
if [ -n "${NOH_SAN:-}" ]; then
    skip 'the scenes and what they measure' 'they take minutes under a sanitizer, and the festival below runs the same code'
else
    scenes
fi
noh crowd --test door200 --agents 40 --seconds 1 --dump "$work/agents.csv"
expect 0 'a dump'
check 'it has a line for each agent and step' awk -F, 'NR == 1 { head = $0 == "frame,agent,x,z,vx,vz,radius"; next } NF != 7 || $7 != 0.25 { bad = 1 } END { exit !(head && !bad && NR == 1201) }' "$work/agents.csv"

# ---- places ----

festival=tools/demo_assets/festival/festival.place
noh crowd --place "$festival" --agents 150 --seconds 20 --dump "$work/agents.csv" --json
expect 0 'a festival'
bound 'its agents get on, and do not overlap' 'value["agents"] == 150 && value["seconds"] == 20 && value["progress_pct"] > 60 && value["overlap_max_pct"] < 8 && value["stuck_max_s"] < 2 && value["bytes"] > 0'
cp "$work/out" "$work/first"
check 'its dump has a line for each agent and step' awk -F, 'NR == 1 { head = $0 == "frame,agent,x,z,vx,vz,radius" } END { exit !(head && NR == 90001) }' "$work/agents.csv"
noh crowd --place "$festival" --agents 150 --seconds 20 --json
expect 0 'again'
check 'comes to the same hash' sh -c 'grep hash "$1" >"$1.a"; grep hash "$2" | cmp -s - "$1.a"' - "$work/out" "$work/first"
told=$(sed -n 's/.*"bytes": \([0-9]*\).*/\1/p' "$work/out")
noh budget "$build/demo/puppet_levels.noh" --actors 150 --place "$festival" --no-gpu
expect 0 'its budget'
check 'has its agents, flow fields and smart objects, to the byte' awk -v told="$told" '/^  (crowd|flow fields|smart objects) / { sum += $(NF - 1); n++ } END { exit !(n == 3 && sum == told) }' "$work/out"
noh crowd --place door --agents 40 --seconds 2 --json
expect 0 'a word for a scene of --test'
bound 'is that scene' 'value["agents"] == 40 && value["seconds"] == 2'
printf 'area 0 0 9 9\nspan 0 0 1 1\n' >"$work/bad.place"
noh crowd --place "$work/bad.place" --json
expect 1 'a place with a mistake'
says 'bad.place:2'
says "did you mean 'spawn'?"
noh crowd --place "$work/none.place"
expect 1 'a place that is not there'
printf 'area 0 0 9 9\nspawn 0 0 1 1\ngoal 5 5\n' >"$work/small.place"
noh crowd --place "$work/small.place" --agents 100
expect 1 'too many for where they enter'
says 'have room for only'
for refused in '--place door --test door200' '--scenery x.noh' '--place door --camera 1' '--place door --orca' '--place door -o out.png'; do
    # shellcheck disable=SC2086 # words
    noh crowd $refused
    expect 2 "crowd $refused"
done

# ---- with a GL ----

noh crowd "$pack" -o "$work/out.png"
if grep -q 'no GL context' "$work/err"; then
    skip 'crowds drawn' 'no GL context here'
    finish
fi
expect 1 'a pack without joints'
says 'a crowd needs a skinned mesh'
check 'no picture is left' test ! -e "$work/out.png"
noh bench "$pack" --only crowd
expect 1 'crowd rows of a pack without joints'
says 'no data for these rows'

if [ -f "$assets/khronos/RobotExpressive.glb" ]; then
    "$build/noh" build "$assets/khronos/RobotExpressive.glb" -o "$work/robot.noh" --quiet
    noh crowd "$work/robot.noh" -o "$work/robot.png" --instances 30 --time 0.1 --size 160x90 # a skin that lists joints twice
    expect 0 'a crowd of robots'
    check 'all of its bytes were planned' awk '/planned:/ { gsub(/[,;]/, ""); if ($2 != $8 || $5 != $10) exit 1; found = 1 } END { exit !found }' "$work/out"
    noh crowd "$work/robot.noh" -o "$work/lamp.png" --instances 30 --time 0.1 --size 160x90 --light none
    check 'and is in a light by default' sh -c '! cmp -s "$1/robot.png" "$1/lamp.png"' - "$work"
    noh crowd "$work/robot.noh" -o "$work/none.png" --light fog
    expect 2 'a light that is not there'
    "$build/noh" build "$assets/khronos/RobotExpressive.glb" -o "$work/plain.noh" --quiet --tint Main=off --tint Grey=off --tint Black=off
    noh crowd "$work/plain.noh" -o "$work/plain.png" --instances 30 --time 0.1 --size 160x90
    check 'each robot has a tint of its own where a material takes one' sh -c '! cmp -s "$1/robot.png" "$1/plain.png"' - "$work"
else
    skip 'a crowd of robots' 'no khronos/RobotExpressive.glb in NOH_ASSETS'
fi

# ---- a crowd of puppets, each of two meshes ----

puppets=$build/demo/puppet_levels.noh
planned() {
    check "$1: all of its bytes were planned" awk '/planned:/ { gsub(/[,;]/, ""); if ($2 != $8 || $5 != $10) exit 1; found = 1 } END { exit !found }' "$work/out"
}
noh crowd "$puppets" -o "$work/lit.png" --instances 40 --time 0.3 --size 320x180
expect 0 'a crowd of puppets'
planned 'a crowd of puppets'
check 'every visible body has a level' awk '/visible/ { gsub(/[,;]/, ""); for (i = 8; $i != "fading"; i++) sum += $i; found = sum && sum - $(i - 1) == $4 } END { exit !found }' "$work/out"
noh crowd "$puppets" -o "$work/levels.png" --instances 40 --time 0.3 --size 320x180 --debug lod
expect 0 'in the colours of their levels'
planned 'in the colours of their levels'
check 'is another picture' sh -c '! cmp -s "$1" "$2"' - "$work/lit.png" "$work/levels.png"
noh crowd "$puppets" -o "$work/plain.png" --instances 40 --time 0.3 --size 320x180 --plain
expect 0 'without LOD'
planned 'without LOD'
check 'the picture stays nearly the same' "$build/tests/gl/picture_diff" "$work/lit.png" "$work/plain.png" 0.3 0.02

noh bench "$puppets" --only people --quick --json
expect 0 'what agents and walkers take of a frame'
check 'of a crowd that is dense and of one in the open' awk '/"crowd\/people\/(dense1000|open10000)\/(agents|walkers)"/ { rows++ } /"value":/ { gsub(/[^0-9.]/, ""); if (!($0 + 0 > 0 && $0 + 0 < 100)) bad = 1 } END { exit !(rows == 4 && !bad) }' "$work/out"

# ---- a place of puppets ----

noh crowd "$puppets" --place "$festival" --agents 60 --time 3 -o "$work/place.png" --size 320x180 --light sky
expect 0 'puppets at a festival'
cp "$work/out" "$work/drawn"
check 'the near ones stand on the ground' grep -q '60 in .*feet of 48 on the ground' "$work/out"
noh crowd "$puppets" --place "$festival" --agents 20 --time 1 --strip 2,0.5 -o "$work/strip.png" --size 64x48
expect 0 'two pictures of a place'
check 'lie side by side' test "$(od -An -tu1 -j16 -N8 "$work/strip.png" | tr -s ' ')" = ' 0 0 0 128 0 0 0 48'
noh crowd "$puppets" --place "$festival" --agents 20 --time 1 --strip 1 -o "$work/one.png" --size 64x48
noh crowd "$puppets" --place "$festival" --agents 20 --time 1 -o "$work/alone.png" --size 64x48
check 'a strip of one is the picture' cmp -s "$work/one.png" "$work/alone.png"
noh crowd "$puppets" --place "$festival" --agents 60 --time 4 --hit 3,0,3,6 -o "$work/hit.png" --size 320x180 --light sky
expect 0 'a push'
check 'without a terrain none is reported' sh -c '! grep -q ^terrain "$1"' - "$work/out"
check 'the near ones fall' awk '/^hit: / { found = $2 > 0 && $2 <= 16 && $(NF - 4) == $2 } END { exit !found }' "$work/out"
noh crowd "$puppets" --place "$festival" --agents 60 --time 12 --hit 3,0,3,6 -o "$work/hit.png" --size 32x18 --light sky
check 'and get up' grep -q '^hit: [1-9][0-9]* of a pool of 16 fell, 0 not on their feet' "$work/out"
for refused in '--strip 0' '--strip 2,0' '--strip x' '--strip 2,1,1' '--strip 8193 --size 1x1' '--hit 1,2' '--hit 1,2,x' '--hit 1,2,3,4,5,6' '--hit -1,0,0'; do
    # shellcheck disable=SC2086 # words
    noh crowd "$puppets" --place "$festival" -o "$work/no.png" $refused
    expect 2 "crowd $refused"
done
noh crowd --place "$festival" --hit 1,2,3
expect 2 'a push in what is not drawn'
noh budget "$puppets" --actors 60 --place "$festival" --no-gpu
check 'its walkers take what the budget says' awk '/^  walkers / { told = $(NF - 1) } /walkers [0-9]+;/ { sub(/.*walkers /, ""); took = $0 + 0 } END { exit !(told && told == took) }' "$work/out" "$work/drawn"
noh crowd "$pack" --place "$festival" --agents 10 -o "$work/no.png"
expect 1 'a mask does not walk'
says 'a body that walks'
check 'no picture is left of it' test ! -e "$work/no.png"

if [ -f "$assets/hero/body.glb" ]; then
    printf 'walk 0.1 step\nrun 0.2 step\njump 0.5 land\n' >"$work/keys.txt"
    "$build/noh" build "$assets/hero/body.glb" -o "$work/body.noh" --plain --wrinkles face --lod 2 --lod-fast --effort 1 --events "$work/keys.txt" --quiet
    noh bench "$work/body.noh" --only crowd --quick --json
    expect 0 'a bench of fifty bodies: events equal, bytes as planned'
    check 'there were events' awk '/"crowd_events":/ { gsub(/[^0-9]/, ""); found = $0 > 20 } END { exit !found }' "$work/out"
    for row in cpu/1-pixel cpu/16-pixels gpu/1-pixel gpu/16-pixels; do
        check "it has rows crowd/$row" grep -q "\"crowd/$row\"" "$work/out"
    done
    check 'feet of a captured walk that follows an agent do not slide' env NOH_WALKERS_PACK="$work/body.noh" "$build/tests/unit/stage/test_walkers"
    noh bench "$work/body.noh" --only stage --quick --json
    expect 0 'a stage and its parts joined by hand come to the same palettes'
    check 'it has rows stage/cpu and stage/lod' awk '/"stage\/(cpu|lod)\/20-actors"/ { found++ } END { exit found != 2 }' "$work/out"
else
    skip 'a bench of fifty bodies' 'no hero/body.glb in NOH_ASSETS'
fi
finish
