// heads.js FROM.glb OUT_FOLDER: stand-ins for heads of other makers, with their structures: names of targets, materials
// and joints, one mesh or several, and units. All have the shapes of one head with the 52 targets of ARKit and the
// fifteen visemes (tools/demo_assets/nell), so what differs between them is what noh makes of the structure.
'use strict';
const fs = require('fs');
const path = require('path');

function read(file) {
    const bytes = fs.readFileSync(file), length = bytes.readUInt32LE(12);
    const json = JSON.parse(bytes.toString('utf8', 20, 20 + length));
    const at = 20 + length;
    return { json, bin: bytes.subarray(at + 8, at + 8 + bytes.readUInt32LE(at)) };
}

function write(file, json, bin) {
    const text = Buffer.from(JSON.stringify(json));
    const chunks = [Buffer.concat([text, Buffer.alloc((4 - text.length % 4) % 4, ' ')]),
                    Buffer.concat([bin, Buffer.alloc((4 - bin.length % 4) % 4)])];
    const head = Buffer.alloc(12);
    head.write('glTF');
    head.writeUInt32LE(2, 4);
    head.writeUInt32LE(12 + 16 + chunks[0].length + chunks[1].length, 8);
    const parts = [head];
    chunks.forEach((chunk, i) => {
        const of = Buffer.alloc(8);
        of.writeUInt32LE(chunk.length, 0);
        of.write(i ? 'BIN\0' : 'JSON', 4);
        parts.push(of, chunk);
    });
    fs.writeFileSync(file, Buffer.concat(parts));
}

// ---- targets ----

// Only the targets that `name` returns a name for stay.
function renameTargets(json, name) {
    for (const mesh of json.meshes) {
        const names = mesh.extras.targetNames, kept = names.map(name);
        for (const p of mesh.primitives) p.targets = p.targets.filter((t, i) => kept[i]);
        mesh.extras = { targetNames: kept.filter(n => n) };
        delete mesh.weights;
    }
    for (const node of json.nodes) delete node.weights;
    delete json.animations;
}

const isArkit = name => !/^(smile|frown|blink|surprise|anger)$|^viseme_/.test(name);
const sides = name => name.replace(/Left$/, '_L').replace(/Right$/, '_R');

const vroid = {
    surprise: 'Fcl_ALL_Surprised', anger: 'Fcl_ALL_Angry', smile: 'Fcl_ALL_Joy', frown: 'Fcl_ALL_Sorrow',
    browInnerUp: 'Fcl_BRW_Surprised', blink: 'Fcl_EYE_Close', eyeBlinkLeft: 'Fcl_EYE_Close_L',
    eyeBlinkRight: 'Fcl_EYE_Close_R', viseme_aa: 'Fcl_MTH_A', viseme_I: 'Fcl_MTH_I', viseme_U: 'Fcl_MTH_U',
    viseme_E: 'Fcl_MTH_E', viseme_O: 'Fcl_MTH_O', mouthPucker: 'Fcl_MTH_Small', mouthClose: 'Fcl_MTH_Close',
};

// ---- joints ----

function accessor(g, data, componentType, type) {
    const values = Buffer.from(data.buffer, data.byteOffset, data.byteLength);
    g.bin = Buffer.concat([g.bin, Buffer.alloc((4 - g.bin.length % 4) % 4)]);
    g.json.bufferViews.push({ buffer: 0, byteOffset: g.bin.length, byteLength: values.length });
    g.bin = Buffer.concat([g.bin, values]);
    g.json.buffers[0].byteLength = g.bin.length;
    const per = { VEC3: 3, VEC4: 4, MAT4: 16 }[type];
    g.json.accessors.push({ bufferView: g.json.bufferViews.length - 1, componentType, type, count: data.length / per });
    return g.json.accessors.length - 1;
}

function positions(g, index) {
    const a = g.json.accessors[index], view = g.json.bufferViews[a.bufferView];
    const at = (view.byteOffset || 0) + (a.byteOffset || 0), stride = view.byteStride || 12;
    return Array.from({ length: a.count }, (_, i) => [0, 4, 8].map(k => g.bin.readFloatLE(at + i * stride + k)));
}

