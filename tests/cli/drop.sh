#!/bin/sh
# noh lab drop: output, quality of falls, written files, refused input.
. "$(dirname "$0")/lib.sh"

noh build "$build/demo/puppet.glb" -o "$work/puppet.noh" --plain --wrinkles face --effort 1 --quiet
expect 0 'build the puppet'

noh lab drop "$work/puppet.noh" --dolls 16 --seconds 10 --json --dump "$work/fall.csv" -o "$work/fall.png"
expect 0 'drop it'
check 'prints what it measures' sh -c 'for k in dolls bodies limit_max_deg penetration_max_mm separation_mean_mm settle_s asleep bytes_per_doll ns_per_body_step hash; do grep -q "\"$k\"" "$1" || exit 1; done' - "$work/out"
cp "$work/out" "$work/json"
below() { # KEY BOUND
    check "$1 is at most $2" sh -c 'sed -n "s/.*\"$2\": \([0-9.]*\).*/\1/p" "$1" | awk -v most="$3" "{ n++; if (\$1 > most) exit 1 } END { exit n != 1 }"' - "$work/json" "$1" "$2"
}
below limit_max_deg 12
below penetration_max_mm 5
below separation_mean_mm 0.3
below settle_s 4
below bytes_per_doll 4096
check 'all of them lie still' grep -q '"asleep": 16' "$work/json"
check 'the dump has a line for each frame, doll and body' test "$(wc -l <"$work/fall.csv")" = $((601 * 16 * 16 + 1))
check 'and a heading' sh -c 'head -n 1 "$1" | grep -qx "frame,doll,body,x,y,z,qx,qy,qz,qw"' - "$work/fall.csv"
check 'the strip is a picture' sh -c 'head -c 4 "$1" | grep -q PNG' - "$work/fall.png"

noh lab drop "$work/puppet.noh" --json
check 'the same again' sh -c 'test "$(grep hash "$1")" = "$(grep hash "$2")"' - "$work/out" "$work/json"
noh lab drop "$work/puppet.noh" --seconds 1 --seed 2
expect 0 'another seed'
check 'falls otherwise' sh -c '! grep -q "$(sed -n "s/.*\"hash\": \"\(.*\)\".*/\1/p" "$2")" "$1"' - "$work/out" "$work/json"

# an artist's own bodies, in any order
cat >"$work/puppet.ragdoll" <<'END'
# fewer than by names
shin.L hinge backward bend 0 140 friction 5
"hips"
thigh.L forward bend -20 95 side 40 twist 30 friction 5   # as names have it
spine bend -15 25 side 15 twist 15 friction 5
END
noh build "$build/demo/puppet.glb" -o "$work/own.noh" --plain --wrinkles face --effort 1 --quiet --ragdoll "$work/puppet.ragdoll"
expect 0 'a ragdoll of its own'
noh lab drop "$work/own.noh" --dolls 4 --seconds 1 --json
expect 0 'drop that'
check 'it has those bodies' grep -q '"bodies": 4' "$work/out"
bones=$build/demo/get_up.glb # its skeleton is the puppet's, and it is read in no time
bad() { # ROW MESSAGE
    printf 'hips\n%s\n' "$1" >"$work/bad.ragdoll"
    noh build "$bones" -o "$work/bad.noh" --ragdoll "$work/bad.ragdoll"
    expect 1 "refused: $1"
    check "line and cause of: $1" grep -q "bad.ragdoll:2: .*$2" "$work/err"
    check 'and no pack is left' test ! -e "$work/bad.noh"
}
bad 'spine bend 5 25' 'bend, the least angle: 5 must be -180 to 0'
bad 'spine bend -5' 'bend, the largest angle: the number is missing'
bad 'spine twist nan' ''
bad 'spine friction -1' 'friction: -1 must be 0 to 10000'
bad 'spine hinge side 5' 'a hinge only bends'
bad 'spine elastic' "a body has no setting 'elastic'"
bad 'hips' 'this joint is given twice; the first row is in line 1'
bad 'tail' "no skeleton has the joint 'tail'"
bad '"spine' 'a quote is not closed'
printf '# nothing\n' >"$work/bad.ragdoll"
noh build "$bones" -o "$work/bad.noh" --ragdoll "$work/bad.ragdoll"
expect 1 'an empty table'
says 'the ragdoll has no body'
printf 'thigh.L\nhead\n' >"$work/bad.ragdoll"
noh build "$bones" -o "$work/bad.noh" --ragdoll "$work/bad.ragdoll"
expect 1 'bodies that do not hang together'
says 'not a descendant of the first'

noh lab drop "$build/mask.noh"
expect 1 'a mask has no skeleton'
says 'no skeleton, and so no ragdoll'
noh lab drop "$work/puppet.noh" --dolls 0
expect 2 'no dolls'
says '--dolls must be a whole number from 1 to 1024'
noh lab drop "$work/puppet.noh" --substeps 4
expect 2 'too few substeps'
says '--substeps must be a whole number from 5 to 20'
noh lab drop "$work/puppet.noh" --seconds 0
expect 2 'no time'
noh lab drop "$work/puppet.noh" --seconds 1 --dump "$work/no/such/fall.csv"
expect 1 'a dump that cannot be written'
says 'cannot write'

# ---- pushed ----

noh sheet "$build/demo/puppet_falls.noh" -o "$work/fall.png" --clip walk --push 0,0,-150 --tiles 3 --tile 48
if [ $code != 0 ] && grep -q 'no GL context' "$work/err"; then
    skip 'a sheet of a fall' 'no GL context here'
else
    expect 0 'a sheet of a fall'
    noh sheet "$build/demo/puppet_falls.noh" -o "$work/walk.png" --clip walk --tiles 3 --tile 48
    check 'shows another picture' sh -c '! cmp -s "$1/fall.png" "$1/walk.png"' - "$work"
    noh sheet "$build/demo/puppet_falls.noh" -o "$work/again.png" --clip walk --push 0,0,-150 --tiles 3 --tile 48
    check 'and the same one each time' cmp -s "$work/fall.png" "$work/again.png"
fi
noh sheet "$build/demo/puppet_falls.noh" -o "$work/x.png" --clip walk --push 1,2
expect 2 'a push of two numbers'
says '--push must be X,Y,Z'
noh sheet "$build/demo/puppet_falls.noh" -o "$work/x.png" --clip walk --push 1,2,nan
expect 2 'a push that is no number'
finish
