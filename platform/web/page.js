// page.js: the page around the WebAssembly program (main.c): the camera, clips, sliders, the table of memory.
// The query: ?pack=NAME shows that pack instead of page.noh; ?path=gather forces a path; ?clip=NAME begins with that
// clip, or with none; ?detail=0 begins with that LOD level; ?size=512 draws a canvas of so many pixels across.
'use strict';

const query = new URLSearchParams(location.search);
const paths = ['auto', 'layered', 'mrt', 'per-layer', 'gather', 'cpu', 'blend'];
const transition = 0.3; // seconds from one clip into another
const byId = (id) => document.getElementById(id);
const canvas = byId('canvas');
let lost = false;
let wanted = false;
let drawn = 0; // time of the last frame, in ms

// Tests wait for these.
window.noh = { ready: false, lost: 0, restored: 0, frames: 0, error: '' };

function fail(text) {
    window.noh.error = text;
    byId('message').textContent = text;
    throw new Error(text);
}

const text = (pointer) => Module.UTF8ToString(pointer);
const check = (result) => { if (result) fail(text(Module._web_error())); };
const floats = (pointer, count) => Module.HEAPF32.subarray(pointer >> 2, (pointer >> 2) + count);

// ---- the camera: as `noh render` has it, 30 degrees high ----

const front = { azimuth: 0, elevation: 0.05 };
const orbit = { ...front, distance: 0, box: null };

function product(a, b) {
    const out = new Float32Array(16);
    for (let i = 0; i < 16; i++) {
        for (let k = 0; k < 4; k++) out[i] += a[4 * k + i % 4] * b[4 * (i >> 2) + k];
    }
    return out;
}

// Come as near as the whole figure in its current pose allows.
function fit() {
    orbit.box = Array.from(floats(Module._web_measure(), 6));
    orbit.distance = 0;
    redraw();
}

function setCamera() {
    const b = orbit.box;
    const centre = [0, 1, 2].map((c) => (b[c] + b[3 + c]) / 2);
    const half = [0, 1, 2].map((c) => (b[3 + c] - b[c]) / 2);
    const aspect = canvas.width / canvas.height, f = 1 / Math.tan(Math.PI / 12);
    const radius = Math.max(Math.hypot(...half), 1e-6);
    const need = Math.max(half[1], Math.max(half[0], half[2] * 0.7) / aspect) * 1.05;
    const fitting = Math.max(need * f + half[2], radius * 1.02);
    const d = (orbit.distance || 1) * fitting, near = Math.max(d - 2 * radius, d * 0.02), far = d + 2 * radius;
    const ca = Math.cos(orbit.azimuth), sa = Math.sin(orbit.azimuth);
    const ce = Math.cos(orbit.elevation), se = Math.sin(orbit.elevation);
    const right = [ca, 0, -sa], up = [-sa * se, ce, -ca * se], back = [sa * ce, se, ca * ce];
    const eye = centre.map((c, i) => c + back[i] * d);
    const dot = (a) => a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2];
    const view = [0, 1, 2].flatMap((c) => [right[c], up[c], back[c], 0]).concat([-dot(right), -dot(up), -dot(back), 1]);
    const projection = [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, -(far + near) / (far - near), -1, 0, 0, -2 * far * near / (far - near), 0];
    const key = right.map((r, i) => -0.45 * r + 0.62 * up[i] + 0.64 * back[i]);
    const camera = floats(Module._web_camera(), 22); // noh_gl_camera: matrix, eye, key
    camera.set(product(projection, view), 0);
    camera.set(eye, 16);
    camera.set(key.map((k) => k / Math.hypot(...key)), 19);
}

// One finger or the mouse turns the figure; two fingers or the wheel zoom.
const pointers = new Map();
const apart = () => {
    const [a, b] = [...pointers.values()];
    return Math.max(Math.hypot(a.x - b.x, a.y - b.y), 1);
};
function zoom(by) {
    orbit.distance = Math.min(4, Math.max(0.15, (orbit.distance || 1) * by));
    redraw();
}
canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
});
canvas.addEventListener('pointermove', (event) => {
    const at = pointers.get(event.pointerId);
    if (!at || pointers.size > 2) return;
    const x = event.clientX - at.x, y = event.clientY - at.y, before = pointers.size === 2 ? apart() : 0;
    Object.assign(at, { x: event.clientX, y: event.clientY });
    if (before) return zoom(before / apart());
    orbit.azimuth -= x * 0.01;
    orbit.elevation = Math.min(1.5, Math.max(-1.5, orbit.elevation + y * 0.01));
    redraw();
});
for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    zoom(Math.exp(event.deltaY * 0.001));
}, { passive: false });
byId('fit').addEventListener('click', fit);
byId('front').addEventListener('click', () => { Object.assign(orbit, front); redraw(); });

