#!/bin/sh
# --light, --rotate, --tonemap, --shadow, --background of noh render and noh sheet: pictures, files, refused input.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh
for name in white studio room sky; do
    noh render "$pack" -o "$work/$name.png" --light $name --size 128x128
    expect 0 "render --light $name"
done
check 'environments differ' sh -c '! cmp -s "$1" "$2" && ! cmp -s "$1" "$3"' - "$work/studio.png" "$work/room.png" "$work/sky.png"
noh render "$pack" -o "$work/again.png" --light room --size 128x128
check 'the same picture again' cmp "$work/room.png" "$work/again.png"
for more in '--rotate 90' '--tonemap none' '--tonemap filmic' '--shadow off' '--shadow blob' '--background gradient' '--background plain' '--debug light'; do
    noh render "$pack" -o "$work/more.png" --light room --size 128x128 $more
    expect 0 "render --light room $more"
    check "$more changes the picture" sh -c '! cmp -s "$1" "$2"' - "$work/room.png" "$work/more.png"
done
for light in room none; do
    noh render "$pack" -o "$work/full.png" --light $light --size 128x128
    noh render "$pack" -o "$work/phone.png" --light $light --size 128x128 --tier phone
    expect 0 "render --tier phone, $light"
    check "nearly the same picture, $light" "$build/tests/gl/picture_diff" "$work/full.png" "$work/phone.png" 1.5 0.05
    check "of another program, $light" sh -c '! cmp -s "$1" "$2"' - "$work/full.png" "$work/phone.png"
done
noh render "$pack" -o "$work/phone.png" --tier low
expect 2 'an unknown tier'
noh render "$pack" -o "$work/more.png" --debug occlusion --size 64x64
expect 0 'occlusion without a light'
noh sheet "$pack" -o "$work/sheet.png" --light studio --target smile --tile 64
expect 0 'sheet --light'

# A Radiance picture of 2 x 1 texels, without run lengths: 1 1 1 in front, 0.5 0 0 behind.
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\200\200\200\201\200\000\000\200' >"$work/two.hdr"
noh render "$pack" -o "$work/hdr.png" --light "$work/two.hdr" --size 64x64
expect 0 'a Radiance panorama'
noh render "$pack" -o "$work/panorama.png" --light "$work/room.png" --size 64x64
expect 0 'a PNG as a panorama'
head -c 40 "$work/two.hdr" >"$work/cut.hdr"
noh render "$pack" -o "$work/cut.png" --light "$work/cut.hdr"
expect 1 'a cut Radiance picture'
says 'damaged'
check 'no picture of it' test ! -e "$work/cut.png"
echo text >"$work/text.hdr"
noh render "$pack" -o "$work/cut.png" --light "$work/text.hdr"
expect 1 'no picture at all'
says 'neither a Radiance file'
noh render "$pack" -o "$work/cut.png" --light "$work/none.hdr"
expect 1 'no such file'
noh render "$pack" -o "$work/cut.png" --light rooom
expect 2 'an unknown environment'
says "--light must be auto, none, white, studio, room, sky or a file (.hdr, .png), not 'rooom'"
noh render "$pack" -o "$work/cut.png" --light room --tonemap bright
expect 2 'an unknown tone map'
says "--tonemap must be neutral, filmic or none, not 'bright'"
noh render "$pack" -o "$work/cut.png" --light room --shadow soft
expect 2 'an unknown shadow'
noh render "$pack" -o "$work/cut.png" --light room --background red
expect 2 'an unknown background'
says "--background must be light, gradient or plain, not 'red'"

# ---- without --light ----

noh render "$pack" -o "$work/auto.png" --size 128x128
noh render "$pack" -o "$work/studio.png" --size 128x128 --light studio
check 'a picture is lit by the studio' cmp -s "$work/auto.png" "$work/studio.png"
noh render "$pack" -o "$work/plain.png" --size 128x128 --light none
check 'unless an option turns it off' sh -c '! cmp -s "$1" "$2"' - "$work/auto.png" "$work/plain.png"
noh render "$pack" -o "$work/auto.png" --size 128x128 --debug normal
noh render "$pack" -o "$work/plain.png" --size 128x128 --debug normal --light none
check 'values as colours are not' cmp -s "$work/auto.png" "$work/plain.png"

noh render "$pack" -o "$work/off.png" --light room --size 128x128 --shadow off
noh render "$pack" -o "$work/blob.png" --light room --size 128x128 --shadow blob
expect 0 'render --shadow blob'
check 'spots are drawn' sh -c '! cmp -s "$1" "$2"' - "$work/off.png" "$work/blob.png"

noh bench "$pack" --only look --quick --json
expect 0 'a bench of looks'
for row in environment environment-shadow environment-tonemap environment-blob environment-teeth environment-backdrop all; do
    check "with a row for $row" grep -q "\"look/$row\"" "$work/out"
done
check 'none for maps that the pack lacks' sh -c '! grep -q look/surface-map "$1"' - "$work/out"
check 'and none for a transfer that it lacks' sh -c '! grep -q look/transfer "$1"' - "$work/out"
finish
