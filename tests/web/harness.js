// harness.js: what the tests of the page share: checks as TAP, a page that is opened, drawn, closed, loses its context.
// NOH_WEB_ONLY=lights,held runs these parts alone.
'use strict';
const fs = require('fs');
const path = require('path');
const { serve, launch, newPage, save, slowly, unprepared } = require('./browser.js');

const [folder, executablePath, out] = process.argv.slice(2);
let told = 0, failures = 0, address = '';

function check(name, right, more) {
    told++;
    if (!right) failures++;
    console.log(`${right ? '' : 'not '}ok ${told} - ${name}`);
    if (more !== undefined && (!right || process.env.NOH_WEB_VALUES)) console.log(`#   ${more}`);
}

const keep = (page, name) => save(page, '#canvas', path.join(out, name));
const same = (a, b) => fs.readFileSync(path.join(out, a)).equals(fs.readFileSync(path.join(out, b)));

// Act, and wait until the page has drawn the result: the frame that is due after the act. A page that is busy with what
// came before draws others in between.
async function drawn(page, act) {
    const frames = await page.evaluate(() => window.noh.frames);
    await act();
    const due = await page.evaluate(() => window.noh.due);
    await page.waitForFunction((n) => window.noh.frames >= n, Math.max(due, frames + 1));
}

const slide = (page, selector, value) => drawn(page, () => page.locator(selector).evaluate((slider, v) => {
    slider.value = v;
    slider.dispatchEvent(new Event('input'));
}, value));
const setTarget = (page, target, value) => slide(page, `input[data-target="${target}"]`, value);

// In plain light, without faces that live, without a shadow on the floor, as `noh render` has it, and with all panels,
// unless the search says otherwise; in a small picture at a coarse level, since a software rasteriser pays for each pixel
// and triangle; of the pack as it is, which opens one stage and not two (load.js has the wire form).
const asTested = { pack: 'page.noh', light: 'plain', floor: 'off', alive: 'off', tab: 'all', size: 192, detail: 3, pixels: 'all' };
async function open(browser, options, search) {
    const asked = new URLSearchParams(search);
    for (const [name, value] of Object.entries(asTested)) if (!asked.has(name)) asked.set(name, value);
    const page = await newPage(browser, options);
    await slowly(page);
    await unprepared(page);
    page.problems = [];
    page.on('pageerror', (error) => page.problems.push(String(error)));
    page.on('console', (message) => { if (message.type() === 'error') page.problems.push(message.text()); });
    await page.goto(`${address}/?${asked}`);
    await page.waitForFunction(() => window.noh.whole || window.noh.error);
    return page;
}

async function close(page, name) {
    check(`${name}: no GL error`, await page.evaluate(() => Module._web_check()) === 0);
    check(`${name}: the browser reports no problem`, page.problems.length === 0, page.problems.join(' | '));
    await page.close();
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

// What axe finds wrong in a page, or in a part of it.
async function faults(page, part) {
    await page.evaluate(fs.readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8'));
    return page.evaluate((selector) => window.axe.run(selector || document).then((r) => r.violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target).join(' ')}`)), part || '');
}

const choose = (page, selector, label) => drawn(page, () => page.selectOption(selector, { label }));
const toggle = (page, selector) => drawn(page, () => page.click(selector));

// CPU seconds of the browser's processes so far, those that have ended included, and of node, with NOH_WEB_TIMES=1.
async function spent(browser) {
    if (process.env.NOH_WEB_TIMES !== '1') return null;
    const client = await browser.newBrowserCDPSession(), { processInfo } = await client.send('SystemInfo.getProcessInfo'), { user, system } = process.cpuUsage(), all = new Map();
    await client.detach();
    for (const id of fs.readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
        try {
            const fields = fs.readFileSync(`/proc/${id}/stat`, 'utf8').replace(/.*\) /, '').split(' ').map(Number); // from the third on
            all.set(Number(id), { parent: fields[1], seconds: fields.slice(11, 15).reduce((a, b) => a + b) / 100 });
        } catch { /* has ended */ }
    }
    const { id: root } = processInfo.find(({ type }) => type === 'browser'), isOf = (id) => id === root || (all.has(id) && isOf(all.get(id).parent));
    return { browser: [...all].reduce((sum, [id, { seconds }]) => sum + (isOf(id) ? seconds : 0), 0), node: (user + system) / 1e6,
        GPU: processInfo.reduce((sum, { type, cpuTime }) => sum + (type === 'GPU' ? cpuTime : 0), 0) };
}

function tell(name, seconds, before, after) {
    const took = (what) => (after[what] - before[what]).toFixed(1);
    console.log(`# ${path.basename(folder)} ${name}: ${seconds.toFixed(1)} s; of processors: browser ${took('browser')}, of it GPU ${took('GPU')}; node ${took('node')}`);
}

// { name: async (browser) => ... }, run one after another. flags: of the browser's command line; places: served with
// the page; start: opens another browser than Chromium.
async function main(parts, flags, places, start = launch) {
    const served = await serve({ ...places, '/': folder });
    address = served.address;
    const browser = await start(executablePath, flags);
    const only = (process.env.NOH_WEB_ONLY || '').split(',').filter((name) => name);
    try {
        for (const name of Object.keys(parts)) {
            if (only.length && !only.includes(name)) continue;
            const begin = Date.now(), before = await spent(browser);
            await parts[name](browser);
            if (before) await tell(name, (Date.now() - begin) / 1000, before, await spent(browser));
        }
    } finally {
        await browser.close();
        served.server.close();
    }
    console.log(`1..${told}`);
}

const run = (...given) => main(...given).then(() => process.exit(failures ? 1 : 0))
    .catch((error) => { console.log(`not ok ${told + 1} - ${error}`); process.exit(1); });

module.exports = { folder, out, check, keep, same, drawn, slide, setTarget, choose, toggle, open, close, loseAndRestore, faults, run, address: () => address };
