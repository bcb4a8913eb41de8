// three_page.js: a scene of three.js with a character of noh, a box and a floor. three.js (the test) calls window.scene.
import { BoxGeometry, CanvasTexture, Color, DirectionalLight, HemisphereLight, Mesh, MeshStandardMaterial, PCFShadowMap, PerspectiveCamera, PlaneGeometry, Raycaster, REVISION,
    Scene, Vector2, WebGLRenderer } from 'three';
import { NohObject3D } from 'noh-character/three';

const renderer = new WebGLRenderer({ canvas: document.getElementById('canvas'), antialias: true, preserveDrawingBuffer: true });
const scene = new Scene(), camera = new PerspectiveCamera(30, 1, 0.01, 10), sun = new DirectionalLight(0xffffff, 2.5), objects = [];

function checked() {
    const canvas = Object.assign(document.createElement('canvas'), { width: 8, height: 8 }), to = canvas.getContext('2d');
    to.fillStyle = '#fff';
    to.fillRect(0, 0, 8, 8);
    to.fillStyle = '#c33';
    for (let i = 0; i < 8; i++) to.fillRect(i, i % 2, 1, 1);
    return new CanvasTexture(canvas);
}

function build() {
    renderer.setSize(200, 200, false);
    Object.assign(renderer.shadowMap, { enabled: true, type: PCFShadowMap });
    scene.background = new Color(0x4e5054);
    sun.position.set(0.6, 1.2, 0.9);
    sun.castShadow = true;
    Object.assign(sun.shadow.camera, { left: -0.6, right: 0.6, top: 0.6, bottom: -0.6, near: 0.1, far: 4 });
    const box = new Mesh(new BoxGeometry(0.08, 0.08, 0.08), new MeshStandardMaterial({ map: checked() }));
    const floor = new Mesh(new PlaneGeometry(2, 2), new MeshStandardMaterial({ color: 0x9a958c }));
    box.position.set(0.16, -0.08, 0.1);
    box.castShadow = true;
    floor.rotation.x = -Math.PI / 2;
    floor.position.y = -0.16;
    floor.receiveShadow = true;
    scene.add(sun, new HemisphereLight(0xbfd4ff, 0x4a3f36, 1.2), box, floor);
    camera.position.set(0.1, 0.1, 0.95);
    camera.lookAt(0, -0.01, 0);
}

async function add(source, x, options) {
    const object = new NohObject3D(renderer, options);
    scene.add(object);
    object.position.x = x;
    await object.load(source);
    for (const mesh of object.meshes) mesh.castShadow = mesh.receiveShadow = true;
    objects.push(object);
    return objects.length - 1;
}

function frame(seconds) {
    for (const object of objects) object.update(seconds, camera);
    renderer.render(scene, camera);
    return renderer.getContext().getError();
}

// What the GPU has of a mesh's attribute.
function read(i, mesh, name) {
    const gl = renderer.getContext(), { buffer, count, itemSize } = objects[i].meshes[mesh].geometry.attributes[name], out = new Float32Array(count * itemSize);
    gl.bindBuffer(gl.COPY_READ_BUFFER, buffer);
    gl.getBufferSubData(gl.COPY_READ_BUFFER, 0, out);
    gl.bindBuffer(gl.COPY_READ_BUFFER, null);
    return Array.from(out);
}

function hit(x, y) {
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(x, y), camera);
    return ray.intersectObjects(objects).map(({ distance, object, joint }) => ({ distance, mesh: object.name, joint }));
}

build();
window.scene = { renderer, scene, camera, objects, revision: REVISION, add, frame, read, hit };
