// page.js FOLDER CHROMIUM OUT CLIP TIME SIZE PATHS: the page in headless Chromium on SwiftShader. Loads it, moves sliders,
// searches, plays clips, turns the figure, loses the context and restores it, lights it, lets it live and speak. Saves canvases in OUT as PNG, among them
// CLIP at TIME by each path, SIZE pixels across. Prints its checks as TAP.
'use strict';
const path = require('path');
const { folder, out, check, keep, same, drawn, slide, setTarget, choose, toggle, open, close, loseAndRestore, run } = require('./harness.js');

const [clip, time, size, paths] = process.argv.slice(5);
const forcedPaths = paths.split(' ');
const owns = forcedPaths.length > 1; // what does not depend on the pack is tried with this one
const isBody = path.basename(folder) === 'puppet_levels';

// Draw `pixels` pixels across at a level from now on.
const redraw = (page, pixels, level) => drawn(page, () => page.evaluate(([n, l]) => {
    Object.assign(character, { size: n, level: l });
    character.resizeCanvas();
    character.draw();
}, [Number(pixels), level]));

// Save a large picture, for the comparison with `noh render`.
async function keepLarge(page, name, level = 0) {
    await redraw(page, size, level);
    await keep(page, name);
    await redraw(page, 192, 3);
}

// Show the clip at its time, framed as by `noh render`.
async function scrub(page) {
    await drawn(page, () => page.selectOption('#clips', { label: clip }));
    await slide(page, '#time', time);
    await drawn(page, () => page.click('#fit'));
}

async function onePath(browser, forced) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, `path=${forced}&clip=none`);
    const state = await page.evaluate(() => window.noh);
    check(`${forced}: it loads`, state.ready && !state.error, state.error);
    if (!state.ready) return;
    check(`${forced}: and takes that path`, state.path === (forced === 'auto' ? 'cpu' : forced), state.path);
    if (forced === 'auto') console.log(`# ${state.renderer}; ${JSON.stringify(state.memory)}`);
    console.log(`# budget ${state.path} plain still ${state.memory.cpu} ${state.memory.gpu}`);
    check(`${forced}: what noh uses is within what was planned`, state.memory.cpu <= state.memory.room);
    await keep(page, `${forced}_small_rest.png`);
    await keepLarge(page, `${forced}_rest.png`);
    await setTarget(page, 'smile', 1);
    await keep(page, `${forced}_small_smile.png`);
    await keepLarge(page, `${forced}_smile.png`);
    check(`${forced}: a slider moves the picture`, !same(`${forced}_small_rest.png`, `${forced}_small_smile.png`));
    await drawn(page, () => page.click('#reset'));
    await keep(page, `${forced}_reset.png`);
    check(`${forced}: and back`, same(`${forced}_small_rest.png`, `${forced}_reset.png`));
    await scrub(page);
    await keepLarge(page, `${forced}_clip.png`);
    await keep(page, `${forced}_small_clip.png`);
    check(`${forced}: a clip moves the picture`, !same(`${forced}_small_rest.png`, `${forced}_small_clip.png`));
    const gpu = await page.evaluate(() => Module._web_gpu_bytes());
    await loseAndRestore(page);
    await keep(page, `${forced}_restored.png`);
    check(`${forced}: after a lost context it is the same picture`, same(`${forced}_small_clip.png`, `${forced}_restored.png`));
    check(`${forced}: and the same bytes on the GPU`, await page.evaluate(() => Module._web_gpu_bytes()) === gpu);
    await drawn(page, () => page.selectOption('#clips', { label: 'none' }));
    await drawn(page, () => page.click('#fit'));
    await keep(page, `${forced}_none.png`);
    check(`${forced}: and without the clip it is as it was loaded`, same(`${forced}_none.png`, `${forced}_small_rest.png`));
    check(`${forced}: memory did not grow`, await page.evaluate(() => Module.HEAPU8.length) === state.memory.all);
    await close(page, forced);
}

