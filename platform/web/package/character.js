// character.js: a character on a canvas: loading its pack, drawing, clips, gaze, emotions and speech. Settings are
// stored here, so that they apply to the coarsest levels of a pack, to the whole pack, and to another pack.
import { Camera, framed, front } from './camera.js';
import { baked, forgetPrograms, linkAhead } from './gl.js';
import { Pixels } from './pixels.js';
import { Arrival, compile, explained, fetchFirst, learn, receive } from './program.js';
import { reach } from './reach.js';
import { Speech } from './speech.js';

export const layers = ['body', 'face'];
export const backgrounds = ['plain', 'gradient', 'light'];
const grey = [0.3035, 0.3094, 0.3227, 1];
export const shadows = ['off', 'on', 'blob'];
const transition = 0.3; // seconds between two clips
const mostPixels = 2; // canvas pixels per page pixel
const restsAfter = 300; // ms without a frame, after which a frame is drawn at full resolution
const longest = 4000; // of a frame, ms; longer gaps were not drawn
const settles = 2500; // ms in which gaze and emotion settle
const swings = 2000; // ms in which hair comes to rest
const shakes = 4000;
const prepares = 1000; // ms after a pack is there
const strength = 150; // of a push, newton seconds
const posesASecond = 8, mostPoses = 96; // of a clip, to frame it

// A background as [red, green, blue, alpha], 0 to 1: a CSS colour; grey, if it is named above; null: neither.
function colorOf(background) {
    if (backgrounds.includes(background)) return grey;
    if (!CSS.supports('color', background)) return null;
    const canvas = Object.assign(document.createElement('canvas'), { width: 1, height: 1 }), context = canvas.getContext('2d');
    context.fillStyle = background;
    context.fillRect(0, 0, 1, 1);
    return Array.from(context.getImageData(0, 0, 1, 1).data, (part) => part / 255);
}

// The default settings of a character.
const asMade = { light: 'studio', degrees: 0, shadow: 'on', floor: true, tonemap: true, background: 'light', transfer: true, level: -1, wrinkles: 1, calm: false,
    emotion: null, amount: 1, hair: true, wind: 0, speed: 1, paused: false };

export class Character extends EventTarget {
    // options: { program: 'all', 'body', 'face' or an address, tier, path, characters, alive, size: pixels across instead of the canvas's own,
    // pixels: 'auto': fewer while it moves and frames take long, or 'all', follows: whether the camera does, view: what it frames, voice: says sentences in place of the browser's voices (speech.js), elsewhere: another renderer draws (three.js) }, and what `asMade` has.
    constructor(canvas, options = {}) {
        super();
        const { program, tier = 'auto', path = 'auto', characters = 1, alive = true, size = 0, pixels = 'auto', follows = true, view = 'full', elsewhere = false, voice = null, ...chosen } = options;
        this.wants = { tier, path, characters, alive, elsewhere };
        Object.assign(this, { canvas, size, view, voice, pixels: new Pixels(), spares: pixels !== 'all', sharp: false, goesOn: false, address: program, program: null, camera: new Camera(), chosen: { ...asMade, ...chosen } });
        Object.assign(this, { weights: new Map(), playing: [{ clip: null }, { clip: null }], clips: [], targets: [], lights: [], emotions: [] });
        Object.assign(this, { loaded: false, whole: false, lost: false, wanted: false, drawn: 0, busy: 0, frames: 0, due: 0, fallen: 0, stopped: false });
        this.speech = new Speech(this);
        this.camera.follows = follows;
        this.ended = new AbortController();
        this.gl = canvas.getContext('webgl2', { antialias: true, depth: true, alpha: true, preserveDrawingBuffer: true }); // to allow saving the canvas
        if (this.gl && !elsewhere) {
            const [red, green, blue, alpha] = colorOf(this.chosen.background) || grey; // until there is a picture
            this.gl.clearColor(red * alpha, green * alpha, blue * alpha, alpha);
            this.gl.clear(this.gl.COLOR_BUFFER_BIT);
        }
        this.watch();
    }

    // 'full' or 'phone': how much is computed at each pixel.
    get tier() { return this.program && this.program.given[3] ? 'phone' : 'full'; }

    // Runs GL calls of the library together, for users of a shared context.
    around(call) { return call(); }

