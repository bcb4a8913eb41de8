// package.js FOLDER CHROMIUM OUT PROJECT: the package as it was installed in PROJECT, one with only its packs: the
// page of the package's README, two elements at once, what goes when one is removed, attributes, keys, words, reduced
// motion, a lost context, minutes without growth. Prints its checks as TAP.
'use strict';
const fs = require('fs');
const path = require('path');
const zlib = require('zlib');
const { folder, out, check, faults, run, address } = require('./harness.js');
const { newPage, slowly, unprepared } = require('./browser.js');

const project = process.argv[5];
const inside = path.join(project, 'node_modules/noh-character');

// A page with this body. Elements of the page have their ids as names.
async function show(browser, body, options, prepares) {
    fs.writeFileSync(path.join(project, 'poster.svg'), '<svg xmlns="http://www.w3.org/2000/svg" width="40" height="50"><rect width="40" height="50" fill="#c9a26b"/></svg>');
    fs.writeFileSync(path.join(project, 'page.html'), `<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>test</title><link rel="icon" href="data:,">
<style>body { margin: 0 } noh-character { height: 100px }</style><script type="module" src="node_modules/noh-character/index.js"></script><main>${body}</main></html>`);
    return visit(browser, 'page.html', options, prepares);
}

// prepares: 1: a worker prepares the lights that are not shown.
async function visit(browser, name, options, prepares) {
    const page = await newPage(browser, { viewport: { width: 200, height: 250 }, ...options });
    await slowly(page);
    if (!prepares) await unprepared(page);
    page.problems = [];
    page.on('pageerror', (error) => page.problems.push(String(error)));
    page.on('console', (message) => { if (message.type() === 'error') page.problems.push(message.text()); });
    await page.goto(`${address()}/project/${name}`);
    return page;
}

const whole = (page, ...ids) => page.waitForFunction((all) => all.every((id) => document.getElementById(id).whole || document.getElementById(id).error), ids);
const frames = (page, id, count) => page.evaluate(([i, n]) => new Promise((resolve) => {
    const element = document.getElementById(i);
    let left = n;
    element.addEventListener('frame', () => { if (--left <= 0) resolve(); });
    element.character.redraw();
}), [id, count]);

async function close(page, name, problems = 0) {
    check(`${name}: the browser reports no problem`, page.problems.length === problems, page.problems.join(' | '));
    await page.close();
}

// ---- the page of the README ----

async function readme(browser) {
    const html = /```html\n([^]*?)```/.exec(fs.readFileSync(path.join(inside, 'README.md'), 'utf8'))[1];
    fs.writeFileSync(path.join(project, 'index.html'), html);
    check('readme: it has ten lines at most', html.trim().split('\n').length <= 10);
    const page = await visit(browser, 'index.html', { viewport: { width: 120, height: 160 } }); // pixels are dear here
    await page.waitForFunction(() => document.querySelector('noh-character').whole || document.querySelector('noh-character').error);
    check('readme: it is there', await page.evaluate(() => document.querySelector('noh-character').error) === '');
    await page.evaluate(() => { document.querySelector('noh-character').shadow = 'off'; }); // the dearest part of a frame here
    const blinks = await page.waitForFunction(() => document.querySelector('noh-character').weight('eyeBlinkLeft') > 0.5).then(() => true, () => false);
    check('readme: a face that blinks', blinks);
    check('readme: the poster has gone', !await page.isVisible('[slot=poster]'));
    await page.screenshot({ path: path.join(out, 'readme.png') });
    await close(page, 'readme', 1); // a page without an icon of its own
}

// ---- several, and one less ----

async function two(browser) {
    const page = await show(browser, `<noh-character id="one" src="face.nohz" auto-life shadow="off" style="height: 50px; width: 50px"></noh-character>
        <noh-character id="two" src="face.noh" characters="2" light="plain" clip="smile" level="3"></noh-character>`);
    await whole(page, 'one', 'two');
    const all = await page.evaluate(() => ['one', 'two'].map((id) => document.getElementById(id)).map((e) => ({
        error: e.error, memory: e.memory, bytes: e.character.program.memory.buffer.byteLength,
        grows: (() => { try { e.character.program.memory.grow(1); return true; } catch { return false; } })(),
    })));
    check('two: both are there', all.every((a) => a.error === ''), all.map((a) => a.error).join());
    check('two: memory of their own, of what each takes', all[0].bytes !== all[1].bytes && all.every((a) => a.memory.all === a.bytes));
    check('two: which cannot grow', all.every((a) => !a.grows));
    check('two: the sum is the pack, its block and little more', all.every((a) => a.bytes - a.memory.pack - a.memory.room < 512 * 1024), JSON.stringify(all.map((a) => a.memory)));
    await page.evaluate(() => document.getElementById('two').setWeight('smile', 1));
    await frames(page, 'two', 2);
    const smiles = await page.evaluate(() => ['one', 'two'].map((id) => document.getElementById(id).weight('smile')));
    check('two: a call to one does not reach the other', smiles[0] === 0 && smiles[1] === 1, smiles.join());
    const globals = await page.evaluate(() => Object.keys(window).filter((name) => /noh|module|wasm|emscripten/i.test(name)));
    check('two: no globals', globals.length === 0, globals.join());
    await removed(page);
    await close(page, 'two');
}

