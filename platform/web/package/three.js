// three.js: a character in a three.js scene: noh deforms it on the context of three's renderer, into buffers that
// three's own materials draw. The scene, its lights and shadows treat it like any other object.
import { BufferAttribute, BufferGeometry, Color, DoubleSide, ExternalTexture, FrontSide, GLBufferAttribute, Group, Matrix4, Mesh, MeshBasicMaterial,
    MeshStandardMaterial, Sphere, Vector3 } from 'three';
import { Character } from './character.js';

const attributes = [['position', 3], ['normal', 3], ['tangent', 4], ['uv', 2], ['color', 4]];
const maps = ['map', 'normalMap', 'surface', 'emissiveMap'];
const FAR = 1e6;

// In textures with one bit of alpha, transparent texels are black, so filtered texels are darkened by their
// transparency.
function divided(shader) {
    shader.fragmentShader = shader.fragmentShader.replace('#include <map_fragment>',
        '#include <map_fragment>\n#ifdef USE_MAP\n\tdiffuseColor.rgb /= max(sampledDiffuseColor.a, 0.002);\n#endif');
}

// A character without a frame loop: three's renderer requests frames.
class Guest extends Character {
    constructor(object, options) {
        super(object.renderer.domElement, { ...options, light: 'plain', elsewhere: true });
        this.object = object;
    }

    around(call) { return this.object.apart(call); }
    use(program, first) { this.around(() => super.use(program, first)); }

    draw() {}
    redraw() {}
    resize() {}
    fit() {}
    releaseContext() {} // it belongs to three

    close() {
        if (this.program && !this.lost) this.program._web_vertices_close();
        super.close();
    }

    restore() {
        this.around(() => super.restore());
        this.object.restore();
    }
}

// A mesh with vertices only on the GPU: the library computes hits of rays.
class NohMesh extends Mesh {
    raycast(raycaster, found) { this.parent.pick(this, raycaster, found); }
}

export class NohObject3D extends Group {
    // renderer: a WebGLRenderer. options: as for Character; options for light and canvas have no effect.
    constructor(renderer, options = {}) {
        super();
        this.isNohObject3D = true;
        this.renderer = renderer;
        this.materials = [];
        this.meshes = [];
        this.view = new Matrix4();
        this.eye = new Vector3();
        this.character = new Guest(this, options);
        this.character.addEventListener('load', () => this.begin());
    }

    // An address, a Response, a File or Blob, or bytes of a pack. Resolves when the whole pack is loaded.
    async load(source) {
        await this.character.load(source);
        return this;
    }

    get program() { return this.character.program; }

    // ---- contents of the pack ----

    begin() {
        const p = this.program;
        this.apart(() => {
            p.check(p._web_vertices_open());
            this.box = p.floats(p._web_measure(), 6).slice();
        });
        this.clear();
        for (const mesh of this.meshes) mesh.geometry.dispose();
        const kept = new Map(this.materials.map((material) => [material.name, material])); // of the coarsest levels: changes stay
        this.materials = Array.from({ length: p._web_material_count() }, (_, i) => kept.get(p.text(p._web_material_name(i))) || this.materialOf(i));
        this.pictured = false;
        this.meshes = Array.from({ length: p._web_drawn_count() }, (_, i) => this.meshOf(i));
        if (this.meshes.length) this.add(...this.meshes);
    }

    materialOf(i) {
        const p = this.program, v = Array.from(p.floats(p._web_material(i), 15));
        const unlit = v[13] === 1, Kind = unlit ? MeshBasicMaterial : MeshStandardMaterial, material = new Kind({
            name: p.text(p._web_material_name(i)), color: new Color(v[0], v[1], v[2]), opacity: v[3], transparent: v[11] === 1, alphaTest: Math.max(0, v[9]),
            side: v[12] === 1 ? DoubleSide : FrontSide,
        });
        if (!unlit) Object.assign(material, { roughness: v[4], metalness: v[5], emissive: new Color(v[6], v[7], v[8]) });
        if (!unlit) material.normalScale.setScalar(v[10]);
        if (v[14] === 1) material.onBeforeCompile = divided;
        return material;
    }

    meshOf(i) {
        const p = this.program, { gl } = this.character, has = p._web_drawn_has(i), geometry = new BufferGeometry(), count = p._web_drawn_vertices(i);
        attributes.forEach(([name, size], out) => {
            const there = { tangent: has & 1, uv: has & 2, color: has & 4 }[name];
            if (there !== 0) geometry.setAttribute(name, new GLBufferAttribute(p.buffers[p._web_drawn_buffer(i, out)], gl.FLOAT, size, 4, count));
        });
        const levels = Array.from({ length: p._web_drawn_level_count(i) }, (_, level) => this.levelOf(i, level));
        if (has & 4) this.colored(levels);
        const { box } = this, middle = new Vector3(box[0] + box[3], box[1] + box[4], box[2] + box[5]).multiplyScalar(0.5);
        geometry.boundingSphere = new Sphere(middle, middle.distanceTo(new Vector3(box[3], box[4], box[5])));
        const mesh = new NohMesh(geometry, this.materials.length ? this.materials : new MeshStandardMaterial());
        Object.assign(mesh, { name: p.text(p._web_drawn_name(i)), frustumCulled: false, levels, level: -1 }); // it moves: only noh knows its bounds
        return mesh;
    }

