// compare.js NOH_FOLDER ASSET CHROMIUM OUT: what a frame costs with noh, three.js and Babylon.js in one browser, in one
// run, with 2, 6 and all of the asset's targets active and with none, by each of noh's paths; what each takes of the GPU,
// weighs, and needs until its first frame. Rounds fall into six batches; of each the least counts, since whatever else runs
// only adds. Rounds are drawn until the quartiles of the batches are within 10 % of their median, or it says that they are
// not. Saves pictures in OUT.
'use strict';
const fs = require('fs');
const path = require('path');
const zlib = require('zlib');
const { serve, launch, newPage, save } = require('./browser.js');

const [nohFolder, asset, executablePath, out] = process.argv.slice(2);
const sides = ['noh', 'three', 'babylon'], small = 64, large = 512, pictureFrame = 7;
const batches = 6, roundsMin = 12, roundsMax = Number(process.env.NOH_ROUNDS || 60), sampleMs = 40, loads = 5;

const at = (values, share) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];
const median = (values) => at(values, 0.5);
const spread = (values) => (at(values, 0.75) - at(values, 0.25)) / 2 / Math.abs(median(values));
const ms = (values) => `${median(values).toFixed(3)} (${at(values, 0.25).toFixed(3)}-${at(values, 0.75).toFixed(3)})`;
const column = (rounds, side, what) => rounds.map((round) => round[`${side} ${what}`]);
const least = (rounds, side, what) => Array.from({ length: batches }, (_, b) => Math.min(...column(rounds.filter((_, i) => i % batches === b), side, what)));
function above(rounds, side) {
    const rest = least(rounds, side, 'rest');
    return least(rounds, side, 'morphed').map((morphed, b) => morphed - rest[b]);
}

// Rounds, each sample of so many frames that it takes as long for every side.
async function measure(page, active, pixels) {
    await page.evaluate((p) => window.compare.resize(p), pixels);
    const rounds = [], times = Object.fromEntries(sides.map((side) => [side, 8]));
    const round = (n) => page.evaluate(([i, a, t]) => window.compare.round(i, a, t), [n, active, times]);
    const trial = [await round(0), await round(1)];
    for (const side of sides) times[side] = Math.max(4, Math.min(200, Math.round(sampleMs / Math.min(...column(trial, side, 'rest')))));
    while (rounds.length < roundsMin || (rounds.length < roundsMax && sides.some((side) => spread(above(rounds, side)) > 0.1))) rounds.push(await round(rounds.length));
    return rounds;
}

function row(name, rounds, values) {
    const all = sides.map((side) => values(rounds, side)), wide = Math.max(...all.map(spread));
    const ratio = (k) => (median(all[k]) / median(all[0])).toFixed(2);
    const doubt = wide > 0.1 ? `  quartiles within ${Math.round(100 * wide)} %` : '';
    console.log(`  ${name.padEnd(30)} ${all.map((v) => ms(v).padEnd(24)).join('')} ${ratio(1).padStart(6)} ${ratio(2).padStart(6)}${doubt}`);
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
    for (const active of counts) row(`${active} targets, what they add`, await measure(page, active, small), above);
    const rounds = await measure(page, all, large);
    row('frame, unmorphed', rounds, (r, side) => least(r, side, 'rest'));
    row(`frame, ${all} targets`, rounds, (r, side) => least(r, side, 'morphed'));
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

(async () => {
    fs.copyFileSync(asset, path.join(out, 'asset.glb'));
    const { server, address } = await serve({ '/noh/': nohFolder, '/web/': __dirname, '/shaders/': path.join(__dirname, '../../shaders_es'), '/': out });
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
