// gl.js: the functions of OpenGL ES 3.0 that the program imports, on a WebGL 2 context. GL uses numbers for WebGL's
// objects, and addresses for WebGL's memory views. A frame allocates nothing: views are passed with offsets.

// Functions without objects or addresses have the same name in WebGL.
const plain = ['Enable', 'Disable', 'BlendFunc', 'BlendFuncSeparate', 'BlendEquation', 'BlendEquationSeparate', 'Viewport', 'Scissor', 'DepthFunc', 'DepthMask', 'ColorMask',
    'FrontFace', 'IsEnabled', 'GetError', 'EnableVertexAttribArray', 'VertexAttribPointer', 'VertexAttribIPointer', 'VertexAttribDivisor', 'VertexAttrib4f',
    'VertexAttribI4i', 'ActiveTexture', 'TexStorage2D', 'TexStorage3D', 'TexParameteri', 'PixelStorei', 'CheckFramebufferStatus', 'ReadBuffer',
    'RenderbufferStorageMultisample', 'DrawElements', 'DrawElementsInstanced', 'DrawArraysInstanced', 'Flush'];

// The meaning of a number, by letter. s: a shader, p: a program, u: a uniform location, b, v, t, f, r, m: a buffer, a
// vertex array, a texture, a framebuffer, a renderbuffer, a sampler; n: a number.
const mapped = {
    AttachShader: 'ps', CompileShader: 's', UseProgram: 'p', UniformBlockBinding: 'pnn', Uniform1i: 'un', Uniform1f: 'un', Uniform2i: 'unn',
    Uniform3i: 'unnn', Uniform4i: 'unnnn', Uniform2f: 'unn', Uniform3f: 'unnn', Uniform4f: 'unnnn', BindBuffer: 'nb', BindBufferBase: 'nnb',
    BindBufferRange: 'nnbnn', BindVertexArray: 'v', BindTexture: 'nt', BindFramebuffer: 'nf', FramebufferTexture2D: 'nnntn',
    FramebufferTextureLayer: 'nntnn', BindRenderbuffer: 'nr', BindSampler: 'nm',
};

const COMPRESSED_ETC = 'WEBGL_compressed_texture_etc';
const COMPRESSED_ASTC = 'WEBGL_compressed_texture_astc';
const extensions = ['EXT_color_buffer_float', 'EXT_color_buffer_half_float', 'EXT_float_blend', COMPRESSED_ETC, COMPRESSED_ASTC];

// The memory view for texels of a type, and the bytes per element as a shift.
function viewOf(gl, type) {
    switch (type) {
        case gl.UNSIGNED_BYTE: return ['U8', 0];
        case gl.BYTE: return ['I8', 0];
        case gl.SHORT: return ['I16', 1];
        case gl.UNSIGNED_SHORT: case gl.HALF_FLOAT: return ['U16', 1];
        case gl.INT: return ['I32', 2];
        case gl.FLOAT: return ['F32', 2];
        default: return ['U32', 2];
    }
}

// Objects by number, from 1; 0 is none.
class Names {
    constructor() {
        this.objects = [null];
        this.free = [];
    }

    add(object) {
        const name = this.free.length ? this.free.pop() : this.objects.length;
        this.objects[name] = object;
        return name;
    }

    take(name) {
        const object = this.objects[name];
        if (!name || !object) return null;
        this.objects[name] = null;
        this.free.push(name);
        return object;
    }
}

const decoder = new TextDecoder(), encoder = new TextEncoder();

// C strings in a heap, whose views are U8, U32 and so on.
export function textAt(heap, at, length) {
    let end = at;
    if (length === undefined) while (heap.U8[end]) end++;
    return decoder.decode(heap.U8.subarray(at, length === undefined ? end : at + length));
}

// Returns the number of bytes written, without the zero.
function writeText(heap, text, at, room) {
    if (!room) return 0;
    const bytes = encoder.encode(text).subarray(0, room - 1);
    heap.U8.set(bytes, at);
    heap.U8[at + bytes.length] = 0;
    return bytes.length;
}

// gl.bindBuffer('buffer', number) and so on, by the letters of `mapped`.
function addMapped(out, gl, kinds) {
    const by = { s: kinds.shaders, p: kinds.programs, u: kinds.uniforms, b: kinds.buffers, v: kinds.arrays, t: kinds.textures, f: kinds.framebuffers, r: kinds.renderbuffers, m: kinds.samplers };
    for (const [name, letters] of Object.entries(mapped)) {
        const call = gl[name[0].toLowerCase() + name.slice(1)].bind(gl);
        const [a, b, c, d] = [...letters].map((l) => (by[l] ? by[l].objects : null));
        const object = (list, n) => (list ? list[n] || null : n);
        out[`gl${name}`] = letters.length === 1 ? (x) => call(object(a, x))
            : letters.length === 2 ? (x, y) => call(object(a, x), object(b, y))
                : letters.length === 3 ? (x, y, z) => call(object(a, x), object(b, y), object(c, z))
                    : (x, y, z, w, q) => call(object(a, x), object(b, y), object(c, z), object(d, w), q);
    }
}

