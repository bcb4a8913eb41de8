#!/bin/sh
# Skeletons as pictures: render and sheet of a pack of clips only; two clips at once.
. "$(dirname "$0")/lib.sh"

bvh() { # NAME SECOND-FRAME-OF-THE-KNEE
    cat >"$work/$1.bvh" <<BVH
HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT knee
  {
    OFFSET 0 -10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT foot
    {
      OFFSET 0 -10 0
      CHANNELS 3 Zrotation Xrotation Yrotation
      End Site
      {
        OFFSET 0 0 4
      }
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.0333333
0 20 0 0 0 0 0 0 0 0 0 0
1 20 0 5 0 0 $2 0 0 0 0 0
0 20 0 0 0 0 0 0 0 0 0 0
BVH
}
bvh walk 25
bvh kick 80
noh build "$work/walk.bvh" "$work/kick.bvh" -o "$work/leg.noh" --quiet
expect 0 'two clips of one skeleton'
sed 's/knee/knie/' "$work/kick.bvh" >"$work/knie.bvh"
for option in "kick.bvh --events" "knie.bvh --rename" "knie.bvh --retarget"; do # the message begins with a clip's file
    noh build "$work/walk.bvh" "$work/"$option "$work/none.txt" -o "$work/bad.noh"
    expect 1 "$option without its file"
    says "No such file or directory ($work/none.txt)"
done
printf 'wlk 0.1 step\n' >"$work/wrong.txt"
noh build "$work/walk.bvh" -o "$work/bad.noh" --events "$work/wrong.txt"
expect 1 'a clip that is not there'
says "($work/wrong.txt, line 1)"

# Where a recording faces, and what its rest pose is. This one faces +x: its left is at -z.
cat >"$work/sides.bvh" <<'END'
HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT LeftLeg
  {
    OFFSET 0 -40 -10
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -40 0
    }
  }
  JOINT RightLeg
  {
    OFFSET 0 -40 10
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -40 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0333333
0 80 0 0 0 -90 0 0 0 0 0 0
0 80 5 0 0 -90 0 0 0 0 0 0
END
noh build "$work/sides.bvh" -o "$work/x.noh" --facing auto
expect 0 'a recording that faces +x'
check 'is turned to +z' grep -q '^turned by -90.0 degrees to face +z$' "$work/out"
noh build "$work/sides.bvh" -o "$work/x.noh" --facing auto --rest first-frame
expect 0 'whose first frame faces +z'
check 'and needs no turn by it' grep -q '^turned by -*0.0 degrees' "$work/out"
noh build "$work/sides.bvh" -o "$work/turned.noh" --facing -90
expect 0 'by degrees'
check 'it is another skeleton' sh -c '! cmp -s "$1" "$2"' - "$work/x.noh" "$work/turned.noh"
noh build "$work/walk.bvh" -o "$work/x.noh" --facing auto
expect 1 'no joint is left or right'
says 'give --facing DEG'

# A body that does not face +z is shown from its own front: left and right and both feet tell where that is.
awk 'function joint(name, x, y, z, below) {
        print "JOINT " name "\n{\nOFFSET " x, y, z "\nCHANNELS 3 Zrotation Xrotation Yrotation"
        if (!below) print "End Site\n{\nOFFSET 0 0 4\n}\n}"
        count++
    }
    BEGIN {
        print "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
        for (i = 0; i < 2; i++) {
            side = i ? "Right" : "Left"
            x = i ? -1 : 1
            joint(side "UpLeg", 10 * x, -5, 0, 1); joint(side "Leg", 0, -40, 2, 1)
            joint(side "Foot", 0, -40, -2, 1); joint(side "Toes", 2 * x, -5, 14, 0)
            print "}\n}\n}"
            joint(side "Arm", (i ? 15 : 20) * x, 50, 0, 1); joint(side "Hand", 50 * x, 0, 0, 0)
            print "}"
        }
        print "}\nMOTION\nFrames: 1\nFrame Time: 0.0333333"
        line = "0 90 0"
        for (i = 0; i <= count; i++) line = line " 0 0 0"
        print line
    }' >"$work/body.bvh"
for way in 0 90 180 -90; do
    noh build "$work/body.bvh" -o "$work/body$way.noh" --facing "$way"
    noh render "$work/body$way.noh" -o "$work/body$way.png" --camera full,30,5 --size 128x128
    expect 0 "a body that faces $way degrees"
    check 'is shown from its front' "$build/tests/gl/picture_diff" "$work/body0.png" "$work/body$way.png" 1 0.02
    noh render "$work/body$way.noh" -o "$work/full$way.png" --camera full --size 128x128
    check 'as large' "$build/tests/gl/picture_diff" "$work/full0.png" "$work/full$way.png" 1 0.02
done
noh render "$work/body0.noh" -o "$work/plain0.png" --camera 30,5 --size 128x128
noh render "$work/body180.noh" -o "$work/plain180.png" --camera 30,5 --size 128x128
check 'a direction alone is of the axes' sh -c '! "$1" "$2" "$3" 1 0.02 >/dev/null' - "$build/tests/gl/picture_diff" "$work/plain0.png" "$work/plain180.png"

# Sixty frames of an arm that swings, which is elsewhere for one frame and held for five.
awk 'BEGIN {
    print "HIERARCHY\nROOT Hips\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
    print " JOINT Arm\n {\n  OFFSET 0 60 0\n  CHANNELS 3 Zrotation Xrotation Yrotation\n  End Site\n  {\n   OFFSET 0 30 0\n  }\n }"
    print " JOINT Foot\n {\n  OFFSET 0 -80 0\n  CHANNELS 3 Zrotation Xrotation Yrotation\n  End Site\n  {\n   OFFSET 0 0 15\n  }\n }\n}"
    print "MOTION\nFrames: 60\nFrame Time: 0.0166667"
    for (i = 0; i < 60; i++) {
        at = 40 * sin(i / 8)
        if (i >= 40 && i < 45) at = 40 * sin(39 / 8)
        print 0, 80, 0, 0, 0, 0, i == 20 ? 170 : at, 0, 0, 0, 0, 0
    }
}' >"$work/swing.bvh"
noh build "$work/swing.bvh" -o "$work/swing.noh"
expect 0 'a recording with gaps'
check 'not reported without --clean' sh -c '! grep -q clean "$1"' - "$work/out"
noh build "$work/swing.bvh" -o "$work/clean.noh" --clean all
expect 0 'cleaned up'
check 'both gaps are filled' grep -q "^clean 'swing': filled 2 gaps in 1 tracks, the longest of 0.083 s; left 0 longer" "$work/out"
check 'its foot, which never moves, makes it go nowhere' grep -q "^clean 'swing': the root moves 0.0 cm" "$work/out"
noh build "$work/swing.bvh" -o "$work/x.noh" --clean gaps
check 'gaps alone give the same pack' cmp -s "$work/x.noh" "$work/clean.noh"
# ---- footsteps ----

