// convert.js: models of a visitor's own as packs, by the converter, which is asked for when it is first needed and runs in
// a worker of its own (tools/web_convert): the page goes on meanwhile. As `noh build` makes them, byte for byte.

export const models = /\.(glb|gltf|vrm|obj|bvh)$/i;
const main = /\.(glb|gltf|vrm|obj)$/i;

// What it cannot do, before anything is asked for.
export function refusal(names) {
    const known = names.filter((name) => models.test(name));
    if (names.some((name) => /\.fbx$/i.test(name))) return 'FBX is not converted by a page: noh build does it';
    if (!known.length) return `none of .glb, .gltf, .vrm, .obj, .bvh, .noh, .nohz`;
    if (known.filter((name) => main.test(name)).length > 1) return 'one model at a time, and any number of .bvh with it';
    return '';
}

// files: File objects, a model and what it names (.bin, pictures), or clips. tell(words) is called as it goes on.
// options: as those of `noh build`. Resolves to the pack's bytes.
export async function convert(files, { tell = () => {}, options = [], base = new URL('convert/', import.meta.url) } = {}) {
    const names = files.map((file) => file.name), refused = refusal(names);
    if (refused) throw new Error(refused);
    const order = [...files].sort((a, b) => Number(main.test(b.name)) - Number(main.test(a.name)));
    tell('the converter is loaded');
    const read = await Promise.all(order.map(async (file) => ({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) })));
    const worker = new Worker(new URL('worker.js', base));
    try {
        return await new Promise((resolve, reject) => {
            worker.onerror = () => reject(new Error('the converter cannot be loaded: the page was built without it, or the connection was lost'));
            worker.onmessage = ({ data }) => {
                if (data.progress) tell(data.progress);
                else if (data.pack) resolve(data.pack);
                else reject(new Error(data.error));
            };
            worker.postMessage({ files: read, options }, read.map(({ bytes }) => bytes.buffer));
        });
    } finally {
        worker.terminate(); // its memory goes with it
    }
}