async function removed(page) {
    const before = await page.evaluate(async () => {
        const element = document.getElementById('one'), { character } = element;
        window.kept = { gl: character.gl, memory: new WeakRef(character.program.memory.buffer), character: new WeakRef(character) };
        element.parentNode.append(element); // moved, not removed
        await new Promise((resolve) => setTimeout(resolve, 50));
        const moved = element.loaded && !kept.gl.isContextLost();
        element.remove();
        await new Promise((resolve) => setTimeout(resolve, 50));
        return { moved, lost: kept.gl.isContextLost(), character: element.character };
    });
    check('removed: one that is only moved stays', before.moved);
    check('removed: its context is released', before.lost && before.character === null);
    const gone = await page.evaluate(async () => {
        kept.gl = null;
        for (let i = 0; i < 5; i++) { // what a WeakRef was asked for stays until the task ends
            await new Promise((resolve) => setTimeout(resolve, 50));
            gc();
        }
        return [kept.memory.deref() ? 'memory' : '', kept.character.deref() ? 'character' : ''].join(' ').trim();
    });
    check('removed: its memory is dropped', gone === '', gone);
    check('removed: the other one goes on', await page.evaluate(() => document.getElementById('two').loaded));
}

// ---- attributes, events, keys ----

async function used(browser) {
    const page = await show(browser, '<noh-character id="it" alt="a mask" camera-orbit light="room" shadow="off"><b slot="progress">wait</b></noh-character>');
    await page.evaluate(() => {
        const it = document.getElementById('it');
        window.seen = [];
        for (const type of ['progress', 'load', 'pick', 'pause', 'error']) it.addEventListener(type, () => seen.push(type));
        it.src = 'face.nohz';
    });
    await whole(page, 'it');
    const canvas = page.locator('noh-character canvas');
    check('used: its name is said', (await canvas.getAttribute('aria-label')).startsWith('a mask;') && await canvas.getAttribute('role') === 'application');
    const wrong = await faults(page, 'noh-character');
    check('used: axe finds nothing', wrong.length === 0, wrong.join(' | '));
    await frames(page, 'it', 1);
    const state = () => page.evaluate(() => { const { camera, chosen, paused } = document.getElementById('it').character; return { ...camera, light: chosen.light, paused }; });
    const before = await state();
    await page.keyboard.press('Tab');
    await page.keyboard.press('ArrowLeft');
    await page.keyboard.press('+');
    await page.keyboard.press(' ');
    const after = await state();
    check('used: keys turn it, bring it closer, hold it', after.azimuth > before.azimuth && after.distance < 1 && after.paused, JSON.stringify(after));
    await page.keyboard.press('Home');
    await page.evaluate(() => { document.getElementById('it').light = 'sky'; });
    check('used: an attribute changes the light', (await state()).light === 'sky');
    const held = await page.evaluate(() => {
        const it = document.getElementById('it'), { character } = it, before = { ...character.camera };
        Object.assign(it, { minCameraOrbit: '-10deg 60deg 80%', maxCameraOrbit: '10deg auto 120%' });
        character.turn(1, 2);
        character.zoom(0.1);
        const { azimuth, elevation, distance } = character.camera;
        Object.assign(it, { minCameraOrbit: '', maxCameraOrbit: '' });
        Object.assign(character.camera, before, { limits: character.camera.limits });
        return [azimuth, elevation, distance].map((value) => value.toFixed(4)).join();
    });
    check('used: attributes limit the camera', held === '0.1745,0.5236,0.8000', held);
    const r = await canvas.boundingBox();
    await page.mouse.click(r.x + r.width / 2, r.y + r.height / 2);
    const seen = await page.evaluate(() => seen);
    check('used: events tell', ['progress', 'load', 'pick', 'pause'].every((type) => seen.includes(type)) && !seen.includes('error'), seen.join());
    const caption = await page.evaluate(() => new Promise((resolve) => {
        const it = document.getElementById('it'), shown = it.shadowRoot.querySelector('.caption');
        it.addEventListener('caption', ({ detail }) => resolve([detail.words, shown.hidden, shown.textContent].join()), { once: true });
        it.captions = true;
        it.speak('mama, mama, mama, mama, mama');
    }));
    check('used: what it says is shown', caption === 'mama, mama, mama, mama, mama,false,mama, mama, mama, mama, mama', caption);
    await page.screenshot({ path: path.join(out, 'caption.png') });
    await page.evaluate(() => document.getElementById('it').hush());
    check('used: until it is hushed', !await page.isVisible('noh-character .caption'));
    await page.evaluate(() => { document.getElementById('it').clip = 'nothing'; });
    check('used: a clip that is not there is named in the message', (await page.textContent('noh-character .message')).includes("no clip 'nothing'"));
    await page.evaluate(() => { document.getElementById('it').src = 'none.noh'; });
    await page.waitForFunction(() => document.getElementById('it').error.includes('404'));
    check('used: as is a pack that is not there, and what was shown stays', await page.isVisible('noh-character .message') && await page.evaluate(() => document.getElementById('it').loaded));
    await close(page, 'used', 1);
}

