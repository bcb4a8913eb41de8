// element.js: <noh-character src="x.noh" clip="walk" light="room" camera-orbit auto-life>.
import { limitsOf } from './camera.js';
import { Character } from './character.js';
import { convertAddress, isModel, Visitor } from './convert.js';
import { Hotspots } from './hotspots.js';
import { addGaze, addPointers } from './pointer.js';
import { kilobytes } from './program.js';

const style = `
:host { display: block; position: relative; height: 20rem; overflow: hidden; background: #4e4f52; color: #fff; font: 15px/1.4 system-ui, sans-serif; }
:host([hidden]) { display: none; }
:host([background=transparent]) { background: none; }
canvas { display: block; width: 100%; height: 100%; }
:host([camera-orbit]) canvas { touch-action: pan-y; cursor: grab; }
:host([camera-orbit]) canvas:active { cursor: grabbing; }
canvas:focus-visible { outline: 3px solid Highlight; outline-offset: -3px; }
.poster, .poster ::slotted(*), .poster img { position: absolute; inset: 0; width: 100%; height: 100%; object-fit: contain; pointer-events: none; }
.progress, .message { position: absolute; inset: auto 0 0 0; padding: .5rem .8rem; background: #000c; }
.bar { display: flex; gap: .7rem; align-items: center; }
progress { flex: 1; min-width: 0; max-width: 16rem; }
.hotspot { position: absolute; inset: 0 auto auto 0; pointer-events: none; }
.hotspot:not(.away) ::slotted(*) { pointer-events: auto; }
.hotspot.away ::slotted(*) { opacity: var(--min-hotspot-opacity, .25); }
.caption { position: absolute; inset: auto 0 0 0; padding: .5rem .8rem; background: #000c; text-align: center; }
.message { color: #ffc4ba; white-space: pre-wrap; max-height: 40%; overflow: auto; }
.message button { font: inherit; float: right; margin-left: .7rem; }
[hidden] { display: none !important; }`;

const body = `<div class="poster" part="poster"><slot name="poster"></slot></div>
<div class="hotspots"></div>
<div class="progress" part="progress" hidden><slot name="progress"><div class="bar"><progress aria-label="the character arrives"></progress><span></span></div></slot></div>
<div class="caption" part="caption" role="status" hidden></div>
<div class="message" part="message" role="status" hidden><button part="retry" hidden>try again</button><span></span></div>`;

// One for all elements; adopted, because policies refuse a <style>.
let sheet = null;
function styleSheet() {
    if (!sheet) (sheet = new CSSStyleSheet()).replaceSync(style);
    return sheet;
}

const byKeys = 'drag or arrow keys turn it, pinch, plus and minus bring it closer, two fingers or arrows with shift move it, home frames it, space plays and pauses';
const ofLight = ['light', 'degrees', 'shadow', 'floor', 'tonemap', 'background'];

// Properties and their values without an attribute.
const properties = { src: '', clip: '', face: '', light: 'studio', degrees: 0, shadow: 'on', floor: 'on', tonemap: 'on', background: 'light', level: -1, speed: 1, emotion: '',
    alt: '', poster: '', loading: 'auto', program: 'all', tier: 'auto', path: 'auto', pixels: 'auto', characters: 1, view: 'full', cameraOrbit: false, minCameraOrbit: '', maxCameraOrbit: '', autoLife: false, captions: false, gaze: false, drop: false, paused: false };

const reduced = () => globalThis.matchMedia('(prefers-reduced-motion: reduce)');

// A plain class if there is no page (rendering on a server).
export class NohCharacter extends (globalThis.HTMLElement || Object) {
    static observedAttributes = ['src', 'poster', 'clip', 'face', ...ofLight, 'level', 'speed', 'view', 'min-camera-orbit', 'max-camera-orbit', 'emotion', 'alt', 'aria-label', 'camera-orbit', 'auto-life', 'paused'];

    constructor() {
        super();
        this.attachShadow({ mode: 'open' }).innerHTML = body;
        this.shadowRoot.adoptedStyleSheets = [styleSheet()];
        this.inside = (selector) => this.shadowRoot.querySelector(selector);
        this.character = null;
        this.faults = new Map(); // messages, by what failed: a success removes its own
        this.waiting = []; // calls until the pack is shown
        this.renew();
        this.visitor = new Visitor();
        this.inside('button').addEventListener('click', () => this.again());
    }

    // Another `ready`, which resolves to the element when a pack is shown, and rejects if it cannot be.
    renew() {
        this.ready = new Promise((resolve, reject) => { this.settle = { resolve, reject }; });
        this.ready.catch(() => {}); // an unheard one is an event, not an error of the page
        this.arriving = true;
    }

    // ---- added to and removed from the page ----

