// festival.js FOLDER CHROMIUM OUT: the crowd's page: it is drawn, goes on, turns by keys, survives a lost context; people
// are where `noh crowd` has them, since the steps are the same. Prints its checks as TAP, and, with NOH_WEB_RATES=1, as
// "#" lines, how many people are drawn at 30 frames a second at 640 x 360 (NOH_WEB_AGENTS=25,100: also the time of a
// frame with 25 and with 100).
'use strict';
const os = require('os');
const path = require('path');
const { out, check, keep, same, faults, run, address } = require('./harness.js');
const { newPage } = require('./browser.js');

async function open(browser, search) {
    const page = await newPage(browser, { viewport: { width: 900, height: 640 } });
    page.problems = [];
    page.on('pageerror', (error) => page.problems.push(String(error)));
    page.on('console', (message) => { if (message.type() === 'error') page.problems.push(message.text()); });
    await page.goto(`${address()}/festival/?${search}`);
    await page.waitForFunction(() => (window.noh.ready && window.noh.frames > 0) || window.noh.error);
    return page;
}

async function close(page, name) {
    check(`${name}: no GL error`, await page.evaluate(() => Module._festival_error_of_gl()) === 0);
    check(`${name}: the browser reports no problem`, page.problems.length === 0, page.problems.join(' | '));
    await page.close();
}

async function crowd(browser) {
    const page = await open(browser, 'agents=40&size=320x180&still=2');
    check('crowd: it is there', await page.evaluate(() => window.noh.error) === '' && await page.evaluate(() => Module._festival_seen()) > 20);
    await keep(page, 'festival_still.png');
    const again = await open(browser, 'agents=40&size=320x180&still=2');
    await keep(again, 'festival_again.png');
    check('crowd: the same picture again', same('festival_still.png', 'festival_again.png'));
    for (const [colorScheme, width, height] of [['dark', 900, 640], ['light', 390, 844]]) {
        await again.emulateMedia({ colorScheme });
        await again.setViewportSize({ width, height });
        const said = await again.locator('aside').innerText();
        check(`crowd: it says how many are seen, and counts no bytes, ${width} x ${height}`, /\d in view/.test(said) && !said.includes('bytes'), said);
        await again.click('summary');
        check(`crowd: until it is asked to, ${width} x ${height}`, /[\d,]{9,} bytes/.test(await again.locator('aside').innerText())
            && await again.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
        const wrong = await faults(again);
        check(`crowd: axe finds nothing, ${colorScheme}, ${width} x ${height}`, wrong.length === 0, wrong.join(' | '));
        await again.screenshot({ path: path.join(out, `festival_${width}.png`) });
        await again.click('summary');
    }
    await close(again, 'crowd, again');
    const frame = async (act) => {
        const frames = await page.evaluate(() => window.noh.frames);
        await act();
        await page.waitForFunction((n) => window.noh.frames > n && !wanted, frames);
    };
    await page.focus('#canvas');
    await frame(() => page.keyboard.press('ArrowLeft'));
    await keep(page, 'festival_turned.png');
    check('crowd: a key turns it', !same('festival_still.png', 'festival_turned.png'));
    await frame(() => page.keyboard.press('Home'));
    await keep(page, 'festival_home.png');
    check('crowd: and home is home', same('festival_still.png', 'festival_home.png'));
    await page.evaluate(() => { window.taken = canvas.getContext('webgl2').getExtension('WEBGL_lose_context'); window.taken.loseContext(); });
    await page.waitForFunction(() => window.noh.lost === 1);
    const restored = page.evaluate(() => window.noh.frames);
    await page.evaluate(() => window.taken.restoreContext());
    await page.waitForFunction((n) => window.noh.restored === 1 && window.noh.frames > n && !wanted, await restored);
    await keep(page, 'festival_restored.png');
    check('crowd: after a lost context it is the same picture', same('festival_still.png', 'festival_restored.png'));
    const before = await page.evaluate(() => [window.noh.steps, window.noh.memory.buffer.byteLength]);
    await page.click('#play');
    await page.waitForFunction((n) => window.noh.steps > n + 10, before[0]);
    check('crowd: it goes on', true);
    check('crowd: its memory does not grow', await page.evaluate(() => window.noh.memory.buffer.byteLength) === before[1]);
    await page.screenshot({ path: path.join(out, 'festival_page.png') });
    await close(page, 'crowd');
}

// What a frame with this crowd takes at 640 x 360, in ms: of processors, by the browser's own clocks, since others may
// use the machine, too; and as it passed.
async function frameOf(browser, agents, frames = 30) {
    const page = await open(browser, `agents=${agents}&size=640x360`), client = await browser.newBrowserCDPSession();
    const read = async () => {
        const { processInfo } = await client.send('SystemInfo.getProcessInfo');
        return { frames: await page.evaluate(() => window.noh.frames), at: Date.now(), cpu: Object.fromEntries(processInfo.map((p) => [p.id, [p.type, p.cpuTime]])) };
    };
    await page.waitForFunction(() => window.noh.frames > 50); // levels have been chosen, and their programs compiled
    const a = await read();
    await page.waitForFunction((n) => window.noh.frames >= n, a.frames + frames);
    const b = await read(), count = b.frames - a.frames, per = (type) => Object.entries(b.cpu).filter(([, p]) => p[0] === type)
        .reduce((sum, [id, p]) => sum + p[1] - (a.cpu[id] ? a.cpu[id][1] : 0), 0) * 1000 / count;
    const told = { agents, page: per('renderer'), gpu: per('GPU'), passed: (b.at - a.at) / count, said: await page.textContent('#said') };
    console.log(`# ${agents} people at 640 x 360: page ${told.page.toFixed(1)} ms, GPU process ${told.gpu.toFixed(1)} ms of CPU time a frame; ${told.passed.toFixed(1)} ms passed; ${told.said}`);
    await page.screenshot({ path: path.join(out, `festival_${agents}.png`) });
    await client.detach();
    await page.close();
    return told;
}

// The most people that are drawn at 30 frames a second, in whole doublings and then by halves, down to one; 0: not even
// one. By processors: the page is one thread, SwiftShader has all cores.
async function rates(browser) {
    if (process.env.NOH_WEB_RATES !== '1') return;
    const cores = os.cpus().length, most = 1000 / 30, holds = ({ page, gpu }) => page <= most && page + gpu <= most * cores;
    let some = 0, many = 1;
    for (const agents of (process.env.NOH_WEB_AGENTS || '').split(',').filter((n) => n)) await frameOf(browser, agents);
    while (many <= 1024 && holds(await frameOf(browser, Math.min(many, 1000)))) [some, many] = [many, many * 2];
    while (many - some > Math.max(1, some >> 3)) {
        const middle = (some + many) >> 1;
        if (holds(await frameOf(browser, middle))) some = middle;
        else many = middle;
    }
    console.log(`# 30 frames a second at 640 x 360, SwiftShader, ${cores} cores: ${some} people`);
}

run({ crowd, rates });