// A page loads the program that it names, and no other.
async function programs(browser) {
    const page = await show(browser, ['face', 'body', 'all'].map((name) => `<noh-character id="${name}" src="face.noh" program="${name}" light="plain"></noh-character>`).join(''));
    await whole(page, 'face', 'body', 'all');
    const told = await page.evaluate(async () => ({ errors: [...document.querySelectorAll('noh-character')].map(({ error }) => error).join(''),
        loaded: performance.getEntriesByType('resource').map(({ name }) => name.split('/').pop()).filter((name) => name.endsWith('.wasm')).sort().join(' '),
        pushed: [await document.getElementById('face').push(), await document.getElementById('body').push(), await document.getElementById('all').push()] }));
    check('programs: each element loads its own', told.loaded === 'body.wasm face.wasm noh.wasm' && told.errors === '', JSON.stringify(told));
    check('programs: what one lacks, it says', told.pushed.map((words) => /has no falls: use noh\.wasm/.test(words)).join() === 'true,true,false', told.pushed.join(' | '));
    const sizes = await page.evaluate(() => ['face', 'body', 'all'].map((id) => document.getElementById(id).memory.pack));
    const most = { face: 180000, body: 202000, noh: 235000 };
    for (const [name, limit] of Object.entries(most)) {
        const { length } = zlib.brotliCompressSync(fs.readFileSync(path.join(inside, `${name}.wasm`)));
        check(`programs: ${name}.wasm takes ${limit / 1000} kB at most`, length <= limit, length);
    }
    check('programs: all show the same pack', sizes[0] > 0 && sizes.every((size) => size === sizes[0]), sizes.join(' '));
    await close(page, 'programs');
}

// What a change of light takes is made beforehand: it links no program, and bakes no light.
async function lights(browser) {
    const page = await show(browser, '<noh-character id="it" src="face.nohz" light="studio"></noh-character>', {}, 1);
    await whole(page, 'it');
    const told = await page.evaluate(async () => {
        const it = document.getElementById('it'), { character } = it, { gl, program } = character, link = gl.linkProgram.bind(gl), pictures = [], times = [];
        await character.prepared;
        character.sparing = false; // a busy machine lowers the resolution
        character.resize();
        let count = 0;
        gl.linkProgram = (linked) => { count++; link(linked); };
        for (const light of ['plain', 'sky', 'plain', 'sky', 'room']) {
            const start = performance.now();
            it.light = light;
            times.push(Math.round(performance.now() - start));
            character.advance(1); // until no level fades
            character.advance(0);
            pictures.push(character.canvas.toDataURL());
        }
        return { count, times, error: program._web_check(), same: pictures[0] === pictures[2] && pictures[1] === pictures[3] && pictures[0] !== pictures[1], room: pictures[4] };
    });
    console.log(`# a change of light: ${told.times.join(', ')} ms`);
    check('lights: a change links nothing', told.count === 0 && told.error === 0, `${told.count} programs`);
    check('lights: a light that was there before looks the same', told.same);
    await page.goto(page.url()); // nothing is kept
    await page.evaluate(() => { document.getElementById('it').light = 'room'; });
    await whole(page, 'it');
    const alone = await page.evaluate(() => { const { character } = document.getElementById('it'); character.sparing = false; character.resize(); character.advance(1); character.advance(0); return character.canvas.toDataURL(); });
    // Edges of shadows differ by a few steps between a light that comes late and one from the start.
    const off = await page.evaluate(async (urls) => {
        const [a, b] = await Promise.all(urls.map(async (url) => {
            const image = new Image(), canvas = document.createElement('canvas'), context = canvas.getContext('2d');
            image.src = url;
            await image.decode();
            Object.assign(canvas, { width: image.width, height: image.height });
            context.drawImage(image, 0, 0);
            return context.getImageData(0, 0, image.width, image.height).data;
        }));
        const differ = (value, i) => Math.abs(value - b[i]);
        return { most: a.length === b.length ? a.reduce((most, value, i) => Math.max(most, differ(value, i)), 0) : 255, far: a.filter((value, i) => differ(value, i) > 8).length / a.length };
    }, [alone, told.room]);
    check('lights: one that a worker has baked looks as one of the page', off.most <= 16 && off.far < 1e-4, `off by ${off.most}, ${off.far} of the values by more than 8`);
    await close(page, 'lights');
}

