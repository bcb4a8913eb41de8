// three.js FOLDER CHROMIUM OUT PROJECT NOH: NohObject3D of the package as it was installed in PROJECT, in a scene of three.js:
// its vertices against `noh dump`, three's own objects, materials, shadow and rays, two of them, one less, a lost context.
// Prints its checks as TAP.
'use strict';
const childProcess = require('child_process');
const fs = require('fs');
const path = require('path');
const { out, check, keep, same, run, address } = require('./harness.js');
const { newPage } = require('./browser.js');

const [project, noh] = process.argv.slice(5);

// x, y, z of each vertex that `noh dump` writes.
function dumped(pack, ...options) {
    const file = path.join(out, 'three.obj');
    childProcess.execFileSync(noh, ['dump', path.join(project, pack), '-o', file, ...options], { stdio: 'ignore' });
    const lines = fs.readFileSync(file, 'utf8').split('\n');
    return ['v', 'vn'].map((what) => lines.filter((l) => l.startsWith(`${what} `)).flatMap((l) => l.split(' ').slice(1, 4).map(Number)));
}

const apart = (a, b) => a.reduce((most, v, i) => Math.max(most, Math.abs(v - b[i])), a.length === b.length ? 0 : Infinity);

async function open(browser) {
    const page = await newPage(browser, { viewport: { width: 340, height: 340 } });
    page.problems = [];
    page.on('pageerror', (error) => page.problems.push(String(error)));
    page.on('console', (message) => { if (message.type() === 'error') page.problems.push(message.text()); });
    await page.goto(`${address()}/web/three.html`);
    await page.waitForFunction(() => window.scene);
    return page;
}

const frame = (page, seconds = 0) => page.evaluate((s) => window.scene.frame(s), seconds);

async function three(browser) {
    const page = await open(browser);
    console.log(`# three.js r${await page.evaluate(() => window.scene.revision)}`);
    await frame(page);
    await keep(page, 'three_alone.png');
    const at = await page.evaluate(() => window.scene.add('/project/face.noh', 0, { alive: false, level: 0 }));
    check('three: no GL error', await frame(page) === 0);
    await keep(page, 'three_rest.png');
    check('three: it is there', !same('three_alone.png', 'three_rest.png'));
    await page.evaluate((i) => { window.scene.objects[i].visible = false; }, at);
    await frame(page);
    await keep(page, 'three_hidden.png');
    check('three: the others are drawn as without it', same('three_alone.png', 'three_hidden.png'));
    await page.evaluate((i) => { window.scene.objects[i].visible = true; window.scene.objects[i].character.setWeight('smile', 1); }, at);
    await frame(page);
    await keep(page, 'three_smile.png');
    check('three: a target moves it', !same('three_rest.png', 'three_smile.png'));
    const [positions, normals] = dumped('face.noh', '--weight', 'smile=1');
    const [p, n] = [await page.evaluate((i) => window.scene.read(i, 0, 'position'), at), await page.evaluate((i) => window.scene.read(i, 0, 'normal'), at)];
    check('three: its vertices are those of noh dump', apart(p, positions) < 2e-5, apart(p, positions));
    check('three: and its normals', apart(n, normals) < 2e-3, apart(n, normals));
    await shadows(page, at);
    await rays(page, at);
    await lost(page, at);
    await several(page, at);
    check('three: the browser reports no problem', page.problems.length === 0, page.problems.join(' | '));
    await page.close();
}

async function shadows(page, at) {
    const cast = (on) => page.evaluate(([i, c]) => { for (const mesh of window.scene.objects[i].meshes) mesh.castShadow = c; }, [at, on]);
    await cast(false);
    await frame(page);
    await keep(page, 'three_shadeless.png');
    check('three: it casts a shadow', !same('three_smile.png', 'three_shadeless.png'));
    await cast(true);
    await page.evaluate((i) => window.scene.objects[i].materials.forEach((m) => { m.wireframe = true; }), at);
    await frame(page);
    await keep(page, 'three_wires.png');
    check('three: its materials are three\'s', !same('three_smile.png', 'three_wires.png'));
    await page.evaluate((i) => window.scene.objects[i].materials.forEach((m) => { m.wireframe = false; }), at);
}

async function rays(page) {
    const found = await page.evaluate(() => [window.scene.hit(0, 0), window.scene.hit(-0.95, 0.95)]);
    check('three: a ray meets it', found[0].length === 1 && found[0][0].mesh === 'mask' && found[0][0].distance > 0.5 && found[0][0].distance < 1, JSON.stringify(found));
    check('three: and passes beside it', found[1].length === 0);
}

async function lost(page) {
    await page.evaluate(() => {
        const gl = window.scene.renderer.getContext();
        window.taken = gl.getExtension('WEBGL_lose_context');
        window.restored = new Promise((resolve) => { gl.canvas.addEventListener('webglcontextrestored', () => setTimeout(resolve, 50)); });
        window.taken.loseContext();
    });
    await page.evaluate(async () => {
        await new Promise((resolve) => setTimeout(resolve, 100));
        window.taken.restoreContext();
        await window.restored;
    });
    check('three: no GL error after a lost context', await frame(page) === 0);
    await frame(page);
    await keep(page, 'three_restored.png');
    check('three: and the same picture', same('three_smile.png', 'three_restored.png'));
}

// Another one, with a body if there is one, in the wire form and of coarse levels; then the first is gone.
async function several(page, at) {
    const walks = fs.existsSync(path.join(project, 'walker.noh'));
    const other = await page.evaluate((w) => window.scene.add(w ? '/project/walker.noh' : '/project/face.nohz', 0.2, { alive: false }), walks);
    if (walks) {
        await page.evaluate((i) => {
            const object = window.scene.objects[i];
            object.scale.setScalar(0.2);
            object.position.y = -0.16;
            object.character.play('walk', { fade: 0, time: 0.4 });
        }, other);
    }
    check('three: two', await frame(page) === 0);
    await keep(page, 'three_two.png');
    check('three: the second one shows', !same('three_two.png', 'three_restored.png'));
    if (walks) {
        await page.evaluate(() => { for (let i = 0; i < 5; i++) window.scene.frame(0.05); });
        await keep(page, 'three_walks.png');
        check('three: and walks', !same('three_two.png', 'three_walks.png'));
    }
    const left = await page.evaluate((i) => {
        const { objects } = window.scene, gl = window.scene.renderer.getContext(), [gone] = objects.splice(i, 1), { program } = gone.character;
        gone.dispose();
        gl.getError(); // three.js deletes what geometries had in the lost context, too
        return { bytes: program._web_gpu_bytes(), lost: gl.isContextLost() };
    }, at);
    check('three: one less: its bytes are given back, the context stays', left.bytes === 0 && !left.lost, JSON.stringify(left));
    const after = await frame(page, 0.05);
    check('three: and the other goes on', after === 0, after);
    await keep(page, 'three_one.png');
}

run({ three }, [], { '/project/': project, '/web/': __dirname, '/three/': path.dirname(path.dirname(require.resolve('three'))) });
