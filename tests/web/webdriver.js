// webdriver.js: as much of a browser and its pages as stock.js asks of puppeteer, by W3C WebDriver alone: WebKit has no other.
// One page at a time. WebDriver does not pass on what a page complains about.
'use strict';
const fs = require('fs');
const http = require('http');
const { spawn } = require('child_process');

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

function ask(port, method, path, body) {
    return new Promise((resolve, reject) => {
        const request = http.request({ port, host: '127.0.0.1', method, path, headers: { 'Content-Type': 'application/json' } }, (answer) => {
            const parts = [];
            answer.on('data', (part) => parts.push(part));
            answer.on('end', () => {
                const { value } = JSON.parse(Buffer.concat(parts).toString());
                if (answer.statusCode === 200) resolve(value);
                else reject(new Error(`${path}: ${value.error}: ${value.message}`));
            });
        });
        request.on('error', reject);
        request.end(body && JSON.stringify(body));
    });
}

// Functions and arguments go over as text. Resolves to what the function returns or promises.
const inPage = `const done = arguments[arguments.length - 1];
Promise.resolve().then(() => (0, eval)('(' + arguments[0] + ')')(...arguments[1])).then((value) => done({ value: value === undefined ? null : value }), (error) => done({ error: String(error) }));`;

// driver: a program that takes --port; options: capabilities of the browser.
async function launch(driver, options) {
    const port = 40000 + (process.pid % 20000), run = spawn(driver, [`--port=${port}`], { stdio: 'ignore' });
    const failed = new Promise((resolve, reject) => run.on('error', reject));
    let session = null;
    for (let tries = 0; !session; tries++) {
        await Promise.race([failed, pause(200)]);
        session = await Promise.race([failed, ask(port, 'POST', '/session', { capabilities: { alwaysMatch: options } })]).catch((error) => {
            if (error.code !== 'ECONNREFUSED' || tries > 100) throw error;
            return null;
        });
    }
    const call = (method, path, body) => ask(port, method, `/session/${session.sessionId}${path}`, body);
    const evaluate = async (what, ...given) => {
        const { value, error } = await call('POST', '/execute/async', { script: inPage, args: [typeof what === 'function' ? String(what) : `() => (${what})`, given] });
        if (error) throw new Error(error);
        return value;
    };
    const page = {
        setDefaultTimeout() {}, on() {}, evaluate,
        setViewport: ({ width, height }) => call('POST', '/window/rect', { width, height }),
        goto: (url) => call('POST', '/url', { url }),
        async waitForFunction(what, { timeout }, ...given) {
            for (const end = Date.now() + timeout; !await evaluate(what, ...given); await pause(100)) if (Date.now() > end) throw new Error(`waited too long for ${what}`);
        },
        screenshot: async ({ path }) => fs.writeFileSync(path, Buffer.from(await call('GET', '/screenshot'), 'base64')),
        close: () => call('POST', '/url', { url: 'about:blank' }),
    };
    return {
        newPage: async () => page,
        version: async () => `${session.capabilities.browserName} ${session.capabilities.browserVersion}`,
        async close() {
            await call('DELETE', '').catch(() => {});
            run.kill();
        },
    };
}

module.exports = { launch };