awk 'BEGIN { # two legs that are lifted in turn
    print "HIERARCHY\nROOT hips\n{\nOFFSET 0 90 0\nCHANNELS 3 Xposition Yposition Zposition"
    print "JOINT head\n{\nOFFSET 0 80 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 10 0\n}\n}"
    for (side = 1; side >= -1; side -= 2) {
        print "JOINT " (side > 0 ? "Left" : "Right") "Foot\n{\nOFFSET", 10 * side, "-85 0"
        print "CHANNELS 3 Xposition Yposition Zposition\nEnd Site\n{\nOFFSET 0 -5 12\n}\n}"
    }
    print "}\nMOTION\nFrames: 121\nFrame Time: 0.0166667"
    for (i = 0; i <= 120; i++) {
        up = 15 * sin(3.14159265 * (i % 30) / 30)
        is_left = i % 60 < 30
        print 0, 90, 0, 0, 0, 0, 10, -85 + (is_left ? up : 0), 0, -10, -85 + (is_left ? 0 : up), 0
    }
}' >"$work/march.bvh"
printf 'march 0.25 shout\n' >"$work/march.txt"
noh build "$work/march.bvh" -o "$work/march.noh" --clean contact-keys --events "$work/march.txt"
expect 0 'callback keys of footsteps'
check 'two steps a foot' grep -q "^clean 'march': 4 callback keys where 2 feet come down" "$work/out"
noh info "$work/march.noh" --json
check 'in ticks where each comes down, with the keys of a file' python3 -c "
import json, sys
keys = json.load(open(sys.argv[1]))['clips'][0]['event_list']
times = {n: [e['seconds'] for e in keys if e['name'] == n] for n in ('left_foot', 'right_foot', 'shout')}
want = {'left_foot': [0.5, 1.5], 'right_foot': [0.0, 1.0], 'shout': [0.25]}
for name, at in want.items():
    assert len(times[name]) == len(at), times
    for a, b in zip(sorted((t + 0.1) % 2 - 0.1 for t in times[name]), at): assert abs(a - b) < 0.04, times
assert len(keys) == 5" "$work/out"
noh build "$work/sides.bvh" -o "$work/x.noh" --clean contact-keys
expect 0 'none to be found'
check 'is a warning' grep -q "^warning: clip 'sides'" "$work/out"
noh build "$work/sides.bvh" -o "$work/x.noh" --clean contact-keys --warnings
check 'which --warnings prints, too' grep -q "^warning: clip 'sides'" "$work/err"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$work/flat.obj"
noh build "$work/flat.obj" -o "$work/x.noh" --clean contact-keys
expect 1 'footsteps without a clip'
says 'needs a clip that moves joints'
noh build "$work/march.bvh" -o "$work/x.noh" --clean contact-keys --only mesh
expect 2 'footsteps of a mesh alone'

