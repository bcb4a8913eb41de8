// element.js: <noh-character src="x.noh" clip="walk" light="room" camera-orbit auto-life>.
import { Character } from './character.js';
import { Visitor } from './convert.js';
import { addGaze, addPointers } from './pointer.js';
import { kilobytes } from './program.js';

const style = `
:host { display: block; position: relative; height: 20rem; overflow: hidden; background: #4e4f52; color: #fff; font: 15px/1.4 system-ui, sans-serif; }
:host([hidden]) { display: none; }
canvas { display: block; width: 100%; height: 100%; }
:host([camera-orbit]) canvas { touch-action: pan-y; cursor: grab; }
:host([camera-orbit]) canvas:active { cursor: grabbing; }
canvas:focus-visible { outline: 3px solid Highlight; outline-offset: -3px; }
.poster, .poster ::slotted(*) { position: absolute; inset: 0; width: 100%; height: 100%; object-fit: contain; pointer-events: none; }
.progress, .message { position: absolute; inset: auto 0 0 0; padding: .5rem .8rem; background: #000c; }
.bar { display: flex; gap: .7rem; align-items: center; }
progress { flex: 1; min-width: 0; max-width: 16rem; }
.message { color: #ffc4ba; white-space: pre-wrap; max-height: 40%; overflow: auto; }
.message:empty, [hidden] { display: none !important; }`;

const body = `<div class="poster" part="poster"><slot name="poster"></slot></div>
<div class="progress" part="progress" hidden><slot name="progress"><div class="bar"><progress aria-label="the character arrives"></progress><span></span></div></slot></div>
<div class="message" part="message" role="status"></div>`;

// One for all elements; adopted, because policies refuse a <style>.
let sheet = null;
function styleSheet() {
    if (!sheet) (sheet = new CSSStyleSheet()).replaceSync(style);
    return sheet;
}

const byKeys = 'drag or arrow keys turn it, pinch, plus and minus bring it closer, two fingers or arrows with shift move it, home frames it, space plays and pauses';
const ofLight = ['light', 'degrees', 'shadow', 'floor', 'tonemap', 'background'];

const reduced = () => globalThis.matchMedia('(prefers-reduced-motion: reduce)');

// A plain class if there is no page (rendering on a server).
export class NohCharacter extends (globalThis.HTMLElement || Object) {
    static observedAttributes = ['src', 'clip', 'face', 'light', 'degrees', 'shadow', 'floor', 'tonemap', 'background', 'level', 'speed', 'emotion', 'alt', 'aria-label',
        'camera-orbit', 'auto-life', 'paused'];

    constructor() {
        super();
        this.attachShadow({ mode: 'open' }).innerHTML = body;
        this.shadowRoot.adoptedStyleSheets = [styleSheet()];
        this.inside = (selector) => this.shadowRoot.querySelector(selector);
        this.character = null;
        this.error = '';
        this.visitor = new Visitor();
    }

    // ---- added to and removed from the page ----

    connectedCallback() {
        if (this.character) return; // it was moved
        this.ended = new AbortController();
        this.canvas = document.createElement('canvas'); // a released context cannot be restored
        this.canvas.part = 'canvas';
        this.inside('.poster').before(this.canvas);
        this.character = new Character(this.canvas, this.wishes());
        this.watch();
        this.nameCanvas();
        if (this.src) this.load(this.src);
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
        this.sees.disconnect();
        this.character.dispose();
        this.canvas.remove();
        this.character = this.canvas = null;
        this.inside('.poster').hidden = false;
        this.tell('');
    }

