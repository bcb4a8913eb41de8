// hotspots.js: children of the element that stay at a joint, a vertex or a place of the first character, named as in
// model-viewer: slot="hotspot-NAME", data-position, data-normal, data-visible; data-joint and data-vertex are noh's.

const metres = { m: 1, cm: 0.01, mm: 0.001 };

// Three numbers of "0m 1.2m 0m" or "0 1.2 0"; null: not three.
export function pointOf(text) {
    const parts = (text || '').trim().split(/\s+/).map((part) => /^(-?[\d.]+(?:e-?\d+)?)(m|cm|mm)?$/.exec(part));
    return parts.length === 3 && parts.every(Boolean) ? parts.map(([, number, unit]) => Number(number) * metres[unit || 'm']) : null;
}

// By a matrix of three rows; w 1: a point, 0: a direction.
const moved = (m, v, w) => [0, 4, 8].map((r) => m[r] * v[0] + m[r + 1] * v[1] + m[r + 2] * v[2] + w * m[r + 3]);

// The number of a name, as name(0), name(1)... tell it; -1: none of them.
function numberOf(program, name, wanted) {
    for (let i = 0, at; (at = name(i)); i++) if (program.text(at) === wanted) return i;
    return -1;
}

class Hotspot {
    constructor(name) {
        this.name = name;
        this.place = document.createElement('div');
        this.place.className = 'hotspot';
        this.place.hidden = true;
        this.place.append(Object.assign(document.createElement('slot'), { name }));
        this.view = null; // of the last frame: as queryHotspot tells
    }

    read(element) {
        const { joint, vertex, position, normal } = element.dataset;
        Object.assign(this, { element, joint, vertex, position: pointOf(position), normal: pointOf(normal), program: null });
    }

    // In another program names have other numbers.
    find(program) {
        if (this.program === program) return;
        const [, mesh, index] = /^(.*\S)\s+(\d+)$/.exec(this.vertex || '') || [];
        this.program = program;
        if (this.joint !== undefined) this.number = numberOf(program, program._web_joint_name, this.joint);
        else if (this.vertex !== undefined) this.number = mesh === undefined ? -1 : numberOf(program, program._web_mesh_name, mesh);
        else this.number = this.position ? 0 : -1;
        this.index = Number(index);
        const lacks = this.joint !== undefined ? `the pack has no joint '${this.joint}'` : mesh !== undefined ? `the pack has no mesh '${mesh}'`
            : `it needs data-joint="NAME", data-vertex="MESH NUMBER" or data-position="X Y Z"`;
        this.error = this.number < 0 ? `${this.name}: ${lacks}` : '';
    }

    // { point, normal } in the world, the normal null if none is given; null: it is not shown.
    world() {
        const { program } = this;
        if (this.number < 0) return null;
        if (this.vertex !== undefined && this.joint === undefined) {
            const at = program._web_vertex(this.number, this.index), v = at ? program.floats(at, 6) : null;
            return v && { point: Array.from(v.subarray(0, 3)), normal: Array.from(v.subarray(3)) };
        }
        const at = this.joint !== undefined ? program._web_joint_matrix(this.number) : program._web_place_matrix(), m = at ? program.floats(at, 12) : null;
        return m && { point: moved(m, this.position || [0, 0, 0], 1), normal: this.normal && moved(m, this.normal, 0) };
    }
}

const named = ([x, y, z]) => ({ x, y, z });

export class Hotspots {
    // layer: where the places are added; fault(error): of a name that the pack lacks, '' if none is wrong.
    constructor(element, layer, fault) {
        Object.assign(this, { element, layer, fault, all: new Map() });
        this.watches = new MutationObserver(() => this.read());
        this.watches.observe(element, { childList: true, subtree: true, attributes: true, attributeFilter: ['slot', 'data-joint', 'data-vertex', 'data-position', 'data-normal'] });
        this.read();
    }

    end() {
        this.watches.disconnect();
        for (const { place } of this.all.values()) place.remove();
    }

    read() {
        const children = new Map([...this.element.children].filter((child) => child.slot.startsWith('hotspot')).map((child) => [child.slot, child]));
        for (const [name, { place }] of this.all) {
            if (children.has(name)) continue;
            place.remove();
            this.all.delete(name);
        }
        for (const [name, child] of children) {
            if (!this.all.has(name)) this.all.set(name, new Hotspot(name));
            const spot = this.all.get(name);
            if (!spot.place.isConnected) this.layer.append(spot.place);
            spot.read(child);
        }
        if (this.element.loaded) this.element.character.redraw();
    }

    // After a frame.
    update({ program, canvas }) {
        const { clientWidth: width, clientHeight: height } = canvas;
        if (!this.all.size) return;
        const view = Array.from(program.floats(program._web_view(), 19)), eye = view.slice(16);
        for (const spot of this.all.values()) {
            spot.find(program);
            this.put(spot, spot.world(), view, eye, width, height);
        }
        this.fault([...this.all.values()].map(({ error }) => error).find(Boolean) || '');
    }

    put(spot, at, m, eye, width, height) {
        const clip = at && [0, 1, 2, 3].map((i) => m[i] * at.point[0] + m[4 + i] * at.point[1] + m[8 + i] * at.point[2] + m[12 + i]);
        const [x, y, z] = at ? [0, 1, 2].map((i) => clip[i] / clip[3]) : [], seen = at && clip[3] > 0 && Math.max(Math.abs(x), Math.abs(y), Math.abs(z)) <= 1;
        const faces = Boolean(seen) && (!at.normal || at.normal.reduce((sum, n, i) => sum + n * (eye[i] - at.point[i]), 0) > 0);
        const across = (x + 1) / 2 * width, down = (1 - y) / 2 * height;
        spot.place.hidden = !seen;
        spot.place.classList.toggle('away', !faces);
        if (seen) spot.place.style.transform = `translate(${across.toFixed(2)}px, ${down.toFixed(2)}px) translate(-50%, -50%)`;
        spot.view = at && { position: named(at.point), normal: at.normal && named(at.normal), canvasPosition: { x: across, y: down, z }, facingCamera: faces };
        if (faces === spot.element.hasAttribute('data-visible')) return;
        spot.element.toggleAttribute('data-visible', faces);
        spot.element.dispatchEvent(new CustomEvent('hotspot-visibility', { detail: { visible: faces } }));
    }

    query(name) { return this.all.get(name)?.view || null; }
}
