// greet.js FOLDER CHROMIUM OUT: what a visitor meets: a poster at once, the share of what has come, a face that fills the
// page, a greeting by the first touch or by keys, the workbench behind a button. Headless browsers have no voices, so the
// greeting is silent, with its words shown. Prints its checks as TAP.
'use strict';
const fs = require('fs');
const path = require('path');
const { folder, out, check, close, faults, run, address } = require('./harness.js');
const { newPage, slowly, unprepared } = require('./browser.js');

const phone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 1, hasTouch: true, isMobile: true };
const small = 'size=96&detail=2&shadow=off'; // a software rasteriser pays for each pixel
const sent = fs.readFileSync(path.join(folder, 'page.nohz'));
let release = () => {}, holds = false;

// The pack, whose first bytes wait until the test lets them go.
function pack(request, answer) {
    const [, from, to] = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range || 'bytes=0-'), last = Math.min(Number(to || Infinity), sent.length - 1);
    const go = () => {
        answer.writeHead(206, { 'Content-Type': 'application/octet-stream', 'Content-Length': last + 1 - from, 'Content-Range': `bytes ${from}-${last}/${sent.length}` });
        answer.end(sent.subarray(Number(from), last + 1));
    };
    if (holds) release = go;
    else go();
}

async function meet(browser, options, search = small) {
    const page = await newPage(browser, options);
    await slowly(page);
    await unprepared(page);
    page.problems = [];
    page.on('pageerror', (error) => page.problems.push(String(error)));
    page.on('console', (message) => { if (message.type() === 'error') page.problems.push(message.text()); });
    await page.goto(`${address()}/?${search}`);
    return page;
}
const whole = (page) => page.waitForFunction(() => window.noh.whole || window.noh.error);
const saysSomething = (page) => page.waitForFunction(() => document.getElementById('caption').textContent);
const ends = (page) => page.waitForFunction(() => !greets && !document.getElementById('caption').textContent);

async function first(browser) {
    holds = true;
    const page = await meet(browser, phone), poster = await page.evaluate(async () => {
        const image = document.querySelector('#poster img');
        await image.decode();
        return { name: image.currentSrc, wide: image.naturalWidth };
    });
    check('first: a poster for a tall screen', /poster_tall/.test(poster.name) && poster.wide > 0 && await page.isVisible('#poster img'), JSON.stringify(poster));
    const shape = await page.evaluate(async () => { // as a phone lies
        const image = Object.assign(new Image(), { src: 'poster_wide.jpg' });
        await image.decode();
        return image.naturalWidth / image.naturalHeight;
    });
    check('first: the wide poster is cut at its sides alone', shape >= phone.viewport.height / phone.viewport.width, shape);
    for (const name of ['tall', 'wide']) check(`first: the ${name} poster has 5 kB at most`, fs.statSync(path.join(folder, `poster_${name}.jpg`)).size <= 5000);
    await page.waitForFunction(() => /^loading: [1-9]\d? %$/.test(document.getElementById('progress-text').textContent));
    check('first: the share of what has come is a bar, too', await page.evaluate(() => { const { value, max } = document.getElementById('progress-bar'); return value > 0 && value < max; }));
    check('first: what does not work yet is disabled', await page.isDisabled('#greet') && await page.isDisabled('#more') && await page.evaluate(() => document.getElementById('controls').inert));
    const place = () => page.locator('#greet').boundingBox(), before = await place();
    await page.screenshot({ path: path.join(out, 'greet_poster.png') });
    holds = false;
    release();
    await page.waitForFunction(() => window.noh.ready);
    check('first: then the character is there', await page.evaluate(() => document.getElementById('poster').classList.contains('gone')) && await page.isEnabled('#greet') && await page.isEnabled('#more'));
    const after = await place();
    check('first: the buttons stay where they were', before.x === after.x && before.y === after.y, JSON.stringify([before, after]));
    check('first: and no workbench', !await page.isVisible('#controls'));
    await whole(page);
    await page.screenshot({ path: path.join(out, 'greet_first.png') });
    check('first: the face fills the page', await page.evaluate(() => character.camera.box[1] > character.camera.all[1]));
    await touched(page);
    await close(page, 'first');
}

