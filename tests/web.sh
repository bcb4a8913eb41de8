#!/bin/sh
# web.sh PACK...: for each pack, the page of `make web` is built and run in headless Chromium (tests/web/page.js,
# figure.js, load.js; with the mask controls.js, speech.js and the npm package, web_package.sh; with Nell greet.js). Its
# canvas is compared with `noh render`, and its bytes with the plan that sized its memory and with `noh budget`. `make
# web-check` runs it; NOH_WEB_ONLY=lights,hair runs only these parts, without a comparison; with NOH_WEB_TIMES=1 each part
# prints its time, with NOH_WEB_VALUES=1 each check its value (tests/web/harness.js). Ends like tests/run.sh. Skipped with
# the reason if emscripten, Chromium or playwright is not available.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
passed=0 failed=0

leave_out() {
    echo "skipped: $1"
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
}
command -v emcc >/dev/null 2>&1 || leave_out 'no emcc here (emscripten)'
. tests/web/find_browser.sh
fetch=
node --no-experimental-fetch -e 0 2>/dev/null && fetch=--no-experimental-fetch
find_browser "$build/web-check" playwright-core axe-core typescript three @types/three @types/react

ok() { passed=$((passed + 1)); }
not_ok() {
    failed=$((failed + 1))
    echo "$name: $1"
}

# The limits are as in tests/gl/matrix.sh for rasterisers other than llvmpipe, scaled from 1,024 pixels to this size: a
# canvas averages samples after encoding, `noh render` before, so edges differ, and their share grows as pictures shrink.
size=768
compare() { # NAME [MEAN]
    if said=$("$build/tests/gl/picture_diff" "$out/native.png" "$out/$1.png" "${2:-0.33}" 0.0133); then ok; else not_ok "$1 is not the native picture"; fi
    echo "$name $1: $said"
}

# The page's stage desc (platform/web/cast.c) as a text.
describe() { # FLOATS still|alive
    falls=
    [ -z "$(echo "$plan" | grep '^falls')" ] || falls='ragdolls 1'
    cat >"$out/page.txt" <<END
kind page
mesh $build/web/$name/page.nohz
actor_count 1
inertia 1
held_float_count $1
root_axes ground
$falls
layer body
layer face over joints=
END
    [ "$2" = still ] || echo "face $eyes" >>"$out/page.txt"
}

# In the browser the stage takes the bytes planned under node. `noh budget` plans the same GPU bytes if its device is
# also a software rasteriser, and more CPU bytes, because its pointers are larger.
budget_of() { # PATH plain|lit still|alive CPU GPU
    planned=$(echo "$plan" | sed -n "s/^$1 $2 $3 //p")
    if [ "$planned" = "$4 $5" ]; then ok; else not_ok "$1 $2 $3 takes $4 $5 bytes, planned are $planned"; fi
    describe "$floats" "$3"
    said=$("$build/noh" budget --desc "$out/page.txt" --path "$1" --json)
    cpu=$(echo "$said" | sed -n 's/^  "cpu_bytes": \([0-9]*\).*/\1/p')
    gpu=$(echo "$said" | sed -n 's/^  "gpu_bytes": \([0-9]*\).*/\1/p')
    # the stage has one actor's hair state, which is drawn separately
    set -- "$@" $(echo "$plan" | sed -n 's/^hair //p')
    cpu=$((cpu + ${6:-0} + ${7:-0})) gpu=$((gpu + ${8:-0}))
    # a cube of 64 x 64 with its levels, a shadow map, and maps of moments at half and at a quarter of its side
    if [ "$2" = lit ]; then gpu=$((gpu + 130944 + 2 * 512 * 512 + 4 * (256 * 256 + 128 * 128))); fi
    if [ "$5" = "$gpu" ]; then ok; else not_ok "$1 $2 $3 takes $5 bytes of the GPU, noh budget says $gpu"; fi
    if [ "$4" -le $((cpu + 1024)) ] && [ "$4" -ge $((cpu * 3 / 4)) ]; then ok; else not_ok "$1 $2 $3 takes $4 bytes, noh budget says $cpu"; fi
}

