#!/bin/sh
# noh render without options: the picture's name and size, how a figure stands, what the camera frames; refused input.
. "$(dirname "$0")/lib.sh"

small='--size 64x64'
cd "$work" || exit 1
noh render "$build/mask.noh"
expect 0 'render of a file alone'
check 'and says its size' grep -q 'mask.png: 1024x1024' "$work/out"
check 'a picture in the working folder' test -s mask.png

for frame in face upper full body face,30,10 upper,-20,5 full,180,0 30,10 30,10,3; do
    # shellcheck disable=SC2086
    noh render "$build/demo/puppet.noh" -o "$frame.png" $small --camera $frame
    expect 0 "--camera $frame"
done
check 'body is the whole figure' cmp full.png body.png
check 'a face from the side' sh -c '! cmp -s face.png face,30,10.png'
for frame in faces face, face,30 face,30,10,2 face,30,x upper,0,90; do
    # shellcheck disable=SC2086
    noh render "$build/demo/puppet.noh" -o x.png $small --camera $frame
    expect 2 "--camera $frame"
done

# shellcheck disable=SC2086
{
    noh render "$build/demo/puppet.noh" -o auto.png $small
    noh render "$build/demo/puppet.noh" -o idle.png $small --clip idle
    noh render "$build/demo/puppet.noh" -o rest.png $small --pose rest
    check 'it stands as in its clip idle' cmp auto.png idle.png
    check 'unless it is to stand as modelled' sh -c '! cmp -s auto.png rest.png'
    noh render "$build/demo/puppet.noh" -o x.png $small --pose sit
    expect 2 'no other pose'
}
finish
