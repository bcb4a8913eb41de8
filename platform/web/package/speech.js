// speech.js: speech from the microphone, sounds, or sentences that the browser speaks. The first two go through the
// library's ear (sound.c), unless their visemes are given. For a sentence, a browser reports only the starts of words, so
// the mouth roughly follows the letters; without a voice it does so in silence.

import { reach } from './reach.js';

const earRates = [8000, 48000]; // Hz
const liveLatency = 40, fileLatency = 80; // ms; more misses fewer closures
const ticksPerMs = 48;
export const shapeCount = 15;
const silent = { open: 0, shapes: null };
const voicesMs = 1000, startMs = 3000; // to wait for the browser's voices, and for a voice to begin
const soundDelay = 0.05; // seconds from a media element to its sound: the ear's latency and a picture
const media = new WeakMap(); // nodes by media element, which can have only one

const micErrors = {
    NotAllowedError: 'The microphone is refused. Allow it for this page in the browser, then press the button again.',
    NotFoundError: 'There is no microphone here. Connect one, or open a sound file.',
    NotReadableError: 'The microphone does not answer: another program may have it.',
};
const speechErrors = {
    'not-allowed': 'The browser refuses to speak: press the button again.',
    'voice-unavailable': 'The browser has no voice for this.',
    'language-unavailable': 'The browser has no voice for this language.',
};

// ---- a sentence ----

// Shapes by letters, the longest first: a rough fit for Latin scripts. Numbers are noh_viseme; 0 is silence.
const letters = { th: 3, sch: 6, ch: 6, sh: 6, ph: 2, ck: 5, ng: 5, qu: 5, oo: 14, ou: 14, ee: 12, ea: 12, ow: 13, oa: 13,
    p: 1, b: 1, m: 1, f: 2, v: 2, t: 4, d: 4, k: 5, g: 5, c: 5, q: 5, x: 5, j: 6, s: 7, z: 7, n: 8, l: 8, r: 9,
    a: 10, h: 10, e: 11, i: 12, y: 12, o: 13, u: 14, w: 14 };
const vowelMs = 95, consonantMs = 65, pauseMs = 60, stopMs = 280;

// [{ at, ms, shape }]: the position in the text and the duration of each letter or group.
export function shapesOfText(words, rate) {
    const plain = words.normalize('NFD').replace(/[\u0300-\u036f]/g, '').toLowerCase(), out = [];
    // a text that changes its length when decomposed is kept unchanged, so that positions agree with the browser's
    const line = plain.length === words.length ? plain : words.toLowerCase();
    for (let at = 0; at < line.length;) {
        const group = [3, 2, 1].map((n) => line.substr(at, n)).find((part) => letters[part] !== undefined) || line[at];
        const shape = letters[group] || (/\p{L}|\p{N}/u.test(group) ? 11 : 0); // other scripts only open and shut the mouth
        const long = shape ? (shape > 9 ? vowelMs : consonantMs) : /[.,;:!?]/.test(group) ? stopMs : pauseMs;
        out.push({ at, ms: long / rate, shape });
        at += group.length;
    }
    return out;
}

// The ear's tables, fetched when something is first heard.
let earTables = null;
function fetchEar() {
    const address = new URL('./ear.bin', import.meta.url);
    if (!earTables) {
        earTables = reach(fetch(address), 'ear', address).then(async (answer) => {
            if (!answer.ok) throw new Error(`no ear: ${address}: the server says ${answer.status}`);
            return (earTables.bytes = new Uint8Array(await answer.arrayBuffer()));
        });
        earTables.catch(() => { earTables = null; }); // the next call tries again
    }
    return earTables;
}

// Mix the channels of a decoded sound into one.
function mixed(buffer) {
    const sum = new Float32Array(buffer.length);
    for (let c = 0; c < buffer.numberOfChannels; c++) {
        buffer.getChannelData(c).forEach((sample, i) => { sum[i] += sample / buffer.numberOfChannels; });
    }
    return sum;
}

// Whether the browser has voices. Some list them only some time after a first request: they are waited for once.
let voicesCome = null;
async function hasVoices() {
    const voices = window.speechSynthesis, some = () => Boolean(voices) && voices.getVoices().length > 0;
    if (!voices || some()) return some();
    voicesCome = voicesCome || new Promise((resolve) => {
        if (voices.addEventListener) voices.addEventListener('voiceschanged', resolve, { once: true });
        setTimeout(resolve, voicesMs);
    });
    await voicesCome;
    return some();
}