    emit(type, detail) {
        this.dispatchEvent(new CustomEvent(type, { detail }));
    }

    watch() {
        const { signal } = this.ended;
        this.canvas.addEventListener('webglcontextlost', (event) => {
            event.preventDefault(); // otherwise the browser never restores the context
            this.lost = true;
            forgetPrograms(this.gl);
            if (!signal.aborted) this.emit('lost');
        }, { signal });
        this.canvas.addEventListener('webglcontextrestored', () => this.restore(), { signal });
        this.resizes = new ResizeObserver(() => this.resize());
        this.resizes.observe(this.canvas);
    }

    restore() {
        if (this.program) this.program.check(this.program._web_restore());
        this.lost = false;
        if (this.program) this.setLight({});
        this.emit('restored');
        this.draw();
    }

    // ---- loading ----

    // source: an address, a Response, a File or Blob, or bytes. The present character stays until the new one can be
    // shown. Resolves when the whole pack is loaded.
    async load(source) {
        const number = this.loads = (this.loads || 0) + 1, was = this.whole;
        const mine = () => this.loads === number && !this.ended.signal.aborted;
        if (!this.gl) throw new Error('cannot create a WebGL 2 context: use a browser with WebGL 2');
        this.whole = false;
        let shown = 0;
        const show = async (arrival) => {
            const program = await arrival.open(this.wants), { shows } = arrival;
            if (!mine()) return;
            this.caps = arrival.caps();
            this.use(program, shown === 0);
            shown = shows;
            this.whole = shows === 2;
            this.emit('load', { whole: this.whole });
        };
        try {
            await this.arrive(source, () => shown, show, mine);
            if (mine()) setTimeout(() => mine() && learn(this.program.module), prepares);
            if (mine() && !this.wants.elsewhere) this.prepared = new Promise((resolve) => { setTimeout(() => resolve(mine() && !this.lost && this.prepare()), prepares); });
        } catch (error) {
            if (shown === 0 && mine()) this.whole = was;
            throw await explained(error);
        }
    }

    // Lets a worker prepare the lights that are not shown; without one, the first change to each takes its time. Resolves
    // when it has ended.
    prepare() {
        const { program, gl, caps } = this, { packBytes: bytes, given, module } = program, at = program._web_loaded_at();
        return new Promise((resolve) => {
            const worker = new Worker(new URL('./prepare.js', import.meta.url), { type: 'module' }); // the form that bundlers follow
            let links = Promise.resolve();
            const end = () => { worker.terminate(); resolve(links); };
            worker.onerror = (event) => { event.preventDefault(); end(); };
            worker.onmessage = ({ data: { light, texels, programs = [], ends } }) => {
                if (ends || this.program !== program) return end();
                if (texels) baked.set(light, texels);
                return (links = links.then(() => linkAhead(gl, programs)));
            };
            this.ended.signal.addEventListener('abort', end, { once: true });
            worker.postMessage({ module, caps, pack: program.HEAPU8.slice(at, at + bytes), wants: given, lit: this.lights.includes(this.chosen.light), done: [...baked.keys()] });
        }).catch(() => {}); // the package lies on another server, whose scripts may not be workers here
    }

    async arrive(source, shown, show, mine) {
        const program = (came) => { if (mine()) this.emit('progress', { taken: 0, all: 0, shows: 0, program: came }); };
        const [module, answer] = await Promise.all([compile(this.address, program), responseOf(source)]);
        if (!mine()) return;
        const arrival = await Arrival.begin(module, this.gl, this.caps);
        arrival.around = (call) => this.around(call);
        await receive(answer, async (bytes) => {
            if (mine() && arrival.push(bytes) > shown()) await show(arrival);
        }, (taken, all) => { if (mine()) this.emit('progress', { taken, all, shows: shown() }); }, this.ended.signal);
        if (!mine()) return;
        arrival.end();
        if (shown() < 2) await show(arrival);
    }

    // Switch to another program. first: the first one of a pack.
    use(program, first) {
        const time = this.program && !first ? this.time : 0;
        this.close();
        this.program = program;
        this.list();
        this.beginLight();
        program.open();
        if (first) this.begin();
        this.restoreChoices(first, time);
        this.speech.moved();
        this.loaded = true;
        this.resize();
        this.draw();
        program.check(program._web_check());
    }

