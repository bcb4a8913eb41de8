#!/bin/sh
# What noh build chooses for a face: eyes, lips, folds, LOD levels; what --plain and an option that is given leave of it;
# what other models get; eyes that are not found.
. "$(dirname "$0")/lib.sh"

# A sheet with two balls in front of it: of HEIGHT times their width, with both lids and the jaw moved. Its material is not
# skin, whose hollows become dark unless --plain is given.
sheet() { # HEIGHT LEFT RIGHT JAW
    awk -v height="$1" -v left="$2" -v right="$3" -v jaw="$4" 'BEGIN {
        print "mtllib face.mtl\nusemtl paper"
        for (y = 0; y < 9; y++) for (x = 0; x < 9; x++) {
            px = (x - 4) * 0.02; py = (y - 4) * 0.025; pz = 0
            if (py > 0.02) pz = px > 0 ? left : px < 0 ? right : 0
            if (py < -0.03) py -= jaw
            printf "v %.4f %.4f %.4f\nvt %.3f %.3f\n", px, py, pz, x / 8, y / 8
        }
        for (e = -1; e < 2; e += 2) for (i = 0; i < 6; i++) for (k = 0; k < 8; k++) {
            a = 0.3 + i * 0.5; b = k * 0.785398
            printf "v %.5f %.5f %.5f\nvt 0.5 0.5\n", e * 0.03 + 0.012 * sin(a) * cos(b),
                0.03 + height * 0.012 * cos(a), 0.02 + 0.012 * sin(a) * sin(b)
        }
        for (y = 0; y < 8; y++) for (x = 0; x < 8; x++) quad(9 * y + x + 1, 9 * y + x + 2, 9 * y + x + 11, 9 * y + x + 10)
        for (e = 0; e < 2; e++) for (i = 0; i < 5; i++) for (k = 0; k < 8; k++) {
            n = 82 + 48 * e + 8 * i; j = (k + 1) % 8
            quad(n + k, n + j, n + 8 + j, n + 8 + k)
        }
    }
    function quad(a, b, c, d) { printf "f %d/%d %d/%d %d/%d %d/%d\n", a, a, b, b, c, c, d, d }'
}
targets() { # HEIGHT: the head and a folder of its targets
    rm -rf "$work/shapes" && mkdir "$work/shapes"
    sheet "$1" 0 0 0 >"$work/head.obj"
    sheet "$1" 0.004 0 0 >"$work/shapes/eyeBlinkLeft.obj"
    sheet "$1" 0 0.004 0 >"$work/shapes/eyeBlinkRight.obj"
    sheet "$1" 0 0 0.01 >"$work/shapes/jawOpen.obj"
}
face() { noh build "$work/head.obj" --targets "$work/shapes" -o "$work/face.noh" "$@"; }
joints() { grep -q "skin 'face': 3 joints" "$work/told"; }
levels() { grep -c '^  level ' "$work/told"; }
told() { "$build/noh" info "$work/face.noh" >"$work/told"; }

printf 'newmtl paper\nKd 1 0.8 0.7\n' >"$work/face.mtl"
targets 1
face
expect 0 'a face'
check 'says what turns its eyes' grep -q '^eyes: two joints turn them' "$work/out"
check 'and what its lips lack' grep -q "^lips: no target brings them to the teeth: mesh '.*': its lips" "$work/out"
check 'and that levels would take too long' grep -q '^LOD: no levels' "$work/out"
check 'without a warning' sh -c '! grep "^warning" "$1"' - "$work/out"
told
check 'the joints are there' joints
check 'and no light transfer, which takes too long unasked' sh -c '! grep transfer "$1"' - "$work/told"
face --plain
expect 0 '--plain'
check 'does not speak of them' sh -c '! grep "^eyes:\|^lips:\|^LOD:" "$1"' - "$work/out"
told
check 'and there are no joints' sh -c '! grep "^skin" "$1"' - "$work/told"
cp "$work/face.noh" "$work/plain.noh"
face --plain --eyes
told
check '--plain with an option has that' joints

# A picture takes longer than levels.
noh render "$build/demo/puppet.noh" -o "$work/paper.png" --size 512x512
printf 'newmtl paper\nmap_Kd paper.png\n' >"$work/face.mtl"
face
check 'with a texture it gets levels' grep -q '^LOD: 3 levels by --lod-fast, [1-9][0-9]* % more work' "$work/out"
told
check 'they are there' test "$(levels)" = 3
face --lod 2
check 'an option wins' sh -c '! grep "^LOD:" "$1"' - "$work/out"
told
check 'with as many levels' test "$(levels)" = 2
face --lod 1
told
check 'or none' test "$(levels)" = 0

# Eyes that are no balls: a warning where nothing else turns them, and the face without joints.
printf 'newmtl paper\nKd 1 0.8 0.7\n' >"$work/face.mtl"
targets 0.4
face
expect 0 'a face with flat eyes'
check 'warns of them' grep -q '^warning: eyes get no joints, and nothing turns them: ' "$work/out"
cp "$work/face.noh" "$work/flat.noh"
face --plain
check 'and is what --plain makes' cmp "$work/flat.noh" "$work/face.noh"
for side in Left Right; do
    for way in Out In; do sheet 0.4 0.001 0 0 >"$work/shapes/eyeLook$way$side.obj"; done
done
face
check 'targets may turn them' grep -q '^eyes: targets turn them' "$work/out"
check 'then there is no warning' sh -c '! grep "^warning" "$1"' - "$work/out"
face --eyes
expect 1 'asked for, eyes have to be found'

sheet 0.4 0 0 0.002 >"$work/shapes/viseme_FF.obj"
face
check 'a shape for f that the artist made stays' grep -q "^lips: a target of the model's own shows f and v" "$work/out"

# What does not blink and open its mouth is no face.
rm "$work/shapes/eyeBlinkLeft.obj"
face
check 'one that does not blink gets nothing' sh -c '! grep "^eyes:\|^lips:\|^LOD:" "$1"' - "$work/out"
noh build "$build/demo/arm.glb" -o "$work/arm.noh" --quiet
noh build "$build/demo/arm.glb" -o "$work/arm_plain.noh" --plain --quiet
check 'nor does an arm' cmp "$work/arm.noh" "$work/arm_plain.noh"

# A whole face: the mask.
noh build "$build/mask.glb" -o "$work/face.noh" --only mesh
expect 0 'the mask'
check 'has lips for f and v' grep -q '^lips: they meet the teeth' "$work/out"
told
check 'joints for its eyes' joints
check 'the target of its lips' grep -q '^    lipToTeeth ' "$work/told"
check 'folds' grep -q '^wrinkle\|wrinkles' "$work/told"

# Clips of a build of their own fit it, with the target of its lips or without.
printf 'Timecode,BlendshapeCount,JawOpen\n00:00:00:00,1,0\n00:00:00:30,1,1\n00:00:01:00,1,1\n' >"$work/take.csv"
noh build "$build/mask.glb" "$work/take.csv" -o "$work/take.noh" --only anim
expect 0 'clips apart'
noh render "$work/face.noh" -o "$work/rest.png" --size 64x64 --anim "$work/take.noh" --clip take --time 0
noh render "$work/face.noh" -o "$work/open.png" --size 64x64 --anim "$work/take.noh" --clip take --time 1
expect 0 'play on it'
check 'and move it' sh -c '! cmp -s "$1" "$2"' - "$work/rest.png" "$work/open.png"
finish
