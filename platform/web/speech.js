// speech.js: what the faces say: what the microphone hears, a sound file, or a typed sentence that the browser speaks.
// The first two go through the library's ear (sound.c). A browser tells of a sentence only where its words begin: the
// mouth then follows the letters, roughly.
'use strict';

const earRates = [8000, 48000]; // Hz
const ticksPerMs = 48;
const shapeCount = 15;
const silent = { open: 0, shapes: null };

// What speaks now: { stop(), frame(now) } of which frame gives { open, shapes: [15] }, or null at its end.
let speaker = null;
let newest = 0; // counts speakers, so that one which is late is not heard any more

const isSpeaking = () => speaker !== null;
const said = (words) => { byId('speech-text').textContent = words; };
const latency = () => Module._web_ear_latency();

window.noh.said = { open: 0, source: '' }; // tests look here

// Before each step of the stage.
function showSpeech() {
    if (!speaker) return;
    const frame = speaker.frame(performance.now());
    if (!frame) return stopSpeech();
    window.noh.said.open = frame.open;
    if (frame.shapes) floats(Module._web_shapes(), shapeCount).set(frame.shapes);
    Module._web_show_shapes(frame.shapes ? 1 : 0);
    return undefined;
}

function stopSpeech() {
    const was = speaker;
    newest++;
    speaker = null;
    if (was) was.stop();
    byId('listen').setAttribute('aria-pressed', 'false');
    byId('listen').textContent = 'microphone';
    Module._web_show_shapes(0);
    Module._web_set_talking(0);
    window.noh.said = { open: 0, source: '' };
    settle();
}

function speakBy(source, which) {
    speaker = which;
    window.noh.said.source = source;
    Module._web_set_talking(1);
    redraw();
}

// ---- the ear ----

function openEar(rate) {
    if (rate < earRates[0] || rate > earRates[1]) throw new Error(`sound of ${rate} Hz: the ear takes ${earRates.join(' to ')}`);
    check(Module._web_ear_open(rate));
}

// Samples, -1..1, to frames.
function hear(samples) {
    const room = Module._web_ear_room(), frames = [];
    for (let at = 0; at < samples.length; at += room) {
        const part = samples.subarray(at, at + room);
        floats(Module._web_ear_samples(), part.length).set(part);
        const made = Module._web_ear_hear(part.length);
        for (let i = 0; i < made; i++) {
            frames.push({ open: Module._web_ear_open_by(i), shapes: floats(Module._web_ear_shapes(i), shapeCount).slice() });
        }
    }
    return frames;
}

// ---- the microphone ----

const micErrors = {
    NotAllowedError: 'The microphone is refused. Allow it for this page in the browser, then press the button again.',
    NotFoundError: 'There is no microphone here. Connect one, or open a sound file.',
    NotReadableError: 'The microphone does not answer: another program may have it.',
};

async function openMicrophone(number) {
    if (!navigator.mediaDevices || !window.AudioWorkletNode) throw new Error('The microphone works on https:// and on localhost only, in a browser with AudioWorklet.');
    const stream = await navigator.mediaDevices.getUserMedia({ audio: { channelCount: 1, echoCancellation: false } });
    const close = () => { for (const track of stream.getTracks()) track.stop(); };
    if (number !== newest) return close();
    const context = new AudioContext(); // as it is, unless it is faster than the ear
    const slower = context.sampleRate > earRates[1] ? new AudioContext({ sampleRate: earRates[1] }) : context;
    if (slower !== context) context.close();
    const stop = () => { close(); slower.close(); };
    try {
        await slower.audioWorklet.addModule('microphone.js');
        if (number !== newest) return stop();
        listenTo(slower, stream, stop);
    } catch (error) {
        stop();
        throw error;
    }
    return undefined;
}