// The first touch greets.
async function touched(page) {
    await page.evaluate(() => {
        window.seen = { moods: new Set(), words: [], turned: 0, lit: 0, open: 0 };
        const feel = character.feel.bind(character); // some moods last less than a slow frame
        character.feel = (mood, ...more) => { if (mood) window.seen.moods.add(mood); feel(mood, ...more); };
        const before = { azimuth: character.camera.azimuth, degrees: character.chosen.degrees };
        character.addEventListener('caption', ({ detail }) => { if (detail.words) window.seen.words.push(detail.words); });
        character.addEventListener('frame', () => {
            const { seen } = window;
            if (character.chosen.emotion) seen.moods.add(character.chosen.emotion);
            seen.turned = Math.max(seen.turned, Math.abs(character.camera.azimuth - before.azimuth));
            seen.lit = Math.max(seen.lit, Math.abs(character.chosen.degrees - before.degrees));
            seen.open = Math.max(seen.open, character.speech.now.open);
            seen.back = Math.abs(character.camera.azimuth - before.azimuth) + Math.abs(character.chosen.degrees - before.degrees) < 1e-6;
        });
    });
    const begin = Date.now();
    await page.touchscreen.tap(195, 400);
    await saysSomething(page);
    check('greeting: the first touch begins it', await page.isVisible('#caption') && await page.textContent('#greet') === 'Stop');
    check('greeting: a screen reader hears it', await page.getAttribute('#caption', 'role') === 'status');
    await page.screenshot({ path: path.join(out, 'greet_says.png') });
    await ends(page);
    const seconds = (Date.now() - begin) / 1000, seen = await page.evaluate(() => ({ ...window.seen, moods: [...window.seen.moods] }));
    check('greeting: it is not over at once', seconds > 12, seconds); // how much later depends on the machine
    check('greeting: five sentences are shown', seen.words.length === 5 && /in \d+ kilobytes/.test(seen.words[1]), seen.words.join(' | '));
    check('greeting: the mouth moves', seen.open > 0.2, seen.open);
    check('greeting: it shows emotions', ['joy', 'sadness', 'surprise', 'anger'].every((mood) => seen.moods.includes(mood)), seen.moods.join());
    check('greeting: it turns, and the light does', seen.turned > 0.1 && seen.lit > 10, JSON.stringify(seen));
    await page.waitForFunction(() => window.seen.back);
    check('greeting: then all is as before', await page.evaluate(() => character.chosen.emotion === null && character.lives));
    await page.touchscreen.tap(195, 400);
    await page.waitForTimeout(500);
    check('greeting: a second touch does not repeat it', await page.evaluate(() => !greets) && await page.textContent('#greet') === 'Say it again');
}

// By keys alone; the workbench and back.
async function keys(browser) {
    const page = await meet(browser, { viewport: { width: 900, height: 600 } });
    await whole(page);
    await page.focus('#greet');
    await page.keyboard.press('Enter');
    await saysSomething(page);
    await page.keyboard.press('Escape');
    await ends(page);
    check('keys: Enter greets and Escape ends it', await page.textContent('#greet') === 'Say it again');
    await page.keyboard.press('Tab');
    await page.keyboard.press('Enter');
    check('keys: the workbench opens, and has the focus', await page.isVisible('#tabs') && await page.evaluate(() => document.activeElement.id) === 'less');
    check('keys: it shows all of the figure', await page.evaluate(() => character.camera.box[1] === character.camera.all[1]));
    await page.screenshot({ path: path.join(out, 'greet_works.png') });
    await page.keyboard.press('Enter');
    check('keys: and closes', !await page.isVisible('#tabs') && await page.evaluate(() => document.activeElement.id) === 'more');
    await close(page, 'keys');
}

async function access(browser) {
    for (const [colorScheme, options] of [['dark', { viewport: { width: 1440, height: 900 } }], ['light', phone]]) {
        const page = await meet(browser, { ...options, colorScheme });
        await whole(page);
        const found = await faults(page), low = await page.locator('#greeting button').evaluateAll((all) => all.filter((e) => e.getBoundingClientRect().height < 44).length);
        check(`access: axe finds nothing, ${colorScheme}`, found.length === 0, found.join(' | '));
        check(`access: buttons are 44 pixels high, ${colorScheme}`, low === 0);
        await close(page, `access ${colorScheme}`);
    }
}

// Words and mouth without anything else that moves.
async function reduced(browser) {
    const page = await meet(browser, { ...phone, reducedMotion: 'reduce' });
    await whole(page);
    await page.evaluate(() => { window.turned = 0; character.addEventListener('frame', () => { window.turned = Math.max(window.turned, Math.abs(character.camera.azimuth)); }); });
    await page.tap('#greet');
    await page.waitForFunction(() => /kilobytes/.test(document.getElementById('caption').textContent));
    await page.waitForFunction(() => !/kilobytes/.test(document.getElementById('caption').textContent));
    check('reduced motion: it speaks, and the camera stands still', await page.evaluate(() => window.turned === 0 && !character.lives));
    await close(page, 'reduced motion');
}

run({ first, keys, access, reduced }, [], { '/page.nohz': pack });
