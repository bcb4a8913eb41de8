#!/bin/sh
# A process that is killed at any change of a file, a disk that is full from any on, and memory that is refused once at
# any allocation: an output is the old file or the whole new one, every failure has a message and an exit code, and
# nothing crashes. tests/cli/faults.c is preloaded. NOH_LONG=1: every allocation; otherwise one of a few.
. "$(dirname "$0")/lib.sh"
if [ -n "${NOH_SAN:-}" ]; then
    skip 'faults' 'a preloaded library does not go with sanitizers'
    finish
fi
if ! ${CC:-gcc} -shared -fPIC -O1 -w tests/cli/faults.c -o "$work/faults.so" -ldl 2>"$work/err"; then
    skip 'faults' 'no shared library with malloc of its own here'
    finish
fi
tool=$build/noh
sh tests/support/small_glb.sh >"$work/small.glb"
"$tool" build "$work/small.glb" -o "$work/small.noh" --quiet
cat >"$work/walk.bvh" <<'END'
HIERARCHY
ROOT hips
{
 OFFSET 0 0 0
 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
 End Site
 {
  OFFSET 0 10 0
 }
}
MOTION
Frames: 3
Frame Time: 0.0333333
0 90 0 0 0 0
0 90 5 0 4 0
0 90 10 0 8 0
END

# under FAULT OUT COMMAND...: run with a fault; sets code. OUT is the old file before.
under() {
    fault=$1 target=$2
    shift 2
    cp "$work/old" "$target"
    NOH_FAULT=$fault LD_PRELOAD=$work/faults.so "$@" >"$work/out" 2>"$work/err"
    code=$?
}
is_old_or_new() { cmp -s "$1" "$work/old" || cmp -s "$1" "$work/new"; }

faults() { # NAME OUT COMMAND...
    name=$1 out=$2
    shift 2
    echo 'the old file' >"$work/old"
    NOH_FAULT_COUNT=$work/count LD_PRELOAD=$work/faults.so "$@" >/dev/null 2>&1
    check "$name works" test $? = 0 -a -s "$work/count"
    cp "$out" "$work/new"
    read -r files allocations <"$work/count"
    check "$name changes files" test "$files" -ge 3
    : >"$work/killed" >"$work/full" >"$work/memory"
    at=1
    while [ "$at" -le "$files" ]; do
        under kill:$at "$out" "$@"
        { [ $code = 137 ] && is_old_or_new "$out"; } || echo "killed at $at: exit code $code" >>"$work/killed"
        rm -f "$work"/.noh-*.tmp
        under full:$at "$out" "$@"
        { [ $code != 0 ] && [ $code -lt 126 ] && cmp -s "$out" "$work/old" && grep -q 'No space left' "$work/err"; } ||
            echo "full at $at: exit code $code, $(head -c 100 "$work/err")" >>"$work/full"
        at=$((at + 1))
    done
    check "$name, killed at each of $files changes: the old file or the new one" sh -c '! grep . "$1"' - "$work/killed"
    check "$name, a full disk: the old file and a message" sh -c '! grep . "$1"' - "$work/full"
    check "$name leaves no temporary file" sh -c '! ls "$1"/.noh-*.tmp 2>/dev/null' - "$work"
    step=$((allocations / 120 + 1))
    [ -z "${NOH_LONG:-}" ] || step=1
    at=1
    while [ "$at" -le "$allocations" ]; do
        under memory:$at "$out" "$@"
        if [ $code = 0 ]; then
            cmp -s "$out" "$work/new" || echo "allocation $at: success with another file" >>"$work/memory"
        else
            { [ $code -lt 126 ] && cmp -s "$out" "$work/old" && [ -s "$work/err" ]; } ||
                echo "allocation $at: exit code $code, $(head -c 100 "$work/err")" >>"$work/memory"
        fi
        at=$((at + step))
    done
    check "$name, memory refused at $((allocations / step)) of $allocations allocations" sh -c '! grep . "$1"' - "$work/memory"
}

faults 'build of a model' "$work/made.noh" "$tool" build "$work/small.glb" -o "$work/made.noh"
faults 'build with levels' "$work/levels.noh" "$tool" build "$work/small.glb" -o "$work/levels.noh" --lod 2
faults 'build of motion capture' "$work/walk.noh" "$tool" build "$work/walk.bvh" -o "$work/walk.noh"
faults 'pack' "$work/made.nohz" "$tool" pack "$work/small.noh" -o "$work/made.nohz"
faults 'dump' "$work/made.obj" "$tool" dump "$work/small.noh" -o "$work/made.obj"
finish
