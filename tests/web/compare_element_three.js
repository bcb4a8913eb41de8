// compare_element_three.js: the side of three.js: its standard materials in an environment, with a light that may cast a shadow.
import { Box3, DirectionalLight, PerspectiveCamera, PMREMGenerator, REVISION, Scene, Vector3, WebGLRenderer } from 'three';
import { RoomEnvironment } from 'three/examples/jsm/environments/RoomEnvironment.js';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { boundsAtRest, cameraOf } from './compare_shared.js';

export async function open(place, shadow) {
    const renderer = new WebGLRenderer({ antialias: true }), scene = new Scene(), key = new DirectionalLight(0xffffff, 1);
    renderer.setSize(512, 512);
    place.append(renderer.domElement);
    scene.environment = new PMREMGenerator(renderer).fromScene(new RoomEnvironment()).texture;
    scene.add((await new GLTFLoader().loadAsync('/asset.glb')).scene, key);
    const box = new Box3(), view = cameraOf(boundsAtRest(scene, box, new Box3())), camera = new PerspectiveCamera(30, 1, view.near, view.far);
    camera.position.set(...view.eye);
    camera.lookAt(new Vector3(...view.centre));
    const radius = box.getSize(new Vector3()).length() / 2;
    key.position.set(...view.centre).addScaledVector(new Vector3(...view.key), 2 * radius);
    key.target.position.set(...view.centre);
    scene.add(key.target);
    renderer.shadowMap.enabled = key.castShadow = shadow;
    key.shadow.mapSize.set(512, 512); // as noh's
    Object.assign(key.shadow.camera, { left: -radius, right: radius, top: radius, bottom: -radius, near: radius / 2, far: 4 * radius });
    scene.traverse((object) => { if (object.isMesh) object.castShadow = object.receiveShadow = shadow; });
    return { version: `three.js r${REVISION}`, gl: renderer.getContext(), draw: () => renderer.render(scene, camera) };
}