// [{ word, at, ms }] of a text, by the times of its letters.
function wordsOf(text, shapes, times) {
    return [...text.matchAll(/\S+/g)].map(({ 0: word, index: at }) => ({ word, at, ms: times[shapes.findIndex((s) => s.at >= at)] ?? Infinity }));
}

// The speech of a character. Messages for the user are sent as the character's event "speech"; what is said as events
// "caption" and "word".
export class Speech {
    constructor(character) {
        Object.assign(this, { character, speaker: null, newest: 0, queue: [], job: null }); // newest counts speakers, so that a late one is ignored
        this.now = { open: 0, source: '' };
    }

    get program() { return this.character.program; }
    get speaks() { return this.speaker !== null; }
    tell(words) { this.character.emit('speech', { words, speaks: this.speaks, source: this.now.source }); }

    // ---- one after another ----

    // what: a sentence, a sound (Blob, URL, ArrayBuffer, AudioBuffer), a MediaStream, an <audio> or <video>, or an async
    // iterable of Float32Array, samples at `rate`. options: { visemes: [{ viseme, ms }] of a sound, starts; words: [{ word, ms
    // }]; mood: an emotion meanwhile; rate; interrupt: at once, instead of after what is said now }. Resolves to whether
    // all of it was said.
    speak(what, options = {}) {
        if (options.mood) this.character.emotionNamed(options.mood);
        if (options.interrupt) this.stop();
        return new Promise((resolve) => {
            this.queue.push({ what, options, resolve });
            if (!this.job) this.next();
        });
    }

    async next() {
        const job = this.job = this.queue.shift() || null;
        if (!job) return;
        if (this.speaker) this.speaker.stop(); // the microphone
        this.speaker = null;
        const { what, options } = job, { emotion, amount } = this.character.chosen, number = ++this.newest;
        if (options.mood) {
            this.character.feel(options.mood);
            job.calm = () => this.character.feel(emotion, amount);
        }
        try {
            await this.begin(what, options, () => number === this.newest);
        } catch (error) {
            if (number !== this.newest) return;
            this.end(false);
            this.tell(String(error.message || error));
        }
    }

    begin(what, options, mine) {
        const { AudioBuffer, MediaStream, HTMLMediaElement } = window;
        if (typeof what === 'string') return this.say(what, options, mine);
        if (MediaStream && what instanceof MediaStream) return this.hearStream(what, options, mine);
        if (HTMLMediaElement && what instanceof HTMLMediaElement) return this.hearMedia(what, options, mine);
        if (what[Symbol.asyncIterator]) return this.playChunks(what, options, mine);
        return this.play(what, options, mine, AudioBuffer && what instanceof AudioBuffer ? what : null);
    }

    // The present speaker ends; the next one follows.
    end(said) {
        const was = this.speaker, { job } = this;
        this.newest++;
        this.speaker = this.job = null;
        this.now = { open: 0, source: '' };
        if (was) was.stop();
        if (job && job.calm) job.calm();
        if (job) job.resolve(said);
        if (job) this.character.emit('caption', { words: '', silent: false });
        if (!this.program) return;
        this.show(null);
        this.program._web_set_talking(0);
        this.character.settle();
        if (was) this.tell('');
        if (!this.job) this.next();
    }

    // Ends the present speaker and forgets those that wait.
    stop() {
        for (const { resolve } of this.queue.splice(0)) resolve(false);
        this.end(false);
    }

    // Before each step of the stage.
    frame() {
        if (!this.speaker) return;
        const frame = this.speaker.frame(performance.now());
        if (!frame) {
            this.end(true);
            return;
        }
        this.now.open = frame.open;
        this.show(frame.shapes);
    }

    // Fifteen weights, or null: silence.
    show(shapes) {
        if (shapes) this.program.floats(this.program._web_shapes(), shapeCount).set(shapes);
        this.program._web_show_shapes(shapes ? 1 : 0);
    }

    // which: { stop(), frame(now) }; frame returns { open, shapes }, or null at the end; moved: in another program.
    speakBy(source, which) {
        this.speaker = which;
        this.now.source = source;
        this.program._web_set_talking(1);
        this.character.redraw();
    }

    // ---- the ear ----

