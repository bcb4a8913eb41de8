// worker.js: converts in a worker, and tells what it does. A message { files: [{ name, bytes }], options } comes, the first
// file the model; messages { progress }, and at last { pack, warnings } or { error } go.
import nohConvert from './convert.js';
import { compileFrom } from '../reach.js';
import { decodeAll } from './webp.js';

const decoder = new TextDecoder();

// Bytes of a stream of the program, as lines; a carriage return ends one too: so a terminal shows progress.
function lines(tell) {
    let line = [];
    return (byte) => {
        if (byte === null) return;
        if (byte !== 10 && byte !== 13) return void line.push(byte);
        if (line.length) tell(decoder.decode(new Uint8Array(line)));
        line = [];
    };
}

async function convert({ files, options }) {
    const warnings = [], errors = [], module = await compileFrom(new URL('./convert.wasm', import.meta.url), 'converter');
    const program = await nohConvert({
        instantiateWasm: (imports, use) => { WebAssembly.instantiate(module, imports).then((instance) => use(instance, module)); return {}; },
        stdout: lines((line) => { if (line.startsWith('warning: ')) warnings.push(line.slice(9)); }),
        stderr: lines((line) => {
            const said = line.replace('\u001b[K', '').trim();
            if (line.startsWith('noh: ')) errors.push(said.slice(5));
            else if (said) postMessage({ progress: said });
        }),
    });
    program.FS.mkdir('/in');
    program.FS.mkdir('/webp');
    for (const [name, bytes] of await decodeAll(files)) program.FS.writeFile(`/webp/${name}`, bytes);
    program.FS.chdir('/in');
    for (const { name, bytes } of files) program.FS.writeFile(name, bytes);
    const models = files.filter(({ name }) => /\.(glb|gltf|vrm|fbx|obj|bvh|csv|trc|c3d|vrma)$/i.test(name)).map(({ name }) => name);
    const status = program.callMain(['build', ...models, '-o', '/out.noh', ...options]);
    if (status) throw new Error(errors.join('\n') || `the converter ended with ${status}`);
    return { pack: program.FS.readFile('/out.noh'), warnings };
}

onmessage = ({ data }) => convert(data).then((made) => postMessage(made, [made.pack.buffer]),
    (error) => postMessage({ error: /memory|OOM/i.test(String(error)) ? 'there is not enough memory to convert it' : String(error.message || error) }));
