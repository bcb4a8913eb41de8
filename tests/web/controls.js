// controls.js FOLDER CHROMIUM OUT CLIP: the page by keys alone, targets in groups, what axe has to say of it, and how
// make web-serve serves it. Prints its checks as TAP.
'use strict';
const childProcess = require('child_process');
const fs = require('fs');
const http = require('http');
const path = require('path');
const zlib = require('zlib');
const { median, addedOf, quiet, inBatches, isSettled } = require('./compare_fours.js');
const { folder, out, check, keep, same, drawn, open, close, faults, run } = require('./harness.js');

const clip = process.argv[5];

// What a mouse does, by keys alone.
async function keyboard(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, `clip=${clip}`);
    const camera = () => page.evaluate(() => ({ ...character.camera }));
    const press = (key) => drawn(page, () => page.keyboard.press(key));
    await page.keyboard.press('Tab');
    check('keys: the canvas is first', await page.evaluate(() => document.activeElement === canvas));
    await page.keyboard.press(' ');
    check('keys: space holds the clip', await page.textContent('#play') === 'play');
    await keep(page, 'keys_before.png');
    const before = await camera();
    await press('ArrowLeft');
    await press('ArrowUp');
    await press('+');
    await press('Shift+ArrowRight');
    const after = await camera();
    check('keys: arrows turn it', after.azimuth > before.azimuth && after.elevation < before.elevation);
    check('keys: plus brings it closer', after.distance < 1 && after.distance > 0.8, after.distance);
    check('keys: arrows with shift move it', Math.hypot(...after.offset) > 0);
    await keep(page, 'keys_after.png');
    check('keys: all of which shows', !same('keys_before.png', 'keys_after.png'));
    await press('Home');
    await keep(page, 'keys_home.png');
    check('keys: home is where it began', same('keys_before.png', 'keys_home.png'));
    await page.keyboard.press(' ');
    check('keys: space goes on', await page.textContent('#play') === 'pause');
    check('keys: the page does not scroll', await page.evaluate(() => window.scrollY) === 0);
    await close(page, 'keys');
}

// Targets lie in groups; one without any that the search names is not there.
async function grouped(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, 'clip=none');
    const names = await page.locator('#targets summary').allTextContents();
    check('groups: eyes and mouth are apart', names.includes('eyes') && names.includes('mouth'), names.join(', '));
    const all = await page.locator('#targets input').count();
    check('groups: each target is in one', all === await page.evaluate(() => Module._web_target_count()), all);
    await page.fill('#search', 'smile');
    const left = await page.locator('#targets summary:visible').allTextContents();
    check('groups: the search leaves those that it is in', left.length > 0 && left.length < names.length && left.includes('mouth'), left.join(', '));
    await close(page, 'groups');
}

// A tab shows its panel alone, by a click and by keys; characters side by side.
async function tabbed(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, 'clip=none&size=128&tab=face&alive=on');
    const shown = () => page.locator('[role=tabpanel]:visible').evaluateAll((panels) => panels.map((panel) => panel.id).join());
    const names = await page.locator('[role=tab]:visible').allTextContents();
    check('tabs: one for each panel', names.join() === 'Motion,Face,Speech,Look,Several,Crowd,Pack', names.join());
    check('tabs: the query begins with one', await shown() === 'panel-face');
    await page.click('#tab-look');
    check('tabs: a click shows another', await shown() === 'panel-look' && await page.isVisible('#light') && !await page.isVisible('#search'));
    await page.keyboard.press('ArrowRight');
    check('tabs: as do arrows', await shown() === 'panel-several' && await page.evaluate(() => document.activeElement.id) === 'tab-several');
    await page.keyboard.press('Home');
    check('tabs: home is the first', await shown() === 'panel-motion');
    await page.click('#tab-several');
    const before = await page.evaluate(() => window.noh.memory.all);
    await keep(page, 'one.png');
    await page.selectOption('#several', '3');
    await page.waitForFunction((n) => !opening && window.noh.whole && window.noh.memory.all > n, before);
    await keep(page, 'three.png');
    check('tabs: three characters, in memory of their own', !same('one.png', 'three.png'));
    check('tabs: which cannot grow', await page.evaluate(() => { try { Module.memory.grow(1); return false; } catch { return true; } }));
    await page.selectOption('#several', '1');
    await page.waitForFunction((n) => !opening && window.noh.whole && window.noh.memory.all === n, before);
    await page.screenshot({ path: path.join(out, 'tabs.png') });
    await close(page, 'tabs');
}