# The checks of a log, and its other lines.
count() { # CODE LOG
    good=$(grep -c '^ok ' "$2") bad=$(grep -c '^not ok ' "$2")
    [ "$1" = 0 ] || [ "$bad" != 0 ] || bad=1
    passed=$((passed + good)) failed=$((failed + bad))
    grep -v '^ok \|^# budget \|^1\.\.' "$2"
}

check_pack() {
    out=$build/web-check/$name
    mkdir -p "$out"
    rm -f "$out"/*.png
    : >"$out/log.txt"
    # a pack for one part of the page
    [ "$all" = 0 ] || timeout -k 5 6000 node tests/web/page.js "$build/web/$name" "$chromium" "$out" "$clip" "$time" $size "$paths" >"$out/log.txt" 2>&1
    code=$?
    [ "$all" = 0 ] || count $code "$out/log.txt"
    : >"$out/figure.txt"
    if [ -n "$figure" ]; then
        NOH_WEB_ONLY=${NOH_WEB_ONLY:-$figure} timeout -k 5 6000 node tests/web/figure.js "$build/web/$name" "$chromium" "$out" 256 >"$out/figure.txt" 2>&1
        count $? "$out/figure.txt"
    fi
    if [ "$name" = nell ]; then
        # 30 frames a second on a Mali-G52 by the model of `noh budget`, if the dearest material fills a phone of 390 x 844
        most=$("$build/noh" budget "$build/web/$name/page.noh" --nominal --gpu g52 --tier phone --size 780x1688 --json |
            awk -F': ' '/"material"/ { is = 1 } /"percent_of_frame"/ { if (is && $2 + 0 > most) most = $2 + 0; if (!is) all += $2; is = 0 } END { print most + all }')
        if awk "BEGIN { exit !($most > 10 && $most <= 200) }"; then ok; else not_ok "a frame takes $most % of 1/60 s of a Mali-G52"; fi
        timeout -k 5 6000 node tests/web/greet.js "$build/web/$name" "$chromium" "$out" >"$out/greet.txt" 2>&1
        count $? "$out/greet.txt"
    fi
    case $name in mask | wig | nell) # with levels, the coarsest first, and without
        timeout -k 5 6000 node tests/web/load.js "$build/web/$name" "$chromium" "$out" >"$out/load.txt" 2>&1
        count $? "$out/load.txt"
        ;;
    esac
    if [ "$name" = mask ]; then
        timeout -k 5 6000 node tests/web/controls.js "$build/web/$name" "$chromium" "$out" "$clip" >"$out/controls.txt" 2>&1
        count $? "$out/controls.txt"
        timeout -k 5 6000 node tests/web/speech.js "$build/web/$name" "$chromium" "$out" >"$out/speech.txt" 2>&1
        count $? "$out/speech.txt"
    fi
    plan=$(node $fetch "$build/web-objects/plan.js" "$build/web/$name/page.nohz" 1)
    floats=$(echo "$plan" | sed -n 's/^floats //p') eyes=$(echo "$plan" | sed -n 's/^eyes //p')
    while read -r _ _ path light life cpu_used gpu_used; do [ -z "$path" ] || budget_of "$path" "$light" "$life" "$cpu_used" "$gpu_used"; done <<END
$(cat "$out/log.txt" "$out/figure.txt" | grep '^# budget ')
END
    [ "$all" = 1 ] && [ -z "${NOH_WEB_ONLY:-}" ] || return
    shown_pack=$build/web/$name/page.noh # as rounded for the wire form
    for shown in 'rest --light none --weight smile=0' 'smile --light none --weight smile=1' "clip --light none --clip $clip --time $time"; do
        # shellcheck disable=SC2086
        "$build/noh" render "$shown_pack" --springs off -o "$out/native.png" --size ${size}x$size --camera full --pose rest ${shown#* } >/dev/null || not_ok "noh render $shown"
        for path in $paths; do compare "${path}_${shown%% *}"; done
    done
    room='room --light room'
    [ "$name" != puppet_levels ] || room="$room --shadow off" # as page.js draws a body
    for shown in "$room" 'studio --light studio --rotate 40 --shadow off --tonemap none --background gradient'; do
        # shellcheck disable=SC2086
        "$build/noh" render "$shown_pack" --springs off -o "$out/native.png" --size ${size}x$size --camera full --pose rest ${shown#* } >/dev/null || not_ok "noh render $shown"
        for path in $paths; do [ ! -f "$out/${path}_${shown%% *}.png" ] || compare "${path}_${shown%% *}" 0.4; done
    done
    if [ -f "$out/tier.png" ]; then
        # shellcheck disable=SC2086
        "$build/noh" render "$shown_pack" --springs off -o "$out/native.png" --size ${size}x$size --camera full --pose rest ${room#* } --tier phone >/dev/null || not_ok 'noh render --tier phone'
        compare tier 0.4 # the full tier is 0.68 away
    fi
    [ -f "$out/level.png" ] || return
    "$build/noh" render "$shown_pack" --light none -o "$out/native.png" --size ${size}x$size --camera full --pose rest --lod 2 >/dev/null || not_ok 'noh render --lod'
    compare level
}

# A script with a summary line like this one's.
add() {
    said=$(NOH_BUILD="$build" sh "$@")
    echo "$said" | sed '$d'
    passed=$((passed + $(echo "$said" | sed -n 's/^\([0-9]*\) passed, .*/\1/p')))
    failed=$((failed + $(echo "$said" | sed -n 's/^[0-9]* passed, \([0-9]*\) failed.*/\1/p')))
}

