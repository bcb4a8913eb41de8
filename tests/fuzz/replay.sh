#!/bin/sh
# replay.sh: the fuzzer's seeds, and whatever it once found (tests/fuzz/found), without libFuzzer.
build=${NOH_BUILD:-build}
set -- "$build/tests/fuzz/corpus"
[ ! -d tests/fuzz/found ] || set -- "$@" tests/fuzz/found
exec "$build/tests/fuzz/fuzz_pack" "$@"
