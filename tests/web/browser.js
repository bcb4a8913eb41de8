// browser.js: shared by the tests of the page: a server of one or more folders, and Chromium on SwiftShader.
// Needs playwright-core, found through NODE_PATH.
'use strict';
const crypto = require('crypto');
const fs = require('fs');
const http = require('http');
const path = require('path');
const zlib = require('zlib');

const types = { '.glb': 'model/gltf-binary', '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.svg': 'image/svg+xml', '.jpg': 'image/jpeg' };

// A file alone is served as itself.
const fileOf = (place, name) => name || !fs.statSync(place, { throwIfNoEntry: false })?.isFile() ? path.join(place, !name || name.endsWith('/') ? `${name}index.html` : name) : place;

// What is text or program goes over the wire with brotli or gzip, as servers send it; of the rest, parts that are asked for.
// quality: of brotli. Where bytes are counted it is 11, which takes seconds for each program.
const wire = { quality: 4 };
const brotli = (bytes) => zlib.brotliCompressSync(bytes, { params: { [zlib.constants.BROTLI_PARAM_QUALITY]: wire.quality } });
const codings = [['br', brotli], ['gzip', zlib.gzipSync]], coded = new Map(); // by coding and contents
function packedBy(request, bytes) {
    const coding = codings.find(([name]) => new RegExp(`\\b${name}\\b`).test(request.headers['accept-encoding'] || ''));
    if (!coding) return null;
    const key = `${coding[0]} ${crypto.createHash('sha1').update(bytes).digest('hex')}`;
    if (!coded.has(key)) coded.set(key, coding[1](bytes));
    return { name: coding[0], bytes: coded.get(key) };
}

function send(request, answer, name, bytes) {
    const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range || '');
    if (range && !types[path.extname(name)] && Number(range[1]) < bytes.length) {
        const from = Number(range[1]), to = Math.min(bytes.length - 1, Number(range[2] || bytes.length));
        answer.writeHead(206, { 'Content-Type': 'application/octet-stream', 'Content-Length': to + 1 - from, 'Content-Range': `bytes ${from}-${to}/${bytes.length}` });
        answer.end(bytes.subarray(from, to + 1));
        return;
    }
    const type = types[path.extname(name)] || (name.endsWith('/') ? 'text/html' : 'application/octet-stream');
    const packed = types[path.extname(name)] && !/jpg$/.test(name) ? packedBy(request, bytes) : null, body = packed ? packed.bytes : bytes;
    answer.writeHead(200, { 'Content-Type': type, 'Content-Length': body.length, ...(packed ? { 'Content-Encoding': packed.name } : {}) });
    answer.end(body);
}

// Serve the files of { '/prefix/': folder, file or function (request, answer) }, with more headers; resolves to the
// server and its address.
function serve(folders, headers = {}) {
    const server = http.createServer((request, answer) => {
        for (const [name, value] of Object.entries(headers)) answer.setHeader(name, value);
        const name = new URL(request.url, 'http://localhost').pathname;
        const prefix = Object.keys(folders).find((p) => name.startsWith(p) && !name.includes('..'));
        if (typeof folders[prefix] === 'function') return folders[prefix](request, answer);
        return fs.readFile(prefix ? fileOf(folders[prefix], name.slice(prefix.length)) : '', (error, bytes) => {
            if (!error) return send(request, answer, name, bytes);
            answer.writeHead(404);
            return answer.end('');
        });
    });
    return new Promise((resolve) => {
        server.listen(0, 'localhost', () => resolve({ server, address: `http://localhost:${server.address().port}` }));
    });
}

// flags: more of them, of the browser's command line.
function launch(executablePath, flags) {
    return require('playwright-core').chromium.launch({
        executablePath,
        args: ['--headless', '--no-sandbox', '--disable-gpu', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
            '--disable-background-networking', '--disable-component-update', '--js-flags=--wasm-lazy-compilation --expose-gc', ...(flags || [])],
    });
}

// A dozen frames a second are enough to see that something moves: a browser asks for more than a software rasteriser draws,
// and what it was asked for has to be drawn in the end.
function slowly(page) {
    return page.addInitScript(() => {
        const next = window.requestAnimationFrame.bind(window);
        window.requestAnimationFrame = (call) => setTimeout(() => next(call), 70);
    });
}

// Without the worker that prepares lights (package/prepare.js): it takes a second of a processor, and ends at any time.
function unprepared(page) {
    return page.addInitScript(() => {
        const { Worker } = window;
        window.Worker = class extends Worker {
            constructor(url, options) {
                if (String(url).includes('prepare')) throw new Error('not in this test');
                super(url, options);
            }
        };
    });
}

// How long a test waits for what has to come: a software rasteriser on a busy machine takes minutes where it takes seconds
// on an idle one.
const patienceMs = 300000;
async function newPage(browser, options) {
    const page = await browser.newPage(options);
    page.setDefaultTimeout(patienceMs);
    return page;
}

// Save a canvas as PNG.
async function save(page, selector, file) {
    const url = await page.evaluate((s) => document.querySelector(s).toDataURL('image/png'), selector);
    fs.writeFileSync(file, Buffer.from(url.split(',')[1], 'base64'));
}

module.exports = { wire, serve, launch, save, slowly, unprepared, newPage };
