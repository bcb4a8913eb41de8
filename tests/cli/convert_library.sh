#!/bin/sh
# libnohconvert: files in memory give the same pack as `noh build` makes of them, and no file of the machine is read.
. "$(dirname "$0")/lib.sh"
if [ -n "${NOH_SAN:-}" ]; then
    skip 'the converter as a library' 'its objects have sanitizers here'
    finish
fi
libraries=$(make -s --no-print-directory -f Makefile --eval 'tool-libs: ; @echo $(TOOL_LIBS)' tool-libs DEPS=0 2>/dev/null)
program=$work/convert
# shellcheck disable=SC2086
check 'a program links' ${CC:-gcc} -Wall -Wextra -Werror -Itools/noh/build tests/cli/convert_library.c "$build/libnohconvert.a" \
    "$build/libnoh.a" $libraries -lstdc++ -lpthread -o "$program"
check 'only its own functions are global' test \
    "$(nm --defined-only -g "$build/libnohconvert.a" | sed -n 's/.* [A-Z] //p' | sort | tr '\n' ' ')" = 'noh_convert noh_convert_version '

library() { # OUT FOLDER FILE... -- ARGUMENT...
    (cd / && "$program" "$@" >"$work/out" 2>"$work/err")
    code=$?
}
tells() { check "it tells: $1" grep -Fqe "$1" "$work/out"; }
# equal NAME FOLDER FILE... -- ARGUMENT...
equal() {
    name=$1 folder=$2
    shift
    library "$work/library.noh" "$@"
    while [ "$1" != -- ]; do shift; done
    shift
    check "$name: the library" test "$code" = 0
    (cd "$folder" && "$tool" build "$@" -o "$work/tool.noh" --quiet)
    check "$name: the same bytes as noh build" cmp "$work/library.noh" "$work/tool.noh"
}
tool=$(cd "$build" && pwd)/noh

# ---- files that refer to others ----

in=$work/in
mkdir -p "$in/textures" "$in/targets" "$in/models"
sh tests/support/small_glb.sh >"$in/small.glb"
{ head -c 12 /dev/zero; printf '\000\000\200\077'; head -c 8 /dev/zero
  printf '\000\000\200\077\000\000\200\077\000\000\000\000'; } >"$in/data.bin"
"$tool" render "$build/mask.noh" -o "$in/textures/skin.png" --size 8x8 >/dev/null 2>&1
cat >"$in/models/hero.gltf" <<'END'
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"buffers":[{"uri":"../data.bin","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"images":[{"uri":"../textures/skin.png"}],"textures":[{"source":0}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}]}
END
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$in/face.obj"
printf 'v 0 0 0\nv 1 0 0\nv 0 1.5 0\nf 1 2 3\n' >"$in/targets/smile.obj"
printf 'v 0 0 0\nv 1 0.2 0\nv 0 1 0\nf 1 2 3\n' >"$in/targets/frown.obj"

equal 'one file' "$in" small.glb -- small.glb
equal 'buffers and pictures by their names' "$in" models/hero.gltf data.bin textures/skin.png -- models/hero.gltf
equal 'a folder of targets' "$in" face.obj targets/smile.obj targets/frown.obj -- face.obj --targets targets
equal 'options' "$in" small.glb -- small.glb --textures raw --error-um 50

# ---- what it tells ----

check 'lines are plain text' sh -c '! LC_ALL=C grep -q "[[:cntrl:]]" "$1"' - "$work/out"

library "$work/none.noh" "$in" models/hero.gltf data.bin -- models/hero.gltf
check 'a picture that is not given costs a warning' test "$code" = 0
tells 'warning: '
tells 'missing: models/../textures/skin.png'
library "$work/none.noh" "$in" models/hero.gltf textures/skin.png -- models/hero.gltf
check 'a buffer that is not given is an error' test "$code" = 2
tells 'data.bin'
tells 'result 2, '
library "$work/none.noh" "$in" small.glb -- "$in/small.glb"
check 'no file of the machine is read' test "$code" = 2
library "$work/none.noh" "$in" small.glb -- small.glb --no-such
check 'a wrong option' test "$code" = 1
tells 'no option --no-such'
head -c 100 "$in/small.glb" >"$in/cut.glb"
library "$work/none.noh" "$in" cut.glb -- cut.glb
check 'a damaged file' test "$code" = 2
tells 'error: cut.glb: '
REFUSE=1 library "$work/none.noh" "$in" small.glb -- small.glb
check 'no memory for the pack' test "$code" = 3
check 'nothing is printed on stderr' test ! -s "$work/err"
check 'nothing is written' test ! -e "$work/none.noh.tmp"
finish
