#!/bin/sh
# Targets of -o: regular files, long names, symbolic links, FIFOs, devices, standard output; inputs are never
# overwritten; a full standard output is an error.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh
folder=$work/folder
mkdir "$folder"

only() { # NAMES... : the folder holds these and nothing temporary
    check "and leaves nothing else" test "$(ls -A "$folder" | tr '\n' ' ')" = "$(printf '%s\n' "$@" | sort | tr '\n' ' ')"
}
is_obj() {
    check "$1" sh -c 'head -n 1 "$1" | grep -q "^# baked by noh" && grep -q "^f " "$1"' - "$2"
}

noh dump "$pack" -o "$work/plain.obj"
expect 0 'dump to a file'

# ---- long names ----

name=$(printf '%0241d' 0)
for length in 245 251 255; do
    long=$(printf "%0$((length - 4))d.obj" 0)
    noh dump "$pack" -o "$folder/$long"
    expect 0 "a name of $length characters"
    check 'is the whole file' cmp "$folder/$long" "$work/plain.obj"
    only "$long"
    rm -f "$folder/$long"
done
noh dump "$pack" -o "$folder/${name}0123456789.obj_"
expect 1 'a name of 256 characters'
says 'cannot write'
check 'leaves nothing' test -z "$(ls -A "$folder")"

noh dump "$pack" -o ''
expect 1 'an empty name'
says 'No such file or directory'
noh dump "$pack" -o "$folder/"
expect 1 'a folder'
says 'it is a folder: give the name of a file'
noh dump "$pack" -o "$folder/none/x.obj"
expect 1 'a folder that is not there'
says 'cannot write: its folder does not exist: make the folder first'

# ---- an older file ----

echo old >"$folder/out.obj"
chmod 640 "$folder/out.obj"
noh dump "$pack" -o "$folder/out.obj"
expect 0 'over an older file'
check 'replaces it' cmp "$folder/out.obj" "$work/plain.obj"
check 'and keeps its permissions' test "$(stat -c %a "$folder/out.obj")" = 640
only out.obj

# ---- symbolic links ----

mkdir "$work/elsewhere"
mv "$folder/out.obj" "$work/elsewhere/real.obj"
echo old >"$work/elsewhere/real.obj"
ln -s ../elsewhere/real.obj "$folder/out.obj"
ln -s out.obj "$folder/second.obj"
noh dump "$pack" -o "$folder/second.obj"
expect 0 'through two symbolic links'
check 'the links stay' test -L "$folder/second.obj" -a -L "$folder/out.obj"
check 'their target is written' cmp "$work/elsewhere/real.obj" "$work/plain.obj"
check 'and no other file is left' test "$(ls -A "$work/elsewhere")" = real.obj
rm "$work/elsewhere/real.obj"
noh dump "$pack" -o "$folder/out.obj"
expect 0 'through a link to a file that is not there yet'
check 'makes it' cmp "$work/elsewhere/real.obj" "$work/plain.obj"
check 'and the link stays' test -L "$folder/out.obj"
ln -s loop "$folder/loop"
noh dump "$pack" -o "$folder/loop"
expect 1 'through a link to itself'
check 'it stays' test -L "$folder/loop"
rm "$folder/loop" "$folder/out.obj" "$folder/second.obj"

# ---- FIFOs, devices ----

mkfifo "$folder/pipe"
cat "$folder/pipe" >"$work/piped.obj" &
reader=$!
noh dump "$pack" -o "$folder/pipe"
expect 0 'into a FIFO'
wait $reader
check 'the reader gets the file' cmp "$work/piped.obj" "$work/plain.obj"
check 'the FIFO stays' test -p "$folder/pipe"
rm "$folder/pipe"

# The same devices as /dev/null and /dev/full, under names of our own.
if mknod "$folder/null" c 1 3 2>/dev/null && mknod "$folder/full" c 1 7 2>/dev/null && : >"$folder/null"; then
    noh build "$build/mask.glb" -o "$folder/null" --quiet
    expect 0 'build into a device'
    check 'it stays a device' test -c "$folder/null"
    noh build "$build/mask.glb" -o "$folder/full" --quiet
    expect 1 'build into a full device'
    says 'cannot write: No space left on device'
    check 'it stays a device' test -c "$folder/full"
    noh render "$pack" -o "$folder/full" --size 16x16
    expect 1 'render into a full device'
    check 'and does not report success' test ! -s "$work/out"
    only null full
    rm "$folder/null" "$folder/full"
else
    skip 'devices' 'mknod needs a privileged user, and a file system that has devices'
fi

# ---- standard output ----

"$build/noh" dump "$pack" -o /dev/stdout | cat >"$work/stdout.obj"
check 'dump -o /dev/stdout into a pipe' cmp "$work/stdout.obj" "$work/plain.obj"
"$build/noh" dump "$pack" -o /dev/stdout >"$work/stdout.obj"
check 'and into a file' cmp "$work/stdout.obj" "$work/plain.obj"
"$build/noh" build "$build/mask.glb" -o /dev/stdout --plain --wrinkles auto 2>"$work/err" | cat >"$work/stdout.noh"
check 'build -o /dev/stdout is the pack and nothing else' cmp "$work/stdout.noh" "$pack"
check 'and the report is on stderr' grep -q 'bytes' "$work/err"

if [ -c /dev/full ]; then
    for arguments in 'help' '--version' 'info --help' "info $pack" "info $pack --json" "budget $pack --nominal" "clip $pack --json"; do
        # shellcheck disable=SC2086
        "$build/noh" $arguments >/dev/full 2>"$work/err"
        code=$?
        expect 1 "a full standard output: noh ${arguments%% *}"
        says 'standard output: cannot write'
    done
else
    skip 'a full standard output' 'there is no /dev/full'
fi

# ---- the Makefile ----

env -u MAKEFLAGS make -s BUILD="$work/a b" DEPS=0 help >"$work/out" 2>"$work/err"
check 'make refuses a BUILD with a blank' sh -c 'test "$2" != 0 && grep -q "BUILD names one folder, without spaces" "$1"' - "$work/err" $?
check 'and makes nothing' test ! -e "$work/a" -a ! -e "$work/a b"

# ---- inputs ----

cp "$build/mask.glb" "$folder/model.glb"
cp "$pack" "$folder/face.noh"
ln -s face.noh "$folder/link.noh"
kept() {
    check 'the input is as it was' cmp "$1" "$2"
}
noh build "$folder/model.glb" -o "$folder/model.glb" --quiet
expect 2 'build over its input'
says 'would overwrite the input'
kept "$folder/model.glb" "$build/mask.glb"
noh build "$folder/model.glb" -o "$folder/../folder/model.glb" --quiet
expect 2 'by another path'
noh dump "$folder/face.noh" -o "$folder/link.noh"
expect 2 'by a symbolic link'
kept "$folder/face.noh" "$pack"
noh render "$folder/face.noh" -o "$folder/face.noh" --size 16x16
expect 2 'render over its pack'
kept "$folder/face.noh" "$pack"
noh render "$pack" -o "$folder/face.noh" --size 16x16 --anim "$folder/face.noh" --clip speak
expect 2 'render over --anim'
says 'which --anim reads'
noh clip "$folder/face.noh" --dump "$folder/face.noh" --clip speak
expect 2 'clip --dump over its pack'
echo 'speak 0.1 hello' >"$folder/keys.txt"
noh build "$folder/model.glb" -o "$folder/keys.txt" --events "$folder/keys.txt"
expect 2 'build over its events'
check 'which stay' grep -q hello "$folder/keys.txt"
finish
