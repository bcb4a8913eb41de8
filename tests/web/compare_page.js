// compare_page.js: one asset drawn by noh and by three.js, in one page, at one size, with one camera. Both shade with
// noh's fragment shader (shaders_es/mesh.frag), so they differ only in how targets are summed and in the cost of a frame
// around it. ?path=gather forces noh's path. compare.js calls the functions of window.compare.
import * as THREE from 'three';
import { GLTFLoader } from 'three/loaders/GLTFLoader.js';
import { Arrival, compile } from '/noh/package/program.js';

let M = null; // noh's program
const text = (pointer) => M.text(pointer);
const check = (result) => { if (result) throw new Error(text(M._web_error())); };

// Every target is active, with other weights in every frame.
const weight = (target, frame) => 0.25 + 0.15 * Math.sin(0.7 * target + 0.3 * frame);

// Wait until a frame is drawn; the same for both sides.
const pixel = new Uint8Array(4);
const wait = (gl) => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);

// ---- noh ----

async function openNoh() {
    const gl = document.getElementById('canvas').getContext('webgl2', { alpha: false, preserveDrawingBuffer: true });
    const arrival = await Arrival.begin(await compile(), gl);
    arrival.push(new Uint8Array(await (await fetch('/noh/page.nohz')).arrayBuffer()));
    M = await arrival.open({ path: new URLSearchParams(location.search).get('path') || 'auto', characters: 1, alive: false });
    M.open();
    M._web_set_level(0); // all targets, however small
    const count = M._web_target_count();
    let atRest = true;
    return {
        count,
        names: Array.from({ length: count }, (_, i) => text(M._web_target_name(i))),
        bounds: Array.from(M.HEAPF32.subarray(M._web_measure() >> 2, (M._web_measure() >> 2) + 6)),
        path: text(M._web_path()),
        renderer: text(M._web_renderer()),
        draw(morphed, frame) {
            for (let t = 0; !(atRest && !morphed) && t < count; t++) M._web_hold(t, morphed ? weight(t, frame) : 0, 1);
            atRest = !morphed;
            check(M._web_step(0));
            check(M._web_draw());
            wait(gl);
        },
    };
}

// ---- the camera: that of the page ----

function placeCamera(bounds) {
    const low = new THREE.Vector3(...bounds.slice(0, 3)), high = new THREE.Vector3(...bounds.slice(3));
    const centre = low.clone().add(high).multiplyScalar(0.5), half = high.clone().sub(low).multiplyScalar(0.5);
    const radius = half.length(), need = Math.max(half.y, half.x, half.z * 0.7) * 1.05;
    const distance = Math.max(need / Math.tan(Math.PI / 12) + half.z, radius * 1.02);
    const camera = new THREE.PerspectiveCamera(30, 1, Math.max(distance - 2 * radius, distance * 0.02), distance + 2 * radius);
    camera.position.copy(centre).add(new THREE.Vector3(0, Math.sin(0.05), Math.cos(0.05)).multiplyScalar(distance));
    camera.lookAt(centre);
    camera.updateMatrixWorld();
    const key = new THREE.Vector3(-0.45, 0.62, 0.64).applyQuaternion(camera.quaternion).normalize();
    const all = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    M.HEAPF32.set([...all.elements, ...camera.position.toArray(), ...key.toArray()], M._web_view() >> 2); // matrix, eye, light
    return { camera, key };
}

// ---- three.js ----

const vertexShader = `
#include <common>
#include <morphtarget_pars_vertex>
out vec3 v_world, v_normal, v_model;
out vec4 v_tangent, v_color;
out vec2 v_uv;
void main()
{
    #include <beginnormal_vertex>
    #include <morphinstance_vertex>
    #include <morphnormal_vertex>
    #include <begin_vertex>
    #include <morphtarget_vertex>
    v_world = (modelMatrix * vec4(transformed, 1.0)).xyz;
    v_normal = mat3(modelMatrix) * objectNormal;
    v_model = transformed;
    v_tangent = vec4(0.0);
    v_uv = uv;
    v_color = vec4(1.0);
#ifdef USE_COLOR_ALPHA
    v_color = color;
#elif defined(USE_COLOR)
    v_color.rgb = color;
#endif
    gl_Position = projectionMatrix * viewMatrix * vec4(v_world, 1.0);
}`;

