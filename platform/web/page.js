// page.js: panels around a character (package/character.js): clips, sliders, the table of memory. The query:
// ?path=gather forces a path; ?clip=NAME starts with this clip, or with none; ?face=NAME plays this clip on the face;
// ?detail=0 starts with this LOD level; ?camera=fixed keeps the camera in place; ?actors=3 shows three characters;
// ?size=512 draws a canvas 512 pixels wide; ?pixels=all always draws at full resolution; ?tier=phone or full shades as on phones or not. load.js, light.js, hair.js,
// faces.js, speech.js and tabs.js read other parts of the query.
'use strict';

const byId = (id) => document.getElementById(id);
const canvas = byId('canvas');
const arriving = import('./package/page.js'); // Character and its modules, joined (tools/web_join.sh)
let character = null;
let Module = null; // its program
let fresh = true; // the next pack starts afresh, else it continues

// Tests wait for these.
window.noh = { ready: false, whole: false, coarse: 0, lost: 0, restored: 0, frames: 0, due: 0, error: '' };

// Parts of the query that are not possible, shown next to the picture.
const say = (words) => { byId('message').textContent = words; };
const text = (pointer) => Module.text(pointer);

// ---- camera, pushes, picks ----

function showPush({ error }) {
    byId('push-text').hidden = !error;
    byId('push-text').textContent = error ? `cannot be pushed: ${error}` : '';
}

byId('push').addEventListener('click', () => character.push());
byId('fit').addEventListener('click', () => character.fit());
byId('front').addEventListener('click', () => {
    Object.assign(character.camera, { azimuth: 0, elevation: 0.05 });
    character.redraw();
});
byId('follow').addEventListener('change', () => {
    character.camera.follows = byId('follow').checked;
    character.redraw();
});

// ---- LOD levels ----

function showDetail() {
    if (byId('details').hidden) return;
    const shown = Module._web_level(), error = Module._web_error_pixels();
    byId('detail-text').textContent = `${shown ? `level ${shown}` : 'the full mesh'} is drawn, off by at most ${error.toFixed(2)} pixels`;
}

byId('detail').addEventListener('change', () => { character.level = Number(byId('detail').value); });

// By pixels, or at the chosen level if it exists.
function listDetail() {
    const count = Module._web_level_count();
    byId('detail').length = 2; // by pixels, full
    for (let i = 1; i < count; i++) byId('detail').add(new Option(`level ${i}`, i));
    byId('details').hidden = count < 2;
    byId('detail').value = character.level < count ? character.level : -1;
}

// ---- sharpness ----

function showSharpness() {
    const { share } = character, slow = window.noh.software ? 'no GPU draws here, so frames take long' : 'frames take long';
    byId('sharpness-text').textContent = share < 1 ? `${Math.round(100 * share)} % of the pixels across while it moves: ${slow}. All of them at rest.` : 'All pixels are drawn.';
}

byId('sparing').addEventListener('change', () => { character.sparing = byId('sparing').checked; });

// ---- clips ----

const nameOf = (option) => option.dataset.name || option.text; // as in the pack
const named = (select) => (Number(select.value) < 0 ? null : nameOf(select.selectedOptions[0]));

function showTime() {
    const time = character.time;
    byId('time').value = time;
    byId('time-text').textContent = `${time.toFixed(2)} s`;
}

function choose(fade) {
    const name = named(byId('clips'));
    byId('time').max = name === null ? 0.001 : Math.max(character.clipNamed(name).seconds, 0.001);
    character.play(name, { fade });
}

byId('play').addEventListener('click', () => { character.paused = !character.paused; });
byId('clips').addEventListener('change', () => choose(character.paused ? 0 : undefined));
byId('face').addEventListener('change', () => character.play(named(byId('face')), { layer: 'face' }));
byId('time').addEventListener('input', () => {
    character.paused = true;
    character.time = Number(byId('time').value);
});
byId('speed').addEventListener('input', () => {
    byId('speed-text').textContent = `${Number(byId('speed').value).toFixed(2)}\u00d7`;
    character.speed = Number(byId('speed').value);
});

function listClips(select) {
    select.length = 1; // none
    for (const clip of character.clips) {
        const option = new Option(wordsOf(clip.name), clip.index);
        option.dataset.name = clip.name;
        select.add(option);
    }
}

// The clip of the query; without one, the given option, or none.
function begin(select, name, otherwise) {
    const options = [...select.options], asked = query.get(name);
    const first = asked ? options.find((o) => nameOf(o) === asked) : options[otherwise];
    select.value = first ? first.value : -1;
}

// The action of the button, not the state.
function showPaused() {
    byId('play').textContent = character.paused ? 'play' : 'pause';
}

