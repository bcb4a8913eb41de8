// load.js: the pack, which index.html requests while the program is loading (?pack=NAME: instead of page.nohz), and the
// visitor's files.
'use strict';

const ownText = byId('file-text').textContent;

// Until the first picture, the share of the program and of the first bytes of the pack; then of the rest. As text alone
// if the server sends no length.
const programBytes = Number(document.documentElement.dataset.program), firstBytes = Number(document.documentElement.dataset.first);
let programCame = 0;
function showProgress({ taken, all, shows, program = programCame }) {
    const bar = byId('progress-bar'), kilobytes = (bytes) => Math.round(bytes / 1000).toLocaleString('en');
    programCame = program;
    const rest = `${kilobytes(taken)}${all ? ` of ${kilobytes(all)}` : ''} kB`, first = programBytes + Math.min(all || firstBytes, firstBytes);
    const share = shows ? taken / all : Math.min(1, (program + taken) / first);
    byId('progress').hidden = shows === 2;
    bar.hidden = !Number.isFinite(share);
    if (!bar.hidden) bar.value = share;
    byId('progress-text').textContent = shows ? `finer detail: ${rest}` : programBytes ? `loading: ${Math.round(100 * share)} %` : `loading: ${rest}`;
}

function showWords(words) {
    byId('progress').hidden = false;
    byId('progress-bar').hidden = true;
    byId('progress-text').textContent = words;
}

async function load(source) {
    await character.load(source);
    byId('progress').hidden = true;
}

// ---- the visitor's files ----

// The present character stays until the new one can be shown. If the file is damaged, the page's own pack is shown
// again.
let opening = false, visitor = null;
let again = () => fetch(ownPack); // the shown pack, again
async function openFiles(list) {
    const files = [...list], { name } = files[0];
    if (opening || !window.noh.whole || character.lost) return;
    opening = true;
    say('');
    const before = character.program, warnings = [];
    try {
        visitor = visitor || new (await import('./package/convert.js')).Visitor();
        const pack = await visitor.pack(files, { tell: showWords, warn: (words) => warnings.push(words) });
        fresh = true;
        character.address = undefined; // the page's own program may be of faces alone
        await load(pack);
        say(warnings.join('\n'));
        again = () => pack;
        byId('file-text').textContent = files.map((file) => file.name).join(', ');
    } catch (error) {
        fresh = true;
        window.noh.error = '';
        byId('progress').hidden = true;
        if (character.program !== before) {
            byId('file-text').textContent = ownText;
            again = () => fetch(ownPack);
            await load(again()).catch(() => {});
        }
        say(`${name} cannot be shown: ${error.message || error}`);
    }
    opening = false;
}

byId('open-file').addEventListener('click', () => byId('file').click());
byId('file').addEventListener('change', () => {
    if (byId('file').files.length) openFiles(byId('file').files);
    byId('file').value = '';
});
document.addEventListener('dragover', (event) => event.preventDefault());
document.addEventListener('drop', (event) => {
    event.preventDefault();
    if (event.dataTransfer.files.length) openFiles(event.dataTransfer.files);
});
