#!/bin/sh
# Help, version, options without effect, JSON on errors, JSON together with --dump.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh
verbs='build strip pack info clip budget render sheet dump verify view crowd speak mask bake face bench lab_zoom lab_drop lab_light lab_replay lab_bisect'

silent() {
    check "$1" test ! -s "$work/err"
}

# ---- help ----

noh --version
expect 0 '--version'
check 'is NOH_VERSION' sh -c 'grep -qx "noh $(sed -n "s/^#define NOH_VERSION \"\(.*\)\"/\1/p" runtime/noh/base.h)" "$1"' - "$work/out"
for verb in $verbs; do
    verb=$(echo "$verb" | tr _ ' ')
    noh $verb --help
    expect 0 "$verb --help"
    cp "$work/out" "$work/help"
    silent 'on stdout alone'
    check 'with usage and examples' sh -c 'grep -q "^usage: noh $2 " "$1" && grep -q "^  noh $2 " "$1"' - "$work/help" "$verb"
    noh $verb -h
    expect 0 "$verb -h"
    check 'says the same' cmp "$work/out" "$work/help"
    noh help $verb
    expect 0 "help $verb"
    check 'says the same' cmp "$work/out" "$work/help"
    # The parser accepts every option in the help.
    options=$(sed -n 's/^  \(-[-a-z0-9]*\).*/\1/p' "$work/help" | grep -v '^-h$')
    for option in $options; do
        noh $verb $option
        check "$verb knows $option" sh -c 'test "$2" = 2 && ! grep -q "has no option" "$1"' - "$work/err" $code
    done
done
noh render "$pack" --size 64x64 -h
expect 0 'help among other arguments'
noh help FORMATS
expect 0 'help FORMATS'
check 'has the events file' grep -q 'CLIP TIME_S NAME marker' "$work/out"
check 'has masks and JSON' sh -c 'grep -q "^masks" "$1" && grep -q "not_found" "$1"' - "$work/out"
noh help rendr
expect 2 'help of an unknown verb'
says "did you mean 'render'?"
noh rendr
expect 2 'an unknown verb'
says "did you mean 'render'?"
noh help --man
expect 0 'help --man'
cp "$work/out" "$work/noh.1"
for verb in $verbs; do
    verb=$(echo "$verb" | tr _ ' ')
    check "the man page has $verb" grep -q "^\.SS noh $verb " "$work/noh.1"
done
if command -v man >/dev/null 2>&1 && man -l "$work/noh.1" >"$work/page" 2>/dev/null; then
    check 'man warns of nothing' sh -c 'test -z "$(LC_ALL=C.UTF-8 MANWIDTH=80 MANROFFSEQ= man --warnings -E UTF-8 -l "$1" 2>&1 >/dev/null)"' - "$work/noh.1"
else
    skip 'man warns of nothing' 'man is not here'
fi

# ---- completion ----

noh help --bash
expect 0 'help --bash'
cp "$work/out" "$work/noh.bash"
complete() { # WORDS... : what bash offers for the last one
    bash -c '. "$0"; COMP_WORDS=(noh "$@"); COMP_CWORD=$#; _noh; echo "${COMPREPLY[*]}"' "$work/noh.bash" "$@"
}
if command -v bash >/dev/null 2>&1; then
    check 'bash completes a verb' test "$(complete rend)" = render
    check 'an option' test "$(complete render --acc)" = --accumulate
    check 'a word of an option' test "$(complete render --path per)" = per-layer
    check 'not the options of another verb' test -z "$(complete info --acc)"
    check 'a verb of the lab' test "$(complete lab zo)" = zoom
    check 'and its options' test "$(complete lab zoom --jit)" = --jitter
    check 'a word of one' test "$(complete lab zoom --driver os)" = osmesa
    check 'and a file' test "$(complete lab drop "$work/noh.b")" = "$work/noh.bash"
    check 'help completes the lab' test "$(complete help la)" = lab
    check 'a file' test "$(complete info "$work/noh.b")" = "$work/noh.bash"
else
    skip 'completion' 'bash is not here'
fi

# ---- options without effect ----

