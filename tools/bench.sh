#!/bin/sh
# bench.sh BUILD: `noh bench` on the mask, the puppet, its motion matching and a stage of it, and, where $NOH_ASSETS has
# them, on hero/head.glb, hero/body.glb, a crowd and a stage of it with four LOD levels, and five captured clips at 30 Hz.
# Everything after BUILD goes to `noh bench`: --json, --rounds N, --driver D.
set -eu

build=${1:?"bench.sh BUILD [OPTIONS OF noh bench]"}
shift

echo "== the mask" >&2
"$build/noh" bench "$build/mask.noh" --source "$build/mask.glb" "$@"

echo "== the puppet" >&2
"$build/noh" bench "$build/demo/puppet.noh" "$@"
echo "== motion matching of the puppet" >&2
"$build/noh" bench "$build/demo/roam.noh" --only clip "$@"
echo "== motion matching in 28,000 rows: 476 s of the puppet, 60 a second" >&2
"$build/demo_assets" --roam-all "$build/roam_all.glb"
{ echo 'rows 60'; echo 'clip roam_*'; } >"$build/roam_all.match"
"$build/noh" build "$build/roam_all.glb" -o "$build/roam_all.noh" --match "$build/roam_all.match" --quiet
"$build/noh" bench "$build/roam_all.noh" --only clip "$@"
echo "== a stage of the puppet with LOD levels" >&2
"$build/noh" bench "$build/demo/puppet_levels.noh" --only stage "$@"

for name in head body; do
    asset=${NOH_ASSETS:-}/hero/$name.glb
    if [ -f "$asset" ]; then
        "$build/noh" build "$asset" -o "$build/$name.noh" --plain --wrinkles face --quiet
        echo "== $asset" >&2
        "$build/noh" bench "$build/$name.noh" --source "$asset" "$@"
    else
        echo "no hero/$name.glb in NOH_ASSETS" >&2
    fi
done

body=${NOH_ASSETS:-}/hero/body.glb
if [ -f "$body" ]; then
    "$build/noh" build "$body" -o "$build/body_levels.noh" --plain --wrinkles face --lod 4 --quiet
    echo "== a crowd of $body with LOD levels" >&2
    "$build/noh" bench "$build/body_levels.noh" --only crowd "$@"
    "$build/noh" bench "$build/body_levels.noh" --only stage "$@"
fi

clips=${NOH_ASSETS:-}/clips
if [ -f "$clips/cmu_01_01.rcl" ]; then
    echo "== $clips" >&2
    packs=
    for name in cmu_01_01 cmu_01_03 cmu_indian_04 cmu_martial_03 cmu_salsa_01; do
        "$build/noh" build "$clips/$name.rcl" --rate 30 -o "$build/$name.noh" --quiet
        packs="$packs $build/$name.noh"
    done
    # shellcheck disable=SC2086
    "$build/noh" bench $packs "$@"
else
    echo "no clips/cmu_01_01.rcl in NOH_ASSETS: no clip rows" >&2
fi