// ---- how many pixels are drawn ----

// A machine's frames, in ms by the share of pixels across, for `seconds`: what the share was in the end, the least of
// them, and how often it changed.
function play(pixels, seconds, frame, start = 0) {
    const told = { least: 1, changes: 0, at: start };
    for (const end = start + 1000 * seconds; told.at < end;) {
        const ms = frame(pixels.share, told.at);
        told.at += ms;
        if (pixels.tell(ms, told.at)) told.changes++;
        told.least = Math.min(told.least, pixels.share);
    }
    return told;
}

async function spared() {
    const { Pixels } = await import(path.join(__dirname, '../../platform/web/package/pixels.js'));
    const quick = new Pixels(), slow = new Pixels(), vertices = new Pixels();
    check('sharpness: with a GPU all pixels are drawn', play(quick, 60, () => 16.7).least === 1);
    check('sharpness: one long frame in a second changes nothing', play(quick, 60, (share, at) => (at % 1000 < 17 ? 300 : 16.7)).least === 1);
    const down = play(slow, 15, (share) => 15 + 120 * share ** 2);
    check('sharpness: fewer where pixels take long, until frames are short enough', 15 + 120 * slow.share ** 2 < 50 && slow.share > 0.3 && slow.share < 0.6, slow.share);
    check('sharpness: and not to and fro', down.changes <= 3, down.changes);
    play(slow, 60, () => 16.7, down.at);
    check('sharpness: all again when frames are short', slow.share === 1);
    const vain = play(vertices, 15, () => 200);
    check('sharpness: all where fewer are no help', vertices.share === 1 && vain.changes === 2, `${vertices.share} after ${vain.changes}`);
}

// While it moves and at rest.
async function sharpness(browser) {
    await spared();
    const page = await open(browser, { viewport: { width: 600, height: 300 } }, `clip=${clip}&size=0&pixels=auto`);
    const width = () => page.evaluate(() => canvas.width);
    await page.evaluate(() => { Object.assign(character.pixels, { share: 0.5, tell: () => false, forget() {} }); });
    await page.waitForFunction(() => canvas.width * 2 === canvas.clientWidth);
    check('sharpness: it says so', (await page.textContent('#sharpness-text')).startsWith('50 %'));
    await page.evaluate(() => { character.paused = true; });
    await page.waitForFunction(() => canvas.width === canvas.clientWidth);
    check('sharpness: at rest it has all of them', (await page.textContent('#sharpness-text')).startsWith('All'));
    await page.evaluate(() => { character.paused = false; });
    await page.waitForFunction(() => canvas.width * 2 === canvas.clientWidth);
    await drawn(page, () => page.click('#sparing'));
    check('sharpness: or always, if asked for', await width() === await page.evaluate(() => canvas.clientWidth));
    await close(page, 'sharpness');
}

// What the panels say.
async function worded(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, `clip=${clip}`);
    check('words: what plays can be paused', await page.textContent('#play') === 'pause');
    const names = await page.evaluate(() => ['browInnerUp', 'eyeBlinkLeft', 'viseme_aa', 'Fcl_BRW_Angry', 'A', 'mouth-open', '_'].map(wordsOf));
    check('words: of names', names.join('; ') === 'brow inner up; eye blink, left; viseme aa; fcl brw angry; a; mouth open; _', names.join('; '));
    const [asMade, shown] = await page.evaluate(() => {
        byId('clips').add(Object.assign(new Option(wordsOf('get_up_left'), 0), { selected: true }));
        byId('clips').lastChild.dataset.name = 'get_up_left';
        return [named(byId('clips')), byId('clips').selectedOptions[0].text];
    });
    check('words: of a clip, which is played by its name', asMade === 'get_up_left' && shown === 'get up, left', `${asMade}, ${shown}`);
    await page.fill('#search', 'brow inner');
    const left = await page.locator('#targets label:visible input').evaluateAll((inputs) => inputs.map((input) => input.dataset.target));
    check('words: are searched for, too', left.join() === 'browInnerUp', left.join());
    await close(page, 'words');
    const still = await open(browser, { viewport: { width: 1000, height: 700 }, reducedMotion: 'reduce' }, `clip=${clip}`);
    check('words: what stands still can be played', await still.textContent('#play') === 'play');
    await close(still, 'words, still');
}