// Calls before the pack is shown wait for it; names that are not there are rejected; an error goes with its cause; a pack
// that could not be reached is tried again.
async function early(browser) {
    const page = await show(browser, '<noh-character id="it" light="plain"></noh-character>');
    const told = await page.evaluate(async () => {
        const it = document.getElementById('it'), said = (promise) => promise.then(() => 'done', (error) => error.message);
        const calls = ['smile', 'typo'].map((name) => said(it.setWeight(name, 0.5))), plays = said(it.play('typo'));
        it.src = 'face.nohz';
        const same = await it.ready === it, answers = [...await Promise.all(calls), await plays, await said(it.setWeight('typo', 1))];
        return { same, answers, loaded: it.loaded, error: it.error };
    });
    check('early: calls wait, and unknown names are reported alike', told.same && told.loaded && told.error === ''
        && told.answers.join() === "done,the pack has no target 'typo',the pack has no clip 'typo' that moves it,the pack has no target 'typo'", JSON.stringify(told));
    await whole(page, 'it');
    await frames(page, 'it', 1);
    check('early: what was called has come', await page.evaluate(() => document.getElementById('it').weight('smile')) === 0.5);
    const error = () => page.evaluate(() => document.getElementById('it').error);
    await page.evaluate(() => { document.getElementById('it').clip = 'nothing'; });
    check('early: a wrong attribute is reported', (await error()).includes("no clip 'nothing'"), await error());
    await page.evaluate(() => { document.getElementById('it').clip = 'smile'; });
    check('early: until it is right', await error() === '' && !await page.isVisible('noh-character .message'), await error());
    await page.context().setOffline(true);
    const fails = await page.evaluate(() => { const it = document.getElementById('it'); it.src = 'face.noh'; return it.ready.catch((e) => e.message); });
    check('early: offline has a message', fails.includes('face.noh cannot be reached, because this device is offline') && await error() === fails, fails);
    check('early: with a button', await page.isVisible('noh-character [part=retry]'));
    await page.screenshot({ path: path.join(out, 'offline.png') });
    await page.context().setOffline(false);
    const shown = await page.evaluate(() => document.getElementById('it').ready.then((it) => it.error));
    check('early: it tries again when the network is there', shown === '' && !await page.isVisible('noh-character .message'), shown);
    await whole(page, 'it');
    await close(page, 'early', 1); // the request that failed
}

// A model as `src`: converted once.
async function model(browser) {
    if (!fs.existsSync(path.join(inside, 'convert'))) return;
    const page = await show(browser, '<noh-character id="it" src="arm.glb" light="plain"></noh-character>'), asked = [];
    await whole(page, 'it');
    const clips = () => page.evaluate(() => document.getElementById('it').clips.map(({ name }) => name).join());
    check('model: it is converted and shown', (await clips()).includes('bend'), await page.evaluate(() => document.getElementById('it').error));
    page.on('request', (request) => { if (request.method() === 'GET') asked.push(request.url()); });
    await page.reload();
    await whole(page, 'it');
    check('model: its pack is kept', (await clips()).includes('bend') && !asked.some((url) => url.includes('convert.wasm')), asked.join(' '));
    await page.evaluate(() => { document.getElementById('it').src = 'cut.glb'; });
    const said = await page.evaluate(() => document.getElementById('it').ready.catch((error) => error.message));
    check('model: a broken one is reported', String(said).includes('truncated') && await page.isVisible('noh-character .message'), String(said));
    await close(page, 'model');
}

// Nothing is loaded before a visitor scrolls to it; a poster is shown until then.
async function lazy(browser) {
    const page = await show(browser, '<div style="height: 2000px"></div><noh-character id="it" src="face.nohz" light="plain" loading="lazy" poster="poster.svg"></noh-character>'), asked = [];
    page.on('request', (request) => asked.push(request.url()));
    await page.waitForTimeout(500);
    check('lazy: the pack is not asked for', !asked.some((url) => url.includes('face')) && await page.evaluate(() => !document.getElementById('it').loads), asked.join(' '));
    await page.evaluate(() => document.getElementById('it').scrollIntoView());
    const poster = await page.evaluate(() => { const img = document.getElementById('it').shadowRoot.querySelector('img'); return img.decode().then(() => img.clientWidth); });
    check('lazy: a poster', poster > 0, poster);
    const blob = await page.evaluate(async () => {
        const it = document.getElementById('it'), file = await it.toBlob(), picture = await createImageBitmap(file);
        return [file.type, picture.width === it.clientWidth * devicePixelRatio, it.shadowRoot.querySelector('.poster').hidden].join();
    });
    check('lazy: then it comes, and a picture of it is a file', blob === 'image/png,true,true', blob);
    await whole(page, 'it');
    await close(page, 'lazy');
}

