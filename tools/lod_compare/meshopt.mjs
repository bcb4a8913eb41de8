// meshopt.mjs MESH LEVELS: simplify with the npm package meshoptimizer, once for each weight of the attributes.
// peer_npm.c writes MESH and reads LEVELS, and says there what is in them.
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { pathToFileURL } from 'node:url';

const NO_LIMIT = 1e6; // on the error, in sizes of the mesh: only the count of triangles ends it

// require finds packages by NODE_PATH, import does not.
const program = createRequire(import.meta.url).resolve('meshoptimizer/simplifier');
const { MeshoptSimplifier } = await import(pathToFileURL(program));
await MeshoptSimplifier.ready;

const file = readFileSync(process.argv[2]);
const buffer = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
let at = 0;
function take(Type, count) {
	const values = new Type(buffer, at, count);
	at += count * 4;
	return values;
}

const [vertexCount, indexCount, attributeCount, submeshCount, levelCount, weightCount] = take(Uint32Array, 6);
const weights = take(Float32Array, weightCount);
const ranges = take(Uint32Array, submeshCount * 2);
const wanted = take(Uint32Array, levelCount * submeshCount);
const positions = take(Float32Array, vertexCount * 3);
const attributes = take(Float32Array, vertexCount * attributeCount);
const indices = take(Uint32Array, indexCount);

function simplify(triangles, count, weight) {
	if (!attributeCount || !weight) {
		return MeshoptSimplifier.simplify(triangles, positions, 3, count, NO_LIMIT)[0];
	}
	return MeshoptSimplifier.simplifyWithAttributes(triangles, positions, 3, attributes, attributeCount,
		new Array(attributeCount).fill(weight), null, count, NO_LIMIT)[0];
}

const parts = [];
for (const weight of weights) {
	for (let i = 0; i < wanted.length; i++) {
		const first = ranges[(i % submeshCount) * 2], count = ranges[(i % submeshCount) * 2 + 1];
		const level = simplify(indices.slice(first, first + count), wanted[i], weight);
		parts.push(Buffer.from(Uint32Array.of(level.length).buffer),
			Buffer.from(level.buffer, level.byteOffset, level.byteLength));
	}
}
writeFileSync(process.argv[3], Buffer.concat(parts));
console.log(` npm: meshoptimizer ${JSON.parse(readFileSync(join(dirname(program), 'package.json'))).version}`);