    connectedCallback() {
        if (this.character) return; // it was moved
        for (const name of [...Object.keys(properties), 'voice']) { // set before the element was defined
            if (!Object.hasOwn(this, name)) continue;
            const value = this[name];
            delete this[name];
            this[name] = value;
        }
        this.ended = new AbortController();
        this.canvas = document.createElement('canvas'); // a released context cannot be restored
        this.canvas.part = 'canvas';
        this.inside('.poster').before(this.canvas);
        this.character = new Character(this.canvas, this.wishes());
        this.limitCamera();
        this.hotspots = new Hotspots(this, this.inside('.hotspots'), (words) => this.blame('hotspot', words));
        this.watch();
        this.nameCanvas();
        this.showPoster();
        if (this.src && this.loading !== 'lazy') this.load(this.src);
    }

    // A moved element is in the page again before this ends.
    disconnectedCallback() {
        queueMicrotask(() => { if (!this.isConnected) this.dispose(); });
    }

    // Releases the context and drops the memory. Added to the page again, the element restarts.
    dispose() {
        if (!this.character) return;
        this.ended.abort();
        this.endPointers();
        this.hotspots.end();
        this.sees.disconnect();
        this.character.dispose();
        this.loads = 0;
        this.canvas.remove();
        this.character = this.canvas = null;
        this.inside('.poster').hidden = false;
        this.faults.clear();
        this.tell();
        if (!this.arriving) this.renew();
    }

    watch() {
        const { character } = this, { signal } = this.ended;
        const pass = (type, call) => character.addEventListener(type, ({ detail }) => {
            if (call) call(detail);
            this.dispatchEvent(new CustomEvent(type, { detail }));
        }, { signal });
        pass('load', () => this.shown());
        pass('progress', (detail) => this.showProgress(detail));
        pass('lost', () => this.tell('the graphics context is lost'));
        pass('restored', () => this.tell());
        pass('caption', ({ words, silent }) => {
            this.inside('.caption').textContent = words;
            this.inside('.caption').hidden = !words || !(silent || this.captions);
        });
        for (const type of ['word', 'key', 'pick', 'push', 'speech', 'pause', 'light']) pass(type);
        pass('frame', () => this.hotspots.update(character));
        character.addEventListener('fault', ({ detail }) => this.fail('frame', new Error(detail.message)), { signal });
        globalThis.addEventListener('online', () => { if (this.failed) this.again(); }, { signal });
        reduced().addEventListener('change', () => this.rest(), { signal });
        this.addEventListener('dragover', (event) => { if (this.drop) event.preventDefault(); }, { signal });
        this.addEventListener('drop', (event) => this.dropped(event), { signal });
        this.endPointers = this.addPointers();
        this.sees = new IntersectionObserver(([entry]) => { // draw only while visible
            character.stopped = !entry.isIntersecting;
            if (character.stopped) return;
            if (!this.loads && this.src) this.load(this.src); // loading="lazy"
            character.redraw();
        });
        this.sees.observe(this);
    }

    // The wheel scrolls the page until the figure is clicked.
    addPointers() {
        const orbits = () => this.cameraOrbit;
        const ends = [addPointers(this.canvas, this.character, (event) => event.ctrlKey || this.shadowRoot.activeElement === this.canvas, orbits),
            addGaze(this.canvas, this.character, () => this.gaze)];
        return () => { for (const end of ends) end(); };
    }

    // ---- the pack ----

    // The attributes as options.
    wishes() {
        const { program, tier, path, pixels, characters, view, light, degrees, shadow, background, level, speed } = this;
        return { program, tier, voice: this.voice, path, pixels, characters, view, light, degrees, shadow, floor: this.floor !== 'off', tonemap: this.tonemap !== 'none', background, level, speed,
            paused: this.rests(), calm: !this.lives() };
    }

    // An address (of a model, too), a Response, a File or Blob, or bytes. Resolves to whether the whole pack is shown; an error is shown as
    // an event and a text, with a button to try again.
    async load(source) {
        const { character } = this, number = this.loads = (this.loads || 0) + 1, mine = () => this.loads === number && character === this.character;
        if (!character) return false;
        if (!this.arriving) this.renew();
        this.failed = null;
        this.faults.clear();
        this.tell();
        this.fresh = true;
        this.showProgress({ taken: 0, all: 0, shows: 0 });
        const warnings = [], show = (what) => { if (mine()) this.showProgress({ taken: 0, all: 0, shows: 0, ...what }); };
        try {
            const converts = (typeof source === 'string' || source instanceof URL) && isModel(source);
            const pack = converts ? await convertAddress(source, { progress: (taken, all) => show({ taken, all }), tell: (words) => show({ words }), warn: (words) => warnings.push(words) }) : source;
            if (!mine()) return false;
            await character.load(pack);
        } catch (error) {
            if (mine()) this.missed(source, error);
            return false;
        }
        if (!mine()) return false;
        this.inside('.progress').hidden = true;
        this.warn(warnings);
        return true;
    }

