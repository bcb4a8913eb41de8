#!/bin/sh
# small_glb.sh: prints a .glb of three vertices on two joints, with a target and a clip: a seed for fuzzers.
set -eu
text='{"asset":{"version":"2.0"},"buffers":[{"byteLength":200}],"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36},{"buffer":0,"byteOffset":72,"byteLength":48},{"buffer":0,"byteOffset":120,"byteLength":12},{"buffer":0,"byteOffset":132,"byteLength":8},{"buffer":0,"byteOffset":140,"byteLength":8},{"buffer":0,"byteOffset":148,"byteLength":32}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[0,0,1]},{"bufferView":2,"componentType":5126,"count":3,"type":"VEC4"},{"bufferView":3,"componentType":5121,"count":3,"type":"VEC4"},{"bufferView":4,"componentType":5123,"count":3,"type":"SCALAR"},{"bufferView":5,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},{"bufferView":6,"componentType":5126,"count":2,"type":"VEC4"}],"meshes":[{"name":"m","extras":{"targetNames":["up"]},"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":2},"indices":4,"targets":[{"POSITION":1}]}]}],"nodes":[{"name":"a","children":[1]},{"name":"b","translation":[0,1,0]},{"mesh":0,"skin":0}],"skins":[{"joints":[0,1]}],"animations":[{"name":"turn","channels":[{"sampler":0,"target":{"node":1,"path":"rotation"}}],"samplers":[{"input":5,"output":6}]}],"scenes":[{"nodes":[0,2]}],"scene":0}'
while [ $((${#text} % 4)) != 0 ]; do text="$text "; done
word() { # a little-endian word
    printf "\\$(printf %o $(($1 & 255)))\\$(printf %o $(($1 >> 8 & 255)))\\$(printf %o $(($1 >> 16 & 255)))\\$(printf %o $(($1 >> 24 & 255)))"
}
floats() { # 0, 1 and h (a half of the square root of 2)
    for f in "$@"; do
        case $f in 0) printf '\0\0\0\0' ;; 1) printf '\0\0\200\77' ;; h) printf '\363\4\65\77' ;; esac
    done
}
printf glTF
word 2
word $((12 + 8 + ${#text} + 8 + 200))
word ${#text}
printf 'JSON%s' "$text"
word 200
printf 'BIN\0'
floats 0 0 0 1 0 0 0 1 0         # positions
floats 0 0 0 0 0 0 0 0 1         # the target
floats 1 0 0 0 1 0 0 0 h h 0 0   # weights
printf '\0\1\0\0\0\1\0\0\0\1\0\0' # joints
printf '\0\0\1\0\2\0\0\0'        # triangle
floats 0 1                       # times
floats 0 0 0 1 0 0 h h           # rotations
printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0'
