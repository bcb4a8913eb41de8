#!/bin/sh
# noh build and noh clip with .bvh, .rcl and glTF clips; errors in a file name the line.
. "$(dirname "$0")/lib.sh"

cat >"$work/walk.bvh" <<'BVH'
HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT knee
  {
    OFFSET 0 -10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -10 0
    }
  }
}
MOTION
Frames: 4
Frame Time: 0.0333333
0 20 0 0 0 0 0 0 0
1 20 0 5 0 0 10 0 0
2 21 0 10 0 0 25 0 0
0 20 0 0 0 0 0 0 0
BVH

noh build "$work/walk.bvh" -o "$work/walk.noh" --quiet
expect 0 'a .bvh becomes a pack'
noh clip "$work/walk.noh"
expect 0 'clip'
check 'and prints the certified error' grep -q 'certified all round, 3 cm' "$work/out"
noh clip "$work/walk.noh" --dump "$work/walk.rcl"
expect 0 'the decoded frames as .rcl'
noh build "$work/walk.rcl" -o "$work/again.noh" --quiet
expect 0 'which is built again'
noh info "$work/walk.noh" --json
check 'info counts the skeleton' grep -q '"joints": 2' "$work/out"
check 'and its levels' sh -c 'tr -d " \n" <"$1" | grep -q "\"levels\":\[2,1\]"' - "$work/out"
noh info "$work/walk.noh"
check 'info prints the levels' grep -q '2 joints, at coarser levels 1$' "$work/out"
check 'and what they cost' grep -q 'off by at most .* cm at 30, 15, 8 Hz; 1\.[0-9]* cm with 1 joint (3 cm from the joints)' "$work/out"
noh build "$work/walk.bvh" -o "$work/shell.noh" --shell-cm 6 --quiet
noh info "$work/shell.noh"
check 'of another shell too' grep -q '(6 cm from the joints)' "$work/out"
noh clip "$work/walk.noh" --dump "$work/x.rcl" --clip wlak
expect 1 'a clip that is not there'
says "did you mean 'walk'"

noh bench "$work/walk.noh" --rounds 1 --json
expect 0 'a bench of a clip of one segment, without a mesh'
noh bench "$work/walk.noh" "$work/again.noh" --rounds 1 --json
expect 0 'and of two packs'
for row in clip/warm clip/alone clip/shared-100x2 clip/seek clip/worst-frame; do
    check "has the row $row" grep -q "\"$row\"" "$work/out"
done

for option in '--error-cm 0' '--shell-cm -1' '--rate -3' '--only legs' '--unit-cm 0'; do
    # shellcheck disable=SC2086
    noh build "$work/walk.bvh" -o "$work/x.noh" $option
    expect 2 "build $option is a usage error"
done

# Clips of 100 Hz or more are split, so that half of their frames take half of the time.
awk 'BEGIN { print "HIERARCHY\nROOT hips\n{\n OFFSET 0 0 0\n CHANNELS 3 Zrotation Xrotation Yrotation\n End Site\n { OFFSET 0 10 0 }\n}"
    print "MOTION\nFrames: 96\nFrame Time: 0.00833333"
    for (i = 0; i < 96; i++) print 20 * sin(i / 15) + sin(37 * i * i), 10 * cos(i / 21) + sin(53 * i * i), sin(29 * i * i) }' >"$work/fast.bvh"
noh build "$work/fast.bvh" -o "$work/fast.noh" --quiet
noh clip "$work/fast.noh"
check 'a fast clip is split' grep -q '3 segments, split,' "$work/out"
noh clip "$work/fast.noh" --json
check 'as JSON says' grep -q '"split": true' "$work/out"
noh build "$work/fast.bvh" -o "$work/whole.noh" --split-hz 0 --quiet
noh clip "$work/whole.noh" --json
check '--split-hz 0: none is' grep -q '"split": false' "$work/out"
noh build "$work/fast.bvh" -o "$work/slow.noh" --rate 60 --quiet
noh clip "$work/slow.noh" --json
check 'one of 60 Hz is not' grep -q '"split": false' "$work/out"
noh build "$work/fast.bvh" -o "$work/slow.noh" --rate 60 --split-hz 60 --quiet
noh clip "$work/slow.noh" --json
check '--split-hz 60: it is' grep -q '"split": true' "$work/out"
noh build "$work/fast.bvh" -o "$work/short.noh" --segment-frames 16 --quiet
noh clip "$work/short.noh"
check '--segment-frames: 96 frames in 6 segments' grep -q '6 segments' "$work/out"
for option in '--segment-frames 7' '--segment-frames 41' '--segment-frames 16.5'; do
    # shellcheck disable=SC2086
    noh build "$work/fast.bvh" -o "$work/x.noh" $option
    expect 2 "build $option is a usage error"
