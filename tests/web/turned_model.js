// turned_model.js FILE.glb DEGREES: prints the model turned from +z towards +x.
'use strict';
const fs = require('fs');

const half = Number(process.argv[3]) * Math.PI / 360, glb = fs.readFileSync(process.argv[2]), bytes = glb.readUInt32LE(12), model = JSON.parse(glb.toString('utf8', 20, 20 + bytes));
for (const scene of model.scenes) scene.nodes = [model.nodes.push({ children: scene.nodes, rotation: [0, Math.sin(half), 0, Math.cos(half)] }) - 1];
const text = Buffer.from(JSON.stringify(model)), json = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]), rest = glb.subarray(20 + bytes), head = Buffer.from(glb.subarray(0, 20));
head.writeUInt32LE(20 + json.length + rest.length, 8);
head.writeUInt32LE(json.length, 12);
process.stdout.write(Buffer.concat([head, json, rest]));
