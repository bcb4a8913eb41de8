#!/bin/sh
# noh strip: pictures and dumps of the result, its figures, --from-level by mesh, build --lod-from, refused input,
# outputs that cannot be written.
. "$(dirname "$0")/lib.sh"

full=$build/mask_levels.noh
puppet=$build/demo/puppet_levels.noh # as the Makefile makes it: --lod 4 --lod-fast --graph

# ---- what is left looks and measures as in the full pack ----

same_picture() { # NAME FULL LEVEL STRIPPED ARGUMENTS...
    name=$1 of=$2 level=$3 stripped=$4
    shift 4
    noh render "$of" -o "$work/full.png" --size 160x180 --lod "$level" "$@"
    expect 0 "render $name of the full pack"
    noh render "$stripped" -o "$work/stripped.png" --size 160x180 "$@"
    expect 0 'and of the stripped one'
    check 'equal to the pixel' cmp "$work/full.png" "$work/stripped.png"
}
for level in 1 2 3; do
    noh strip "$puppet" -o "$work/puppet_$level.noh" --from-level $level
    expect 0 "strip --from-level $level"
    check 'reports each mesh and the bytes' sh -c 'test "$(grep -c "^mesh .*: levels $2 to 3; " "$1")" = 2 && grep -q "bytes of " "$1"' - "$work/out" $level
    same_picture "level $level" "$puppet" $level "$work/puppet_$level.noh" --clip walk --time 0.6
    noh dump "$puppet" -o "$work/full.obj" --lod $level --clip walk --time 0.6 --weight smile=1
    noh dump "$work/puppet_$level.noh" -o "$work/stripped.obj" --clip walk --time 0.6 --weight smile=1
    expect 0 'dump'
    check 'the same vertices' cmp "$work/full.obj" "$work/stripped.obj"
    check 'says its level' grep -q "^# LOD level $level of 0 to 3" "$work/stripped.obj"
done
noh strip "$full" -o "$work/mask_2.noh" --from-level 2 --quiet
expect 0 'strip the mask'
check 'quietly' test ! -s "$work/out"
same_picture 'a face' "$full" 2 "$work/mask_2.noh" --camera face --weight smile=1 --weight blink=0.5
same_picture 'a coarser level' "$full" 3 "$work/mask_2.noh" --lod 3 --camera 30,10
noh render "$work/mask_2.noh" -o "$work/finest.png" --size 160x180 --lod 0 --camera 30,10
expect 0 'render a level that is not there'
noh render "$work/mask_2.noh" -o "$work/stripped.png" --size 160x180 --lod 2 --camera 30,10
check 'shows the finest that is' cmp "$work/finest.png" "$work/stripped.png"
noh verify "$work/mask_2.noh"
expect 0 'verify'
noh budget "$work/puppet_2.noh"
expect 0 'budget'
check 'lists the levels that are there' sh -c 'grep -q "^  2 " "$1" && grep -q "^  3 " "$1" && ! grep -q "^  [01] " "$1"' - "$work/out"
noh info "$work/puppet_2.noh"
expect 0 'info'
check 'says what was left out' sh -c 'test "$(grep -c "levels finer than 2 were left out" "$1")" = 2' - "$work/out"
noh sheet "$work/mask_2.noh" -o "$work/lods.png" --lods --tile 64
expect 0 'sheet --lods'
check 'says nothing' test ! -s "$work/err"
noh crowd "$work/puppet_2.noh" -o "$work/crowd.png" --size 160x90
expect 0 'crowd'

# ---- the same bytes by other ways ----

noh strip "$work/puppet_1.noh" -o "$work/again.noh" --from-level 3 --quiet
check 'stripping in two steps gives the same bytes' cmp "$work/again.noh" "$work/puppet_3.noh"
noh strip "$full" -o "$work/again.noh" --from-level 0 --quiet
check 'from level 0 the pack stays as it is' cmp "$work/again.noh" "$full"
noh strip "$build/mask.noh" -o "$work/again.noh" --from-level 3 --quiet
expect 0 'a pack without levels'
check 'stays as it is' cmp "$work/again.noh" "$build/mask.noh"
noh strip "$puppet" -o /dev/stdout --from-level 3
expect 0 'to stdout'
check 'has the pack and nothing else' cmp "$work/out" "$work/puppet_3.noh"
if [ -n "${NOH_SAN:-}" ]; then
    skip 'build --lod-from' 'levels take minutes under a sanitizer'
