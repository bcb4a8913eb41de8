// run.js CONVERT.js ARGUMENT...: the page's converter under node, on files of this machine, for the tests: `build a.glb -o
// a.noh`. Paths are absolute.
'use strict';
const fs = require('fs');
const path = require('path');

const [script, ...args] = process.argv.slice(2);
const inside = (file) => `/${path.basename(file)}`;
Object.assign(globalThis, { self: globalThis, location: { href: '' }, importScripts() {} }); // it is made for workers

(async () => {
    const source = fs.readFileSync(script), wasm = fs.readFileSync(script.replace(/js$/, 'wasm'));
    const { default: nohConvert } = await import(`data:text/javascript;base64,${source.toString('base64')}`);
    const program = await nohConvert({
        instantiateWasm: (imports, use) => { WebAssembly.instantiate(wasm, imports).then(({ instance, module }) => use(instance, module)); return {}; },
    });
    const given = args.map((argument, i) => {
        if (!path.isAbsolute(argument)) return argument;
        if (args[i - 1] !== '-o') program.FS.writeFile(inside(argument), fs.readFileSync(argument));
        return inside(argument);
    });
    const status = program.callMain(given), out = args[args.indexOf('-o') + 1];
    if (!status) fs.writeFileSync(out, program.FS.readFile(inside(out)));
    process.exitCode = status;
})().catch((error) => { console.error(String(error)); process.exitCode = 1; });