// ---- frames ----

function draw() {
    wanted = false;
    if (lost || !window.noh.ready) return;
    setCamera();
    const now = performance.now();
    check(Module._web_draw(Math.min(now - drawn, 100) / 1000));
    drawn = now;
    window.noh.frames++;
    showDetail();
    if (Module._web_fades()) redraw();
}

function redraw() {
    if (!wanted) requestAnimationFrame(draw);
    wanted = true;
}

function resize() {
    const fixed = Number(query.get('size')), scale = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = fixed ? [fixed, fixed] : [canvas.clientWidth, canvas.clientHeight].map((n) => Math.max(1, Math.round(n * scale)));
    if (width === canvas.width && height === canvas.height) return;
    Object.assign(canvas, { width, height });
    if (!window.noh.ready) return;
    draw(); // at once, because resizing clears a canvas
}

canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault(); // else the browser never restores it
    lost = true;
    window.noh.lost++;
    byId('message').textContent = 'the context is lost';
});
canvas.addEventListener('webglcontextrestored', () => {
    check(Module._web_restore());
    lost = false;
    window.noh.restored++;
    byId('message').textContent = '';
    draw();
});

// ---- LOD levels ----

function showDetail() {
    if (byId('details').hidden) return;
    const shown = Module._web_level(), error = Module._web_error_pixels();
    byId('detail-text').textContent = `${shown ? `level ${shown}` : 'full'}, off by at most ${error.toFixed(2)} pixels`;
}

byId('detail').addEventListener('change', () => {
    Module._web_set_level(Number(byId('detail').value));
    redraw();
});

// By pixels, or at the level that ?detail says.
function beginDetail() {
    const count = Module._web_level_count();
    for (let i = 1; i < count; i++) byId('detail').add(new Option(`level ${i}`, i));
    byId('details').hidden = count < 2;
    const asked = Number(query.get('detail') || -1);
    byId('detail').value = asked >= 0 && asked < count ? asked : -1;
    Module._web_set_level(Number(byId('detail').value));
}

// ---- targets ----

const sliders = [];

function showWeight(s) {
    const weight = Module._web_weight(s.index);
    if (weight === s.shown) return;
    s.shown = weight;
    s.slider.value = weight;
    s.output.textContent = weight.toFixed(2);
}

function addSlider(index, name) {
    const label = document.createElement('label'), span = document.createElement('span');
    const slider = document.createElement('input'), output = document.createElement('output');
    span.textContent = span.title = name;
    Object.assign(slider, { type: 'range', min: -1, max: 2, step: 0.01 });
    slider.dataset.target = name;
    const s = { index, label, slider, output, name: name.toLowerCase(), shown: NaN, initial: Module._web_weight(index) };
    slider.addEventListener('input', () => {
        Module._web_set_weight(index, Number(slider.value));
        showWeight(s);
        redraw();
    });
    label.append(span, slider, output);
    byId('targets').append(label);
    sliders.push(s);
    showWeight(s);
}

byId('search').addEventListener('input', () => {
    const part = byId('search').value.trim().toLowerCase();
    for (const s of sliders) s.label.hidden = !s.name.includes(part);
});
byId('reset').addEventListener('click', () => {
    for (const s of sliders) Module._web_set_weight(s.index, s.initial);
    sliders.forEach(showWeight);
    redraw();
});

// ---- clips ----

const clip = () => Number(byId('clips').value);
let playing = false, before = 0;

function showPose() {
    byId('time').value = Module._web_time();
    byId('time-text').textContent = `${Module._web_time().toFixed(2)} s`;
    sliders.forEach(showWeight);
    redraw();
}

function choose(over) {
    check(Module._web_play(clip(), 0, over));
    byId('time').max = Math.max(clip() < 0 ? 0 : Module._web_clip_seconds(clip()), 0.001);
    showPose();
}

