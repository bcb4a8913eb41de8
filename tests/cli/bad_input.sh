#!/bin/sh
# Missing, truncated, damaged files and files of another kind: exit code 1, a one-line message with the error and its
# place, and no output file, not even a partial one. A file that changes nothing is warned of.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh
bytes=$(wc -c <"$pack")

# Overwrite one byte of a copy: flip OFFSET OCTAL
flip() {
    cp "$pack" "$work/bad.noh"
    printf "\\$2" | dd of="$work/bad.noh" bs=1 seek="$1" conv=notrunc 2>/dev/null
}

for verb in info budget verify; do
    noh $verb "$work/missing.noh"
    expect 1 "$verb of a missing file"
    says "noh: $work/missing.noh: "
done
noh info "$work"
expect 1 'a folder as a pack'
: >"$work/empty.noh"
noh info "$work/empty.noh"
expect 1 'an empty file'
says 'the file is empty'
echo 'This is not a pack, but a line of text that is long enough to hold a header, and more.' >"$work/text.noh"
noh info "$work/text.noh"
expect 1 'a text file as a pack'
says 'not a .noh pack'
cp "$work/text.noh" "$work/text.txt"
noh info "$work/text.txt"
expect 1 'a text file of another ending'
says 'this is neither a pack nor a model'
cp "$work/text.noh" "$work/text.glb"
noh info "$work/text.glb"
expect 1 'a text file as a model'
says "noh: $work/text.glb: "

for cut in 1 63 64 65 1000 $((bytes / 2)) $((bytes - 1)); do
    head -c "$cut" "$pack" >"$work/cut.noh"
    noh info "$work/cut.noh"
    expect 1 "a pack cut to $cut bytes"
    says "noh: $work/cut.noh: "
    says '(byte '
done
flip 0 130
noh info "$work/bad.noh"
expect 1 'a wrong magic'
says 'NOHP'
flip 4 143
noh info "$work/bad.noh"
expect 1 'another version'
says 'another format version'
flip $((bytes / 2)) 125
cmp -s "$pack" "$work/bad.noh" && flip $((bytes / 2)) 126
for verb in info budget verify; do
    noh $verb "$work/bad.noh"
    expect 1 "$verb of a pack with one byte changed"
    says 'checksum differs'
done

# ---- outputs ----

none_left() {
    check "and leaves no file, whole or half" sh -c 'test -z "$(ls -A "$1")"' - "$work/folder"
}
mkdir "$work/folder"
noh build "$build/mask.glb" -o "$work/nowhere/out.noh" --quiet
expect 1 'build into a folder that is not there'
says "noh: $work/nowhere/out.noh: "
check 'the folder was not made' test ! -e "$work/nowhere"
noh build "$work/missing.glb" -o "$work/folder/out.noh" --quiet
expect 1 'build of a missing file'
says "noh: $work/missing.glb: the file does not exist"
check 'with its path once' sh -c 'test "$(grep -o missing.glb "$1/err" | wc -l)" = 1' - "$work"
none_left
for ending in glb fbx obj bvh csv; do
    : >"$work/empty.$ending"
    noh build "$work/empty.$ending" -o "$work/folder/out.noh" --quiet
    expect 1 "build of an empty .$ending"
    says 'this is an empty file'
done
none_left
head -c 5000 "$build/mask.glb" >"$work/cut.glb"
noh build "$work/cut.glb" -o "$work/folder/out.noh" --quiet
expect 1 'build of a cut .glb'
says "noh: $work/cut.glb: "
none_left
noh build "$pack" -o "$work/folder/out.noh" --quiet
expect 1 'build of a pack'
none_left
echo '{"asset":{"version":"2.0"}}' >"$work/nothing.gltf"
noh build "$work/nothing.gltf" -o "$work/folder/out.noh" --quiet
expect 1 'build of a glTF without meshes'
none_left
echo '{"asset":{"version":"2.0"},"extensionsRequired":["KHR_texture_basisu"]}' >"$work/basisu.gltf"
noh build "$work/basisu.gltf" -o "$work/folder/out.noh" --quiet
expect 1 'build of a file that needs Draco'
says 'KHR_texture_basisu'
none_left
noh render "$work/bad.noh" -o "$work/folder/out.png"
expect 1 'render of a broken pack'
none_left
noh render "$pack" -o "$work/nowhere/out.png" --size 16x16
expect 1 'render into a folder that is not there'
says "noh: $work/nowhere/out.png: "
noh dump "$pack" -o "$work/nowhere/out.obj"
expect 1 'dump into a folder that is not there'

# A failed build leaves the older pack unchanged.
echo old >"$work/folder/out.noh"
noh build "$work/cut.glb" -o "$work/folder/out.noh" --quiet
expect 1 'a failed build over an older file'
check 'the older file is untouched' sh -c 'test "$(cat "$1/out.noh")" = old && test "$(ls -A "$1")" = out.noh' - "$work/folder"

# ---- files of options ----

sh tests/support/small_glb.sh >"$work/small.glb"
mkdir "$work/odd" "$work/odd/folder"
: >"$work/odd/empty"
printf 'a\0b\n' >"$work/odd/binary"
printf '\377\376a\0' >"$work/odd/utf16"
printf '\357\273\277nobody nothing\r\n' >"$work/odd/bom"
# Of no use, as a rule: that is an error or a warning, and never silence.
for option in --rename --retarget --events --names --springs --graph --recipe; do
    for odd in missing folder empty binary utf16 bom; do
        noh build "$work/small.glb" -o "$work/odd.noh" $option "$work/odd/$odd"
        check "$option: $odd" sh -c 'grep -q -e "^noh: .*odd/$2" -e "^warning: $3 .*/$2 changes nothing" "$1/out" "$1/err"' \
            - "$work" $odd "$option"
    done
done

# ---- names ----

for verb in render dump; do
    noh $verb "$pack" -o "$work/folder/x" --weight simle=1
    expect 1 "$verb with a misspelt target"
    says "did you mean 'smile'?"
done
noh render "$pack" -o "$work/folder/x.png" --weight 'zzzzzzzzzzzzzzzzzzzz=1'
expect 1 'a name that is near nothing'
check 'suggests nothing' sh -c '! grep -q "did you mean" "$1"' - "$work/err"
noh render "$pack" -o "$work/folder/x.png" --clip no_such_clip_at_all
expect 1 'an unknown clip'
says 'no clip named'
finish
