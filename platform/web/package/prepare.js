// prepare.js: a worker that makes a change of light quick: it opens a pack on a GL that draws nothing, in the lights that are
// not shown, and sends what took the time: the texels of each light, and the sources of the programs.
import { baked } from './gl.js';
import { Program } from './program.js';

// A WebGL context that knows no more than shaders and programs. links: receives the sources of each program.
function blankContext(links) {
    const known = {
        createShader: () => ({}),
        createProgram: () => ({ shaders: [] }),
        shaderSource: (shader, source) => { shader.source = source; },
        getShaderSource: (shader) => shader.source,
        attachShader: (program, shader) => { program.shaders.push(shader); },
        getAttachedShaders: (program) => program.shaders,
        linkProgram: (program) => { links.push(program.shaders.map(({ source }) => source)); },
        getShaderParameter: () => 1,
        getProgramParameter: (program, what) => (what === 0x8B89 ? 0 : 1), // no active attributes; compiled and linked
        getParameter: () => [],
        getSupportedExtensions: () => [],
        checkFramebufferStatus: () => 0x8CD5,
    };
    const others = { create: () => ({}), get: () => null }, nothing = () => 0;
    return new Proxy(known, { get: (all, name) => all[name] || others[/^[a-z]*/.exec(name)[0]] || nothing });
}

// lit: whether the page's stage is; done: the lights whose texels the page has.
self.onmessage = async ({ data: { module, caps, pack, wants, lit, done } }) => {
    const links = [], p = await Program.start(module, blankContext(links), undefined, caps), grow = (bytes) => p.reserve(p.memory.buffer.byteLength + bytes);
    p.reserve(p._web_memory_for(pack.length, 0));
    p.HEAPU8.set(pack, p._web_pack(pack.length));
    p.check(p._web_loaded());
    grow(p._web_plan_grows());
    const block = p._web_plan(...wants);
    if (!block) throw p.failure();
    p.reserve(p._web_memory_for(pack.length, block));
    p.check(p._web_open(...wants));
    if (lit) self.postMessage({ programs: links });
    for (let light = 0; light < p._web_light_count(); light++) {
        if (done.includes(light) && (lit || light)) continue;
        links.length = 0;
        p.check(p._web_set_light(light));
        self.postMessage({ light, texels: baked.get(light), programs: lit ? [] : [...links] });
    }
    self.postMessage({ ends: true });
};
