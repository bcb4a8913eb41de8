// page.js: the page around the WebAssembly program (main.c): the camera, clips, sliders, the table of memory.
// The query: ?path=gather forces a path; ?clip=NAME begins with that
// clip, or with none; ?face=NAME has that clip's face over it; ?detail=0 begins with that LOD level; ?camera=fixed leaves
// the camera where it is; ?actors=3 shows so many characters, as far as the page was built for them; ?size=512 draws a
// canvas of so many pixels across. load.js, light.js, hair.js, faces.js and speech.js have parts of the query of their own.
'use strict';

const query = new URLSearchParams(location.search);
const paths = ['auto', 'layered', 'mrt', 'per-layer', 'gather', 'cpu', 'blend'];
const transition = 0.3; // seconds from one clip into another
const body = 0, face = 1; // layers
const byId = (id) => document.getElementById(id);
const canvas = byId('canvas');
let lost = false;
let wanted = false;
let drawn = 0; // time of the last frame, in ms
let busy = 0; // until then something fades

// Tests wait for these.
window.noh = { ready: false, whole: false, coarse: 0, lost: 0, restored: 0, frames: 0, due: 0, error: '' };

function fail(text) {
    window.noh.error = text;
    byId('message').textContent = text;
    throw new Error(text);
}

// What is not as the query asks, beside the picture.
const say = (words) => { byId('message').textContent = words; };

const text = (pointer) => Module.UTF8ToString(pointer);
const check = (result) => { if (result) fail(text(Module._web_error())); };
const floats = (pointer, count) => Module.HEAPF32.subarray(pointer >> 2, (pointer >> 2) + count);

// ---- the camera: as `noh render` has it, 30 degrees high ----

const front = { azimuth: 0, elevation: 0.05 };
const orbit = { ...front, distance: 0, box: null, from: [0, 0, 0], offset: [0, 0, 0], right: [1, 0, 0], up: [0, 1, 0], pixel: 0 };
const walked = () => Array.from(floats(Module._web_walked(), 3));

function product(a, b) {
    const out = new Float32Array(16);
    for (let i = 0; i < 16; i++) {
        for (let k = 0; k < 4; k++) out[i] += a[4 * k + i % 4] * b[4 * (i >> 2) + k];
    }
    return out;
}

// Come as near as all figures in their current pose allow.
function fit() {
    orbit.box = Array.from(floats(Module._web_measure(), 6));
    orbit.from = walked();
    orbit.distance = 0;
    orbit.offset = [0, 0, 0];
    redraw();
}

function setCamera() {
    const b = orbit.box, to = byId('follow').checked ? walked() : orbit.from;
    const centre = [0, 1, 2].map((c) => (b[c] + b[3 + c]) / 2 + to[c] - orbit.from[c] + orbit.offset[c]);
    const half = [0, 1, 2].map((c) => (b[3 + c] - b[c]) / 2);
    const aspect = canvas.width / canvas.height, f = 1 / Math.tan(Math.PI / 12);
    const radius = Math.max(Math.hypot(...half), 1e-6);
    const need = Math.max(half[1], Math.max(half[0], half[2] * 0.7) / aspect) * 1.05;
    const fitting = Math.max(need * f + half[2], radius * 1.02);
    const d = (orbit.distance || 1) * fitting, near = Math.max(d - 2 * radius, d * 0.02), far = d + 2 * radius;
    const ca = Math.cos(orbit.azimuth), sa = Math.sin(orbit.azimuth);
    const ce = Math.cos(orbit.elevation), se = Math.sin(orbit.elevation);
    const right = [ca, 0, -sa], up = [-sa * se, ce, -ca * se], back = [sa * ce, se, ca * ce];
    Object.assign(orbit, { right, up, pixel: 2 * d / f / canvas.clientHeight });
    const eye = centre.map((c, i) => c + back[i] * d);
    const dot = (a) => a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2];
    const view = [0, 1, 2].flatMap((c) => [right[c], up[c], back[c], 0]).concat([-dot(right), -dot(up), -dot(back), 1]);
    const projection = [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, -(far + near) / (far - near), -1, 0, 0, -2 * far * near / (far - near), 0];
    const key = right.map((r, i) => -0.45 * r + 0.62 * up[i] + 0.64 * back[i]);
    const out = floats(Module._web_view(), 22); // matrix, eye, light
    out.set(product(projection, view), 0);
    out.set(eye, 16);
    out.set(key.map((k) => k / Math.hypot(...key)), 19);
}

