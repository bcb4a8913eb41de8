#!/bin/sh
# demo_face.sh BUILD: the puppet says a sentence and walks, and the mask says it with joy: the sound, a strip of each,
# and a film as numbered pictures, with the sound in one file where ffmpeg is.
set -eu
build=$1
out=$build/demo
noh=$build/noh
text=${NOH_TEXT:-'Bob and Mabel pump up five balloons before supper.'}

"$noh" build "$out/puppet.glb" -o "$out/puppet_says_pack.noh" --graph tools/demo_assets/puppet/puppet.graph --springs tools/demo_assets/puppet/puppet.springs --plain --wrinkles auto \
    --lips --quiet
"$noh" build "$build/mask.glb" -o "$out/mask_says_pack.noh" --plain --wrinkles auto --lips --quiet
if ! "$noh" speak "$text" --face "$out/puppet_says_pack.noh" -o "$out/says.noh" --wav "$out/says.wav"; then
    echo 'demo-face: nothing is said without eSpeak NG (Debian: apt install libespeak-ng1 espeak-ng-data)'
    exit 0
fi
"$noh" speak "$text" --face "$out/mask_says_pack.noh" -o "$out/mask_says.noh"
"$noh" sheet "$out/puppet_says_pack.noh" -o "$out/puppet_says.png" --anim "$out/puppet_says_pack.noh" --anim "$out/says.noh" \
    --clip speech --clip walk --face on --tiles 16 --columns 8 --tile 240
"$noh" sheet "$out/mask_says_pack.noh" -o "$out/mask_says.png" --anim "$out/mask_says.noh" --clip speech \
    --face on --feel joy=0.8 --tiles 16 --columns 8 --tile 240

# 25 pictures a second of as long as the sound lasts: 16 bits, one channel, 22,050 samples a second
seconds=$(($(wc -c <"$out/says.wav") / 44100 + 1))
rm -rf "$out/film"
mkdir -p "$out/film"
frame=0
while [ $frame -lt $((seconds * 25)) ]; do
    time=$(awk "BEGIN { printf \"%.3f\", $frame / 25 }")
    "$noh" render "$out/puppet_says_pack.noh" -o "$(printf '%s/film/%04d.png' "$out" $frame)" --size 384x384 --camera face \
        --anim "$out/puppet_says_pack.noh" --anim "$out/says.noh" --clip idle --clip speech --face on --time "$time" >/dev/null
    frame=$((frame + 1))
done
if command -v ffmpeg >/dev/null; then
    ffmpeg -loglevel error -y -framerate 25 -i "$out/film/%04d.png" -i "$out/says.wav" -pix_fmt yuv420p -shortest \
        "$out/says.mp4"
fi
echo
echo 'Made:'
ls "$out"/says.* "$out"/*_says.png | sed 's/^/  /'
echo "  $out/film: $frame pictures, 25 a second"
