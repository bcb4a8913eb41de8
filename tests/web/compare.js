// compare.js NOH_FOLDER ASSET THREE_FOLDER CHROMIUM OUT: what a frame costs with noh and with three.js in one browser, in one
// run: the asset with all its targets active and with none, at 512 x 512, with the same fragment shader on both sides.
// Waits for each frame. Prints medians and ratios, and saves both pictures in OUT.
'use strict';
const fs = require('fs');
const path = require('path');
const { serve, launch, save } = require('./browser.js');

const [nohFolder, asset, threeFolder, executablePath, out] = process.argv.slice(2);
const rounds = 30, frames = 6, pictureFrame = 7;

const sorted = (values) => [...values].sort((a, b) => a - b);
const at = (values, share) => sorted(values)[Math.min(values.length - 1, Math.floor(share * values.length))];
const median = (values) => at(values, 0.5);

async function measure(page) {
    const all = [];
    for (let i = 0; i < rounds; i++) all.push(await page.evaluate(([n, f]) => window.compare.round(n, f), [i, frames]));
    const column = (name) => all.map((round) => round[name]);
    const above = (side) => all.map((round) => round[`${side} morphed`] - round[`${side} rest`]);
    return { column, above };
}

const ms = (values) => `${median(values).toFixed(2)} ms (${at(values, 0.25).toFixed(2)} to ${at(values, 0.75).toFixed(2)})`;

function report(about, { column, above }) {
    console.log(`${about.targets} targets active; noh by ${about.path}; three.js r${about.three}; ${about.renderer}`);
    console.log(`median and quartiles of ${rounds} rounds of ${frames} frames     noh                          three.js`);
    const row = (name, values) => console.log(`  ${name.padEnd(36)} ${ms(values('noh')).padEnd(28)} ${ms(values('three'))}`);
    row('frame, unmorphed', (side) => column(`${side} rest`));
    row('frame, all targets', (side) => column(`${side} morphed`));
    row('targets: what that is more', above);
    console.log(`three.js over noh: targets ${(median(above('three')) / median(above('noh'))).toFixed(1)}, ` +
        `whole frame ${(median(column('three morphed')) / median(column('noh morphed'))).toFixed(2)}, ` +
        `unmorphed ${(median(column('three rest')) / median(column('noh rest'))).toFixed(2)}`);
}

async function compare(browser, address, forced) {
    const page = await browser.newPage({ viewport: { width: 1024, height: 512 } });
    page.on('console', (message) => { if (message.type() === 'error') console.log(`# ${message.text()}`); });
    await page.goto(`${address}/web/compare.html?path=${forced}`);
    await page.waitForFunction(() => window.compare, null, { timeout: 60000 });
    const about = await page.evaluate(() => window.compare.about || { error: window.compare.error });
    if (about.error) throw new Error(about.error);
    report(about, await measure(page));
    await page.evaluate((frame) => window.compare.draw(frame, true), pictureFrame);
    await save(page, '#canvas', path.join(out, `noh_${about.path}.png`));
    await save(page, '#three', path.join(out, 'three.png'));
    await page.screenshot({ path: path.join(out, 'side_by_side.png') });
    await page.close();
}

(async () => {
    fs.copyFileSync(asset, path.join(out, 'asset.glb'));
    const root = path.join(__dirname, '../..');
    const { server, address } = await serve({
        '/noh/': nohFolder, '/three/': threeFolder, '/web/': __dirname, '/shaders/': path.join(root, 'shaders_es'), '/': out,
    });
    const browser = await launch(executablePath);
    try {
        for (const forced of ['auto', 'gather']) await compare(browser, address, forced);
    } finally {
        await browser.close();
        server.close();
    }
})().catch((error) => { console.log(String(error)); process.exit(1); });
