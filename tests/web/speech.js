// speech.js FOLDER CHROMIUM OUT: the page speaks, in headless Chromium: what a microphone hears (a sound that the browser
// plays into a device of its own), a sound file, a typed sentence (with voices that the test brings, since headless
// browsers have none). Prints its checks as TAP.
'use strict';
const fs = require('fs');
const path = require('path');
const { serve, launch, newPage, save, slowly, unprepared } = require('./browser.js');

const [folder, executablePath, out] = process.argv.slice(2);
const rate = 16000;
let told = 0, failures = 0, address = '';

function check(name, right, more) {
    told++;
    if (!right) failures++;
    console.log(`${right ? '' : 'not '}ok ${told} - ${name}`);
    if (more !== undefined && (!right || process.env.NOH_WEB_VALUES)) console.log(`#   ${more}`);
}

// ---- a voice ----

// One second of "a": pulses of 120 Hz through the three resonances of an open mouth.
function vowel() {
    const out = new Float64Array(rate), resonances = [[730, 90], [1090, 110], [2440, 170]];
    for (let i = 0; i < rate; i++) out[i] = i % Math.round(rate / 120) === 0 ? 1 : 0;
    for (const [frequency, width] of resonances) {
        const r = Math.exp(-Math.PI * width / rate), a = 2 * r * Math.cos(2 * Math.PI * frequency / rate);
        for (let i = 0, one = 0, two = 0; i < rate; i++) {
            const now = out[i] + a * one - r * r * two;
            [out[i], one, two] = [now, now, one];
        }
    }
    const most = out.reduce((m, s) => Math.max(m, Math.abs(s)), 0);
    return out.map((s, i) => 0.6 * s / most * Math.min(1, i / 800, (rate - i) / 800));
}

// Silence, the vowel, silence: a second each. The silence hisses a little, as rooms do.
function wav() {
    const samples = new Float64Array(3 * rate), voice = vowel();
    let noise = 1;
    for (let i = 0; i < samples.length; i++) {
        noise = (noise * 1103515245 + 12345) % 2147483648;
        samples[i] = (noise / 1073741824 - 1) * 0.0005 + (i >= rate && i < 2 * rate ? voice[i - rate] : 0);
    }
    const bytes = Buffer.alloc(44 + 2 * samples.length);
    bytes.write('RIFF', 0);
    bytes.writeUInt32LE(36 + 2 * samples.length, 4);
    bytes.write('WAVEfmt ', 8);
    bytes.writeUInt32LE(16, 16);
    bytes.writeUInt16LE(1, 20);
    bytes.writeUInt16LE(1, 22);
    bytes.writeUInt32LE(rate, 24);
    bytes.writeUInt32LE(2 * rate, 28);
    bytes.writeUInt16LE(2, 32);
    bytes.writeUInt16LE(16, 34);
    bytes.write('data', 36);
    bytes.writeUInt32LE(2 * samples.length, 40);
    samples.forEach((s, i) => bytes.writeInt16LE(Math.round(s * 32767), 44 + 2 * i));
    return bytes;
}

// ---- the page ----

async function open(browser, options, prepare) {
    const page = await newPage(browser, { viewport: { width: 1000, height: 700 }, ...options });
    await slowly(page);
    await unprepared(page);
    page.problems = [];
    page.on('pageerror', (error) => page.problems.push(String(error)));
    page.on('console', (message) => { if (message.type() === 'error') page.problems.push(message.text()); });
    if (prepare) await page.addInitScript(prepare);
    await page.goto(`${address}/?pack=page.noh&clip=none&light=plain&size=192&detail=3&tab=all`);
    await page.waitForFunction(() => window.noh.whole || window.noh.error);
    await page.click('#alive'); // a mouth that moves is then the speech's
    return page;
}

async function close(page, name) {
    check(`${name}: the browser reports no problem`, page.problems.length === 0, page.problems.join(' | '));
    await page.context().close();
}