async function panels(browser) {
    const page = await open(browser, { viewport: { width: 900, height: 500 } }, 'size=0');
    const frames = await page.evaluate(() => window.noh.frames);
    await page.waitForFunction((n) => window.noh.frames > n + 5, frames);
    check('it plays on its own', Number(await page.inputValue('#time')) > 0);
    await drawn(page, () => page.selectOption('#clips', { label: clip }));
    await page.waitForFunction(() => Number(document.getElementById('time').value) > 0.6);
    await slide(page, '#speed', 2);
    await page.click('#play');
    check('and stops when told to', await page.textContent('#play') === 'play');
    const still = await page.inputValue('#time');
    await page.evaluate(() => character.advance(0.3));
    check('and then stands still', await page.inputValue('#time') === still && await page.evaluate(() => !character.runs));
    await page.screenshot({ path: path.join(out, 'page.png') });
    await page.fill('#search', 'smil');
    const seen = await page.locator('#targets label:visible span').allTextContents();
    check('the search leaves what it names', seen.length > 0 && seen.every((name) => name.toLowerCase().includes('smil')), seen.join(' '));
    await keep(page, 'before_turn.png');
    await drawn(page, async () => {
        await page.mouse.move(300, 300);
        await page.mouse.down();
        await page.mouse.move(380, 280);
        await page.mouse.up();
    });
    await keep(page, 'after_turn.png');
    check('a drag turns it', !same('before_turn.png', 'after_turn.png'));
    await drawn(page, () => page.setViewportSize({ width: 900, height: 600 }));
    await page.waitForFunction(() => document.getElementById('canvas').height === 600);
    await close(page, 'panels');
}

const pickAt = (page, x, y) => page.mouse.click(x, y).then(() => page.textContent('#picked'));
const view = (page) => page.evaluate(() => ({ walked: character.walked, eye: Array.from(Module.floats(Module._web_view() + 64, 3)) }));
const reach = (page, seconds) => page.waitForFunction((s) => Number(document.getElementById('time').value) > s, seconds);

async function held(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, `clip=${clip}`);
    await setTarget(page, 'smile', 1.5);
    const ends = () => page.locator('input[data-target="smile"]').evaluate((e) => [e.min, e.max, e.value].join(' '));
    check('held: a target is 0 at the left end, and 1 at the right one', await ends() === '0 1 1', await ends());
    await page.click('#beyond');
    await setTarget(page, 'smile', 1.5);
    const value = () => page.locator('input[data-target="smile"]').inputValue().then(Number);
    await reach(page, 0.6);
    check('held: a clip does not move a slider that is held', await value() === 1.5, await value());
    await drawn(page, () => page.click('#reset'));
    await drawn(page, async () => {});
    check('held: and does after the reset', await value() !== 1.5, await value());
    check('picked: a tap names what is there', /^(mask|body)/.test(await pickAt(page, 316, 350)), await page.textContent('#picked'));
    check('picked: and beside the figure nothing', await pickAt(page, 5, 5) === '');
    const across = await page.evaluate(() => [[300, 300], [400, 300], [300, 400]].map(([x, y]) => character.pixelOf(x, y)));
    const step = [across[1][0] - across[0][0], across[2][1] - across[0][1]];
    check('size: pixels are square on a page that is not', Math.abs(step[0] - step[1]) < 1e-6 && step[0] > 0
        && await page.evaluate(() => getComputedStyle(canvas).objectFit) === 'contain', step.join(' '));
    await close(page, 'held');
}

// A figure that walks is followed, unless the camera is fixed.
async function walks(browser, camera) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, `clip=walk&camera=${camera}`);
    const before = await view(page);
    await page.click('#play');
    await page.evaluate(() => { // some walks in steps that no frame of the page comes between
        character.paused = false;
        for (let i = 0; i < 60; i++) character.step(0.05);
        character.paused = true;
    });
    await drawn(page, () => page.click('#front'));
    const after = await view(page);
    const way = after.walked[2] - before.walked[2], moved = after.eye[2] - before.eye[2];
    check(`camera ${camera}: the figure walks`, way > 1, way);
    check(`camera ${camera}: ${camera === 'fixed' ? 'and leaves the camera behind' : 'with the camera'}`,
        Math.abs(moved - (camera === 'fixed' ? 0 : way)) < 1e-3, moved);
    await page.screenshot({ path: path.join(out, `walk_${camera}.png`) });
    await close(page, `camera ${camera}`);
}