function tick(now) {
    if (!playing) return;
    Module._web_step(Math.min(Math.max(now - before, 0), 100) / 1000);
    before = now;
    showPose();
    requestAnimationFrame(tick);
}

function setPlaying(on) {
    const started = on && !playing;
    playing = on;
    byId('play').textContent = playing ? 'pause' : 'play';
    if (!started) return;
    before = performance.now();
    requestAnimationFrame(tick);
}

byId('play').addEventListener('click', () => setPlaying(!playing));
byId('clips').addEventListener('change', () => choose(playing ? transition : 0));
byId('time').addEventListener('input', () => {
    setPlaying(false);
    check(Module._web_play(clip(), Number(byId('time').value), 0));
    showPose();
});
byId('speed').addEventListener('input', () => {
    const speed = Number(byId('speed').value);
    Module._web_set_speed(speed);
    byId('speed-text').textContent = speed.toFixed(2);
});

// The clip that ?clip says, else the pack's first.
function beginClips() {
    for (let i = 0; i < Module._web_clip_count(); i++) {
        if (Module._web_clip_seconds(i) >= 0) byId('clips').add(new Option(text(Module._web_clip_name(i)), i));
    }
    const options = [...byId('clips').options], asked = query.get('clip');
    byId('motion').hidden = options.length < 2;
    const first = asked ? options.find((o) => o.text === asked) : options[1];
    byId('clips').value = first ? first.value : -1;
    choose(0);
    if (clip() >= 0 && !matchMedia('(prefers-reduced-motion: reduce)').matches) setPlaying(true);
}

// ---- start ----

function addRow(cells, tag) {
    const row = byId('memory').insertRow();
    for (const value of cells) {
        const cell = document.createElement(tag || 'td');
        cell.textContent = typeof value === 'number' ? value.toLocaleString('en') : value;
        row.append(cell);
    }
}

// What each part of noh takes, and what the page gives it.
function showMemory() {
    const parts = Array.from({ length: Module._web_part_count() }, (_, i) =>
        ({ name: text(Module._web_part_name(i)), cpu: Module._web_part_cpu_bytes(i), gpu: Module._web_part_gpu_bytes(i) }));
    const sum = (key) => parts.reduce((all, p) => all + p[key], 0);
    const memory = {
        cpu: sum('cpu'), gpu: Module._web_gpu_bytes(), room: Module._web_memory_room(), pack: Module._web_pack_room(), all: Module.HEAPU8.length,
    };
    window.noh.memory = memory;
    byId('memory').replaceChildren();
    addRow(['', 'CPU', 'GPU'], 'th');
    for (const p of parts) if (p.cpu || p.gpu) addRow([p.name, p.cpu, p.gpu]);
    addRow(['noh uses', memory.cpu, memory.gpu]);
    addRow(['of', memory.room, '']);
    addRow(['the pack', memory.pack, '']);
    addRow(['WebAssembly, cannot grow', memory.all, '']);
    byId('device').textContent = `path ${window.noh.path}, ${window.noh.renderer}`;
}

async function start() {
    const answer = await fetch(query.get('pack') || 'page.noh');
    if (!answer.ok) fail(`no pack: ${answer.status}`);
    const file = new Uint8Array(await answer.arrayBuffer());
    const place = Module._web_pack(file.length);
    if (!place) fail(`the pack has ${file.length} bytes, more than the page was built for`);
    Module.HEAPU8.set(file, place);
    check(Module._web_open(file.length, Math.max(0, paths.indexOf(query.get('path') || 'auto'))));
    for (let i = 0; i < Module._web_target_count(); i++) addSlider(i, text(Module._web_target_name(i)));
    byId('faces').hidden = !sliders.length;
    window.noh.renderer = text(Module._web_renderer());
    window.noh.path = text(Module._web_path());
    beginDetail();
    beginClips();
    fit();
    byId('message').textContent = '';
    window.noh.ready = true;
    resize();
    draw();
    check(Module._web_check());
    showMemory();
    new ResizeObserver(resize).observe(canvas);
}

var Module = { onRuntimeInitialized: () => start().catch((error) => { byId('message').textContent = window.noh.error = String(error.message || error); }) };
window.Module = Module;
