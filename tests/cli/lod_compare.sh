#!/bin/sh
# lod_compare: data sent to and returned by the npm simplifier, with a fake package, so that neither the network nor the
# real package is needed; also with the real one, if `make bench-lod` installed it.
. "$(dirname "$0")/lib.sh"

script=$PWD/tools/lod_compare/meshopt.mjs

compared() { # MODEL ARGUMENTS: as `noh` does
    model=$1
    shift
    "$build/lod_compare" "$model" --fast "$@" >"$work/out" 2>"$work/err"
    code=$?
}

compared "$build/demo/arm.glb"
expect 0 'without npm'
check 'it is left out' grep -q 'no node, or no meshoptimizer from npm: left out' "$work/out"
check 'and three levels are compared with the other peer' test "$(grep -c '^ level' "$work/out")" = 3
compared "$build/demo/arm.glb" --npm "$script"
expect 2 '--npm wants a folder, too'
if ! command -v node >/dev/null; then
    skip 'the peer of npm' 'no node here'
    finish
    exit
fi

# ---- a mesh: two bent sheets with twelve targets, whose 36 numbers a vertex are more than the peer takes ----

cat >"$work/sheets.mjs" <<'END'
import { writeFileSync } from 'node:fs';
const SIDE = 12, TARGETS = 12, views = [], accessors = [], parts = [];
let bytes = 0;
function add(values, type, count) {
	views.push({ buffer: 0, byteOffset: bytes, byteLength: values.byteLength });
	parts.push(Buffer.from(values.buffer));
	bytes += values.byteLength;
	accessors.push({ bufferView: views.length - 1, componentType: type === 'SCALAR' ? 5125 : 5126, count, type });
	return accessors.length - 1;
}
function points(f) {
	const values = new Float32Array(SIDE * SIDE * 3);
	for (let i = 0; i < SIDE * SIDE; i++) values.set(f((i % SIDE) / SIDE, Math.floor(i / SIDE) / SIDE), i * 3);
	return values;
}
const primitives = [0, 1].map((z) => {
	const indices = [];
	for (let y = 0; y + 1 < SIDE; y++) for (let x = 0; x + 1 < SIDE; x++) {
		const a = y * SIDE + x;
		indices.push(a, a + 1, a + SIDE, a + SIDE, a + 1, a + SIDE + 1);
	}
	const targets = [];
	for (let t = 0; t < TARGETS; t++) {
		targets.push({ POSITION: add(points((x, y) => [Math.sin(9 * x + t) / 50, Math.cos(7 * y * (1 + t)) / 40,
			Math.sin(5 * x * t + 3 * y) / 30]), 'VEC3', SIDE * SIDE) });
	}
	return { attributes: { POSITION: add(points((x, y) => [x, y, z + Math.sin(6 * x) * Math.cos(5 * y) / 5]), 'VEC3',
		SIDE * SIDE) }, indices: add(Uint32Array.from(indices), 'SCALAR', indices.length), targets };
});
writeFileSync(process.argv[2], JSON.stringify({ asset: { version: '2.0' }, buffers: [{ byteLength: bytes,
	uri: 'data:application/octet-stream;base64,' + Buffer.concat(parts).toString('base64') }], bufferViews: views,
	accessors, meshes: [{ primitives }], nodes: [{ mesh: 0 }], scenes: [{ nodes: [0] }] }));
END
node "$work/sheets.mjs" "$work/sheets.gltf"

# ---- a package that checks what it is given: only with the weight 64 it keeps all triangles, else the first ones ----

