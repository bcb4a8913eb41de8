// web_shaders.js IN OUT FILE...: writes OUT, the shaders of IN (build/gen/shaders.gen.c) as a page loads them: without
// spaces, empty lines and #line, without functions that nothing calls, and with short names in place of those that no
// string of the C FILEs has. Names after a point are fields or swizzles, and structs stay as they are. Geometry shaders,
// which WebGL lacks, become empty.
'use strict';
const fs = require('fs');
const PIECE = 4000; // characters: C99 promises strings of 4,095
const escapes = { n: '\n', '"': '"', '\\': '\\', '?': '?' };

const unquoted = (lines) => lines.replace(/^\s*"|",?$/gm, '').replace(/\n/g, '').replace(/\\(.)/g, (_, c) => escapes[c]);
const quoted = (text) => `"${text.replace(/[\\"?]/g, '\\$&').replace(/\n/g, '\\n')}"`;
const words = /(?<![\w.#])[A-Za-z_]\w*/g, structs = /struct \w+ \{[^}]*\}/g, both = new RegExp(`${structs.source}|${words.source}`, 'g');

// Text without what no compiler needs. Directives keep their lines.
function squeezed(text) {
    const lines = [];
    for (const line of text.split('\n')) {
        if (!line || line.startsWith('#line')) continue;
        if (line.startsWith('#') || !lines.length || lines[lines.length - 1].startsWith('#')) lines.push(line);
        else lines[lines.length - 1] += ` ${line}`;
    }
    return lines.map((line) => `${line.startsWith('#') ? line : shortNumbers(line.replace(blanks, (all, c, next) => ('+-'.includes(c) && c === next && all.endsWith(' ') ? `${c} ` : c)))}\n`).join('');
}
const blanks = / *([-+*/%=<>!&|^?:;,(){}[\]]) *(?=(.?))/g; // "a - -b" is no "a--b"
const shortNumbers = (line) => line.replace(/(?<![\w.])(\d+)\.0+(?![\d.e])/g, '$1.').replace(/(?<![\w.])0\.(?=\d)/g, '.');

// What a compiler reads of a text, one token a line.
const tokens = (text) => shortNumbers(text.replace(/^#line.*$/gm, '')).match(/[\w.]+|\+\+|--|[-+*/%<>=!&|^]=|<<|>>|&&|\|\||\S/g).join('\n');

// The functions and the bodies of a text: what stands between two places outside of all braces.
function units(text) {
    const out = [];
    let depth = 0, start = 0;
    for (let i = 0; i < text.length; i++) {
        depth += text[i] === '{' ? 1 : text[i] === '}' ? -1 : 0;
        if (depth < 0) return [text];
        if (depth === 0 && (text[i] === '}' || text[i] === ';')) {
            out.push(text.slice(start, i + 1));
            start = i + 1;
        }
    }
    return depth ? [text] : [...out, text.slice(start)];
}

// A text without what stands between #ifdef of a name, which only shaders of a game's own define, and its #endif.
function without(text, name) {
    let depth = 0;
    return text.split('\n').filter((line) => {
        if (depth || line === `#ifdef ${name}`) depth += /^#\s*if/.test(line) ? 1 : /^#\s*endif/.test(line) ? -1 : 0;
        else return true;
        return false;
    }).join('\n');
}

// The texts without functions that neither they nor a string of C name: a page has no shaders of its own, which might.
function called(texts, strings) {
    const count = new Map(), head = /(^|[;}\n])((?:void|bool|float|u?int|[ui]?vec[234]|noh_\w+) +(\w+)\([^;{}]*\)\s*)\{[^]*\}$/;
    for (const [word] of texts.join('\n').matchAll(words)) count.set(word, (count.get(word) || 0) + 1);
    const kept = texts.map((text) => units(text).map((unit) => {
        const found = unit.match(head);
        const goes = found && found[3] !== 'main' && count.get(found[3]) === 1 && !strings.has(found[3]);
        return goes ? unit.slice(0, found.index + found[1].length) : unit;
    }).join(''));
    return kept.join('') === texts.join('') ? texts : called(kept, strings);
}

// Short names for what the texts declare by a type and a name, unless it is C's, or a function of GLSL has the same.
// Locals that never meet in a function share a short name; globals, and what a directive names, have their own.
function renames(texts, strings) {
    const all = texts.join('\n'), parts = texts.flatMap(units), sets = parts.map((part) => new Set(part.match(words))), count = new Map(), own = [], to = new Map();
    for (const [word] of all.matchAll(words)) count.set(word, (count.get(word) || 0) + 1);
    const names = (pattern) => new Set(Array.from(all.replace(structs, '').matchAll(pattern), (m) => m[1]));
    const type = '\\b(?:void|bool|float|u?int|[ui]?vec[234]|mat[234](?:x[234])?|noh_\\w+) +([a-z]\\w+)';
    const called = names(/(\w+) *\(/g), functions = names(new RegExp(`${type} *\\(`, 'g'));
    for (const name of names(new RegExp(type, 'g'))) if (!strings.has(name) && name !== 'main' && (functions.has(name) || !called.has(name))) own.push(name);
    own.sort((a, b) => count.get(b) - count.get(a) || (a < b ? -1 : 1));
    const globals = new Set(functions), outside = [...parts.filter((part) => !part.endsWith('}')), ...all.match(/^#.*/gm)];
    for (const text of outside) for (const word of text.match(words) || []) globals.add(word);
    const taken = new Set([...globals].concat('do', 'if', 'in'));
    for (const name of own) {
        const near = new Set(sets.filter((part) => part.has(name)).flatMap((part) => [...part].map((word) => to.get(word) || word)));
        for (let n = 0; !to.has(name) && letters(n).length < name.length; n++) {
            if (!near.has(letters(n)) && !taken.has(letters(n))) to.set(name, letters(n));
        }
        if (globals.has(name)) taken.add(to.get(name));
    }
    return to;
}
function letters(n) {
    const a = 'abcdefghijklmnopqrstuvwxyz';
    return n < 26 ? a[n] : letters(Math.floor(n / 26) - 1) + a[n % 26];
}

const decoded = (numbers) => String.fromCharCode(...numbers.match(/\d+/g).slice(0, -1).map(Number)); // without its zero
const encoded = (text) => `    ${[...`${text}\0`].map((c) => c.charCodeAt(0)).join(',').replace(/((?:\d+,){24})/g, '$1\n    ')}`;
// Each text is an array of literals, or of characters.
const [, , from, to, ...files] = process.argv;
// Names that occur in a string of C are not shortened: all words of a string without spaces; of any other string, which
// may be GLSL, the words that begin with noh_.
const strings = new Set(files.flatMap((file) => Array.from(fs.readFileSync(file, 'utf8').matchAll(/"(?:[^"\\\n]|\\.)*"/g))
    .flatMap(([text]) => text.match(/^"\w+[^\s"]*"$/.test(text) ? /\w+/g : /\bnoh_\w+/g) || [])));
const parts = fs.readFileSync(from, 'utf8').split(/^((?:static const char \*const \w+_pieces|const char \w+)\[\] = \{\n[^]*?\n\};\n)/m);
const all = parts.map((part, i) => (i % 2 ? (part.startsWith('static') ? unquoted : decoded)(part.slice(part.indexOf('\n') + 1, part.indexOf('\n};'))) : null));
const small = called(all.filter((text) => text !== null).map((text) => without(text, 'NOH_EXTRAS')), strings);
const texts = all.map((text, i) => (text === null ? null : small[(i - 1) / 2]));
const short = renames(small, strings);
for (let i = 1; i < parts.length; i += 2) {
    const renamed = parts[i].includes('_geom_pieces') ? '' : texts[i].replace(/\\\n/g, ' ').replace(both, (word) => short.get(word) || word), text = squeezed(renamed) || '\n', pieces = [], line = parts[i].indexOf('\n') + 1;
    for (let at = 0; at < text.length; at += PIECE) pieces.push(quoted(text.slice(at, at + PIECE)));
    if (text.trim() && tokens(text) !== tokens(renamed)) throw new Error(`${from}: a text of ${parts[i].slice(0, line)} has other tokens when it is small`);
    const isArray = parts[i].startsWith('static');
    parts[i] = `${parts[i].slice(0, line)}${isArray ? `    ${pieces.join(',\n    ')},` : encoded(text)}\n};\n`;
    if (isArray) parts[i + 1] = parts[i + 1].replace(/_pieces, \d+\n/, `_pieces, ${pieces.length}\n`);
}
fs.writeFileSync(to, parts.join(''));
