// compare_three.js: the side of three.js. Bundled by esbuild, so that only what is used is counted.
import { BufferGeometry, Color, DataTexture, GLSL3, Mesh, PerspectiveCamera, REVISION, Scene, ShaderMaterial, Vector3, Vector4, WebGLRenderer } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { cameraOf, fragmentShader } from './compare_shared.js';

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

function whiteTexture() {
    const white = new DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
    white.needsUpdate = true;
    return white;
}

const shadeAsNoh = (from, shader, view) => new ShaderMaterial({
    glslVersion: GLSL3, vertexShader, fragmentShader: shader, vertexColors: from.vertexColors, side: from.side, transparent: from.transparent,
    uniforms: {
        noh_camera: { value: new Vector3(...view.eye) },
        noh_key: { value: new Vector3(...view.key) },
        noh_base_color: { value: new Vector4(from.color.r, from.color.g, from.color.b, from.opacity) },
        noh_material: { value: new Vector4(from.roughness, from.metalness, from.alphaTest || -1, 0) },
        noh_f0: { value: new Vector3(0.04, 0.04, 0.04) },
        noh_base_color_texture: { value: from.map || whiteTexture() },
        noh_bounds_min: { value: new Vector3() },
        noh_bounds_size: { value: new Vector3(1, 1, 1) },
    },
});

// The same geometry without its targets.
function atRest(mesh) {
    const geometry = new BufferGeometry(), rest = new Mesh(geometry, mesh.material);
    geometry.setIndex(mesh.geometry.index);
    for (const [name, attribute] of Object.entries(mesh.geometry.attributes)) geometry.setAttribute(name, attribute);
    rest.applyMatrix4(mesh.matrixWorld);
    return rest;
}

// bounds: as noh measured them; names: of the targets.
export async function open(canvas, bounds, names) {
    const view = cameraOf(bounds), camera = new PerspectiveCamera(30, 1, view.near, view.far);
    const renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    const morphed = new Scene(), rest = new Scene(), shader = await fragmentShader(), meshes = [];
    camera.position.set(...view.eye);
    camera.lookAt(new Vector3(...view.centre));
    renderer.setClearColor(new Color().setRGB(0.075, 0.078, 0.085), 1);
    morphed.add((await new GLTFLoader().loadAsync('/asset.glb')).scene);
    morphed.updateMatrixWorld(true);
    morphed.traverse((object) => { if (object.isMesh) meshes.push(object); });
    for (const mesh of meshes) {
        mesh.material = shadeAsNoh(mesh.material, shader, view);
        rest.add(atRest(mesh));
    }
    const places = meshes.map((mesh) => names.map((name) => mesh.morphTargetDictionary[name]));
    return {
        version: `three.js r${REVISION}`,
        gl: renderer.getContext(),
        resize: (pixels) => renderer.setSize(pixels, pixels, false),
        // weights: of all names; null: the geometry without targets
        draw(weights) {
            for (let m = 0; weights && m < meshes.length; m++) {
                for (let t = 0; t < names.length; t++) meshes[m].morphTargetInfluences[places[m][t]] = weights[t];
            }
            renderer.render(weights ? morphed : rest, camera);
        },
    };
}