// How far the mouth was open in any frame from now on, and the captions: whatever the test sees, and when.
const record = (page) => page.evaluate(() => {
    window.most = 0;
    window.captions = [];
    character.addEventListener('frame', () => { window.most = Math.max(window.most, character.speech.now.open); });
    character.addEventListener('caption', () => captions.push(document.getElementById('caption').textContent));
});
const opened = (page) => page.waitForFunction(() => window.most > 0.15).then(() => true, () => false);
const shown = (page, caption) => page.waitForFunction((c) => captions.includes(c), caption).then(() => true, () => false);

const words = (page, part) => page.waitForFunction((p) => document.getElementById('speech-text').textContent.includes(p), part)
    .then(() => true, () => false);
const jaw = () => Number(document.querySelector('input[data-target="jawOpen"], input[data-target="mouth-open"], input[data-target="jaw_open"]').value);
const opens = (page) => page.waitForFunction(`(${jaw})() > 0.15`).then(() => true, () => false);
const shuts = (page) => page.waitForFunction(`Math.abs((${jaw})()) < 0.03`).then(() => true, () => false);

async function microphone(browser) {
    const page = await open(browser, { permissions: ['microphone'] });
    const memory = await page.evaluate(() => Module.HEAPU8.length);
    check('microphone: offered to a face that can speak', await page.isVisible('#listen'));
    await page.click('#listen');
    check('microphone: it says how late the mouth is', await words(page, '40 ms late'), await page.textContent('#speech-text'));
    check('microphone: the mouth opens when there is a voice', await opens(page), await page.textContent('#speech-text'));
    await save(page, '#canvas', path.join(out, 'speaks.png'));
    await page.screenshot({ path: path.join(out, 'speech.png') });
    check('microphone: and shuts when there is none', await shuts(page));
    check('microphone: and opens again', await opens(page));
    await page.click('#listen');
    check('microphone: it stops when told to', await page.getAttribute('#listen', 'aria-pressed') === 'false' && await shuts(page));
    check('microphone: memory did not grow', await page.evaluate(() => Module.HEAPU8.length) === memory);
    await close(page, 'microphone');
}

async function refused(browser) {
    const page = await open(browser, { permissions: [] });
    await page.click('#listen');
    check('refused: it says so, and what to do', await words(page, 'Allow it for this page'), await page.textContent('#speech-text'));
    check('refused: nothing listens', await page.getAttribute('#listen', 'aria-pressed') === 'false' && await page.evaluate(() => !character.speech.speaks));
    for (const [name, error, said] of [['no device', 'NotFoundError', 'There is no microphone'], ['a device in use', 'NotReadableError', 'another program'],
        ['an unknown error', 'OddError', 'cannot be used: odd']]) {
        await page.evaluate((e) => { navigator.mediaDevices.getUserMedia = () => Promise.reject(Object.assign(new Error('odd'), { name: e })); }, error);
        await page.click('#listen');
        check(`${name}: it says so`, await words(page, said), await page.textContent('#speech-text'));
    }
    await page.evaluate(() => Object.defineProperty(navigator, 'mediaDevices', { value: undefined }));
    await page.click('#listen');
    check('no https: it says so', await words(page, 'https'), await page.textContent('#speech-text'));
    await close(page, 'refused');
}

async function file(browser) {
    const page = await open(browser, {});
    await page.setInputFiles('#sound', { name: 'no_sound.wav', mimeType: 'audio/wav', buffer: Buffer.from('this is no sound') });
    check('a file: what is no sound is refused by name', await words(page, 'no_sound.wav: this browser cannot decode it'), await page.textContent('#speech-text'));
    await record(page);
    await page.setInputFiles('#sound', path.join(out, 'voice.wav'));
    check('a file: it plays', await words(page, 'voice.wav, 3.0 s'), await page.textContent('#speech-text'));
    const frames = await page.evaluate(() => window.noh.said.frames.map((f) => f.open));
    const mean = (from, to) => frames.slice(from, to).reduce((sum, o) => sum + o, 0) / (to - from);
    check('a file: a frame each 10 ms', frames.length >= 295 && frames.length <= 300, frames.length);
    check('a file: silent before', mean(20, 95) < 0.05, mean(20, 95));
    check('a file: open in the vowel', mean(115, 190) > 0.3, mean(115, 190));
    check('a file: silent after', mean(220, 290) < 0.05, mean(220, 290));
    check('a file: the mouth opens', await opened(page));
    await page.waitForFunction(() => !character.speech.speaks);
    check('a file: and is shut at its end', await shuts(page));
    await close(page, 'a file');
}

