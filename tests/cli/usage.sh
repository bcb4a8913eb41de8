#!/bin/sh
# Wrong arguments: exit code 2, one line on stderr, nothing on stdout.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh
verbs='build strip pack info budget render sheet dump verify crowd speak mask bake face bench'
lab='zoom drop light replay bisect'

quiet_stdout() {
    check "and prints nothing else" test ! -s "$work/out"
}

noh
expect 2 'no verb is a usage error'
noh help
expect 0 'help is not an error'
check 'help names every verb' sh -c 'for v in $2; do grep -q "noh $v " "$1" || exit 1; done' - "$work/out" "$verbs lab"
noh lab
expect 2 'no verb of the lab is a usage error'
noh lab --help
expect 0 'help of the lab is not an error'
check 'it names every verb' sh -c 'for v in $2; do grep -q "noh lab $v " "$1" || exit 1; done' - "$work/out" "$lab"
cp "$work/out" "$work/lab"
noh help lab
check 'help lab says the same' cmp "$work/out" "$work/lab"
noh biuld "$pack"
expect 2 'an unknown verb'
says "there is no verb 'biuld'"
quiet_stdout
noh lab zom "$pack"
expect 2 'an unknown verb of the lab'
says "there is no verb 'lab zom' (did you mean 'lab zoom'?)"
noh lab render "$pack"
expect 2 'a verb outside the lab'
for verb in $lab; do
    noh $verb "$pack"
    expect 2 "$verb without lab"
    says "there is no verb '$verb': use noh lab $verb"
    noh help $verb
    expect 2 "help $verb without lab"
    says "noh lab $verb"
    quiet_stdout
done

for verb in $verbs $(printf 'lab_%s ' $lab); do
    verb=$(echo "$verb" | tr _ ' ')
    noh $verb
    expect 2 "$verb without a file"
    noh $verb "$pack" --no-such-option
    expect 2 "$verb with an unknown option"
    says '--no-such-option'
    quiet_stdout
done

for verb in strip pack info budget 'lab light' verify; do
    noh $verb "$pack" "$pack"
    expect 2 "$verb with one file too many"
    says 'one file too many'
done

noh build in.glb
expect 2 'build without -o'
says '-o'
noh build in.glb -o
expect 2 'an option without its value'
says '-o needs a value'
noh build in.glb -o "$work/out.noh" --error-um ten
expect 2 'an invalid number'
says "--error-um must be a number, not 'ten'"
for value in 0 -1 1e9 nan inf; do
    noh build in.glb -o "$work/out.noh" --error-um $value
    expect 2 "--error-um $value"
done
for value in 0 -3 2.5 65536 many; do
    noh build in.glb -o "$work/out.noh" --rects $value
    expect 2 "--rects $value"
    says '--rects must be'
done
for value in 0 33 2.5 many; do
    noh build in.glb -o "$work/out.noh" --influences $value
    expect 2 "--influences $value"
    says '--influences must be'
done
for value in 3 257 4.5 many; do
    noh build in.glb -o "$work/out.noh" --palette $value
    expect 2 "--palette $value"
    says '--palette must be'
done
for value in 0x512 512 512x 512x0 9000x10 -1x5 axb; do
    noh render "$pack" -o "$work/out.png" --size $value
    expect 2 "--size $value"
    says '--size must be'
done
noh render "$pack" -o "$work/out.png" --path fastest
expect 2 'an unknown path'
says "--path must be auto, blend, layered, mrt, per-layer, gather, direct, cpu or streams, not 'fastest'"
noh render "$pack" -o "$work/out.png" --accumulate f64
expect 2 'an unknown accumulator'
says '--accumulate must be'
noh render "$pack" -o "$work/out.png" --driver vulkan
expect 2 'an unknown driver'
says "no driver 'vulkan'"
noh render "$pack" -o "$work/out.png" --debug skeleton
expect 2 'an unknown debug view'
says "--debug must be none, position, normal, tangent, lod, light, occlusion, wrinkle, wireframe, joints, weights or bones, not 'skeleton'"
noh render "$pack" -o "$work/out.png" --debug bones
expect 1 'bones of a pack without a skeleton'
noh render "$pack" -o "$work/out.png" --camera sideways
expect 2 'an unknown camera'
for value in smile smile= =1 smile=much smile=nan; do
    noh render "$pack" -o "$work/out.png" --weight "$value"
    expect 2 "--weight $value"
done
check 'no picture was written by any of these' test ! -e "$work/out.png"
finish