    // After fetchEar.
    openEar(rate, latency) {
        if (rate < earRates[0] || rate > earRates[1]) throw new Error(`sound of ${rate} Hz: the ear takes ${earRates.join(' to ')}`);
        if (earTables.bytes.length !== this.program._web_ear_tables_bytes()) throw new Error('ear.bin is of another version than the program: put the files of one package together');
        this.program.HEAPU8.set(earTables.bytes, this.program._web_ear_tables());
        this.rate = rate;
        this.program.check(this.program._web_ear_open(rate, latency));
    }

    // Continue with another program of the character.
    moved() {
        if (!this.speaker) return;
        if (this.speaker.moved) this.speaker.moved();
        this.program._web_set_talking(1);
    }

    // Samples, -1..1, to frames.
    hear(samples) {
        const { program } = this, room = program._web_ear_room(), frames = [];
        for (let at = 0; at < samples.length; at += room) {
            const part = samples.subarray(at, at + room);
            program.floats(program._web_ear_samples(), part.length).set(part);
            const made = program._web_ear_hear(part.length);
            for (let i = 0; i < made; i++) {
                frames.push({ open: program._web_ear_open_by(i), shapes: program.floats(program._web_ear_shapes(i), shapeCount).slice() });
            }
        }
        return frames;
    }

    // The microphone, until stop().
    async listen() {
        this.stop();
        this.tell('Waiting for the microphone\u2026');
        const number = this.newest;
        try {
            await this.openMicrophone(number);
        } catch (error) {
            if (number !== this.newest) return;
            this.stop();
            this.tell(micErrors[error.name] || `The microphone cannot be used: ${error.message}`);
        }
    }

    async openMicrophone(number) {
        if (!navigator.mediaDevices || !window.AudioWorkletNode) throw new Error('The microphone works on https:// and on localhost only, in a browser with AudioWorklet.');
        const stream = await navigator.mediaDevices.getUserMedia({ audio: { channelCount: 1, echoCancellation: false } });
        const close = () => { for (const track of stream.getTracks()) track.stop(); };
        if (number !== this.newest) close();
        else await this.hearStream(stream, { source: 'microphone', close }, () => number === this.newest);
    }

    // Sounds of a stream, which are not played.
    async hearStream(stream, { source = 'stream', close = () => {} }, mine) {
        const context = this.contextForEar(), stop = () => { close(); context.close(); };
        try {
            const node = await this.earNode(context, mine);
            if (!node) return stop();
            const track = stream.getAudioTracks()[0];
            this.listenTo(node, source, track, stop);
            context.createMediaStreamSource(stream).connect(node);
            return await context.resume();
        } catch (error) {
            stop();
            throw error;
        }
    }

    // An <audio> or <video>: whenever it plays, until its end or until stop().
    async hearMedia(element, options, mine) {
        if (!media.has(element)) {
            const context = this.contextForEar(), source = context.createMediaElementSource(element), delay = context.createDelay();
            delay.delayTime.value = soundDelay;
            source.connect(delay).connect(context.destination);
            media.set(element, { context, source });
        }
        const { context, source } = media.get(element), node = await this.earNode(context, mine);
        if (!node) return;
        this.listenTo(node, 'media', element, () => source.disconnect(node));
        source.connect(node);
        await context.resume();
    }

    // At its own rate, unless it is above the ear's limit.
    contextForEar() {
        const context = new AudioContext();
        if (context.sampleRate <= earRates[1]) return context;
        context.close();
        return new AudioContext({ sampleRate: earRates[1] });
    }

    async earNode(context, mine) {
        await fetchEar();
        await context.audioWorklet.addModule(new URL('./microphone.js?no-inline', import.meta.url)); // a file in Vite, too: policies refuse data:
        return mine() ? new AudioWorkletNode(context, 'microphone', { numberOfOutputs: 0 }) : null;
    }

    // from: a track or an element, which tells its end.
    listenTo(node, source, from, stop) {
        const mine = () => this.speaker && this.speaker.node === node, rate = node.context.sampleRate;
        let frame = silent;
        this.openEar(rate, liveLatency);
        node.port.onmessage = ({ data }) => { if (mine()) frame = this.hear(data).pop() || frame; };
        from.addEventListener('ended', () => {
            if (!mine()) return;
            this.end(true);
            if (source === 'microphone') this.tell('The microphone is gone.');
        }, { once: true });
        this.speakBy(source, { stop, node, moved: () => this.openEar(rate, liveLatency), frame: () => frame });
        const { latency } = from.getSettings ? from.getSettings() : {}, device = latency ? `, ${Math.round(latency * 1000)} by the microphone` : '';
        this.tell(`Listening. The mouth is ${liveLatency} ms late by the ear, 10 by the page${device}, and a picture. Nothing is kept.`);
    }

