#!/bin/sh
# Targets, joints and materials by the names that exporters give them: what `noh face` finds, --names, units.
. "$(dirname "$0")/lib.sh"

# model FILE SCALE NAME...: a triangle with a target for each name, and a material of two eyes 0.063 SCALE apart
model() {
    file=$1 scale=$2 names= targets= count=0
    shift 2
    for name in "$@"; do
        names="$names${names:+,}\"$name\"" targets="$targets${targets:+,}{\"POSITION\":1}" count=$((count + 1))
    done
    cat >"$file" <<END
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[$scale,$scale,$scale]}],
"buffers":[{"uri":"p.bin","byteLength":108}],"bufferViews":[{"buffer":0,"byteLength":108}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":0,"byteOffset":72,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"materials":[{"name":"Std_Eye_L"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0,"targets":[$targets]}],
"extras":{"targetNames":[$names]}}]}
END
}
# Vertices 0 0 0, 1 0 0, 0 1 0; deltas; the same again.
triangle='\000\000\000\000\000\000\000\000\000\000\000\000\000\000\200\077\000\000\000\000\000\000\000\000\000\000\000\000\000\000\200\077\000\000\000\000'
printf "$triangle$triangle$triangle" >"$work/p.bin"

# shows CHANNEL WORDS: `noh face` has a line of this channel with these words
shows() {
    check "$1: $2" grep -q "^  $1  *[a-z].*$2" "$work/out"
}

model "$work/oculus.gltf" 1 viseme_sil viseme_PP viseme_FF viseme_TH viseme_DD viseme_kk viseme_CH viseme_SS viseme_nn \
    viseme_RR viseme_aa viseme_E viseme_I viseme_O viseme_U jawOpen mouthFunnel
noh face "$work/oculus.gltf"
expect 0 'the fifteen mouth shapes of Oculus'
for shape in PP FF TH DD kk CH SS nn RR aa E; do shows $shape "viseme_$shape 1"; done
shows ih 'viseme_I 1'
shows oh 'viseme_O 1'
shows ou 'viseme_U 1'

model "$work/cc.gltf" 1 Eye_Blink_L Eye_Blink_R Jaw_Open Mouth_Smile_L Mouth_Smile_R Mouth_Dimple_L Mouth_Dimple_R \
    Mouth_Funnel_Up_L Mouth_Funnel_Up_R V_Explosive Brow_Raise_Inner_L
noh face "$work/cc.gltf"
expect 0 "Character Creator's names"
shows blink-left 'Eye_Blink_L 1'
shows blink-right 'Eye_Blink_R 1'
shows joy-mouth 'Mouth_Smile_L 0.8'
shows PP 'V_Explosive 1'
shows aa 'Jaw_Open 0.6'
shows CH 'Mouth_Funnel_Up_L 0.6'

model "$work/vroid.gltf" 1 Face.Fcl_MTH_A Fcl_MTH_I Fcl_MTH_U Fcl_MTH_E Fcl_MTH_O Fcl_EYE_Close_L Fcl_EYE_Close_R Fcl_ALL_Joy
noh face "$work/vroid.gltf"
expect 0 "VRoid's names"
shows ou 'Fcl_MTH_U 1'
shows blink-left 'Fcl_EYE_Close_L 1'
shows joy-upper 'Fcl_ALL_Joy 1'

model "$work/sides.gltf" 1 eyeBlink_L eyeBlink_R mouthSmile_L mouthSmile_R mouthDimple_L mouthDimple_R
noh face "$work/sides.gltf"
shows blink-left 'eyeBlink_L 1'
shows joy-mouth 'mouthSmile_R 0.8'

model "$work/arkit.gltf" 1 eyeBlinkLeft eyeBlinkRight jawOpen
noh build "$work/arkit.gltf" -o "$work/arkit.noh"
expect 0 "ARKit's own names"
noh face "$work/arkit.noh"
check 'need no rows in the pack' sh -c '! grep -q "own recipe" "$1"' - "$work/out"

# ---- a file ----

printf '# of our studio\ntarget aa Schnabel_Auf\ntarget eyeBlink* Zwinker_*\nmaterial skin leder\n' >"$work/our.names"
model "$work/ours.gltf" 1 Schnabel_Auf Zwinker_L Zwinker_R
noh build "$work/ours.gltf" -o "$work/ours.noh" --names "$work/our.names"
expect 0 '--names'
noh face "$work/ours.noh"
shows aa 'Schnabel_Auf 1'
shows blink-right 'Zwinker_R 1'
printf 'target aa\nfoo\n' >"$work/bad.names"
noh build "$work/ours.gltf" -o "$work/bad.noh" --names "$work/bad.names"
expect 1 'a wrong line in it'
says "bad.names: 'foo' is none of target, joint, material and strip (line 2)"
noh build "$work/ours.gltf" -o "$work/bad.noh" --names "$work/missing.names"
expect 1 'a missing file'
says 'missing.names: the file cannot be read'
printf '\377\376t\000' >"$work/wide.names"
noh build "$work/ours.gltf" -o "$work/bad.noh" --names "$work/wide.names"
expect 1 'UTF-16'
says 'wide.names: this is a text in UTF-16: save it as UTF-8'
printf 'target aa Schnabel_Auf\rmaterial skin leder\r' >"$work/cr.names"
noh build "$work/ours.gltf" -o "$work/cr.noh" --names "$work/cr.names"
expect 0 'lines that end with CR'
noh face "$work/cr.noh"
shows aa 'Schnabel_Auf 1'
noh render "$work/our.names" -o "$work/out.png"
expect 1 'it is no model'
says 'noh build MODEL --names FILE'

