// faces.js: faces that live: they blink, breathe, look at the pointer or the finger, and feel. ?alive=off leaves them out,
// ?emotion=joy begins with one, ?wrinkles=0.5 with wrinkles half as strong.
'use strict';

const isAlive = () => !byId('living').hidden && byId('alive').checked;

function setAlive() {
    Module._web_set_calm(isAlive() ? 0 : 1);
    redraw();
}

function lookAt(event) {
    if (lost || !window.noh.ready || !byId('looks').checked) return;
    const r = canvas.getBoundingClientRect();
    Module._web_look((event.clientX - r.left) * canvas.width / r.width, (event.clientY - r.top) * canvas.height / r.height, 1);
    settle();
}

function lookAhead() {
    if (!window.noh.ready) return;
    Module._web_look(0, 0, 0);
    settle();
}

function feel() {
    const emotion = Number(byId('emotion').value);
    byId('amount').disabled = emotion < 0;
    Module._web_feel(emotion, Number(byId('amount').value));
    settle();
}

// 0 smooths the wrinkles out.
function smooth() {
    const strength = Number(byId('wrinkles').value);
    byId('wrinkles-text').textContent = strength.toFixed(2);
    Module._web_set_wrinkles(strength);
    redraw();
}

// A calm face moves, too, when it is told to; and a pose is not made anew in every frame.
function settle() {
    if (byId('living').hidden) return;
    busy = Math.max(busy, performance.now() + 2500);
    redraw();
}

function beginFaces() {
    byId('living').hidden = !Module._web_alive();
    byId('emotions-row').hidden = !(Module._web_face_shows() & 1);
    byId('wrinkles-row').hidden = !Module._web_wrinkles();
    byId('looks-of-face').hidden = byId('living').hidden && byId('wrinkles-row').hidden;
    byId('wrinkles').value = query.get('wrinkles') || 1;
    smooth();
    byId('emotion').length = 1; // none
    for (let i = 0; Module._web_emotion_name(i); i++) byId('emotion').add(new Option(text(Module._web_emotion_name(i)), i));
    byId('alive').checked = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    setAlive();
    begin(byId('emotion'), 'emotion', 0);
    feel();
}

canvas.addEventListener('pointermove', lookAt);
canvas.addEventListener('pointerdown', lookAt);
canvas.addEventListener('pointerleave', lookAhead);
byId('looks').addEventListener('change', lookAhead);
byId('alive').addEventListener('change', setAlive);
byId('emotion').addEventListener('change', feel);
byId('amount').addEventListener('input', feel);
byId('wrinkles').addEventListener('input', smooth);
