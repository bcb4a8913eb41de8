#!/bin/sh
# demo_body.sh BUILD: convert the puppet, make it move, push it, and print what it costs; the same arm bent and twisted by each
# kind of skinning; and, where $NOH_ASSETS has it, hero/body.glb.
set -eu
build=$1
out=$build/demo
noh=$build/noh

echo
"$noh" build "$out/puppet.glb" -o "$out/puppet.noh" --graph tools/demo_assets/puppet/puppet.graph --springs tools/demo_assets/puppet/puppet.springs --plain --wrinkles auto
echo
"$noh" render "$out/puppet.noh" -o "$out/puppet.png" --size 640x720 --clip dance --time 14.73 --camera 15,4
for clip in walk bow look_round dance; do
    "$noh" sheet "$out/puppet.noh" -o "$out/puppet_$clip.png" --clip $clip --camera 25,4 --tiles 8 --columns 8 --tile 240
done
"$noh" sheet "$out/puppet.noh" -o "$out/puppet_bones.png" --clip dance --bones --camera 25,4 --tiles 8 --columns 8 --tile 240
"$noh" budget "$out/puppet.noh"

# A push: it falls, and gets up by the clip for how it lies.
"$noh" sheet "$out/puppet_falls.noh" -o "$out/puppet_falls.png" --clip walk --push 0,0,-150 --camera 50,12 --tiles 16 \
    --columns 8 --tile 200
"$noh" sheet "$out/puppet_falls.noh" -o "$out/puppet_stumbles.png" --clip walk --push 20,0,60 --camera 50,12 --tiles 16 \
    --columns 8 --tile 200
"$noh" lab drop "$out/puppet_falls.noh" -o "$out/puppet_drop.png"

echo
"$noh" build "$out/arm.glb" -o "$out/arm.noh" --dual-quaternion twisted_dual --two-stream stream_a=stream_b --quiet
"$noh" info "$out/arm.noh"
"$noh" sheet "$out/arm.noh" -o "$out/arm_bend.png" --clip bend --camera -25,12 --tiles 8 --columns 4 --tile 400
"$noh" sheet "$out/arm.noh" -o "$out/arm_twist.png" --clip twist --camera 0,4 --tiles 8 --columns 4 --tile 400
"$noh" sheet "$out/arm.noh" -o "$out/arm_streams.png" --target stream_b=0.25 --target stream_b=0.5 --target stream_b=0.75 \
    --target stream_b --camera face --columns 5 --tile 320

body=${NOH_ASSETS:-}/hero/body.glb
if [ -f "$body" ]; then
    echo
    "$noh" build "$body" -o "$out/body.noh" --plain --wrinkles face --quiet
    for clip in walk run dance; do
        "$noh" sheet "$out/body.noh" -o "$out/body_$clip.png" --clip $clip --camera 25,4 --tiles 8 --columns 8 --tile 240
    done
    for clip in walk run dance; do
        "$noh" sheet "$out/body.noh" -o "$out/bones_$clip.png" --clip $clip --bones --camera 50,8 --tiles 8 --columns 8 --tile 200
    done
    "$noh" sheet "$out/body.noh" -o "$out/bones_blend.png" --clip walk --blend run --bones --camera 60,8 --tiles 8 --tile 160
    "$noh" sheet "$out/body.noh" -o "$out/bones_inertia.png" --clip walk --to punch --transition inertia --over 0.4 --bones \
        --camera 60,8 --tiles 12 --columns 6 --tile 200
    "$noh" sheet "$out/body.noh" -o "$out/body_speaks.png" --clip face_speak --clip dance --camera face --tiles 8 --columns 8 --tile 240
    "$noh" render "$out/body.noh" -o "$out/body_smile.png" --size 640x720 --clip dance --time 7.64 --weight mouth-corner-puller=1 \
        --weight mouth-part-later=0.5 --camera 15,4
fi
echo
echo 'Pictures:'
ls "$out"/*.png | sed 's/^/  /'