// A humanoid whose pack has no clips, where one was built: its arms hang, and it breathes and shifts its weight, unless it
// is to be still.
async function stands(browser) {
    if (!fs.existsSync(path.join(project, 'standing.noh'))) return;
    const page = await show(browser, '<noh-character id="it" src="standing.noh" light="studio" shadow="off" style="width: 200px; height: 250px"></noh-character>');
    await whole(page, 'it');
    const told = await page.evaluate(() => {
        const it = document.getElementById('it'), { character } = it, { box } = character.camera, picture = (seconds) => {
            for (let i = 0; i < 10 * seconds; i++) character.step(0.1);
            character.advance(0);
            return character.canvas.toDataURL();
        };
        const still = picture(0) === picture(2), first = picture(0), goesOn = character.moves(Infinity);
        it.autoLife = true;
        const told = { shape: (box[3] - box[0]) / (box[4] - box[1]), still, goesOn, begins: picture(0) === first, moves: picture(2) !== first, lives: character.moves(Infinity) };
        character.stopped = true; // pixels are dear here
        return told;
    });
    check('stands: its arms hang', told.shape < 0.5, told.shape);
    check('stands: it is still', told.still && !told.goesOn, JSON.stringify(told));
    check('stands: with auto-life it breathes, from the same pose on', told.begins && told.moves && told.lives, JSON.stringify(told));
    await page.screenshot({ path: path.join(out, 'stands.png') });
    await close(page, 'stands');
}

// A body that faces -z or +x is framed and lit from its own front, and stands next to others across it.
async function turned(browser) {
    if (!fs.existsSync(path.join(project, 'turned.noh'))) return;
    const page = await show(browser, ['standing', 'turned', 'aside'].map((name) => `<noh-character id="${name}" src="${name}.noh" characters="2" program="${name === 'aside' ? 'body' : 'all'}" light="studio" shadow="off" style="width: 96px; height: 80px"></noh-character>`).join(''));
    await whole(page, 'standing', 'turned', 'aside');
    const told = await page.evaluate(async () => {
        const all = ['standing', 'turned', 'aside'].map((id) => document.getElementById(id).character), pixels = ({ gl, canvas }) => {
            const out = new Uint8Array(4 * canvas.width * canvas.height);
            gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, out);
            return out;
        };
        const look = (character) => { character.stopped = true; character.advance(1); character.advance(0); return pixels(character); };
        const [ahead, round, aside] = all.map(look), apart = (a, b) => a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0) / a.length;
        all[1].turn(Math.PI, 0);
        return { facing: all.map(({ program }) => program._web_facing()).join(), front: apart(ahead, round), aside: apart(ahead, aside), back: apart(ahead, look(all[1])) };
    });
    check('turned: where it faces is known', told.facing === '0,180,90', told.facing);
    check('turned: its front is shown, in the same light', Math.max(told.front, told.aside) < told.back / 4, JSON.stringify(told));
    await page.evaluate(() => document.getElementById('turned').character.home());
    await frames(page, 'turned', 1);
    await page.screenshot({ path: path.join(out, 'turned.png') });
    await close(page, 'turned');
}

// The colour behind the figure: the page's own where it is transparent, with the shadow on the floor.
async function behind(browser) {
    const page = await show(browser, `<style>#it { background-color: rgb(255, 200, 0); width: 100px; height: 125px }</style>
        <noh-character id="it" src="${fs.existsSync(path.join(project, 'walker.noh')) ? 'walker.noh' : 'face.noh'}" level="3" background="transparent"></noh-character>`);
    await whole(page, 'it');
    const look = (background) => page.evaluate(async (b) => {
        const it = document.getElementById('it'), { character } = it;
        it.background = b;
        character.advance(1);
        character.advance(0);
        const picture = await createImageBitmap(await it.toBlob()), { width, height } = picture, canvas = Object.assign(document.createElement('canvas'), { width, height }), context = canvas.getContext('2d');
        context.drawImage(picture, 0, 0);
        const { data } = context.getImageData(0, 0, width, height), at = (x, y) => Array.from(data.slice(4 * (y * width + x), 4 * (y * width + x) + 4)).join();
        let shade = 0;
        for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 10 && data[i + 3] < 200 && data[i] + data[i + 1] + data[i + 2] < 30) shade++;
        return { corner: at(1, 1), middle: at(width >> 1, height * 0.4 | 0).split(',')[3], shade, error: it.error };
    }, background);
    const clear = await look('transparent');
    check('behind: nothing but the figure', clear.corner === '0,0,0,0' && clear.middle === '255' && clear.error === '', JSON.stringify(clear));
    check('behind: and the shadow that it casts', clear.shade > 30 || !fs.existsSync(path.join(project, 'walker.noh')), clear.shade);
    await page.screenshot({ path: path.join(out, 'behind_page.png') });
    const blue = await look('hsl(240 100% 50%)'), half = await look('#00ff0080'), wrong = await look('blau'), light = await look('light');
    check('behind: a colour of CSS', blue.corner === '0,0,255,255' && half.corner.endsWith(',128') && blue.error === '', `${blue.corner} ${half.corner}`);
    check('behind: what is none is named', wrong.error.includes("background 'blau'") && light.error === '', wrong.error);
    check('behind: a picture without gaps', light.corner.endsWith(',255') && light.middle === '255', JSON.stringify(light));
    await close(page, 'behind');
}