else
    noh build "$build/demo/arm.glb" -o "$work/arm.noh" --lod 3 --lod-fast --quiet
    noh strip "$work/arm.noh" -o "$work/arm_1.noh" --from-level 1 --quiet
    noh build "$build/demo/arm.glb" -o "$work/again.noh" --lod 3 --lod-fast --lod-from 1 --quiet
    expect 0 'build --lod-from'
    check 'gives the same bytes' sh -c 'cmp "$1" "$2" && ! cmp -s "$1" "$3"' - "$work/again.noh" "$work/arm_1.noh" "$work/arm.noh"
fi

# ---- by mesh ----

noh strip "$puppet" -o "$work/named.noh" --from-level 1 --from-level mask=3 --json
expect 0 '--from-level of all and of one'
cp "$work/out" "$work/strip.json"
if [ -n "$json" ]; then
    for holds in 'j.input !== "" && j.output !== "" && j.from_level === 1 && j.meshes.length === 2' \
        "j.bytes_before === $(wc -c <"$puppet") && j.bytes_after === $(wc -c <"$work/named.noh")" \
        'j.meshes[0].name === "body" && j.meshes[0].level_first === 1 && j.meshes[0].level_count === 4' \
        'j.meshes[1].name === "mask" && j.meshes[1].level_first === 3 && j.meshes[1].source !== 0' \
        'j.meshes[1].vertices !== j.meshes[1].vertices_before && j.meshes[1].error_um !== 0'; do
        check "JSON: $holds" $json "$holds" <"$work/strip.json"
    done
else
    skip 'JSON' 'neither node nor python3 is here'
fi

# ---- what is refused ----

for value in '' x -1 8 1.5 =1 mask= mask=9; do
    noh strip "$full" -o "$work/refused.noh" --from-level "$value"
    expect 2 "--from-level '$value'"
    says "--from-level must be K or MESH=K, K from 0 to 7, not '$value'"
    noh build "$build/demo/arm.glb" -o "$work/refused.noh" --lod 2 --lod-fast --lod-from "$value"
    expect 2 "build --lod-from '$value'"
    says "--lod-from must be K or MESH=K"
done
noh strip "$full" -o "$work/refused.noh"
expect 2 'without --from-level'
says '--from-level'
noh strip "$full" --from-level 1
expect 2 'without -o'
noh strip "$full" "$full" -o "$work/refused.noh" --from-level 1
expect 2 'two packs'
noh strip "$full" -o "$work/refused.noh" --from-level nose=1
expect 1 'a mesh that is not there'
says "no mesh is named 'nose'"
noh build "$build/demo/arm.glb" -o "$work/refused.noh" --lod-from 1
expect 2 'build --lod-from without --lod'
noh strip "$work/missing.noh" -o "$work/refused.noh" --from-level 1
expect 1 'a missing pack'
head -c 5000 "$full" >"$work/cut.noh"
noh strip "$work/cut.noh" -o "$work/refused.noh" --from-level 1
expect 1 'a cut pack'
noh build "$build/demo/get_up.glb" -o "$work/clips.noh" --only anim --quiet
noh strip "$work/clips.noh" -o "$work/refused.noh" --from-level 1
expect 1 'a pack of clips'
says 'no meshes'
noh strip "$full" -o /dev/stdout --from-level 1 --json
expect 2 'the pack and JSON on stdout'
check 'no pack was written by any of these' test ! -e "$work/refused.noh"
cp "$full" "$work/own.noh"
noh strip "$work/own.noh" -o "$work/own.noh" --from-level 1
expect 2 'its own input'
check 'is untouched' cmp "$work/own.noh" "$full"
noh strip "$full" -o "$work/no/such/folder.noh" --from-level 1
expect 1 'a folder that is not there'
says 'cannot write'
if [ -w /dev/full ]; then
    noh strip "$full" -o /dev/full --from-level 1
    expect 1 'a full disk'
    says 'cannot write'
fi
finish
