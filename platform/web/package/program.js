// program.js: the WebAssembly program in its own memory, which is sized for one pack and cannot grow.
import { importsOf, textAt, tierOf } from './gl.js';
import { compileFrom, reach } from './reach.js';

const PAGE = 65536;
const LEAST = 16; // pages of any program: static data and stack; of a planning program, the memory may grow
const MOST = 32768; // 2 GiB
export const paths = ['auto', 'layered', 'mrt', 'per-layer', 'gather', 'cpu', 'blend', 'streams', 'direct']; // by number

const compiled = new Map(); // by address

// What a page needs, in the form that bundlers follow: everything, no falls and no three.js, or faces alone.
const programs = { all: () => new URL('./noh.wasm', import.meta.url), body: () => new URL('./body.wasm', import.meta.url), face: () => new URL('./face.wasm', import.meta.url) };

// The sentences of their errors, which are not in them (tools/web_messages.js).
const texts = { all: () => new URL('./noh.txt', import.meta.url), body: () => new URL('./body.txt', import.meta.url), face: () => new URL('./face.txt', import.meta.url) };
const sentences = new WeakMap(); // by module: { address, lines: null or [address in memory, words] }
const wordless = new WeakMap(); // by error: { module, at }

// A cache may have kept the sentences, or the program, of an older build: both have a mark, which must be the same.
const markOf = (module) => String.fromCharCode(...new Uint8Array(WebAssembly.Module.customSections(module, 'texts')[0] || 0));

// Fetches the sentences of a program; without them an error has a number.
export async function learn(module) {
    const known = sentences.get(module), answer = known && !known.lines && await fetch(known.address).catch(() => null);
    const text = answer && answer.ok && await answer.text().catch(() => '');
    const [mark, ...lines] = text ? text.split('\n') : [];
    if (mark && markOf(module) === mark) known.lines = lines.map((line) => [parseInt(line, 10), line.slice(line.indexOf(' ') + 1)]);
}

function sentence(module, at) {
    const { lines } = sentences.get(module) || {}, line = lines && lines.filter(([from, words]) => from <= at && at < from + words.length).pop();
    return line ? line[1].slice(at - line[0]) : `error ${at} of the program`;
}

// The same error, with its sentence.
export async function explained(error) {
    const { module, at } = wordless.get(error) || {};
    if (module) {
        await learn(module);
        error.message = sentence(module, at);
    }
    return error;
}

