// festival.js: the page around the crowd's program (festival.c). Without a GPU there are fewer people, no antialiasing,
// coarser figures, a plain sky, and a lower resolution while frames are slow. The query: ?agents=600; ?shadow=on;
// ?size=640x360: size of the canvas; ?still=30: shows this second and stops; ?antialias=on|off, default off without a
// GPU; ?error=8: largest LOD error in pixels.
'use strict';

const query = new URLSearchParams(location.search), byId = (id) => document.getElementById(id), canvas = byId('canvas');
const files = ['people.nohz', 'festival.nohz', 'festival.place'];
const counts = [100, 200, 300, 400, 600, 1000];
const home = { azimuth: 0.31, elevation: 0.23, distance: 24, x: 0, z: 0 };
const orbit = { ...home };
const step = 1 / 30; // seconds
let pixels = null; // resolution (package/pixels.js)
let Module = null, software = false, playing = true, lost = false, wanted = false, before = 0, owed = 0;
const times = []; // of the last frames, ms

// Tests wait for these.
window.noh = { ready: false, frames: 0, steps: 0, error: '', lost: 0, restored: 0 };

const say = (words) => { byId('message').textContent = words; };
function check(status) {
    if (!status) return;
    window.noh.error = Module.UTF8ToString(Module._festival_error());
    say(window.noh.error);
    throw new Error(window.noh.error);
}

function redraw() {
    if (!wanted) requestAnimationFrame(draw);
    wanted = true;
}

function advance(steps) {
    Module._festival_step(steps);
    window.noh.steps += steps;
}

// Time advances in whole steps, at most four per frame: a page that cannot keep up is slow, not jerky.
function draw(now) {
    wanted = false;
    if (lost) return;
    const passed = before ? Math.min(now - before, 500) / 1000 : 0;
    before = now;
    if (playing && passed && pixels && pixels.tell(1000 * passed, now)) resize();
    if (playing) {
        owed = Math.min(owed + passed, 4 * step);
        const steps = Math.floor(owed / step + 1e-3);
        owed -= steps * step;
        if (steps) advance(steps);
        times.push(1000 * passed);
        if (times.length > 60) times.shift();
    }
    Module._festival_look(orbit.azimuth, orbit.elevation, orbit.distance, orbit.x, orbit.z, canvas.width, canvas.height);
    check(Module._festival_draw());
    window.noh.frames++;
    if (window.noh.frames % 15 === 1) tell();
    if (playing) redraw();
}

function tell() {
    const sum = times.reduce((a, b) => a + b, 0), rate = sum ? `, ${(1000 * times.length / sum).toFixed(0)} frames a second${software ? ' without a GPU' : ''}` : '';
    const number = (n) => n.toLocaleString('en');
    byId('said').textContent = `${number(Module._festival_seen())} in view${rate}`;
    byId('bytes').textContent = `The stage takes ${number(Module._festival_stage_bytes())} bytes of memory, and ${number(Module._festival_gpu_bytes())} of the GPU's.`;
}

function resize() {
    const fixed = /^(\d+)x(\d+)$/.exec(query.get('size') || ''), scale = Math.min(window.devicePixelRatio || 1, 2) * (pixels && playing ? pixels.share : 1);
    const [width, height] = fixed ? [Number(fixed[1]), Number(fixed[2])] : [canvas.clientWidth, canvas.clientHeight].map((n) => Math.max(1, Math.round(n * scale)));
    if (width !== canvas.width || height !== canvas.height) Object.assign(canvas, { width, height });
    redraw();
}

// ---- the camera ----

function turn(azimuth, elevation) {
    orbit.azimuth += azimuth;
    orbit.elevation = Math.min(1.4, Math.max(0.05, orbit.elevation + elevation));
    redraw();
}
function zoom(by) {
    orbit.distance = Math.min(60, Math.max(3, orbit.distance * by));
    redraw();
}
const pointers = new Map();
const apart = () => { const [a, b] = [...pointers.values()]; return Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)); };
canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
});
canvas.addEventListener('pointermove', (event) => {
    const at = pointers.get(event.pointerId), was = pointers.size === 2 ? apart() : 0;
    if (!at) return;
    const x = event.clientX - at.x, y = event.clientY - at.y;
    Object.assign(at, { x: event.clientX, y: event.clientY });
    if (was) zoom(was / apart());
    else turn(-x * 0.006, y * 0.006);
});
for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
canvas.addEventListener('wheel', (event) => { event.preventDefault(); zoom(Math.exp(event.deltaY * 0.001)); }, { passive: false });

