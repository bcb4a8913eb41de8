// faces.js: animated faces: they blink, breathe, look at the pointer or the finger, and show emotions. ?alive=off turns
// them off, ?emotion=joy starts with an emotion, ?wrinkles=0.5 with wrinkles half as strong.
'use strict';

function feel() {
    byId('amount').disabled = named(byId('emotion')) === null;
    character.feel(named(byId('emotion')), Number(byId('amount').value));
}

// 0: no wrinkles.
function smooth() {
    const strength = Number(byId('wrinkles').value);
    byId('wrinkles-text').textContent = strength.toFixed(2);
    character.setWrinkles(strength);
}

function beginFaces() {
    byId('living').hidden = !Module._web_alive();
    byId('emotions-row').hidden = !(Module._web_face_shows() & 1);
    byId('wrinkles-row').hidden = !Module._web_wrinkles();
    byId('looks-of-face').hidden = byId('living').hidden && byId('wrinkles-row').hidden;
    byId('wrinkles').value = query.get('wrinkles') || 1;
    smooth();
    byId('emotion').length = 1; // none
    character.emotions.forEach((name, i) => byId('emotion').add(new Option(name, i)));
    byId('alive').checked = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    character.alive = byId('alive').checked;
    begin(byId('emotion'), 'emotion', 0);
    feel();
}

byId('looks').addEventListener('change', () => character.lookAhead());
byId('alive').addEventListener('change', () => { character.alive = byId('alive').checked; });
byId('emotion').addEventListener('change', feel);
byId('amount').addEventListener('input', feel);
byId('wrinkles').addEventListener('input', smooth);