    // Of the converter.
    warn(warnings) {
        for (const message of warnings) this.dispatchEvent(new CustomEvent('warning', { detail: { message } }));
        if (warnings.length) this.tell(warnings.join('\n'));
    }

    // The previous pack, if there is one, stays.
    missed(source, error) {
        this.arriving = this.fresh = false;
        this.settle.reject(error);
        if (typeof source === 'string' || source instanceof URL) this.failed = source; // others cannot be read twice
        this.fail('src', error);
        if (this.loaded) this.flush();
    }

    again() {
        if (this.failed) this.load(this.failed);
    }

    shown() {
        this.inside('.poster').hidden = true;
        if (!this.fresh) return;
        this.fresh = this.arriving = false;
        this.apply('clip');
        this.apply('face');
        this.apply('emotion');
        this.attempt('light', () => this.character.setLight({ background: this.background }));
        this.character.fit();
        this.settle.resolve(this);
        this.flush();
    }

    flush() { for (const call of this.waiting.splice(0)) call(); }

    // The attribute `poster`, an address, in place of the slot.
    showPoster() {
        const picture = new Image();
        Object.assign(picture, { src: this.poster, alt: '' });
        this.inside('slot').replaceChildren(...this.poster ? [picture] : []);
    }

    showProgress({ taken, all, shows, words, program = 0 }) {
        const bar = this.inside('progress');
        this.inside('.progress').hidden = shows === 2;
        if (all) Object.assign(bar, { max: all, value: taken });
        else bar.removeAttribute('value');
        this.style.setProperty('--noh-progress', all ? String(taken / all) : '0');
        this.inside('.bar span').textContent = words || `${shows ? 'finer detail' : 'loading'}: ${kilobytes(taken || program)}${all ? ` of ${kilobytes(all)}` : ''} kB`;
    }

    dropped(event) {
        if (!this.drop || !event.dataTransfer.files.length) return;
        event.preventDefault();
        event.stopPropagation();
        this.open(event.dataTransfer.files);
    }

    // The visitor's files: a pack, or a model with its files and clips, which is converted. As load.
    async open(list) {
        const files = [...list], { character } = this;
        if (!character) return false;
        this.faults.delete('files');
        this.tell();
        try {
            const mine = () => character === this.character, warnings = [];
            const tell = (words) => { if (mine()) this.showProgress({ taken: 0, all: 0, shows: 0, words }); };
            const pack = await this.visitor.pack(files, { tell, warn: (words) => warnings.push(words) });
            if (!mine() || !await this.load(pack)) return false;
            this.warn(warnings);
            return true;
        } catch (error) {
            if (character === this.character) this.fail('files', new Error(`${files[0].name} cannot be shown: ${error.message || error}`));
            return false;
        }
    }

    // ---- words ----

    // The first error; '' if there is none.
    get error() { return [...this.faults.values()][0] || ''; }

    tell(words = this.error) {
        this.inside('.message').hidden = !words;
        this.inside('.message span').textContent = words;
        this.inside('button').hidden = !this.failed;
    }

    fail(what, error) {
        const message = String(error.message || error);
        this.faults.set(what, message);
        this.inside('.progress').hidden = true;
        this.tell();
        this.dispatchEvent(new CustomEvent('error', { detail: { message } }));
    }

    nameCanvas() {
        const name = this.getAttribute('alt') || this.getAttribute('aria-label') || 'a character', orbits = this.cameraOrbit;
        this.canvas.setAttribute('role', orbits ? 'application' : 'img');
        this.canvas.setAttribute('aria-label', orbits ? `${name}; ${byKeys}` : name);
        if (orbits) this.canvas.tabIndex = 0;
        else this.canvas.removeAttribute('tabindex');
    }

    // ---- attributes ----

    rests() { return this.paused || reduced().matches; }
    lives() { return this.autoLife && !reduced().matches; }

    rest() {
        this.character.paused = this.rests();
        this.character.alive = this.lives();
    }

    attributeChangedCallback(name, before, after) {
        if (!this.character || before === after) return;
        if (name === 'src') {
            if (after && (this.loads || this.loading !== 'lazy' || !this.character.stopped)) this.load(after);
        } else if (name === 'poster') {
            this.showPoster();
        } else if (ofLight.includes(name)) {
            this.attempt('light', () => this.character.setLight(Object.fromEntries(Object.entries(this.wishes()).filter(([key]) => ofLight.includes(key)))));
        } else if (name === 'level' || name === 'speed') {
            this.character[name] = this.wishes()[name];
        } else if (name === 'view') {
            this.character.view = this.view;
            if (this.loaded) this.character.fit();
        } else if (name === 'min-camera-orbit' || name === 'max-camera-orbit') {
            this.limitCamera();
        } else if (name === 'paused' || name === 'auto-life') {
            this.rest();
        } else if (name === 'alt' || name === 'aria-label' || name === 'camera-orbit') {
            this.nameCanvas();
        } else {
            this.apply(name);
        }
    }

