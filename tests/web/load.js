// load.js FOLDER CHROMIUM OUT: the page while its pack arrives: what it shows first, what it says when the pack is cut
// short, damaged or missing, and, as "#" lines, how long it takes by 1.6 Mbit/s and 150 ms. Prints its checks as TAP.
'use strict';
const fs = require('fs');
const path = require('path');
const { folder, out, check, keep, same, drawn, setTarget, open, close, run, address } = require('./harness.js');
const { wire, newPage, unprepared } = require('./browser.js');

const wide = { viewport: { width: 1440, height: 900 } };
const sent = fs.readFileSync(path.join(folder, 'page.nohz'));
const images = sent.readUInt32LE(16); // of the file's head: 2 where the coarsest levels come first
const view = `clip=none&size=256${images > 1 ? '' : '&hair=off'}`; // hair swings: no two pictures of it are the same
let release = null;

// All but the end, which comes when the test says so.
function heldBack(request, answer) {
    answer.writeHead(200, { 'Content-Type': 'application/octet-stream', 'Content-Length': sent.length });
    answer.write(sent.subarray(0, sent.length - 1000));
    release = () => answer.end(sent.subarray(sent.length - 1000));
}
const cut = (request, answer) => answer.end(sent.subarray(0, sent.length >> 1));
function flipped(request, answer) {
    const bytes = Buffer.from(sent);
    bytes[bytes.length >> 1] ^= 16;
    answer.end(bytes);
}

async function arrives(browser) {
    const plain = await open(browser, wide, `${view}&detail=0&pack=page.noh`);
    check('the pack as it is: it loads', await plain.evaluate(() => window.noh.whole && !window.noh.error));
    await drawn(plain, () => setTarget(plain, 'smile', 1));
    await keep(plain, 'as_it_is.png');
    await close(plain, 'the pack as it is');
    const page = await newPage(browser, wide);
    await unprepared(page);
    page.problems = [];
    page.on('pageerror', (error) => page.problems.push(String(error)));
    await page.goto(`${address()}/?${view}&detail=0&light=plain&alive=off&tab=all&pack=held`);
    if (images > 1) {
        await page.waitForFunction(() => window.noh.ready || window.noh.error);
        check('the wire form: its coarsest levels are shown while the end is not there', await page.evaluate(() => window.noh.ready && !window.noh.whole));
        check('the wire form: and it says so', (await page.textContent('#progress-text')).startsWith('finer detail') && await page.isVisible('#progress-bar'));
        check('the wire form: there is one level', await page.evaluate(() => Module._web_level_count()) === 1);
        await setTarget(page, 'smile', 1);
        await keep(page, 'coarse.png');
        await page.screenshot({ path: path.join(out, 'coarse_page.png') });
    } else {
        await page.waitForFunction(() => document.getElementById('progress-text').textContent.startsWith('loading:'));
        check('the wire form: nothing is shown before its end', await page.evaluate(() => !window.noh.ready));
    }
    release();
    await page.waitForFunction(() => window.noh.whole || window.noh.error);
    check('the wire form: then all of it', await page.evaluate(() => window.noh.error) === '' && !await page.isVisible('#progress'));
    if (images > 1) {
        check('the wire form: what was held stays', await page.inputValue('input[data-target="smile"]') === '1');
        check('the wire form: all levels are there', await page.evaluate(() => Module._web_level_count()) > 1 && await page.locator('#detail option').count() > 3);
        await drawn(page, () => page.selectOption('#detail', '0'));
    } else {
        await setTarget(page, 'smile', 1);
    }
    await drawn(page, () => page.click('#fit'));
    await keep(page, 'by_wire.png');
    check('the wire form: the picture of the pack as it is', same('as_it_is.png', 'by_wire.png'));
    if (images > 1) check('the wire form: which is finer than the first', !same('coarse.png', 'by_wire.png'));
    await close(page, 'the wire form');
}

async function refused(browser) {
    for (const [pack, words] of [['cut', 'cut short'], ['flipped', 'damaged'], ['none.nohz', '404'], ['page.js', 'not']]) {
        const page = await newPage(browser);
        await page.goto(`${address()}/?pack=${pack}`);
        await page.waitForFunction(() => window.noh.error);
        const said = await page.textContent('#message');
        check(`a pack that is ${pack}: it says so`, said.includes(words) && await page.evaluate(() => !window.noh.whole), said);
        check(`a pack that is ${pack}: it can be tried again`, await page.isVisible('#again') && !await page.isVisible('#progress'));
        if (pack === 'none.nohz') await page.screenshot({ path: path.join(out, 'refused_page.png') });
        await page.close();
    }
    const page = await newPage(browser); // sentences of errors are a file of their own
    await page.route('**/*.txt', (route) => route.abort());
    await page.goto(`${address()}/?pack=flipped`);
    await page.waitForFunction(() => window.noh.error);
    check('a damaged pack, and no sentences: it has a number', /error \d+ of the program/.test(await page.textContent('#message')), await page.textContent('#message'));
    await page.close();
}