function listenTo(context, stream, stop) {
    const node = new AudioWorkletNode(context, 'microphone', { numberOfOutputs: 0 });
    const track = stream.getAudioTracks()[0], settings = track.getSettings ? track.getSettings() : {};
    let frame = silent;
    openEar(context.sampleRate);
    node.port.onmessage = ({ data }) => {
        const frames = speaker && speaker.node === node ? hear(data) : [];
        if (!frames.length) return;
        frame = frames[frames.length - 1];
        redraw();
    };
    track.addEventListener('ended', () => { if (speaker && speaker.node === node) { stopSpeech(); said('The microphone is gone.'); } });
    context.createMediaStreamSource(stream).connect(node);
    byId('listen').textContent = 'stop listening';
    byId('listen').setAttribute('aria-pressed', 'true');
    speakBy('microphone', { node, stop, frame: () => frame });
    const device = settings.latency ? `, ${Math.round(settings.latency * 1000)} by the microphone` : '';
    said(`Listening. The mouth is ${latency()} ms late by the ear, 10 by the page${device}, and a picture. Nothing is kept.`);
}

byId('listen').addEventListener('click', async () => {
    const on = byId('listen').getAttribute('aria-pressed') === 'true';
    stopSpeech();
    if (on) return said('');
    said('Waiting for the microphone\u2026');
    const number = newest;
    try {
        await openMicrophone(number);
    } catch (error) {
        if (number !== newest) return undefined;
        stopSpeech();
        said(micErrors[error.name] || `The microphone cannot be used: ${error.message}`);
    }
    return undefined;
});

// ---- a sound file ----

function mixed(buffer) {
    const sum = new Float32Array(buffer.length);
    for (let c = 0; c < buffer.numberOfChannels; c++) {
        buffer.getChannelData(c).forEach((sample, i) => { sum[i] += sample / buffer.numberOfChannels; });
    }
    return sum;
}

// The whole file is heard first, so that its mouth is not late: twice, as `noh speak` does, so that the ear knows the
// speaker and the room.
async function playFile(file, number) {
    const context = new AudioContext();
    const rate = Math.min(context.sampleRate, earRates[1]);
    try {
        const bytes = await file.arrayBuffer();
        const decoder = new OfflineAudioContext(1, 1, rate);
        const buffer = await decoder.decodeAudioData(bytes).catch(() => { throw new Error(`${file.name}: this browser cannot decode it as sound`); });
        if (number !== newest) return context.close();
        openEar(rate);
        const samples = mixed(buffer), node = context.createBufferSource();
        hear(samples);
        Module._web_ear_restart();
        const frames = hear(samples);
        node.buffer = buffer;
        node.connect(context.destination);
        await context.resume();
        const start = context.currentTime + 0.05;
        node.start(start);
        const at = () => context.currentTime - (context.outputLatency || 0) - start;
        speakBy('file', {
            stop: () => context.close(),
            frame: () => (at() > buffer.duration ? null : frames[Math.round((at() * 1000 - 12.5) / 10)] || silent),
        });
        window.noh.said.frames = frames;
        return said(`${file.name}, ${buffer.duration.toFixed(1)} s. The mouth is that of the live ear, without its ${latency()} ms.`);
    } catch (error) {
        context.close();
        throw error;
    }
}

byId('open-sound').addEventListener('click', () => byId('sound').click());
byId('sound').addEventListener('change', async () => {
    const file = byId('sound').files[0];
    if (!file) return;
    stopSpeech();
    const number = newest;
    try {
        await playFile(file, number);
    } catch (error) {
        if (number === newest) said(String(error.message || error));
    }
    byId('sound').value = ''; // the same file may be chosen again
});

// ---- a typed sentence ----

// Shapes by letters, the longest first: roughly those of languages in Latin script. Numbers are noh_viseme; 0 is silence.
const letters = { th: 3, sch: 6, ch: 6, sh: 6, ph: 2, ck: 5, ng: 5, qu: 5, oo: 14, ou: 14, ee: 12, ea: 12, ow: 13, oa: 13,
    p: 1, b: 1, m: 1, f: 2, v: 2, t: 4, d: 4, k: 5, g: 5, c: 5, q: 5, x: 5, j: 6, s: 7, z: 7, n: 8, l: 8, r: 9,
    a: 10, h: 10, e: 11, i: 12, y: 12, o: 13, u: 14, w: 14 };
const vowelMs = 95, consonantMs = 65, pauseMs = 60, stopMs = 280;

