// load.js: the pack is asked for while the program still arrives; a wire form is unpacked as it comes, and its coarsest
// levels are shown before the rest is there. ?pack=NAME: another one than page.nohz.
'use strict';

const ownPack = query.get('pack') || 'page.nohz';
const asked = fetch(ownPack);
const kilobytes = (bytes) => Math.round(bytes / 1000).toLocaleString('en');

// What has arrived, in words and as a bar. Without a length that the server tells, only in words.
function showProgress(taken, all, shows) {
    const bar = byId('progress-bar');
    byId('progress').hidden = shows === 2;
    bar.hidden = !all;
    if (all) Object.assign(bar, { max: all, value: taken });
    byId('progress-text').textContent = `${shows ? 'finer detail' : 'loading'}: ${kilobytes(taken)}${all ? ` of ${kilobytes(all)}` : ''} kB`;
}

// Calls show(1) as soon as there is something to show and show(2) when all is there. asked: the answer to a fetch.
async function load(asked, show) {
    const answer = await asked;
    if (!answer.ok) fail(`no pack: the server says ${answer.status}`);
    const reader = answer.body.getReader(), all = Number(answer.headers.get('Content-Length'));
    let head = new Uint8Array(0), taken = 0, shows = 0;
    const next = async () => {
        const { value, done } = await reader.read().catch(() => fail(`the connection was lost after ${kilobytes(taken)} kB of the pack`));
        if (!done) taken += value.length;
        showProgress(taken, all, shows);
        return done ? null : value;
    };
    while (head.length < 4) { // which of both it is
        const more = await next();
        if (!more) fail('the pack is no pack: it has ended after ' + head.length + ' bytes');
        head = joined([head, more]);
    }
    if (String.fromCharCode(...head.subarray(0, 4)) !== 'NOHZ') return loadPlain(head, next, show);
    const place = Module._web_wire(), room = Module._web_piece_bytes();
    if (!place) fail(text(Module._web_error()));
    for (let bytes = head; bytes; bytes = await next()) {
        for (let at = 0; at < bytes.length; at += room) {
            const piece = bytes.subarray(at, at + room);
            Module.HEAPU8.set(piece, place);
            check(Module._web_wire_push(piece.length));
        }
        const now = Module._web_wire_shows();
        if (now > shows) show(shows = now);
        showProgress(taken, all, shows);
    }
    if (shows < 2) fail(`the pack was cut short: ${kilobytes(taken)} kB came`);
    return undefined;
}

function joined(parts) {
    const out = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
    parts.reduce((at, part) => { out.set(part, at); return at + part.length; }, 0);
    return out;
}

async function loadPlain(head, next, show) {
    const parts = [head];
    for (let more = await next(); more; more = await next()) parts.push(more);
    const file = joined(parts), place = Module._web_pack(file.length);
    if (!place) fail(`the pack has ${file.length} bytes, more than the page was built for`);
    Module.HEAPU8.set(file, place);
    showProgress(file.length, file.length, 2);
    show(2);
}

// ---- a file of the visitor's own ----

// Meanwhile nothing is drawn: what is shown lies where the file goes. If that cannot be shown, the page's own pack is
// again.
let opening = false;
async function openFile(file) {
    if (opening || lost || !window.noh.whole) return;
    opening = true;
    say('');
    try {
        if (!/\.nohz?$/i.test(file.name)) fail('neither .noh nor .nohz: noh build makes a pack of it');
        const show = takeOver();
        await load(new Response(file.stream(), { headers: { 'Content-Length': file.size } }), show);
        byId('file-text').textContent = file.name;
    } catch (error) {
        window.noh.error = '';
        if (!window.noh.whole) {
            byId('file-text').textContent = 'or drop one here: .noh, .nohz';
            await load(fetch(ownPack), takeOver()).catch(() => {});
        }
        say(`${file.name} cannot be shown: ${error.message || error}`);
    }
    opening = false;
}

byId('open-file').addEventListener('click', () => byId('file').click());
byId('file').addEventListener('change', () => {
    if (byId('file').files[0]) openFile(byId('file').files[0]);
    byId('file').value = '';
});
document.addEventListener('dragover', (event) => event.preventDefault());
document.addEventListener('drop', (event) => {
    event.preventDefault();
    if (event.dataTransfer.files[0]) openFile(event.dataTransfer.files[0]);
});
