#!/bin/sh
# compare.sh BUILD: our LOD levels against meshoptimizer's (Debian's, and npm's where node is), on the mask, and on
# hero/head.glb and hero/body.glb where $NOH_ASSETS has them. Pictures are left in BUILD.
set -eu

build=${1:?"compare.sh BUILD"}
build=$(cd "$build" && pwd)
peer=$build/lod-peer
script=$(cd "$(dirname "$0")" && pwd)/meshopt.mjs

is_there() { node -e "require.resolve('meshoptimizer/simplifier')" 2>/dev/null; }
compare() {
    if is_there; then
        "$build/lod_compare" "$@" --npm "$script" "$peer"
    else
        "$build/lod_compare" "$@"
    fi
}

mkdir -p "$peer"
export NODE_PATH="$peer/node_modules${NODE_PATH:+:$NODE_PATH}"
is_there || (cd "$peer" && npm install --no-save --silent meshoptimizer@latest >/dev/null 2>&1) || true

compare "$build/mask.glb" --picture "$build/lod_mask.png"
for name in head body; do
    file=${NOH_ASSETS:-}/hero/$name.glb
    if [ -f "$file" ]; then
        compare "$file" --picture "$build/lod_$name.png"
    else
        echo "no hero/$name.glb in NOH_ASSETS: skipped" >&2
    fi
done