for ending in c3d trc; do
    echo markers >"$work/markers.$ending"
    noh build "$work/markers.$ending" -o "$work/x.noh"
    expect 1 "markers: .$ending"
    says "this is not a .$ending file"
done
for refused in '--facing left' '--facing 361' '--rest last' '--clean gap' '--clean gaps,'; do
    # shellcheck disable=SC2086
    noh build "$work/sides.bvh" -o "$work/x.noh" $refused
    expect 2 "build $refused"
done

noh render "$work/leg.noh" -o "$work/rest.png" --size 96x64
if [ $code != 0 ] && grep -q 'no GL context' "$work/err"; then
    skip 'bones' 'no GL context here'
    finish
fi
expect 0 'a pack without meshes shows its bones'
noh render "$work/leg.noh" -o "$work/walk.png" --size 96x64 --clip walk --time 0.033
expect 0 'in a clip'
check 'they move' sh -c '! cmp -s "$1" "$2"' - "$work/rest.png" "$work/walk.png"
noh render "$work/leg.noh" -o "$work/x.png" --clip kcik
expect 1 'a clip that is not there'
says "did you mean 'kick'"
noh render "$build/mask.noh" -o "$work/x.png" --bones
expect 1 'bones of a pack without a skeleton'
says 'no skeleton to draw'
check 'leave no file' test ! -e "$work/x.png"

noh sheet "$work/leg.noh" -o "$work/sheet.png" --clip walk --tiles 4 --tile 64
expect 0 'sheet of a clip'
noh sheet "$work/leg.noh" -o "$work/blend.png" --clip walk --blend kick --tiles 2 --tile 64
expect 0 'sheet of a blend'
check 'with a row for each weight' test "$(od -An -tu1 -j20 -N4 "$work/blend.png" | awk '{ print $3 * 256 + $4 }')" = 320
for how in fade inertia; do
    noh sheet "$work/leg.noh" -o "$work/$how.png" --clip walk --to kick --transition $how --over 0.02 --tiles 8 --tile 64
    expect 0 "sheet of a transition by $how"
done
check 'fade and inertia differ' sh -c '! cmp -s "$1" "$2"' - "$work/fade.png" "$work/inertia.png"
noh sheet "$work/leg.noh" -o "$work/x.png" --blend kick
expect 2 'a blend without a clip is a usage error'
noh sheet "$work/leg.noh" -o "$work/x.png" --clip walk --to kick --blend kick
expect 2 'a blend and a transition is one'
noh sheet "$work/leg.noh" -o "$work/x.png" --clip walk --to kick --transition jump
expect 2 'so is an unknown transition'

# Clips of one humanoid on another: by names, by a file, and what a file gets wrong.
if [ -d "${NOH_ASSETS:-}/clips" ]; then
    clips=$NOH_ASSETS/clips
    noh build "$clips/Knight__Idle.rcl" "$clips/RobotExpressive__Walking.rcl" --retarget auto -o "$work/two.noh"
    expect 0 'a walk of a robot on a knight'
    check 'says how it came over' grep -q "^retargeted 'RobotExpressive__Walking': 1[0-9] bones, sizes x 0.2" "$work/out"
    check 'no foot slides' grep -q 'feet slide 0.0[0-9] %' "$work/out"
    noh build "$clips/Knight__Idle.rcl" "$clips/RobotExpressive__Walking.rcl" -o "$work/unasked.noh"
    expect 0 'without the option'
    check 'warns that the skeleton is another' grep -q '^warning: .*Walking.rcl: its skeleton is another one' "$work/out"
    check 'and makes the same' cmp "$work/two.noh" "$work/unasked.noh"
    noh build "$clips/Knight__Idle.rcl" "$clips/Fox__Walk.rcl" -o "$work/x.noh"
    expect 1 'a fox on a knight'
    noh info "$work/two.noh"
    check 'both clips move the knight' test "$(grep -c '^clip ' "$work/out")" -eq 2
    printf 'hips Hips hips\nleftArm a b\n' >"$work/bones.txt"
    noh build "$clips/Knight__Idle.rcl" "$clips/RobotExpressive__Walking.rcl" --retarget "$work/bones.txt" -o "$work/x.noh"
    expect 1 'a file of bones that names an unknown bone'
    check 'names line and word' grep -q "'leftArm' is no bone: .*bones.txt, line 2)" "$work/err"
fi
finish
