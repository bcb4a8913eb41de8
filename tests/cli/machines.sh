#!/bin/sh
# Clips built on several machines by GNU parallel, as the guide has it: the same bytes, and what a lost machine had is
# done by another. Machines are networks of their own, reached by a program in place of ssh. With NOH_LONG a thousand
# clips, else thirty.
. "$(dirname "$0")/lib.sh"
if ! command -v parallel >/dev/null 2>&1 || ! parallel --version 2>/dev/null | grep -q '^GNU parallel'; then
    skip 'several machines' 'no GNU parallel here'
    finish
fi
if ! unshare -rn true 2>/dev/null; then
    skip 'several machines' 'no namespaces for users here'
    finish
fi
bin=$(cd "$build" && pwd)/noh
clips=${NOH_LONG:+1000}
clips=${clips:-30}
cd "$work" || exit 1
mkdir clips packs one jobs

# reach HOST COMMAND: a machine is lost in its sixth job: it has built the pack, but nobody hears of it
cat >reach <<'END'
#!/bin/sh
host=$1
shift
[ "$1" != -- ] || shift
echo x >>"jobs/$host"
if [ "$host" = lost ] && [ "$(wc -l <jobs/lost)" -gt 5 ]; then
    [ "$(wc -l <jobs/lost)" -gt 6 ] || unshare -rn sh -c "$*"
    exit 255
fi
exec unshare -rn sh -c "$*"
END
chmod +x reach
# A login sets SHELL. Without it parallel 20221122 runs nothing on another machine and reports success.
export SHELL=/bin/sh
n=0
while [ $n -lt "$clips" ]; do
    printf 'HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.04\n0 0 0\n0 1 %s\n1 0 90\n' $n >clips/c$n.bvh
    n=$((n + 1))
done

# build MACHINES... into packs/
build_on() {
    parallel --will-cite --retries 3 --joblog clips.log --workdir . "$@" \
        "$bin" build {} -o packs/{/.}.noh --quiet ::: clips/*.bvh >"$work/out" 2>"$work/err"
    code=$?
}
build_on -S "2/$work/reach first" -S "2/$work/reach second" -S "2/$work/reach lost"
expect 0 "$clips clips on three machines, and one is lost"
check 'it was, and did some before' test "$(wc -l <jobs/lost)" -gt 6
check 'all packs are there' test "$(find packs -name '*.noh' | wc -l)" = "$clips"
check 'as many jobs succeeded' test "$(awk '$7 == 0' clips.log | wc -l)" = "$clips"
for clip in clips/*.bvh; do echo "$clip"; done | xargs -P 2 -I '{}' sh -c '"$1" build "$2" -o "one/$(basename "$2" .bvh).noh" --quiet' - "$bin" '{}'
check 'they have the bytes that one machine makes' diff -r one packs
check 'and nothing else is left' test "$(find packs -type f | wc -l)" = "$clips"

# Interrupted: what is left is done, and nothing else.
rm packs/c1.noh packs/c2.noh
awk 'NR == 1 || ($0 !~ /c1\.bvh/ && $0 !~ /c2\.bvh/)' clips.log >kept.log
mv kept.log clips.log
rm -f jobs/*
build_on --resume-failed -S "2/$work/reach first"
expect 0 'what was interrupted goes on'
check 'with what is left' diff -r one packs
check 'alone' test "$(wc -l <jobs/first)" = 2
finish
