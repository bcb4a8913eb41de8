// compare_element_talkinghead.js: the side of TalkingHead, which draws by three.js and loads only bodies with the joints of
// Mixamo: the head gets such joints, which move nothing.
import { TalkingHead } from '@met4citizen/talkinghead';
import { Box3, Vector3 } from 'three';
import model from '@met4citizen/talkinghead/package.json';
import { boundsAtRest, cameraOf } from './compare_shared.js';

// A .glb whose scene lies below a node of this name, with nodes of other names.
async function under(address, root, names) {
    const bytes = new Uint8Array(await (await fetch(address)).arrayBuffer()), length = new DataView(bytes.buffer).getUint32(12, true);
    const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length))), scene = json.scenes[json.scene || 0];
    json.nodes = json.nodes || [];
    const joints = names.map((name, i) => json.nodes.push({ name, translation: [0, 0.01 * i, 0] }) - 1);
    scene.nodes = [json.nodes.push({ name: root, children: [...scene.nodes, ...joints] }) - 1];
    let text = new TextEncoder().encode(JSON.stringify(json));
    text = new Uint8Array([...text, ...new Array((4 - text.length % 4) % 4).fill(32)]);
    const rest = bytes.subarray(20 + length), head = new Uint32Array([0x46546C67, 2, 20 + text.length + rest.length, text.length, 0x4E4F534A]);
    return URL.createObjectURL(new Blob([head, text, rest]));
}

export async function open(place, shadow) {
    const head = new TalkingHead(place, { ttsEndpoint: 'none', lipsyncModules: [], cameraView: 'head', modelFPS: 60, modelPixelRatio: 1 });
    const names = [...new Set([...head.posePropNames.map((name) => name.split('.')[0]), 'LeftEye', 'RightEye'])];
    await head.showAvatar({ url: await under('/asset.glb', head.opt.modelRoot, names), body: 'F', avatarMood: 'neutral' });
    head.stop(); // the comparison asks for frames
    const view = cameraOf(boundsAtRest(head.armature, new Box3(), new Box3())), { camera, renderer, scene } = head;
    Object.assign(camera, { fov: 30, aspect: 1, near: view.near, far: view.far });
    camera.updateProjectionMatrix();
    camera.position.set(...view.eye);
    camera.lookAt(new Vector3(...view.centre));
    renderer.shadowMap.enabled = shadow;
    return { version: `TalkingHead ${model.version}`, gl: renderer.getContext(), draw: () => renderer.render(scene, camera) };
}
