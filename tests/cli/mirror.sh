#!/bin/sh
# Mirrors: in a dump, triangles of mirroring nodes face in the direction of their normals; clips that mirror give a warning.
. "$(dirname "$0")/lib.sh"

# A triangle that faces +z, drawn by a node as it is and by one that mirrors.
model() { # NAME SCALE
    printf '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"mesh":0,"translation":[3,0,0],"scale":%s}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}' "$2" >"$work/$1.gltf"
    noh build "$work/$1.gltf" -o "$work/$1.noh"
    expect 0 "build with a scale of $2"
}

# Prints how each triangle faces along z, and its first corner's normal.
facing='
    $1 == "v" { nv++; x[nv] = $2; y[nv] = $3 }
    $1 == "vn" { nn++; n[nn] = $4 }
    $1 == "f" {
        split($2, a, "/"); split($3, b, "/"); split($4, c, "/")
        i = a[1]; j = b[1]; k = c[1]
        area = (x[j] - x[i]) * (y[k] - y[i]) - (x[k] - x[i]) * (y[j] - y[i])
        printf "%s%d %d", sep, (area > 0 ? 1 : -1), (n[a[3]] > 0 ? 1 : -1); sep = ", "
    }'

for case in 'x [-1,1,1] 1' 'y [1,-2,1] 1' 'z [1,1,-1] -1' 'all [-1,-1,-1] -1' 'two [-1,-1,1] 1'; do
    set -- $case
    model "$1" "$2"
    noh dump "$work/$1.noh" -o "$work/$1.obj"
    expect 0 "dump with a scale of $2"
    check "a scale of $2 faces $3" test "$(awk "$facing" "$work/$1.obj")" = "1 1, $3 $3"
done

# A clip whose last key has another scale.
clip() { # NAME BUFFER MATERIAL
    printf '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"n","mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{%s}],"animations":[{"name":"turn","samplers":[{"input":1,"output":2}],"channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},{"buffer":0,"byteOffset":44,"byteLength":24}],"buffers":[{"byteLength":68,"uri":"data:application/octet-stream;base64,%s"}]}' "$3" "$2" >"$work/$1.gltf"
    noh build "$work/$1.gltf" -o "$work/$1.noh"
    expect 0 "build a clip that scales: $1"
}
one=AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAIA/AACAPwAAgD8AAIC/AACAPwAAgD8=
two=AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAIA/AACAPwAAgD8AAIC/AACAvwAAgD8=
warned="clip 'turn': it mirrors joint 'n' by a scale below 0"
clip mirror "$one" ''
check 'a clip that mirrors is warned of' grep -qF "$warned" "$work/out"
clip half-turn "$two" ''
check 'but not one that mirrors twice' sh -c '! grep -q mirrors "$1"' - "$work/out"
clip both-sides "$one" '"doubleSided":true'
check 'or shows both sides' sh -c '! grep -q mirrors "$1"' - "$work/out"

finish