    // Read the contents of the pack.
    list() {
        const p = this.program, names = (count, name) => Array.from({ length: count }, (_, i) => p.text(name(i)));
        this.lights = names(p._web_light_count(), p._web_light_name);
        this.emotions = [];
        for (let i = 0; p._web_emotion_name(i); i++) this.emotions.push(p.text(p._web_emotion_name(i)));
    }

    // Apply settings before the stage is created, so that it is created only once.
    beginLight() {
        const { light } = this.chosen;
        this.tellLighting();
        this.program.check(this.program._web_set_light(this.lights.indexOf(light)));
    }

    begin() {
        this.pixels.forget();
        this.weights.clear();
        this.playing = layers.map(() => ({ clip: null }));
        this.fallen = 0;
    }

    restoreChoices(first, time) {
        const p = this.program, c = this.chosen;
        this.targets = Array.from({ length: p._web_target_count() }, (_, i) => p.text(p._web_target_name(i)));
        this.clips = Array.from({ length: p._web_clip_count() }, (_, index) => ({ index, name: p.text(p._web_clip_name(index)), seconds: p._web_clip_seconds(index) }))
            .filter((clip) => clip.seconds >= 0);
        const box = p.floats(p._web_measure(), 6), across = p._web_facing() % 180 ? 2 : 0;
        p._web_set_spacing((box[across + 3] - box[across]) * 1.1);
        this.level = c.level;
        if (!c.transfer && p._web_has_transfer()) p.check(p._web_set_transfer(0));
        p._web_set_hair(c.hair ? 1 : 0, c.wind);
        p._web_set_wrinkles(c.wrinkles);
        p._web_set_calm(c.calm ? 1 : 0);
        this.tellSpeed();
        this.feel(c.emotion, c.amount);
        for (const [name, weight] of this.weights) this.setWeight(name, weight);
        this.playing.forEach(({ clip }, layer) => { if (clip !== null) this.play(clip, { layer: layers[layer], fade: 0, time: layer ? 0 : time }); });
        if (first || !this.camera.box) this.fit();
    }

    // ---- frames ----

    draw() {
        this.wanted = false;
        if (this.lost || !this.loaded) return;
        const now = performance.now(), passed = now - this.drawn, seconds = Math.min(passed, 100) / 1000;
        this.drawn = now;
        if (this.goesOn && passed < longest && this.spares && !this.size) this.pixels.tell(passed, now);
        this.resizeCanvas();
        try {
            this.advance(seconds);
        } catch (error) { // no caller waits for a frame
            this.loaded = false;
            explained(error).then(({ message }) => this.emit('fault', { message: String(message || error) }));
            return;
        }
        this.goesOn = this.moves(now);
        if (this.goesOn) this.redraw();
        else this.rest();
    }

    // Draw at full resolution once nothing moves.
    rest() {
        clearTimeout(this.resting);
        if (this.share === 1) return;
        this.resting = setTimeout(() => {
            if (this.wanted || this.goesOn || this.ended.signal.aborted) return;
            this.sharp = true;
            this.draw();
            this.sharp = false;
        }, restsAfter);
    }

    // Resolution of the next frame, as a share of the full width.
    get share() { return this.sharp || !this.spares || this.size ? 1 : this.pixels.share; }

    // Whether the resolution is reduced while the figure moves and frames are slow.
    get sparing() { return this.spares; }
    set sparing(on) {
        this.spares = on;
        this.pixels.forget();
        this.redraw();
    }

    // Advance time.
    step(seconds) {
        const p = this.program;
        this.speech.frame();
        p.check(p._web_step(seconds));
        for (let i = 0; i < p._web_key_count(); i++) this.tellKey(i);
        this.watchFall();
    }

    // Advance time and draw.
    advance(seconds) {
        const p = this.program;
        this.step(seconds);
        this.camera.write(p.floats(p._web_view(), 22), p.floats(p._web_walked(), 3), this.canvas.width / this.canvas.height, this.shownHeight());
        p.check(p._web_draw());
        this.frames++;
        this.emit('frame', { seconds });
    }

    tellKey(i) {
        const p = this.program;
        this.emit('key', { name: p.text(p._web_key_name(i)), clip: p.text(p._web_key_clip(i)), layer: layers[p._web_key_layer(i)], weight: p._web_key_weight(i),
            character: p._web_key_character(i) });
    }

