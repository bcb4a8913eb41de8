# view.sh: shared by the tests of `noh view`: a virtual display and scripted input. Each test begins with `.
# tests/cli/lib.sh` and `. tests/support/view.sh`.
#
#   start_display            ends the test as skipped if there is no display
#   hand NAME ARGUMENTS <<.. run noh view with a script (tools/noh/view/view_script.h) in $work, where it saves pictures;
#                            expectations are checked frame by frame, independent of time
#   last STATE-LINE          text after these words in the last printed state
#   same, differ, alike A B  compare pictures, in $work if no folder is given
#   check_near A B WITHIN    compare numbers

start_display() {
    for program in Xvfb xdotool; do
        command -v $program >/dev/null 2>&1 && continue
        skip 'windows' "$program is not installed"
        finish
    done
    # -noreset: otherwise it resets between two programs and refuses connections meanwhile.
    Xvfb -noreset -displayfd 3 -screen 0 1800x1000x24 3>"$work/display" >"$work/xvfb" 2>&1 &
    xvfb=$!
    trap 'kill $xvfb 2>/dev/null; rm -rf "$work"' EXIT
    tries=0
    while [ ! -s "$work/display" ] && [ $tries -lt 150 ]; do sleep 0.2; tries=$((tries + 1)); done
    if [ ! -s "$work/display" ]; then
        skip 'windows' 'Xvfb does not start here'
        finish
    fi
    DISPLAY=:$(cat "$work/display")
    export DISPLAY
    noh view "$build/mask.noh" --frames 1 --size 700x400
    if [ $code != 0 ] && grep -q 'built without\|no window with OpenGL ES' "$work/err"; then
        skip 'windows' "$(sed 's/^noh: [^:]*: //' "$work/err" | head -n 1)"
        finish
    fi
}

hand() {
    name=$1
    shift
    cat >"$work/hand.txt"
    (cd "$work" && "$build/noh" view "$@" --face off --size "${view_size:-820x500}" --script hand.txt) \
        >"$work/out" 2>"$work/err"
    code=$?
    expect 0 "$name"
    check 'and GL has nothing to say' sh -c '! grep "^noh: GL" "$1"' - "$work/err"
}
last() {
    sed -n "s/^$1//p" "$work/out" | tail -n 1
}
path_of() { case $1 in /*) echo "$1" ;; *) echo "$work/$1" ;; esac; }
same() { cmp -s "$(path_of "$1")" "$(path_of "$2")"; }
differ() { [ -f "$(path_of "$1")" ] && [ -f "$(path_of "$2")" ] && ! same "$1" "$2"; }
# Equal except for rounding: creases and skin are lit by derivatives, which different programs round differently.
alike() { "$build/tests/gl/picture_diff" "$(path_of "$1")" "$(path_of "$2")" "${3:-0.02}" "${4:-0.01}"; }
check_near() {
    awk -v a="$1" -v b="$2" -v most="$3" 'BEGIN { exit !(a != "" && b != "" && a - b <= most && b - a <= most) }'
}
png_size() { # FILE: "640x480"
    od -An -tu1 -j16 -N8 "$(path_of "$1")" | awk '{ print ($1 * 256 + $2) * 65536 + $3 * 256 + $4 "x" ($5 * 256 + $6) * 65536 + $7 * 256 + $8 }'
}
draw() { # OUT LIKE FILE OPTIONS: as noh render has it, of the size of the picture LIKE
    drawn=$1 like=$2 drawn_file=$3
    shift 3
    "$build/noh" render "$drawn_file" -o "$work/$drawn" --size "$(png_size "$like")" --camera full --pose rest "$@" >/dev/null
}
