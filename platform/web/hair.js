// hair.js: hair in wind, which swings when a head is shaken: ?hair=off hides it, ?wind=3 starts with wind of 3 metres
// per second.
'use strict';

const hairAsked = () => ({ hair: query.get('hair') !== 'off', wind: Number(query.get('wind') || 0) });

function showHair() {
    const { hair, wind } = character.chosen;
    byId('hair').checked = hair;
    byId('wind').value = wind;
    byId('wind-text').textContent = `${wind.toFixed(1)} m/s`;
    byId('wind').disabled = byId('shake').disabled = !hair;
}

function setHair() {
    character.setHair(byId('hair').checked, Number(byId('wind').value));
    showHair();
}

function beginHair() {
    const has = Module._web_has_hair();
    byId('hair-section').hidden = !has;
    showHair();
    if (!has && (query.has('hair') || query.has('wind'))) say('the pack has no hair: build it with noh build --hair');
}

byId('hair').addEventListener('change', setHair);
byId('wind').addEventListener('input', setHair);
byId('shake').addEventListener('click', () => character.shake());
