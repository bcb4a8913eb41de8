#!/bin/sh
# fuzz.sh: libFuzzer on the pack reader, with AddressSanitizer and UBSan, for FUZZ_SECONDS
# (60), from the seeds in build/tests/fuzz/corpus. Closes like run.sh. What it finds lies in
# build/fuzz/crash-*: copy it to tests/fuzz/found/, where `make check` replays it.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
seconds=${FUZZ_SECONDS:-60}
clang=${CLANG:-clang}
work=$build/fuzz
mkdir -p "$work/corpus" "$work/objects"

skip() {
    echo "fuzz skipped: $1"
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
}
command -v "$clang" >/dev/null 2>&1 || skip "no $clang here"
echo 'int LLVMFuzzerTestOneInput(const unsigned char *d, unsigned long n); int LLVMFuzzerTestOneInput(const unsigned char *d, unsigned long n) { return d && n == 99 ? 1 : 0; }' >"$work/probe.c"
"$clang" -fsanitize=fuzzer,address,undefined "$work/probe.c" -o "$work/probe" 2>"$work/probe.txt" ||
    skip "$clang has no libFuzzer or sanitizer runtime (libclang-rt-dev)"

failed() {
    echo '0 passed, 1 failed, 0 skipped'
    exit 1
}
flags="-std=c99 -O1 -g -ffp-contract=off -fno-math-errno -DNOH_LIBFUZZER -fsanitize=fuzzer,address,undefined
    -fno-sanitize-recover=all -fno-omit-frame-pointer -Iruntime -Itests -I$build/gen"
# shellcheck disable=SC2086
"$clang" $flags tests/fuzz/fuzz_pack.c tests/pack_walk.c runtime/*/*.c "$build/gen/shaders.gen.c" -o "$work/fuzz_pack" || failed

set -- "$work/corpus" "$build/tests/fuzz/corpus"
[ ! -d tests/fuzz/found ] || set -- "$@" tests/fuzz/found
"$work/fuzz_pack" -seed=1 -max_total_time="$seconds" -max_len=8192 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$work/" "$@" >"$work/log.txt" 2>&1
result=$?
grep 'DONE\|stat::number_of_executed_units\|stat::peak_rss_mb' "$work/log.txt" | sed 's/^/  /'
if [ $result != 0 ]; then
    tail -n 60 "$work/log.txt"
    failed
fi
echo "fuzzed for $seconds s: nothing found"
echo '1 passed, 0 failed, 0 skipped'
