// pointer.js: mouse, touch and keys. One finger or the mouse turns the figure; two fingers or the wheel zoom; two
// fingers in the same direction, or a drag with the right button, move the picture; a drag with shift turns the light;
// a tap or a click picks, with Alt it pushes. Arrow keys act like a drag in their direction.

const step = 0.1; // radians per key
const pixels = 30; // pixels per key
const wobble = 6; // pixels: a tap moves less

const keys = {
    ArrowLeft: (c, shift) => (shift ? c.pan(-pixels, 0) : c.turn(step, 0)),
    ArrowRight: (c, shift) => (shift ? c.pan(pixels, 0) : c.turn(-step, 0)),
    ArrowUp: (c, shift) => (shift ? c.pan(0, -pixels) : c.turn(0, -step)),
    ArrowDown: (c, shift) => (shift ? c.pan(0, pixels) : c.turn(0, step)),
    '+': (c) => c.zoom(0.9),
    '=': (c) => c.zoom(0.9),
    '-': (c) => c.zoom(1 / 0.9),
    ' ': (c) => { c.paused = !c.paused; },
    Home: (c) => c.home(),
};

class Pointers {
    constructor(canvas, character) {
        Object.assign(this, { canvas, character, at: new Map(), tapped: null });
    }

    apart() {
        const [a, b] = [...this.at.values()];
        return Math.max(Math.hypot(a.x - b.x, a.y - b.y), 1);
    }

    down(event) {
        const place = { x: event.clientX, y: event.clientY };
        this.canvas.setPointerCapture(event.pointerId);
        this.tapped = this.at.size ? null : place;
        this.at.set(event.pointerId, { ...place });
    }

    move(event) {
        const at = this.at.get(event.pointerId), { character } = this;
        if (!at || this.at.size > 2) return;
        if (this.tapped && Math.hypot(event.clientX - this.tapped.x, event.clientY - this.tapped.y) > wobble) this.tapped = null;
        const x = event.clientX - at.x, y = event.clientY - at.y, before = this.at.size === 2 ? this.apart() : 0;
        Object.assign(at, { x: event.clientX, y: event.clientY });
        if (before) {
            character.pan(x / 2, y / 2);
            character.zoom(before / this.apart());
        } else if (event.shiftKey) {
            character.turnLight(x * 0.5);
        } else if (event.buttons === 2) {
            character.pan(x, y);
        } else {
            character.turn(-x * 0.01, y * 0.01);
        }
    }

    up(event) {
        if (this.tapped && event.type === 'pointerup') this.character.tap(event.clientX, event.clientY, event.altKey);
        this.tapped = null;
        this.at.delete(event.pointerId);
    }
}

// Let the canvas move the camera while `asked` returns true. wheel: whether the wheel zooms now. Returns a function
// that ends it.
export function addPointers(canvas, character, wheel = () => true, asked = () => true) {
    const pointers = new Pointers(canvas, character), ended = new AbortController(), { signal } = ended;
    const on = (type, call, more) => canvas.addEventListener(type, (event) => { if (asked()) call(event); }, { signal, ...more });
    on('pointerdown', (event) => pointers.down(event));
    on('pointermove', (event) => pointers.move(event));
    for (const type of ['pointerup', 'pointercancel']) on(type, (event) => pointers.up(event));
    on('contextmenu', (event) => event.preventDefault());
    on('wheel', (event) => {
        if (!wheel(event)) return;
        event.preventDefault();
        character.zoom(Math.exp(event.deltaY * 0.001));
    }, { passive: false });
    on('keydown', (event) => {
        if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey || !character.loaded) return;
        event.preventDefault(); // otherwise the page scrolls
        keys[event.key](character, event.shiftKey);
    });
    return () => ended.abort();
}

// The faces look at the pointer or the finger while it is over the canvas. asked: whether they do now.
export function addGaze(canvas, character, asked = () => true) {
    const ended = new AbortController(), { signal } = ended;
    const look = (event) => { if (asked()) character.lookAt(event.clientX, event.clientY); };
    for (const type of ['pointermove', 'pointerdown']) canvas.addEventListener(type, look, { signal });
    canvas.addEventListener('pointerleave', () => character.lookAhead(), { signal });
    return () => ended.abort();
}
