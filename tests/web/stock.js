// stock.js FOLDER BROWSER OUT: the page and the element in a stock browser: Firefox, which puppeteer drives by WebDriver
// BiDi, or MiniBrowser of WebKitGTK, by WebDriver (webdriver.js): a face is drawn, a weight changes the picture, a lost context
// comes back with the same picture, and nothing is complained about (which WebDriver does not tell). Needs a display: without
// one Firefox has no WebGL on a software rasteriser. Prints its checks as TAP.
'use strict';
const path = require('path');
const { out, check, keep, same, run, address } = require('./harness.js');

const patienceMs = 300000;

const isWebKit = path.basename(process.argv[3]) === 'MiniBrowser', is = isWebKit ? 'webkit' : 'firefox';

const launch = (executablePath) => (isWebKit
    ? require('./webdriver.js').launch('WebKitWebDriver', { 'webkitgtk:browserOptions': { binary: executablePath, args: ['--automation'] }, timeouts: { script: patienceMs, pageLoad: patienceMs } })
    : require('puppeteer-core').launch({
        browser: 'firefox', executablePath, headless: false, protocolTimeout: patienceMs, timeout: patienceMs,
        extraPrefsFirefox: { 'webgl.disabled': false, 'webgl.force-enabled': true },
    }));

async function open(browser, name) {
    const page = await browser.newPage();
    page.setDefaultTimeout(patienceMs);
    page.problems = [];
    page.on('pageerror', (error) => page.problems.push(String(error)));
    page.on('console', (message) => { if (message.type() === 'error') page.problems.push(message.text()); });
    await page.setViewport({ width: 900, height: 600 });
    await page.goto(`${address()}${name}`);
    return page;
}

async function close(page, name) {
    if (!isWebKit) check(`${name}: the browser reports no problem`, page.problems.length === 0, page.problems.join(' | '));
    await page.close();
}

const until = (page, call, ...given) => page.waitForFunction(call, { timeout: patienceMs }, ...given);

// Act, and wait for the frame that is due after it.
async function drawn(page, act) {
    const frames = await page.evaluate(() => window.noh.frames);
    await page.evaluate(act);
    await until(page, (n) => window.noh.frames >= Math.max(n, window.noh.due), frames + 1);
}

// The share of a canvas that is not as its upper left corner is.
const filled = (page, find) => page.evaluate((how) => {
    const source = new Function(`return ${how}`)(), to = document.createElement('canvas');
    const { width, height } = Object.assign(to, { width: source.width, height: source.height }), context = to.getContext('2d');
    context.drawImage(source, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    let other = 0;
    for (let i = 0; i < data.length; i += 4) other += [0, 1, 2].some((c) => Math.abs(data[i + c] - data[c]) > 40);
    return other / (width * height);
}, find);

async function page(browser) {
    const shown = await open(browser, '/?tab=all&clip=none&alive=off&light=studio&background=plain&size=256');
    await until(shown, () => window.noh.whole || window.noh.error);
    const state = await shown.evaluate(() => ({ error: window.noh.error, renderer: window.noh.renderer, path: window.noh.path }));
    console.log(`# ${await browser.version()}, ${state.renderer}, path ${state.path}`);
    check('page: it loads', state.error === '', state.error);
    const share = await filled(shown, 'canvas');
    check('page: a face is drawn', share > 0.2 && share < 0.9, share);
    await keep(shown, `${is}_rest.png`);
    await drawn(shown, () => character.setWeight('smile', 1));
    await keep(shown, `${is}_smile.png`);
    check('page: a weight changes the picture', !same(`${is}_rest.png`, `${is}_smile.png`));
    await shown.evaluate(() => {
        window.taken = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
        window.taken.loseContext();
    });
    await until(shown, () => window.noh.lost === 1);
    await shown.evaluate(() => window.taken.restoreContext());
    await until(shown, () => window.noh.restored === 1);
    await drawn(shown, () => character.redraw());
    await keep(shown, `${is}_restored.png`);
    check('page: after a lost context it is the same picture', same(`${is}_smile.png`, `${is}_restored.png`));
    await drawn(shown, () => character.releaseWeights());
    await keep(shown, `${is}_back.png`);
    check('page: and a weight that is let go goes back', same(`${is}_rest.png`, `${is}_back.png`));
    check('page: no GL error', await shown.evaluate(() => Module._web_check()) === 0);
    check('page: its memory cannot grow', await shown.evaluate(() => { try { Module.memory.grow(1); return false; } catch { return true; } }));
    await shown.screenshot({ path: path.join(out, `${is}_page.png`) });
    await close(shown, 'page');
}

const html = `<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>test</title><link rel="icon" href="data:,">
<style>noh-character { width: 200px; height: 200px }</style><script type="module" src="package/index.js"></script>
<main><noh-character id="face" src="page.nohz" light="plain" camera-orbit auto-life></noh-character></main></html>`;

async function element(browser) {
    const shown = await open(browser, '/element.html');
    await until(shown, () => { const e = document.getElementById('face'); return e.whole || e.error; });
    check('element: it loads', await shown.evaluate(() => document.getElementById('face').error) === '');
    const share = await filled(shown, 'document.getElementById("face").character.canvas');
    check('element: a face is drawn', share > 0.1 && share < 0.9, share);
    const blinks = await until(shown, () => document.getElementById('face').weight('eyeBlinkLeft') > 0.5).then(() => true, () => false);
    check('element: it blinks', blinks);
    await shown.screenshot({ path: path.join(out, `${is}_element.png`) });
    await shown.evaluate(() => document.getElementById('face').remove());
    await until(shown, () => !document.querySelector('noh-character'));
    await close(shown, 'element');
}

run({ page, element }, [], { '/element.html': (request, answer) => answer.writeHead(200, { 'Content-Type': 'text/html' }).end(html) }, launch);