// A browser's voice without a sound: it begins on request, and says "mamama" a word at a time when the test asks.
const voices = `
window.voice = { queue: [] };
window.SpeechSynthesisUtterance = function (text) { this.text = text; };
Object.defineProperty(window, 'speechSynthesis', { value: {
    getVoices: () => [{ name: 'test', lang: 'en' }],
    speak: (u) => { window.voice.now = u; u.onstart(); },
    cancel: () => { const u = window.voice.now; window.voice.now = null; if (u) u.onerror({ error: 'canceled' }); },
} });`;

async function text(browser) {
    const none = await open(browser, {}, "Object.defineProperty(window, 'speechSynthesis', { value: { getVoices: () => [], cancel() {} } });");
    await none.click('#say button');
    check('text: nothing typed is reported', await words(none, 'Type a sentence'));
    await none.evaluate(() => {
        window.heard = [];
        for (const type of ['word', 'caption']) character.addEventListener(type, ({ detail }) => heard.push(detail.word ?? detail.words));
    });
    await record(none);
    await none.fill('#line', 'A man came home.');
    await none.click('#say button');
    check('text: a visitor reads that there is no voice', await words(none, 'This browser has no voice: the words are shown'), await none.textContent('#speech-text'));
    check('text: and the face says it without one', await opened(none) && await shown(none, 'A man came home.'));
    await none.screenshot({ path: path.join(out, 'silent.png') });
    await none.waitForFunction(() => !character.speech.speaks);
    const heard = await none.evaluate(() => heard.join('|'));
    check('text: words are events', heard === 'A man came home.|A|man|came|home.|', heard);
    await close(none, 'no voices');
    const late = await open(browser, {}, `${voices}
        let told = null, all = [];
        Object.assign(speechSynthesis, { getVoices: () => all, addEventListener: (type, call) => { told = call; } });
        window.bring = () => { all = [{ name: 'test', lang: 'en' }]; told(); };`);
    await late.fill('#line', 'mama');
    await late.click('#say button');
    await late.evaluate(() => window.bring());
    await late.waitForFunction(() => window.voice.now);
    check('text: voices that come late speak the first time', await late.evaluate(() => window.voice.now.text) === 'mama');
    await late.evaluate(() => { speechSynthesis.speak = () => {}; });
    await record(late);
    await late.fill('#line', 'papa');
    await late.click('#say button');
    check('text: a voice that does not begin is done without', await words(late, 'This browser has no voice') && await shown(late, 'papa'));
    await close(late, 'late voices');
    const page = await open(browser, {}, voices);
    await page.fill('#line', `Papa und Mama ${'a'.repeat(300)}`); // half a minute: frames may be slow
    await page.click('#say button');
    check('text: it says that the mouth is rough', await words(page, 'roughly'));
    check('text: the mouth opens', await opens(page));
    const at = await page.evaluate(async () => [0, 5, 9, 14].map(((shapesOfText) => (c) => shapesOfText('Papa und Mama aaa', 1).find((s) => s.at >= c).shape)((await import('./package/index.js')).shapesOfText)));
    check('text: letters are shapes', at.join() === '1,14,1,10', at.join());
    await page.evaluate(() => window.voice.now.onboundary({ charIndex: 14 }));
    check('text: at a word the mouth is where the word is', await opens(page) && await words(page, 'where words begin'));
    await page.evaluate(() => window.voice.now.onend());
    check('text: at the end it is shut', await shuts(page));
    await page.fill('#line', '\u3053\u3093\u306b\u3061\u306f'.repeat(60));
    await page.click('#say button');
    check('text: other scripts open the mouth, too', await opens(page));
    await page.evaluate(() => window.voice.now.onerror({ error: 'language-unavailable' }));
    check('text: a language without a voice is reported', await words(page, 'no voice for this language'));
    await close(page, 'text');
}