for pack in "$@"; do
    case $pack in /*) ;; *) pack=$PWD/$pack ;; esac
    name=$(basename "$pack" .noh) clip=smile time=0.5 all=1 paths='auto mrt gather direct'
    figure=hair,spots,transfer,pushes,small # the parts of figure.js
    case $name in
    wig) all=0 figure=hair ;;
    nell) all=0 figure= ;;
    puppet_falls) all=0 figure=pushes ;;
    *_transfer) all=0 figure=transfer ;;
    puppet_levels) figure= ;;
    esac
    [ "$name" != puppet_levels ] || clip=dance time=3.25 paths=auto # the other paths are the mask's to try
    if make --no-print-directory DEPS=0 BUILD="${NOH_BUILD:-build}" web WEB_PACK="$pack"; then check_pack; else not_ok 'the page does not build'; fi
    [ "$name" != mask ] || add tests/web_package.sh "$pack"
    [ "$name" != mask ] || [ -n "${NOH_WEB_ONLY:-}" ] || add tests/web_bundlers.sh "$pack"
done
add tests/web_convert.sh
# The share of a figure in the picture while clips play.
assets=${NOH_ASSETS:-../shared/assets}
inside() { # NAME RATE CLIP...
    name=$1 out=$build/web-check/$1
    shift
    timeout -k 5 6000 node tests/web/silhouette.js "$build/web/$name" "$chromium" "$out" "$@" >"$out/silhouette.log" 2>&1
    count $? "$out/silhouette.log"
}
if [ "${NOH_LONG:-0}" != 1 ]; then
    [ ! -f "$build/web/puppet_levels/index.html" ] || [ -n "${NOH_WEB_ONLY:-}" ] || inside puppet_levels 3 dance
elif [ -f "$assets/hero/body.glb" ]; then
    mkdir -p "$build/web-check/body"
    "$build/noh" build "$assets/hero/body.glb" -o "$build/web-check/body.noh" --plain --wrinkles face --quiet &&
        make --no-print-directory DEPS=0 BUILD="${NOH_BUILD:-build}" web WEB_PACK="$build/web-check/body.noh" >/dev/null || not_ok 'no page of the body'
    inside body 30
fi
if [ "${NOH_LONG:-0}" = 1 ] && [ -f "$build/web/mask/index.html" ]; then # the crowd: its pack takes a minute
    name=festival out=$build/web-check/festival
    mkdir -p "$out"
    make --no-print-directory DEPS=0 BUILD="${NOH_BUILD:-build}" web-festival WEB_PACK="$build/page/mask.noh" >/dev/null || not_ok 'the crowd does not build'
    NOH_WEB_RATES=1 timeout -k 5 6000 node tests/web/festival.js "$build/web/mask" "$chromium" "$out" >"$out/log.txt" 2>&1
    count $? "$out/log.txt"
fi
[ "${NOH_LONG:-0}" != 1 ] || [ ! -f "$build/web/mask/index.html" ] || add tests/web_stock.sh "$build/web/mask"
echo "$passed passed, $failed failed, 0 skipped"
[ "$failed" = 0 ] && [ "$passed" != 0 ]