// One finger or the mouse turns the figure; two fingers or the wheel zoom; two fingers that go the same way, or a drag
// with the right button, move the picture; a drag with shift turns the light; a tap or a click picks. keys.js has the
// same for the keyboard.
const pointers = new Map();
let tapped = null;
const apart = () => {
    const [a, b] = [...pointers.values()];
    return Math.max(Math.hypot(a.x - b.x, a.y - b.y), 1);
};
function zoom(by) {
    orbit.distance = Math.min(4, Math.max(0.15, (orbit.distance || 1) * by));
    redraw();
}
function turn(azimuth, elevation) {
    orbit.azimuth += azimuth;
    orbit.elevation = Math.min(1.5, Math.max(-1.5, orbit.elevation + elevation));
    redraw();
}
// By pixels of the page: what is under a finger stays there.
function pan(x, y) {
    orbit.offset = orbit.offset.map((o, i) => o + (y * orbit.up[i] - x * orbit.right[i]) * orbit.pixel);
    redraw();
}
function pick(event) {
    const r = canvas.getBoundingClientRect();
    const x = (event.clientX - r.left) * canvas.width / r.width, y = (event.clientY - r.top) * canvas.height / r.height;
    if (event.altKey) return push((strength) => Module._web_push_at(x, y, strength));
    const names = Module._web_pick(x, y) ? [Module._web_picked_mesh(), Module._web_picked_joint()].map(text) : [];
    byId('picked').textContent = names.filter((name) => name).join(', joint ');
}
canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    tapped = pointers.size ? null : { x: event.clientX, y: event.clientY };
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
});
canvas.addEventListener('pointermove', (event) => {
    const at = pointers.get(event.pointerId);
    if (!at || pointers.size > 2) return;
    if (tapped && Math.hypot(event.clientX - tapped.x, event.clientY - tapped.y) > 6) tapped = null;
    const x = event.clientX - at.x, y = event.clientY - at.y, before = pointers.size === 2 ? apart() : 0;
    Object.assign(at, { x: event.clientX, y: event.clientY });
    if (before) pan(x / 2, y / 2);
    if (before) return zoom(before / apart());
    if (event.shiftKey) return turnLight(x);
    return event.buttons === 2 ? pan(x, y) : turn(-x * 0.01, y * 0.01);
});
canvas.addEventListener('contextmenu', (event) => event.preventDefault());
canvas.addEventListener('pointerup', (event) => {
    if (tapped && !lost) pick(event);
    tapped = null;
});
for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    zoom(Math.exp(event.deltaY * 0.001));
}, { passive: false });

// A push at the chest or where a click with Alt hits, newton seconds. Who lies gets up, and goes on with the clip.
const strength = 90;
let fallen = 0;
function push(by) {
    const error = lost ? 0 : by(strength);
    byId('push-text').hidden = !error;
    byId('push-text').textContent = error ? `cannot be pushed: ${text(Module._web_error())}` : '';
    redraw();
}
function showFall() {
    const before = fallen;
    fallen = Module._web_fallen();
    if (before && !fallen && clip() >= 0) play(body, clip(), 0, transition);
}
byId('push').addEventListener('click', () => push(Module._web_push));

byId('fit').addEventListener('click', fit);
byId('front').addEventListener('click', () => { Object.assign(orbit, front); redraw(); });
byId('follow').addEventListener('change', redraw);

// ---- frames ----

function draw() {
    wanted = false;
    if (lost || !window.noh.ready) return;
    const now = performance.now();
    showSpeech();
    check(Module._web_step(Math.min(now - drawn, 100) / 1000));
    drawn = now;
    showFall();
    setCamera();
    check(Module._web_draw());
    window.noh.frames++;
    showDetail();
    showTime();
    sliders.forEach(showWeight);
    if (playing || now < busy || Module._web_fades() || isAlive() || isSpeaking() || fallen || hairMoves()) redraw();
}

function redraw() {
    window.noh.due = window.noh.frames + 1;
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
    chooseLight();
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
    byId('detail').length = 2; // by pixels, full
    for (let i = 1; i < count; i++) byId('detail').add(new Option(`level ${i}`, i));
    byId('details').hidden = count < 2;
    const asked = Number(query.get('detail') || -1);
    byId('detail').value = asked >= 0 && asked < count ? asked : -1;
    Module._web_set_level(Number(byId('detail').value));
}

// ---- clips ----

const clip = () => Number(byId('clips').value);
let playing = false;

function showTime() {
    const time = Module._web_time();
    byId('time').value = time;
    byId('time-text').textContent = `${time.toFixed(2)} s`;
}

const setSpeed = () => Module._web_set_speed(playing ? Number(byId('speed').value) : 0);

function play(layer, which, time, over) {
    check(Module._web_play(layer, which, time, over));
    busy = performance.now() + 1000 * over + 100;
    redraw();
}

function choose(over) {
    byId('time').max = Math.max(clip() < 0 ? 0 : Module._web_clip_seconds(clip()), 0.001);
    play(body, clip(), 0, over);
}

function setPlaying(on) {
    playing = on;
    byId('play').textContent = playing ? 'pause' : 'play';
    setSpeed();
    redraw();
}

byId('play').addEventListener('click', () => setPlaying(!playing));
byId('clips').addEventListener('change', () => choose(playing ? transition : 0));
byId('face').addEventListener('change', () => play(face, Number(byId('face').value), 0, transition));
byId('time').addEventListener('input', () => {
    setPlaying(false);
    play(body, clip(), Number(byId('time').value), 0);
});
byId('speed').addEventListener('input', () => {
    byId('speed-text').textContent = Number(byId('speed').value).toFixed(2);
    setSpeed();
});

