#!/bin/sh
# Small files that ask for much: each is converted within seconds, or refused with a message that says what is too
# large, where it is and what to do.
. "$(dirname "$0")/lib.sh"

sh tests/support/small_glb.sh | tail -c 200 >"$work/small.bin"

# gltf FILE MESHES TARGETS NAMES: a triangle in each mesh, with targets whose names are of a kind below
gltf() {
    awk -v meshes="$2" -v targets="$3" -v names="$4" '
    function name(i) {
        if (names == "pairs") return i < 30 ? "t" i : "t" i % 30 "_t" (int(i / 30) + i % 30) % 30
        if (names == "joined") return i == 0 ? "x" : i == 1 ? "y" : "x_y_x_x_x_x_x_x_x_x_" i
        return "key_" i
    }
    BEGIN {
        printf "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":200,\"uri\":\"small.bin\"}],\"bufferViews\":["
        printf "{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":36}],\"accessors\":["
        printf "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},"
        printf "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"meshes\":["
        for (k = 0; k < meshes; k++) {
            printf "%s{\"name\":\"m%d\",\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[", k ? "," : "", k
            for (i = 0; i < targets; i++) printf "%s{\"POSITION\":1}", i ? "," : ""
            printf "]}],\"extras\":{\"targetNames\":["
            for (i = 0; i < targets; i++) printf "%s\"%s\"", i ? "," : "", name(i)
            printf "]}}"
        }
        printf "],\"nodes\":["
        for (k = 0; k < meshes; k++) printf "%s{\"mesh\":%d}", k ? "," : "", k
        printf "],\"scenes\":[{\"nodes\":["
        for (k = 0; k < meshes; k++) printf "%s%d", k ? "," : "", k
        printf "]}],\"scene\":0}"
    }' >"$work/$1"
}

# ---- morph targets ----

gltf targets.gltf 1 2000 row
noh build "$work/targets.gltf" -o "$work/out.noh" --quiet
expect 1 '2000 targets'
says "2000 morph targets: a pack holds up to 1024: remove some (mesh 'm0')"

gltf pairs.gltf 1 600 pairs
noh build "$work/pairs.gltf" -o "$work/out.noh" --quiet
expect 1 'names that make more rows than a recipe has'
says "the face's recipe has more than 1024 rows"
says '--no-correctives'
noh build "$work/pairs.gltf" -o "$work/out.noh" --quiet --no-correctives
expect 0 'without these rows'

gltf row.gltf 1 150 row
noh build "$work/row.gltf" -o "$work/out.noh"
expect 0 'targets with numbers'
check 'key_110 is no corrective of key_1' sh -c '! grep -q correctives "$1"' - "$work/out"

# Each of the 1024 ways to cut a name was looked up among all targets.
gltf joined.gltf 20 1024 joined
(
    ulimit -t 60
    "$build/noh" build "$work/joined.gltf" -o "$work/out.noh" --quiet
) 2>"$work/err"
code=$?
expect 0 'names of ten joints take no time'

# ---- polygons ----

awk 'BEGIN {
    n = 66000
    print "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 7400\n}\nObjects: {"
    printf "\tGeometry: 1, \"Geometry::star\", \"Mesh\" {\n\t\tVertices: *%d {\n\t\t\ta: ", 3 * n
    for (i = 0; i < n; i++) printf "%s%.6f,%.6f,0", i ? "," : "", cos(i) * (1 + i % 2), sin(i) * (1 + i % 2)
    printf "\n\t\t}\n\t\tPolygonVertexIndex: *%d {\n\t\t\ta: ", n
    for (i = 0; i < n - 1; i++) printf "%d,", i
    printf "%d\n\t\t}\n\t}\n\tModel: 2, \"Model::m\", \"Mesh\" {\n\t}\n}\n", -n
    print "Connections: {\n\tC: \"OO\",1,2\n\tC: \"OO\",2,0\n}"
}' >"$work/star.fbx"
noh build "$work/star.fbx" -o "$work/out.noh" --quiet
expect 1 'a concave polygon of 66000 corners, as FBX'
says "up to this one, which has 66000 corners, take too long to cut into triangles: triangulate them (mesh 'star')"

# ---- clips ----

# long FRAMES: of 350 joints
long() {
    awk -v frames="$1" 'BEGIN {
        print "HIERARCHY\nROOT j\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation"
        for (i = 0; i < 349; i++) print "JOINT j" i "\n{\nOFFSET 0 1 0\nCHANNELS 0"
        print "End Site\n{\nOFFSET 0 1 0\n}"
        for (i = 0; i < 350; i++) print "}"
        print "MOTION\nFrames: " frames "\nFrame Time: 0.001"
        for (i = 0; i < frames; i++) print i % 7, 0, 0
    }' >"$work/long.bvh"
}
long 3000
noh build "$work/long.bvh" -o "$work/out.noh"
expect 0 'more frames of joints than the usual effort is spent on'
check 'and says so' grep -q 'all clips have 1050000 frames of a joint, so they are encoded with --effort 1' "$work/out"
long 12000
noh build "$work/long.bvh" -o "$work/out.noh" --quiet
expect 1 'more frames of joints than are encoded'
says 'all clips have 4200000 frames of a joint, this one 12000 of 350 joints: too many to encode'
says 'lower --rate'
says 'build 2 or more packs of clips (--only anim; --anim takes several)'
noh build "$work/long.bvh" -o "$work/out.noh" --quiet --rate 2
expect 0 'fewer frames of it'
finish