// What a program says: one after another, sounds of each kind, times of its own, an interruption.
async function program(browser) {
    const page = await open(browser, {}, "Object.defineProperty(window, 'speechSynthesis', { value: undefined });");
    const said = await page.evaluate(async (bytes) => {
        const { speech } = character, file = () => new File([new Uint8Array(bytes)], 'voice.wav'), order = [];
        character.addEventListener('word', ({ detail }) => order.push(detail.word));
        const first = speech.speak('mama', { mood: 'joy' }), mood = character.chosen.emotion, second = speech.speak('papa');
        const whole = [await first, await second], after = character.chosen.emotion;
        const cut = speech.speak('a long sentence that nobody hears to its end');
        const next = speech.speak(URL.createObjectURL ? new URL(URL.createObjectURL(file())) : file(), { interrupt: true });
        const interrupted = await cut;
        while (!speech.now.frames) await new Promise((resolve) => setTimeout(resolve, 20));
        const open = Math.max(...speech.now.frames.map((f) => f.open));
        speech.stop();
        return { order: order.slice(0, 2).join(), mood, after, whole: whole.join(), interrupted, next: await next, open };
    }, [...wav()]);
    check('a program: sentences follow each other', said.order === 'mama,papa' && said.whole === 'true,true', JSON.stringify(said));
    check('a program: a mood lasts as long as its sentence', said.mood === 'joy' && said.after === null, JSON.stringify(said));
    check('a program: one may interrupt', said.interrupted === false && said.next === false && said.open > 0.3, JSON.stringify(said));
    const sounds = await page.evaluate(async (bytes) => {
        const { speech } = character, told = {}, context = new AudioContext(), most = async (name, source, options) => {
            const done = speech.speak(source, options);
            let open = 0, ended = false;
            done.then(() => { ended = true; });
            while (!ended) {
                await new Promise((resolve) => setTimeout(resolve, 30));
                open = Math.max(open, speech.now.open);
                if (name === 'stream' && open > 0.2) speech.stop();
            }
            told[name] = [open > 0.2, await done].join();
        };
        const buffer = await context.decodeAudioData(new Uint8Array(bytes).buffer), silence = context.createBuffer(1, 32000, 16000);
        await most('visemes', silence, { visemes: [{ viseme: 0, ms: 0 }, { viseme: 10, ms: 100 }, { viseme: 0, ms: 1800 }] }); // long enough for slow frames
        const resampled = await (async () => { const o = new OfflineAudioContext(1, 48000, 16000), n = o.createBufferSource(); n.buffer = buffer; n.connect(o.destination); n.start(); return o.startRendering(); })();
        await most('chunks', (async function* () { for (let i = 0; i < 48000; i += 8000) yield resampled.getChannelData(0).slice(i, i + 8000); })(), { rate: 16000 });
        const audio = new Audio(URL.createObjectURL(new Blob([new Uint8Array(bytes)], { type: 'audio/wav' })));
        setTimeout(() => audio.play(), 300);
        await most('media', audio);
        const out = context.createMediaStreamDestination(), node = context.createBufferSource();
        node.buffer = buffer;
        node.loop = true;
        node.connect(out);
        node.start();
        await most('stream', out.stream);
        return told;
    }, [...wav()]);
    check('a program: visemes of its own', sounds.visemes === 'true,true', JSON.stringify(sounds));
    check('a program: samples as they come', sounds.chunks === 'true,true', JSON.stringify(sounds));
    check('a program: an <audio> drives the mouth', sounds.media === 'true,true', JSON.stringify(sounds));
    check('a program: a stream', sounds.stream === 'true,false', JSON.stringify(sounds));
    await close(page, 'a program');
}

(async () => {
    const served = await serve({ '/': folder }), sound = path.join(out, 'voice.wav');
    address = served.address;
    fs.writeFileSync(sound, wav());
    const browser = await launch(executablePath, ['--use-fake-device-for-media-stream', `--use-file-for-fake-audio-capture=${sound}`,
        '--autoplay-policy=no-user-gesture-required']);
    try {
        await microphone(browser);
        await refused(browser);
        await file(browser);
        await text(browser);
        await program(browser);
    } finally {
        await browser.close();
        served.server.close();
    }
    console.log(`1..${told}`);
    process.exit(failures ? 1 : 0);
})().catch((error) => { console.log(`not ok ${told + 1} - ${error}`); process.exit(1); });
