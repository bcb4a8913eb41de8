// compare.js NOH_FOLDER ASSET CHROMIUM OUT: what a frame costs with noh, three.js and Babylon.js in one browser, in one
// run, with 2, 6 and all of the asset's targets active and with none, by each of noh's paths; what each takes of the GPU,
// weighs, and needs until its first frame. Saves pictures in OUT.
//
// Frames are measured in fours (compare_fours.js), of each side until its quartiles are within 10 % of its median, for
// NOH_SECONDS at most (240) in a row; the widest are printed, and how many fours were left out.
'use strict';
const fs = require('fs');
const path = require('path');
const zlib = require('zlib');
const { serve, launch, newPage, save } = require('./browser.js');
const { restOf, morphedOf, addedOf, at, median, spread, quiet, inBatches, isSettled, enough } = require('./compare_fours.js');

const [nohFolder, asset, executablePath, out] = process.argv.slice(2);
const sides = ['noh', 'three', 'babylon'], small = 64, large = 512, pictureFrame = 7;
const turnMs = 1000, secondsMax = Number(process.env.NOH_SECONDS || 240), loads = 5;

const ms = (values) => `${median(values).toFixed(3)} (${at(values, 0.25).toFixed(3)}-${at(values, 0.75).toFixed(3)})`;

// Fours of each side, by turns, until what is asked of them is settled; a side that is settled is left alone.
async function measure(page, active, pixels, ...kinds) {
    await page.evaluate((p) => window.compare.resize(p), pixels);
    const all = Object.fromEntries(sides.map((side) => [side, []])), turn = (asked) => page.evaluate((given) => window.compare.measure(...given), [asked, active, turnMs]);
    await turn(sides); // warms up: not counted
    const end = Date.now() + 1000 * secondsMax;
    for (let asked = sides; asked.length && Date.now() < end; asked = sides.filter((side) => !isSettled(all[side], kinds))) {
        for (const [side, fours] of Object.entries(await turn(asked))) all[side].push(...fours);
    }
    return all;
}

function row(name, all, kind) {
    const values = sides.map((side) => inBatches(all[side], kind)), wide = Math.max(...values.map(spread));
    const ratio = (k) => (median(values[k]) / median(values[0])).toFixed(2);
    const left = sides.reduce((sum, side) => sum + quiet(all[side]).length, 0), whole = sides.reduce((sum, side) => sum + all[side].length, 0);
    const doubt = `  quartiles within ${Math.ceil(100 * wide)} %, ${Math.round(100 * (1 - left / whole))} % left out${left < enough * sides.length ? ', few are left' : ''}`;
    console.log(`  ${name.padEnd(30)} ${values.map((v) => ms(v).padEnd(24)).join('')} ${ratio(1).padStart(6)} ${ratio(2).padStart(6)}${doubt}`);
}

async function compare(browser, address, forced) {
    const page = await newPage(browser, { viewport: { width: 1536, height: 512 } });
    page.on('console', (message) => { if (message.type() === 'error') console.log(`# ${message.text()}`); });
    await page.goto(`${address}/web/compare.html?path=${forced}`);
    await page.waitForFunction(() => window.compare);
    const { about, error } = await page.evaluate(() => ({ about: window.compare.about, error: window.compare.error }));
    if (error) throw new Error(error);
    fs.writeFileSync(path.join(out, 'known.json'), JSON.stringify(about));
    const all = about.names.length, counts = [2, 6].filter((n) => n < all).concat(all);
    console.log(`${about.versions.join(', ')}; ${about.renderer}`);
    console.log(`  ms, median (quartiles)         ${sides.map((side) => side.padEnd(24)).join('')}  three Babylon, over noh`);
    for (const active of counts) row(`${active} targets, what they add`, await measure(page, active, small, addedOf), addedOf);
    const frames = await measure(page, all, large, restOf, morphedOf);
    row('frame, unmorphed', frames, restOf);
    row(`frame, ${all} targets`, frames, morphedOf);
    const bytes = await page.evaluate(() => window.compare.bytes());
    console.log(`  ${'bytes of the GPU'.padEnd(30)} ${sides.map((side) => bytes[side].toLocaleString('en').padEnd(24)).join('')}`);
    await page.evaluate(([a, f]) => window.compare.draw(a, f), [all, pictureFrame]);
    await save(page, '#canvas', path.join(out, `noh_${forced}.png`));
    for (const side of sides.slice(1)) await save(page, `#${side}`, path.join(out, `${side}.png`));
    await page.screenshot({ path: path.join(out, 'side_by_side.png') });
    await page.close();
}

// What each side needs: program and asset, as a server sends them.
function downloads() {
    const gzip = (file) => zlib.gzipSync(fs.readFileSync(file), { level: 9 }).length, whole = (file) => fs.statSync(file).size;
    const glb = gzip(path.join(out, 'asset.glb')), inside = path.join(nohFolder, 'package');
    const program = fs.readdirSync(inside).filter((name) => /\.(js|wasm)$/.test(name)).reduce((sum, name) => sum + gzip(path.join(inside, name)), 0);
    const all = { noh: [program, whole(path.join(nohFolder, 'page.nohz'))] };
    for (const side of sides.slice(1)) all[side] = [gzip(path.join(out, `${side}.js`)), glb];
    console.log(`  ${'download, bytes with gzip'.padEnd(30)} ${sides.map((side) => (all[side][0] + all[side][1]).toLocaleString('en').padEnd(24)).join('')}`);
    console.log(`  ${'  program and asset'.padEnd(30)} ${sides.map((side) => all[side].map((n) => n.toLocaleString('en')).join(' + ').padEnd(24)).join('')}`);
}

// Each in a page of its own, by turns.
async function firstFrames(browser, address) {
    const times = Object.fromEntries(sides.map((side) => [side, []]));
    for (let i = 0; i < loads * sides.length; i++) {
        const side = sides[i % sides.length], page = await newPage(browser);
        await page.goto(`${address}/web/compare.html?side=${side}`);
        await page.waitForFunction(() => window.compare);
        const { first, error } = await page.evaluate(() => window.compare);
        if (error) throw new Error(error);
        times[side].push(first);
        await page.close();
    }
    console.log(`  ${'first frame after, ms'.padEnd(30)} ${sides.map((side) => `${Math.round(median(times[side]))} (${Math.round(at(times[side], 0.25))}-${Math.round(at(times[side], 0.75))})`.padEnd(24)).join('')}`);
}

// Pages that are isolated have a clock of 5 us; others of 100.
const isolated = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };

(async () => {
    fs.copyFileSync(asset, path.join(out, 'asset.glb'));
    const { server, address } = await serve({ '/noh/': nohFolder, '/web/': __dirname, '/shaders/': path.join(__dirname, '../../shaders_es'), '/': out }, isolated);
    const browser = await launch(executablePath);
    try {
        for (const forced of (process.env.NOH_PATHS || 'mrt,gather,cpu').split(',')) await compare(browser, address, forced);
        downloads();
        await firstFrames(browser, address);
    } finally {
        await browser.close();
        server.close();
    }
})().catch((error) => { console.log(String(error.stack || error)); process.exit(1); });