done
noh build "$work/fast.bvh" -o "$work/x.noh" --split-hz -1
expect 2 'a rate below 0 is a usage error'
noh clip "$work/fast.noh" --dump "$work/fast.rcl"
noh clip "$work/whole.noh" --dump "$work/whole.rcl"
check 'whole, both decode to the same' cmp "$work/fast.rcl" "$work/whole.rcl"

# Bounds of single clips and joints: coarser is smaller, finer is certified.
noh build "$work/walk.bvh" -o "$work/coarse.noh" --clip-error walk=1 --quiet
expect 0 'a bound for one clip'
noh clip "$work/coarse.noh"
check 'is not the others' sh -c '! cmp -s "$1" "$2"' - "$work/coarse.noh" "$work/walk.noh"
noh build "$work/walk.bvh" -o "$work/fine.noh" --joint-error knee=0.0005 --quiet
expect 0 'a bound for one joint'
check 'makes another pack' sh -c '! cmp -s "$1" "$2"' - "$work/fine.noh" "$work/walk.noh"
noh build "$work/walk.bvh" -o "$work/x.noh" --clip-error run=1
expect 1 'a bound for a missing clip'
says "no clip is named 'run'"
for option in '--joint-error knee=none' '--clip-error walk' '--clip-error walk=' '--clip-error walk=0' '--clip-error =1' '--joint-error knee=-1'; do
    # shellcheck disable=SC2086
    noh build "$work/walk.bvh" -o "$work/x.noh" $option
    expect 2 "a bad bound is a usage error: $option"
    says "${option%% *} must be NAME=CM"
done

sed '$d' "$work/walk.bvh" >"$work/short.bvh"
noh build "$work/short.bvh" -o "$work/x.noh"
expect 0 'a frame too few'
check 'is a warning' grep -q 'warning: line .*: the file ends after .* frames; the clip ends before it' "$work/out"
sed 's/^1 20 0 5/1 20 x 5/' "$work/walk.bvh" >"$work/word.bvh"
noh build "$work/word.bvh" -o "$work/x.noh"
expect 0 'a word among the numbers'
check 'is a warning' grep -q "warning: line 20: 'x' is not a number; 1 frame that cannot be read repeats the nearest one" "$work/out"
rm -f "$work/x.noh"
printf 'walk 0.02 step\nwalk later step\n' >"$work/keys.txt"
noh build "$work/walk.bvh" -o "$work/x.noh" --events "$work/keys.txt"
expect 1 'a callback key without a time'
says 'line 2'
check 'no pack was left' test ! -e "$work/x.noh"

# ---- sync markers ----

printf 'walk 0 left marker\nwalk 0.05 right marker\nwalk 0.1 step 7\n' >"$work/keys.txt"
noh build "$work/walk.bvh" -o "$work/keys.noh" --events "$work/keys.txt" --quiet
expect 0 'keys and markers'
noh clip "$work/keys.noh"
check 'clip lists both' grep -q "0.0500 s marker 'right'" "$work/out"
noh info "$work/keys.noh"
check 'info lists markers' grep -q "0.0500 s marker 'right'" "$work/out"
check 'info lists callback keys' grep -q "0.1000 s 'step'" "$work/out"
noh info "$work/keys.noh" --json
check 'and both, and joints, as JSON' python3 -c "
import json, sys
j = json.load(open(sys.argv[1]))
c, s = j['clips'][0], j['skeletons'][0]
assert [(e['name'], e['seconds']) for e in c['event_list']] == [('step', 0.1)] and len(c['marker_list']) == 2
assert len(s['joint_list']) == s['joints'] and s['joint_list'][0]['parent'] is None and s['joint_list'][1]['parent']" "$work/out"
printf 'walk 0.1 left marker\n' >"$work/keys.txt"
noh build "$work/walk.bvh" -o "$work/x.noh" --events "$work/keys.txt"
expect 1 'a marker at the end of its clip'
says 'where a loop begins again'
printf 'walk 0.05 left marker\nwalk 0.050001 right marker\n' >"$work/keys.txt"
noh build "$work/walk.bvh" -o "$work/x.noh" --events "$work/keys.txt"
expect 1 'two markers at one time'
says 'has the time of another marker'

