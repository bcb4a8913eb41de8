// web_serve.js FOLDER [PORT [all]]: serves a page, with brotli or gzip, on this machine alone or, with `all`, to every
// machine of its networks: their addresses are printed, the first as a QR code too where qrencode is installed. PORT 0: one
// that is free. It serves until it is stopped.
'use strict';
const childProcess = require('child_process');
const fs = require('fs');
const http = require('http');
const os = require('os');
const path = require('path');
const zlib = require('zlib');

const [folder, port = '8000', host = 'localhost'] = process.argv.slice(2);
const types = { '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.wasm': 'application/wasm', '.txt': 'text/plain; charset=utf-8' };
const codings = [['br', (bytes) => zlib.brotliCompressSync(bytes)], ['gzip', (bytes) => zlib.gzipSync(bytes)]];
const packed = new Map(); // by name, coding and time of change

function fail(words) {
    console.error(`web-serve: ${words}`);
    process.exit(1);
}

// The file of a request, and only one below the folder.
function fileOf(url) {
    const name = decodeURIComponent(new URL(`http://localhost${url}`).pathname);
    const file = path.join(folder, name.endsWith('/') ? `${name}index.html` : name);
    return path.relative(folder, file).startsWith('..') ? null : file;
}

// Packs are compressed already: what is text or program alone is worth it.
function pack(file, bytes, changed, accepted) {
    const coding = types[path.extname(file)] && codings.find(([name]) => accepted.includes(name));
    if (!coding) return { bytes };
    const key = `${file} ${coding[0]} ${changed}`;
    if (!packed.has(key)) packed.set(key, coding[1](bytes));
    return { bytes: packed.get(key), coding: coding[0] };
}

// The bytes that are asked for, of what is sent as it is.
function part(request, sent) {
    const asked = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range || ''), all = sent.bytes.length;
    if (!asked || sent.coding || Number(asked[1]) >= all) return sent;
    const from = Number(asked[1]), to = Math.min(all - 1, Number(asked[2] || all));
    return to < from ? sent : { bytes: sent.bytes.subarray(from, to + 1), range: `bytes ${from}-${to}/${all}` };
}

function answer(request, response) {
    const refuse = (code) => response.writeHead(code).end();
    let file;
    try {
        file = fileOf(request.url);
    } catch (error) {
        return refuse(400);
    }
    if (request.method !== 'GET' && request.method !== 'HEAD') return refuse(405);
    if (!file || !fs.statSync(file, { throwIfNoEntry: false })?.isFile()) return refuse(404);
    const changed = fs.statSync(file).mtimeMs, sent = part(request, pack(file, fs.readFileSync(file), changed, request.headers['accept-encoding'] || ''));
    response.writeHead(sent.range ? 206 : 200, {
        'Content-Type': types[path.extname(file)] || 'application/octet-stream', 'Content-Length': sent.bytes.length,
        'Cache-Control': 'no-cache', Vary: 'Accept-Encoding', 'Accept-Ranges': 'bytes', 'Last-Modified': new Date(changed).toUTCString(),
        ...(sent.coding ? { 'Content-Encoding': sent.coding } : {}), ...(sent.range ? { 'Content-Range': sent.range } : {}),
    });
    return response.end(request.method === 'HEAD' ? undefined : sent.bytes);
}

const outside = () => Object.values(os.networkInterfaces()).flat().filter((a) => a.family === 'IPv4' && !a.internal).map((a) => a.address);

function tell(number) {
    const addresses = (host === 'all' ? outside() : []).map((address) => `http://${address}:${number}/`);
    console.log([`http://localhost:${number}/`, ...addresses].join('\n'));
    if (host === 'all' && !addresses.length) console.log('this machine has no network that another one could reach it by');
    if (addresses.length) childProcess.spawnSync('qrencode', ['-t', 'ANSIUTF8', addresses[0]], { stdio: ['ignore', 'inherit', 'ignore'] });
}

if (!folder || !fs.existsSync(path.join(folder, 'index.html'))) fail(`there is no page in ${folder}: make web`);
if (!/^\d+$/.test(port) || Number(port) > 65535) fail(`'${port}' is no port`);
if (host !== 'localhost' && host !== 'all') fail(`HOST is localhost or all, not '${host}'`);
const server = http.createServer(answer);
server.on('error', (error) => fail(error.code === 'EADDRINUSE' ? `port ${port} is taken: PORT=8001 is another` : error.message));
server.listen(Number(port), host === 'all' ? '0.0.0.0' : 'localhost', () => tell(server.address().port));
