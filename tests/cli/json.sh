#!/bin/sh
# --json: the output parses and has the keys that users' scripts rely on; the budget's prediction equals the use found
# by verify.
. "$(dirname "$0")/lib.sh"

pack=$build/mask.noh

for verb in info budget verify; do
    noh $verb "$pack" --json
    expect 0 "$verb --json"
    cp "$work/out" "$work/$verb.json"
done
noh render "$pack" -o /dev/stdout --json
expect 2 'a picture and JSON do not both go to stdout'
noh render "$pack" -o "$work/face.png" --size 64x64 --camera face,0,4 --light room --json
expect 0 'render --json'
cp "$work/out" "$work/render.json"
if [ -z "$json" ]; then
    for verb in info budget verify render; do
        skip "$verb --json parses" 'neither node nor python3 is here'
    done
    finish
fi

holds() {
    check "$1: $2" sh -c '. "$0"; "$1" "$2" <"$3"' "$work/json.sh" $json "$2" "$work/$1.json"
}
# the functions of lib.sh, without its setup
sed -n '/^json_node()/,/^}/p; /^json_python()/,/^}/p' tests/cli/lib.sh >"$work/json.sh"

holds info 'j.version === 5'
holds info "j.bytes === $(wc -c <"$pack")"
holds info 'j.meshes[0].vertices !== 0 && j.meshes[0].indices !== 0 && j.meshes[0].targets !== 0'
holds info 'j.meshes[0].pairs !== 0 && j.meshes[0].texels !== 0 && j.meshes[0].target_bytes !== 0'
holds info 'j.meshes[0].name !== "" && j.meshes[0].lods !== 0 && j.skeletons !== 0 && j.clips[0].name !== "" && j.events !== 1'
holds info 'j.clips[0].rate_errors_cm[0] === 0 && j.clips[0].rate_errors_cm[3] !== 0 && j.clips[0].error_shell_cm === 0'
holds render 'j.width === 64 && j.height === 64 && j.camera.view_deg === 30 && j.light.name === "room" && j.light.exposure !== 0'
holds render 'j.camera.eye[0] === 0 && j.camera.eye[2] !== 0 && j.camera.forward[0] === 0 && j.camera.forward[2] !== 0 && j.light.key_direction[1] !== 0'
holds budget 'j.cpu_bytes !== 0 && j.gpu_bytes !== 0 && j.parts[0].name !== "" && j.parts[0].cpu_bytes + j.parts[0].gpu_bytes !== 0'
holds budget "j.pack_bytes === $(wc -c <"$pack")"
holds verify 'j.ok === true && j.driver !== "" && j.gl_version !== ""'
holds verify 'j.paths[0].path !== "" && j.paths[0].accumulate !== "" && j.paths[0].available === true && j.paths[0].reason !== ""'
holds verify 'j.paths[0].values !== 0 && j.paths[0].differing === 0 && j.paths[0].max_error_um === 0 && j.paths[0].bound_um === 0'
holds verify 'j.memory.cpu_used === j.memory.cpu_predicted && j.memory.gpu_used === j.memory.gpu_predicted'

number() {
    sed -n "s/.*\"$1\": \([0-9]*\).*/\1/p" "$work/$2.json" | head -n 1
}
for instances in 1 100; do
    noh budget "$pack" --instances $instances --json
    cp "$work/out" "$work/budget.json"
    noh verify "$pack" --instances $instances --json
    cp "$work/out" "$work/verify.json"
    expect 0 "verify of $instances instances"
    for kind in cpu gpu; do
        predicted=$(number ${kind}_bytes budget) used=$(number ${kind}_used verify)
        check "$kind bytes of $instances: budget $predicted, used $used" test -n "$predicted" -a "$predicted" = "$used"
    done
    check "the parts of the budget add up" awk '
        /"parts"/ { parts = 1 }
        /"levels"/ { exit }
        /"(cpu|gpu)_bytes"/ { n = $2 + 0; if (parts) sum += n; else whole += n }
        END { exit !(sum == whole && sum > 0) }' "$work/budget.json"
done
finish
