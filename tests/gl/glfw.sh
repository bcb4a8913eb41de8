#!/bin/sh
# Windows on a virtual display: the driver glfw draws the same picture as EGL, byte for byte, and windows of glfw and of
# EGL are shown, read and measured.
. tests/cli/lib.sh
mask=$build/mask.noh

if ! command -v Xvfb >/dev/null 2>&1; then
    skip 'windows' 'no Xvfb here'
    finish
fi
Xvfb -displayfd 3 -screen 0 640x480x24 -nolisten tcp 3>"$work/display" 2>/dev/null &
server=$!
trap 'kill $server 2>/dev/null; rm -rf "$work"' EXIT
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    [ -s "$work/display" ] && break
    sleep 0.5
done
DISPLAY=:$(cat "$work/display")
export DISPLAY
check 'the virtual display runs' test "$DISPLAY" != :

noh render "$mask" --light none -o "$work/egl.png" --weight smile=1 --driver egl
if [ $code != 0 ]; then
    skip 'windows' 'no EGL context to compare with'
    finish
fi
noh render "$mask" --light none -o "$work/glfw.png" --weight smile=1 --driver glfw
if [ $code != 0 ] && grep -q 'libglfw' "$work/err"; then
    skip 'glfw' 'no libglfw.so.3 here'
else
    expect 0 'glfw draws'
    check 'glfw draws what EGL draws' cmp "$work/egl.png" "$work/glfw.png"
    noh verify "$mask" --driver glfw
    expect 0 'and every path there equals the CPU'
fi

for driver in glfw egl; do
    "$build/tests/gl/window" $driver >"$work/out" 2>"$work/err"
    code=$?
    if [ $code = 77 ]; then
        skip "a window of $driver" "$(grep . "$work/err" | tail -n 1)"
    else
        expect 0 "a window of $driver is drawn to, shown and measured"
    fi
done

unset DISPLAY
noh render "$mask" --light none -o "$work/none.png" --driver glfw
expect 1 'without a display glfw is refused'
says 'no GL context'
check 'and nothing is written' test ! -e "$work/none.png"
finish