// A face of one clip over the body of another.
async function faces(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, `clip=idle`);
    const weights = () => page.locator('#targets input').evaluateAll((all) => all.map((e) => Number(e.value)));
    await page.click('#play');
    await page.waitForFunction(() => performance.now() > character.busy);
    const before = await weights();
    await page.selectOption('#face', { label: clip });
    await page.click('#play');
    const moves = await page.waitForFunction((all) => [...document.querySelectorAll('#targets input')]
        .some((e, i) => Math.abs(Number(e.value) - all[i]) > 0.05), before).catch(() => null);
    check('face: it moves', moves !== null);
    check('face: the body plays its own clip', await page.evaluate(() => Number(document.getElementById('time').max)) === 4);
    await close(page, 'face');
}

// The shadow of a body falls on the floor, not on nothing: below its middle, and darker than without. Edges of shadows on
// the body itself are a little lighter over a floor, where its depth takes the place of nothing.
async function floors(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, 'clip=none&light=room&background=plain&floor=on');
    const lines = (name) => keep(page, name).then(() => page.evaluate(() => {
        const gl = canvas.getContext('webgl2'), { width, height } = canvas, rgba = new Uint8Array(4 * width * height);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rgba); // the lowest line first
        return Array.from({ length: height }, (_, y) => rgba.subarray(4 * width * y, 4 * width * (y + 1)).reduce((a, b) => a + b, 0));
    }));
    const tell = (what) => drawn(page, () => page.evaluate((w) => character.setLight(w), what));
    const edges = 400, near = (sum, other) => Math.abs(sum - other) <= edges;
    const on = await lines('floor_on.png');
    await tell({ floor: false });
    const off = await lines('floor_off.png'), half = on.length / 2;
    check('floor: the shadow on it is dark', on.every((sum, y) => sum <= off[y] + edges) && on.some((sum, y) => sum < off[y] - 10 * edges));
    check('floor: and lies below', on.every((sum, y) => y < half || near(sum, off[y])));
    await tell({ floor: true });
    await loseAndRestore(page);
    await keep(page, 'floor_again.png');
    check('floor: after a lost context it is the same picture', same('floor_on.png', 'floor_again.png'));
    await drawn(page, () => page.evaluate(() => character.turn(0, -0.6)));
    const below = await lines('floor_below.png');
    await tell({ floor: false });
    const none = await lines('floor_below_off.png');
    check('floor: from below there is none', below.every((sum, y) => near(sum, none[y])));
    await close(page, 'floor');
}

async function bodies(browser) {
    const page = await open(browser, {}, 'clip=none');
    const has = await page.evaluate(() => Module._web_joint_count() > 0);
    check('a face and a camera of its own are offered where there is a body',
        await page.isVisible('#face') === has && await page.isVisible('#follow') === has);
    await close(page, 'bodies');
    if (!has) return;
    await floors(browser);
    for (const camera of ['follow', 'fixed']) await walks(browser, camera);
    await faces(browser);
}

// ---- light ----

