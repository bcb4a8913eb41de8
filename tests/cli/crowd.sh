#!/bin/sh
# noh crowd, and the rows of a crowd in noh bench: what they refuse, and, where NOH_ASSETS has models, what they draw and measure.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh

noh crowd "$pack"
expect 2 'crowd without -o'
says '-o'
for value in 0 -1 nan many; do
    noh crowd "$pack" -o "$work/out.png" --pixels $value
    expect 2 "--pixels $value"
    says '--pixels wants'
done
noh crowd "$pack" -o "$work/out.png" --time -1
expect 2 'a time before the start'
says '--time wants'
noh crowd "$pack" -o "$work/out.png" --debug normal
expect 2 'a debug view that crowds do not have'
says '--debug wants lod'
noh crowd "$pack" -o "$work/out.png" --instances 0
expect 2 'a crowd of no bodies'
noh bench "$pack" --only crwod
expect 2 'an unknown group of rows'
says "did you mean 'crowd'"

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
else
    skip 'a crowd of robots' 'no khronos/RobotExpressive.glb in NOH_ASSETS'
fi

if [ -f "$assets/hero/body.glb" ]; then
    "$build/noh" build "$assets/hero/body.glb" -o "$work/body.noh" --lod 2 --lod-fast --quiet
    noh bench "$work/body.noh" --only crowd --quick --json
    expect 0 'a bench of fifty bodies: events equal, bytes as planned'
    for row in cpu/1-pixel cpu/16-pixels gpu/1-pixel gpu/16-pixels; do
        check "it has rows crowd/$row" grep -q "\"crowd/$row\"" "$work/out"
    done
    noh bench "$work/body.noh" --only stage --quick --json
    expect 0 'a stage and its parts joined by hand come to the same palettes'
    check 'it has rows stage/cpu and stage/lod' awk '/"stage\/(cpu|lod)\/20-actors"/ { found++ } END { exit found != 2 }' "$work/out"
else
    skip 'a bench of fifty bodies' 'no hero/body.glb in NOH_ASSETS'
fi
finish
