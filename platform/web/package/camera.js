// camera.js: a camera that orbits the figures, with the vertical field of view of `noh render`, 30 degrees.

export const front = { azimuth: 0, elevation: 0.05 };

// ---- limits ----

const free = { azimuth: [-Infinity, Infinity], elevation: [-1.5, 1.5], distance: [0.15, 4] };
const units = { deg: Math.PI / 180, rad: 1, '%': 0.01 };
function measured(text) {
    const [, number, unit] = /^(-?[\d.]+)(deg|rad|%)$/.exec(text) || [];
    return number === undefined ? null : Number(number) * units[unit];
}

// Limits from two texts "theta phi radius" as in model-viewer: angles in deg or rad, phi 0 from above, the radius in % of
// the distance that frames the figures; auto: no limit of its own.
export function limitsOf(min, max) {
    const [low, high] = [min, max].map((text) => text.trim().split(/\s+/).map(measured)), up = (phi) => (phi == null ? null : Math.PI / 2 - phi);
    const range = (from, to, [least, most]) => [Math.max(least, from ?? least), Math.min(most, to ?? most)];
    return { azimuth: range(low[0], high[0], free.azimuth), elevation: range(up(high[1]), up(low[1]), free.elevation), distance: range(low[2], high[2], free.distance) };
}
const within = (value, [from, to]) => Math.max(from, Math.min(to, value));

// ---- what is framed, much as `noh render --camera` does (figure_shape.c) ----

const faceIsAll = 0.4, upperShare = 0.45; // of the figure's height: a higher face is a head alone; of a body, its upper part
const belowFace = [0.12, 0.12, 1.3], aboveFace = [0.12, 0.9, 0.35]; // room around a face, of its height: less at the sides, so that it fills a tall screen; above and behind, a drawn head is half hair

// A box turned about the vertical axis, by a multiple of 90 degrees.
function turned(b, degrees) {
    const [s, c] = [Math.sin, Math.cos].map((of) => Math.round(of(degrees * units.deg)));
    const x = [c * b[0] + s * b[2], c * b[3] + s * b[5]], z = [c * b[2] - s * b[0], c * b[5] - s * b[3]];
    return [Math.min(...x), b[1], Math.min(...z), Math.max(...x), b[4], Math.max(...z)];
}

// The box of a view: 'face', 'upper' or 'full'. Boxes: minimum, maximum. face: what targets move; its minimum is above its
// maximum if there is none. facing: where the front is, in degrees from +z towards +x.
export const framed = (all, face, view, facing) => turned(framedAhead(turned(all, -facing), turned(face, -facing), view), facing);

function framedAhead(all, face, view) {
    const tall = all[4] - all[1], high = face[4] - face[1], middle = (all[0] + all[3]) / 2, half = upperShare * tall / 2;
    if (view === 'full' || (high < 0 && view === 'face')) return all;
    if (high > 0 && (view === 'face' || high > faceIsAll * tall)) {
        return face.map((at, i) => (i < 3 ? Math.max(at - belowFace[i] * high, all[i]) : Math.min(at + aboveFace[i - 3] * high, all[i])));
    }
    return [Math.max(all[0], middle - half), all[4] - 2 * half, all[2], Math.min(all[3], middle + half), all[4], all[5]];
}

function product(a, b, out) {
    for (let i = 0; i < 16; i++) {
        out[i] = 0;
        for (let k = 0; k < 4; k++) out[i] += a[4 * k + i % 4] * b[4 * (i >> 2) + k];
    }
}

export class Camera {
    constructor() {
        // azimuth: from the front; distance: 1 frames the figures; pixel: size of a page pixel at the figures, in world units
        Object.assign(this, front, { limits: free, facing: 0, distance: 0, box: null, all: null, from: [0, 0, 0], offset: [0, 0, 0], right: [1, 0, 0], up: [0, 1, 0], pixel: 0, follows: true, byHand: false });
        this.matrix = new Float32Array(16);
    }

    // Frame a box, measured at the figures' position, as near as possible. all: the box of the figures; facing: as in framed.
    fit(box, from, all = box, facing = 0) {
        Object.assign(this, { box, from, all, facing, distance: 0, offset: [0, 0, 0], byHand: false });
    }

    zoom(by) {
        this.byHand = true;
        this.distance = within((this.distance || 1) * by, this.limits.distance);
    }

    turn(azimuth, elevation) {
        this.azimuth = within(this.azimuth + azimuth, this.limits.azimuth);
        this.elevation = within(this.elevation + elevation, this.limits.elevation);
    }

    limit(limits) {
        this.limits = limits;
        this.turn(0, 0);
        if (this.distance) this.zoom(1);
    }

    // Move by pixels of the page: the point under a finger stays there.
    pan(x, y) {
        this.byHand = true;
        this.offset = this.offset.map((o, i) => o + (y * this.up[i] - x * this.right[i]) * this.pixel);
    }

    // Into 22 floats: matrix, eye, light. walked: present position of the figures; height: of the canvas on the page.
    write(out, walked, aspect, height) {
        const b = this.box, to = this.follows ? walked : this.from;
        const centre = [0, 1, 2].map((c) => (b[c] + b[3 + c]) / 2 + to[c] - this.from[c] + this.offset[c]);
        const ahead = turned(b, -this.facing), half = [0, 1, 2].map((c) => (ahead[3 + c] - ahead[c]) / 2), f = 1 / Math.tan(Math.PI / 12);
        const radius = Math.max(Math.hypot(...half), 1e-6);
        const need = Math.max(half[1], Math.max(half[0], half[2] * 0.7) / aspect) * 1.05;
        const d = (this.distance || 1) * Math.max(need * f + half[2], radius * 1.02);
        const depth = 2 * (radius + Math.max(...b.map((at, i) => Math.abs(this.all[i] - at))));
        const near = Math.max(d - depth, d * 0.02), far = d + depth;
        const azimuth = this.azimuth + this.facing * units.deg, ca = Math.cos(azimuth), sa = Math.sin(azimuth), ce = Math.cos(this.elevation), se = Math.sin(this.elevation);
        const right = [ca, 0, -sa], up = [-sa * se, ce, -ca * se], back = [sa * ce, se, ca * ce];
        Object.assign(this, { right, up, pixel: 2 * d / f / height });
        const eye = centre.map((c, i) => c + back[i] * d);
        const dot = (a) => a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2];
        const view = [0, 1, 2].flatMap((c) => [right[c], up[c], back[c], 0]).concat([-dot(right), -dot(up), -dot(back), 1]);
        const projection = [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, -(far + near) / (far - near), -1, 0, 0, -2 * far * near / (far - near), 0];
        const key = right.map((r, i) => -0.45 * r + 0.62 * up[i] + 0.64 * back[i]);
        product(projection, view, this.matrix);
        out.set(this.matrix, 0);
        out.set(eye, 16);
        out.set(key.map((k) => k / Math.hypot(...key)), 19);
    }
}
