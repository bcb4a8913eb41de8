// page.js FOLDER CHROMIUM OUT: the page in headless Chromium on SwiftShader. Loads it, moves sliders,
// searches, plays a clip, loses the context and gets it back; saves canvases as PNG in OUT and tells
// its checks as TAP. Uses playwright-core, found through NODE_PATH.
'use strict';
const fs = require('fs');
const http = require('http');
const path = require('path');
const { chromium } = require('playwright-core');

const [folder, executablePath, out] = process.argv.slice(2);
let told = 0, failures = 0;

function check(name, right, more) {
    told++;
    if (!right) failures++;
    console.log(`${right ? '' : 'not '}ok ${told} - ${name}`);
    if (!right && more !== undefined) console.log(`#   ${more}`);
}

const types = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm' };
const server = http.createServer((request, answer) => {
    const name = path.join(folder, path.basename(new URL(request.url, 'http://localhost').pathname) || 'index.html');
    fs.readFile(name, (error, bytes) => {
        answer.writeHead(error ? 404 : 200, { 'Content-Type': types[path.extname(name)] || 'application/octet-stream' });
        answer.end(error ? '' : bytes);
    });
});

async function save(page, name) {
    const url = await page.evaluate(() => document.getElementById('canvas').toDataURL('image/png'));
    fs.writeFileSync(path.join(out, name), Buffer.from(url.split(',')[1], 'base64'));
}

async function setSlider(page, target, value) {
    const frames = await page.evaluate(() => window.noh.frames);
    await page.locator(`input[data-target="${target}"]`).evaluate((slider, v) => {
        slider.value = v;
        slider.dispatchEvent(new Event('input'));
    }, value);
    await page.waitForFunction((n) => window.noh.frames > n, frames);
}

async function open(browser, forced) {
    const page = await browser.newPage({ viewport: { width: 1000, height: 700 } });
    page.problems = [];
    page.on('pageerror', (error) => page.problems.push(String(error)));
    page.on('console', (message) => { if (message.type() === 'error') page.problems.push(message.text()); });
    await page.goto(`http://localhost:${server.address().port}/index.html?path=${forced}`);
    await page.waitForFunction(() => window.noh.ready || window.noh.error, null, { timeout: 60000 });
    return page;
}

async function loseAndRestore(page) {
    await page.evaluate(() => {
        window.taken = document.getElementById('canvas').getContext('webgl2').getExtension('WEBGL_lose_context');
        window.taken.loseContext();
    });
    await page.waitForFunction(() => window.noh.lost === 1);
    await page.evaluate(() => window.taken.restoreContext());
    await page.waitForFunction(() => window.noh.restored === 1);
}

async function onePath(browser, forced) {
    const page = await open(browser, forced);
    const state = await page.evaluate(() => window.noh);
    check(`${forced}: it loads`, state.ready && !state.error, state.error);
    if (!state.ready) return;
    check(`${forced}: and takes that path`, state.path === (forced === 'auto' ? 'cpu' : forced), state.path);
    if (forced === 'auto') console.log(`# ${state.renderer}; ${JSON.stringify(state.memory)}`);
    check(`${forced}: what noh uses is within what the page was built for`, state.memory['noh uses'] <= state.memory['of it, pack and noh']);
    await save(page, `${forced}_rest.png`);
    await setSlider(page, 'smile', 1);
    await save(page, `${forced}_smile.png`);
    const gpu = await page.evaluate(() => Module._web_gpu_bytes());
    await loseAndRestore(page);
    await save(page, `${forced}_restored.png`);
    const same = (a, b) => fs.readFileSync(path.join(out, a)).equals(fs.readFileSync(path.join(out, b)));
    check(`${forced}: a slider moves the picture`, !same(`${forced}_rest.png`, `${forced}_smile.png`));
    check(`${forced}: after a lost context it is the same picture`, same(`${forced}_smile.png`, `${forced}_restored.png`));
    check(`${forced}: and the same bytes on the GPU`, await page.evaluate(() => Module._web_gpu_bytes()) === gpu);
    await setSlider(page, 'smile', 0);
    await save(page, `${forced}_back.png`);
    check(`${forced}: and the slider still moves it`, same(`${forced}_back.png`, `${forced}_rest.png`));
    if (forced === 'auto') await panels(page, same);
    check(`${forced}: memory did not grow`, await page.evaluate(() => Module.HEAPU8.length) === state.memory['WebAssembly memory']);
    check(`${forced}: the browser has nothing to complain of`, page.problems.length === 0, page.problems.join(' | '));
    await page.close();
}

async function panels(page, same) {
    await page.fill('#search', 'smil');
    const seen = await page.locator('#targets label:visible span').allTextContents();
    check('the search leaves what it names', seen.length > 0 && seen.every((name) => name.toLowerCase().includes('smil')), seen.join(' '));
    await page.screenshot({ path: path.join(out, 'page.png') });
    await page.fill('#search', '');
    const clips = await page.locator('#clips option').count();
    check('clips are listed', clips > 1, clips);
    const frames = await page.evaluate(() => window.noh.frames);
    await page.selectOption('#clips', { label: 'smile' });
    await page.check('#play');
    await page.waitForFunction((n) => window.noh.frames > n + 5, frames);
    await page.uncheck('#play');
    check('and played', Number(await page.inputValue('#time')) > 0);
    const played = await page.evaluate(() => window.noh.frames);
    await page.locator('#time').evaluate((slider) => {
        slider.value = 0.5;
        slider.dispatchEvent(new Event('input'));
    });
    await page.waitForFunction((n) => window.noh.frames > n, played);
    await save(page, 'clip.png');
    check('and a clip moves the picture', !same('clip.png', 'auto_rest.png'));
}

(async () => {
    await new Promise((resolve) => server.listen(0, 'localhost', resolve));
    const browser = await chromium.launch({
        executablePath,
        args: ['--headless', '--no-sandbox', '--disable-gpu', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
            '--disable-background-networking', '--disable-component-update'],
    });
    try {
        for (const forced of ['auto', 'mrt', 'gather']) await onePath(browser, forced);
    } finally {
        await browser.close();
        server.close();
    }
    console.log(`1..${told}`);
    process.exit(failures ? 1 : 0);
})().catch((error) => { console.log(`not ok ${told + 1} - ${error}`); process.exit(1); });
