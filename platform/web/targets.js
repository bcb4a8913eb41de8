// targets.js: a slider for each target, in groups by name. A moved slider holds its target, whatever clip plays, until
// the reset.
'use strict';

const sliders = [];
const groups = [ // the first match
    ['brows', /brow/i],
    ['eyes', /eye|blink|lid|look|squint|wink/i],
    ['jaw and tongue', /jaw|tongue|chin/i],
    ['mouth', /mouth|lip|smile|frown|pucker|teeth|viseme|^(aa|ih|ou|ee|oh|[aiueo]|sil|pp|ff|th|dd|kk|ch|ss|nn|rr)$/i],
    ['cheeks and nose', /cheek|nose|nostril|sneer/i],
    ['feelings', /happy|joy|angry|anger|sad|sorrow|fun|surpris|relax|fear|disgust|contempt|neutral/i],
    ['others', /./],
];

// A name as words: browInnerUp is "brow inner up", eyeBlinkLeft "eye blink, left". The pack's name is the tooltip.
function wordsOf(name) {
    const words = name.replace(/([a-z\d])([A-Z])/g, '$1 $2').replace(/[_\-.\s]+/g, ' ').trim().toLowerCase();
    return words.replace(/^(.+) (left|right|l|r)$/, (all, what, side) => `${what}, ${{ l: 'left', r: 'right' }[side] || side}`) || name;
}
const groupOf = (name) => groups.find((g) => g[1].test(name))[0];

function showWeight(s) {
    const weight = character.weight(s.name);
    if (weight === s.shown) return;
    s.shown = weight;
    s.slider.value = weight;
    s.output.textContent = Math.abs(weight) < 0.015 && !character.weights.has(s.name) ? '0.00' : weight.toFixed(2); // clips are rounded
}

function hold(s, weight) {
    character.setWeight(s.name, weight);
    s.label.classList.add('held');
}

// The left end of a slider is weight 0, the right end 1; or its range extends beyond both.
function setRange(s) {
    const beyond = byId('beyond').checked;
    Object.assign(s.slider, { min: beyond ? -1 : 0, max: beyond ? 2 : 1 });
    s.shown = NaN;
    showWeight(s);
}

function addSlider(name, to) {
    const label = document.createElement('label'), span = document.createElement('span');
    const slider = document.createElement('input'), output = document.createElement('output');
    Object.assign(span, { textContent: wordsOf(name), title: name });
    Object.assign(slider, { type: 'range', step: 0.01 });
    slider.dataset.target = name;
    const s = { label, slider, output, name, found: `${name} ${span.textContent}`.toLowerCase(), shown: NaN };
    slider.addEventListener('input', () => hold(s, Number(slider.value)));
    label.classList.toggle('held', character.weights.has(name));
    label.append(span, slider, output);
    to.append(label);
    sliders.push(s);
    setRange(s);
}

function addGroup(name, targets, alone) {
    const to = document.createElement(alone ? 'div' : 'details');
    if (!alone) {
        const summary = document.createElement('summary');
        summary.textContent = name;
        to.open = true;
        to.append(summary);
    }
    byId('targets').append(to);
    for (const name of targets) addSlider(name, to);
}

function listTargets() {
    const all = character.targets;
    const filled = groups.map(([name]) => [name, all.filter((target) => groupOf(target) === name)]).filter(([, list]) => list.length);
    const alone = all.length < 12 || filled.length < 2;
    byId('targets').replaceChildren();
    sliders.length = 0;
    if (alone) addGroup('', all, true);
    else for (const [name, list] of filled) addGroup(name, list, false);
    byId('faces').hidden = !sliders.length;
    byId('search').dispatchEvent(new Event('input'));
}

byId('search').addEventListener('input', () => {
    const part = byId('search').value.trim().toLowerCase();
    for (const s of sliders) s.label.hidden = !s.found.includes(part);
    for (const group of byId('targets').children) group.hidden = ![...group.querySelectorAll('label')].some((label) => !label.hidden);
});
byId('beyond').addEventListener('change', () => sliders.forEach(setRange));
byId('reset').addEventListener('click', () => {
    character.releaseWeights();
    for (const s of sliders) s.label.classList.remove('held');
});
