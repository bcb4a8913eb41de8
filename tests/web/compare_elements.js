// compare_elements.js NOH_FOLDER ASSET CHROMIUM OUT: the same head as each library draws it by itself, in one browser, with a
// shadow and without: noh's element, three.js, Babylon.js, model-viewer and TalkingHead. Of each: the bytes before its first
// picture as servers send them (with brotli), the heap of the page after it (JavaScript's, arrays outside of it, and WebAssembly's
// memory),
// and a frame of 512 x 512 pixels that is waited for: medians and quartiles, by turns. Saves pictures in OUT.
'use strict';
const fs = require('fs');
const path = require('path');
const { serve, launch, newPage } = require('./browser.js');
const { at, median } = require('./compare_fours.js');

const [nohFolder, asset, executablePath, out] = process.argv.slice(2);
const sides = ['noh', 'three', 'babylon', 'model_viewer', 'talkinghead'];
const turns = Number(process.env.NOH_TURNS || 12), framesATurn = 5;

async function open(browser, address, side, shadow) {
    const page = await newPage(browser, { viewport: { width: 512, height: 512 } }), client = await page.context().newCDPSession(page);
    let bytes = 0;
    await client.send('Network.enable');
    client.on('Network.loadingFinished', ({ encodedDataLength }) => { bytes += encodedDataLength; });
    await page.goto(`${address}/web/compare_elements.html?side=${side}&shadow=${shadow}`);
    await page.waitForFunction(() => window.compare);
    const { error, version, outside } = await page.evaluate(() => window.compare), first = bytes;
    if (error) console.log(`# ${side}: ${error}`);
    if (error) return null;
    await client.send('HeapProfiler.collectGarbage');
    const { usedSize, backingStorageSize = 0 } = await client.send('Runtime.getHeapUsage');
    return { side, page, version, first, heap: usedSize + backingStorageSize + outside, times: [] };
}

async function measure(browser, address, shadow) {
    const all = [];
    for (const side of sides) all.push(await open(browser, address, side, shadow));
    const there = all.filter((one) => one);
    for (let turn = 0; turn <= turns; turn++) {
        for (const one of there) {
            await one.page.bringToFront();
            const times = await one.page.evaluate((n) => Array.from({ length: n }, () => window.compare.frame()), framesATurn);
            if (turn) one.times.push(...times); // the first warms up
        }
    }
    const three = there.find(({ side }) => side === 'three');
    console.log(`shadow ${shadow}                bytes before it  heap after it   frame, ms (quartiles)   over three.js`);
    for (const { side, version, first, heap, times, page } of there) {
        console.log(`  ${version.padEnd(20)} ${first.toLocaleString('en').padStart(14)} ${heap.toLocaleString('en').padStart(14)}   ${median(times).toFixed(1).padStart(6)} (${at(times, 0.25).toFixed(1)}-${at(times, 0.75).toFixed(1)})`.padEnd(78) + (median(times) / median(three.times)).toFixed(2));
        await page.evaluate(() => window.compare.frame());
        await page.screenshot({ path: path.join(out, `element_${side}_${shadow}.png`) });
        await page.close();
    }
}

// Pages that are isolated have a clock of 5 us; others of 100.
const isolated = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };

(async () => {
    fs.copyFileSync(asset, path.join(out, 'asset.glb'));
    const { server, address } = await serve({ '/noh/': nohFolder, '/web/': __dirname, '/': out }, isolated);
    const browser = await launch(executablePath);
    try {
        for (const shadow of ['off', 'on']) await measure(browser, address, shadow);
    } finally {
        await browser.close();
        server.close();
    }
})().catch((error) => { console.log(String(error.stack || error)); process.exit(1); });
