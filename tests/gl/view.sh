#!/bin/sh
# `noh view` on a virtual display: its options, then real key, mouse and drop events of a window system; view_figure.sh
# and view_tools.sh test their effects. Every run fails on any GL error reported by KHR_debug.
. tests/cli/lib.sh
. tests/support/view.sh
mask=$build/mask.noh
case $mask in /*) ;; *) mask=$PWD/$mask ;; esac
case $build in /*) ;; *) build=$PWD/$build ;; esac
tests_gl=$PWD/tests/gl

DISPLAY= WAYLAND_DISPLAY= noh view "$mask" --frames 1
if grep -q 'built without' "$work/err"; then
    skip 'view' "$(sed 's/^noh: [^:]*: //' "$work/err")"
    finish
fi
expect 1 'no display is an error'
says 'DISPLAY'
noh view
expect 2 'no file is a usage error'
noh view "$mask" --screenshot "$work/x.png"
expect 2 'so is a screenshot without --frames'
noh view "$mask" --driver osmesa
expect 2 'so is a driver that windows do not have'
noh view "$mask" --lod 9
expect 2 'so are more LOD levels than there can be'

start_display

# ---- without input ----

noh view "$mask" --frames 2 --size 900x600 --screenshot "$work/shot.png"
expect 0 'some frames and a screenshot'
check 'of the size of the window' test "$(png_size shot.png)" = 900x600
for path in layered mrt per-layer gather cpu direct; do
    format=f16
    [ $path != direct ] || format=f32 # it has no halves
    noh view "$mask" --path $path --accumulate $format --clip speak --frames 3 --size 700x400
    if [ $code != 0 ] && grep -q "^noh: $mask: " "$work/err"; then
        skip "path $path" "$(head -n 1 "$work/err")"
    else
        expect 0 "path $path"
        check 'and GL has nothing to say' test ! -s "$work/err"
    fi
done
for data in sums base smile; do # the pixels are tests/unit/tools/test_data_page.c's
    noh view "$mask" --data $data --frames 2 --size 900x800
    expect 0 "data textures: $data"
    check 'and GL has nothing to say' test ! -s "$work/err"
done
noh view "$mask" --data smirk --frames 1
expect 1 'and a target that is not there'
cat >"$work/leg.bvh" <<'BVH'
HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT knee
  {
    OFFSET 0 -10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -10 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0333333
0 20 0 0 0 0 0 0 0
1 20 0 5 0 0 30 0 0
BVH
noh view "$work/leg.bvh" --frames 2 --size 700x400
expect 0 'a clip is converted and its bones are shown'
says 'warning: the skeleton is 20 cm large with a unit of 1 cm; if it is a person, try --unit-cm 8.5'
check 'without another complaint' test "$(wc -l <"$work/err")" = 1
# The leg runs away and the camera follows, unless it is fixed: then only the times in the panels change.
sed 's/^Frames: .*/Frames: 3/; s/^Frame Time: .*/Frame Time: 0.5/; /^Frame Time/q' "$work/leg.bvh" >"$work/run.bvh"
printf '0 0 0 0 0 0 0 0 0\n0 0 100 0 0 0 0 0 0\n100 0 0 0 0 0 0 0 0\n' >>"$work/run.bvh"
run_for() { # FRAMES OUT ARGUMENTS...
    frames=$1 out=$2
    shift 2
    noh view "$work/run.bvh" --frames "$frames" --clip run --size 820x600 --screenshot "$work/$out.png" "$@"
    expect 0 "$frames frames of a run, $out"
}
changed() { # pixels of a hundred thousand in which a screenshot differs from the first
    "$build/tests/gl/picture_diff" "$work/first.png" "$work/$1.png" 255 100 | sed 's/.*, \([0-9.]*\) % of.*/\1/' | awk '{ print int($1 * 1000) }'
}
run_for 4 first # tables of the panels have found their widths by then
run_for 60 followed --camera follow
run_for 60 fixed --camera fixed
echo "# changed: $(changed followed) followed, $(changed fixed) fixed"
check 'the camera follows it' test $((3 * $(changed followed))) -lt "$(changed fixed)"
check 'or is fixed' test "$(changed fixed)" -gt 150
noh view "$work/run.bvh" --frames 1 --camera sideways
expect 2 'an unknown camera'
says '--camera must be follow or fixed'
noh view "$work/leg.bvh" --frames 2 --clip jump
expect 1 'a clip that is not there'
says "no clip named 'jump'"
noh view "$work/xvfb" --frames 2
expect 1 'a file that is no pack'

# ---- with input ----

