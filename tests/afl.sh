#!/bin/sh
# afl.sh: AFL++ on `noh build`, with AddressSanitizer: models (.glb), recordings (.bvh) and meshes (.obj) for
# AFL_SECONDS (300) each, in parallel. Seeds are the demo's arm and the files below. Ends like run.sh; crashes and hangs
# are in build/afl/out-*/default/. Part of `make check-long`.
set -u
cd "$(dirname "$0")/.." || exit 1
build=${NOH_BUILD:-build}
seconds=${AFL_SECONDS:-300}
case $build in /*) ;; *) build=$PWD/$build ;; esac
work=$build/afl
if ! command -v afl-fuzz >/dev/null 2>&1 || ! command -v afl-clang-fast >/dev/null 2>&1; then
    echo 'AFL++ skipped: it is not installed (Debian: afl++)'
    echo '0 passed, 0 failed, 1 skipped'
    exit 0
fi
rm -rf "$work/in-glb" "$work/in-bvh" "$work/in-obj" "$work/out-glb" "$work/out-bvh" "$work/out-obj"
mkdir -p "$work/in-glb" "$work/in-bvh" "$work/in-obj"
export AFL_USE_ASAN=1 AFL_SKIP_CPUFREQ=1 AFL_I_DONT_CARE_ABOUT_MISSING_CRASHES=1 AFL_NO_UI=1 AFL_NO_AFFINITY=1 AFL_QUIET=1
# A failed allocation returns NULL, as in the build without sanitizers; leaks at the end of a program are ignored.
export ASAN_OPTIONS=abort_on_error=1:symbolize=0:detect_leaks=0:allocator_may_return_null=1
if ! make --no-print-directory -j"${JOBS:-2}" BUILD="$work/build" CC=afl-clang-fast CXX=afl-clang-fast++ OPT='-O1 -g' WERROR= DEPS=0 \
    "$work/build/noh" >"$work/make.txt" 2>&1; then
    echo 'it does not build:'
    tail -n 20 "$work/make.txt"
    echo '0 passed, 1 failed, 0 skipped'
    exit 1
fi

# A triangle on two joints with a target and a clip, small enough to be mutated everywhere.
sh tests/support/small_glb.sh >"$work/in-glb/small.glb"
cat >"$work/in-bvh/leg.bvh" <<'END'
HIERARCHY
ROOT Hips
{
 OFFSET 0 0 0
 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
 JOINT Knee
 {
  OFFSET 0 -40 0
  CHANNELS 3 Zrotation Xrotation Yrotation
  End Site
  {
   OFFSET 0 -40 5
  }
 }
}
MOTION
Frames: 3
Frame Time: 0.0333333
0 80 0 0 0 0 0 0 0
0 80 5 10 0 0 0 -20 0
0 80 9 0 0 0 5 0 0
END
printf 'mtllib none.mtl\no quad\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nusemtl skin\ns 1\nf 1/1/1 2/2/1 3/3/1 4/1/1\n' \
    >"$work/in-obj/quad.obj"

for kind in glb bvh obj; do
    (
        cd "$work" || exit 1
        afl-fuzz -V "$seconds" -t 5000 -m none -e "$kind" -i "in-$kind" -o "out-$kind" -- \
            ./build/noh build @@ -o "made-$kind.noh" --quiet --clean all >"fuzz-$kind.txt" 2>&1
    ) &
done
wait
passed=0 failed=0
for kind in glb bvh obj; do
    stats=$work/out-$kind/default/fuzzer_stats
    if [ ! -s "$stats" ]; then
        echo "$kind: AFL++ did not run:"
        tail -n 12 "$work/fuzz-$kind.txt"
        failed=$((failed + 1))
        continue
    fi
    crashes=$(find "$work/out-$kind/default/crashes" -type f ! -name README.txt | wc -l)
    hangs=$(find "$work/out-$kind/default/hangs" -type f | wc -l)
    echo "$kind: $(sed -n 's/^execs_done *: //p' "$stats") runs, $(sed -n 's/^corpus_count *: //p' "$stats") inputs, edges $(sed -n 's/^edges_found *: //p' "$stats") ($(sed -n 's/^bitmap_cvg *: //p' "$stats")), $crashes crashes, $hangs hangs"
    if [ "$crashes" = 0 ] && [ "$hangs" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
done
echo "$passed passed, $failed failed, 0 skipped"
[ $failed = 0 ]
