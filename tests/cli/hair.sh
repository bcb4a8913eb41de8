#!/bin/sh
# noh build --hair: a haircut in a pack, info, pictures, refused input.
. "$(dirname "$0")/lib.sh"

# a head of hair on the arm: any mesh will do
cat >"$work/arm.hair" <<'END'
# a tuft
skull 0 0 0  0.1 0.12 0.1
around 6
rows 3   # from the crown to the hairline
points 5
strips 200
segments 6
length 0.2 0.2
sphere 0 -0.2 0 0.1
END
noh build "$build/demo/arm.glb" -o "$work/hair.noh" --quiet --hair "$work/arm.hair"
expect 0 'build with a haircut'
noh build "$build/demo/arm.glb" -o "$work/again.noh" --quiet --hair "$work/arm.hair"
check 'the same bytes again' cmp "$work/hair.noh" "$work/again.noh"
noh info "$work/hair.noh"
expect 0 'info'
check 'describes it' grep -q '^hair: 18 control hairs of 5 points, 12 patches, 4 spheres, 200 strips of 6 segments' "$work/out"
check 'and what it takes' grep -q 'on a stage 3728 bytes an actor; drawn with 1356 bytes on the CPU, 1440 on the GPU' "$work/out"
noh info "$work/hair.noh" --json
check 'as JSON, too' grep -q '"gpu_bytes": 1440' "$work/out"
budget_of() { # PACK: the CPU and GPU bytes of it
    noh budget "$1" --json
    number() { sed -n "s/.*\"$1\": \([0-9]*\).*/\1/p" "$work/out" | head -n 1; }
    echo "$(number cpu_bytes) $(number gpu_bytes)"
}
with=$(budget_of "$work/hair.noh")
check 'noh budget has a line for it' sh -c 'tr -d "\n" <"$1" | grep -q "\"name\": \"hair[ 0-9]*\", *\"cpu_bytes\": 1356, *\"gpu_bytes\": 1440"' - "$work/out"
noh verify "$work/hair.noh" --json
expect 0 'verify'
used="$(sed -n 's/.*"cpu_used": \([0-9]*\).*/\1/p' "$work/out" | head -n 1) $(sed -n 's/.*"gpu_used": \([0-9]*\).*/\1/p' "$work/out" | head -n 1)"
check "what is used is the budget: $used, $with" test "$used" = "$with"
noh build "$build/demo/arm.glb" -o "$work/bald.noh" --quiet
set -- $with $(budget_of "$work/bald.noh")
check 'on the GPU the hair is all that is more' test $(($2 - $4)) = 1440
noh render "$work/hair.noh" -o "$work/on.png" --size 96x96 --light none
expect 0 'draw it'
noh render "$work/hair.noh" -o "$work/off.png" --size 96x96 --light none --hair off
expect 0 'draw it without'
check 'that is another picture' sh -c '! cmp -s "$1" "$2"' - "$work/on.png" "$work/off.png"
noh render "$work/hair.noh" -o "$work/wind.png" --size 96x96 --light none --wind 30,0,0
expect 0 'in wind'
check 'that moves it' sh -c '! cmp -s "$1" "$2"' - "$work/on.png" "$work/wind.png"
noh render "$work/hair.noh" -o "$work/wind.png" --wind 30,0
expect 2 'half a wind'
noh render "$work/hair.noh" -o "$work/wind.png" --hair perhaps
expect 2 'neither on nor off'

bad() { # ROW MESSAGE
    printf 'skull 0 0 0 0.1 0.1 0.1\n%s\n' "$1" >"$work/bad.hair"
    noh build "$build/demo/arm.glb" -o "$work/bad.noh" --hair "$work/bad.hair"
    expect 1 "refused: $1"
    check "line and cause of: $1" grep -q "bad.hair:2: .*$2" "$work/err"
}
bad 'beard 1' "has no setting 'beard'"
bad 'rows 1' 'must be'
bad 'around' 'needs 1 number'
bad 'around nan' ''
bad 'around 200' 'more than 256 control hairs'
bad 'comb 0 0 0' 'give it a direction'
bad 'strips 200 300' 'one word too many'
bad 'sphere 0 0 0 -1' 'above 0'
printf 'rows 3\n' >"$work/bad.hair"
noh build "$build/demo/arm.glb" -o "$work/bad.noh" --hair "$work/bad.hair"
expect 1 'no skull'
says 'the skull is missing'
printf 'joint nowhere\nskull 0 0 0 1 1 1\n' >"$work/bad.hair"
noh build "$build/demo/arm.glb" -o "$work/bad.noh" --hair "$work/bad.hair"
expect 1 'no such joint'
says "no skeleton has the joint 'nowhere'"

# Each seed gives other colours of hair; from behind only hair is seen.
for person in 0 1 2; do
    noh render "$build/wig.noh" -o "$work/person_$person.png" --person $person --camera face,180,0 --size 64x64
    expect 0 "person $person"
done
check 'they differ' sh -c '! cmp -s "$1" "$2" && ! cmp -s "$2" "$3"' - "$work/person_0.png" "$work/person_1.png" \
    "$work/person_2.png"
noh render "$build/wig.noh" -o "$work/x.png" --person 1.5
expect 2 'a person is a whole number'
finish
