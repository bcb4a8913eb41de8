// look.js ASSET PICTURE THREE_FOLDER CHROMIUM OUT NAME: saves OUT/NAME_three.png, the asset by three.js's standard materials,
// and OUT/NAME.png, PICTURE of noh and that one side by side.
'use strict';
const path = require('path');
const { serve, launch, newPage, save } = require('./browser.js');

const [asset, picture, threeFolder, executablePath, out, name] = process.argv.slice(2);

(async () => {
    const { server, address } = await serve({
        '/three/': threeFolder, '/web/': __dirname, '/asset.glb': asset, '/noh.png': picture,
    });
    const browser = await launch(executablePath);
    try {
        const page = await newPage(browser, { viewport: { width: 2160, height: 1080 } });
        page.on('console', (message) => { if (message.type() === 'error') console.log(`# ${message.text()}`); });
        await page.goto(`${address}/web/look.html`);
        await page.waitForFunction(() => window.look);
        const about = await page.evaluate(() => window.look);
        if (about.error) throw new Error(about.error);
        await save(page, '#three', path.join(out, `${name}_three.png`));
        await page.screenshot({ path: path.join(out, `${name}.png`) });
        console.log(`${path.join(out, name)}.png: noh to the left, three.js r${about.three} to the right`);
    } finally {
        await browser.close();
        server.close();
    }
})().catch((error) => { console.log(`${name}: ${error}`); process.exit(1); });
