#!/bin/sh
# first_program.sh: the programs of the guide that show a walking figure in a window, tools/examples/window: each has at
# most 60 lines, builds without a warning with the library alone, runs, and says what is wrong with a bad file.
. tests/cli/lib.sh
if ! command -v Xvfb >/dev/null 2>&1; then
    skip 'windows' 'no Xvfb here'
    finish
fi
Xvfb -displayfd 3 -screen 0 1024x768x24 -nolisten tcp 3>"$work/display" 2>/dev/null &
server=$!
trap 'kill $server 2>/dev/null; rm -rf "$work"' EXIT
for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    [ -s "$work/display" ] && break
    sleep 0.5
done
DISPLAY=:$(cat "$work/display")
export DISPLAY
check 'the virtual display runs' test "$DISPLAY" != :
echo 'no pack' >"$work/bad"

program() { # NAME PACKAGE
    source=tools/examples/window/$1.c
    check "$1: at most 60 lines" test "$(wc -l <"$source")" -le 60
    if ! pkg-config --exists "$2" 2>/dev/null; then
        skip "$1" "no $2 for pkg-config here"
        return
    fi
    # shellcheck disable=SC2046
    check "$1: builds without a warning" gcc -std=gnu99 -O1 -Wall -Wextra -Werror -Iruntime $(pkg-config --cflags "$2") "$source" \
        "$build/libnoh.a" -Wl,--gc-sections $(pkg-config --libs "$2") -o "$work/$1"
    (ulimit -S -t 120 && exec timeout 1200 "$work/$1" "$build/demo/puppet.noh" walk 5) >"$work/out" 2>"$work/err"
    code=$?
    if [ $code != 0 ] && grep -qi 'window\|GL' "$work/err"; then
        skip "$1: runs" "$(head -n 1 "$work/err")"
        return
    fi
    expect 0 "$1: five frames of a walk"
    check "$1: no message" test ! -s "$work/err"
    (ulimit -S -t 120 && exec timeout 1200 "$work/$1" "$work/bad" walk 5) >"$work/out" 2>"$work/err"
    code=$?
    expect 1 "$1: a file that is no pack"
    check "$1: the reason" grep -q 'pack' "$work/err"
}
program sdl2 sdl2
program glfw glfw3
finish
