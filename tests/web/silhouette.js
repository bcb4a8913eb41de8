// silhouette.js FOLDER CHROMIUM OUT RATE [CLIP...]: how much of a figure's silhouette is inside the picture while its clips
// play: at RATE pictures a second, in a wide and a narrow one, the page's camera is drawn at half its size, so that what lies
// outside shows too. 95 % at least must be inside. CLIP: those clips alone. Prints its checks as TAP.
'use strict';
const fs = require('fs');
const path = require('path');
const { out, check, open, close, run } = require('./harness.js');

const [rate, ...named] = process.argv.slice(5);
const shapes = [[144, 90], [54, 96]]; // pixels

// In the page: the least share inside over a clip, and when that was.
async function least(page, clip, [width, height]) {
    return page.evaluate(([name, w, h, fps]) => {
        const { camera, gl, program: p } = character, pixels = new Uint8Array(4 * w * h), { seconds } = character.clipNamed(name);
        Object.assign(character, { draw() {}, resize() {}, redraw() {} });
        Object.assign(canvas, { width: w, height: h });
        character.play(name, { fade: 0 });
        let worst = { inside: 1, at: 0 };
        for (let i = 0; i < Math.ceil(seconds * fps); i++) {
            character.step(i ? 1 / fps : 0);
            const view = p.floats(p._web_view(), 22);
            camera.write(view, p.floats(p._web_walked(), 3), w / h, h);
            for (let c = 0; c < 16; c += 4) for (const r of [0, 1]) view[c + r] *= 0.5;
            p.check(p._web_draw());
            gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
            let all = 0, inside = 0;
            for (let y = 0; y < h; y++) {
                for (let x = 0; x < w; x++) {
                    const k = 4 * (y * w + x);
                    if (Math.abs(pixels[k] - 78) + Math.abs(pixels[k + 1] - 79) + Math.abs(pixels[k + 2] - 82) < 6) continue; // what is behind
                    all++;
                    inside += x >= w / 4 && x < 3 * w / 4 && y >= h / 4 && y < 3 * h / 4;
                }
            }
            const share = all ? inside / all : 0;
            if (share < worst.inside) worst = { inside: share, at: i / fps, all };
        }
        return worst;
    }, [clip, width, height, Number(rate)]);
}

async function inside(browser) {
    for (const shape of shapes) {
        const page = await open(browser, { viewport: { width: 700, height: 500 } }, 'background=plain');
        const clips = named.length ? named : await page.evaluate(() => character.clips.map((clip) => clip.name));
        for (const clip of clips) {
            const { inside: share, at } = await least(page, clip, shape);
            if (clips.length > 1) console.log(`# ${clip}, ${shape.join(' x ')}: ${(100 * share).toFixed(1)} % inside at ${at.toFixed(2)} s`);
            check(`inside: ${clip}, ${shape.join(' x ')}`, share >= 0.95, `${share} at ${at} s`);
        }
        fs.writeFileSync(path.join(out, 'silhouette.txt'), clips.join('\n'));
        await close(page, `inside ${shape.join(' x ')}`);
    }
}

run({ inside });
