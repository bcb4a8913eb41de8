#!/bin/sh
# fuzz.sh: runs libFuzzer on the pack reader, the clip decoder and the wire form's unpacker, with AddressSanitizer, UBSan and all asserts on,
# all at once for FUZZ_SECONDS (60), from the seeds in build/tests/fuzz/corpus, clips and wires. Closes like run.sh. A crash
# is saved as build/fuzz/TARGET-crash-*: copy it to tests/fuzz/found/ (packs) or found_clips/ or found_wires/, where `make check`
# replays it.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
seconds=${FUZZ_SECONDS:-60}
clang=${CLANG:-clang}
work=$build/fuzz
mkdir -p "$work"

skip() {
    echo "fuzz skipped: $1"
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
}
command -v "$clang" >/dev/null 2>&1 || skip "no $clang here"
echo 'int LLVMFuzzerTestOneInput(const unsigned char *d, unsigned long n); int LLVMFuzzerTestOneInput(const unsigned char *d, unsigned long n) { return d && n == 99 ? 1 : 0; }' >"$work/probe.c"
"$clang" -fsanitize=fuzzer,address,undefined "$work/probe.c" -o "$work/probe" 2>"$work/probe.txt" ||
    skip "$clang has no libFuzzer or sanitizer runtime (libclang-rt-dev)"

flags="-std=c99 -O1 -g -ffp-contract=off -fno-math-errno -DNOH_LIBFUZZER -fsanitize=fuzzer-no-link,address,undefined
    -fno-sanitize-recover=all -fno-omit-frame-pointer -DNOH_ASSERT_LEVEL=2 -Iruntime -Itests -Itests/support -I$build/gen"

# All targets link the same objects.
rm -rf "$work/objects"
mkdir "$work/objects"
# shellcheck disable=SC2016
if ! { find runtime -name '*.c' && find tests -name pack_walk.c && echo "$build/gen/shaders.gen.c"; } |
    xargs -P "${JOBS:-2}" -I '{}' sh -c '$1 $2 -c "$3" -o "$4/$(echo "$3" | tr / _).o"' sh "$clang" "$flags" '{}' "$work/objects"; then
    echo '0 passed, 1 failed, 0 skipped'
    exit 1
fi

# fuzz TARGET MAX_LEN FOUND SEEDS: succeeds when nothing was found
fuzz() {
    target=$1 max_len=$2 found=$3
    mkdir -p "$work/$target.corpus"
    # shellcheck disable=SC2086
    "$clang" $flags -fsanitize=fuzzer "tests/fuzz/$target.c" "$work"/objects/*.o -o "$work/$target" || return 1
    set -- "$work/$target.corpus" "$4"
    [ ! -d "$found" ] || set -- "$@" "$found"
    "$work/$target" -seed=1 -max_total_time="$seconds" -max_len="$max_len" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
        -artifact_prefix="$work/$target-" "$@" >"$work/$target.txt" 2>&1
}
fuzz fuzz_pack 8192 tests/fuzz/found "$build/tests/fuzz/corpus" &
packs=$!
fuzz fuzz_clip 4096 tests/fuzz/found_clips "$build/tests/fuzz/clips" &
clips=$!
fuzz fuzz_wire 16384 tests/fuzz/found_wires "$build/tests/fuzz/wires" &
wires=$!

# told TARGET RESULT: prints what its log says
passed=0 failed=0
told() {
    echo "$1"
    if [ "$2" = 0 ]; then
        grep 'DONE\|stat::number_of_executed_units\|stat::peak_rss_mb' "$work/$1.txt" | sed 's/^/  /'
        echo "  fuzzed for $seconds s: nothing found"
        passed=$((passed + 1))
    else
        tail -n 60 "$work/$1.txt"
        failed=$((failed + 1))
    fi
}
wait "$packs"
told fuzz_pack $?
wait "$clips"
told fuzz_clip $?
wait "$wires"
told fuzz_wire $?
echo "$passed passed, $failed failed, 0 skipped"
[ $failed = 0 ]