    // Whether another frame must follow.
    moves(now) {
        const p = this.program, hair = p._web_has_hair() && this.chosen.hair && (this.chosen.wind > 0 || p._web_shakes());
        return !this.stopped && (this.runs || now < this.busy || p._web_fades() > 0 || this.lives || this.speech.speaks || this.fallen > 0 || hair);
    }

    get lives() { return (this.program._web_alive() > 0 || this.program._web_stands() > 0) && !this.chosen.calm; }
    get runs() { return this.playing.some(({ clip }) => clip !== null) && this.speed > 0 && !this.paused; }

    redraw() {
        this.due = this.frames + 1;
        if (!this.wanted && !this.ended.signal.aborted) requestAnimationFrame(() => this.draw());
        this.wanted = true;
    }

    // Poses are not updated in every frame, and calm faces still move on request.
    settle(ms = settles) {
        this.busy = Math.max(this.busy, performance.now() + ms);
        this.redraw();
    }

    resizeCanvas() {
        const { canvas, size } = this, scale = Math.min(window.devicePixelRatio || 1, mostPixels) * this.share;
        const [width, height] = size ? [size, size] : [canvas.clientWidth, canvas.clientHeight].map((n) => Math.max(1, Math.round(n * scale)));
        const changes = width !== canvas.width || height !== canvas.height;
        if (changes) Object.assign(canvas, { width, height });
        canvas.style.objectFit = size ? 'contain' : ''; // keeps the picture's proportions, centred
        return changes;
    }

    // The size of the picture on the page: with a `size` of its own, as much as fits.
    shownHeight() {
        const { canvas, size } = this, height = canvas.clientHeight || canvas.height;
        return size && canvas.clientWidth ? Math.min(height, canvas.clientWidth * canvas.height / canvas.width) : height;
    }

    resize() {
        if (this.resizeCanvas() && this.loaded) this.draw(); // immediately, because resizing clears a canvas
    }

    // ---- the camera ----

    // The position of the first character.
    get walked() { return Array.from(this.program.floats(this.program._web_walked(), 3)); }

    // Frame the figures as near as possible, in their present pose or in all poses of a running clip; with the view 'upper'
    // or 'face' that part of them, as `noh render --camera` does, and from their own front.
    fit() {
        const p = this.program, clip = this.runs && this.playing[0].clip !== null ? this.clipNamed(this.playing[0].clip) : null;
        const poses = clip ? Math.min(mostPoses, Math.max(4, Math.ceil(clip.seconds * posesASecond))) : 0;
        const still = Array.from(p.floats(p._web_measure(), 6)), face = Array.from(p.floats(p._web_measure_face(), 6));
        const all = clip ? Array.from(p.floats(p._web_measure_clip(clip.index, clip.seconds, poses), 6)) : still;
        this.camera.fit(this.view === 'full' ? all : framed(still, face, this.view, p._web_facing()), this.walked, all, p._web_facing());
        this.redraw();
    }

    home() { Object.assign(this.camera, front); this.fit(); }
    zoom(by) { this.camera.zoom(by); this.redraw(); }
    turn(azimuth, elevation) { this.camera.turn(azimuth, elevation); this.redraw(); }
    pan(x, y) { this.camera.pan(x, y); this.redraw(); }

    // ---- clips ----

    clipNamed(name) { return this.clips.find((clip) => clip.name === name); }

    // Play a clip by name, null: none. With a fade in seconds it starts from the shown pose; with 0 the body starts at
    // a time in seconds.
    play(name, { layer = 'body', fade = transition, time = 0 } = {}) {
        const clip = name === null ? null : this.clipNamed(name), at = Math.max(0, layers.indexOf(layer));
        if (clip === undefined) throw new Error(`the pack has no clip '${name}' that moves it`);
        this.playing[at].clip = name;
        this.program.check(this.program._web_play(at, clip ? clip.index : -1, time, fade));
        this.settle(1000 * fade + 100);
        if (at === 0 && clip && this.camera.box && !this.camera.byHand && !this.paused) this.fit(); // the clip may need more space
    }

    // The time of the body clip, in seconds.
    get time() { return this.program._web_time(); }
    set time(seconds) {
        const { byHand } = this.camera;
        this.camera.byHand = true; // the same clip needs no new framing
        this.play(this.playing[0].clip, { fade: 0, time: seconds });
        this.camera.byHand = byHand;
    }