// Elements that stay at a vertex, a joint and a place, while the figure moves.
async function hotspots(browser) {
    const page = await show(browser, `<style>button { width: 12px; height: 12px; padding: 0; border-radius: 6px; background: red } noh-character { width: 200px; height: 250px }</style>
        <noh-character id="it" src="face.noh" light="plain" clip="smile" paused></noh-character>`);
    await whole(page, 'it');
    const told = await page.evaluate(async () => {
        const it = document.getElementById('it'), { character } = it, told = {}, r = it.getBoundingClientRect();
        const drawn = async () => { await Promise.resolve(); character.advance(0.1); character.advance(0); };
        const spot = (name, data) => { const b = it.appendChild(Object.assign(document.createElement('button'), { slot: name })); Object.assign(b.dataset, data); return b; };
        await drawn();
        const picked = await new Promise((resolve) => {
            it.addEventListener('pick', ({ detail }) => resolve(detail), { once: true });
            character.tap(r.left + r.width / 2, r.top + r.height * 0.77);
        });
        told.picked = picked.vertex >= 0;
        const lip = spot('hotspot-lip', { vertex: `${picked.mesh} ${picked.vertex}` }), back = spot('hotspot-back', { position: '0m 0m 0m', normal: '0m 0m -1m' });
        await drawn();
        const at = (b) => { const box = b.getBoundingClientRect(); return [box.left + box.width / 2 - r.left, box.top + box.height / 2 - r.top]; }, near = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
        told.there = near(at(lip), [r.width / 2, r.height * 0.77]);
        told.visible = [lip, back].map((b) => b.hasAttribute('data-visible')).join();
        const query = it.queryHotspot('hotspot-lip'), before = at(lip);
        told.query = [near([query.canvasPosition.x, query.canvasPosition.y], before) < 1, query.facingCamera, query.normal.z > 0].join();
        it.setWeight('smile', 1);
        it.setWeight('jawOpen', 1);
        await drawn();
        told.moved = near(at(lip), before);
        it.releaseWeights();
        const seen = new Promise((resolve) => back.addEventListener('hotspot-visibility', ({ detail }) => resolve(detail.visible)));
        character.turn(Math.PI, 0);
        await drawn();
        told.behind = [lip, back].map((b) => b.hasAttribute('data-visible')).join();
        told.seen = await seen;
        const wrong = spot('hotspot-wrong', { joint: 'tail' });
        await drawn();
        told.error = it.error;
        wrong.remove();
        await drawn();
        told.after = it.error;
        character.turn(Math.PI + 0.4, 0.1);
        await drawn();
        return told;
    });
    check('hotspots: a tap tells the vertex', told.picked);
    check('hotspots: an element stays at it', told.there < 6, told.there);
    check('hotspots: what faces the camera is visible', told.visible === 'true,false' && told.behind === 'false,true' && told.seen === true, JSON.stringify(told));
    check('hotspots: its place can be asked for', told.query === 'true,true,true', told.query);
    check('hotspots: it follows targets', told.moved > 0.5, told.moved);
    check('hotspots: a joint that is not there is named', told.error === "hotspot-wrong: the pack has no joint 'tail'" && told.after === '', told.error);
    await page.screenshot({ path: path.join(out, 'hotspots.png') });
    await close(page, 'hotspots');
    if (!fs.existsSync(path.join(project, 'walker.noh'))) return;
    const walks = await show(browser, `<style>b { background: #fffc; color: #000; font: 10px sans-serif; padding: 0 2px } noh-character { width: 200px; height: 250px }</style>
        <noh-character id="it" src="walker.noh" clip="walk" light="plain" level="3"><b slot="hotspot-foot" data-joint="foot.L">foot</b><b slot="hotspot-head" data-joint="head" data-position="0 10cm 0">head</b></noh-character>`);
    await whole(walks, 'it');
    const foot = await walks.evaluate(() => {
        const it = document.getElementById('it'), ahead = [];
        for (let i = 0; i < 12; i++) {
            it.character.advance(0.1);
            const view = it.queryHotspot('hotspot-foot');
            if (view) ahead.push(view.position.z);
        }
        it.character.stopped = true; // pixels are dear here
        return { error: it.error, range: Math.max(...ahead) - Math.min(...ahead), head: it.queryHotspot('hotspot-head')?.canvasPosition.y };
    });
    check('hotspots: it follows a joint', foot.error === '' && foot.range > 0.2 && foot.head > 0 && foot.head < 80, JSON.stringify(foot));
    await walks.screenshot({ path: path.join(out, 'hotspots_walk.png') });
    await close(walks, 'hotspots of a walk');
}

