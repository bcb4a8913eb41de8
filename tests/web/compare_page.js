// compare_page.js: one asset drawn by noh, three.js and Babylon.js in one page, with one camera and one fragment shader
// (shaders_es/mesh.frag), so that they differ only in how targets are summed and in the cost of a frame around it.
// ?path=gather forces noh's path; ?side=three loads one side alone. compare.js calls window.compare.
import { countBytes } from './compare_shared.js';

const query = new URLSearchParams(location.search), alone = query.get('side');
const canvases = { noh: 'canvas', three: 'three', babylon: 'babylon' };

// Wait until all is drawn; the same for all sides.
const pixel = new Uint8Array(4);
const wait = (gl) => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);

// `active` of the targets, evenly among them, with other weights in every frame; null: none.
function weightsOf(count, active, frame) {
    if (!active) return null;
    const weights = new Float32Array(count);
    for (let i = 0; i < active; i++) {
        const t = Math.floor((i + 0.5) * count / active);
        weights[t] = 0.25 + 0.15 * Math.sin(0.7 * t + 0.3 * frame);
    }
    return weights;
}

let frame = 0;
function draw(side, count, active) {
    side.draw(weightsOf(count, active, frame++));
    wait(side.gl);
}

// Milliseconds of a frame that is waited for. The one before it, which is like it, is not counted: it pays for the
// change from what was drawn before.
function sample(side, count, active) {
    draw(side, count, active);
    const start = performance.now();
    draw(side, count, active);
    return performance.now() - start;
}

async function openSide(name, known) {
    const canvas = document.getElementById(canvases[name]), bytes = countBytes(canvas);
    const { open } = await import(name === 'noh' ? '/web/compare_noh.js' : `/${name}.js`);
    const side = name === 'noh' ? await open(canvas, query.get('path') || 'auto') : await open(canvas, known.bounds, known.names);
    for (let tries = 0; side.isReady && !side.isReady() && tries < 2000; tries++) { // it compiles meanwhile
        side.draw(null);
        await new Promise((resolve) => setTimeout(resolve, 5));
    }
    return Object.assign(side, { bytes });
}

// One side, as a visitor would wait for it: until the first frame is drawn.
async function first() {
    const known = await (await fetch('/known.json')).json(), side = await openSide(alone, known);
    draw(side, known.names.length, 0);
    window.compare = { first: performance.now() };
}

async function start() {
    if (alone) return first();
    const noh = await openSide('noh'), three = await openSide('three', noh), babylon = await openSide('babylon', noh);
    const sides = { noh, three, babylon }, names = Object.keys(sides), count = noh.names.length;
    window.compare = {
        about: { versions: names.map((name) => sides[name].version), renderer: noh.renderer, names: noh.names, bounds: noh.bounds },
        resize: (pixels) => names.forEach((name) => sides[name].resize(pixels)),
        bytes: () => Object.fromEntries(names.map((name) => [name, sides[name].bytes()])),
        draw(active, fixed) { for (const name of names) { frame = fixed; draw(sides[name], count, active); } },
        // For `ms` ms, of each of these sides by turns: frames without targets, with them, with them, without.
        // They are neighbours, so that what disturbs one disturbs the others, and what drifts meanwhile cancels out.
        measure(asked, active, ms) {
            const out = Object.fromEntries(asked.map((name) => [name, []])), end = performance.now() + ms;
            do {
                for (const name of asked) out[name].push([0, active, active, 0].map((c) => sample(sides[name], count, c)));
            } while (performance.now() < end);
            return out;
        },
    };
    return undefined;
}

start().catch((error) => { window.compare = { error: `${error}\n${error.stack}` }; });
