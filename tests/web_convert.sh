#!/bin/sh
# web_convert.sh: the page's converter, under node, gives the same bytes and messages as `noh build`. NOH_LONG=1: also
# larger models. Part of tests/web.sh; ends like tests/run.sh.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
assets=${NOH_ASSETS:-../shared/assets}
out=$build/web-check/convert
passed=0 failed=0
[ -f "$build/web-convert/convert.js" ] || { echo 'skipped: there is no converter (make web)'; echo '0 passed, 0 failed, 1 skipped'; exit 0; }
mkdir -p "$out"
fetch=
node --no-experimental-fetch -e 0 2>/dev/null && fetch=--no-experimental-fetch
web() { node $fetch tools/web_convert/run.js "$build/web-convert/convert.js" "$@"; }
ok() { passed=$((passed + 1)); }
not_ok() {
    failed=$((failed + 1))
    echo "web_convert: $1"
}

same() { # NAME FILE... OPTION...
    name=$1
    shift
    "$build/noh" build "$@" -o "$out/$name.noh" --quiet >/dev/null 2>&1 || not_ok "$name: noh build fails"
    rm -f "$out/$name.web.noh"
    web build "$@" -o "$out/$name.web.noh" --quiet >"$out/$name.txt" 2>&1 || not_ok "$name: the page's converter fails: $(cat "$out/$name.txt")"
    if cmp -s "$out/$name.noh" "$out/$name.web.noh"; then ok; else not_ok "$name: bytes differ from noh build's"; fi
}

# The same messages except for the folder.
refuses() { # NAME FILE WORDS
    "$build/noh" build "$2" -o "$out/$1.noh" --quiet 2>&1 | sed "s,$out,," >"$out/$1.native.txt"
    web build "$2" -o "$out/$1.web.noh" --quiet >"$out/$1.txt" 2>&1 && not_ok "$1: is not refused"
    if grep -q "$3" "$out/$1.txt" && cmp -s "$out/$1.txt" "$out/$1.native.txt"; then ok; else not_ok "$1: says '$(cat "$out/$1.txt")'"; fi
}

same arm "$build/demo/arm.glb"
head -c 5000 "$build/demo/arm.glb" >"$out/cut.glb"
refuses cut "$out/cut.glb" 'truncated'
printf 'HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 10 0\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.03\n0 0 0\n10 20 30\n20 40 60\n' >"$out/turn.bvh"
same clip "$out/turn.bvh"
sed -n '/^cat .*strip\.fbx/,/^FBX$/p' tests/cli/fbx.sh | sed '1d; $d' >"$out/strip.fbx"
same strip "$out/strip.fbx"
printf 'HIERARCHY\nROOT hip\n{\nOFFSET 0 0\n' >"$out/bad.bvh"
refuses bad "$out/bad.bvh" 'bad.bvh'
if [ "${NOH_LONG:-0}" = 1 ]; then
    same levels "$build/demo/arm.glb" --lod 3 --lod-fast --transfer 4
    same mask "$build/mask.glb" --wrinkles auto
    same puppet "$build/demo/puppet.glb"
    for model in head body; do [ ! -f "$assets/hero/$model.glb" ] || same "$model" "$(realpath "$assets/hero/$model.glb")"; done
fi
echo "$passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ] && [ "$passed" != 0 ]
