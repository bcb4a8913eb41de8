#!/bin/sh
# gpu_figures.sh BUILD [OPTIONS OF noh bench]: what morphing costs on the GPU at hand, by its timers: every path against
# loops over targets, 2 to all targets active, in one draw and in three, and 10 to 1,000 heads; on the mask, and, where
# $NOH_ASSETS has them, on head.glb and identity.glb. 9 rounds, unless the options say so: --quick is for a try, also
# on a software rasteriser, whose figures are processor time. Prints the cost of each path as a share of the loop over
# active targets, and counts the shares above 1. BUILD/gpu_figures has the whole output of the bench.
set -eu

build=${1:?"gpu_figures.sh BUILD [OPTIONS OF noh bench]"}
shift
[ $# -gt 0 ] || set -- --rounds 9
out=$build/gpu_figures
mkdir -p "$out"

# table FILE: rows of the bench as "cost over the loop's, row". A name stands in the first of the lines of its row.
table() {
    awk '$3 == "us" { name = $1; cost = $2; ratio = $4; with = $5 }
         NF == 2 { ratio = $1; with = $2 }
         name ~ /^morph\// && with == "dense-active-loop" && name !~ /\/(dense|filament|quad)[^\/]*$/ && ratio > 0 {
             rows++
             above += 1 / ratio > 1
             printf "%8.3f  %10s us  %s\n", 1 / ratio, cost, name
         }
         END { printf "%d rows, %d above 1\n", rows, above; exit !rows }' "$1"
}

# measure NAME PACK SOURCE OPTIONS
measure() {
    name=$1 pack=$2 source=$3
    shift 3
    echo "== $name"
    "$build/noh" bench "$pack" --source "$source" --only morph "$@" >"$out/$name-morph.txt"
    sed -n 2,3p "$out/$name-morph.txt"
    table "$out/$name-morph.txt"
    "$build/noh" bench "$pack" --only heads "$@" >"$out/$name-heads.txt"
    sed -n '/^crowd\//p; /over active pairs/,$p' "$out/$name-heads.txt"
}

measure mask "$build/mask.noh" "$build/mask.glb" "$@"
for name in head identity; do
    asset=${NOH_ASSETS:-}/hero/$name.glb
    if [ -f "$asset" ]; then
        "$build/noh" build "$asset" -o "$out/$name.noh" --plain --wrinkles face --quiet
        measure "$name" "$out/$name.noh" "$asset" "$@"
    else
        echo "no hero/$name.glb in NOH_ASSETS"
    fi
done