    watch() {
        const { character } = this, { signal } = this.ended;
        const pass = (type, call) => character.addEventListener(type, ({ detail }) => {
            if (call) call(detail);
            this.dispatchEvent(new CustomEvent(type, { detail }));
        }, { signal });
        pass('load', () => this.loaded());
        pass('progress', (detail) => this.showProgress(detail));
        pass('lost', () => this.tell('the graphics context is lost'));
        pass('restored', () => this.tell(''));
        for (const type of ['key', 'pick', 'push', 'speech', 'pause', 'light', 'frame']) pass(type);
        character.addEventListener('fault', ({ detail }) => this.fail(new Error(detail.message)), { signal });
        reduced().addEventListener('change', () => this.rest(), { signal });
        this.addEventListener('dragover', (event) => { if (this.hasAttribute('drop')) event.preventDefault(); }, { signal });
        this.addEventListener('drop', (event) => this.dropped(event), { signal });
        this.endPointers = this.addPointers();
        this.sees = new IntersectionObserver(([entry]) => { // draw only while visible
            character.stopped = !entry.isIntersecting;
            if (!character.stopped) character.redraw();
        });
        this.sees.observe(this);
    }

    // The wheel scrolls the page until the figure is clicked.
    addPointers() {
        const orbits = () => this.hasAttribute('camera-orbit');
        const ends = [addPointers(this.canvas, this.character, (event) => event.ctrlKey || this.shadowRoot.activeElement === this.canvas, orbits),
            addGaze(this.canvas, this.character, () => this.hasAttribute('gaze'))];
        return () => { for (const end of ends) end(); };
    }

    // ---- the pack ----

    // The attributes as options.
    wishes() {
        const text = (name, otherwise) => this.getAttribute(name) ?? otherwise;
        return {
            program: this.program || undefined, path: text('path', 'auto'), pixels: text('pixels', 'auto'), characters: Number(text('characters', 1)), light: text('light', 'studio'),
            degrees: Number(text('degrees', 0)), shadow: text('shadow', 'on'), floor: text('floor', 'on') !== 'off', tonemap: text('tonemap', 'on') !== 'none', background: text('background', 'light'),
            level: Number(text('level', -1)), speed: Number(text('speed', 1)), paused: this.rests(), calm: !this.lives(),
        };
    }

    // An address, a Response, a File or Blob, or bytes. Resolves when the whole pack is shown; an error is shown as an
    // event and a text, and rejects nothing.
    async load(source) {
        const { character } = this;
        if (!character) return false;
        this.tell('');
        this.fresh = true;
        this.showProgress({ taken: 0, all: 0, shows: 0 });
        try {
            await character.load(source);
        } catch (error) {
            if (character === this.character) this.fail(error);
            return false;
        }
        if (character === this.character) this.inside('.progress').hidden = true;
        return character === this.character;
    }

    loaded() {
        this.inside('.poster').hidden = true;
        if (!this.fresh) return;
        this.fresh = false;
        this.apply('clip');
        this.apply('face');
        this.apply('emotion');
        this.character.fit();
    }

    showProgress({ taken, all, shows, words }) {
        const bar = this.inside('progress');
        this.inside('.progress').hidden = shows === 2;
        if (all) Object.assign(bar, { max: all, value: taken });
        else bar.removeAttribute('value');
        this.style.setProperty('--noh-progress', all ? String(taken / all) : '0');
        this.inside('.bar span').textContent = words || `${shows ? 'finer detail' : 'loading'}: ${kilobytes(taken)}${all ? ` of ${kilobytes(all)}` : ''} kB`;
    }

    dropped(event) {
        if (!this.hasAttribute('drop') || !event.dataTransfer.files.length) return;
        event.preventDefault();
        event.stopPropagation();
        this.open(event.dataTransfer.files);
    }

    // The visitor's files: a pack, or a model with its files and clips, which is converted. As load.
    async open(list) {
        const files = [...list], { character } = this;
        if (!character) return false;
        this.tell('');
        try {
            const mine = () => character === this.character, warnings = [];
            const tell = (words) => { if (mine()) this.showProgress({ taken: 0, all: 0, shows: 0, words }); };
            const pack = await this.visitor.pack(files, { tell, warn: (words) => warnings.push(words) });
            if (!mine() || !await this.load(pack)) return false;
            for (const message of warnings) this.dispatchEvent(new CustomEvent('warning', { detail: { message } }));
            this.tell(warnings.join('\n'));
            return true;
        } catch (error) {
            if (character === this.character) this.fail(new Error(`${files[0].name} cannot be shown: ${error.message || error}`));
            return false;
        }
    }

    // ---- words ----

    tell(words) { this.inside('.message').textContent = words; }