// Gen and Delete, of n names each.
function addNamed(out, gl, heap, what, names, make, remove) {
    out[`glGen${what}`] = (n, at) => {
        for (let i = 0; i < n; i++) heap.U32[(at >> 2) + i] = names.add(make.call(gl));
    };
    out[`glDelete${what}`] = (n, at) => {
        for (let i = 0; i < n; i++) {
            const object = names.take(heap.U32[(at >> 2) + i]);
            if (object) remove.call(gl, object);
        }
    };
}

// Programs that a stage has deleted, by their sources, for the next stage on the context: with another light, or with all
// levels of the pack.
const spares = new WeakMap(), sources = new WeakMap();
function sparesOf(gl) {
    if (!spares.has(gl)) spares.set(gl, new Map());
    return spares.get(gl);
}
export function forgetPrograms(gl) {
    for (const program of sparesOf(gl).values()) gl.deleteProgram(program);
    spares.delete(gl);
}

const keyOf = (gl, program, varyings) => [...gl.getAttachedShaders(program).map((shader) => gl.getShaderSource(shader)), varyings].join('\0');

const idle = () => new Promise((resolve) => (globalThis.requestIdleCallback ? requestIdleCallback(resolve, { timeout: 2000 }) : setTimeout(resolve, 200)));
const COMPLETION_STATUS = 0x91B1;
const linksMs = 50, longestLinks = 40; // between two looks at a program; looks

