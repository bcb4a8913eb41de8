// compare_element_babylon.js: the side of Babylon.js: its physical materials in an environment that it brings, and a light
// that may cast a shadow.
import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { DirectionalLight } from '@babylonjs/core/Lights/directionalLight.js';
import { HemisphericLight } from '@babylonjs/core/Lights/hemisphericLight.js';
import { ShadowGenerator } from '@babylonjs/core/Lights/Shadows/shadowGenerator.js';
import { ImportMeshAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Scene } from '@babylonjs/core/scene.js';
import '@babylonjs/loaders/glTF/2.0/glTFLoader.js';
import { cameraOf } from './compare_shared.js';

export async function open(place, shadow) {
    const canvas = Object.assign(document.createElement('canvas'), { width: 512, height: 512 }), engine = new Engine(canvas, true, { stencil: false }), scene = new Scene(engine);
    place.append(canvas);
    scene.useRightHandedSystem = true;
    scene.skipPointerMovePicking = true;
    const loaded = await ImportMeshAsync('/asset.glb', scene), { min, max } = scene.getWorldExtends();
    for (const group of loaded.animationGroups) group.dispose();
    const view = cameraOf([...min.asArray(), ...max.asArray()]), camera = new FreeCamera('camera', new Vector3(...view.eye), scene);
    camera.setTarget(new Vector3(...view.centre));
    Object.assign(camera, { fov: Math.PI / 6, minZ: view.near, maxZ: view.far });
    const key = new DirectionalLight('key', new Vector3(...view.key.map((k) => -k)), scene), sky = new HemisphericLight('sky', new Vector3(0, 1, 0), scene);
    Object.assign(key, { intensity: 2, position: new Vector3(...view.eye) });
    sky.intensity = 0.5;
    if (shadow) {
        const map = new ShadowGenerator(512, key); // as noh's
        map.bias = 0.01;
        for (const mesh of loaded.meshes) {
            map.addShadowCaster(mesh);
            mesh.receiveShadows = true;
        }
    }
    await scene.whenReadyAsync();
    return { version: `Babylon.js ${Engine.Version}`, gl: engine._gl, draw: () => scene.render() };
}