# Each picture is a file noh-figure-N.png, written at once.
shots=0
figure() { # sets $shot
    shots=$((shots + 1))
    shot=$work/noh-figure-$shots.png
    xdotool key F11
    tries=0
    while [ ! -f "$shot" ] && [ $tries -lt 6000 ] && kill -0 $viewer 2>/dev/null; do sleep 0.1; tries=$((tries + 1)); done
}
drag() { # X0 Y0 X1 Y1 BUTTON
    xdotool mousemove "$1" "$2" mousedown "${5:-1}"
    figure
    xdotool mousemove $((($1 + $3) / 2)) $((($2 + $4) / 2))
    figure
    xdotool mousemove "$3" "$4"
    figure
    xdotool mouseup "${5:-1}"
    figure
}

open_viewer() { # SIZE [FILE]: sets $viewer, $window
    view_size=$1
    shift
    [ $# != 0 ] || set -- "$mask"
    "$build/noh" view "$@" --play off --face off --size "$view_size" >"$work/out" 2>"$work/err" &
    viewer=$!
    trap 'kill $viewer $xvfb 2>/dev/null; rm -rf "$work"' EXIT
    tries=0 # xdotool may trip over a window that is just being made
    while find_window; [ -z "$window" ] && [ $tries -lt 10 ] && kill -0 $viewer 2>/dev/null; do sleep 1; tries=$((tries + 1)); done
}
find_window() {
    window=$(timeout 60 xdotool search --sync --onlyvisible --pid $viewer 2>/dev/null | tail -n 1)
    [ -z "$window" ] || timeout 20 xdotool windowfocus --sync "$window"
}
# F10 discards the context, as a driver may: everything is restored in another window.
lose() {
    lost=$window
    xdotool key F10
    tries=0
    while find_window; [ "${window:-$lost}" = "$lost" ] && [ $tries -lt 50 ] && kill -0 $viewer 2>/dev/null; do sleep 0.2; tries=$((tries + 1)); done
}
close_viewer() { # NAME
    xdotool key Escape
    figure # it asks
    xdotool key Return
    wait $viewer
    code=$?
    expect 0 "$1"
    check 'GL had nothing to say' sh -c '! grep -q "^noh: GL" "$1"' - "$work/err"
}

cd "$work" || exit 1
open_viewer 1000x600
check 'a window opens' test -n "$window"
if [ -z "$window" ]; then
    sed 's/^/# /' "$work/err"
    finish
fi

figure
rest=$shot
check 'F11 saves the figure' test -f "$rest"
"$build/noh" render "$mask" -o "$work/render.png" --size "$(png_size "$rest")" --camera full --pose rest >/dev/null
check 'which is what noh render draws' same "$rest" "$work/render.png"
drag 470 230 360 280
check 'a drag turns the camera' differ "$rest" "$shot"
xdotool key f
figure
check 'F goes back to where it was' same "$rest" "$shot"
xdotool mousemove 470 230 click 4
figure
check 'the wheel brings it nearer' differ "$rest" "$shot"
xdotool key f
xdotool key Tab
figure
check 'Tab takes the panels away' test "$(png_size "$shot")" = 1000x600
xdotool key Tab
xdotool key F12
shots=$((shots + 1))
tries=0
while [ ! -f "$work/noh-window-$shots.png" ] && [ $tries -lt 6000 ] && kill -0 $viewer 2>/dev/null; do sleep 0.1; tries=$((tries + 1)); done
check 'F12 saves the window' test "$(png_size "noh-window-$shots.png")" = 1000x600
lose
check 'F10 loses the context, and a new one comes' test "${window:-$lost}" != "$lost"
figure
check 'in which the figure is as it was' same "$rest" "$shot"

if ${CC:-gcc} "$tests_gl/drop.c" -lX11 -o "$work/drop" >/dev/null 2>&1; then
    check 'a file can be dropped' "$work/drop" "$window" "$work/leg.bvh"
    figure
    check 'and is shown' differ "$rest" "$shot"
    bones=$shot
    check 'so can one that is no pack' "$work/drop" "$window" "$work/xvfb"
    figure
    check 'and what was shown stays' same "$bones" "$shot"
    check 'the reason is reported' grep -q "^noh: $work/xvfb: " "$work/err"
else
    skip 'drop' 'no X11 headers to compile a source of drops with'
fi
close_viewer 'Escape and Enter end it'

# ---- two pixels per point ----

if ! command -v xprop >/dev/null 2>&1; then
    skip 'a dense screen' 'xprop is not installed'
    finish
fi
xprop -root -f RESOURCE_MANAGER 8s -set RESOURCE_MANAGER 'Xft.dpi: 192'
rm -f "$work"/noh-*.png
shots=0
open_viewer 780x330
figure
sized=$shot
check 'a dense screen gets more pixels of the figure' test "$(png_size "$shot")" = 240x428
drag 780 250 700 290
check 'and drags where they are seen' differ "$sized" "$shot"
close_viewer 'Escape ends this one too'
finish