// A visitor's own file, chosen and dropped; one that is no pack or is broken leaves the page as it was.
async function own(browser) {
    const page = await open(browser, wide, `${view}&detail=0`), raw = path.join(folder, 'page.noh');
    await keep(page, 'before_own.png');
    const said = () => page.textContent('#message');
    const give = async (name, buffer, words) => {
        await page.setInputFiles('#file', { name, mimeType: 'application/octet-stream', buffer });
        await page.waitForFunction((w) => window.noh.whole && !opening && document.getElementById('message').textContent.includes(w), words);
    };
    const shown = async (what, picture) => {
        if (await page.isVisible('#detail')) await drawn(page, () => page.selectOption('#detail', '0'));
        await drawn(page, () => page.click('#fit'));
        await keep(page, picture);
        check(`a file of one's own: ${what}`, same('before_own.png', picture), await said());
    };
    await give('face.noh', fs.readFileSync(raw), '');
    check('a file of one\'s own: it is named', await page.textContent('#file-text') === 'face.noh');
    await shown('a pack as it is', 'own_plain.png');
    const clips = await page.locator('#clips option').count();
    await page.evaluate(async () => {
        const bytes = await (await fetch('page.nohz')).arrayBuffer(), data = new DataTransfer();
        data.items.add(new File([bytes], 'dropped.nohz'));
        document.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    });
    await page.waitForFunction(() => document.getElementById('file-text').textContent === 'dropped.nohz');
    await shown('a wire form that is dropped', 'own_wire.png');
    check('a file of one\'s own: clips are listed once', await page.locator('#clips option').count() === clips);
    const bad = fs.readFileSync(raw);
    bad[bad.length >> 1] ^= 16;
    for (const [name, buffer, words] of [['a.txt', Buffer.from('glTF'), 'none of'], ['a.bvh', Buffer.from('HIERARCHY'), 'motion alone'], ['a.csv', Buffer.from('Time,JawOpen'), 'motion alone'], ['bad.noh', bad, 'cannot be shown'], ['short.noh', bad.subarray(0, 3), 'no pack'],
        ['cut.nohz', sent.subarray(0, sent.length >> 1), 'cut short'], ['large.noh', Buffer.alloc(9e6), 'cannot be shown']]) {
        await give(name, buffer, words);
        check(`a file of one's own, ${name}: it says what is wrong`, (await said()).startsWith(`${name} cannot be shown: `), await said());
        await shown(`after ${name} a pack is there`, 'own_again.png');
    }
    const named = await page.textContent('#file-text');
    check('a file of one\'s own: what is shown is named', images > 1 ? named.startsWith('or drop') : named === 'dropped.nohz', named);
    await page.screenshot({ path: path.join(out, 'own_page.png') });
    await close(page, 'a file of one\'s own');
}

// By a slow network, in milliseconds since the page was asked for, and what had come by then.
async function slow(browser) {
    wire.quality = 11;
    const page = await newPage(browser, wide), client = await page.context().newCDPSession(page);
    let bytes = 0, rest = 0; // rest: of them, what is asked for after the first picture
    const later = new Set();
    await unprepared(page);
    await client.send('Network.enable');
    client.on('Network.requestWillBeSent', ({ requestId, request }) => {
        // The sentences are asked for a second after the pack is there.
        if (/^bytes=[1-9]/.test(request.headers.Range) || request.url.endsWith('.txt')) later.add(requestId);
    });
    client.on('Network.dataReceived', ({ requestId, encodedDataLength }) => {
        bytes += encodedDataLength;
        if (later.has(requestId)) rest += encodedDataLength;
    });
    await client.send('Network.emulateNetworkConditions', { offline: false, latency: 150, downloadThroughput: 200000, uploadThroughput: 93750 });
    const start = Date.now(), told = [];
    await page.goto(`${address()}/?${view}`, { waitUntil: 'commit' });
    for (const what of ['ready', 'whole']) {
        await page.waitForFunction((w) => window.noh && (window.noh[w] || window.noh.error), what, { polling: 20 });
        told.push(`${what === 'ready' ? 'first picture' : 'complete'} after ${((Date.now() - start) / 1000).toFixed(1)} s and ${Math.round(bytes / 1000)} kB`);
    }
    console.log(`# 1.6 Mbit/s, 150 ms: ${told.join(', ')}`);
    const isSmall = !fs.readFileSync(path.join(folder, 'page.js'), 'utf8').includes('\n    '), most = isSmall ? 276000 : 284000; // by esbuild
    check(`by a slow network: the first picture takes ${most / 1000} kB at most`, rest > 0 && bytes - rest <= most, `${bytes - rest} and ${rest}`);
    check('by a slow network: the complete head takes 900 kB at most', bytes <= 900000, bytes);
    check('by a slow network: it is all there', await page.evaluate(() => window.noh.whole && !window.noh.error));
    await page.close();
}

// Of the page, not of the pack: once is enough.
const host = path.basename(folder) === 'nell'; // the page's own, whose bytes count
const parts = host ? { slow } : images > 1 ? { arrives, refused, own } : { arrives };
run(parts, [], { '/held': heldBack, '/cut': cut, '/flipped': flipped });
