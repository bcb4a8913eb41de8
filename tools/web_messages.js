// web_messages.js PROGRAM.wasm TEXTS FILE...: takes the sentences of C FILEs out of the data of a program, which keeps
// zeros in their places: a page without errors never needs them, and they are a twentieth of its bytes. A sentence has
// four words or more; names of drivers in gl_quirks.c, which are compared, are shorter. TEXTS gets a line for each, its
// address and the sentence; the page fetches it (package/program.js).
'use strict';
const crypto = require('crypto');
const fs = require('fs');
const [, , file, texts, ...sources] = process.argv;
const program = fs.readFileSync(file), escapes = { n: '\n', t: '\t', 0: '\0' };

const literals = new Set();
for (const source of sources) {
    for (const [all] of fs.readFileSync(source, 'utf8').matchAll(/(?:"(?:[^"\\\n]|\\.)*"\s*)+/g)) {
        literals.add(Array.from(all.matchAll(/"((?:[^"\\]|\\.)*)"/g), (m) => m[1]).join('').replace(/\\(.)/g, (_, c) => escapes[c] || c));
    }
}

// The data segments: { at: in the file, address, bytes }.
function segments() {
    const found = [];
    let p = 8;
    const number = () => {
        for (let value = 0, shift = 0; ; shift += 7) {
            const byte = program[p++];
            value += (byte & 127) * 2 ** shift;
            if (byte < 128) return value;
        }
    };
    while (p < program.length) {
        const id = program[p++], bytes = number(), end = p + bytes;
        if (id !== 11) { p = end; continue; }
        for (let left = number(); left; left--) {
            const kind = number();
            if (kind === 2) number();
            if (kind === 1 || program[p++] !== 0x41) throw new Error(`${file}: a data segment without a constant address`);
            const address = number();
            if (program[p++] !== 0x0b) throw new Error(`${file}: an address of a data segment that is no constant`);
            const size = number();
            found.push({ at: p, address, bytes: size });
            p += size;
        }
    }
    return found;
}

const sentences = [...literals].filter((text) => /^[ -~]*$/.test(text) && text.split(' ').length >= 4);
const lines = [], places = segments();
// A linker may put a short text into the end of a long one, wherever else its bytes are: the longest such end stays.
const taken = (text) => { let i = 1; while (i < text.length && !literals.has(text.slice(i))) i++; return i; };
const out = Buffer.from(program);
for (const text of sentences) {
    const at = program.indexOf(`\0${text}\0`, 0, 'latin1') + 1, place = places.find((s) => at > s.at && at < s.at + s.bytes);
    if (!place) continue;
    out.fill(0, at, at + taken(text));
    lines.push([place.address + at - place.at, text]);
}
if (lines.length < 100) throw new Error(`${file}: only ${lines.length} of ${sentences.length} sentences are in its data`);
lines.sort((a, b) => a[0] - b[0]);
// The program and TEXTS may come from different builds, out of a cache. So both have a mark, the program in a custom
// section and TEXTS in its first line, and the page compares them.
const told = lines.map((line) => `${line.join(' ')}\n`).join('');
const mark = crypto.createHash('sha256').update(told).digest('hex').slice(0, 8), section = `\x05texts${mark}`;
fs.writeFileSync(file, Buffer.concat([out, Buffer.from([0, section.length]), Buffer.from(section, 'latin1')]));
fs.writeFileSync(texts, `${mark}\n${told}`);