async function lights(browser, forced) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, `path=${forced}&clip=none&light=room${isBody ? '&shadow=off' : ''}`); // floors() has the floor of a body
    const budget = async (words) => {
        const m = await page.evaluate(() => window.noh.memory), path = await page.evaluate(() => window.noh.path);
        console.log(`# budget ${path} ${words} ${m.cpu} ${m.gpu}`);
        return m;
    };
    const before = await budget('lit still');
    await keepLarge(page, `${forced}_room.png`);
    await keep(page, `${forced}_small_room.png`);
    const back = async (what) => {
        await keep(page, `${forced}_again.png`);
        check(`light by ${forced}: ${what}, it is the same picture`, same(`${forced}_small_room.png`, `${forced}_again.png`));
    };
    if (forced !== 'auto' || !owns) { // what follows depends neither on path nor on pack
        await close(page, `light by ${forced}`);
        return;
    }
    await lightControls(page, back);
    await loseAndRestore(page);
    await back('after a lost context');
    await setTarget(page, 'smile', 1);
    await choose(page, '#light', 'plain');
    const plain = await budget('plain still');
    check(`light by ${forced}: none of it, and its textures are gone`, plain.gpu < before.gpu - 6e5, plain.gpu);
    check(`light by ${forced}: what was held stays`, await page.locator('input[data-target="smile"]').inputValue() === '1');
    await keep(page, `${forced}_plain_smile.png`);
    check(`light by ${forced}: plain light is the same, whether it was chosen or was there`, same(`${forced}_plain_smile.png`, `${forced}_small_smile.png`));
    await choose(page, '#light', 'studio');
    await drawn(page, () => page.click('#reset'));
    await slide(page, '#rotate', 40);
    await choose(page, '#shadow', 'no shadow');
    await toggle(page, '#tonemap');
    await choose(page, '#background', 'gradient behind');
    await keepLarge(page, `${forced}_studio.png`);
    const after = await budget('lit still');
    check(`light by ${forced}: the same bytes as before`, after.gpu === before.gpu && after.cpu === before.cpu && after.all === before.all);
    await close(page, `light by ${forced}`);
}

async function lightControls(page, back) {
    const moves = async (what, name, act) => {
        await act();
        await keep(page, `auto_${name}.png`);
        check(`light: ${what} shows`, !same('auto_small_room.png', `auto_${name}.png`));
    };
    await moves('a shadow less', 'flat', () => choose(page, '#shadow', 'no shadow'));
    await choose(page, '#shadow', 'shadow');
    await moves('the tone map', 'tones', () => toggle(page, '#tonemap'));
    await toggle(page, '#tonemap');
    await moves('what is behind', 'grey', () => choose(page, '#background', 'grey behind'));
    await choose(page, '#background', 'light behind');
    await moves('a turn', 'turned', () => slide(page, '#rotate', 90));
    await slide(page, '#rotate', 0);
    await moves('another light', 'sky', () => choose(page, '#light', 'sky'));
    await choose(page, '#light', 'room');
    await back('and all of it back');
}

// A frown creases the brow, as far as the slider says.
// A page on a GPU by this name.
const named = (browser, renderer) => ({ newPage: async (options) => {
    const page = await browser.newPage(options);
    await page.addInitScript((name) => {
        const { getParameter } = WebGL2RenderingContext.prototype;
        WebGL2RenderingContext.prototype.getParameter = function named(what) { return what === 0x9246 ? name : getParameter.call(this, what); };
    }, renderer);
    return page;
} });

// How much is computed at each pixel, by the GPU. Its name may be hidden: then by its medium precision.
const gpus = [['ANGLE (ARM, Mali-G52 MC2, OpenGL ES 3.2)', 10, 'phone'], ['Mali-G57 MC2', 10, 'full'], ['Adreno (TM) 610', 10, 'phone'], ['Adreno (TM) 740', 10, 'full'],
    ['Apple GPU', 10, 'full'], ['WebKit WebGL', 10, 'phone'], ['WebKit WebGL', 23, 'full'], ['ANGLE (Intel, Mesa Intel(R) UHD Graphics 620)', 10, 'full']];
async function tiers(browser) {
    const page = await open(named(browser, gpus[0][0]), { viewport: { width: 1000, height: 700 } }, 'clip=none&light=room');
    check('tier: a slow phone gets its own', await page.evaluate(() => character.tier) === 'phone');
    await keepLarge(page, 'tier.png');
    await keep(page, 'small_tier.png');
    const found = await page.evaluate(async (all) => {
        const { tierOf } = await import('./package/gl.js');
        return all.map(([name, precision]) => tierOf({ getExtension: () => ({}), getParameter: () => name, getShaderPrecisionFormat: () => ({ precision }) }, 'auto'));
    }, gpus);
    gpus.forEach(([name, precision, tier], i) => check(`tier: ${name}, medium precision ${precision}: ${tier}`, found[i] === tier, found[i]));
    await close(page, 'tier');
    const full = await open(named(browser, gpus[0][0]), { viewport: { width: 1000, height: 700 } }, 'clip=none&light=room&tier=full');
    check('tier: it can be pinned', await full.evaluate(() => character.tier) === 'full');
    await keep(full, 'small_full.png');
    check('tier: and computes more', !same('small_tier.png', 'small_full.png'));
    await close(full, 'tier full');
}

