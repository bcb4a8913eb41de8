// convert.js: converts a visitor's files to packs. Models go through the converter, which is loaded when first needed
// and runs in a worker (tools/web_convert), without blocking the page. With the same options, packs equal `noh build`'s.
import { reach } from './reach.js';

const packs = /\.nohz?$/i;
const figures = /\.(glb|gltf|vrm|fbx|obj)$/i;
const motions = /\.(bvh|csv|trc|c3d|vrma)$/i;
const alone = /\.(glb|vrm|fbx)$/i; // in one file
const mostKept = 8;
const quick = ['--effort', '1']; // a visitor waits: clips take a quarter of the time, and a few more bytes
export const kinds = ['.noh', '.nohz', '.glb', '.gltf', '.vrm', '.fbx', '.obj', '.bvh', '.csv', '.trc', '.c3d', '.vrma'];

// Detect files that cannot be shown, before loading anything. names: of files given together.
export function refusal(names) {
    const count = (pattern) => names.filter((name) => pattern.test(name)).length;
    if (count(packs) === 1 && names.length === 1) return '';
    if (count(packs)) return 'a pack is shown alone';
    if (count(figures) > 1) return 'one model at a time, and any number of clips with it';
    return count(figures) + count(motions) ? '' : `it is none of ${kinds.join(', ')}`;
}

// files: File objects: a model and the files it refers to (.bin, pictures), or clips. tell(words) reports progress,
// warn(words) each warning. options: as for `noh build`. Resolves to the pack's bytes.
export async function convert(files, { tell = () => {}, warn = () => {}, options = [] } = {}) {
    const refused = refusal(files.map(({ name }) => name));
    if (refused) throw new Error(refused);
    const order = [...files].sort((a, b) => Number(figures.test(b.name)) - Number(figures.test(a.name)));
    tell('the converter is loaded');
    const read = await Promise.all(order.map(async (file) => ({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) })));
    const worker = new Worker(new URL('./convert/worker.js', import.meta.url), { type: 'module' }); // the form that bundlers follow
    try {
        return await new Promise((resolve, reject) => {
            worker.onerror = () => reject(new Error('the converter cannot be loaded: the page was built without it, or the connection was lost'));
            worker.onmessage = ({ data }) => {
                if (data.progress) tell(data.progress);
                else if (data.error) reject(new Error(data.error));
                else data.warnings.forEach(warn), resolve(data.pack);
            };
            worker.postMessage({ files: read, options }, read.map(({ bytes }) => bytes.buffer));
        });
    } finally {
        worker.terminate(); // its memory goes with it
    }
}

// ---- models by address ----

export const isModel = (address) => alone.test(new URL(address, document.baseURI).pathname);

// Changes with the converter.
async function madeBy() {
    const { headers } = await fetch(new URL('./convert/convert.wasm', import.meta.url), { method: 'HEAD' });
    return headers.get('ETag') || headers.get('Last-Modified') || headers.get('Content-Length');
}

// Where the pack of a file is kept: [cache, key]; or null, where the browser keeps nothing (no https, a private window).
async function placeOf(bytes) {
    try {
        const hash = await crypto.subtle.digest('SHA-256', bytes), digits = [...new Uint8Array(hash)].map((byte) => byte.toString(16).padStart(2, '0')).join('');
        return [await caches.open('noh-character'), `https://noh.invalid/${digits}/${encodeURIComponent(await madeBy())}`];
    } catch {
        return null;
    }
}

// The pack of a model at an address, converted once: it is kept by the contents of the model. progress(taken, all) counts
// its bytes; tell, warn: as for convert.
export async function convertAddress(address, { progress, ...settings }) {
    const answer = await reach(fetch(address), 'model', address), parts = [], all = answer.headers.get('Content-Encoding') ? 0 : Number(answer.headers.get('Content-Length'));
    if (!answer.ok) throw new Error(`no model: ${address}: the server says ${answer.status}`);
    const reader = answer.body.getReader();
    for (let taken = 0; ;) {
        const { value, done } = await reach(reader.read(), 'model', address);
        if (done) break;
        parts.push(value);
        progress(taken += value.length, all);
    }
    const file = new File(parts, decodeURIComponent(new URL(address, document.baseURI).pathname.split('/').pop())), place = await placeOf(await file.arrayBuffer());
    const kept = place && await place[0].match(place[1]);
    if (kept) return new Uint8Array(await kept.arrayBuffer());
    const pack = await convert([file], { ...settings, options: quick });
    if (place) await keep(...place, pack).catch(() => {}); // there may be no room
    return pack;
}

async function keep(cache, key, pack) {
    await cache.put(key, new Response(pack));
    const keys = await cache.keys();
    for (const old of keys.slice(0, Math.max(0, keys.length - mostKept))) await cache.delete(old);
}

// A visitor's files, one set after another: clips alone belong to the previous model.
export class Visitor {
    constructor() {
        this.model = []; // the files of the last converted model
    }

    // Resolves to a source for Character.load.
    async pack(files, settings) {
        const has = (pattern) => files.some(({ name }) => pattern.test(name)), refused = refusal(files.map(({ name }) => name));
        if (refused) throw new Error(refused);
        if (has(packs)) {
            this.model = [];
            return files[0];
        }
        if (!has(figures) && !this.model.length) throw new Error('it has motion alone: drop it together with its model, or after it');
        const all = has(figures) ? files : [...this.model, ...files], pack = await convert(all, { ...settings, options: quick });
        this.model = all;
        return pack;
    }
}