// Face clips are offered if clips may also move a body.
function beginClips() {
    const moves = Module._web_joint_count() > 0;
    listClips(byId('clips'));
    listClips(byId('face'));
    byId('motion').hidden = byId('clips').options.length < 2;
    byId('faces-row').hidden = !moves || !sliders.length;
    byId('follow-row').hidden = byId('push-row').hidden = !moves;
    begin(byId('clips'), 'clip', 1);
    begin(byId('face'), 'face', 0);
    character.paused = named(byId('clips')) === null || matchMedia('(prefers-reduced-motion: reduce)').matches;
    showPaused();
    choose(0);
    if (named(byId('face')) !== null) character.play(named(byId('face')), { layer: 'face' });
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

// The memory of each part of noh and of the pack.
function showMemory() {
    const { memory } = character;
    window.noh.memory = memory;
    byId('memory').replaceChildren();
    addRow(['of', 'CPU', 'GPU'], 'th');
    for (const p of memory.parts) if (p.cpu || p.gpu) addRow([p.name, p.cpu, p.gpu]);
    addRow(['the stage', memory.cpu, memory.gpu]);
    addRow(['its block', memory.room, '']);
    addRow(['the pack', memory.pack, '']);
    addRow(['WebAssembly, cannot grow', memory.all, '']);
    byId('device').textContent = `${window.noh.path ? `Targets are added by path ${window.noh.path}. ` : ''}Drawn by ${window.noh.renderer}${window.noh.software ? ', without a GPU' : ''}.`;
}

// A new pack.
function showPack() {
    fresh = false;
    character.releaseWeights();
    listTargets();
    beginClips();
    say('');
    beginTransfer();
    beginHair();
    beginFaces();
    beginSpeech();
    listTabs();
    beginGreeting();
    character.fit();
}

function showLoaded({ whole }) {
    Module = window.Module = character.program;
    window.noh.renderer = text(Module._web_renderer());
    window.noh.path = text(Module._web_path());
    listDetail();
    if (fresh) showPack();
    else listTargets(); // all levels replace the coarsest: choices and held weights stay
    character.draw();
    window.noh.ready = true;
    if (!whole) window.noh.coarse = character.frames;
    window.noh.whole = whole;
    showMemory();
}

function showFrame(detail) {
    showSwing(detail);
    window.noh.frames = character.frames;
    showDetail();
    showSharpness();
    showTime();
    sliders.forEach(showWeight);
}

function listen() {
    const on = (type, call) => character.addEventListener(type, (event) => call(event.detail));
    on('load', showLoaded);
    on('frame', showFrame);
    on('progress', showProgress);
    on('light', showLight);
    on('push', showPush);
    on('speech', showSaid);
    on('caption', showCaption);
    on('word', feelAtWord);
    on('pick', ({ mesh, joint }) => {
        if (!works()) return;
        byId('picked').textContent = [mesh, joint].filter((name) => name).join(', joint ');
    });
    on('pause', showPaused);
    on('lost', () => {
        window.noh.lost++;
        say('The browser has taken the graphics context away; the picture goes on when it comes back.');
    });
    on('restored', () => {
        window.noh.restored++;
        say('');
    });
}

async function start() {
    const { Character, addPointers, addGaze, isSoftware } = await arriving.catch(() => { throw new Error('the page cannot load its program: is this device online?'); });
    Object.defineProperty(window.noh, 'software', { get: () => isSoftware(window.noh.renderer) });
    character = new Character(canvas, {
        program: query.has('pack') ? undefined : byId('program').href, tier: query.get('tier') || 'auto', path: query.get('path') || 'auto', characters: Number(query.get('actors') || 1), alive: query.get('alive') !== 'off', size: Number(query.get('size')), pixels: query.get('pixels') || 'auto',
        view: viewAsked(), follows: query.get('camera') !== 'fixed', level: Number(query.get('detail') || -1), ...lightAsked(), ...hairAsked(),
    });
    byId('follow').checked = character.camera.follows;
    byId('sparing').checked = character.sparing;
    Object.defineProperty(window.noh, 'due', { get: () => character.due });
    listen();
    addPointers(canvas, character);
    addGaze(canvas, character, () => byId('looks').checked);
    await load(asked);
}

// After the other scripts are loaded.
document.addEventListener('DOMContentLoaded', () => start().catch((error) => {
    say(window.noh.error = String(error.message || error));
    byId('progress').hidden = true;
    byId('again').hidden = false;
    beginGreeting();
    for (const [on, type] of [[byId('again'), 'click'], [window, 'online']]) on.addEventListener(type, () => location.reload());
}));