function listClips(select) {
    select.length = 1; // none
    for (let i = 0; i < Module._web_clip_count(); i++) {
        if (Module._web_clip_seconds(i) >= 0) select.add(new Option(text(Module._web_clip_name(i)), i));
    }
}

// The clip of the query; without one the option that is given, or none.
function begin(select, name, otherwise) {
    const options = [...select.options], asked = query.get(name);
    const first = asked ? options.find((o) => o.text === asked) : options[otherwise];
    select.value = first ? first.value : -1;
}

// A face is offered where clips may move a body beside it.
function beginClips() {
    const moves = Module._web_joint_count() > 0;
    listClips(byId('clips'));
    listClips(byId('face'));
    byId('motion').hidden = byId('clips').options.length < 2;
    byId('faces-row').hidden = !moves || !sliders.length;
    byId('follow-row').hidden = byId('push-row').hidden = !moves;
    byId('follow').checked = query.get('camera') !== 'fixed';
    begin(byId('clips'), 'clip', 1);
    begin(byId('face'), 'face', 0);
    setSpeed();
    choose(0);
    if (Number(byId('face').value) >= 0) play(face, Number(byId('face').value), 0, transition);
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
    const byName = new Map();
    for (let i = 0; i < Module._web_part_count(); i++) { // those of several skeletons in one row
        const name = text(Module._web_part_name(i)), row = byName.get(name) || { name, cpu: 0, gpu: 0 };
        row.cpu += Module._web_part_cpu_bytes(i);
        row.gpu += Module._web_part_gpu_bytes(i);
        byName.set(name, row);
    }
    const parts = [...byName.values()];
    const sum = (key) => parts.reduce((all, p) => all + p[key], 0);
    const memory = {
        cpu: sum('cpu'), gpu: Module._web_gpu_bytes(), room: Module._web_memory_room(), pack: Module._web_pack_room(), all: Module.HEAPU8.length,
    };
    window.noh.memory = memory;
    byId('memory').replaceChildren();
    addRow(['of', 'CPU', 'GPU'], 'th');
    for (const p of parts) if (p.cpu || p.gpu) addRow([p.name, p.cpu, p.gpu]);
    addRow(['the stage', memory.cpu, memory.gpu]);
    addRow(['its block', memory.room, '']);
    addRow(['the pack', memory.pack, '']);
    addRow(['WebAssembly, cannot grow', memory.all, '']);
    byId('device').textContent = (window.noh.path ? `path ${window.noh.path}, ` : '') + window.noh.renderer;
}

// A pack as it begins. again: another one was shown before it.
function showPack(again) {
    if (!again) beginLight();
    check(again ? Module._web_open_again() : Module._web_open(Math.max(0, paths.indexOf(query.get('path') || 'auto')),
        Number(query.get('actors') || 1), query.get('alive') === 'off' ? 0 : 1));
    const box = floats(Module._web_measure(), 6);
    Module._web_set_spacing((box[3] - box[0]) * 1.1);
    listTargets();
    window.noh.renderer = text(Module._web_renderer());
    window.noh.path = text(Module._web_path());
    beginDetail();
    beginClips();
    say('');
    beginTransfer();
    beginHair();
    beginFaces();
    beginSpeech();
    fit();
    window.noh.ready = true;
    resize();
    draw();
    check(Module._web_check());
    showMemory();
}

// All levels in place of the coarsest: what was chosen and held meanwhile stays.
function goOn() {
    const time = Module._web_time(), kept = sliders.filter((s) => s.label.classList.contains('held')).map((s) => [s.slider.dataset.target, Number(s.slider.value)]);
    const over = Number(byId('face').value);
    check(Module._web_open_again());
    listTargets();
    for (const [name, weight] of kept) hold(sliders.find((s) => s.slider.dataset.target === name), weight);
    beginDetail();
    play(body, clip(), time, 0);
    if (over >= 0) play(face, over, 0, 0);
    if (!byId('hair-section').hidden) setHair();
    smooth();
    setAlive();
    feel();
    draw();
    check(Module._web_check());
    showMemory();
}

function showArrived(shows, again) {
    if (window.noh.ready) goOn();
    else showPack(again);
    if (shows === 1) window.noh.coarse = window.noh.frames;
    window.noh.whole = shows === 2;
}

// Of another pack than the one that is shown, which goes.
function takeOver() {
    Object.assign(window.noh, { ready: false, whole: false, error: '' });
    return (shows) => showArrived(shows, true);
}

async function start() {
    await load(asked, (shows) => showArrived(shows, false));
    new ResizeObserver(resize).observe(canvas);
}

var Module = { onRuntimeInitialized: () => start().catch((error) => { byId('message').textContent = window.noh.error = String(error.message || error); }) };
window.Module = Module;
