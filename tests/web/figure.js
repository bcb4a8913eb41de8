// figure.js FOLDER CHROMIUM OUT SIZE: hair, spots under feet, precomputed light and pushes on the page, where its pack has
// them; where it has none, that it says so. Prints its checks as TAP.
'use strict';
const path = require('path');
const { out, check, keep, same, drawn, slide, choose, toggle, open, close, loseAndRestore, run } = require('./harness.js');

const size = process.argv[5];
const wide = { viewport: { width: 1440, height: 900 } };
const shot = (page, name) => page.screenshot({ path: path.join(out, name) });

// Until nothing moves by itself any more.
const still = (page) => page.waitForFunction(() => !character.wanted && performance.now() > character.busy);

// Small: a software rasteriser takes a second and more for each frame with all strips.
async function hair(browser) {
    const page = await open(browser, wide, 'clip=none&size=48&light=studio');
    const has = await page.evaluate(() => Module._web_has_hair()) === 1;
    check('hair: offered where there is some', await page.isVisible('#hair') === has);
    if (has) await wig(page);
    await close(page, 'hair');
    if (has) return;
    const asked = await open(browser, wide, 'wind=3');
    check('hair: a pack without says so', (await asked.textContent('#message')).includes('no hair'));
    await close(asked, 'no hair');
}

async function wig(page) {
    await still(page);
    const memory = await page.evaluate(() => window.noh.memory);
    console.log(`# budget ${await page.evaluate(() => window.noh.path)} lit still ${memory.cpu} ${memory.gpu}`);
    await keep(page, 'wig.png');
    await toggle(page, '#hair');
    await keep(page, 'bald.png');
    check('hair: a switch leaves it out', !same('wig.png', 'bald.png'));
    await loseAndRestore(page);
    await keep(page, 'bald_restored.png');
    check('hair: what is below it is the same after a lost context', same('bald.png', 'bald_restored.png'));
    await toggle(page, '#hair');
    await still(page);
    await keep(page, 'wig_restored.png');
    check('hair: and it is there again', !same('bald.png', 'wig_restored.png'));
    await shot(page, 'wig_page.png');
    await slide(page, '#wind', 6);
    await page.waitForFunction((n) => window.noh.frames > n + 8, await page.evaluate(() => window.noh.frames));
    await keep(page, 'wig_wind.png');
    check('hair: wind moves it', !same('wig.png', 'wig_wind.png'));
    await slide(page, '#wind', 0);
    await still(page);
    await page.click('#shake');
    const turned = await page.waitForFunction(() => Math.abs(Module._web_shaken()) > 0.1).then(() => 1, () => 0);
    await keep(page, 'wig_shaken.png');
    check('hair: a head is shaken', turned === 1);
    await page.waitForFunction(() => !Module._web_shakes());
    await still(page);
    check('hair: and comes back', Math.abs(await page.evaluate(() => Module._web_shaken())) < 1e-3);
    await choose(page, '#light', 'plain');
    await choose(page, '#light', 'studio');
    check('hair: no byte more by another light', await page.evaluate(() => Module._web_gpu_bytes()) === memory.gpu);
}

async function spots(browser) {
    const page = await open(browser, wide, `clip=none&size=${size}&light=room&shadow=blob`);
    if (await page.isVisible('#hair')) await toggle(page, '#hair'); // it has a life of its own
    await keep(page, 'spots.png');
    await choose(page, '#shadow', 'no shadow');
    await keep(page, 'no_spots.png');
    check('spots: they are there', !same('spots.png', 'no_spots.png'));
    await choose(page, '#shadow', 'soft spots');
    await loseAndRestore(page);
    await keep(page, 'spots_restored.png');
    check('spots: after a lost context it is the same picture', same('spots.png', 'spots_restored.png'));
    await shot(page, 'spots_page.png');
    await close(page, 'spots');
}

async function transfer(browser) {
    const page = await open(browser, wide, `clip=none&size=${size}&light=room&transfer=off`);
    const has = await page.evaluate(() => Module._web_has_transfer()) === 1;
    check('precomputed light: offered where there is some', await page.isVisible('#transfer') === has);
    check('precomputed light: a pack without says so', has || (await page.textContent('#message')).includes('no precomputed light'));
    if (has) {
        const gpu = () => page.evaluate(() => Module._web_gpu_bytes());
        const less = await gpu();
        await keep(page, 'transfer_off.png');
        await toggle(page, '#transfer');
        await keep(page, 'transfer_on.png');
        check('precomputed light: it shows', !same('transfer_on.png', 'transfer_off.png'));
        check('precomputed light: and has bytes of its own', await gpu() > less, `${less} to ${await gpu()}`);
        await toggle(page, '#transfer');
        await keep(page, 'transfer_again.png');
        check('precomputed light: and back', same('transfer_off.png', 'transfer_again.png') && await gpu() === less);
    }
    await close(page, 'precomputed light');
}

// Until the number of figures that fell is so.
const fallen = (page, count) => page.waitForFunction((n) => character.fallen === n, count).then(() => 1, () => 0);

async function pushes(browser) {
    const page = await open(browser, wide, 'light=room&size=256');
    const why = await page.evaluate(() => Module.words(Module._web_cannot_fall()));
    check('push: offered where there are joints', await page.isVisible('#push') === await page.evaluate(() => Module._web_joint_count() > 0));
    if (await page.isVisible('#push')) {
        await page.click('#push');
        if (why) {
            check('push: who cannot fall says why', (await page.textContent('#push-text')).includes(why));
        } else {
            await falls(page, 'the button');
            const r = await page.locator('#canvas').boundingBox();
            await page.keyboard.down('Alt');
            await page.mouse.click(r.x + r.width / 2, r.y + r.height * 0.45);
            await page.keyboard.up('Alt');
            await falls(page, 'a click with Alt');
        }
    } else {
        check('push: a pack without says why', why.length > 0);
    }
    await close(page, 'push');
}

async function falls(page, by) {
    check(`push by ${by}: it falls`, await fallen(page, 1) === 1);
    await page.waitForFunction((n) => window.noh.frames > n + 12, await page.evaluate(() => window.noh.frames));
    await shot(page, 'fall.png');
    check(`push by ${by}: it gets up`, await fallen(page, 0) === 1);
    const frames = await page.evaluate(() => window.noh.frames);
    await page.waitForFunction((n) => window.noh.frames > n + 10, frames);
    check(`push by ${by}: and goes on with its clip`, await page.evaluate(() => character.playing[0].clip === null || character.time > 0));
    await drawn(page, () => page.click('#fit'));
    await shot(page, 'got_up.png');
}

async function small(browser) {
    const page = await open(browser, { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true }, 'clip=none&light=studio&size=256');
    const widths = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
    check('a small page: nothing sticks out', widths[0] <= widths[1], widths.join(' of '));
    await shot(page, 'small.png');
    await page.evaluate(() => window.scrollTo(0, 500));
    await shot(page, 'small_scrolled.png');
    await close(page, 'a small page');
}

run({ hair, spots, transfer, pushes, small });
