#!/bin/sh
# fuzz.sh: runs libFuzzer on the pack reader, the clip decoder, the wire form's unpacker and the reader of a capture's
# packets, with AddressSanitizer, UBSan and all asserts on, in parallel for FUZZ_SECONDS (60), from the seeds in
# build/tests/fuzz/corpus, clips and wires. Ends like run.sh. A crash is saved as build/fuzz/TARGET-crash-*: copy it to
# tests/fuzz/found/ (packs), found_clips/ or found_wires/, where `make check` replays it; a packet becomes a case of
# tests/unit/tools/test_vmc.c. With NOH_LONG set, also on the inputs of noh build (fuzz_import), from files written by the
# converter's tests; findings go to tests/fuzz/found_imports.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
seconds=${FUZZ_SECONDS:-60}
clang=${CLANG:-clang}
clangxx=${CLANGXX:-clang++}
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

flags="-std=c99 -O1 -g1 -ffp-contract=off -fno-math-errno -DNOH_LIBFUZZER -fsanitize=fuzzer-no-link,address,undefined
    -fno-sanitize-recover=all -fno-omit-frame-pointer -DNOH_ASSERT_LEVEL=2 -Iruntime -Itests -Itests/support -Itools/noh -I$build/gen"
# As in the Makefile, and without what draws stages, which no reader calls.
without='-path runtime/gl/stage'
if [ -n "${NOH_LONG:-}" ]; then without='-path none'; else flags="$flags -fno-sanitize=null,object-size"; fi

# All targets link the same objects.
rm -rf "$work/objects"
mkdir "$work/objects"
# shellcheck disable=SC2016,SC2086
if ! { find runtime $without -prune -o -name '*.c' -print && find tests -name pack_walk.c -o -name 'wild_*.c' && printf '%s\n' tools/noh/capture/osc.c tools/noh/capture/vmc.c && echo "$build/gen/shaders.gen.c"; } |
    xargs -P "${JOBS:-2}" -I '{}' sh -c '$1 $2 -c "$3" -o "$4/$(echo "$3" | tr / _).o"' sh "$clang" "$flags" '{}' "$work/objects"; then
    echo '0 passed, 1 failed, 0 skipped'
    exit 1
fi

# link_target TARGET
link_target() {
    # shellcheck disable=SC2086
    "$clang" $flags -fsanitize=fuzzer "tests/fuzz/$1.c" "$work"/objects/*.o -o "$work/$1"
}

# fuzz TARGET MAX_LEN FOUND SEEDS: succeeds when nothing was found
fuzz() {
    target=$1 max_len=$2 found=$3
    mkdir -p "$work/$target.corpus"
    [ -n "${linked:-}" ] || link_target "$target" || return 1
    set -- "$work/$target.corpus" "$4"
    [ ! -d "$found" ] || set -- "$@" "$found"
    "$work/$target" -seed=1 -max_total_time="$seconds" -max_len="$max_len" -timeout=60 -rss_limit_mb=2048 -print_final_stats=1 \
        -artifact_prefix="$work/$target-" "$@" >"$work/$target.txt" 2>&1
}
fuzz fuzz_pack 8192 tests/fuzz/found "$build/tests/fuzz/corpus" &
packs=$!
fuzz fuzz_clip 4096 tests/fuzz/found_clips "$build/tests/fuzz/clips" &
clips=$!
fuzz fuzz_wire 16384 tests/fuzz/found_wires "$build/tests/fuzz/wires" &
wires=$!
mkdir -p "$work/packets"
printf '/VMC/Ext/Bone/Pos\0\0\0,sfffffff\0\0\0Hips\0\0\0\0%028d' 0 >"$work/packets/bone"
printf '#bundle\0%08d\0\0\0\044/VMC/Ext/Blend/Val\0\0,sf\0Joy\0?\0\0\0' 0 >"$work/packets/bundle"
fuzz fuzz_vmc 2048 tests/fuzz/found_packets "$work/packets" &
packets=$!

# Also the converter: C and C++, with its input libraries.
link_import() {
    more="-Itools -Iplatform -isystem /usr/include/stb" libraries="-ltinygltf -lmeshoptimizer -lstb"
    if pkg-config --exists draco; then more="$more -DNOH_DRACO" libraries="$libraries -ldraco"; fi
    rm -rf "$work/import"
    mkdir "$work/import"
    # shellcheck disable=SC2016
    { find tools/convert -name '*.c' -o -name '*.cpp'; echo platform/file.c; echo platform/file_write.c; echo tests/fuzz/fuzz_import.c
        printf 'tools/noh/%s\n' cli/message.c crowd/place_file.c speak/sound.c; } |
        xargs -P "${JOBS:-2}" -I '{}' sh -c 'compiler=$1 flags=$3
            case $4 in *.cpp) compiler=$2 flags="-std=c++17 ${3#-std=c99}" ;; esac
            $compiler $flags -c "$4" -o "$5/$(echo "$4" | tr / _).o"' sh "$clang" "$clangxx" "$flags $more" '{}' "$work/import" || return 1
    # shellcheck disable=SC2086
    "$clangxx" -fsanitize=fuzzer,address,undefined "$work"/import/*.o "$work"/objects/*.o -o "$work/fuzz_import" $libraries -ldl -lm
}

# Files of every kind, written by the converter's tests.
import_seeds() {
    rm -rf "$work/imports"
    mkdir "$work/imports"
    for test in gltf_read gltf_draco gltf_left_out gltf_springs influences fbx_read obj_read bvh_read rcl events_read; do
        make --no-print-directory DEPS=0 BUILD="$build" "$build/tests/unit/convert/test_$test" >/dev/null || return 1
        NOH_SEEDS=$work/imports "$build/tests/unit/convert/test_$test" >/dev/null 2>&1 || return 1
    done
    sh tests/support/small_glb.sh >"$work/imports/small"
    make --no-print-directory DEPS=0 BUILD="$build" "$build/tests/fuzz/fuzz_import" >/dev/null || return 1
    "$build/tests/fuzz/fuzz_import" --seeds "$work/imports"
}

imports=
if [ -n "${NOH_LONG:-}" ]; then
    # A failed allocation returns NULL, as without sanitizers.
    (link_import && import_seeds && export ASAN_OPTIONS=allocator_may_return_null=1 && linked=1 &&
        fuzz fuzz_import 16384 tests/fuzz/found_imports "$work/imports") &
    imports=$!
fi

# told TARGET RESULT: prints the result from its log
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
wait "$packets"
told fuzz_vmc $?
if [ -n "$imports" ]; then
    wait "$imports"
    told fuzz_import $?
fi
echo "$passed passed, $failed failed, 0 skipped"
[ $failed = 0 ]
