// look.js NOH CHROMIUM OUT THREE MODEL_VIEWER MODEL[:full]...: OUT/look.png, a row for each model and light, and
// OUT/look.txt, figures of each row. Ends like tests/run.sh. OUT has the panoramas of tests/gl/panorama.c.
'use strict';
const fs = require('fs');
const path = require('path');
const { execFileSync } = require('child_process');
const { serve, launch, newPage } = require('./browser.js');

const [noh, executablePath, out, threeFolder, viewerFolder, ...models] = process.argv.slice(2);
const words = (name, otherwise) => (process.env[name] || otherwise).split(' ');
const lights = words('NOH_LOOK_LIGHTS', 'room studio sky'), angles = words('NOH_LOOK_ANGLES', '0 40 85');
const side = Number(process.env.NOH_LOOK_PX || 480);
const makers = ['noh', 'noh_phone', 'three_standard', 'three_physical', 'model_viewer'];

const fileOf = (model, light, angle, maker) => path.join(out, `${model.name}_${light}_${angle}_${maker}.png`);
const put = (file, url) => fs.writeFileSync(file, Buffer.from(url.split(',')[1], 'base64'));
const keyOf = (light) => JSON.parse(fs.readFileSync(path.join(out, `${light}.json`)));

// By noh; of the full tier also without its shadow, for the width of edges. Resolves to camera and light.
function drawNoh(model, light, angle, maker, more) {
    const args = ['render', model.pack, '-o', fileOf(model, light, angle, maker), '--json', '--light', light, '--pose', 'rest',
        '--hair', 'off', '--background', 'plain', '--camera', `${model.frame},${angle},4`, '--size', `${side}x${side}`, ...more];
    return JSON.parse(execFileSync(noh, args, { maxBuffer: 1 << 24, stdio: ['ignore', 'pipe', 'inherit'] }));
}

// Pages of the peers, which keep their lights and programs from model to model.
async function openPeers(browser, address) {
    const tabs = [];
    for (const page of ['three', 'viewer']) {
        const tab = await newPage(browser, { viewport: { width: side, height: side } });
        tab.on('console', (message) => { if (message.type() === 'error') console.log(`# ${message.text()}`); });
        await tab.goto(`${address}/web/look_${page}.html?side=${side}`);
        await tab.waitForFunction(() => window.look);
        tabs.push(tab);
    }
    return tabs;
}

async function drawPeers(tabs, model, views) {
    for (const tab of tabs) {
        await tab.evaluate((address) => window.look.open(address), `/models/${model.name}.glb`);
        for (const { light, angle, told } of views) {
            const wanted = { camera: told.camera, exposure: told.light.exposure, light, key: keyOf(light), front: angle === angles[0] };
            const shots = await tab.evaluate((w) => window.look.draw(w), wanted);
            for (const [maker, url] of Object.entries(shots)) put(fileOf(model, light, angle, maker), url);
        }
    }
}

async function drawModel(tabs, model) {
    const views = [];
    execFileSync(noh, ['build', model.file, '-o', model.pack, '--quiet'], { stdio: 'inherit' });
    for (const light of lights) {
        for (const angle of angles) {
            views.push({ light, angle, told: drawNoh(model, light, angle, 'noh', []) });
            drawNoh(model, light, angle, 'noh_phone', ['--tier', 'phone']);
        }
        drawNoh(model, light, angles[0], 'noh_unshadowed', ['--shadow', 'off']);
    }
    await drawPeers(tabs, model, views);
}

// The figures of all rows as text, a line for each maker.
function textOf(rows) {
    const n = (value, digits) => (value === null ? '-' : value.toFixed(digits));
    const lines = ['Of the figure from the front. lit, dim: the lighter and the darker half of its pixels, hue (degrees) and chroma in OKLCH;',
        'clipped: share with a channel at 254 or more; edge: pixels across the edge of its own shadows, in the median; SSIM: of',
        'noh\'s phone tier with its full one, all angles.', '',
        ['model light maker'.padEnd(44), 'lit hue', ' chroma', 'dim hue', ' chroma', 'clipped', ' edge', '  SSIM'].join(' ')];
    for (const { model, light, maker, f } of rows) {
        lines.push([`${model} ${light} ${maker}`.padEnd(44), n(f.lit[0], 1).padStart(7), n(f.lit[1], 3).padStart(7), n(f.dim[0], 1).padStart(7),
            n(f.dim[1], 3).padStart(7), `${n(100 * f.clipped, 2)}%`.padStart(7), n(f.edge, 1).padStart(5), n(f.ssim, 3).padStart(6)].join(' '));
    }
    return `${lines.join('\n')}\n`;
}

async function drawSheet(browser, address, drawn) {
    const sheet = await newPage(browser, { viewport: { width: 1600, height: 900 } });
    await sheet.goto(`${address}/web/look_sheet.html`);
    const rows = await sheet.evaluate((all) => window.sheet(all), { models: drawn.map((m) => m.name), lights, angles, makers, side });
    fs.writeFileSync(path.join(out, 'look.txt'), textOf(rows));
    await sheet.screenshot({ path: path.join(out, 'look.png'), fullPage: true });
    return rows;
}

(async () => {
    const all = models.map((text) => {
        const [file, frame] = text.split(/:(?=full$)/), name = path.basename(file).replace(/\.\w+$/, '');
        return { file, name, frame: frame || 'face', pack: path.join(out, `${name}.noh`) };
    });
    const there = all.filter((m) => fs.existsSync(m.file));
    for (const m of all) if (!there.includes(m)) console.log(`SKIP: ${m.name}: no ${m.file}`);
    const folders = { '/three/': threeFolder, '/viewer/': viewerFolder, '/web/': __dirname, '/out/': out };
    for (const m of there) folders[`/models/${m.name}.glb`] = m.file;
    const { server, address } = await serve(folders);
    const browser = await launch(executablePath);
    const drawn = [];
    try {
        const tabs = await openPeers(browser, address);
        for (const model of there) {
            try {
                await drawModel(tabs, model);
                drawn.push(model);
                console.log(`ok - ${model.name}`);
            } catch (error) {
                console.log(`not ok - ${model.name}: ${error}`);
            }
        }
        if (drawn.length) {
            await drawSheet(browser, address, drawn);
            console.log(`${path.join(out, 'look.png')}, look.txt`);
        }
    } finally {
        await browser.close();
        server.close();
    }
    console.log(`${drawn.length} passed, ${there.length - drawn.length} failed, ${all.length - there.length} skipped`);
    process.exitCode = drawn.length === there.length ? 0 : 1;
})().catch((error) => { console.log(`not ok - ${error}\n0 passed, 1 failed, 0 skipped`); process.exit(1); });