    // 1: original speed.
    get speed() { return this.chosen.speed; }
    set speed(speed) {
        this.chosen.speed = speed;
        this.tellSpeed();
    }

    // Whether clips are paused.
    get paused() { return this.chosen.paused; }
    set paused(on) {
        if (this.paused === Boolean(on)) return;
        this.chosen.paused = Boolean(on);
        this.emit('pause', { paused: this.paused });
        this.tellSpeed();
    }

    tellSpeed() {
        if (!this.program) return;
        this.program._web_set_speed(this.paused ? 0 : this.speed);
        this.redraw();
    }

    // ---- targets ----

    targetNamed(name) {
        const at = this.targets.indexOf(name);
        if (at < 0) throw new Error(`the pack has no target '${name}'`);
        return at;
    }

    // Hold a target at a weight, whatever clip plays, until it is released.
    setWeight(name, weight) {
        this.program._web_hold(this.targetNamed(name), weight, 1);
        this.weights.set(name, weight);
        this.redraw();
    }

    releaseWeight(name) {
        this.program._web_hold(this.targetNamed(name), 0, 0);
        this.weights.delete(name);
        this.redraw();
    }

    releaseWeights() { for (const name of this.targets) this.releaseWeight(name); }

    // The weight in the last frame.
    weight(name) { return this.program._web_weight(this.targetNamed(name)); }

    // ---- light, levels, wrinkles, hair ----

    tellLighting() {
        const c = this.chosen;
        this.program._web_set_lighting(c.degrees, Math.max(0, shadows.indexOf(c.shadow)), c.tonemap ? 2 : 0, Math.max(0, backgrounds.indexOf(c.background)));
        this.program._web_set_floor(c.floor ? 1 : 0);
        this.program._web_set_background(...colorOf(c.background) || grey);
    }

    // { light, degrees, shadow, floor, tonemap, background, transfer }, or some of them. In a lost context, changes are
    // applied after it is restored.
    setLight(what) {
        const { transfer: before, light, shadow } = this.chosen;
        if (what.background !== undefined && !colorOf(what.background)) throw new Error(`the background '${what.background}' is none of ${backgrounds.join(', ')} or a CSS colour`);
        Object.assign(this.chosen, what);
        if (light !== this.chosen.light || shadow !== this.chosen.shadow) this.pixels.forget();
        if (!this.program) return;
        this.tellLighting();
        this.emit('light', { ...this.chosen });
        if (this.lost) return;
        this.program.check(this.program._web_set_light(this.lights.indexOf(this.chosen.light)));
        if (this.chosen.transfer !== before) this.program.check(this.program._web_set_transfer(this.chosen.transfer ? 1 : 0));
        this.redraw();
    }

    turnLight(degrees) {
        if (this.lights.includes(this.chosen.light)) this.setLight({ degrees: (this.chosen.degrees + degrees + 540) % 360 - 180 });
    }

    // -1: the coarsest level with an error of at most one pixel.
    get level() { return this.chosen.level; }
    set level(level) {
        this.chosen.level = level;
        if (!this.program) return;
        this.program._web_set_level(level < this.program._web_level_count() ? level : -1);
        this.redraw();
    }

    setWrinkles(amount) {
        this.chosen.wrinkles = amount;
        this.program._web_set_wrinkles(amount);
        this.redraw();
    }

    // wind: metres per second, from the right.
    setHair(shown, wind) {
        Object.assign(this.chosen, { hair: shown, wind });
        this.program._web_set_hair(shown ? 1 : 0, wind);
        this.settle(swings);
    }

    shake() {
        this.program._web_shake();
        this.settle(shakes);
    }

    // ---- the face ----

    // Whether the face blinks, breathes and looks around by itself.
    get alive() { return !this.chosen.calm; }
    set alive(on) {
        this.chosen.calm = !on;
        if (!this.program) return;
        this.program._web_set_calm(on ? 0 : 1);
        this.redraw();
    }

    pixelOf(x, y) {
        const { width, height } = this.canvas, r = this.canvas.getBoundingClientRect(), each = [width / r.width, height / r.height];
        if (this.size) each.fill(Math.max(...each));
        return [width / 2 + (x - r.left - r.width / 2) * each[0], height / 2 + (y - r.top - r.height / 2) * each[1]];
    }

