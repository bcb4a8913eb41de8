// page.js: the page around the WebAssembly program (main.c): sliders, clips, the camera.
// The pack is page.noh, or what ?pack=NAME says; ?path=gather forces a path.
'use strict';

const query = new URLSearchParams(location.search);
const paths = ['auto', 'layered', 'mrt', 'per-layer', 'gather', 'cpu'];
const byId = (id) => document.getElementById(id);
const canvas = byId('canvas');
const orbit = { azimuth: 0, elevation: 0.05, distance: 0 };
let lost = false;
let wanted = false;

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

function product(a, b) {
    const out = new Float32Array(16);
    for (let i = 0; i < 16; i++) {
        for (let k = 0; k < 4; k++) out[i] += a[4 * k + i % 4] * b[4 * (i >> 2) + k];
    }
    return out;
}

function setCamera() {
    const b = floats(Module._web_bounds(), 6);
    const centre = [0, 1, 2].map((c) => (b[c] + b[3 + c]) / 2);
    const half = [0, 1, 2].map((c) => (b[3 + c] - b[c]) / 2);
    const aspect = canvas.width / canvas.height, f = 1 / Math.tan(Math.PI / 12);
    const radius = Math.max(Math.hypot(...half), 1e-6);
    const need = Math.max(half[1], Math.max(half[0], half[2] * 0.7) / aspect) * 1.05;
    if (!orbit.distance) orbit.distance = Math.max(need * f + half[2], radius * 1.02);
    const d = orbit.distance, near = Math.max(d - 2 * radius, d * 0.02), far = d + 2 * radius;
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

// ---- frames ----

function draw() {
    wanted = false;
    if (lost || !window.noh.ready) return;
    setCamera();
    check(Module._web_draw());
    window.noh.frames++;
}

function redraw() {
    if (!wanted) requestAnimationFrame(draw);
    wanted = true;
}

canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault(); // else it never comes back
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

canvas.addEventListener('pointermove', (event) => {
    if (!event.buttons) return;
    orbit.azimuth -= event.movementX * 0.01;
    orbit.elevation = Math.min(1.5, Math.max(-1.5, orbit.elevation + event.movementY * 0.01));
    redraw();
});
canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    orbit.distance *= Math.exp(event.deltaY * 0.001);
    redraw();
}, { passive: false });

// ---- targets and clips ----

const sliders = [];

function addSlider(index, name) {
    const label = document.createElement('label'), span = document.createElement('span'), slider = document.createElement('input');
    span.textContent = name;
    Object.assign(slider, { type: 'range', min: -1, max: 2, step: 0.01, value: Module._web_weight(index) });
    slider.dataset.target = name;
    slider.addEventListener('input', () => {
        Module._web_set_weight(index, Number(slider.value));
        redraw();
    });
    label.append(span, slider);
    byId('targets').append(label);
    sliders.push({ label, slider, name: name.toLowerCase() });
}

byId('search').addEventListener('input', () => {
    const part = byId('search').value.toLowerCase();
    for (const s of sliders) s.label.style.display = s.name.includes(part) ? '' : 'none';
});

function applyClip() {
    const clip = Number(byId('clips').value);
    if (clip < 0) return;
    Module._web_set_clip(clip, Number(byId('time').value) * Module._web_clip_seconds(clip));
    sliders.forEach((s, i) => { s.slider.value = Module._web_weight(i); });
    redraw();
}

let before = 0;
function play(now) {
    const clip = Number(byId('clips').value);
    if (!byId('play').checked || clip < 0) return;
    const seconds = Module._web_clip_seconds(clip) || 1;
    byId('time').value = (Number(byId('time').value) + (now - before) / 1000 / seconds) % 1;
    before = now;
    applyClip();
    requestAnimationFrame(play);
}
byId('clips').addEventListener('change', applyClip);
byId('time').addEventListener('input', applyClip);
byId('play').addEventListener('change', () => { before = performance.now(); requestAnimationFrame(play); });

// ---- start ----

function showMemory() {
    const rows = {
        'WebAssembly memory': Module.HEAPU8.length,
        'of it, pack and noh': Module._web_static_bytes(),
        'noh uses': Module._web_memory_bytes(),
        'on the GPU, canvas included': Module._web_gpu_bytes(),
    };
    window.noh.memory = rows;
    for (const [name, bytes] of Object.entries(rows)) {
        const row = byId('memory').insertRow();
        row.insertCell().textContent = name;
        row.insertCell().textContent = bytes.toLocaleString('en');
    }
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
    for (let i = 0; i < Module._web_clip_count(); i++) {
        byId('clips').add(new Option(text(Module._web_clip_name(i)), i));
    }
    byId('message').textContent = '';
    window.noh.renderer = text(Module._web_renderer());
    window.noh.path = text(Module._web_path());
    window.noh.ready = true;
    draw();
    showMemory();
}

var Module = { onRuntimeInitialized: () => start().catch((error) => { byId('message').textContent = window.noh.error = String(error.message || error); }) };
window.Module = Module;
