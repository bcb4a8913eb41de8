// light.js: the light that the figures stand in, by the words of `noh render`: ?light=none|white|studio|room|sky,
// ?rotate=DEGREES, ?shadow=on|off|blob, ?tonemap=none, ?transfer=off, ?background=light|gradient|plain.
'use strict';

const firstLight = 'studio'; // as pictures of `noh render` have it
const backgrounds = ['plain', 'gradient', 'light'];
const shadows = ['off', 'on', 'blob'];
const ofLight = ['rotate', 'shadow', 'tonemap', 'background'];

function setLighting() {
    const degrees = Number(byId('rotate').value);
    byId('rotate-text').textContent = `${degrees.toFixed(0)}\u00b0`;
    Module._web_set_lighting(degrees, shadows.indexOf(byId('shadow').value), byId('tonemap').checked ? 1 : 0, backgrounds.indexOf(byId('background').value));
}

// Plain light has nothing to turn, no shadow and no tones. In a lost context nothing is made: it is, once that is back.
function chooseLight() {
    const light = Number(byId('light').value);
    for (const id of ofLight.concat('transfer')) byId(id).disabled = light < 0;
    if (lost) return;
    check(Module._web_set_light(light));
    if (!window.noh.ready) return;
    showMemory();
    redraw();
}

function turnLight(pixels) {
    const slider = byId('rotate');
    if (slider.disabled) return;
    slider.value = (Number(slider.value) + pixels * 0.5 + 540) % 360 - 180;
    setLighting();
    redraw();
}

// Before the stage is made, so that it is made once.
function beginLight() {
    const asked = query.get('light') || firstLight;
    for (let i = 0; i < Module._web_light_count(); i++) byId('light').add(new Option(text(Module._web_light_name(i)), i));
    const option = [...byId('light').options].find((o) => o.text === asked);
    byId('light').value = option ? option.value : -1;
    byId('rotate').value = Number(query.get('rotate') || 0);
    byId('shadow').value = shadows.includes(query.get('shadow')) ? query.get('shadow') : 'on';
    byId('tonemap').checked = query.get('tonemap') !== 'none';
    byId('background').value = backgrounds.includes(query.get('background')) ? query.get('background') : 'light';
    setLighting();
    chooseLight();
}

// Whether meshes shade themselves by what was worked out when the pack was built. It is told in words of a pack without.
function chooseTransfer() {
    if (lost) return;
    check(Module._web_set_transfer(byId('transfer').checked ? 1 : 0));
    showMemory();
    redraw();
}

function beginTransfer() {
    const has = Module._web_has_transfer();
    byId('transfer-row').hidden = !has;
    if (query.get('transfer') === 'off' && has) {
        byId('transfer').checked = false;
        check(Module._web_set_transfer(0));
    } else if (query.has('transfer') && !has) {
        say('the pack has no precomputed light: build it with noh build --transfer');
    }
}

byId('transfer').addEventListener('change', chooseTransfer);
byId('light').addEventListener('change', chooseLight);
for (const id of ofLight) {
    byId(id).addEventListener('input', () => {
        setLighting();
        redraw();
    });
}