// A voice of the program in place of the browser's: its sound is heard, or its times are followed.
async function voice(browser) {
    const page = await show(browser, '<noh-character id="it" src="face.noh" light="plain" style="width: 64px; height: 64px" captions></noh-character>');
    await whole(page, 'it');
    const told = await page.evaluate(async () => {
        const it = document.getElementById('it'), { speech } = it.character, rate = 16000, asked = [], told = {};
        // half a second of a buzz through the resonances of "a"
        const buzz = () => {
            const sound = new AudioBuffer({ length: rate / 2, sampleRate: rate }), out = sound.getChannelData(0);
            for (let i = 0; i < out.length; i++) for (const [hz, loud] of [[730, 0.3], [1090, 0.2], [2440, 0.1]]) out[i] += loud * Math.sin(2 * Math.PI * hz * i / rate) * Math.exp(-(i % 133) / 40);
            return sound;
        };
        it.voice = async (text) => { asked.push(text); return buzz(); };
        it.addEventListener('caption', ({ detail }) => { told.caption = told.caption || detail.words; });
        const heard = it.speak('Aha');
        await new Promise((resolve) => { it.addEventListener('speech', ({ detail }) => { if (detail.source === 'file') resolve(); }); });
        told.open = Math.max(...speech.now.frames.map(({ open }) => open));
        told.said = await heard;
        const words = [], times = [{ viseme: 1, ms: 0 }, { viseme: 10, ms: 100 }, { viseme: 0, ms: 400 }];
        it.addEventListener('word', ({ detail }) => words.push(detail.word));
        it.voice = (text) => { asked.push(text); return { sound: buzz(), visemes: times, words: [{ word: 'Papa', ms: 0 }] }; };
        told.timed = await it.speak('Papa') && words.join() === 'Papa' && !speech.now.frames;
        it.voice = () => { throw new Error('hoarse'); };
        told.fallen = await Promise.race([it.speak('Oh').then(() => 'said'), new Promise((resolve) => { it.addEventListener('caption', ({ detail }) => { if (detail.words === 'Oh') resolve('said'); }); })]);
        it.hush();
        return { ...told, asked: asked.join() };
    });
    check('voice: it says the sentence, which is shown', told.said === true && told.caption === 'Aha' && told.asked === 'Aha,Papa', JSON.stringify(told));
    check('voice: the mouth follows what the ear hears', told.open > 0.3, told.open);
    check('voice: or the times that it gives', told.timed === true, told.timed);
    check('voice: if it fails, the browser takes over', told.fallen === 'said', told.fallen);
    await close(page, 'voice');
}

// Callback keys of a clip, where a pack that has some was built.
async function keys(browser) {
    if (!fs.existsSync(path.join(project, 'walker.noh'))) return;
    const page = await show(browser, '<noh-character id="it" src="walker.noh" clip="walk" light="plain" level="3" style="width: 64px; height: 64px"></noh-character>');
    await whole(page, 'it');
    const told = await page.evaluate(() => {
        const it = document.getElementById('it'), seen = [];
        it.addEventListener('key', ({ detail }) => seen.push(detail));
        for (let i = 0; i < 15; i++) it.character.advance(0.1);
        return seen;
    });
    check('keys: a step of a walk is an event', told.length > 0 && told.every(({ name, clip, layer, weight }) => name && clip === 'walk' && layer === 'body' && weight > 0), JSON.stringify(told));
    const shares = await page.evaluate(() => ['face', 'upper', 'full'].map((view) => {
        const it = document.getElementById('it');
        it.view = view;
        const { box, all } = it.character.camera;
        return (box[4] - box[1]) / (all[4] - all[1]);
    }));
    check('keys: the camera frames a face, the upper part, or all', shares[0] < 0.35 && Math.abs(shares[1] - 0.45) < 0.1 && shares[2] === 1, shares.join());
    await close(page, 'keys');
}

// A WebP picture is decoded by the browser, to the pixels of `noh build`; what is left out is a warning.
async function webp(page, drop) {
    await page.evaluate(() => {
        window.warned = [];
        document.getElementById('it').addEventListener('warning', ({ detail }) => warned.push(detail.message));
    });
    await drop('webp.gltf');
    await page.waitForFunction(() => warned.length || document.getElementById('it').error);
    const told = await page.evaluate(() => ({ warned, error: document.getElementById('it').error }));
    check('dropped: a picture that is not there is an event, and nothing else', told.error === '' && told.warned.length === 1 && told.warned[0].includes('nowhere.png'), JSON.stringify(told));
    check('dropped: and a text', (await page.textContent('noh-character .message')).includes('nowhere.png'));
    if (!fs.existsSync(path.join(project, 'webp.noh'))) return;
    const made = await page.evaluate(async () => {
        const { convert } = await import('./node_modules/noh-character/index.js'), file = new File([await (await fetch('webp.gltf')).arrayBuffer()], 'webp.gltf');
        return Array.from(await convert([file]));
    });
    check('dropped: a WebP picture has the bytes of `noh build`', fs.readFileSync(path.join(project, 'webp.noh')).equals(Buffer.from(made)), made.length);
}

