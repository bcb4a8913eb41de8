// light.js: the light of the page, with the names of `noh render`: ?light=none|white|studio|room|sky, ?rotate=DEGREES,
// ?shadow=on|off|blob, ?floor=off (the shadow falls only on the figure), ?tonemap=none, ?transfer=off,
// ?background=light|gradient|plain.
'use strict';

const firstLight = 'studio'; // as in `noh render`
const ofLight = ['rotate', 'shadow', 'tonemap', 'background'];
const plainLight = 'plain'; // no environment

function lightAsked() {
    const offered = (select, asked, otherwise) => ([...byId(select).options].some((o) => o.value === asked) ? asked : otherwise);
    return {
        light: query.get('light') || firstLight, degrees: Number(query.get('rotate') || 0), shadow: offered('shadow', query.get('shadow'), 'on'), floor: query.get('floor') !== 'off',
        tonemap: query.get('tonemap') !== 'none', background: offered('background', query.get('background'), 'light'), transfer: query.get('transfer') !== 'off',
    };
}

// Plain light has no rotation, shadow or tone map.
function showLight({ light, degrees, shadow, tonemap, background, transfer }) {
    const plain = !character.lights.includes(light), select = byId('light');
    if (select.options.length === 1) for (const name of character.lights) select.add(new Option(name, name));
    select.value = plain ? plainLight : light;
    byId('rotate').value = degrees;
    byId('rotate-text').textContent = `${degrees.toFixed(0)}\u00b0`;
    byId('shadow').value = shadow;
    byId('tonemap').checked = tonemap;
    byId('background').value = background;
    byId('transfer').checked = transfer;
    for (const id of ofLight.concat('transfer')) byId(id).disabled = plain;
}

function chooseLight() {
    character.setLight({
        light: byId('light').value, degrees: Number(byId('rotate').value), shadow: byId('shadow').value, tonemap: byId('tonemap').checked,
        background: byId('background').value, transfer: byId('transfer').checked,
    });
    showMemory();
}

// Spots lie under feet, so a figure without joints has none, unless the query asks for them.
function offerSpots() {
    const spots = byId('shadow').querySelector('[value=blob]');
    spots.disabled = spots.hidden = !Module._web_joint_count() && query.get('shadow') !== 'blob';
    if (spots.disabled && character.chosen.shadow === 'blob') character.setLight({ shadow: 'on' });
}

// Whether meshes use the light precomputed for the pack. For a pack without it, a text says so.
function beginTransfer() {
    const has = Module._web_has_transfer();
    byId('transfer-row').hidden = !has;
    offerSpots();
    showLight(character.chosen);
    if (query.has('transfer') && !has) say('the pack has no precomputed light: build it with noh build --transfer');
}

for (const id of ['light', 'transfer']) byId(id).addEventListener('change', chooseLight);
for (const id of ofLight) byId(id).addEventListener('input', chooseLight);
