#!/bin/sh
# `noh view` on a virtual display, driven with real key, mouse and drop events. Every run fails on any GL error
# that KHR_debug reports. F11 saves the figure without the panels; those pictures are compared.
. tests/cli/lib.sh
mask=$build/mask.noh
case $mask in /*) ;; *) mask=$PWD/$mask ;; esac
case $build in /*) ;; *) build=$PWD/$build ;; esac
tests_gl=$PWD/tests/gl
levels=$build/mask_levels.noh

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

for program in Xvfb xdotool; do
    if ! command -v $program >/dev/null 2>&1; then
        skip 'windows' "$program is not installed"
        finish
    fi
done
# -noreset: else it resets between two programs, and refuses one that connects meanwhile.
Xvfb -noreset -displayfd 3 -screen 0 1800x1000x24 3>"$work/display" >"$work/xvfb" 2>&1 &
xvfb=$!
trap 'kill $xvfb 2>/dev/null; rm -rf "$work"' EXIT
tries=0
while [ ! -s "$work/display" ] && [ $tries -lt 50 ]; do sleep 0.2; tries=$((tries + 1)); done
if [ ! -s "$work/display" ]; then
    skip 'windows' 'Xvfb does not start here'
    finish
fi
DISPLAY=:$(cat "$work/display")
export DISPLAY

# ---- without a hand ----

png_size() { # FILE: "640x480"
    od -An -tu1 -j16 -N8 "$1" | awk '{ print ($1 * 256 + $2) * 65536 + $3 * 256 + $4 "x" ($5 * 256 + $6) * 65536 + $7 * 256 + $8 }'
}
noh view "$mask" --frames 2 --size 900x600 --screenshot "$work/shot.png"
if [ $code != 0 ] && grep -q 'no window with OpenGL ES' "$work/err"; then
    skip 'windows' 'no window with OpenGL ES 3 here'
    finish
fi
expect 0 'some frames and a screenshot'
check 'of the size of the window' test "$(png_size "$work/shot.png")" = 900x600
for path in layered mrt per-layer gather cpu; do
    noh view "$mask" --path $path --accumulate f16 --clip speak --frames 3 --size 700x400
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
check 'without a complaint' test ! -s "$work/err"
# The leg runs off; the camera goes with it, unless it is told to stay. Only the times in the panels change then.
sed 's/^Frames: .*/Frames: 3/; s/^Frame Time: .*/Frame Time: 0.5/; /^Frame Time/q' "$work/leg.bvh" >"$work/run.bvh"
printf '0 0 0 0 0 0 0 0 0\n0 0 100 0 0 0 0 0 0\n100 0 0 0 0 0 0 0 0\n' >>"$work/run.bvh"
run_for() { # FRAMES OUT ARGUMENTS...
    frames=$1 out=$2
    shift 2
    noh view "$work/run.bvh" --frames "$frames" --clip run --size 1200x1000 --screenshot "$work/$out.png" "$@"
    expect 0 "$frames frames of a run, $out"
}
changed() { # pixels of a hundred thousand in which a screenshot differs from the first
    "$build/tests/gl/picture_diff" "$work/first.png" "$work/$1.png" 255 100 | sed 's/.*, \([0-9.]*\) % of.*/\1/' | awk '{ print int($1 * 1000) }'
}
run_for 4 first # tables of the panels have found their widths by then
run_for 60 followed --camera follow
run_for 60 fixed --camera fixed
echo "# changed: $(changed followed) followed, $(changed fixed) fixed"
check 'the camera follows it' test "$(changed followed)" -lt 700
check 'or is fixed' test "$(changed fixed)" -gt 1200
noh view "$work/run.bvh" --frames 1 --camera sideways
expect 2 'an unknown camera'
says '--camera wants follow or fixed'
noh view "$work/leg.bvh" --frames 2 --clip jump
expect 1 'a clip that is not there'
says "no clip named 'jump'"
noh view "$work/xvfb" --frames 2
expect 1 'a file that is no pack'

# ---- by hand ----

