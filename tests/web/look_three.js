// look_three.js: a model by three.js in noh's light, exposure, tone map and camera. `standard`: as GLTFLoader makes it, lit
// by the panorama alone. `physical`: as an artist dresses it: MeshPhysicalMaterial with fuzz on skin and a clear coat on
// eyes, the brightest lamp of the panorama as a light with a soft shadow. look.js waits for window.look.
import * as THREE from 'three';
import { GLTFLoader } from 'three/loaders/GLTFLoader.js';
import { MeshoptDecoder } from 'three/libs/meshopt_decoder.module.js';
import { HDRLoader } from 'three/loaders/HDRLoader.js';

const query = new URLSearchParams(window.location.search), side = Number(query.get('side'));
const lights = new Map(); // by file

async function lightOf(generator, name) {
    if (!lights.has(name)) {
        const panorama = await new HDRLoader().loadAsync(`/out/${name}.hdr`);
        lights.set(name, generator.fromEquirectangular(panorama).texture);
    }
    return lights.get(name);
}

function physicalOf(standard) {
    if (!standard.isMeshStandardMaterial) return standard;
    const made = new THREE.MeshPhysicalMaterial();
    if (standard.isMeshPhysicalMaterial) made.copy(standard);
    else THREE.MeshStandardMaterial.prototype.copy.call(made, standard);
    made.defines = { STANDARD: '', PHYSICAL: '' };
    if (/eye(?!brow|lash|line)|iris|cornea/i.test(standard.name)) made.clearcoat = 1;
    else if (/skin|face|head|body/i.test(standard.name)) {
        made.ior = 1.4;
        made.sheen = 0.25;
        made.sheenRoughness = 0.5;
        made.sheenColor = new THREE.Color(0.9, 0.6, 0.5);
    }
    return made;
}

function sunOf(box) {
    const sun = new THREE.DirectionalLight(), sphere = box.getBoundingSphere(new THREE.Sphere()), eye = sun.shadow.camera;
    sun.castShadow = true;
    sun.shadow.mapSize.set(1024, 1024);
    sun.shadow.radius = 4;
    sun.shadow.normalBias = sphere.radius * 0.004;
    eye.left = eye.bottom = -sphere.radius;
    eye.right = eye.top = sphere.radius;
    eye.near = 0;
    eye.far = 4 * sphere.radius;
    sun.target.position.copy(sphere.center);
    return { sun, sphere };
}

function setSun({ sun, sphere }, key) {
    const most = Math.max(...key.irradiance, 1e-6);
    sun.color.setRGB(...key.irradiance.map((e) => e / most));
    sun.intensity = most;
    sun.position.copy(sphere.center).addScaledVector(new THREE.Vector3(...key.direction), 2 * sphere.radius);
}

function setUp() {
    const canvas = document.getElementById('three');
    const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    const generator = new THREE.PMREMGenerator(renderer), camera = new THREE.PerspectiveCamera(30, 1, 0.02, 50);
    let scene, lamp, meshes;
    renderer.setSize(side, side);
    renderer.toneMapping = THREE.NeutralToneMapping;
    renderer.shadowMap.enabled = true;
    async function open(address) {
        const { scene: model } = await new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).loadAsync(address);
        scene = new THREE.Scene().add(model);
        meshes = [];
        model.updateMatrixWorld(true);
        lamp = sunOf(new THREE.Box3().setFromObject(model, true));
        model.traverse((node) => {
            if (!node.isMesh) return;
            node.castShadow = node.receiveShadow = true;
            node.frustumCulled = false;
            meshes.push({ node, standard: node.material, physical: physicalOf(node.material) });
        });
    }
    const shot = () => {
        renderer.render(scene, camera);
        return canvas.toDataURL('image/png');
    };
    async function draw(wanted) {
        const shots = {}, place = new THREE.Vector3(...wanted.camera.eye);
        camera.position.copy(place);
        camera.lookAt(place.add(new THREE.Vector3(...wanted.camera.forward)));
        renderer.toneMappingExposure = wanted.exposure;
        scene.environment = await lightOf(generator, wanted.light);
        scene.remove(lamp.sun, lamp.sun.target);
        for (const m of meshes) m.node.material = m.standard;
        shots.three_standard = shot();
        scene.environment = await lightOf(generator, `${wanted.light}_rest`);
        setSun(lamp, wanted.key);
        scene.add(lamp.sun, lamp.sun.target);
        for (const m of meshes) m.node.material = m.physical;
        lamp.sun.castShadow = true;
        shots.three_physical = shot();
        if (wanted.front) {
            lamp.sun.castShadow = false;
            shots.three_unshadowed = shot();
        }
        return shots;
    }
    return { open, draw };
}

window.look = setUp();
