#!/bin/sh
# noh build FACE TAKE.csv: facial capture moves the targets that mean the same, at the right times.
. "$(dirname "$0")/lib.sh"

# Targets that move a triangle by 1 along x, y and z.
model() { # NAME TARGETS
    printf '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"face","mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1},{"POSITION":2},{"POSITION":3}]}],"extras":{"targetNames":[%s]}}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3","min":[1,0,0],"max":[1,0,0]},{"bufferView":2,"componentType":5126,"count":3,"type":"VEC3","min":[0,1,0],"max":[0,1,0]},{"bufferView":3,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,1],"max":[0,0,1]}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},{"buffer":0,"byteOffset":72,"byteLength":36},{"buffer":0,"byteOffset":108,"byteLength":36}],"buffers":[{"byteLength":144,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAACAPwAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"}]}' "$2" >"$work/$1.gltf"
}
build() { # MODEL CSV
    noh build "$work/$1.gltf" "$work/$2.csv" -o "$work/$2.noh"
    expect 0 "build $1 $2"
}
# How far the mesh is moved, to a hundredth.
shows() { # CSV TIME WANTED
    noh dump "$work/$1.noh" -o "$work/$1.obj" --clip "$1" --time "$2"
    is=$(awk '$1 == "v" { x += $2 / 3; y += $3 / 3; z += $4 / 3 } END { printf "%.2f %.2f %.2f\n", x - 1 / 3, y - 1 / 3, z }' "$work/$1.obj" | sed 's/-0\.00/0.00/g')
    check "$1 at $2 s is $3, and it is $is" test "$is" = "$3"
}
warns() { # TEXT
    check "it warns: $1" grep -qF -- "$1" "$work/out"
}

# As Live Link Face writes it: over midnight, with a row without a face and a damaged one.
model face '"eyeBlink_L","Mouth_Smile","TongueOut"'
cat >"$work/take.csv" <<'END'
Timecode,BlendShapeCount,EyeBlinkLeft,MouthSmileLeft,MouthSmileRight,TongueOut,BrowInnerUp,HeadYaw
23:59:59:58.000,6,0,0,0,0,0,0.1
23:59:59:59.000,6,0.1,0,0,0,0,0.1
00:00:00:00.000,0,,,,,,
00:00:00:02.000,6,0.4,0.2,0.6,1,0,0.1
00:00:00:03.000,6,0.9,?,0.6,1,0,0.1
00:00:00:04.000,6,0.8,0.2,0.6,1,0,0.1
00:00:00:04.000,6,0.3,0.2,0.6,1,0,0.1
END
build face take
warns 'column HeadYaw was left out'
warns '2 rows were left out: a number is missing or damaged, or the time does not rise (line 6)'
warns "has no target 'browInnerUp': 1 of 5 shapes were left out"
shows take 0 '0.00 0.00 0.00'
shows take 0.033333 '0.20 0.13 0.33'
shows take 0.066667 '0.40 0.40 1.00'
shows take 0.083333 '0.60 0.40 1.00'
noh info "$work/take.noh" --json
check 'it lasts 6 frames at 60 Hz' grep -q '"seconds": 0.1' "$work/out"

# A VRM animation moves the expressions of a VRM: a preset by its channel, an author's own by its name.
model person '"Joy","LidL","c"'
sed 's/^{/{"extensionsUsed":["VRMC_vrm"],"extensions":{"VRMC_vrm":{"specVersion":"1.0","expressions":{"preset":{"happy":{"morphTargetBinds":[{"node":0,"index":0,"weight":0.5}]}},"custom":{"Wink":{"morphTargetBinds":[{"node":0,"index":1,"weight":1}]}}}}},/' \
    "$work/person.gltf" >"$work/person.new" && mv "$work/person.new" "$work/person.gltf"
keys=$(printf '\0\0\0\0\0\0\200\77\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0\0\0\0\0' | base64)
cat >"$work/mood.gltf" <<END
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],"nodes":[{"name":"hips"},{"name":"one"},{"name":"two"}],
"extensionsUsed":["VRMC_vrm_animation"],"extensions":{"VRMC_vrm_animation":{"specVersion":"1.0","humanoid":{"humanBones":{"hips":{"node":0}}},
"expressions":{"preset":{"happy":{"node":1},"angry":{"node":7}},"custom":{"Wink":{"node":2}}}}},
"animations":[{"name":"mood","samplers":[{"input":0,"output":1}],"channels":[{"sampler":0,"target":{"node":1,"path":"translation"}},{"sampler":0,"target":{"node":2,"path":"translation"}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},{"bufferView":1,"componentType":5126,"count":2,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":8},{"buffer":0,"byteOffset":8,"byteLength":24}],
"buffers":[{"byteLength":32,"uri":"data:application/octet-stream;base64,$keys"}]}
END
noh build "$work/person.gltf" "$work/mood.gltf" -o "$work/mood.noh"
expect 0 'a VRM and an animation'
warns "VRM expression 'angry': its animation was left out: its node does not exist"
shows mood 1 '0.50 1.00 0.00'
shows mood 0.5 '0.25 0.50 0.00'

# Seconds, other separators and a decimal comma, a face that has no such targets.
printf 'time;jaw_open;mouthSmileLeft\r\n0.50;0;0\r\n0,54;0,5;0\r\n0.58;1;0\r\n' >"$work/seconds.csv"
model jaw '"jawOpen","a","b"'
build jaw seconds
shows seconds 0.04 '0.50 0.00 0.00'
model other '"a","b","c"'
build other seconds
warns 'has no target for its 2 shapes'
noh build "$work/seconds.csv" -o "$work/alone.noh"
expect 0 'build a take alone'
noh info "$work/alone.noh"
check 'which has its scalars' grep -q "clip 'seconds': 0.080 s, 0 joints, 2 floats" "$work/out"

# One shape under two names moves once, as does one whose motion another target has, too.
model twice '"eyeBlinkLeft","Eye_Blink_L","TongueOut"'
sed 's/{"POSITION":2}/{"POSITION":1}/' "$work/twice.gltf" >"$work/alike.gltf"
printf 'Time,EyeBlinkLeft,TongueOut\n0,0,0\n1,1,1\n' >"$work/wink.csv"
build alike wink
shows wink 1 '1.00 0.00 1.00'
build twice wink # targets that move differently add up
shows wink 1 '1.00 1.00 1.00'

# A long silence is said.
printf 'Time,JawOpen\n0,0\n0.1,0\n0.2,0\n1.2,1\n' >"$work/gap.csv"
build jaw gap
warns 'for up to 1 s there is no face, and weights are interpolated'
shows gap 0.7 '0.50 0.00 0.00'

refuses() { # NAME TEXT
    noh build "$work/face.gltf" "$work/$1.csv" -o "$work/$1.noh"
    expect 1 "$1 is refused"
    says "$2"
}
printf 'price,count\n1,2\n' >"$work/shop.csv"
refuses shop 'no column is named as a shape of ARKit'
printf 'EyeBlinkLeft\n0\n' >"$work/timeless.csv"
refuses timeless 'no column is named Timecode or Time'
printf 'Timecode,EyeBlinkLeft\n1:2:3,0\n' >"$work/short.csv"
refuses short 'no row has a time and a weight for each shape'
: >"$work/empty.csv"
refuses empty 'this is an empty file'
printf 'Time,EyeBlinkLeft\n0,0\n0.01,0\n0.02,0\n100000,0\n' >"$work/long.csv"
refuses long 'and the limit is'

finish