# Each picture is a file noh-figure-N.png, written at once.
shots=0
figure() { # sets $shot
    shots=$((shots + 1))
    shot=$work/noh-figure-$shots.png
    xdotool key F11
    tries=0
    while [ ! -f "$shot" ] && [ $tries -lt 900 ] && kill -0 $viewer 2>/dev/null; do sleep 0.1; tries=$((tries + 1)); done
}
same() { cmp -s "$1" "$2"; }
# But for a rounding: creases and skin are lit by derivatives, and other programs round them otherwise.
near() { "$build/tests/gl/picture_diff" "$1" "$2" 0.02 0.01 >/dev/null; }
differ() { [ -f "$1" ] && [ -f "$2" ] && ! cmp -s "$1" "$2"; }
moves() { # within some pictures the figure changes
    figure
    first=$shot
    tried=0
    while [ $tried -lt 15 ]; do
        figure
        ! differ "$first" "$shot" || return 0
        tried=$((tried + 1))
    done
    return 1
}
# A picture is saved some frames after its key, so it is also how to wait until all that went before has been drawn.
click() { # X Y
    xdotool mousemove "$1" "$2" click 1
    figure
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

open_viewer() { # SIZE [FILE OPTIONS]: sets $viewer, $window
    view_size=$1
    shift
    [ $# != 0 ] || set -- "$mask"
    "$build/noh" view "$@" --face off --size "$view_size" >"$work/out" 2>"$work/err" &
    viewer=$!
    trap 'kill $viewer $xvfb 2>/dev/null; rm -rf "$work"' EXIT
    tries=0 # xdotool may trip over a window that is just being made
    while find_window; [ -z "$window" ] && [ $tries -lt 3 ] && kill -0 $viewer 2>/dev/null; do sleep 1; tries=$((tries + 1)); done
}
find_window() {
    window=$(timeout 60 xdotool search --sync --onlyvisible --pid $viewer 2>/dev/null | tail -n 1)
    [ -z "$window" ] || timeout 20 xdotool windowfocus --sync "$window"
}
# F10 throws the context away, as a driver may: all of it is made again, in another window.
lose() {
    lost=$window
    xdotool key F10
    tries=0
    while find_window; [ "${window:-$lost}" = "$lost" ] && [ $tries -lt 50 ] && kill -0 $viewer 2>/dev/null; do sleep 0.2; tries=$((tries + 1)); done
}
close_viewer() { # NAME
    xdotool key Escape
    wait $viewer
    code=$?
    expect 0 "$1"
    check 'GL had nothing to say' sh -c '! grep -q "^noh: GL" "$1"' - "$work/err"
}

cd "$work" || exit 1
open_viewer 1280x800
check 'a window opens' test -n "$window"
if [ -z "$window" ]; then
    sed 's/^/# /' "$work/err"
    finish
fi

figure
rest=$shot
check 'F11 saves the figure' test -f "$rest"
"$build/noh" render "$mask" -o "$work/render.png" --size "$(png_size "$rest")" >/dev/null
check 'which is what noh render draws' same "$rest" "$work/render.png"

drag 610 300 500 350
check 'a drag turns the camera' differ "$rest" "$shot"
turned=$shot
drag 610 300 590 280 3
check 'the right button moves it' differ "$turned" "$shot"
turned=$shot
xdotool mousemove 610 300 click 4
figure
check 'the wheel brings it nearer' differ "$turned" "$shot"
xdotool key f
figure
check 'F goes back to where it was' same "$rest" "$shot"

# The search leaves one slider; dragged to its end it is at 1.
click 100 55
xdotool type cheekpuff
drag 15 79 250 79
"$build/noh" render "$mask" -o "$work/puff.png" --size "$(png_size "$rest")" --weight cheekPuff=1 >/dev/null
check 'a slider moves the target that was searched for' near "$shot" "$work/puff.png"
click 255 55
check 'reset lets it go' same "$rest" "$shot"

click 938 95 # play, third row: speak
check 'a clip plays' moves
xdotool key space
figure
paused=$shot
sleep 0.5
figure
check 'space pauses it' same "$paused" "$shot"
drag 1000 190 1180 190
check 'its time can be scrubbed' differ "$paused" "$shot"
xdotool key space
check 'space plays it again' moves
xdotool key space
figure
paused=$shot

# The list of paths opens below its box; mrt is its third entry, 58 points below.
click 1030 306
click 1030 364
check 'another path draws the same figure' near "$paused" "$shot"

xdotool key Tab
figure
check 'Tab takes the panels away' test "$(png_size "$shot")" = 1280x800
xdotool key Tab
xdotool key F12
shots=$((shots + 1))
tries=0
while [ ! -f "$work/noh-window-$shots.png" ] && [ $tries -lt 100 ]; do sleep 0.1; tries=$((tries + 1)); done
check 'F12 saves the window' test "$(png_size "$work/noh-window-$shots.png")" = 1280x800

lose
check 'F10 loses the context, and a new one comes' test "${window:-$lost}" != "$lost"
figure
check 'in which the figure is as it was, drawn the same way' near "$paused" "$shot"

if ${CC:-gcc} "$tests_gl/drop.c" -lX11 -o "$work/drop" >/dev/null 2>&1; then
    before=$shot
    check 'a file can be dropped' "$work/drop" "$window" "$work/leg.bvh"
    figure
    check 'and is shown' differ "$before" "$shot"
    bones=$shot
    lose
    figure
    check 'bones are drawn again after a lost context' same "$bones" "$shot"
    check 'so can one that is no pack' "$work/drop" "$window" "$work/xvfb"
    figure
    check 'and what was shown stays' same "$bones" "$shot"
    check 'the reason is told' grep -q "^noh: $work/xvfb: " "$work/err"
    check 'the model of a pack is converted' "$work/drop" "$window" "$build/mask.glb"
    figure
    check 'and looks as the pack' near "$rest" "$shot"
else
    skip 'drop' 'no X11 headers to compile a source of drops with'
fi

xdotool key p
figure
check 'a push of what cannot fall says why' grep -q '^noh: .*: it cannot fall: ' "$work/err"
close_viewer 'Escape ends it'

# ---- light ----

rm -f "$work"/noh-*.png
shots=0
open_viewer 1280x800 "$mask" --light room --rotate 20
lit() { # OPTIONS: as noh render draws it, in $drawn
    drawn=$work/lit.png
    "$build/noh" render "$mask" -o "$drawn" --size "$(png_size "$rest")" --light room "$@" >/dev/null
}
figure
rest=$shot
lit --rotate 20
check 'light, its shadow and its background are those of noh render' same "$rest" "$drawn"
lit --rotate 20 --shadow off
check 'which has a shadow' differ "$rest" "$drawn"
xdotool key bracketright
figure
lit --rotate 35
check '] turns the light by 15 degrees' same "$shot" "$drawn"
lose
figure
check 'light is there again after a lost context' same "$shot" "$drawn"
xdotool key bracketleft
figure
check '[ turns it back' same "$rest" "$shot"
close_viewer 'a lit figure is closed'
for background in gradient plain; do
    noh view "$mask" --light room --background $background --shadow off --tonemap none --frames 2 --size 700x400
    expect 0 "in front of $background"
    check 'GL has nothing to say of that' test ! -s "$work/err"
done
noh view "$mask" --light room --background purple
expect 2 'an unknown background'

# ---- LOD levels ----

# Pictures until one is as the one before: a change of level has been faded.
settled() {
    tried=0
    figure
    while [ $tried -lt 30 ]; do
        before=$shot
        figure
        ! same "$before" "$shot" || return 0
        tried=$((tried + 1))
    done
    return 1
}
wheel() { # 4 nearer, 5 farther, how often
    xdotool mousemove 610 300 click --repeat "$2" --delay 20 "$1"
}
native() { # LEVEL OPTIONS: sets $drawn
    drawn=$work/native-$1.png
    "$build/noh" render "$levels" -o "$drawn" --size "$(png_size "$rest")" --lod "$@" >/dev/null
}

# Below the table's head lie full, three levels and `by pixels`, 17 points each, and the slider.
rm -f "$work"/noh-*.png
shots=0
open_viewer 1280x800 "$levels"
figure
rest=$shot
native 0
check 'a pack with levels is shown in full' same "$rest" "$drawn"
xdotool key l
figure
native 1
check 'L shows the next level, as noh render draws it' same "$shot" "$drawn"
check 'which is another picture' differ "$rest" "$shot"
click 930 310
native 3
check 'a click on the third level shows that' same "$shot" "$drawn"
click 100 55
xdotool type cheekpuff
drag 15 79 250 79
native 3 --weight cheekPuff=1
check 'and targets move it' same "$shot" "$drawn"
click 255 55
click 930 259
check 'a click on the full one shows that again' same "$rest" "$shot"
click 930 327
check 'by pixels' settled
check 'the full mesh is shown where no other is good enough' same "$rest" "$shot"
wheel 5 12
check 'the wheel moves it away: a level fades in' settled
far=$shot
xdotool key l
figure
full=$shot
check 'it is not the full mesh' differ "$full" "$far"
found=
for level in 1 2 3; do
    xdotool key l
    figure
    ! same "$shot" "$far" || found=$found$level
done
check 'but one of the levels' test -n "$found"
xdotool key l
settled
check 'by pixels again: the same one' same "$shot" "$far"
wheel 4 12
settled
check 'nearer, it is the full mesh again, or as good' same "$rest" "$shot"
click 1255 349
check 'sixteen pixels allowed' settled
native 2
check 'are enough for the next level' same "$shot" "$drawn"
lose
settled
check 'after a lost context it is at the same level' same "$shot" "$drawn"
close_viewer 'Escape ends it'

if [ -n "${NOH_SAN:-}" ]; then
    skip 'a model converted with levels' 'takes long under a sanitizer'
else
    rm -f "$work"/noh-*.png
    shots=0
    "$build/noh" build "$build/demo/arm.glb" -o "$work/arm.noh" --lod 3 --lod-fast --quiet
    levels=$work/arm.noh
    open_viewer 1280x800 "$build/demo/arm.glb" --lod 3
    xdotool key l
    figure
    rest=$shot
    native 1
    check 'a model is converted with levels when asked to' same "$shot" "$drawn"
    close_viewer 'Escape ends it'
fi

# ---- a body: picking, layers, a blend space, a floor ----

# I prints the state: the lines of the last one go to $work/state.
state() {
    wanted=$(($(grep -c '^end of state' "$work/out") + 1))
    xdotool key i
    tries=0
    while [ "$(grep -c '^end of state' "$work/out")" -lt $wanted ] && [ $tries -lt 600 ] && kill -0 $viewer 2>/dev/null; do sleep 0.1; tries=$((tries + 1)); done
    awk '/^state of/ { text = "" } { text = text $0 "\n" } /^end of state/ { last = text } END { printf "%s", last }' "$work/out" >"$work/state"
}
tells() { grep -q -- "$1" "$work/state"; }
near() { # NUMBER NUMBER WITHIN
    awk -v a="$1" -v b="$2" -v most="$3" 'BEGIN { exit !(a != "" && b != "" && a - b <= most && b - a <= most) }'
}
alike() { "$build/tests/gl/picture_diff" "$1" "$2" 0.2 0.002 >/dev/null; } # up to some ticks
picked_at() { sed -n 's/^picked .* at //p' "$work/state"; }
weight_of() { sed -n "s/^track .* $1 .* weight \([0-9.]*\),.*/\1/p" "$work/state"; }
phase_of() { sed -n "s/^track .* $1 \([0-9.]*\) s,.*/\1/p" "$work/state" | awk -v all="$2" '{ print $1 / all }'; }
place_z() { sed -n 's/^place [^ ]* [^ ]* //p' "$work/state"; }
center_z() { sed -n 's/^center [^ ]* [^ ]* //p' "$work/state"; }

puppet=$build/demo/puppet_levels.noh
rm -f "$work"/noh-*.png
shots=0
open_viewer 1280x800 "$puppet"
figure
rest=$shot

click 615 100
check 'a ring marks what was clicked on' differ "$rest" "$shot"
state
check 'which is the mask, on the jaw' tells "^picked mesh 'mask', submesh 0 'paint', triangle [0-9]*, joint 'jaw', at 0.0[0-9]* 1.4"
click 615 330
state
check 'below it the body' tells "^picked mesh 'body', submesh 0 'cloth', triangle [0-9]*, joint 'hips', at 0.0[0-9]* 0.8"
drag 610 300 600 300
state
check 'a drag picks nothing' tells "^picked mesh 'body', submesh 0"
xdotool key f
click 330 60
check 'a click beside the figure lets go' same "$rest" "$shot"

# With a track the sections begin 220 points from the top: Layers, Blend space, Floor.
click 938 78   # play walk
click 980 220  # Layers
click 931 374  # fade: at once
click 1030 351 # part, from
click 1030 477 # chest
click 1030 328 # layer
click 1030 386 # part
click 1030 443 # loop
click 1030 518 # ping-pong
click 938 95   # play bow
xdotool key space
figure
click 1150 240 # in its middle
click 570 560
bowing=$shot
state
check 'a walk plays on the body' tells '^track 0 body walk .* weight 1.000, speed 1.000, sync 0, repeat, on'
check 'and a bow on a part of it, as asked for' tells '^track 8 part bow .* weight 1.000, speed 1.000, sync 0, ping-pong, on'
check 'a leg is picked' tells "^picked mesh 'body'.* joint '.*\.[LR]'"
leg=$(picked_at)
click 932 263 # the weight of the bow: 0
walking=$shot
check 'which bows less with less weight' differ "$bowing" "$walking"
state
check 'but not in the legs, which the mask leaves out' near "${leg##* }" "$(picked_at | sed 's/.* //')" 0.0011
click 1085 263
check 'with weight it bows again' alike "$bowing" "$shot"
click 1191 220 # mute
state
check 'muted it plays on' tells '^track 8 part bow .* muted'
check 'but is not in the pose' alike "$walking" "$shot"
click 1191 220
click 1236 220 # stop
state
check 'without it the walk is the same' alike "$walking" "$shot"
check 'it is stopped' sh -c '! grep -q "part bow" "$1"' - "$work/state"
xdotool key space
tries=0
while state; ! tells '^key .* body: walk / foot' && [ $tries -lt 40 ]; do tries=$((tries + 1)); sleep 0.1; done
check 'callback keys name their layer' tells '^key [0-9]* .* s   body: walk / foot_.* weight 1.00'
xdotool key space
click 1025 41 # stop all
click 980 157 # Layers
click 330 60

# Without a track they begin 157 points from the top.
click 980 180 # Blend space
click 1030 203
click 960 227 # idle, walk, dance
click 960 244
click 960 295
click 1264 796
state
check 'three clips on a pad weigh the same in its middle' tells '^pad at 0.000 0.000, idle 0.333, walk 0.333, dance 0.333'
click 958 461 # play
sleep 1
xdotool key space
figure
state
check 'they play with these weights, in step' tells '^track . body dance .* weight 0.333, .* sync 1, repeat, on'
check 'idle and walk are at the same phase' near "$(phase_of idle 4)" "$(phase_of walk 1.4)" 0.01
middle=$shot
drag 1043 331 1123 378
state
check 'at the corner of one it has all the weight' near "$(weight_of walk)" 1 0.005
check 'and the others none' near "$(weight_of dance)" 0 0.005
check 'which is another pose' differ "$middle" "$shot"
drag 1043 239 983 259
state
check 'clips can be moved' sh -c '! grep -q "pad at 0.000" "$1"' - "$work/state"
check 'and the point stays' near "$(weight_of walk)" 1 0.02
close_viewer 'Escape ends it'

rm -f "$work"/noh-*.png
shots=0
open_viewer 1280x800 "$puppet" --clip walk --walk
figure
state
from=$(center_z) at=$(place_z)
sleep 2
figure
xdotool key space
figure
state
check 'a walk goes over the floor' awk -v a="$at" -v b="$(place_z)" 'BEGIN { exit !(b > a + 0.2) }'
check 'and the camera goes with it' near "$(awk -v a="$from" -v b="$(center_z)" 'BEGIN { print b - a }')" "$(awk -v a="$at" -v b="$(place_z)" 'BEGIN { print b - a }')" 0.002
with_floor=$shot
click 980 266 # Floor
click 937 289 # floor
check 'the floor can be taken away' differ "$with_floor" "$shot"
click 937 289
check 'and laid again' same "$with_floor" "$shot"
click 1177 289 # back to the start
state
check 'the figure is sent back' near "$(place_z)" 0 0.0001
check 'and its path is gone' differ "$with_floor" "$shot"
click 1001 289 # root motion
xdotool key space
sleep 1
figure
state
check 'without root motion it stays' near "$(place_z)" 0 0.0001
check 'and plays on' tells '^track 0 body walk .* on'
lose
figure
check 'a floor is there again after a lost context' test -f "$shot"
close_viewer 'Escape ends it'

rm -f "$work"/noh-*.png
shots=0
open_viewer 1280x800 "$puppet"
figure
click 980 226 # Graph
click 945 249 # play
state
check 'a graph plays on the body' tells '^graph moves, speed 0.000, attention 0.000, .* bows: acts'
click 1140 283
state
check 'its parameters are moved' tells '^graph moves, speed 0.900, attention 0.000, '
click 942 352 # the trigger
state
check 'a trigger plays a bow once' tells '^graph moves, .* bows: bowing'
check 'it shows' moves
close_viewer 'Escape ends it'

# ---- pushes ----

becomes() { # STATE: within some time its body does
    tried=0
    while state; ! tells "^body $1" && [ $tried -lt 60 ]; do tried=$((tried + 1)); done
    tells "^body $1"
}
rm -f "$work"/noh-*.png
shots=0
open_viewer 1280x800 "$build/demo/puppet_falls.noh" --clip walk
figure
state
check 'a figure stands' tells '^body stands'
standing=$shot
xdotool mousemove 615 300 keydown Alt_L click 1 keyup Alt_L
check 'a click with Alt pushes it: it falls' becomes falls
check 'and picks nothing' sh -c '! grep -q "^picked" "$1"' - "$work/state"
figure
check 'which shows' differ "$standing" "$shot"
check 'it gets up' becomes 'gets up'
check 'by a clip for that' tells '^track . body get_up_'
check 'and stands' becomes stands
check 'it goes on with its clip' tells '^track . body walk '
xdotool mousemove 330 60 keydown Alt_L click 1 keyup Alt_L
state
check 'a push beside it is none' tells '^body stands'
xdotool key space key p
check 'P pushes it, and time goes on' becomes falls
lose
check 'a lost context does not end the fall' becomes 'gets up'
close_viewer 'Escape ends it'

# ---- twice as many pixels in a point ----

if ! command -v xprop >/dev/null 2>&1; then
    skip 'a dense screen' 'xprop is not installed'
    finish
fi
xprop -root -f RESOURCE_MANAGER 8s -set RESOURCE_MANAGER 'Xft.dpi: 192'
rm -f "$work"/noh-*.png
shots=0
open_viewer 860x480
figure
check 'a dense screen gets more pixels of the figure' test "$(png_size "$shot")" = 400x696
drag 30 158 500 158
"$build/noh" render "$mask" -o "$work/smile.png" --size 400x696 --weight smile=1 >/dev/null
# The viewer morphs tangents, noh render turns them with the normals, which shows in creases.
check 'and sliders where they are seen' "$build/tests/gl/picture_diff" "$shot" "$work/smile.png" 0.25 0.5
close_viewer 'Escape ends this one too'
finish