    // ---- sounds ----

    // A sound file, an address, or a decoded sound.
    async play(what, options, mine, decoded) {
        const context = new AudioContext(), rate = Math.min(earRates[1], context.sampleRate);
        try {
            const buffer = decoded || await soundOf(what, rate);
            if (!options.visemes || !options.visemes.length) await fetchEar();
            if (!mine()) context.close();
            else await this.playBuffer(context, buffer, what.name || (options.text ? 'the voice' : 'the sound'), options);
        } catch (error) {
            context.close();
            throw error;
        }
    }

    // Frames of a whole sound. It is heard twice, so that the ear knows the voice from its beginning, then silence, after
    // which the last frames are known.
    framesOf(buffer) {
        const samples = mixed(buffer), silence = new Float32Array(Math.ceil(buffer.sampleRate * fileLatency / 1000));
        this.openEar(buffer.sampleRate, fileLatency);
        this.hear(samples);
        this.program._web_ear_restart();
        return [...this.hear(samples), ...this.hear(silence)];
    }

    async playBuffer(context, buffer, name, { visemes, words, text }) {
        const node = context.createBufferSource(), given = () => this.writePhones(visemes.map(({ viseme, ms }, i) =>
            ({ shape: viseme, ms: (visemes[i + 1] ? visemes[i + 1].ms : 1000 * buffer.duration) - ms })), visemes[0].ms);
        const frames = visemes && visemes.length ? null : this.framesOf(buffer);
        if (!frames) given();
        node.buffer = buffer;
        node.connect(context.destination);
        await context.resume();
        const start = context.currentTime + 0.05, left = [...words || []];
        node.start(start);
        const at = () => context.currentTime - (context.outputLatency || 0) - start;
        this.caption(text || left.map(({ word }) => word).join(' '));
        this.speakBy('file', {
            stop: () => context.close(), moved: frames ? null : given,
            frame: () => {
                const ms = 1000 * at();
                this.passWords(left, ms);
                if (ms > 1000 * buffer.duration) return null;
                return frames ? frames[Math.round((ms - 12.5) / 10)] || silent : this.frameAt(ms);
            },
        });
        this.now.frames = frames;
        this.tell(frames ? `${name}, ${buffer.duration.toFixed(1)} s. The live ear drives the mouth, without its latency.` : `${name}, ${buffer.duration.toFixed(1)} s.`);
    }

    // Samples as they come, each piece played after the one before.
    async playChunks(chunks, { rate = 24000, words, text }, mine) {
        await fetchEar();
        if (!mine()) return;
        const context = new AudioContext(), frames = [], left = [...words || []];
        let start = 0, seconds = 0, whole = false;
        this.openEar(rate, liveLatency);
        const at = () => (start ? context.currentTime - (context.outputLatency || 0) - start : -1);
        this.caption(text || left.map(({ word }) => word).join(' '));
        this.speakBy('chunks', {
            stop: () => context.close(), moved: () => this.openEar(rate, liveLatency),
            frame: () => {
                this.passWords(left, 1000 * at());
                return whole && at() > seconds ? null : frames[Math.round((1000 * at() - 12.5) / 10)] || silent;
            },
        });
        await context.resume();
        for await (const samples of chunks) {
            if (!mine()) return;
            const buffer = context.createBuffer(1, samples.length, rate), node = context.createBufferSource();
            frames.push(...this.hear(samples));
            buffer.copyToChannel(samples, 0);
            Object.assign(node, { buffer }).connect(context.destination);
            start = Math.max(start, context.currentTime + 0.05 - seconds); // moves if pieces come late
            node.start(start + seconds);
            seconds += buffer.duration;
        }
        whole = true;
    }

    // ---- what is said ----

    caption(words, silent = false) {
        if (words) this.character.emit('caption', { words, silent });
    }

    // Emits the words whose time has come. left: those that are left.
    passWords(left, ms) {
        while (left.length && left[0].ms <= ms) {
            const { word, at = -1 } = left.shift();
            this.character.emit('word', { word, at });
        }
    }