const keys = {
    ArrowLeft: () => turn(0.1, 0), ArrowRight: () => turn(-0.1, 0), ArrowUp: () => turn(0, -0.1), ArrowDown: () => turn(0, 0.1),
    '+': () => zoom(0.9), '=': () => zoom(0.9), '-': () => zoom(1 / 0.9), Home: () => { Object.assign(orbit, home); redraw(); }, ' ': () => setPlaying(!playing),
};
canvas.addEventListener('keydown', (event) => {
    if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
});

function setPlaying(on) {
    playing = on;
    before = 0;
    times.length = 0;
    byId('play').textContent = on ? 'pause' : 'play';
    if (Module) resize(); // full resolution at rest
    redraw();
}
byId('play').addEventListener('click', () => setPlaying(!playing));

// The number of people and their shadows are planned before the start, so the page is reloaded.
function beginAnew() {
    query.set('agents', byId('agents').value);
    query.set('shadow', byId('shadow').checked ? 'on' : 'off');
    location.search = query;
}
byId('agents').addEventListener('change', beginAnew);
byId('shadow').addEventListener('change', beginAnew);

// ---- a lost context ----

canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault();
    lost = true;
    window.noh.lost++;
    say('The browser has taken the graphics context away; the picture goes on when it comes back.');
});
canvas.addEventListener('webglcontextrestored', () => {
    check(Module._festival_restore());
    lost = false;
    window.noh.restored++;
    say('');
    redraw();
});

// ---- start ----

async function fetched(name) {
    const answer = await fetch(name);
    if (!answer.ok) throw new Error(`${name}: the server says ${answer.status}`);
    return new Uint8Array(await answer.arrayBuffer());
}
const asked = Promise.all(files.map(fetched)); // in parallel with the program

// The renderer, which only a context reveals.
function findRenderer() {
    const gl = document.createElement('canvas').getContext('webgl2');
    if (!gl) return '';
    const info = gl.getExtension('WEBGL_debug_renderer_info'), name = gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
    gl.getExtension('WEBGL_lose_context')?.loseContext();
    return name;
}

// GL comes from the package, as the page's does.
async function program() {
    const smooths = query.has('antialias') ? query.get('antialias') !== 'off' : !software; // a frame takes nearly twice as long with samples
    const gl = canvas.getContext('webgl2', { antialias: smooths, depth: true, alpha: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error('cannot create a WebGL 2 context: use a browser with WebGL 2');
    const { importsOf } = await import('../package/gl.js'), heap = {}, { imports } = importsOf(gl, heap);
    return nohFestival({
        instantiateWasm(given, done) {
            Object.assign(given.env, imports.env);
            WebAssembly.instantiateStreaming(fetch('program.wasm'), { ...given, noh: imports.noh }).then(({ instance, module }) => {
                const { buffer } = window.noh.memory = instance.exports.memory;
                Object.assign(heap, { U8: new Uint8Array(buffer), I8: new Int8Array(buffer), U16: new Uint16Array(buffer), I16: new Int16Array(buffer),
                    U32: new Uint32Array(buffer), I32: new Int32Array(buffer), F32: new Float32Array(buffer) });
                done(instance, module);
            });
            return {};
        },
    });
}

async function start() {
    const { Pixels, isSoftware } = await import('../package/pixels.js');
    software = isSoftware(findRenderer());
    Module = window.Module = await program();
    const error = Math.max(0.1, Number(query.get('error')) || (software ? 8 : 1)); // LOD error, pixels
    const asksFor = Number(query.get('agents') || (software ? 10 : 300));
    const agents = Math.min(1000, Math.max(1, Number.isFinite(asksFor) ? Math.floor(asksFor) : 300));
    if (!query.has('size')) pixels = new Pixels();
    for (const count of [...new Set([...counts, agents])].sort((a, b) => a - b)) byId('agents').add(new Option(count, count, false, count === agents));
    byId('shadow').checked = query.get('shadow') === 'on';
    (await asked).forEach((bytes, i) => Module.FS.writeFile(files[i], bytes));
    say('people arrive');
    await new Promise((resolve) => setTimeout(resolve)); // lets the browser show the text
    resize();
    check(Module._festival_open(agents, canvas.width, canvas.height, byId('shadow').checked ? 1 : 0, error, software ? 1 : 0));
    const still = Number(query.get('still'));
    if (matchMedia('(prefers-reduced-motion: reduce)').matches || still) setPlaying(false);
    advance(still ? Math.round(still / step) : 2);
    say('');
    new ResizeObserver(resize).observe(canvas);
    resize();
    window.noh.ready = true;
}

document.addEventListener('DOMContentLoaded', () => start().catch((error) => say(window.noh.error = String(error.message || error))));
