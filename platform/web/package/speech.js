// speech.js: speech from the microphone, a sound file, or a sentence that the browser speaks. The first two go through
// the library's ear (sound.c). For a sentence, a browser reports only the starts of words, so the mouth roughly follows
// the letters.

const earRates = [8000, 48000]; // Hz
const ticksPerMs = 48;
export const shapeCount = 15;
const silent = { open: 0, shapes: null };

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

// Mix the channels of a decoded sound into one.
function mixed(buffer) {
    const sum = new Float32Array(buffer.length);
    for (let c = 0; c < buffer.numberOfChannels; c++) {
        buffer.getChannelData(c).forEach((sample, i) => { sum[i] += sample / buffer.numberOfChannels; });
    }
    return sum;
}

// The speech of a character. Messages for the user are sent as the character's event "speech".
export class Speech {
    constructor(character) {
        Object.assign(this, { character, speaker: null, newest: 0 }); // newest counts speakers, so that a late one is ignored
        this.now = { open: 0, source: '' };
    }

    get program() { return this.character.program; }
    get speaks() { return this.speaker !== null; }
    tell(words) { this.character.emit('speech', { words, speaks: this.speaks, source: this.now.source }); }

    // Before each step of the stage.
    frame() {
        if (!this.speaker) return;
        const frame = this.speaker.frame(performance.now());
        if (!frame) {
            this.stop();
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

    stop() {
        const was = this.speaker;
        this.newest++;
        this.speaker = null;
        this.now = { open: 0, source: '' };
        if (was) was.stop();
        if (!this.program) return;
        this.show(null);
        this.program._web_set_talking(0);
        this.character.settle();
        if (was) this.tell('');
    }

    // which: { stop(), frame(now) }; frame returns { open, shapes }, or null at the end.
    speakBy(source, which) {
        this.speaker = which;
        this.now.source = source;
        this.program._web_set_talking(1);
        this.character.redraw();
    }

    // ---- the ear ----

    openEar(rate) {
        if (rate < earRates[0] || rate > earRates[1]) throw new Error(`sound of ${rate} Hz: the ear takes ${earRates.join(' to ')}`);
        this.rate = rate;
        this.program.check(this.program._web_ear_open(rate));
    }

    // Continue with another program of the character.
    moved() {
        if (!this.speaker) return;
        if (this.now.source === 'microphone') this.openEar(this.rate);
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
        if (number !== this.newest) {
            close();
            return;
        }
        const context = new AudioContext(); // at its own rate, unless it is above the ear's limit
        const slower = context.sampleRate > earRates[1] ? new AudioContext({ sampleRate: earRates[1] }) : context;
        if (slower !== context) context.close();
        const stop = () => { close(); slower.close(); };
        try {
            await slower.audioWorklet.addModule(new URL('./microphone.js?no-inline', import.meta.url)); // a file in Vite, too: policies refuse data:
            if (number !== this.newest) stop();
            else this.listenTo(slower, stream, stop);
        } catch (error) {
            stop();
            throw error;
        }
    }

    listenTo(context, stream, stop) {
        const node = new AudioWorkletNode(context, 'microphone', { numberOfOutputs: 0 });
        const track = stream.getAudioTracks()[0], settings = track.getSettings ? track.getSettings() : {};
        const mine = () => this.speaker && this.speaker.node === node;
        let frame = silent;
        this.openEar(context.sampleRate);
        node.port.onmessage = ({ data }) => {
            const frames = mine() ? this.hear(data) : [];
            if (!frames.length) return;
            frame = frames[frames.length - 1];
            this.character.redraw();
        };
        track.addEventListener('ended', () => { if (mine()) { this.stop(); this.tell('The microphone is gone.'); } });
        context.createMediaStreamSource(stream).connect(node);
        this.speakBy('microphone', { node, stop, frame: () => frame });
        const device = settings.latency ? `, ${Math.round(settings.latency * 1000)} by the microphone` : '';
        this.tell(`Listening. The mouth is ${this.program._web_ear_latency()} ms late by the ear, 10 by the page${device}, and a picture. Nothing is kept.`);
    }

    // A sound file. It is heard completely before it plays, so that the mouth has no latency, and twice, as in `noh
    // speak`, so that the ear adapts to the speaker and the room.
    async play(file) {
        this.stop();
        const number = this.newest, context = new AudioContext(), rate = Math.min(context.sampleRate, earRates[1]);
        try {
            const bytes = await file.arrayBuffer(), name = file.name || 'the sound';
            const buffer = await new OfflineAudioContext(1, 1, rate).decodeAudioData(bytes)
                .catch(() => { throw new Error(`${name}: this browser cannot decode it as sound`); });
            if (number !== this.newest) context.close();
            else await this.playBuffer(context, buffer, name, rate);
        } catch (error) {
            context.close();
            if (number === this.newest) this.tell(String(error.message || error));
        }
    }

    async playBuffer(context, buffer, name, rate) {
        const samples = mixed(buffer), node = context.createBufferSource();
        this.openEar(rate);
        this.hear(samples);
        this.program._web_ear_restart();
        const frames = this.hear(samples);
        node.buffer = buffer;
        node.connect(context.destination);
        await context.resume();
        const start = context.currentTime + 0.05;
        node.start(start);
        const at = () => context.currentTime - (context.outputLatency || 0) - start;
        this.speakBy('file', {
            stop: () => context.close(),
            frame: () => (at() > buffer.duration ? null : frames[Math.round((at() * 1000 - 12.5) / 10)] || silent),
        });
        this.now.frames = frames;
        this.tell(`${name}, ${buffer.duration.toFixed(1)} s. The mouth is that of the live ear, without its ${this.program._web_ear_latency()} ms.`);
    }

    // ---- a sentence that the browser speaks ----

    // Phones for the library: start in ticks, shape. Returns the start of each in ms.
    writePhones(shapes) {
        const { program } = this, room = Math.min(shapes.length, program._web_phone_room());
        const at = program._web_phones() >> 2, phones = program.HEAPU32.subarray(at, at + 2 * room), times = [];
        let ms = 0;
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

    say(words) {
        this.stop();
        if (!window.speechSynthesis || !window.speechSynthesis.getVoices().length) {
            this.tell('This browser has no voices. Use the microphone or a sound file; `noh speak` makes clips of sentences.');
            return;
        }
        const number = this.newest, mine = () => number === this.newest;
        const shapes = shapesOfText(words, 1), utterance = new SpeechSynthesisUtterance(words), { times, end } = this.writePhones(shapes);
        let began = 0, told = false;
        utterance.onstart = () => {
            began = performance.now();
            this.character.redraw();
        };
        // A word begins: continue with its first letter.
        utterance.onboundary = ({ charIndex }) => {
            const i = shapes.findIndex((s) => s.at >= charIndex);
            if (i >= 0 && i < times.length) began = performance.now() - times[i];
            if (!told && mine()) this.tell('The browser speaks, and tells only where words begin: in between the mouth follows letters, roughly.');
            told = true;
        };
        utterance.onend = () => { if (mine()) this.stop(); };
        utterance.onerror = ({ error }) => {
            if (!mine() || error === 'canceled' || error === 'interrupted') return;
            this.stop();
            this.tell(speechErrors[error] || `The browser cannot say it: ${error}`);
        };
        this.speakBy('text', {
            stop: () => window.speechSynthesis.cancel(),
            // silence between the estimated end and the browser's end event
            frame: (now) => {
                const ms = began ? now - began : -1, said = ms >= 0 && ms < end ? this.shapesAt(ms) : null;
                return { open: said ? 1 - said[0] - said[1] : 0, shapes: said };
            },
        });
        this.tell('The browser speaks. Without times of its words the mouth follows letters, roughly.');
        window.speechSynthesis.speak(utterance);
    }
}