async function fragmentShader() {
    const names = ['common_fade.glsl', 'common_fragment.glsl', 'common_wrinkle.glsl', 'common_material.glsl', 'common_light.glsl', 'mesh.frag'];
    const texts = await Promise.all(names.map(async (name) => (await fetch('/shaders/' + name)).text()));
    return '#define NOH_DEBUG_VIEW 0\n#define NOH_ENCODE_SRGB\n' + texts.join('\n').replace(/#version.*\n/, '');
}

function whiteTexture() {
    const white = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
    white.needsUpdate = true;
    return white;
}

function shadeAsNoh(from, shader, view) {
    return new THREE.ShaderMaterial({
        glslVersion: THREE.GLSL3,
        vertexShader,
        fragmentShader: shader,
        vertexColors: from.vertexColors,
        side: from.side,
        transparent: from.transparent,
        uniforms: {
            noh_camera: { value: view.camera.position },
            noh_key: { value: view.key },
            noh_base_color: { value: new THREE.Vector4(from.color.r, from.color.g, from.color.b, from.opacity) },
            noh_material: { value: new THREE.Vector4(from.roughness, from.metalness, from.alphaTest || -1, 0) },
            noh_f0: { value: new THREE.Vector3(0.04, 0.04, 0.04) },
            noh_base_color_texture: { value: from.map || whiteTexture() },
            noh_bounds_min: { value: new THREE.Vector3() },
            noh_bounds_size: { value: new THREE.Vector3(1, 1, 1) },
        },
    });
}

// The same geometry without its targets.
function atRest(mesh) {
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(mesh.geometry.index);
    for (const [name, attribute] of Object.entries(mesh.geometry.attributes)) geometry.setAttribute(name, attribute);
    const rest = new THREE.Mesh(geometry, mesh.material);
    rest.applyMatrix4(mesh.matrixWorld);
    return rest;
}

async function openThree(view, names) {
    const canvas = document.getElementById('three');
    const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    const morphed = new THREE.Scene(), rest = new THREE.Scene(), shader = await fragmentShader();
    renderer.setClearColor(new THREE.Color().setRGB(0.075, 0.078, 0.085), 1);
    const { scene } = await new GLTFLoader().loadAsync('/asset.glb');
    morphed.add(scene);
    scene.updateMatrixWorld(true);
    const meshes = [];
    scene.traverse((object) => { if (object.isMesh) meshes.push(object); });
    for (const mesh of meshes) {
        mesh.material = shadeAsNoh(mesh.material, shader, view);
        rest.add(atRest(mesh));
    }
    const places = meshes.map((mesh) => names.map((name) => mesh.morphTargetDictionary[name]));
    const gl = renderer.getContext();
    return {
        draw(isMorphed, frame) {
            for (let m = 0; isMorphed && m < meshes.length; m++) {
                for (let t = 0; t < names.length; t++) meshes[m].morphTargetInfluences[places[m][t]] = weight(t, frame);
            }
            renderer.render(isMorphed ? morphed : rest, view.camera);
            wait(gl);
        },
    };
}

// ---- measuring ----

// Milliseconds per frame.
function sample(side, morphed, first, count) {
    const start = performance.now();
    for (let i = 0; i < count; i++) side.draw(morphed, first + i);
    return (performance.now() - start) / count;
}

async function start() {
    const noh = await openNoh();
    const view = placeCamera(noh.bounds);
    const three = await openThree(view, noh.names);
    const sides = { noh, three };
    window.compare = {
        about: { targets: noh.count, path: noh.path, renderer: noh.renderer, three: THREE.REVISION },
        draw(frame, morphed) { for (const side of Object.values(sides)) side.draw(morphed, frame); },
        // One round of all four, in an order that rotates from round to round.
        round(number, frames) {
            const all = Object.keys(sides).flatMap((name) => [false, true].map((morphed) => ({ name, morphed })));
            const out = {};
            for (let i = 0; i < 4; i++) {
                const { name, morphed } = all[(i + number) % 4];
                sample(sides[name], morphed, 1000 * number, 2); // warms up: not counted
                out[`${name} ${morphed ? 'morphed' : 'rest'}`] = sample(sides[name], morphed, 1000 * number, frames);
            }
            return out;
        },
    };
}

start().catch((error) => { window.compare = { error: String(error) }; });
