#!/bin/sh
# noh render without options: the picture's name and size, how a figure stands, what the camera frames, also in a sheet;
# refused input.
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
    expect 0 'a figure as modelled'
    check 'it stands as in its clip idle' cmp auto.png idle.png
    check 'unless it is to stand as modelled' sh -c '! cmp -s auto.png rest.png'
    noh render "$build/demo/puppet.noh" -o x.png $small --pose sit
    expect 2 'no other pose'
    noh speak Hello -o line.noh --face "$build/demo/puppet.noh"
    noh render "$build/demo/puppet.noh" -o told.png $small --anim line.noh --clip speech
    expect 0 'a body in a clip of the face alone'
    noh render "$build/demo/puppet.noh" -o as_made.png $small --anim line.noh --clip speech --pose rest
    check 'it stands' sh -c '! cmp -s told.png as_made.png'
}

# as many nodes as a stage holds share a mesh: planning compares them in pairs, once
nodes() {
    awk -v n="$1" -v targets="${2:-0}" 'BEGIN {
        printf "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;base64,"
        printf "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        printf "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
        printf "\"max\":[1,1,0]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}"
        for (i = 0; i < targets; i++) printf "%s{\"POSITION\":0}", i ? "," : ",\"targets\":["
        printf "%s}]}],\"nodes\":[", targets ? "]" : ""
        for (i = 0; i < n; i++) printf "%s{\"mesh\":0,\"translation\":[%d,%d,0]}", i ? "," : "", i % 32, i / 32
        print "]}"
    }'
}
nodes 512 >many.gltf
nodes 513 >too_many.gltf
# shellcheck disable=SC2086
noh render many.gltf -o many.png $small
expect 0 '512 nodes with one mesh'
# shellcheck disable=SC2086
noh render too_many.gltf -o x.png $small
expect 1 '513 are too many'
says 'join them'
noh build many.gltf -o many.noh --warnings
expect 0 'a build of 512'
check 'which does not warn of a stage' sh -c '! grep -q stage "$1"' - "$work/err"
noh build too_many.gltf -o too_many.noh --warnings
expect 0 'a build of 513'
check 'which warns that no stage draws them' \
    grep -q "^warning: the pack's 513 drawn meshes take 17 kinds.*at most 16: join meshes" "$work/err"
nodes 5 820 >weights.gltf
noh build weights.gltf -o weights.noh --warnings
expect 0 'a build of 4100 morph targets'
check 'which warns that no stage plays clips with them' \
    grep -q '^warning: morph targets.*take 4100 floats.*at most 4096: .*remove targets' "$work/err"

