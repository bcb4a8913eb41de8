// look_page.js: a model by three.js's standard materials in the light of its room, with the camera of `noh render`. look.js
// waits for window.look.
import * as THREE from 'three';
import { GLTFLoader } from 'three/loaders/GLTFLoader.js';
import { RoomEnvironment } from 'three/environments/RoomEnvironment.js';

// As orbit_fit and orbit_camera in tools/noh/draw/camera.c.
function cameraOf(box) {
    const centre = box.getCenter(new THREE.Vector3()), half = box.getSize(new THREE.Vector3()).multiplyScalar(0.5);
    const radius = half.length(), need = Math.max(half.y, half.x, half.z * 0.7) * 1.05;
    const distance = Math.max(need / Math.tan(Math.PI / 12) + half.z, radius * 1.02);
    const camera = new THREE.PerspectiveCamera(30, 1, Math.max(distance - 2 * radius, distance * 0.02), distance + 2 * radius);
    camera.position.copy(centre).add(new THREE.Vector3(0, Math.sin(0.05), Math.cos(0.05)).multiplyScalar(distance));
    camera.lookAt(centre);
    return camera;
}

async function draw() {
    const renderer = new THREE.WebGLRenderer({ canvas: document.getElementById('three'), antialias: true, preserveDrawingBuffer: true });
    const { scene: model } = await new GLTFLoader().loadAsync('/asset.glb');
    const scene = new THREE.Scene();
    renderer.toneMapping = THREE.ACESFilmicToneMapping;
    scene.environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;
    scene.background = scene.environment;
    scene.backgroundBlurriness = 0.5;
    scene.add(model);
    model.updateMatrixWorld(true);
    renderer.render(scene, cameraOf(new THREE.Box3().setFromObject(model, true)));
    await document.getElementById('noh').decode();
    return { three: THREE.REVISION };
}

draw().then((about) => { window.look = about; }, (error) => { window.look = { error: String(error) }; });