// Makes programs in idle time, for a stage to come. list: of each its two sources.
export async function linkAhead(gl, list) {
    const tells = gl.getExtension('KHR_parallel_shader_compile');
    for (const texts of list) {
        await idle();
        if (gl.isContextLost()) return;
        const program = gl.createProgram();
        texts.forEach((text, i) => {
            const shader = gl.createShader(i ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
            gl.shaderSource(shader, text);
            gl.compileShader(shader);
            gl.attachShader(program, shader);
            gl.deleteShader(shader);
        });
        gl.linkProgram(program);
        for (let i = 0; tells && i < longestLinks && !gl.isContextLost() && !gl.getProgramParameter(program, COMPLETION_STATUS); i++) await new Promise((resolve) => setTimeout(resolve, linksMs));
        const key = keyOf(gl, program);
        if (gl.isContextLost() || sparesOf(gl).has(key)) {
            gl.deleteProgram(program);
            continue;
        }
        sources.set(program, key);
        sparesOf(gl).set(key, program);
    }
}

function addShaders(out, gl, heap, { shaders, programs, uniforms }) {
    const ofProgram = new Map(); // the uniforms of each program, deleted with it
    const varyings = new Map();
    const tell = (value, at) => { heap.I32[at >> 2] = value; };
    const log = (text, room, length, at) => {
        const written = writeText(heap, text || '', at, room);
        if (length) tell(written, length);
    };
    out.glCreateShader = (type) => shaders.add(gl.createShader(type));
    out.glShaderSource = (shader, count, strings, lengths) => {
        let source = '';
        for (let i = 0; i < count; i++) {
            const length = lengths ? heap.I32[(lengths >> 2) + i] : -1;
            source += textAt(heap, heap.U32[(strings >> 2) + i], length < 0 ? undefined : length);
        }
        gl.shaderSource(shaders.objects[shader], source);
    };
    out.glGetShaderiv = (shader, what, at) => {
        const value = what === 0x8B84 ? (gl.getShaderInfoLog(shaders.objects[shader]) || '').length + 1 : gl.getShaderParameter(shaders.objects[shader], what);
        tell(Number(value), at);
    };
    out.glGetShaderInfoLog = (shader, room, length, at) => log(gl.getShaderInfoLog(shaders.objects[shader]), room, length, at);
    out.glDeleteShader = (shader) => { gl.deleteShader(shaders.take(shader)); };
    out.glCreateProgram = () => programs.add(gl.createProgram());
    out.glGetProgramiv = (program, what, at) => {
        const value = what === 0x8B84 ? (gl.getProgramInfoLog(programs.objects[program]) || '').length + 1 : gl.getProgramParameter(programs.objects[program], what);
        tell(Number(value), at);
    };
    out.glGetProgramInfoLog = (program, room, length, at) => log(gl.getProgramInfoLog(programs.objects[program]), room, length, at);
    out.glLinkProgram = (name) => {
        const program = programs.objects[name], key = keyOf(gl, program, varyings.get(name));
        const spare = sparesOf(gl).get(key);
        varyings.delete(name);
        if (!spare) {
            gl.linkProgram(program);
            sources.set(program, key);
            return;
        }
        gl.deleteProgram(program);
        programs.objects[name] = spare;
        sparesOf(gl).delete(key);
    };
    out.glDeleteProgram = (name) => {
        const program = programs.take(name), key = program && sources.get(program);
        for (const uniform of ofProgram.get(name) || []) uniforms.take(uniform);
        ofProgram.delete(name);
        if (!key || sparesOf(gl).has(key) || !gl.getProgramParameter(program, gl.LINK_STATUS)) gl.deleteProgram(program);
        else sparesOf(gl).set(key, program);
    };
    out.glGetActiveAttrib = (program, index, room, length, size, type, name) => {
        const found = gl.getActiveAttrib(programs.objects[program], index);
        if (!found) return;
        tell(found.size, size);
        tell(found.type, type);
        log(found.name, room, length, name);
    };
    out.glGetAttribLocation = (program, name) => gl.getAttribLocation(programs.objects[program], textAt(heap, name));
    out.glGetUniformBlockIndex = (program, name) => gl.getUniformBlockIndex(programs.objects[program], textAt(heap, name));
    out.glGetUniformLocation = (program, name) => {
        const found = gl.getUniformLocation(programs.objects[program], textAt(heap, name));
        if (!found) return -1;
        const uniform = uniforms.add(found);
        if (!ofProgram.has(program)) ofProgram.set(program, []);
        ofProgram.get(program).push(uniform);
        return uniform;
    };
    out.glUniform3fv = (uniform, count, at) => gl.uniform3fv(uniforms.objects[uniform] || null, heap.F32, at >> 2, 3 * count);
    out.glUniform4fv = (uniform, count, at) => gl.uniform4fv(uniforms.objects[uniform] || null, heap.F32, at >> 2, 4 * count);
    out.glUniformMatrix4fv = (uniform, count, transpose, at) => gl.uniformMatrix4fv(uniforms.objects[uniform] || null, transpose, heap.F32, at >> 2, 16 * count);
    out.glTransformFeedbackVaryings = (program, count, strings, mode) => {
        const names = Array.from({ length: count }, (_, i) => textAt(heap, heap.U32[(strings >> 2) + i]));
        varyings.set(program, names.join());
        gl.transformFeedbackVaryings(programs.objects[program], names, mode);
    };
}

// The number of a bound object; an object created by others gets a number, so that it can be bound again.
function nameOf(object, kinds) {
    const names = object instanceof WebGLFramebuffer ? kinds.framebuffers : object instanceof WebGLBuffer ? kinds.buffers
        : object instanceof WebGLTexture ? kinds.textures : object instanceof WebGLProgram ? kinds.programs
            : object instanceof WebGLVertexArrayObject ? kinds.arrays : object instanceof WebGLSampler ? kinds.samplers
                : object instanceof WebGLRenderbuffer ? kinds.renderbuffers : null;
    if (!names) return Number(object) || 0;
    const at = names.objects.indexOf(object);
    return at > 0 ? at : names.add(object);
}

function addData(out, gl, heap, kinds) {
    out.glClearBufferfv = (buffer, index, at) => gl.clearBufferfv(buffer, index, heap.F32, at >> 2);
    out.glGetIntegerv = (what, at) => {
        const value = what === 0x821D ? gl.getSupportedExtensions().length : what === 0x821B ? 3 : what === 0x821C ? 0 : gl.getParameter(what);
        if (value && value.length !== undefined) for (let i = 0; i < value.length; i++) heap.I32[(at >> 2) + i] = value[i];
        else heap.I32[at >> 2] = nameOf(value, kinds);
    };
    out.glGetFloatv = (what, at) => heap.F32.set(gl.getParameter(what), at >> 2);
    out.glGetIntegeri_v = (what, index, at) => { heap.I32[at >> 2] = nameOf(gl.getIndexedParameter(what, index), kinds); };
    out.glDepthRangef = (near, far) => gl.depthRange(near, far);
    out.glBufferData = (target, bytes, at, usage) => (at ? gl.bufferData(target, heap.U8, usage, at, bytes) : gl.bufferData(target, bytes, usage));
    out.glBufferSubData = (target, offset, bytes, at) => gl.bufferSubData(target, offset, heap.U8, at, bytes);
    out.glTexSubImage2D = (target, level, x, y, width, height, format, type, at) => {
        const [view, shift] = viewOf(gl, type);
        gl.texSubImage2D(target, level, x, y, width, height, format, type, heap[view], at >>> shift);
    };
    out.glTexSubImage3D = (target, level, x, y, z, width, height, depth, format, type, at) => {
        const [view, shift] = viewOf(gl, type);
        gl.texSubImage3D(target, level, x, y, z, width, height, depth, format, type, heap[view], at >>> shift);
    };
    out.glCompressedTexSubImage2D = (target, level, x, y, width, height, format, bytes, at) => {
        gl.compressedTexSubImage2D(target, level, x, y, width, height, format, heap.U8, at, bytes);
    };
    out.glReadPixels = (x, y, width, height, format, type, at) => {
        const [view, shift] = viewOf(gl, type);
        gl.readPixels(x, y, width, height, format, type, heap[view], at >>> shift);
    };
    out.glDrawBuffers = (count, at) => gl.drawBuffers(Array.from(heap.U32.subarray(at >> 2, (at >> 2) + count)));
}

export const baked = new Map(); // texels by environment, for all characters: they take half a second to compute

// The driver's name, if the browser reveals it.
function rendererOf(gl) {
    const info = gl.getExtension('WEBGL_debug_renderer_info');
    return (info && gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) || gl.getParameter(gl.RENDERER);
}

// GPUs of phones for which the full tier is much at the resolution of their screens: no faster than a Mali-G52, as far as
// `noh budget --gpu` and the number of their cores tell; and others that are known.
const slow = /Mali-(T|G31|G51|G52|G71|G72)|Adreno \(TM\) ([345]|6[01])\d|PowerVR|VideoCore|V3D/;
const fast = /Mali|Immortalis|Adreno|Apple|Xclipse|Intel|NVIDIA|GeForce|AMD|Radeon|Mesa|SwiftShader|llvmpipe|Basic Render/;

// How much shaders compute at each pixel (noh_shading): 'full' or 'phone', as asked for, otherwise by the GPU. An unknown
// GPU whose medium precision is less than its high one is a phone's: others compute both alike.
export function tierOf(gl, asked) {
    if (asked === 'full' || asked === 'phone') return asked;
    const name = rendererOf(gl);
    if (slow.test(name) || fast.test(name)) return slow.test(name) ? 'phone' : 'full';
    const medium = gl.getShaderPrecisionFormat(gl.FRAGMENT_SHADER, gl.MEDIUM_FLOAT);
    return medium && medium.precision < 23 ? 'phone' : 'full';
}

// Functions beyond GL (context.c, light.c).
function addOthers(gl, heap) {
    return {
        string(what, at, room) {
            const text = what === gl.RENDERER ? rendererOf(gl) : gl.getParameter(what) || '';
            writeText(heap, what === gl.VERSION ? `OpenGL ES 3.0 (${text})` : text, at, room);
        },
        extension: (index, at, room) => { writeText(heap, gl.getSupportedExtensions()[index] || '', at, room); },
        enable: () => { for (const name of extensions) gl.getExtension(name); },
        lost: () => Number(gl.isContextLost()),
        width: () => gl.drawingBufferWidth,
        height: () => gl.drawingBufferHeight,
        take_baked(environment, at, bytes) {
            const texels = baked.get(environment);
            if (!texels || texels.length !== bytes) return 0;
            heap.U8.set(texels, at);
            return 1;
        },
        keep_baked: (environment, at, bytes) => { baked.set(environment, heap.U8.slice(at, at + bytes)); },
        feedback: (begins) => (begins ? gl.beginTransformFeedback(gl.POINTS) : gl.endTransformFeedback()),
    };
}

// heap: { U8, I8, U16, I16, U32, I32, F32 }, whose views may be replaced. Returns { imports, textures, buffers }: the
// program's imports, and the objects by number.
export function importsOf(gl, heap) {
    const kinds = Object.fromEntries(['shaders', 'programs', 'uniforms', 'buffers', 'arrays', 'textures', 'framebuffers', 'renderbuffers', 'samplers'].map((kind) => [kind, new Names()]));
    const out = {};
    for (const name of plain) out[`gl${name}`] = gl[name[0].toLowerCase() + name.slice(1)].bind(gl);
    addMapped(out, gl, kinds);
    addNamed(out, gl, heap, 'Buffers', kinds.buffers, gl.createBuffer, gl.deleteBuffer);
    addNamed(out, gl, heap, 'VertexArrays', kinds.arrays, gl.createVertexArray, gl.deleteVertexArray);
    addNamed(out, gl, heap, 'Textures', kinds.textures, gl.createTexture, gl.deleteTexture);
    addNamed(out, gl, heap, 'Framebuffers', kinds.framebuffers, gl.createFramebuffer, gl.deleteFramebuffer);
    addNamed(out, gl, heap, 'Renderbuffers', kinds.renderbuffers, gl.createRenderbuffer, gl.deleteRenderbuffer);
    addShaders(out, gl, heap, kinds);
    addData(out, gl, heap, kinds);
    return { imports: { env: out, noh: addOthers(gl, heap) }, textures: kinds.textures.objects, buffers: kinds.buffers.objects };
}