// What a visitor drops: a pack, a model, which is converted, clips for it, and what is none or broken.
async function dropped(browser) {
    const page = await show(browser, '<noh-character id="it" drop></noh-character>');
    const drop = (...names) => page.evaluate(async (all) => {
        const it = document.getElementById('it'), data = new DataTransfer(), over = new DragEvent('dragover', { bubbles: true, cancelable: true });
        for (const name of all) data.items.add(new File([await (await fetch(name)).arrayBuffer()], name));
        it.dispatchEvent(over);
        it.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
        return over.defaultPrevented;
    }, names);
    check('dropped: it takes files', await drop('face.nohz'));
    await page.waitForFunction(() => document.getElementById('it').whole);
    check('dropped: a pack', await page.evaluate(() => document.getElementById('it').targets.includes('smile')));
    const fails = async (name, words) => {
        await drop(name);
        await page.waitForFunction(() => document.getElementById('it').error);
        const said = await page.evaluate(() => document.getElementById('it').error);
        check(`dropped: ${name} is refused in words, and the pack stays`, said.startsWith(`${name} cannot be shown: `) && said.includes(words)
            && await page.evaluate(() => document.getElementById('it').targets.includes('smile')), said);
    };
    await fails('types.ts', 'none of .noh');
    await fails('turn.bvh', 'motion alone');
    if (!fs.existsSync(path.join(inside, 'convert'))) return close(page, 'dropped');
    await fails('cut.glb', 'truncated');
    const arrives = async (what, has) => {
        await page.waitForFunction((name) => document.getElementById('it').error || document.getElementById('it').clips.some((clip) => clip.name === name), has);
        check(`dropped: ${what}`, await page.evaluate(() => document.getElementById('it').whole && document.getElementById('it').error) === '');
    };
    await drop('arm.glb');
    await arrives('a model is converted and shown', 'bend');
    await drop('turn.bvh');
    await arrives('a clip joins the model before it', 'turn');
    await frames(page, 'it', 1);
    await page.screenshot({ path: path.join(out, 'dropped.png') });
    await webp(page, drop);
    return close(page, 'dropped');
}

// A visitor who asks for less motion; and a context that goes and comes back.
async function still(browser) {
    const page = await show(browser, '<noh-character id="it" src="face.noh" clip="smile" auto-life style="height: 64px; width: 64px"></noh-character>', { reducedMotion: 'reduce' });
    await whole(page, 'it');
    const state = await page.evaluate(() => ({ paused: document.getElementById('it').character.paused, alive: document.getElementById('it').character.alive }));
    check('still: nothing moves by itself', state.paused && !state.alive);
    await page.emulateMedia({ reducedMotion: 'no-preference' });
    await page.waitForFunction(() => document.getElementById('it').character.alive);
    check('still: until the visitor changes that', await page.evaluate(() => !document.getElementById('it').character.paused));
    await page.emulateMedia({ reducedMotion: 'reduce' });
    const gpu = () => page.evaluate(() => document.getElementById('it').memory.gpu);
    const before = await gpu();
    await page.evaluate(() => {
        const it = document.getElementById('it'), taken = it.character.gl.getExtension('WEBGL_lose_context');
        window.events = [];
        for (const type of ['lost', 'restored']) it.addEventListener(type, () => events.push(type));
        taken.loseContext();
        setTimeout(() => taken.restoreContext(), 200);
    });
    await page.waitForFunction(() => events.length === 2);
    await frames(page, 'it', 1);
    check('still: a lost context comes back, to the byte', await gpu() === before && await page.evaluate(() => document.getElementById('it').character.program._web_check()) === 0);
    await close(page, 'still');
}

// A minute of a face that lives and a clip (NOH_LONG=1: ten minutes), in steps of a thirtieth of a second, every sixtieth
// drawn.
async function long(browser) {
    const page = await show(browser, '<noh-character id="it" src="face.noh" clip="smile" auto-life style="height: 64px; width: 64px"></noh-character>');
    await whole(page, 'it');
    const told = await page.evaluate(async (lasts) => {
        const { character } = document.getElementById('it'), p = character.program;
        await character.prepared;
        character.stopped = true;
        const minutes = (n) => {
            for (let i = 0; i < n * 1800; i++) {
                if (i % 60) p.check(p._web_step(1 / 30));
                else character.advance(1 / 30);
            }
        };
        const measure = async () => {
            for (let i = 0; i < 4; i++) { gc(); await new Promise((resolve) => setTimeout(resolve, 20)); }
            return { heap: performance.memory.usedJSHeapSize, wasm: p.memory.buffer.byteLength, gpu: p._web_gpu_bytes(), objects: p.textures.length + p.buffers.length };
        };
        minutes(lasts / 4);
        const before = await measure();
        minutes(lasts);
        return { before, after: await measure(), error: p._web_check() };
    }, process.env.NOH_LONG === '1' ? 10 : 1);
    check('minutes: no byte of memory and no object more', ['wasm', 'gpu', 'objects'].every((key) => told.before[key] === told.after[key]), JSON.stringify(told));
    check('minutes: nor of the heap of JavaScript', told.after.heap - told.before.heap < 128 * 1024, `${told.before.heap} to ${told.after.heap}`);
    check('minutes: no GL error', told.error === 0);
    await close(page, 'minutes');
}

run({ readme, two, used, programs, lights, early, model, lazy, stands, turned, behind, hotspots, voice, keys, dropped, still, long }, ['--enable-precise-memory-info'], { '/project/': project });