    // Indices of a level, and their ranges by material.
    levelOf(i, level) {
        const p = this.program, count = p._web_drawn_index_count(i, level), at = p._web_drawn_indices(i, level);
        const Indices = p._web_drawn_index_bytes(i) === 4 ? Uint32Array : Uint16Array, parts = p._web_drawn_part_count(i, level);
        const words = new Uint32Array(p.memory.buffer, p._web_drawn_parts(i, level), 6 * parts);
        return {
            index: new BufferAttribute(new Indices(p.memory.buffer, at, count).slice(), 1),
            groups: Array.from({ length: parts }, (_, g) => ({ start: words[6 * g], count: words[6 * g + 1], material: words[6 * g + 2] })).filter((g) => g.count),
        };
    }

    colored(levels) {
        for (const { groups } of levels) for (const { material } of groups) if (this.materials[material]) this.materials[material].vertexColors = true;
    }

    show(mesh, level) {
        if (mesh.level === level) return;
        const { index, groups } = mesh.levels[level];
        mesh.level = level;
        mesh.geometry.setIndex(index);
        mesh.geometry.clearGroups();
        for (const { start, count, material } of groups) mesh.geometry.addGroup(start, count, material < this.materials.length ? material : 0);
    }

    // The library's textures, once created.
    picture() {
        const p = this.program, lent = new Map();
        const borrow = (name) => {
            if (!lent.has(name)) lent.set(name, new ExternalTexture(p.textures[name]));
            return lent.get(name);
        };
        this.materials.forEach((material, i) => {
            for (const [which, slot] of maps.entries()) {
                const name = p._web_material_picture(i, which), to = slot === 'surface' ? ['roughnessMap', 'metalnessMap', 'aoMap'] : [slot];
                if (name) for (const one of to) if (one in material) material[one] = borrow(name);
            }
            material.needsUpdate = true;
        });
        this.pictured = true;
    }

    // ---- frames ----

    // Calls of the library between three's, which do not know each other's GL state.
    apart(call) {
        const { renderer } = this, gl = renderer.getContext();
        renderer.resetState();
        for (const what of [gl.UNPACK_FLIP_Y_WEBGL, gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL]) gl.pixelStorei(what, false);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
        try {
            return call();
        } finally {
            gl.bindFramebuffer(gl.FRAMEBUFFER, null);
            renderer.resetState();
        }
    }

    // Advance time and deform the character for a camera. Call before renderer.render.
    update(seconds, camera) {
        const { character, renderer } = this;
        if (!character.loaded || character.lost) return;
        camera.updateMatrixWorld();
        this.updateWorldMatrix(true, false);
        const p = this.program, to = p.floats(p._web_view(), 22);
        this.view.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(this.matrixWorld);
        this.eye.setFromMatrixPosition(camera.matrixWorld);
        this.worldToLocal(this.eye);
        to.set(this.view.elements);
        to.set([this.eye.x, this.eye.y, this.eye.z, 0, 1, 0], 16);
        this.apart(() => {
            character.step(seconds);
            p.check(p._web_vertices(Math.max(1, renderer.domElement.height)));
        });
        if (!this.pictured) this.picture();
        this.meshes.forEach((mesh, i) => this.show(mesh, p._web_drawn_level(i)));
        character.frames++;
        character.emit('frame', { seconds });
    }

    // Recreate the buffers in a new context.
    restore() {
        const p = this.program, { gl } = this.character;
        if (!p) return;
        this.apart(() => p.check(p._web_vertices_restore()));
        this.pictured = false;
        this.meshes.forEach((mesh, i) => attributes.forEach(([name, size], out) => {
            const was = mesh.geometry.attributes[name];
            if (was) mesh.geometry.setAttribute(name, new GLBufferAttribute(p.buffers[p._web_drawn_buffer(i, out)], gl.FLOAT, size, 4, was.count));
        }));
    }

    // ---- rays ----

    pick(mesh, raycaster, found) {
        if (mesh !== this.meshes[0] || !this.character.loaded) return; // once for all
        const p = this.program, ray = raycaster.ray.clone().applyMatrix4(this.matrixWorld.clone().invert());
        const along = p._web_pick_ray(...ray.origin, ...ray.direction, FAR);
        if (along < 0) return;
        const point = new Vector3(...p.floats(p._web_hit_point(), 3)).applyMatrix4(this.matrixWorld), distance = raycaster.ray.origin.distanceTo(point);
        if (distance < raycaster.near || distance > raycaster.far) return;
        const name = p.text(p._web_picked_mesh()), object = this.meshes.find((m) => m.name === name) || mesh;
        found.push({ distance, point, object, joint: p.text(p._web_picked_joint()) });
    }

    // ---- the end ----

    dispose() {
        this.removeFromParent();
        const p = this.program;
        for (const mesh of this.meshes) mesh.geometry.dispose();
        for (const material of this.materials) material.dispose();
        if (p) this.apart(() => this.character.dispose());
        else this.character.dispose();
        this.clear();
        this.meshes = [];
        this.materials = [];
    }
}