mkdir -p "$work/node_modules/meshoptimizer"
echo '{ "name": "meshoptimizer", "version": "0.0.0-test" }' >"$work/node_modules/meshoptimizer/package.json"
cat >"$work/node_modules/meshoptimizer/simplifier.js" <<'END'
function check(right) {
	if (!right) throw new Error('the peer was given something wrong');
}
function first(indices, positions, count) {
	check(indices instanceof Uint32Array && indices.length === 11 * 11 * 6 && count > 0 && count < indices.length + 1);
	check(positions instanceof Float32Array && positions.length === 288 * 3);
	for (const i of indices) check(i < 288 && Math.abs(positions[3 * i + 2] - (indices[0] < 144 ? 0 : 1)) < 0.21);
	return indices.slice(0, count - count % 3);
}
exports.MeshoptSimplifier = {
	ready: Promise.resolve(),
	simplify: (indices, positions, stride, count) => [first(indices, positions, count), 0],
	simplifyWithAttributes: (indices, positions, stride, attributes, attributeStride, weights, locks, count) => {
		check(attributes instanceof Float32Array && attributeStride === 32 && attributes.length === 288 * 32);
		check(attributes.every(Number.isFinite) && attributes.some((a) => a !== 0));
		check(weights.length === 32 && weights.every((w) => w === weights[0]) && weights[0] >= 1);
		const few = first(indices, positions, count);
		return [weights[0] === 64 ? indices : few, 0];
	},
};
END
export NODE_PATH="$work/node_modules"
compared "$work/sheets.gltf" --npm "$script" "$work"
expect 0 'with a package'
check 'its version is reported' grep -q 'npm: meshoptimizer 0.0.0-test' "$work/out"
check 'the best weight of each level is found' test "$(grep -c 'with weight 64$' "$work/out")" = 3
check 'and its levels are as they were sent' sh -c 'test "$(grep -c "npm.s 484 (242)" "$1")" = 3' - "$work/out"
check 'with which nothing is lost' sh -c \
    'test "$(grep -c "^  skin, targets and mixes .* 0\.000   .* 0\.00 times" "$1")" = 3' - "$work/out"
check 'its attributes hold nearly all of the targets' sh -c \
    'sed -n "s/.*attributes hold \([0-9.]*\) .*/\1/p" "$1" | awk "{ exit !(\$1 > 90 && \$1 <= 100) }"' - "$work/out"

# ---- invalid levels ----

cat >"$work/broken.mjs" <<'END'
import { readFileSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
await import(pathToFileURL(process.env.SCRIPT));
const words = new Uint32Array(new Uint8Array(readFileSync(process.argv[3])).buffer);
const broken = {
	none: () => words.slice(0, 0),
	short: () => words.slice(0, words.length - 1),
	long: () => Uint32Array.of(...words, 0),
	beyond: () => words.map((w, i) => (i === 1 ? 288 : w)),
	'no triangles': () => words.map((w, i) => (i ? w : w - 1)),
	'too many': () => words.map((w, i) => (i ? w : 0xfffffffd)),
	untouched: () => words,
}[process.env.BROKEN]();
writeFileSync(process.argv[3], Buffer.from(broken.buffer));
END
export SCRIPT="$script" BROKEN
for BROKEN in none short long beyond 'no triangles' 'too many'; do
    compared "$work/sheets.gltf" --npm "$work/broken.mjs" "$work"
    expect 0 "levels that are broken ($BROKEN)"
    check 'are left out' grep -q 'npm: meshoptimizer failed: left out' "$work/out"
done
BROKEN=untouched
compared "$work/sheets.gltf" --npm "$work/broken.mjs" "$work"
check 'those that are not are taken' grep -q 'with weight 64' "$work/out"
compared "$work/sheets.gltf" --npm "$work/nothing.mjs" "$work"
expect 0 'a program that is not there'
check 'is left out' grep -q 'npm: meshoptimizer failed: left out' "$work/out"

# ---- the package itself ----

export NODE_PATH="$build/lod-peer/node_modules"
if node -e "require.resolve('meshoptimizer/simplifier')" 2>/dev/null; then
    compared "$work/sheets.gltf" --npm "$script" "$work"
    expect 0 'with the package itself'
    check 'its levels have about our triangles' awk '
        /^ level/ { ours = $3; sub(/.*npm.s /, ""); n++; bad += $1 < 0.9 * ours || $1 > 1.1 * ours + 50 }
        END { exit !(n == 3 && !bad) }' "$work/out"
else
    skip 'with the package itself' 'no meshoptimizer in build/lod-peer: make bench-lod gets it'
fi
finish
