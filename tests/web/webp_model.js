// webp_model.js: prints a glTF model of one triangle, its color a WebP picture with a transparent texel, its emission a
// picture that is not there.
'use strict';
const corners = Buffer.from(new Float32Array([-1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0.5, 1]).buffer).toString('base64');
const webp = 'UklGRiAAAABXRUJQVlA4TBQAAAAvAQAAEA8wgPs//6f5Dy1UIKL/AQ=='; // red, and a blue that lets four fifths through
console.log(JSON.stringify({
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, name: 'sheet' }],
    meshes: [{ name: 'sheet', primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 1 }, material: 0 }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: 'VEC3', min: [-1, 0, 0], max: [1, 2, 0] }, { bufferView: 1, componentType: 5126, count: 3, type: 'VEC2' }],
    bufferViews: [{ buffer: 0, byteOffset: 0, byteLength: 36 }, { buffer: 0, byteOffset: 36, byteLength: 24 }],
    buffers: [{ byteLength: 60, uri: `data:application/octet-stream;base64,${corners}` }],
    materials: [{ alphaMode: 'BLEND', pbrMetallicRoughness: { baseColorTexture: { index: 0 } }, emissiveTexture: { index: 1 }, emissiveFactor: [1, 1, 1] }],
    textures: [{ extensions: { EXT_texture_webp: { source: 0 } } }, { source: 1 }],
    images: [{ uri: `data:image/webp;base64,${webp}` }, { uri: 'nowhere.png' }], extensionsUsed: ['EXT_texture_webp'],
}));