    // Look at a point of the page, taken as a point in space before the figure.
    lookAt(x, y) {
        if (this.lost || !this.loaded) return;
        this.program._web_look(...this.pixelOf(x, y), 1);
        this.settle();
    }

    lookAhead() {
        if (!this.loaded) return;
        this.program._web_look(0, 0, 0);
        this.settle();
    }

    emotionNamed(name) {
        const at = this.emotions.indexOf(name);
        if (at < 0) throw new Error(`there is no emotion '${name}': ${this.emotions.join(', ')}`);
        return at;
    }

    // Set an emotion by name, null: none; replaces the previous one.
    feel(name, amount = 1) {
        const emotion = name === null ? -1 : this.emotionNamed(name);
        Object.assign(this.chosen, { emotion: name, amount });
        this.program._web_feel(emotion, amount);
        if (this.program._web_alive()) this.settle();
    }

    // Fifteen weights of mouth shapes, in the order of noh_viseme; null: silence.
    setMouth(weights) {
        this.speech.stop();
        this.speech.show(weights);
        this.redraw();
    }

    // ---- touch ----

    tap(x, y, pushes) {
        if (this.lost || !this.loaded) return;
        const p = this.program, at = this.pixelOf(x, y);
        if (pushes) {
            this.push(...at);
            return;
        }
        const names = p._web_pick(...at) ? [p.text(p._web_picked_mesh()), p.text(p._web_picked_joint())] : ['', ''];
        this.emit('pick', { mesh: names[0], joint: names[1], vertex: names[0] ? p._web_picked_vertex() : -1 });
    }

    // Push at a pixel of the canvas, or at the chest. A fallen figure gets up and continues its clip. Returns 0 or an
    // error message.
    push(x, y) {
        if (this.lost || !this.loaded) return '';
        const p = this.program, failed = x === undefined ? p._web_push(strength) : p._web_push_at(x, y, strength);
        this.emit('push', { error: failed ? p.words() : '' });
        this.redraw();
        return failed ? p.words() : '';
    }

    watchFall() {
        const before = this.fallen, { clip } = this.playing[0];
        this.fallen = this.program._web_fallen();
        if (before && !this.fallen && clip !== null) this.play(clip);
    }

    // ---- memory ----

    // In bytes: pack; stage: as planned, detailed in parts; block: the stage's block; all: the WebAssembly memory,
    // which cannot grow; gpu.
    get memory() {
        const p = this.program, byName = new Map();
        for (let i = 0; i < p._web_part_count(); i++) { // several skeletons in one row
            const name = p.text(p._web_part_name(i)), row = byName.get(name) || { name, cpu: 0, gpu: 0 };
            row.cpu += p._web_part_cpu_bytes(i);
            row.gpu += p._web_part_gpu_bytes(i);
            byName.set(name, row);
        }
        const parts = [...byName.values()], cpu = parts.reduce((all, part) => all + part.cpu, 0);
        return { cpu, gpu: p._web_gpu_bytes(), room: p._web_memory_room(), pack: p.packBytes, all: p.HEAPU8.length, parts };
    }

    // ---- the end ----

    close() {
        if (this.program && !this.lost) this.program._web_close();
        this.program = null;
        this.loaded = false;
    }

    // Releases the context and drops the memory. No call may follow.
    dispose() {
        if (this.ended.signal.aborted) return;
        this.speech.stop();
        this.ended.abort();
        this.resizes.disconnect();
        this.close();
        if (this.gl) forgetPrograms(this.gl);
        this.releaseContext();
        this.gl = this.caps = null;
    }

    releaseContext() {
        const loses = this.gl && this.gl.getExtension('WEBGL_lose_context');
        if (loses) loses.loseContext();
    }
}

// A source as a Response with a stream.
async function responseOf(source) {
    const given = await (source instanceof Promise ? reach(source, 'pack') : source);
    if (given instanceof Response) return given;
    if (given instanceof Blob) return new Response(given.stream(), { headers: { 'Content-Length': given.size } });
    if (given instanceof ArrayBuffer || ArrayBuffer.isView(given)) return new Response(given, { headers: { 'Content-Length': given.byteLength } });
    return fetchFirst(given);
}
