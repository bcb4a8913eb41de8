// browser.js: shared by the tests of the page: a server of one or more folders, and Chromium on SwiftShader.
// Needs playwright-core, found through NODE_PATH.
'use strict';
const fs = require('fs');
const http = require('http');
const path = require('path');

const types = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm' };

// A file alone is served as itself.
const fileOf = (place, name) => name || !fs.statSync(place, { throwIfNoEntry: false })?.isFile() ? path.join(place, name || 'index.html') : place;

// Serve the files of { '/prefix/': folder or file }; resolves to the server and its address.
function serve(folders) {
    const server = http.createServer((request, answer) => {
        const name = new URL(request.url, 'http://localhost').pathname;
        const prefix = Object.keys(folders).find((p) => name.startsWith(p) && !name.includes('..'));
        fs.readFile(prefix ? fileOf(folders[prefix], name.slice(prefix.length)) : '', (error, bytes) => {
            answer.writeHead(error ? 404 : 200, { 'Content-Type': types[path.extname(name)] || (name.endsWith('/') ? 'text/html' : 'application/octet-stream') });
            answer.end(error ? '' : bytes);
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
            '--disable-background-networking', '--disable-component-update', ...(flags || [])],
    });
}

// Save a canvas as PNG.
async function save(page, selector, file) {
    const url = await page.evaluate((s) => document.querySelector(s).toDataURL('image/png'), selector);
    fs.writeFileSync(file, Buffer.from(url.split(',')[1], 'base64'));
}

module.exports = { serve, launch, save };
