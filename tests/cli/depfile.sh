#!/bin/sh
# noh build --depfile: ten packs by Ninja and by Make are built, built again where a file that they are made of has
# changed, and not otherwise. By CMake, and sandboxed as Bazel does it.
. "$(dirname "$0")/lib.sh"
build=$(cd "$build" && pwd)
bin=$build/noh
cd "$work" || exit 1

# bin FILE BYTE: a triangle with this byte, in octal, in its third vertex
bin() {
    { head -c 12 /dev/zero; printf '\000\000\200\077'; head -c 8 /dev/zero
      printf "\\000\\000\\$2\\077\\000\\000\\200\\077\\000\\000\\000\\000"; } >"$1"
}
# model FOLDER N: FOLDER/N.gltf, with a .bin of its own whose name has a blank, a # and a $, and a texture of all
model() {
    bin "$1/data \$#$2.bin" 200
    cat >"$1/$2.gltf" <<END
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"buffers":[{"uri":"data%20%24%23$2.bin","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"images":[{"uri":"skin.png"}],"textures":[{"source":0}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}]}
END
}
mkdir 'a b' packs
noh render "$build/mask.noh" -o 'a b/skin.png' --size 8x8
for n in 0 1 2 3 4 5 6 7 8 9; do model 'a b' $n; done
echo 'aa smile' >'a b/face.recipe'
echo 'joint head kopf' >our.names

# ---- the file ----

noh build 'a b/0.gltf' -o 'packs/0 $#.noh' --depfile packs/0.d --recipe 'a b/face.recipe' --names our.names --quiet
expect 0 'a depfile'
cat >expected <<'END'
packs/0\ $$\#.noh: \
  our.names \
  a\ b/0.gltf \
  a\ b/data\ $$\#0.bin \
  a\ b/skin.png \
  a\ b/face.recipe
our.names:
a\ b/0.gltf:
a\ b/data\ $$\#0.bin:
a\ b/skin.png:
a\ b/face.recipe:
END
check 'it has every file that was read' diff expected packs/0.d
mkdir cases
bin 'cases/Data $#0.BIN' 200
cp 'a b/skin.png' cases/SKIN.png
cp 'a b/0.gltf' cases/0.gltf
noh build cases/0.gltf -o packs/cases.noh --depfile packs/0.d --warnings
check 'files whose names differ in case are found' sh -c '! grep -q "does not exist" "$1/err"' - "$work"
check 'and named as they are there' grep -q 'cases/SKIN.png' packs/0.d
mv 'a b/skin.png' kept.png
noh build 'a b/0.gltf' -o packs/0.noh --depfile packs/0.d --warnings
expect 0 'without the texture'
check 'of the report the warnings remain, on stderr' sh -c 'test ! -s "$1/out" && grep -q "^warning: .*skin.png" "$1/err"' - "$work"
check 'a file that is not there is not named' sh -c '! grep -q skin.png packs/0.d'
mv kept.png 'a b/skin.png'
rm -f packs/0.d packs/0.noh
noh build 'a b/0.gltf' -o packs/0.noh --depfile nowhere/0.d --quiet
expect 1 'a depfile that cannot be written'
says 'nowhere/0.d: cannot write'
check 'then there is no pack' test ! -e packs/0.noh
noh build 'a b/0.gltf' -o packs/0.noh --depfile 'a b/0.gltf' --quiet
expect 2 'a depfile over an input'
noh build 'a b/missing.gltf' -o packs/0.noh --depfile packs/0.d --quiet
expect 1 'a build that fails'
check 'leaves no depfile' test ! -e packs/0.d
rm -f packs/*

# ---- build systems ----

# runs COUNT NAME: the build runs the tool this many times; touches are told apart by a second
runs() {
    : >ran
    $run >run.txt 2>&1 || { not_ok "$2"; head -n 20 run.txt | sed 's/^/#   /'; return; }
    check "$2: $1" test "$(wc -l <ran)" = "$1"
}
cat >counted <<END
#!/bin/sh
echo x >>ran
exec "$bin" "\$@"
END
chmod +x counted
changes() { # what each build system does as files change
    runs 10 "$1 builds ten packs"
    runs 0 "$1 has nothing to do"
    sleep 1.1
    bin 'a b/data $#3.bin' 0
    runs 1 "$1 builds one again whose .bin has changed"
    check "and that is the one" test -n "$(find packs -name '3.noh' -newer packs/4.noh)"
    runs 0 "$1 has nothing to do then"
    sleep 1.1
    touch 'a b/face.recipe'
    runs 1 "$1: a text of one"
    touch 'a b/unrelated.bin'
    runs 0 "$1: a file of none"
    sleep 1.1
    touch 'a b/skin.png'
    runs 10 "$1: a texture of all"
    mv 'a b/skin.png' kept.png
    runs 10 "$1: without the texture"
    mv kept.png 'a b/skin.png'
    rm packs/7.noh
    runs 1 "$1: a pack that was removed"
}
if command -v ninja >/dev/null 2>&1; then
    {
        printf 'rule pack\n  command = ./counted build $in -o $out --depfile $out.d --quiet $options\n  deps = gcc\n  depfile = $out.d\n'
        for n in 0 1 2 3 4 5 6 7 8 9; do
            echo "build packs/$n.noh: pack a\$ b/$n.gltf"
            [ $n != 5 ] || echo "  options = --recipe 'a b/face.recipe'"
        done
    } >build.ninja
    run=ninja
    changes Ninja
    rm -f packs/*
else
    skip 'Ninja' 'no ninja here'
fi
{
    # shellcheck disable=SC2016
    printf 'packs = $(foreach n,0 1 2 3 4 5 6 7 8 9,packs/$(n).noh)\nall: $(packs)\npacks/5.noh: options = --recipe "a b/face.recipe"\n'
    # shellcheck disable=SC2016
    printf 'packs/%%.noh: a\\ b/%%.gltf\n\t./counted build "$<" -o $@ --depfile $@.d --quiet $(options)\n-include $(packs:=.d)\n'
} >Makefile
run='make -s'
changes Make

# ---- sandboxed: of the folder, an action sees what it declares, as with Bazel ----

if unshare -rm true 2>/dev/null; then
    mkdir box
    cp 'a b/1.gltf' 'a b/data $#1.bin' box
    "$bin" build 'a b/1.gltf' -o packs/whole.noh --quiet
    unshare -rm sh -c 'mount -t tmpfs none "a b" && cp box/* "a b" && exec "$@"' - "$bin" build 'a b/1.gltf' -o packs/box.noh --depfile packs/box.d --quiet
    check 'an input that is not declared is missing in the pack' sh -c '! cmp -s packs/whole.noh packs/box.noh'
    cp 'a b/skin.png' box
    unshare -rm sh -c 'mount -t tmpfs none "a b" && cp box/* "a b" && exec "$@"' - "$bin" build 'a b/1.gltf' -o packs/box.noh --depfile packs/box.d --quiet
    check 'with all inputs the pack is the same' cmp packs/whole.noh packs/box.noh
else
    skip 'a sandbox' 'no namespaces for users here'
fi
finish