    limitCamera() {
        this.character.camera.limit(limitsOf(this.minCameraOrbit, this.maxCameraOrbit));
        if (this.loaded) this.character.redraw();
    }

    // A clip, a face or an emotion by name, if it exists.
    apply(name) {
        const { character } = this, value = this.getAttribute(name) || null;
        if (!character.loaded) return;
        this.attempt(name, () => {
            if (name === 'emotion') character.feel(value);
            else character.play(value, { layer: name === 'face' ? 'face' : 'body' });
        });
    }

    // A success removes the message of an earlier failure.
    attempt(what, call) {
        try {
            call();
        } catch (error) {
            this.fail(what, error);
            return;
        }
        this.blame(what, '');
    }

    blame(what, words) {
        if (words && words !== this.faults.get(what)) this.fail(what, words);
        else if (!words && this.faults.delete(what)) this.tell();
    }

    // ---- for programs ----

    get loaded() { return Boolean(this.character && this.character.loaded); }
    get whole() { return Boolean(this.character && this.character.whole); }
    get clips() { return this.loaded ? this.character.clips.map(({ name, seconds }) => ({ name, seconds })) : []; }
    get targets() { return this.loaded ? [...this.character.targets] : []; }
    get emotions() { return this.loaded ? [...this.character.emotions] : []; }
    get memory() { return this.loaded ? this.character.memory : null; }
    get time() { return this.loaded ? this.character.time : 0; }
    set time(seconds) { this.ask((character) => { character.time = seconds; }); }
    weight(target) { return this.loaded ? this.character.weight(target) : 0; }

    // Says sentences in place of the browser's voices; null: none.
    get voice() { return this.ownVoice || null; }
    set voice(voice) {
        this.ownVoice = voice;
        if (this.character) this.character.voice = voice;
    }

    // A call of the character, once the pack that is asked for is shown. Resolves to its result, or rejects, if the pack
    // lacks a name.
    ask(call) {
        return new Promise((resolve, reject) => {
            const run = () => {
                try {
                    resolve(call(this.character));
                } catch (error) {
                    reject(error);
                }
            };
            if (this.loaded && !this.arriving) run();
            else this.waiting.push(run);
        });
    }

    play(name, options) { return this.ask((character) => character.play(name, options)); }
    setWeight(target, weight) { return this.ask((character) => character.setWeight(target, weight)); }
    releaseWeight(target) { return this.ask((character) => character.releaseWeight(target)); }
    releaseWeights() { return this.ask((character) => character.releaseWeights()); }
    lookAt(x, y) { return this.ask((character) => character.lookAt(x, y)); }
    lookAhead() { return this.ask((character) => character.lookAhead()); }
    feel(emotion, amount) { return this.ask((character) => character.feel(emotion, amount)); }
    push() { return this.ask((character) => character.push()); }
    fit() { return this.ask((character) => character.fit()); }

    // Where a hotspot is, by the name of its slot, as in model-viewer; null: it is not shown.
    queryHotspot(name) { return this.hotspots ? this.hotspots.query(name) : null; }

    // The picture at full resolution, as a file.
    toBlob({ mimeType, quality } = {}) {
        return this.ask((character) => {
            character.sharp = true;
            character.draw();
            character.sharp = false;
            return new Promise((resolve) => { character.canvas.toBlob(resolve, mimeType, quality); });
        });
    }

    // Speech: sentences and sounds (Speech.speak), the microphone, or fifteen weights of mouth shapes.
    speak(what, options) { return this.ask((character) => character.speech.speak(what, options)); }
    listen() { return this.ask((character) => character.speech.listen()); }
    setMouth(weights) { return this.ask((character) => character.setMouth(weights)); }
    hush() { return this.ask((character) => character.speech.stop()); }
}

// Attributes as properties: camera-orbit is cameraOrbit.
for (const [name, otherwise] of Object.entries(properties)) {
    const attribute = name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);
    Object.defineProperty(NohCharacter.prototype, name, {
        enumerable: true, configurable: true,
        get() {
            if (typeof otherwise === 'boolean') return this.hasAttribute(attribute);
            const text = this.getAttribute(attribute);
            return text === null ? otherwise : typeof otherwise === 'number' ? Number(text) : text;
        },
        set(value) {
            if (typeof otherwise === 'boolean') this.toggleAttribute(attribute, Boolean(value));
            else if (value === null || value === undefined) this.removeAttribute(attribute);
            else this.setAttribute(attribute, value);
        },
    });
}

if (globalThis.customElements && !customElements.get('noh-character')) customElements.define('noh-character', NohCharacter);
