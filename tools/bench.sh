#!/bin/sh
# bench.sh BUILD: `noh bench` on the mask, and on hero/head.glb where $NOH_ASSETS has it.
# Everything after BUILD goes to `noh bench`: --json, --rounds N, --driver D.
set -eu

build=${1:?"bench.sh BUILD [OPTIONS OF noh bench]"}
shift

echo "== the mask" >&2
"$build/noh" bench "$build/mask.noh" --source "$build/mask.glb" "$@"

head=${NOH_ASSETS:-}/hero/head.glb
if [ -f "$head" ]; then
    "$build/noh" build "$head" -o "$build/head.noh" --quiet
    echo "== $head" >&2
    "$build/noh" bench "$build/head.noh" --source "$head" "$@"
else
    echo "no hero/head.glb in NOH_ASSETS: the mask only" >&2
fi