// A program, compiled once for all characters: one of these, or an address; tell(taken): its bytes, while they arrive.
export function compile(program = 'all', tell) {
    const key = String(Object.hasOwn(programs, program) ? programs[program]() : program);
    if (!compiled.has(key)) {
        const module = compileFrom(key, 'program', tell);
        module.then((made) => sentences.set(made, { address: Object.hasOwn(texts, program) ? texts[program]() : key.replace(/\.wasm(?=$|[?#])/, '.txt'), lines: null }),
            () => compiled.delete(key)); // the next call tries again
        compiled.set(key, module);
    }
    return compiled.get(key);
}

// C functions are methods with an underscore before the name: program._web_step(0.1).
export class Program {
    constructor(memory) {
        this.memory = memory;
        this.heap = {};
        this.look();
    }

    // Starts in existing memory, or in memory that may grow. caps: of another program on the same context.
    static async start(module, gl, memory = new WebAssembly.Memory({ initial: LEAST, maximum: MOST }), caps = null) {
        const program = new Program(memory);
        const { imports, textures, buffers } = importsOf(gl, program.heap);
        const instance = await WebAssembly.instantiate(module, { ...imports, env: { ...imports.env, memory } });
        for (const [name, value] of Object.entries(instance.exports)) if (name.startsWith('web_')) program[`_${name}`] = value;
        Object.assign(program, { module, gl, textures, buffers });
        instance.exports._initialize();
        if (caps) program.heap.U8.set(caps, program._web_caps());
        return program;
    }

    look() {
        const { buffer } = this.memory;
        Object.assign(this.heap, { U8: new Uint8Array(buffer), I8: new Int8Array(buffer), U16: new Uint16Array(buffer), I16: new Int16Array(buffer),
            U32: new Uint32Array(buffer), I32: new Int32Array(buffer), F32: new Float32Array(buffer) });
    }

    get HEAPU8() { return this.heap.U8; }
    get HEAPU32() { return this.heap.U32; }
    get HEAPF32() { return this.heap.F32; }

    text(at) { return textAt(this.heap, at); }
    UTF8ToString(at) { return textAt(this.heap, at); }
    floats(at, count) { return this.heap.F32.subarray(at >> 2, (at >> 2) + count); }
    // The sentence at an address.
    words(at = this._web_error()) { return at ? this.text(at) || sentence(this.module, at) : ''; }
    failure() {
        const at = this._web_error(), error = new Error(this.words(at));
        if (!this.text(at)) wordless.set(error, { module: this.module, at });
        return error;
    }

    // Check a noh_result; throws an error with its message.
    check(result) { if (result) throw this.failure(); }

    reserve(bytes) {
        const more = Math.ceil((bytes - this.memory.buffer.byteLength) / PAGE);
        if (more <= 0) return;
        try {
            this.memory.grow(more);
        } catch {
            throw new Error(`there is no memory for ${bytes} bytes`);
        }
        this.look();
    }
}

// Loads a pack, a piece at a time, and creates the program that shows it.
export class Arrival {
    static async begin(module, gl, caps) {
        const arrival = new Arrival();
        Object.assign(arrival, { module, gl, shows: 0, parts: [], bytes: 0, place: 0, around: (call) => call() });
        arrival.program = await Program.start(module, gl, undefined, caps);
        return arrival;
    }

    // Add a piece of the file. Returns 0: nothing to show yet, 1: the coarsest levels, 2: the whole pack (wire form).
    push(bytes) {
        this.bytes += bytes.length;
        if (this.place) return this.unpack(bytes);
        this.parts.push(bytes);
        const head = this.program._web_head_bytes();
        if (this.bytes < head || (this.bytes - bytes.length >= head)) return this.shows; // a plain pack, or not enough yet
        const all = joined(this.parts);
        if (String.fromCharCode(...all.subarray(0, 4)) !== 'NOHZ') return this.shows;
        this.program.HEAPU8.set(all.subarray(0, head), this.program._web_head());
        const memory = this.program._web_wire_memory();
        if (!memory) throw this.program.failure();
        this.program.reserve(memory);
        this.place = this.program._web_wire();
        if (!this.place) throw this.program.failure();
        this.parts = [];
        return this.unpack(all);
    }

    unpack(bytes) {
        const room = this.program._web_piece_bytes();
        for (let at = 0; at < bytes.length; at += room) {
            const piece = bytes.subarray(at, at + room);
            this.program.HEAPU8.set(piece, this.place);
            this.program.check(this.program._web_wire_push(piece.length));
        }
        this.shows = this.program._web_wire_shows();
        return this.shows;
    }

    // The end of the file.
    end() {
        if (this.place) {
            if (this.shows < 2) throw new Error(`the pack was cut short: ${kilobytes(this.bytes)} kB came`);
            return;
        }
        if (this.bytes < 4) throw new Error(`the pack is no pack: it has ended after ${this.bytes} bytes`);
        const file = joined(this.parts);
        this.parts = [];
        this.program.reserve(this.program._web_memory_for(file.length, 0));
        this.program.HEAPU8.set(file, this.program._web_pack(file.length));
        this.shows = 2;
    }

    // Create a program for the most complete pack so far, with exactly the memory it needs: { path, characters, alive,
    // tier, elsewhere }.
    async open(wants) {
        const planner = this.program, path = Math.max(0, paths.indexOf(wants.path || 'auto'));
        planner.check(planner._web_loaded());
        const bytes = planner._web_loaded_bytes();
        planner.reserve(planner.memory.buffer.byteLength + planner._web_plan_grows());
        planner._web_set_elsewhere(wants.elsewhere ? 1 : 0);
        const given = [path, wants.characters, wants.alive ? 1 : 0, tierOf(this.gl, wants.tier) === 'phone' ? 1 : 0];
        const block = this.around(() => planner._web_plan(...given));
        if (!block) throw planner.failure();
        const pages = Math.max(LEAST, Math.ceil(planner._web_memory_for(bytes, block) / PAGE));
        const memory = new WebAssembly.Memory({ initial: pages, maximum: pages });
        const program = await Program.start(this.module, this.gl, memory, this.caps());
        program._web_set_elsewhere(wants.elsewhere ? 1 : 0);
        program.HEAPU8.set(planner.HEAPU8.subarray(planner._web_loaded_at(), planner._web_loaded_at() + bytes), program._web_pack(bytes));
        return Object.assign(program, { packBytes: bytes, given, open: () => program.check(program._web_open(...given)) });
    }

    // The capabilities of the context, once probed.
    caps() {
        const at = this.program._web_caps();
        return this.program.HEAPU8.slice(at, at + this.program._web_caps_bytes());
    }
}

export const kilobytes = (bytes) => Math.round(bytes / 1000).toLocaleString('en');

function joined(parts) {
    const out = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
    parts.reduce((at, part) => { out.set(part, at); return at + part.length; }, 0);
    return out;
}

// The first bytes of a pack are requested separately, so that no others compete with the loading program: they contain
// the coarsest levels of most packs.
const FIRST = 131072;
export const fetchFirst = (address) => reach(fetch(address, { headers: { Range: `bytes=0-${FIRST - 1}` } }), 'pack', address);

// The part of a file in a response: { from, all }. A server without range requests sends the whole file.
function extent(answer) {
    if (!answer.ok) throw new Error(`no pack: the server says ${answer.status}`);
    const range = answer.status === 206 && /^bytes (\d+)-\d+\/(\d+)$/.exec(answer.headers.get('Content-Range') || '');
    const coded = answer.headers.get('Content-Encoding'); // then the length is of the encoded data
    return range ? { from: Number(range[1]), all: Number(range[2]) } : { from: 0, all: coded ? 0 : Number(answer.headers.get('Content-Length')) };
}

// The rest of a file after its first bytes, of the same version.
async function fetchRest(first, taken) {
    const rest = await fetch(first.url, { headers: { Range: `bytes=${taken}-` } }), same = (name) => rest.headers.get(name) === first.headers.get(name);
    if (extent(rest).from === taken && same('ETag') && same('Last-Modified')) return rest;
    throw new Error('the pack has changed while it arrived');
}

// Read a response in pieces: push(piece) for each, tell(taken, all) for progress; all is 0 if the server sends no
// length. If the response has only the first bytes of a file, the rest is requested.
export async function receive(answer, push, tell, signal) {
    const { all } = extent(answer), ended = () => signal && signal.aborted;
    let taken = 0;
    for (let part = answer; ; part = await fetchRest(answer, taken)) {
        const reader = part.body.getReader();
        for (;;) {
            const { value, done } = await reader.read().catch(() => { throw new Error(`the connection was lost after ${kilobytes(taken)} kB of the pack`); });
            if (done || ended()) break;
            taken += value.length;
            await push(value);
            tell(taken, all);
        }
        if (answer.status !== 206 || taken >= all || ended()) return;
    }
}
