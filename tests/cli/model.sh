#!/bin/sh
# Verbs that read packs take models, which are built once and kept by their contents; files of other kinds are named.
. "$(dirname "$0")/lib.sh"

mask=$build/mask.glb
noh build "$mask" -o "$work/mask.noh" --quiet
expect 0 'build'

packs() {
    set -- "$work"/cache/*.noh
    [ -e "$1" ] && echo $# || echo 0
}
# kept COUNT NAME: the cache holds this number of packs
kept() {
    check "$2" test "$(packs)" = "$1"
}
warned() {
    check 'and warns' grep -q "^noh: .*: warning: " "$work/err"
}
silent() {
    check 'and says nothing on stderr' test ! -s "$work/err"
}

# ---- every verb ----

noh info "$mask"
expect 0 'info of a model'
warned
cp "$work/out" "$work/first"
kept 1 'its pack is kept'
noh info "$mask"
expect 0 'the same again'
silent
check 'prints the same' cmp "$work/out" "$work/first"
noh info "$work/mask.noh"
tail -n +2 "$work/out" >"$work/of_pack"
check 'and what is printed of the pack' sh -c 'tail -n +2 "$1" | cmp - "$2"' - "$work/first" "$work/of_pack"
for verb in budget verify clip face; do
    noh $verb "$mask"
    expect 0 "$verb of a model"
    silent
done
noh pack "$mask" -o "$work/a.nohz" --quiet
expect 0 'pack of a model'
noh pack "$work/mask.noh" -o "$work/b.nohz" --quiet
check 'gives the wire form of its pack' cmp "$work/a.nohz" "$work/b.nohz"
for verb in 'render --size 64x64' 'sheet --tile 32 --target smile' dump; do
    noh ${verb%% *} "$mask" -o "$work/a" $(echo "$verb " | cut -d' ' -f2-)
    expect 0 "${verb%% *} of a model"
    noh ${verb%% *} "$work/mask.noh" -o "$work/b" $(echo "$verb " | cut -d' ' -f2-)
    check 'gives the same file as of its pack' cmp "$work/a" "$work/b"
done
kept 1 'all of them with one build'
rm -r "$work/cache"
noh render "$mask" -o "$work/a" --size 64x64
expect 0 'render of a model alone'
check 'draws the same picture' sh -c '"$1" render "$2" -o "$3/b" --size 64x64 >"$3/out" && cmp "$3/a" "$3/b"' - "$build/noh" "$work/mask.noh" "$work"
noh info "$mask"
kept 2 'a pack for a picture is not one to ship'

# ---- by contents ----

# A triangle in a .gltf with a .bin: model BYTE puts this byte, in octal, into the x of its third vertex. What is written
# while a build begins is not kept: sleep.
model() {
    mkdir -p "$work/m"
    { head -c 12 /dev/zero; printf '\000\000\200\077'; head -c 8 /dev/zero
      printf "\\000\\000\\$1\\077\\000\\000\\200\\077\\000\\000\\000\\000"; } >"$work/m/a b.bin"
    sleep 0.1
}
cat >"$work/m.gltf" <<'END'
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"buffers":[{"uri":"a%20b.bin","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"images":[{"uri":"skin.png"}],"textures":[{"source":0}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}]}
END
rm -rf "$work/cache"
model 200
mv "$work/m.gltf" "$work/m/m.gltf"
noh dump "$work/m/m.gltf" -o "$work/one.obj"
expect 0 'a model of two files, without its texture'
warned
kept 1 'is kept'
noh dump "$work/m/m.gltf" -o "$work/two.obj"
expect 0 'again'
silent
check 'gives the same' cmp "$work/one.obj" "$work/two.obj"
model 0
noh dump "$work/m/m.gltf" -o "$work/two.obj"
expect 0 'once its .bin has changed'
warned
kept 2 'it is built again'
check 'from the new bytes' sh -c '! cmp -s "$1" "$2"' - "$work/one.obj" "$work/two.obj"
model 200
touch "$work/m/m.gltf"
noh dump "$work/m/m.gltf" -o "$work/two.obj"
expect 0 'with its old bytes'
silent
kept 2 'nothing is built'
check 'and it is what it was' cmp "$work/one.obj" "$work/two.obj"
noh render "$work/mask.noh" -o "$work/m/skin.png" --size 8x8
sleep 0.1
noh info "$work/m/m.gltf"
expect 0 'once its texture is there'
kept 3 'it is built again'
check 'with the texture' grep -q '1 texture' "$work/out"
mv "$work/m" "$work/moved"
noh info "$work/moved/m.gltf"
expect 0 'in another folder'
kept 3 'nothing is built'
mv "$work/moved/m.gltf" "$work/moved/n.gltf"
noh info "$work/moved/n.gltf"
kept 4 'under another name it is another model'

# ---- the folder ----

for pack in "$work"/cache/*.noh; do printf x >"$pack"; done
noh info "$work/moved/n.gltf"
expect 0 'with damaged packs in the cache'
kept 4 'they are built again'
NOH_CACHE_MB=1 noh info "$mask"
expect 0 'a pack larger than the limit'
kept 1 'is all that stays'
touch "$work/cache/other.txt"
NOH_CACHE_MB=1 noh info "$work/moved/n.gltf"
kept 1 'the oldest goes first'
check 'and no other file of the folder' test -e "$work/cache/other.txt"
rm -r "$work/cache"
NOH_CACHE_MB=0 noh info "$work/moved/n.gltf"
expect 0 'without a cache'
check 'no folder is made' test ! -e "$work/cache"
if [ -n "$json" ]; then
    rm "$work/moved/skin.png"
    NOH_CACHE_MB=0 noh info "$work/moved/n.gltf" --json
    warned
    check 'stdout is JSON alone' $json 'j.meshes.length === 1' <"$work/out"
fi
NOH_CACHE=$mask/nowhere noh info "$work/moved/n.gltf"
expect 0 'a cache that cannot be written'
says 'warning: the built pack cannot be kept'
env -u NOH_CACHE XDG_CACHE_HOME="$work/xdg" "$build/noh" info "$work/moved/n.gltf" >"$work/out" 2>"$work/err"
check 'XDG_CACHE_HOME' sh -c 'ls "$1"/xdg/noh/*.noh' - "$work"
env -u NOH_CACHE -u XDG_CACHE_HOME HOME="$work/home" "$build/noh" info "$work/moved/n.gltf" >"$work/out" 2>"$work/err"
check 'HOME' sh -c 'ls "$1"/home/.cache/noh/*.noh' - "$work"

# ---- files of other kinds ----

# wrong NAME WORDS: a file of that name is refused with these words, by a verb that reads packs and by noh build
wrong() {
    noh info "$work/$1"
    expect 1 "info of $1"
    says "$2"
    noh build "$work/$1" -o "$work/out.noh"
    expect 1 "build of $1"
    says "$2"
}
printf 'BLENDER-v300' >"$work/head.blend"
wrong head.blend 'this is a Blender file'
says 'export glTF 2.0 in Blender'
printf 'BLENDER-v300' >"$work/head.glb"
wrong head.glb 'this is a Blender file'
cp "$work/a" "$work/x.dae"
wrong x.dae 'this is a COLLADA file'
noh render "$work/mask.noh" -o "$work/face.png" --size 8x8
wrong face.png 'this is a PNG picture'
echo 'graph walk' >"$work/hero.graph"
wrong hero.graph 'noh build MODEL --graph FILE'
noh build "$work/a.nohz" -o "$work/out.noh"
expect 1 'build of a wire form'
says 'this is the wire form of a pack'
says 'noh info, noh render and noh view take it'
noh render "$work/msak.noh" -o "$work/out.png"
expect 1 'a misspelt file'
says 'did you mean mask.noh?'
noh render "$work/moved" -o "$work/out.png"
expect 1 'a folder'
says 'name a file in it, such as n.gltf'
noh render "$work/cut.glb" -o "$work/out.png"
expect 1 'a missing model'
says 'No such file'
head -c 5000 "$mask" >"$work/cut.glb"
noh render "$work/cut.glb" -o "$work/out.png"
expect 1 'a model that cannot be built'
says "noh: $work/cut.glb: "
check 'no file was written by any of these' sh -c 'test ! -e "$1/out.png" && test ! -e "$1/out.noh"' - "$work"
finish
