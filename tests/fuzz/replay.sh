#!/bin/sh
# replay.sh: replays the fuzzers' seeds and findings (tests/fuzz/found, found_clips, found_wires) without libFuzzer, and
# tries sixty wild files of each text format that noh build reads (NOH_LONG=1: 20000 in place of 60).
build=${NOH_BUILD:-build}
failed=0
set -- "$build/tests/fuzz/corpus"
[ ! -d tests/fuzz/found ] || set -- "$@" tests/fuzz/found
"$build/tests/fuzz/fuzz_pack" "$@" || failed=1
set -- "$build/tests/fuzz/clips"
[ ! -d tests/fuzz/found_clips ] || set -- "$@" tests/fuzz/found_clips
"$build/tests/fuzz/fuzz_clip" "$@" || failed=1
set -- "$build/tests/fuzz/wires"
[ ! -d tests/fuzz/found_wires ] || set -- "$@" tests/fuzz/found_wires
"$build/tests/fuzz/fuzz_wire" "$@" || failed=1
cases=60
[ -z "${NOH_LONG:-}" ] || cases=20000
"$build/tests/fuzz/fuzz_import" --wild 1 $cases || failed=1
exit $failed