    fail(error) {
        this.error = String(error.message || error);
        this.inside('.progress').hidden = true;
        this.tell(this.error);
        this.dispatchEvent(new CustomEvent('error', { detail: { message: this.error } }));
    }

    nameCanvas() {
        const name = this.getAttribute('alt') || this.getAttribute('aria-label') || 'a character', orbits = this.hasAttribute('camera-orbit');
        this.canvas.setAttribute('role', orbits ? 'application' : 'img');
        this.canvas.setAttribute('aria-label', orbits ? `${name}; ${byKeys}` : name);
        if (orbits) this.canvas.tabIndex = 0;
        else this.canvas.removeAttribute('tabindex');
    }

    // ---- attributes ----

    rests() { return this.hasAttribute('paused') || reduced().matches; }
    lives() { return this.hasAttribute('auto-life') && !reduced().matches; }

    rest() {
        this.character.paused = this.rests();
        this.character.alive = this.lives();
    }

    attributeChangedCallback(name, before, after) {
        if (!this.character || before === after) return;
        if (name === 'src') {
            if (after) this.load(after);
        } else if (ofLight.includes(name)) {
            this.character.setLight(Object.fromEntries(Object.entries(this.wishes()).filter(([key]) => ofLight.includes(key))));
        } else if (name === 'level' || name === 'speed') {
            this.character[name] = this.wishes()[name];
        } else if (name === 'paused' || name === 'auto-life') {
            this.rest();
        } else if (name === 'alt' || name === 'aria-label' || name === 'camera-orbit') {
            this.nameCanvas();
        } else {
            this.apply(name);
        }
    }

    // A clip, a face or an emotion by name, if it exists.
    apply(name) {
        const { character } = this, value = this.getAttribute(name) || null;
        if (!character.ready) return;
        try {
            if (name === 'emotion') character.feel(value);
            else character.play(value, { layer: name === 'face' ? 'face' : 'body' });
        } catch (error) {
            this.fail(error);
        }
    }

    // ---- for programs ----

    get src() { return this.getAttribute('src') || ''; }
    set src(address) { this.setAttribute('src', address); }
    get clip() { return this.getAttribute('clip') || ''; }
    set clip(name) { this.setAttribute('clip', name); }
    get light() { return this.getAttribute('light') || 'studio'; }
    set light(name) { this.setAttribute('light', name); }
    get paused() { return this.hasAttribute('paused'); }
    set paused(on) { this.toggleAttribute('paused', Boolean(on)); }

    get ready() { return Boolean(this.character && this.character.ready); }
    get whole() { return Boolean(this.character && this.character.whole); }
    get clips() { return this.ready ? this.character.clips.map(({ name, seconds }) => ({ name, seconds })) : []; }
    get targets() { return this.ready ? [...this.character.targets] : []; }
    get emotions() { return this.ready ? [...this.character.emotions] : []; }
    get memory() { return this.ready ? this.character.memory : null; }
    get time() { return this.ready ? this.character.time : 0; }
    set time(seconds) { if (this.ready) this.character.time = seconds; }

    play(name, options) { this.character.play(name, options); }
    setWeight(target, weight) { this.character.setWeight(target, weight); }
    releaseWeight(target) { this.character.releaseWeight(target); }
    releaseWeights() { this.character.releaseWeights(); }
    weight(target) { return this.ready ? this.character.weight(target) : 0; }
    lookAt(x, y) { this.character.lookAt(x, y); }
    lookAhead() { this.character.lookAhead(); }
    feel(emotion, amount) { this.character.feel(emotion, amount); }
    push() { return this.character.push(); }
    fit() { if (this.ready) this.character.fit(); }

    // Speech: a sentence, the microphone, a sound file, or fifteen weights of mouth shapes.
    say(words) { this.character.speech.say(words); }
    listen() { return this.character.speech.listen(); }
    playSound(file) { return this.character.speech.play(file); }
    setMouth(weights) { this.character.setMouth(weights); }
    hush() { this.character.speech.stop(); }
}

if (globalThis.customElements && !customElements.get('noh-character')) customElements.define('noh-character', NohCharacter);