async function wrinkles(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, `clip=none&light=studio`);
    if (await page.isVisible('#wrinkles')) {
        await setTarget(page, 'browDownLeft', 1);
        await setTarget(page, 'browDownRight', 1);
        await keep(page, 'wrinkled.png');
        await slide(page, '#wrinkles', 0);
        await keep(page, 'smooth.png');
        check('wrinkles: smoothed out by the slider', !same('wrinkled.png', 'smooth.png'));
        await slide(page, '#wrinkles', 1);
        await keep(page, 'wrinkled_again.png');
        check('wrinkles: and back', same('wrinkled.png', 'wrinkled_again.png'));
    }
    await close(page, 'wrinkles');
}

// A drag with shift turns the light; two fingers that go the same way move the picture.
async function turns(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 }, hasTouch: true }, `clip=none&light=room`);
    const turned = () => page.inputValue('#rotate').then(Number);
    await page.keyboard.down('Shift');
    await drawn(page, async () => {
        await page.mouse.move(300, 300);
        await page.mouse.down();
        await page.mouse.move(360, 300);
        await page.mouse.up();
    });
    await page.keyboard.up('Shift');
    check('light: a drag with shift turns it', await turned() === 30, await turned());
    await drawn(page, () => page.evaluate(() => {
        const on = (type, id, x) => canvas.dispatchEvent(new PointerEvent(type, { pointerId: id, clientX: x, clientY: 300, bubbles: true }));
        canvas.setPointerCapture = () => {};
        on('pointerdown', 11, 200);
        on('pointerdown', 12, 400);
        on('pointermove', 11, 240);
        on('pointermove', 12, 440);
        on('pointerup', 11, 240);
        on('pointerup', 12, 440);
    }));
    check('light: two fingers do not', await turned() === 30, await turned());
    const moved = await page.evaluate(() => [character.camera.offset, character.camera.right, character.camera.pixel]);
    const way = moved[0].reduce((sum, o, i) => sum + o * moved[1][i], 0) / moved[2];
    check('two fingers move the picture as far as they go', Math.abs(way + 40) < 1e-3, way);
    await close(page, 'turns');
}

// ---- faces ----

// Wait until one of these targets is above a weight. Returns 1, or 0 if that does not come.
const reaches = (page, weight, ...targets) => page.waitForFunction(([names, w]) => names.some((name) => {
    const e = document.querySelector(`input[data-target="${name}"]`);
    return e && Number(e.value) > w;
}), [targets, weight]).then(() => 1, () => 0);

// Wait until both eyes are turned to one side. A head that turns with them leaves less of it to the eyes.
const looks = (page, side, other) => page.waitForFunction(([s, o]) => {
    const weight = (name) => Number(document.querySelector(`input[data-target="${name}"]`).value);
    return weight(`eyeLookIn${o}`) > weight(`eyeLookIn${s}`) + 0.05;
}, [side, other]).then(() => 1, () => 0);

async function living(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, 'clip=none&alive=on&size=64');
    const state = await page.evaluate(() => window.noh);
    console.log(`# budget ${state.path} plain alive ${state.memory.cpu} ${state.memory.gpu}`);
    check('a face: it is there', await page.isVisible('#alive') && await page.isVisible('#emotion'));
    check('a face: it blinks', await reaches(page, 0.5, 'eyeBlinkLeft') === 1);
    const r = await page.locator('#canvas').boundingBox();
    await page.mouse.move(r.x + r.width * 0.95, r.y + r.height / 2);
    check('a face: it looks to its left', await looks(page, 'Left', 'Right') === 1);
    await page.mouse.move(r.x + r.width * 0.05, r.y + r.height / 2);
    check('a face: and to its right', await looks(page, 'Right', 'Left') === 1);
    await page.selectOption('#emotion', { label: 'joy' });
    check('a face: joy smiles', await reaches(page, 0.3, 'smile', 'mouthSmileLeft') === 1);
    await page.click('#alive');
    await page.selectOption('#emotion', { label: 'no emotion' });
    const frames = await page.evaluate(async () => { // once what was begun is over
        const picture = () => new Promise((resolve) => { requestAnimationFrame(resolve); });
        let drawn = 1;
        for (const end = performance.now() + 300000; drawn && performance.now() < end;) {
            const before = window.noh.frames;
            for (let i = 0; i < 10; i++) await picture();
            drawn = window.noh.frames - before;
        }
        return drawn;
    });
    check('a face: a calm one costs no frames', frames === 0, frames);
    await close(page, 'a face');
}

