#!/bin/sh
# web_bench_pack.sh ASSET OUT: the pack of `make web-bench`: all materials are plain, as drawn by three.js and
# Babylon.js, so that frames are comparable.
set -eu
noh=${NOH_BUILD:-build}/noh
"$noh" build "$1" -o "$2" --plain --wrinkles face --quiet
set -- "$1" "$2" --plain --wrinkles face --quiet
while read -r name; do set -- "$@" --surface "$name=plain"; done <<END
$("$noh" info "$2" | sed -n "s/^material '\(.*\)': \(skin\|eye\|teeth\|toon\),.*/\1/p")
END
asset=$1 out=$2
shift 2
"$noh" build "$asset" -o "$out" "$@"
