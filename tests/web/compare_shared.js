// compare_shared.js: what the sides of the comparison share: the camera, the fragment shader, the bytes of a context.

// Fits a box as the page does: 30 degrees high, from the front and a little above.
export function cameraOf(bounds) {
    const centre = [0, 1, 2].map((c) => (bounds[c] + bounds[3 + c]) / 2), half = [0, 1, 2].map((c) => (bounds[3 + c] - bounds[c]) / 2);
    const radius = Math.hypot(...half), need = Math.max(half[1], half[0], half[2] * 0.7) * 1.05, slope = Math.tan(Math.PI / 12);
    const distance = Math.max(need / slope + half[2], radius * 1.02), se = Math.sin(0.05), ce = Math.cos(0.05);
    const eye = [centre[0], centre[1] + se * distance, centre[2] + ce * distance];
    const right = [1, 0, 0], up = [0, ce, -se], back = [0, se, ce];
    const key = right.map((r, i) => -0.45 * r + 0.62 * up[i] + 0.64 * back[i]), size = Math.hypot(...key);
    return { centre, eye, near: Math.max(distance - 2 * radius, distance * 0.02), far: distance + 2 * radius, key: key.map((k) => k / size), right, up, back };
}

// Of the meshes below an object of three.js at rest: its own bounds have room for all targets.
export function boundsAtRest(object, box, part) {
    object.updateMatrixWorld(true);
    object.traverse((mesh) => { if (mesh.isMesh) box.union(part.setFromBufferAttribute(mesh.geometry.attributes.position).applyMatrix4(mesh.matrixWorld)); });
    return [...box.min.toArray(), ...box.max.toArray()];
}

// Columns.
export function matrixOf({ eye, near, far, right, up, back }) {
    const f = 1 / Math.tan(Math.PI / 12), dot = (a) => a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2];
    const view = [0, 1, 2].flatMap((c) => [right[c], up[c], back[c], 0]).concat([-dot(right), -dot(up), -dot(back), 1]);
    const projection = [f, 0, 0, 0, 0, f, 0, 0, 0, 0, -(far + near) / (far - near), -1, 0, 0, -2 * far * near / (far - near), 0];
    return view.map((_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + projection[4 * k + i % 4] * view[4 * (i >> 2) + k], 0));
}

// shaders_es/mesh.frag as noh compiles it for these materials.
export async function fragmentShader() {
    const names = ['common_fade.glsl', 'common_fragment.glsl', 'common_wrinkle.glsl', 'common_material.glsl', 'common_light.glsl', 'mesh.frag'];
    const texts = await Promise.all(names.map(async (name) => (await fetch('/shaders/' + name)).text()));
    return '#define NOH_DEBUG_VIEW 0\n#define NOH_ENCODE_SRGB\n' + texts.join('\n').replace(/#version.*\n/, '');
}

const texelBytes = (gl) => new Map([[gl.RGBA32F, 16], [gl.RGB32F, 12], [gl.RGBA16F, 8], [gl.RGBA32UI, 16], [gl.RGBA16I, 8], [gl.RGBA16UI, 8],
    [gl.RGB16F, 6], [gl.R8, 1], [gl.RG8, 2], [gl.R32F, 4], [gl.RG32F, 8], [gl.RGB8, 3], [gl.DEPTH_COMPONENT16, 2], [gl.COMPRESSED_RGB8_ETC2 || 0x9274, 0.5]]);

// Counts what a context is given, from its first moment: of each buffer, texture and renderbuffer what it was given last.
// Other formats count as 4 bytes a texel. The canvas itself is not counted.
export function countBytes(canvas) {
    const create = canvas.getContext.bind(canvas), held = new Map();
    let contexts = 0;
    canvas.getContext = (...args) => {
        const gl = create(...args);
        if (gl && !contexts++) watch(gl, held);
        return gl;
    };
    return () => [...held.values()].reduce((sum, faces) => sum + [...faces.values()].reduce((all, bytes) => all + bytes, 0), 0);
}

function watch(gl, held) {
    const bound = new Map(), sizes = texelBytes(gl), texels = (format) => sizes.get(format) || 4;
    let unit = gl.TEXTURE0;
    const wrap = (name, before) => {
        const original = gl[name].bind(gl);
        gl[name] = (...args) => { before(...args); return original(...args); };
    };
    const place = (target) => (target >= gl.TEXTURE_CUBE_MAP_POSITIVE_X && target < gl.TEXTURE_CUBE_MAP_POSITIVE_X + 6 ? gl.TEXTURE_CUBE_MAP : target);
    const give = (key, part, bytes) => {
        const object = bound.get(key);
        if (!object) return;
        if (!held.has(object)) held.set(object, new Map());
        held.get(object).set(part, bytes);
    };
    const levels = (count, w, h, d, each) => Array.from({ length: count }, (_, l) => Math.max(1, w >> l) * Math.max(1, h >> l) * d * each).reduce((a, b) => a + b, 0);
    wrap('activeTexture', (u) => { unit = u; });
    wrap('bindTexture', (target, object) => bound.set(`${unit} ${target}`, object));
    wrap('bindBuffer', (target, object) => bound.set(target, object));
    wrap('bindBufferBase', (target, index, object) => bound.set(target, object));
    wrap('bindBufferRange', (target, index, object) => bound.set(target, object));
    wrap('bindRenderbuffer', (target, object) => bound.set(target, object));
    // the index buffer is the vertex array's: each has its own
    wrap('bindVertexArray', () => bound.delete(gl.ELEMENT_ARRAY_BUFFER));
    wrap('bufferData', (target, data) => give(target, 'all', typeof data === 'number' ? data : data.byteLength));
    wrap('renderbufferStorage', (target, format, w, h) => give(target, 'all', w * h * texels(format)));
    wrap('texStorage2D', (target, count, format, w, h) => give(`${unit} ${target}`, 'all', levels(count, w, h, target === gl.TEXTURE_CUBE_MAP ? 6 : 1, texels(format))));
    wrap('texStorage3D', (target, count, format, w, h, d) => give(`${unit} ${target}`, 'all', levels(count, w, h, d, texels(format))));
    wrap('texImage2D', (target, level, format, w, h) => give(`${unit} ${place(target)}`, `${target} ${level}`, typeof h === 'number' && h < 1e5 ? w * h * texels(format) : 0));
    wrap('texImage3D', (target, level, format, w, h, d) => give(`${unit} ${target}`, level, w * h * d * texels(format)));
    for (const kind of ['Buffer', 'Texture', 'Renderbuffer']) wrap(`delete${kind}`, (object) => held.delete(object));
}