// A chain of joints from the hips to the head, and eyes on it. Vertices of the eyes' material go with their eye, others
// with the head, or below the chin with the neck and the spine.
function addJoints(g, names, eyeMaterial) {
    const eyes = [[], []], json = g.json, first = json.nodes.length;
    let low = Infinity, high = -Infinity;
    for (const mesh of json.meshes) {
        for (const p of mesh.primitives) {
            const at = positions(g, p.attributes.POSITION);
            for (const v of at) {
                low = Math.min(low, v[1]);
                high = Math.max(high, v[1]);
                if (p.material === eyeMaterial) eyes[v[0] > 0 ? 0 : 1].push(v);
            }
        }
    }
    const tall = high - low, mean = list => [0, 1, 2].map(k => list.reduce((s, v) => s + v[k], 0) / list.length);
    const place = [[0, low - 2.0 * tall, 0], [0, low - tall, 0], [0, low + 0.12 * tall, -0.05 * tall],
                   [0, low + 0.3 * tall, -0.05 * tall], mean(eyes[0]), mean(eyes[1])];
    const parent = [-1, 0, 1, 2, 3, 3];
    place.forEach((at, i) => {
        const from = parent[i] < 0 ? [0, 0, 0] : place[parent[i]];
        json.nodes.push({ name: names[i], translation: at.map((x, k) => x - from[k]) });
        if (parent[i] < 0) return;
        const on = json.nodes[first + parent[i]];
        (on.children = on.children || []).push(first + i);
    });
    json.scenes[json.scene || 0].nodes.push(first);
    const inverse = new Float32Array(16 * place.length);
    place.forEach((at, i) => {
        for (let k = 0; k < 4; k++) inverse[16 * i + 5 * k] = 1;
        for (let k = 0; k < 3; k++) inverse[16 * i + 12 + k] = -at[k];
    });
    json.skins = [{ joints: place.map((_, i) => first + i),
                    inverseBindMatrices: accessor(g, inverse, 5126, 'MAT4') }];
    for (const mesh of json.meshes) {
        for (const p of mesh.primitives) {
            const at = positions(g, p.attributes.POSITION);
            const joints = new Uint8Array(4 * at.length), weights = new Float32Array(4 * at.length);
            at.forEach((v, i) => {
                const up = Math.min(1, Math.max(0, (v[1] - low) / tall / 0.15 - 1));
                const eye = p.material === eyeMaterial;
                joints.set(eye ? [v[0] > 0 ? 4 : 5, 0, 0, 0] : [3, 1, 0, 0], 4 * i);
                weights.set(eye ? [1, 0, 0, 0] : [up, 1 - up, 0, 0], 4 * i);
            });
            p.attributes.JOINTS_0 = accessor(g, joints, 5121, 'VEC4');
            p.attributes.WEIGHTS_0 = accessor(g, weights, 5126, 'VEC4');
        }
    }
    for (const node of json.nodes) if (node.mesh !== undefined) node.skin = 0;
}

// A mesh and a node for each primitive.
function split(json, names) {
    const whole = json.nodes.findIndex(n => n.mesh !== undefined), mesh = json.meshes[json.nodes[whole].mesh];
    const scene = json.scenes[json.scene || 0];
    json.meshes = mesh.primitives.map((p, i) => ({ name: names[i], primitives: [p], extras: mesh.extras }));
    json.meshes.forEach((m, i) => {
        if (i) scene.nodes.push(json.nodes.push({ ...json.nodes[whole], name: names[i], mesh: i }) - 1);
    });
    Object.assign(json.nodes[whole], { name: names[0], mesh: 0 });
}

// A shell in front of the eyes: their surface, farther from the middle of each, with a material of its own.
function addShell(g, eyeMaterial, name, far) {
    const mesh = g.json.meshes[0], eye = mesh.primitives.find(p => p.material === eyeMaterial);
    const at = positions(g, eye.attributes.POSITION), sides = [at.filter(v => v[0] > 0), at.filter(v => v[0] <= 0)];
    const middle = sides.map(list => [0, 1, 2].map(k => list.reduce((s, v) => s + v[k], 0) / list.length));
    const moved = new Float32Array(3 * at.length);
    at.forEach((v, i) => moved.set(v.map((x, k) => x + far * (x - middle[v[0] > 0 ? 0 : 1][k])), 3 * i));
    const POSITION = accessor(g, moved, 5126, 'VEC3');
    const axis = k => at.map((_, i) => moved[3 * i + k]), axes = [0, 1, 2].map(axis);
    Object.assign(g.json.accessors[POSITION], { min: axes.map(a => Math.min(...a)), max: axes.map(a => Math.max(...a)) });
    g.json.materials.push({ name, pbrMetallicRoughness: { baseColorFactor: [1, 1, 1, 1] } });
    mesh.primitives.push({ ...eye, attributes: { ...eye.attributes, POSITION }, material: g.json.materials.length - 1 });
}

// ---- makers ----

const from = process.argv[2], out = process.argv[3];
function make(name, change) {
    const g = read(from);
    change(g);
    write(path.join(out, name + '.glb'), g.json, g.bin);
}
const material = (json, name) => json.materials.findIndex(m => m.name === name);

make('arkit', g => renameTargets(g.json, n => isArkit(n) && n));
make('rpm', g => {
    const eyes = material(g.json, 'eyes');
    renameTargets(g.json, n => (isArkit(n) || /^viseme_/.test(n)) && n);
    addJoints(g, ['Hips', 'Spine', 'Neck', 'Head', 'LeftEye', 'RightEye'], eyes);
    split(g.json, g.json.meshes[0].primitives.map(p => 'Wolf3D_' + g.json.materials[p.material].name));
    g.json.materials.forEach(m => { m.name = 'Wolf3D_' + m.name[0].toUpperCase() + m.name.slice(1); });
});
make('vroid', g => {
    const eyes = material(g.json, 'eyes');
    renameTargets(g.json, n => vroid[n]);
    addJoints(g, ['J_Bip_C_Hips', 'J_Bip_C_Spine', 'J_Bip_C_Neck', 'J_Bip_C_Head', 'J_Adj_L_FaceEye',
                  'J_Adj_R_FaceEye'], eyes);
    g.json.materials.forEach(m => { m.name = `N00_000_00_${m.name}_00_${m.name.toUpperCase()} (Instance)`; });
});
make('ict', g => {
    const eyes = material(g.json, 'eyes');
    renameTargets(g.json, n => isArkit(n) && sides(n));
    addShell(g, eyes, 'M_EyeOcclusion', 0.02);
    addShell(g, eyes, 'M_EyeBlend', 0.04);
    addShell(g, eyes, 'M_Lacrimal', 0.06);
    g.json.nodes.forEach(n => { if (n.mesh !== undefined) n.scale = [100, 100, 100]; });
});
