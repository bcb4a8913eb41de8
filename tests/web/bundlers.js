// bundlers.js FOLDER CHROMIUM OUT PROJECT: the package in a project of each bundler, built for production and served by a
// strict Content-Security-Policy: the element is drawn, a model is converted, the microphone is heard, and the policy
// refuses nothing. Prints its checks as TAP.
'use strict';
const fs = require('fs');
const path = require('path');
const { execFileSync } = require('child_process');
const { check, run } = require('./harness.js');
const { serve, newPage, slowly } = require('./browser.js');

const project = process.argv[5];
const needed = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; connect-src 'self'; worker-src 'self'; img-src 'self'";
const bin = (name, ...args) => execFileSync(path.join(project, 'node_modules/.bin', name), args, { cwd: project, encoding: 'utf8', stdio: 'pipe' });

// A page that asks for the bundle `script`; the bundle makes an element.
const html = (script) => `<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>test</title><link rel="stylesheet" href="style.css"><script type="module" src="${script}"></script></html>`;
const main = `import { convert } from 'noh-character';
const it = document.createElement('noh-character');
Object.assign(it, { id: 'it', light: 'plain', src: new URL('face.noh', document.baseURI).href });
document.body.append(it);
window.convertModel = async () => (await convert([new File([await (await fetch('arm.glb')).arrayBuffer()], 'arm.glb')])).length;
`;
const pages = { vite: 'main.js', parcel: 'main.js', webpack: 'bundle.js', esbuild: 'bundle.js' };

const build = {
    vite: (out) => bin('vite', 'build', '--outDir', out, '--emptyOutDir'),
    webpack: (out) => bin('webpack', '--mode', 'production', '--entry', './main.js', '--output-path', out, '--output-filename', 'bundle.js'),
    // esbuild leaves addresses as they are: the files go to the folder of the bundle
    esbuild: (out) => {
        bin('esbuild', 'main.js', '--bundle', '--minify', '--format=esm', `--outfile=${out}/bundle.js`);
        const inside = path.join(project, 'node_modules/noh-character');
        for (const name of ['noh.wasm', 'noh.txt', 'ear.bin', 'microphone.js', 'reach.js', 'gl.js', 'program.js', 'prepare.js', 'convert']) fs.cpSync(path.join(inside, name), path.join(out, name), { recursive: true });
    },
    parcel: (out) => bin('parcel', 'build', 'index.html', '--dist-dir', out, '--public-url', './', '--no-cache', '--no-source-maps'),
};

function files(name) {
    const out = path.join(project, `dist-${name}`);
    fs.rmSync(out, { recursive: true, force: true });
    fs.mkdirSync(out);
    fs.writeFileSync(path.join(project, 'index.html'), html(pages[name]).replace(/<link[^>]*>/g, ''));
    fs.writeFileSync(path.join(project, 'main.js'), main);
    build[name](out);
    if (pages[name] === 'bundle.js') fs.writeFileSync(path.join(out, 'index.html'), html('bundle.js'));
    for (const file of ['face.noh', 'arm.glb']) fs.copyFileSync(path.join(project, file), path.join(out, file));
    fs.writeFileSync(path.join(out, 'style.css'), 'noh-character { height: 100px; width: 80px }');
    return out;
}

async function opened(browser, address) {
    const page = await newPage(browser, { viewport: { width: 200, height: 250 }, permissions: ['microphone'] });
    await slowly(page);
    page.problems = [];
    page.on('pageerror', (error) => page.problems.push(String(error)));
    page.on('console', (message) => { if (message.type() === 'error' && !message.location().url.endsWith('favicon.ico')) page.problems.push(message.text()); });
    await page.addInitScript(() => document.addEventListener('securitypolicyviolation', ({ violatedDirective, blockedURI }) => console.error(`${violatedDirective}: ${blockedURI}`)));
    page.setDefaultTimeout(120000);
    await page.goto(address);
    await page.waitForFunction(() => { const it = document.getElementById('it'); return it && (it.whole || it.error); });
    return page;
}

async function tried(browser, name) {
    let out;
    try {
        out = files(name);
    } catch (error) {
        check(`${name}: it builds`, false, String(error.stderr || error.stdout || error).slice(0, 2000).replace(/\n/g, '\n#   '));
        return;
    }
    const { server, address } = await serve({ '/': out }, { 'Content-Security-Policy': needed });
    const page = await opened(browser, address);
    check(`${name}: the element is drawn`, await page.evaluate(() => document.getElementById('it').error) === '', await page.evaluate(() => document.getElementById('it').error));
    const style = await page.evaluate(() => getComputedStyle(document.getElementById('it').shadowRoot.querySelector('canvas')).display);
    check(`${name}: its style is there`, style === 'block', style);
    const converted = await page.evaluate(() => window.convertModel()).catch(String);
    check(`${name}: a model is converted in a worker`, converted > 1000, converted);
    const heard = await page.evaluate(() => new Promise((resolve) => {
        const it = document.getElementById('it');
        it.addEventListener('speech', ({ detail }) => { if (detail.words && !detail.words.startsWith('Waiting')) resolve(detail); });
        it.listen();
    }));
    check(`${name}: the microphone is heard`, heard.speaks, JSON.stringify(heard));
    await page.evaluate(() => document.getElementById('it').character.prepared); // by a worker of its own
    check(`${name}: the policy refuses nothing`, page.problems.length === 0, page.problems.join(' | '));
    await page.close();
    server.close();
}

// Without 'wasm-unsafe-eval' a sentence says what is missing.
async function unsafe(browser) {
    const { server, address } = await serve({ '/': path.join(project, 'dist-vite') }, { 'Content-Security-Policy': needed.replace(" 'wasm-unsafe-eval'", '') });
    const page = await opened(browser, address), said = await page.evaluate(() => document.getElementById('it').error);
    check("no 'wasm-unsafe-eval': a sentence says so", said.includes("add 'wasm-unsafe-eval' to its script-src"), said);
    await page.close();
    server.close();
}

const parts = Object.fromEntries(Object.keys(build).map((name) => [name, (browser) => tried(browser, name)]));
run({ ...parts, unsafe }, ['--use-fake-device-for-media-stream', '--use-fake-ui-for-media-stream']);
