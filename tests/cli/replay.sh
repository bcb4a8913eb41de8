#!/bin/sh
# noh lab replay and noh lab bisect: the same inputs give the same hashes; a change is located by frame and part; broken
# sessions.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh
noh lab replay "$pack" --seconds 3 --actors 2 --seed 5 -o "$work/a.session"
expect 0 'draw a session'
check 'describes it' grep -q '^180 frames, [0-9]* inputs in [0-9]* bytes ([0-9.]* a frame), hash [0-9a-f]\{8\}$' "$work/out"
noh lab replay "$pack" --play "$work/a.session" -o "$work/b.session"
expect 0 'play it'
check 'to the same hashes' grep -q 'every part of every frame equals' "$work/out"
check 'and the same file' cmp "$work/a.session" "$work/b.session"
noh lab replay "$pack" --seconds 3 --actors 2 --seed 6 -o "$work/other.session"
expect 0 'another seed'
check 'is another session' sh -c '! cmp -s "$1" "$2"' - "$work/a.session" "$work/other.session"
noh lab bisect "$work/a.session" "$work/b.session"
expect 0 'two equal sessions'
check 'are equal' grep -qx 'every part of 180 frames is equal' "$work/out"

# ---- what differs is found ----

floats=$(sed -n '/^hashes/,$s/^100 [0-9a-f]* [0-9a-f]* [0-9a-f]* \([0-9a-f]*\) .*/\1/p' "$work/a.session")
sed "s/^\(100 [0-9a-f]* [0-9a-f]* [0-9a-f]* \)$floats/\10badf00d/" "$work/a.session" >"$work/c.session"
noh lab bisect "$work/a.session" "$work/c.session"
expect 1 'one hash that differs'
check 'in its frame' grep -q '^frame 100 is the first that differs; the 100 before it are equal$' "$work/out"
check 'in its part alone' sh -c 'test "$(grep -c " differs$" "$1")" = 1 && grep -q "^  floats   differs$" "$1"' - "$work/out"
noh lab replay "$pack" --play "$work/c.session"
expect 1 'play it'
says 'frame 100 is the first that differs, in: floats'
awk '/^hashes/ { exit } !done && $1 > 50 && $1 ~ /^[0-9]+$/ { print "50 float 0 smile 0.25 1"; done = 1 } { print }' "$work/a.session" >"$work/more.session"
noh lab replay "$pack" --play "$work/more.session" -o "$work/more2.session"
expect 0 'a session with one more input, without hashes'
noh lab bisect "$work/a.session" "$work/more2.session"
expect 1 'differs'
check 'from that input on' grep -q '^the inputs differ from frame 50 on$' "$work/out"
check 'and so does the result' grep -q '^frame 50 is the first that differs' "$work/out"
noh lab bisect "$work/a.session" "$work/more.session"
expect 1 'a session without hashes'
says 'noh lab replay PACK --play'

# ---- JSON ----

noh lab replay "$pack" --play "$work/a.session" --json
expect 0 'replay --json'
check 'has its keys' sh -c 'for k in frames actors inputs refused input_bytes hash compared equal_frames differ; do grep -q "\"$k\":" "$1" || exit 1; done' - "$work/out"
noh lab bisect "$work/a.session" "$work/c.session" --json
expect 1 'bisect --json'
cp "$work/out" "$work/json"
if [ -n "$json" ]; then
    bisected() { $json 'j.frame === 100 && j.parts[0] === "floats" && j.input_frame === null' <"$work/json"; }
    check 'names frame and part' bisected
fi

# ---- what is refused ----

refused() { # TEXT MESSAGE
    printf '%b' "$1" >"$work/bad.session"
    noh lab replay "$pack" --play "$work/bad.session"
    expect 1 "refused: $2"
    says "$2"
}
crc=$(sed -n 's/^pack //p' "$work/a.session")
head="noh-session 1\npack $crc\nactors 2\nframes 10\n"
refused '' "expected 'noh-session'"
refused 'noh-session 2\n' 'the session has version 2'
refused "noh-session 1\npack 12\n" 'expected eight hexadecimal digits'
refused "noh-session 1\npack 00000000\nactors 2\nframes 10\n" 'the session belongs to another pack'
refused "noh-session 1\npack $crc\nactors 65\n" 'above the limit of 64'
refused "noh-session 1\npack $crc\nactors 0\n" 'at least one actor'
refused "${head}3 dance 0\n" "there is no input 'dance'"
refused "${head}3 stop 0 0 0\n2 stop 0 0 0\n" 'frame 2 follows frame 3'
refused "${head}10 stop 0 0 0\n" 'frame 10 is past the last frame'
refused "${head}3 stop 2 0 0\n" 'above the limit of 1'
refused "${head}3 stop 0 0\n" "'' is not a number"
refused "${head}3 stop 0 0 1e99\n" 'a number is too large'
refused "${head}3 stop 0 0 nan\n" 'is not finite'
refused "${head}3 stop 0 0 0 0\n" "'0' is one word too many on this line"
refused "${head}3 play 0\n" 'expected a name'
refused "${head}hashes state\n" "expected 'events'"
refused "${head}hashes state events places floats joints palettes vertices\n1 0\n" 'expected the hashes of frame 0, not of 1'
printf '%b' "${head}3 spawn 0 0 0 0\n3 play 0 nothing 0 0 1\n" >"$work/bad.session"
noh lab replay "$pack" --play "$work/bad.session"
expect 0 'an input that the stage refuses is played on'
check 'and told' grep -q "1 inputs were refused; the first, 'play' in frame 3" "$work/out"
for cut in 10 100 1000 5000; do
    head -c $cut "$work/a.session" >"$work/bad.session"
    noh lab replay "$pack" --play "$work/bad.session" --json
    check "cut at $cut bytes: an error, or a shorter session" sh -c 'test "$1" = 0 || test "$1" = 1' - $code
done
noh lab bisect "$work/a.session"
expect 2 'bisect of one'
noh lab replay "$pack" --seconds 0
expect 2 'no time'
noh lab replay "$pack" --actors 65
expect 2 'too many actors'
noh lab replay "$pack" --play "$work/a.session" --seed 3
expect 2 '--seed with --play'
finish