# ---- joints ----

LC_ALL=C sed 's/"name":"head"/"name":"tete"/' "$build/demo/puppet.glb" >"$work/tete.glb"
check 'the head has another name' sh -c '! cmp -s "$1" "$2"' - "$build/demo/puppet.glb" "$work/tete.glb"
echo 'joint head tete' >"$work/tete.names"
echo 'joint-head tete' >"$work/tete.recipe"
# looks FILE OPTIONS...: a picture of a face that looks to the side
looks() {
    out=$1
    shift
    noh build "$@" -o "$work/looks.noh" --only mesh --quiet
    noh render "$work/looks.noh" -o "$out" --face on --look-at 3,1.5,1 --size 96x96 --camera 0,0,1
    expect 0 "a face that looks aside: $out"
}
looks "$work/head.png" "$build/demo/puppet.glb"
looks "$work/tete.png" "$work/tete.glb"
check 'a head of no known name does not turn' sh -c '! cmp -s "$1" "$2"' - "$work/head.png" "$work/tete.png"
looks "$work/names.png" "$work/tete.glb" --names "$work/tete.names"
check 'one in --names does' cmp "$work/head.png" "$work/names.png"
looks "$work/recipe.png" "$work/tete.glb" --recipe "$work/tete.recipe"
check 'and one in --recipe' cmp "$work/head.png" "$work/recipe.png"
echo 'joint-head nobody' >"$work/tete.recipe"
noh build "$work/tete.glb" -o "$work/looks.noh" --recipe "$work/tete.recipe" --effort 1
check 'a joint that is not there is a warning' grep -q "no skeleton has the joint 'nobody'" "$work/out"

# ---- units ----

# eyes FILE X HEIGHT: two eyes at X and -X, and a body of this height
eyes() {
    printf 'mtllib e.mtl\nusemtl eye\n' >"$1"
    for x in "$2" "-$2"; do printf 'v %s 0 0\nv %s 0.001 0\nv %s 0 0.001\n' "$x" "$x" "$x"; done >>"$1"
    printf 'f 1 2 3\nf 4 5 6\nv 0 0 0\nv 0 %s 0\nv 0 0 1\nusemtl body\nf 7 8 9\n' "$3" >>"$1"
}
printf 'newmtl eye\nnewmtl body\n' >"$work/e.mtl"
eyes "$work/m.obj" 0.0315 1.7
noh build "$work/m.obj" -o "$work/m.noh"
check 'metres' grep -q 'the figure is 1.7 m high, its eyes' "$work/out"
check 'and no word of units' sh -c '! grep -q "more likely" "$1"' - "$work/out"
eyes "$work/cm.obj" 3.15 170
noh build "$work/cm.obj" -o "$work/cm.noh" --unit-cm 100
check 'centimetres' grep -q 'a unit is more likely a centimetre than a metre' "$work/out"
noh build "$work/cm.obj" -o "$work/cm.noh"
check 'which eyes tell' grep -q 'by the distance of its eyes, a unit of the model is 1 cm' "$work/out"
check 'and so is the height' grep -q 'the figure is 1.7 m high' "$work/out"
eyes "$work/dm.obj" 0.315 17
noh build "$work/dm.obj" -o "$work/dm.noh"
check 'decimetres' grep -q 'a unit of the model is 10 cm' "$work/out"
# A doll, a giant, and a figure in hectometres keep their sizes.
for size in '0.005 0.27 0.27' '0.15 8.2 8.2' '0.000315 0.017 0.017'; do
    # shellcheck disable=SC2086
    set -- $size
    eyes "$work/keep.obj" "$1" "$2"
    noh build "$work/keep.obj" -o "$work/keep.noh"
    check "a figure of $3 m keeps its size" grep -q "the figure is $3 m high" "$work/out"
    check 'and no unit is taken' sh -c '! grep -q "by the distance" "$1"' - "$work/out"
done
check 'the last has a warning' grep -q 'more likely a hectometre' "$work/out"
eyes "$work/x.obj" 50 1
noh build "$work/x.obj" -o "$work/x.noh"
check 'eyes wider apart than the model is high are none' sh -c '! grep -q "the figure is" "$1"' - "$work/out"
finish
