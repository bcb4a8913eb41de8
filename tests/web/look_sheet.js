// look_sheet.js: the pictures of look.js as a table, and figures of them. window.sheet(all) resolves to the rows.
'use strict';
const addressOf = (model, light, angle, maker) => `/out/${model}_${light}_${angle}_${maker}.png`;

// Pixels as { width, height, data }.
async function pixelsOf(address, side) {
    const image = new Image(), canvas = document.createElement('canvas');
    image.src = address;
    await image.decode();
    canvas.width = canvas.height = side;
    const context = canvas.getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, side, side).data;
}

const linear = (byte) => (byte <= 10.31475 ? byte / 3294.6 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
const luma = (d, p) => 0.2126 * linear(d[p]) + 0.7152 * linear(d[p + 1]) + 0.0722 * linear(d[p + 2]);

// B. Ottosson: A perceptual color space for image processing, 2020. From linear light.
function oklab(r, g, b) {
    const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b), m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
    const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
    return [1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s, 0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s];
}

// Hue in degrees and chroma of the mean of these pixels.
function colourOf(data, pixels) {
    const sum = [0, 0, 0];
    for (const p of pixels) for (let c = 0; c < 3; c++) sum[c] += linear(data[p + c]) / pixels.length;
    const [a, b] = oklab(...sum);
    return [(Math.atan2(b, a) * 180 / Math.PI + 360) % 360, Math.hypot(a, b)];
}

// Across the edges of a shadow, in pixels, in the median: its depth by its slope, where it is half as deep.
function edgeOf(shadowed, free, figure, side) {
    const share = (p) => Math.min(luma(shadowed, p) / Math.max(luma(free, p), 1e-4), 1), inside = new Set(figure);
    const values = figure.map(share).sort((x, y) => x - y), deepest = values[Math.floor(values.length * 0.02)], widths = [];
    if (!(deepest < 0.85)) return null;
    for (const p of figure) {
        const around = [p - 4, p + 4, p - 4 * side, p + 4 * side];
        if (!around.every((q) => inside.has(q)) || Math.abs(share(p) - (1 + deepest) / 2) > (1 - deepest) / 8) continue;
        const [left, right, above, below] = around.map(share), slope = Math.hypot(right - left, below - above) / 2;
        if (slope > (1 - deepest) / 60) widths.push((1 - deepest) / slope);
    }
    widths.sort((x, y) => x - y);
    return widths.length > 20 ? widths[widths.length >> 1] : null;
}

// Z. Wang and others: Image quality assessment: from error visibility to structural similarity, 2004; of encoded grey, in
// windows of 8 x 8 that touch the figure.
function ssimOf(one, other, figure, side) {
    const grey = (d, p) => 0.299 * d[p] + 0.587 * d[p + 1] + 0.114 * d[p + 2], inside = new Set(figure);
    let sum = 0, count = 0;
    for (let y = 0; y + 8 <= side; y += 4) {
        for (let x = 0; x + 8 <= side; x += 4) {
            if (!inside.has(4 * ((y + 4) * side + x + 4))) continue;
            let [a, b, aa, bb, ab] = [0, 0, 0, 0, 0];
            for (let k = 0; k < 64; k++) {
                const p = 4 * ((y + (k >> 3)) * side + x + (k & 7)), u = grey(one, p), v = grey(other, p);
                a += u / 64; b += v / 64; aa += u * u / 64; bb += v * v / 64; ab += u * v / 64;
            }
            sum += (2 * a * b + 6.5025) * (2 * (ab - a * b) + 58.5225) / ((a * a + b * b + 6.5025) * (aa - a * a + bb - b * b + 58.5225));
            count++;
        }
    }
    return count ? sum / count : null;
}

// The opaque pixels of a peer's picture: noh's have a background.
function figureOf(data) {
    const pixels = [];
    for (let p = 0; p < data.length; p += 4) if (data[p + 3] === 255) pixels.push(p);
    return pixels;
}

async function figuresOf(all, model, light) {
    const { angles, makers, side } = all, front = (maker) => pixelsOf(addressOf(model, light, angles[0], maker), side);
    const figure = figureOf(await front('three_standard')), rows = [], ssim = [];
    for (const angle of angles) {
        const of = (maker) => pixelsOf(addressOf(model, light, angle, maker), side);
        ssim.push(ssimOf(await of('noh'), await of('noh_phone'), figureOf(await of('three_standard')), side));
    }
    for (const maker of makers) {
        const data = await front(maker), sorted = figure.slice().sort((p, q) => luma(data, p) - luma(data, q)), half = sorted.length >> 1;
        const free = { noh: 'noh_unshadowed', three_physical: 'three_unshadowed' }[maker];
        rows.push({ model, light, maker, f: {
            lit: colourOf(data, sorted.slice(half)), dim: colourOf(data, sorted.slice(0, half)),
            clipped: figure.filter((p) => Math.max(data[p], data[p + 1], data[p + 2]) >= 254).length / Math.max(figure.length, 1),
            edge: free ? edgeOf(data, await front(free), figure, side) : null,
            ssim: maker === 'noh_phone' ? ssim.reduce((x, y) => x + y, 0) / ssim.length : null,
        } });
    }
    return rows;
}

function rowOf(text, cells) {
    const row = document.getElementById('sheet').insertRow(), head = document.createElement('th');
    head.textContent = text;
    row.append(head);
    for (const cell of cells) row.insertCell().append(cell);
}

window.sheet = async (all) => {
    const rows = [];
    rowOf('', all.makers.flatMap((maker) => all.angles.map((angle) => `${maker} ${angle}`)));
    for (const model of all.models) {
        for (const light of all.lights) {
            rowOf(`${model} ${light}`, all.makers.flatMap((maker) => all.angles.map((angle) => {
                const image = new Image();
                image.src = addressOf(model, light, angle, maker);
                return image;
            })));
            rows.push(...await figuresOf(all, model, light));
        }
    }
    await Promise.all([...document.images].map((image) => image.decode()));
    return rows;
};