ineffective() { # NAME-OF-THE-OPTION ARGUMENTS...
    option=$1
    shift
    noh "$@"
    expect 2 "$*"
    says "$option has no effect with"
}
ineffective --clip clip "$pack" --clip foo
ineffective --driver budget "$pack" --driver egl --nominal
ineffective --anim render "$pack" -o "$work/x.png" --anim "$pack"
ineffective --weight render "$pack" -o "$work/x.png" --bones --weight smile=1
ineffective --path render "$pack" -o "$work/x.png" --bones --path cpu
ineffective --driver dump "$pack" -o "$work/x.obj" --driver egl
ineffective --accumulate dump "$pack" -o "$work/x.obj" --path cpu --accumulate f16
ineffective --time dump "$pack" -o "$work/x.obj" --time 1
ineffective --tiles sheet "$pack" -o "$work/x.png" --tiles 4
ineffective --time sheet "$pack" -o "$work/x.png" --time 1
ineffective --transition sheet "$pack" -o "$work/x.png" --clip speak --transition fade
ineffective --over sheet "$pack" -o "$work/x.png" --clip speak --over 1
ineffective --target sheet "$pack" -o "$work/x.png" --clip speak --target smile
ineffective --columns sheet "$pack" -o "$work/x.png" --lods --columns 3
ineffective --clip sheet "$pack" -o "$work/x.png" --lods --clip speak
ineffective --time lab zoom "$pack" --time 1
ineffective --pixels crowd "$pack" -o "$work/x.png" --plain --pixels 2
ineffective --rounds bench "$pack" --quick --rounds 3
ineffective --lod-fast build "$build/mask.glb" -o "$work/x.noh" --lod-fast
ineffective --error-cm build "$build/mask.glb" -o "$work/x.noh" --only mesh --error-cm 1
ineffective --lod build "$build/mask.glb" -o "$work/x.noh" --only anim --lod 4
ineffective --error-um build "$build/mask.glb" -o "$work/x.noh" --only anim --error-um 5
noh build "$build/mask.glb" -o "$work/x.noh" --only mesh --error-um 5 --quiet
expect 0 'build --only mesh --error-um has one'
noh info "$pack" --jsno
expect 2 'a misspelt option'
says 'did you mean --json?'
cp "$pack" "$work/-pack.noh"
check 'after -- a name may begin with a hyphen' sh -c 'cd "$2" && "$1" info -- -pack.noh' - "$(cd "$build" && pwd)/noh" "$work"

# ---- JSON ----

# A pack of two clips, one of joints.
printf 'HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 10 0\n}\n}\nMOTION\nFrames: 3\nFrame Time: 1\n0 0 0\n5 10 0\n0 20 0\n' >"$work/nod.bvh"
sed 's/5 10 0/5 40 3/' "$work/nod.bvh" >"$work/turn.bvh"
noh build "$work/nod.bvh" "$work/turn.bvh" -o "$work/two.noh" --quiet
expect 0 'a pack of clips'
ineffective --path budget "$work/two.noh" --path cpu
ineffective --accumulate budget "$work/two.noh" --accumulate f16
noh build "$build/mask.glb" -o "$work/x.noh" --plain --dual-quaternion all
expect 1 'dual quaternions for all of a rigid model'
says 'no mesh is skinned'
# The events file of the help, with the names of these clips.
noh help FORMATS
sed -n '/^callback keys and sync/,/^callback keys in glTF/{s/^ *walk /nod /p; s/^ *"wave hand"/turn/p}' "$work/out" >"$work/keys.txt"
check 'the help shows four events' test "$(wc -l <"$work/keys.txt")" = 4
noh build "$work/nod.bvh" "$work/turn.bvh" -o "$work/two.noh" --events "$work/keys.txt" --quiet
expect 0 'which build takes'
noh clip "$work/two.noh"
check 'and clip lists' sh -c 'grep -q "marker .right" "$1" && grep -q "step" "$1" && grep -q "1.5000 s .sound" "$1"' - "$work/out"
noh clip "$work/two.noh" --clip turn --dump "$work/turn.rcl" --json
expect 0 'clip --dump --json'
check 'wrote the clip' test -s "$work/turn.rcl"
check 'and printed the list' grep -q '"name": "turn"' "$work/out"
noh budget "$work/two.noh" --json
expect 0 'budget of a pack of clips alone'
check 'has their bytes' grep -q '"cpu_bytes": [1-9]' "$work/out"
noh budget "$work/two.noh"
expect 0 'and as text'

error_json() { # CODE RESULT NAME ARGUMENTS...
    wanted=$1 result=$2 name=$3
    shift 3
    noh "$@"
    expect "$wanted" "$name"
    check 'a message on stderr' grep -q '^noh: ' "$work/err"
    if [ -n "$json" ]; then
        check "JSON with the result $result" $json "j.error.result === \"$result\" && j.error.what !== \"\" && j.error.subject !== \"\"" <"$work/out"
    else
        check "an error with the result $result" grep -q "\"result\": \"$result\"" "$work/out"
    fi
}
error_json 1 failed 'a missing file' info "$work/missing.noh" --json
head -c 5000 "$pack" >"$work/cut.noh"
error_json 1 data 'a cut pack' info "$work/cut.noh" --json
check 'says where' grep -q '"where": [0-9]' "$work/out"
error_json 1 data 'budget of it' budget "$work/cut.noh" --json
error_json 1 data 'verify of it' verify "$work/cut.noh" --json
dd if=/dev/zero of="$work/zeros.noh" bs=1024 count=4 2>"$work/dd"
error_json 1 data 'no pack at all' info "$work/zeros.noh" --json
check 'at byte 0; need means nothing' sh -c 'grep -q "\"where\": 0" "$1" && grep -q "\"need\": null" "$1"' - "$work/out"
error_json 2 usage 'an unknown option' info "$pack" --json --nonsense
check 'where and need are null' sh -c 'grep -q "\"where\": null" "$1" && grep -q "\"need\": null" "$1"' - "$work/out"
error_json 2 usage 'no file' bench --json
error_json 1 failed 'a clip that cannot be dumped' clip "$pack" --dump "$work/x.rcl" --clip speak --json
error_json 1 failed 'a clip that is not there' clip "$work/two.noh" --dump "$work/x.rcl" --clip trun --json
finish
