// compare_babylon.js: the side of Babylon.js. Bundled by esbuild, so that only what is used is counted.
import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import { RawTexture } from '@babylonjs/core/Materials/Textures/rawTexture.js';
import { ShaderMaterial } from '@babylonjs/core/Materials/shaderMaterial.js';
import { ShaderStore } from '@babylonjs/core/Engines/shaderStore.js';
import { Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3, Vector4 } from '@babylonjs/core/Maths/math.vector.js';
import { Scene } from '@babylonjs/core/scene.js';
import { ImportMeshAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import '@babylonjs/core/Shaders/ShadersInclude/morphTargetsVertex.js';
import '@babylonjs/core/Shaders/ShadersInclude/morphTargetsVertexDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/morphTargetsVertexGlobal.js';
import '@babylonjs/core/Shaders/ShadersInclude/morphTargetsVertexGlobalDeclaration.js';
import '@babylonjs/loaders/glTF/2.0/glTFLoader.js';
import { cameraOf, fragmentShader } from './compare_shared.js';

const vertexShader = `
precision highp float;
attribute vec3 position;
attribute vec3 normal;
attribute vec2 uv;
attribute vec4 color;
uniform mat4 world, viewProjection;
varying vec3 v_world;
varying vec3 v_normal;
varying vec3 v_model;
varying vec4 v_tangent;
varying vec4 v_color;
varying vec2 v_uv;
#include<morphTargetsVertexGlobalDeclaration>
#include<morphTargetsVertexDeclaration>[0..maxSimultaneousMorphTargets]
void main(void)
{
    vec3 positionUpdated = position, normalUpdated = normal;
#include<morphTargetsVertexGlobal>
#include<morphTargetsVertex>[0..maxSimultaneousMorphTargets]
    v_world = (world * vec4(positionUpdated, 1.0)).xyz;
    v_normal = mat3(world) * normalUpdated;
    v_model = positionUpdated;
    v_tangent = vec4(0.0);
    v_uv = uv;
    v_color = color;
    gl_Position = viewProjection * vec4(v_world, 1.0);
}`;

function shadeAsNoh(scene, from, view, white) {
    const m = new ShaderMaterial(from.name, scene, 'noh', {
        attributes: ['position', 'normal', 'uv', 'color'], needAlphaBlending: from.needAlphaBlending(),
        uniforms: ['world', 'viewProjection', 'noh_camera', 'noh_key', 'noh_base_color', 'noh_material', 'noh_f0', 'noh_bounds_min', 'noh_bounds_size'],
        samplers: ['noh_base_color_texture'],
    });
    m.backFaceCulling = from.backFaceCulling;
    m.sideOrientation = from.sideOrientation;
    m.setVector3('noh_camera', new Vector3(...view.eye));
    m.setVector3('noh_key', new Vector3(...view.key));
    m.setVector4('noh_base_color', new Vector4(from.albedoColor.r, from.albedoColor.g, from.albedoColor.b, from.alpha));
    m.setVector4('noh_material', new Vector4(from.roughness, from.metallic, -1, 0));
    m.setVector3('noh_f0', new Vector3(0.04, 0.04, 0.04));
    m.setVector3('noh_bounds_min', new Vector3(0, 0, 0));
    m.setVector3('noh_bounds_size', new Vector3(1, 1, 1));
    m.setTexture('noh_base_color_texture', from.albedoTexture || white);
    return m;
}

// The same geometry without its targets, in a scene of its own.
function atRest(mesh) {
    const rest = mesh.clone(`${mesh.name} at rest`, mesh.parent);
    Object.assign(rest, { morphTargetManager: null, hasVertexAlpha: mesh.hasVertexAlpha });
    rest.material = mesh.material.clone(`${mesh.material.name} at rest`);
    return rest;
}

export async function open(canvas, bounds, names) {
    const view = cameraOf(bounds), engine = new Engine(canvas, true, { preserveDrawingBuffer: true, stencil: false });
    const scene = new Scene(engine);
    scene.useRightHandedSystem = true;
    scene.clearColor = new Color4(0.3035, 0.3094, 0.3227, 1);
    scene.skipPointerMovePicking = true;
    const camera = new FreeCamera('camera', new Vector3(...view.eye), scene);
    camera.setTarget(new Vector3(...view.centre));
    Object.assign(camera, { fov: Math.PI / 6, minZ: view.near, maxZ: view.far });
    ShaderStore.ShadersStore.nohVertexShader = vertexShader;
    ShaderStore.ShadersStore.nohFragmentShader = 'precision highp float;\n' + await fragmentShader();
    const white = RawTexture.CreateRGBATexture(new Uint8Array([255, 255, 255, 255]), 1, 1, scene, false, false);
    const loaded = await ImportMeshAsync('/asset.glb', scene);
    const meshes = loaded.meshes.filter((mesh) => mesh.getTotalVertices() > 0);
    for (const mesh of meshes) {
        mesh.hasVertexAlpha = mesh.material.needAlphaBlending(); // colours of four components would blend what is opaque
        mesh.material = shadeAsNoh(scene, mesh.material, view, white);
    }
    const rest = meshes.map(atRest);
    for (const group of loaded.animationGroups) group.dispose();
    const managers = meshes.map((mesh) => mesh.morphTargetManager);
    const targets = managers.map((manager) => names.map((name) => Array.from({ length: manager.numTargets }, (_, i) => manager.getTarget(i)).find((t) => t.name === name)));
    let shown = null;
    const draw = (weights) => {
        if (shown !== !!weights) {
            for (const mesh of meshes) mesh.setEnabled(!!weights);
            for (const mesh of rest) mesh.setEnabled(!weights);
            shown = !!weights;
        }
        for (let m = 0; weights && m < meshes.length; m++) {
            for (let t = 0; t < names.length; t++) targets[m][t].influence = weights[t];
        }
        scene.render();
    };
    await scene.whenReadyAsync();
    return { version: `Babylon.js ${Engine.Version}`, gl: engine._gl, resize: (pixels) => engine.setSize(pixels, pixels), draw, isReady: () => scene.isReady() && meshes.every((mesh) => mesh.isReady(true)) };
}