// What axe finds wrong: nothing, in both colour schemes, wide and narrow.
async function access(browser) {
    for (const [colorScheme, width, height, tab] of [['dark', 1440, 900, 'all'], ['light', 1440, 900, 'face'], ['light', 390, 844, 'motion'], ['dark', 844, 390, 'several']]) {
        const page = await open(browser, { viewport: { width, height }, colorScheme, hasTouch: width < 1000, isMobile: width < 1000 }, `clip=none&size=256&tab=${tab}`);
        const found = await faults(page);
        check(`access: axe finds nothing, ${colorScheme}, ${width} x ${height}`, found.length === 0, found.join(' | '));
        if (width < 1000) {
            const small = await page.locator('button:visible, select:visible, input[type=range]:visible').evaluateAll((e) => e.filter((c) => c.getBoundingClientRect().height < 44).map((c) => c.id));
            check(`access: what is touched is 44 pixels high, ${width} x ${height}`, small.length === 0, small.join(' '));
        }
        await page.screenshot({ path: path.join(out, `${colorScheme}_${width}.png`) });
        await close(page, `access ${colorScheme} ${width}`);
    }
}

// ---- tools/web_serve.js ----

const get = (address, name, accepted) => new Promise((resolve, reject) => {
    http.get(address, { path: name, headers: { 'Accept-Encoding': accepted } }, (response) => {
        const parts = [];
        response.on('data', (part) => parts.push(part));
        response.on('end', () => resolve({ code: response.statusCode, coding: response.headers['content-encoding'], bytes: Buffer.concat(parts) }));
    }).on('error', reject);
});

async function served() {
    const program = path.join(__dirname, '../../tools/web_serve.js');
    const server = childProcess.spawn(process.execPath, [program, folder, '0'], { stdio: ['ignore', 'pipe', 'inherit'] });
    const address = await new Promise((resolve) => { server.stdout.once('data', (said) => resolve(String(said).split('\n')[0])); });
    const want = fs.readFileSync(path.join(folder, 'package/noh.wasm'));
    const br = await get(address, '/package/noh.wasm', 'gzip, deflate, br'), gzip = await get(address, '/package/noh.wasm', 'gzip'), plain = await get(address, '/package/noh.wasm', '');
    check('served: with brotli', br.coding === 'br' && zlib.brotliDecompressSync(br.bytes).equals(want));
    check('served: with gzip', gzip.coding === 'gzip' && zlib.gunzipSync(gzip.bytes).equals(want));
    check('served: as it is', !plain.coding && plain.bytes.equals(want));
    check('served: each smaller than the next', br.bytes.length < gzip.bytes.length && gzip.bytes.length < want.length);
    check('served: packs as they are', !(await get(address, '/page.nohz', 'br')).coding);
    check('served: the page', (await get(address, '/', '')).bytes.includes('<canvas'));
    const codes = [];
    for (const name of ['/none', '//none', '/../../../etc/passwd', '/%2e%2e/%2e%2e/etc/passwd', '/%zz']) codes.push((await get(address, name, '')).code);
    check('served: nothing else', codes.join() === '404,404,404,404,400', codes.join());
    server.kill();
    const refused = (...args) => childProcess.spawnSync(process.execPath, [program, ...args]).status === 1;
    check('served: no page, no port, no such host', refused('/nowhere') && refused(folder, 'x') && refused(folder, '70000') && refused(folder, '0', 'everybody'));
}

// ---- compare_fours.js ----

// Frames of 8 ms (targets take 0.2) on a machine that slows down by a tenth and gives a third to others.
async function compared() {
    let seed = 1;
    const random = () => { seed = (seed * 1103515245 + 12345) % 2147483648; return seed / 2147483648; };
    const four = (i, n) => [0, 0.2, 0.2, 0].map((added) => (8 + added + 0.3 * random()) * (1 + 0.1 * i / n)).map((ms) => (random() < 0.1 ? 2 * ms : ms));
    const fours = Array.from({ length: 600 }, (_, i) => four(i, 600)), left = quiet(fours), found = median(inBatches(fours, addedOf));
    check('compared: what was disturbed is left out', left.length > 300 && left.length < 500 && Math.max(...left.flat()) < 10, left.length);
    check('compared: what targets add is found in what is not', Math.abs(found - 0.21) < 0.02, found);
    check('compared: enough of them settle it, few do not', isSettled(fours, [addedOf]) && !isSettled(fours.slice(0, 60), [addedOf]));
    check('compared: nor do differences that are noise alone', !isSettled(Array.from({ length: 600 }, () => [8, 8, 8, 8].map((ms) => ms + 0.3 * random())), [addedOf]));
}

run({ served, compared, keyboard, grouped, tabbed, sharpness, worded, access });
