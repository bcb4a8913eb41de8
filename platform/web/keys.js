// keys.js: the canvas by the keyboard, as index.html says in its label.
'use strict';

// As a drag does it, to the same side.
const step = 0.1; // radians that it turns
const pixels = 30; // that it moves

const keys = {
    ArrowLeft: (event) => (event.shiftKey ? pan(-pixels, 0) : turn(step, 0)),
    ArrowRight: (event) => (event.shiftKey ? pan(pixels, 0) : turn(-step, 0)),
    ArrowUp: (event) => (event.shiftKey ? pan(0, -pixels) : turn(0, -step)),
    ArrowDown: (event) => (event.shiftKey ? pan(0, pixels) : turn(0, step)),
    '+': () => zoom(0.9),
    '=': () => zoom(0.9),
    '-': () => zoom(1 / 0.9),
    ' ': () => { if (!byId('motion').hidden) setPlaying(!playing); },
    Home: () => { Object.assign(orbit, front); fit(); },
};

canvas.addEventListener('keydown', (event) => {
    if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey || !window.noh.ready) return;
    event.preventDefault(); // else the page scrolls
    keys[event.key](event);
});