# ---- several files ----

cp "$work/walk.bvh" "$work/run.bvh"
noh build "$work/walk.bvh" "$work/run.bvh" -o "$work/both.noh" --quiet
expect 0 'two clips of one skeleton'
noh info "$work/both.noh" --json
check 'are in one pack' sh -c 'test "$(grep -c "\"seconds\"" "$1")" = 2 && grep -q "\"name\": \"run\"" "$1"' - "$work/out"
sed 's/knee/shin/' "$work/walk.bvh" >"$work/shin.bvh"
noh build "$work/walk.bvh" "$work/shin.bvh" -o "$work/x.noh"
expect 1 'a clip of another skeleton'
says "walk.bvh: joint 1 is 'shin' here and 'knee' there"
check 'and names the file' grep -q '^noh: .*shin.bvh: ' "$work/err"

mask=$build/mask.glb
noh build "$work/walk.bvh" "$mask" -o "$work/x.noh"
expect 1 'a walk for a mask: the model is the first with meshes, wherever it stands'
says 'mask.glb has none'
check 'and names the walk' grep -q '^noh: .*walk.bvh: ' "$work/err"

# ---- mesh and clips apart ----

noh build "$mask" -o "$work/mesh.noh" --plain --wrinkles face --only mesh --quiet
expect 0 'a mesh pack'
noh build "$mask" -o "$work/anim.noh" --plain --only anim --quiet
expect 0 'an animation pack'
noh dump "$build/mask.noh" -o "$work/whole.obj" --clip speak --time 1.2
expect 0 'dump of a clip'
noh dump "$work/mesh.noh" -o "$work/apart.obj" --anim "$work/anim.noh" --clip speak --time 1.2
expect 0 'dump of a clip of another pack'
check 'is the same' cmp "$work/whole.obj" "$work/apart.obj"
noh dump "$work/mesh.noh" -o "$work/rest.obj"
check 'and is not the rest pose' sh -c '! cmp -s "$1/rest.obj" "$1/apart.obj"' - "$work"
noh dump "$work/mesh.noh" -o "$work/x.obj" --clip speak
expect 1 'a clip of a pack without clips'
says 'no clip named'
noh dump "$work/mesh.noh" -o "$work/x.obj" --anim "$work/anim.noh" --clip spaek
expect 1 'a clip that is not there'
says "did you mean 'speak'"
noh dump "$work/mesh.noh" -o "$work/x.obj" --anim "$work/walk.noh" --clip walk
expect 1 'an animation pack for another skeleton'
says 'another skeleton'
noh dump "$work/mesh.noh" -o "$work/x.obj" --anim "$work/mesh.noh"
expect 1 'an animation pack without clips'
says 'no clips for'
noh clip "$build/mask.noh" --clip speak --dump "$work/x.rcl"
expect 1 'a clip of weights as .rcl'
says 'animates only floats'

# ---- memory ----

noh verify "$work/mesh.noh" --anim "$work/anim.noh" --instances 7 --json
if [ $code != 0 ] && grep -q 'no GL context' "$work/err"; then
    skip 'budget and verify agree' 'no GL context here'
else
    expect 0 'verify with an animation pack'
    used=$(sed -n 's/.*"cpu_used": \([0-9]*\).*/\1/p' "$work/out")
    noh budget "$work/mesh.noh" --anim "$work/anim.noh" --instances 7 --json
    check "budget predicts what it used ($used)" grep -q "\"cpu_bytes\": $used," "$work/out"
    check 'clips, characters and jobs are parts of it' sh -c 'for p in clips characters jobs; do grep -q "\"name\": \"$p\"" "$1" || exit 1; done' - "$work/out"
fi

clip=$assets/clips/Knight__Walking_A.rcl
if [ -f "$clip" ]; then
    noh build "$clip" -o "$work/a.noh" --quiet
    expect 0 'a real clip'
    noh build "$clip" -o "$work/b.noh" --quiet --error-cm 0.1 --shell-cm 10
    check 'a looser bound is smaller' sh -c 'test "$(wc -c <"$1/b.noh")" -lt "$(wc -c <"$1/a.noh")"' - "$work"
    noh build "$clip" -o "$work/b.noh" --quiet
    check 'the same bytes every time' cmp "$work/a.noh" "$work/b.noh"
else
    skip 'a real clip' 'no clips/Knight__Walking_A.rcl in NOH_ASSETS'
fi
finish