# a sheet frames what moves, as a picture of the clip does
tiles='--tiles 2 --tile 64'
puppet=$build/demo/puppet.noh
noh speak hello --face "$puppet" -o line.noh
# shellcheck disable=SC2086
{
    noh sheet "$puppet" -o walk.png --clip walk $tiles
    noh sheet "$puppet" -o walk_full.png --clip walk $tiles --camera full,15,6
    check 'a sheet of a clip shows the body that it moves' cmp walk.png walk_full.png
    noh sheet "$puppet" -o smile.png --target smile --tile 64
    noh sheet "$puppet" -o smile_face.png --target smile --tile 64 --camera face
    check 'a sheet of targets shows the face' cmp smile.png smile_face.png
    LC_ALL=C sed 's/arm\.\([LR]\)/axm.\1/g; s/hand\./hxnd./g' "$build/demo/puppet.glb" >nobody.glb
    for figure in "$puppet" nobody.glb; do
        noh sheet "$figure" -o "$(basename "${figure%.*}")_full.png" --target smile --tile 64 --camera full
    done
    check 'in which arms of known names are down' sh -c '! cmp -s puppet_full.png nobody_full.png'
    for verb in 'sheet --tiles 2 --tile 64' 'render --size 64x64'; do
        noh ${verb%% *} "$puppet" -o said.png --anim line.noh --clip speech ${verb#* }
        noh ${verb%% *} "$puppet" -o said_face.png --anim line.noh --clip speech ${verb#* } --camera face,15,6
        check "${verb%% *} of a clip that moves no joints shows the face" cmp said.png said_face.png
    done
}

# A figure without targets has its head where the joint of that name is.
LC_ALL=C sed 's/"targets"/"tergets"/g' "$build/demo/puppet.glb" >still.glb
noh build still.glb -o still.noh --effort 1 --quiet
expect 0 'a figure without targets'
for frame in face full; do
    # shellcheck disable=SC2086
    noh render still.noh -o still_$frame.png $small --camera $frame
    expect 0 "has a picture: $frame"
done
noh info still.noh
expect 0 'and can be described'
check 'it has none' sh -c '! grep -q "targets, " "$1"' - "$work/out"
check 'and its head is framed' sh -c '! cmp -s "$1" "$2"' - still_face.png still_full.png


# A picture of a feeling shows it, without a time by which it has come.
# shellcheck disable=SC2086
{
    noh render "$build/mask.noh" -o calm.png $small --face on --time 0.01
    noh render "$build/mask.noh" -o joy.png $small --face on --feel joy=1
    expect 0 'a face that feels'
    check 'shows it' sh -c '! cmp -s "$1" "$2"' - calm.png joy.png
}

# A body whose face is a square of 0.2 at a height of 1.5, with hair as high as 0.8 of it: of a drawn figure.
quads='f 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12\n'
rest='v -.2 0 0\nv .2 0 0\nv .2 1.5 0\nv -.2 1.5 0\nv -.1 1.7 0\nv .1 1.7 0\nv .1 1.86 0\nv -.1 1.86 0\n'
mkdir shapes
printf "v -.1 1.5 0\nv .1 1.5 0\nv .1 1.7 0\nv -.1 1.7 0\n$rest$quads" >tall.obj
printf "v -.1 1.5 .01\nv .1 1.5 .01\nv .1 1.7 .01\nv -.1 1.7 .01\n$rest$quads" >shapes/smile.obj
noh build tall.obj --targets shapes -o tall.noh
noh render tall.noh -o tall.png --size 64x64 --camera face,0,0 --json
expect 0 'a face below high hair'
height=$(sed -n '/"eye"/{n;n;s/[ ,]//g;p;}' "$work/out") # of the middle between 1.476 and 1.86
check 'its frame has all of the hair' awk "BEGIN { exit !($height > 1.667 && $height < 1.669) }"
printf "v -.1 1.5 0\nv .1 1.5 0\nv .1 1.7 0\nv -.1 1.7 0\n${rest}v -.1 1.7 -.15\nv .1 1.7 -.15\nv .1 1.86 -.15\nv -.1 1.86 -.15\n${quads}f 13 14 15 16\n" >deep.obj
printf "v -.1 1.5 .01\nv .1 1.5 .01\nv .1 1.7 .01\nv -.1 1.7 .01\n${rest}v -.1 1.7 -.15\nv .1 1.7 -.15\nv .1 1.86 -.15\nv -.1 1.86 -.15\n${quads}f 13 14 15 16\n" >shapes/smile.obj
noh build deep.obj --targets shapes -o deep.noh
noh render deep.noh -o deep.png --size 64x64 --camera face,90,0 --json
expect 0 'a face in front of deep hair, from the side'
depth=$(sed -n '/"eye"/{n;n;n;s/[ ,]//g;p;}' "$work/out") # of the middle between -0.15 and 0.01 or 0
check 'its frame has all of the hair, too' awk "BEGIN { exit !($depth > -0.076 && $depth < -0.069) }"
sed 's/ -\.15$/ -.4/; s/1\.86/2/' deep.obj >tail.obj
sed 's/ -\.15$/ -.4/; s/1\.86/2/' shapes/smile.obj >smile.obj
mv smile.obj shapes/
noh build tail.obj --targets shapes -o tail.noh
noh render tail.noh -o tail.png --size 64x64 --camera face,90,0 --json
expect 0 'a face in front of a tail of hair, from the side'
depth=$(sed -n '/"eye"/{n;n;n;s/[ ,]//g;p;}' "$work/out") # of the middle between -0.4 and 0.01 or 0
height=$(sed -n '/"eye"/{n;n;s/[ ,]//g;p;}' "$work/out") # of the middle between 1.476 and 2
check 'its frame has all of the tail' awk "BEGIN { exit !($depth > -0.201 && $depth < -0.194) }"
check 'and of the hat' awk "BEGIN { exit !($height > 1.737 && $height < 1.739) }"
if command -v node >/dev/null 2>&1; then
    # shellcheck disable=SC2016
    check 'and so has the page' node -e '
        const text = require("fs").readFileSync(process.argv[1], "utf8"), all = [-0.2, 0, 0, 0.2, 1.86, 0.01];
        import(`data:text/javascript,${encodeURIComponent(text)}`).then(({ framed }) =>
            process.exit(framed(all, [-0.1, 1.5, 0, 0.1, 1.7, 0.01], "face")[4] === 1.86 ? 0 : 1));' \
        "$OLDPWD/platform/web/package/camera.js"
else
    skip 'and so has the page' 'no node here'
fi
finish