    // ---- a sentence that the browser speaks ----

    // Phones for the library: start in ticks, shape. Returns the start of each in ms.
    writePhones(shapes, from = 0) {
        const { program } = this, room = Math.min(shapes.length, program._web_phone_room());
        const at = program._web_phones() >> 2, phones = program.HEAPU32.subarray(at, at + 2 * room), times = [];
        let ms = from;
        for (let i = 0; i < room; i++) {
            times.push(ms);
            phones.set([ms * ticksPerMs, shapes[i].shape], 2 * i);
            ms += shapes[i].ms;
        }
        program.check(program._web_speak(room, ms * ticksPerMs));
        return { times, end: ms };
    }

    shapesAt(ms) {
        this.program._web_speak_at(ms * ticksPerMs);
        return this.program.floats(this.program._web_shapes(), shapeCount).slice();
    }

    frameAt(ms) {
        const said = this.shapesAt(ms);
        return { open: 1 - said[0] - said[1], shapes: said };
    }

    // By a voice of the program: sound as for speak, or { sound, visemes, words, rate } with times. Returns whether it does.
    async sayBy(voice, text, options, mine) {
        const made = await Promise.resolve().then(() => voice(text)).catch((error) => { console.warn('noh-character: the voice fails:', error); });
        if (!mine()) return true;
        if (!made || typeof made === 'string') return false;
        const { sound, ...times } = made.sound ? made : { sound: made };
        await this.begin(sound, { ...options, ...times, text }, mine);
        return true;
    }

    async say(text, options, mine) {
        const { words } = options, { voice } = this.character;
        if (voice && await this.sayBy(voice, text, options, mine)) return;
        const aloud = await hasVoices();
        if (!mine()) return;
        const shapes = shapesOfText(text, 1), { times, end } = this.writePhones(shapes), left = words ? [...words] : wordsOf(text, shapes, times);
        let began = 0, quiet = !aloud, told = false, waits = 0;
        const start = () => {
            clearTimeout(waits);
            if (!began && mine()) this.caption(text, quiet);
            began = began || performance.now();
            this.character.redraw();
        };
        const quietly = () => {
            quiet = true;
            if (aloud) window.speechSynthesis.cancel();
            start();
            this.tell('This browser has no voice: the words are shown while the face says them.');
        };
        this.speakBy('text', {
            stop: () => { clearTimeout(waits); if (aloud) window.speechSynthesis.cancel(); },
            moved: () => this.writePhones(shapes),
            // silence between the estimated end and the browser's end event
            frame: (now) => {
                const ms = began ? now - began : -1;
                this.passWords(left, ms);
                if (quiet && ms >= end + stopMs) return null;
                return ms >= 0 && ms < end ? this.frameAt(ms) : silent;
            },
        });
        if (!aloud) return quietly();
        const utterance = new SpeechSynthesisUtterance(text);
        utterance.onstart = start;
        // A word begins: continue with its first letter.
        utterance.onboundary = ({ charIndex }) => {
            const i = shapes.findIndex((s) => s.at >= charIndex);
            if (i >= 0 && i < times.length) began = performance.now() - times[i];
            if (!told && mine()) this.tell('The browser speaks, and tells only where words begin: in between the mouth follows letters, roughly.');
            told = true;
        };
        utterance.onend = () => { if (mine() && !quiet) this.end(true); };
        utterance.onerror = ({ error }) => {
            if (!mine() || quiet || error === 'canceled' || error === 'interrupted') return;
            this.end(false);
            this.tell(speechErrors[error] || `The browser cannot say it: ${error}`);
        };
        this.tell('The browser speaks. Without times of its words the mouth follows letters, roughly.');
        waits = setTimeout(() => { if (mine()) quietly(); }, startMs);
        window.speechSynthesis.speak(utterance);
    }
}

async function soundOf(what, rate) {
    const file = what instanceof URL ? await reach(fetch(what), 'sound', what).then((answer) => {
        if (!answer.ok) throw new Error(`no sound: ${what}: the server says ${answer.status}`);
        return answer;
    }) : what;
    return new OfflineAudioContext(1, 1, rate).decodeAudioData(file.arrayBuffer ? await file.arrayBuffer() : file)
        .catch(() => { throw new Error(`${what.name || 'the sound'}: this browser cannot decode it as sound`); });
}