async function phone(browser) {
    const page = await open(browser, { viewport: { width: 360, height: 640 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true }, `clip=${clip}&alive=on&size=256`);
    await page.waitForFunction(() => Number(document.getElementById('time').value) > 0.6);
    await page.tap('#play');
    const widths = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
    check('a phone: one column, nothing sticks out', widths[0] <= widths[1], widths.join(' of '));
    const small = await page.locator('button:visible, select:visible').evaluateAll((all) => all.filter((e) => e.getBoundingClientRect().height < 36).length);
    check('a phone: what is touched is large enough', small === 0, small);
    const nameless = await page.locator('button, select, input').evaluateAll((all) => all.filter((e) => !(e.getAttribute('aria-label') ||
        (e.labels && [...e.labels].some((l) => l.textContent.trim())) || (e.tagName === 'BUTTON' && e.textContent.trim()))).map((e) => e.id));
    check('a phone: a screen reader has a name for each control', nameless.length === 0, nameless.join(' '));
    const below = () => page.locator('#memory').evaluate((e) => e.getBoundingClientRect().top + window.scrollY);
    const before = await below();
    await page.evaluate(() => document.getElementById('say').requestSubmit());
    await page.waitForFunction(() => document.getElementById('speech-text').textContent.includes('Type a sentence'));
    check('a phone: nothing jumps when words change', await below() === before, `${before} to ${await below()}`);
    await page.screenshot({ path: path.join(out, 'phone.png') });
    await page.evaluate(() => window.scrollTo(0, 600));
    await page.screenshot({ path: path.join(out, 'phone_scrolled.png') });
    await close(page, 'a phone');
}

// The level that is shown once fades are over.
async function settledLevel(page) {
    await page.waitForFunction(() => !Module._web_fades());
    return page.evaluate(() => Module._web_level());
}

async function levels(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, 'clip=none&detail=-1');
    const count = await page.evaluate(() => Module._web_level_count());
    check('detail: offered where there are levels', await page.isVisible('#detail') === count > 1);
    if (count > 1) {
        check('detail: all of them', await page.locator('#detail option').count() === count + 1);
        await drawn(page, () => page.selectOption('#detail', { label: 'level 2' }));
        check('detail: a level on request', await page.evaluate(() => Module._web_level()) === 2);
        await keepLarge(page, 'level.png', 2);
    }
    await close(page, 'detail');
    if (count > 1) await byPixels(browser);
}

async function byPixels(browser) {
    const page = await open(browser, { viewport: { width: 1000, height: 700 } }, 'clip=none&size=512&detail=-1');
    const wheel = (by) => drawn(page, async () => { for (let i = 0; i < 10; i++) await page.mouse.wheel(0, by); });
    check('detail by pixels: near, the full mesh', await settledLevel(page) === 0);
    await page.mouse.move(300, 300);
    await wheel(200);
    const far = await settledLevel(page), error = await page.evaluate(() => Module._web_error_pixels());
    check('detail by pixels: far away, a coarser one', far > 0, far);
    check('detail by pixels: which is off by less than a pixel', error > 0 && error <= 1, error);
    await page.screenshot({ path: path.join(out, 'detail.png') });
    await wheel(-200);
    check('detail by pixels: and back', await settledLevel(page) === 0);
    await close(page, 'detail by pixels');
}

run({
    async paths(browser) { for (const forced of forcedPaths) await onePath(browser, forced); },
    async lights(browser) { for (const forced of forcedPaths) if (forced !== 'mrt') await lights(browser, forced); },
    bodies, living, ...(owns ? { tiers, levels, held, wrinkles, turns, panels, phone } : {}),
});
