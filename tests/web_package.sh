#!/bin/sh
# web_package.sh PACK: the npm package of `make npm`, installed into an empty project with PACK, plain and in the wire
# form: the contents of the tarball, its types, the page of its README and the element in Chromium
# (tests/web/package.js). Part of tests/web.sh; ends like tests/run.sh.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
out=$build/web-check/package
project=$build/web-check/project # three.js is installed next to it, not in it
tarball=$build/npm/noh-character-$(sed -n "s/^#define NOH_VERSION \"\(.*\)\"/\1/p" runtime/noh/base.h).tgz
passed=0 failed=0

leave_out() {
    echo "skipped: $1"
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
}
. tests/web/find_browser.sh
find_browser "$build/web-check" playwright-core axe-core typescript three @types/three @types/react # the same list as in web.sh: npm removes others
ok() { passed=$((passed + 1)); }
not_ok() {
    failed=$((failed + 1))
    echo "package: $1"
}
check() { # WHAT COMMAND...: prints what it says if it fails
    what=$1
    shift
    if said=$("$@" 2>&1); then ok; else not_ok "$what: $said"; fi
}

rm -rf "$project"
mkdir -p "$project" "$out"
echo '{ "private": true }' >"$project/package.json"
cp "$1" "$project/face.noh"
"$build/noh" pack "$1" -o "$project/face.nohz" --quiet || not_ok 'noh pack fails'
cp "$build/demo/arm.glb" "$project"
[ ! -f "$build/demo/puppet_levels.noh" ] || cp "$build/demo/puppet_levels.noh" "$project/walker.noh"
[ ! -f "$build/demo/puppet.glb" ] || "$build/noh" build "$build/demo/puppet.glb" -o "$project/standing.noh" --plain --only mesh --quiet || not_ok 'noh build fails'
if [ -f "$project/standing.noh" ]; then
    for turned in turned:180 aside:90; do
        node tests/web/turned_model.js "$build/demo/puppet.glb" "${turned#*:}" >"$project/turned.glb"
        "$build/noh" build "$project/turned.glb" -o "$project/${turned%:*}.noh" --plain --only mesh --quiet || not_ok 'noh build fails'
    done
fi
head -c 5000 "$build/demo/arm.glb" >"$project/cut.glb"
printf 'HIERARCHY\nROOT bent_0\n{\nOFFSET 0 0 0\nCHANNELS 1 Zrotation\nJOINT bent_1\n{\nOFFSET 0 50 0\nCHANNELS 1 Zrotation\nEnd Site\n{\nOFFSET 0 50 0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.03\n0 0\n10 20\n' >"$project/turn.bvh"
node tests/web/webp_model.js >"$project/webp.gltf"
[ -z "$(ldconfig -p 2>/dev/null | grep libwebp.so)" ] || "$build/noh" build "$project/webp.gltf" -o "$project/webp.noh" --quiet
check 'npm install' npm install --prefix "$project" --offline --no-audit --no-fund "$tarball"
installed=$project/node_modules/noh-character
for file in LICENSE README.md $(sed -n "s/.*from '\.\/\(.*\)'.*/\1/p" platform/web/package/*.js | sort -u) \
    $(sed -n 's/.*: "\.\/\([a-z.]*\)".*/\1/p' "$installed/package.json"); do
    check "the tarball has $file" test -s "$installed/$file"
done
cp tests/web/types.ts tests/web/react.tsx "$project"
check 'types' node "$(node -p 'require.resolve("typescript/package.json")' | sed 's,package.json$,bin/tsc,')" --noEmit --strict \
    --target es2022 --module nodenext --moduleResolution nodenext --skipLibCheck false --jsx react-jsx "$project/types.ts" "$project/react.tsx"
timeout -k 5 6000 node tests/web/package.js "$project" "$chromium" "$out" "$project" >"$out/log.txt" 2>&1 || [ "$(grep -c '^not ok ' "$out/log.txt")" != 0 ] ||
    not_ok "tests/web/package.js ends too early: $(tail -n 1 "$out/log.txt")"
passed=$((passed + $(grep -c '^ok ' "$out/log.txt"))) failed=$((failed + $(grep -c '^not ok ' "$out/log.txt")))
grep -v '^ok \|^1\.\.' "$out/log.txt"
timeout -k 5 6000 node tests/web/three.js "$project" "$chromium" "$out" "$project" "$build/noh" >"$out/three.txt" 2>&1 || [ "$(grep -c '^not ok ' "$out/three.txt")" != 0 ] ||
    not_ok "tests/web/three.js ends too early: $(tail -n 1 "$out/three.txt")"
passed=$((passed + $(grep -c '^ok ' "$out/three.txt"))) failed=$((failed + $(grep -c '^not ok ' "$out/three.txt")))
grep -v '^ok \|^1\.\.' "$out/three.txt"
echo "$passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ] && [ "$passed" != 0 ]
