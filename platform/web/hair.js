// hair.js: hair that hangs in the wind and swings when a head is shaken: ?hair=off leaves it out, ?wind=3 begins with
// wind of so many metres a second.
'use strict';

const hairMoves = () => !byId('hair-section').hidden && byId('hair').checked && (Number(byId('wind').value) > 0 || Module._web_shakes());

function setHair() {
    const wind = Number(byId('wind').value);
    byId('wind-text').textContent = `${wind.toFixed(1)} m/s`;
    byId('wind').disabled = byId('shake').disabled = !byId('hair').checked;
    Module._web_set_hair(byId('hair').checked ? 1 : 0, wind);
    redraw();
}

function beginHair() {
    byId('hair-section').hidden = !Module._web_has_hair();
    if (byId('hair-section').hidden) {
        if (query.has('hair') || query.has('wind')) say('the pack has no hair: build it with noh build --hair');
        return;
    }
    byId('hair').checked = query.get('hair') !== 'off';
    byId('wind').value = Number(query.get('wind') || 0);
    setHair();
}

byId('hair').addEventListener('change', setHair);
byId('wind').addEventListener('input', () => {
    setHair();
    busy = Math.max(busy, performance.now() + 2000); // until it has come to rest
});
byId('shake').addEventListener('click', () => {
    Module._web_shake();
    busy = performance.now() + 4000;
    redraw();
});