// [{ at, ms, shape }]: of each letter or group where it begins in the text, and how long it lasts.
function shapesOfText(words, rate) {
    const plain = words.normalize('NFD').replace(/[\u0300-\u036f]/g, '').toLowerCase(), out = [];
    // a text that decomposes into more letters is taken as it is, so that places agree with the browser's
    const line = plain.length === words.length ? plain : words.toLowerCase();
    for (let at = 0; at < line.length;) {
        const group = [3, 2, 1].map((n) => line.substr(at, n)).find((part) => letters[part] !== undefined) || line[at];
        const shape = letters[group] || (/\p{L}|\p{N}/u.test(group) ? 11 : 0); // other scripts open and shut the mouth
        const long = shape ? (shape > 9 ? vowelMs : consonantMs) : /[.,;:!?]/.test(group) ? stopMs : pauseMs;
        out.push({ at, ms: long / rate, shape });
        at += group.length;
    }
    return out;
}

// Phones for the library: start in ticks, shape. Returns the time at which each begins, in ms.
function writePhones(shapes) {
    const room = Math.min(shapes.length, Module._web_phone_room());
    const phones = Module.HEAPU32.subarray(Module._web_phones() >> 2, (Module._web_phones() >> 2) + 2 * room), times = [];
    let ms = 0;
    for (let i = 0; i < room; i++) {
        times.push(ms);
        phones.set([ms * ticksPerMs, shapes[i].shape], 2 * i);
        ms += shapes[i].ms;
    }
    check(Module._web_speak(room, ms * ticksPerMs));
    return { times, end: ms };
}

function shapesAt(ms) {
    Module._web_speak_at(ms * ticksPerMs);
    return { shapes: floats(Module._web_shapes(), shapeCount).slice() };
}

const speechErrors = {
    'not-allowed': 'The browser refuses to speak: press the button again.',
    'voice-unavailable': 'The browser has no voice for this.',
    'language-unavailable': 'The browser has no voice for this language.',
};

function sayText(words, number) {
    const shapes = shapesOfText(words, 1), utterance = new SpeechSynthesisUtterance(words);
    const { times, end } = writePhones(shapes);
    let began = 0, told = false;
    utterance.onstart = () => {
        began = performance.now();
        redraw();
    };
    // A word begins: its first letter is said now.
    utterance.onboundary = ({ charIndex }) => {
        const i = shapes.findIndex((s) => s.at >= charIndex);
        if (i >= 0 && i < times.length) began = performance.now() - times[i];
        if (!told && number === newest) said('The browser speaks, and tells only where words begin: in between the mouth follows letters, roughly.');
        told = true;
    };
    utterance.onend = () => { if (number === newest) stopSpeech(); };
    utterance.onerror = ({ error }) => {
        if (number !== newest || error === 'canceled' || error === 'interrupted') return;
        stopSpeech();
        said(speechErrors[error] || `The browser cannot say it: ${error}`);
    };
    said('The browser speaks. Without times of its words the mouth follows letters, roughly.');
    speakBy('text', {
        stop: () => window.speechSynthesis.cancel(),
        // past the estimated end, until the browser says that it ended: silence
        frame: (now) => {
            const ms = began ? now - began : -1, frame = ms >= 0 && ms < end ? shapesAt(ms) : silent;
            return { open: frame.shapes ? 1 - frame.shapes[0] - frame.shapes[1] : 0, shapes: frame.shapes };
        },
    });
    window.speechSynthesis.speak(utterance);
}

byId('say').addEventListener('submit', (event) => {
    const words = byId('line').value.trim();
    event.preventDefault();
    stopSpeech();
    if (!words) return said('Type a sentence first.');
    if (!window.speechSynthesis || !window.speechSynthesis.getVoices().length) {
        return said('This browser has no voices. Use the microphone or a sound file; `noh speak` makes clips of sentences.');
    }
    return sayText(words, newest);
});

// ---- start ----

// Nothing without a face that has mouth shapes. Some browsers list their voices only after they were asked once.
function beginSpeech() {
    byId('speech').hidden = !(Module._web_face_shows() & 2);
    if (window.speechSynthesis) window.speechSynthesis.getVoices();
}
