#!/bin/sh
# heads.sh [HEAD.glb...]: heads of several makers alive: how often outline and brows stand still in ten seconds of idle,
# in two sentences, and in the same with six emotions, as a table; and what they look like, as strips in the build
# folder's heads/. `make heads` runs it. Without arguments: the mask, stand-ins for an ARKit head, a ReadyPlayerMe avatar, a
# VRoid and an ICT head (tests/support/heads.js), and in NOH_ASSETS hero/head_skin.glb and body.glb. It fails where more
# than 5 % of the pairs of pictures stand still. NOH_HEADS_STRIPS=0: without strips.
set -eu
cd "$(dirname "$0")/.."
build=${NOH_BUILD:-build}
out=$build/heads
noh=$build/noh
words='The quick brown fox jumps over the lazy dog. I really did not expect to see you here, my friend.'
emotions='joy sadness surprise fear anger disgust'
mkdir -p "$out"
if [ $# = 0 ]; then
    node tests/support/heads.js "$build/demo/nell.glb" "$out"
    set -- "$build/mask.glb" "$out/arkit.glb" "$out/rpm.glb" "$out/vroid.glb" "$out/ict.glb"
    for name in head_skin body; do
        file=${NOH_ASSETS:-none}/hero/$name.glb
        [ ! -f "$file" ] || set -- "$@" "$file"
    done
fi

# still REGION: of the head in face.json, in per cent; - where it has none of these
still() {
    tr -d ' \n' <"$out/face.json" | sed -n "s/.*\"$1\":\([0-9.e-]*\).*/\1/p" |
        awk '{ printf "%.1f", 100 * $1 } END { if (!NR) printf "-" }'
}

failed=0
row() { # WHAT OPTION...
    what=$1
    shift
    "$noh" face "$pack" --json "$@" >"$out/face.json" || exit 1
    outline=$(still outline)
    brows=$(still brows)
    printf '%-12s %-10s %7s %7s\n' "$head" "$what" "$outline" "$brows"
    printf '%s\n%s\n' "$outline" "$brows" | awk '$1 >= 5 || (NR == 1 && $1 == "-") { exit 1 }' || failed=$((failed + 1))
}

strip() { # WHAT OPTION...
    what=$1
    shift
    [ "${NOH_HEADS_STRIPS:-1}" = 0 ] ||
        "$noh" sheet "$pack" -o "$out/$head-$what.png" --face on --tiles 8 --columns 8 --tile 160 "$@" >/dev/null
}

printf '%-12s %-10s %7s %7s\n' 'still, %' '' outline brows
for file; do
    head=$(basename "$file" .glb)
    pack=$out/$head.noh
    "$noh" build "$file" -o "$pack" --plain --wrinkles face --quiet
    "$noh" speak "$words" --face "$pack" -o "$out/line.noh" --json >/dev/null
    row idle --idle 10
    strip idle --time 10
    row speech --idle 5 --anim "$out/line.noh" --clip speech
    strip speech --anim "$out/line.noh" --clip speech
    for emotion in $emotions; do
        row "$emotion" --idle 5 --anim "$out/line.noh" --clip speech --feel "$emotion=0.8"
        strip "$emotion" --anim "$out/line.noh" --clip speech --feel "$emotion=0.8"
    done
done
[ $failed = 0 ] || echo "$failed rows stand still too often" >&2
[ $failed = 0 ]
