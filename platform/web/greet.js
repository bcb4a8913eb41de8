// greet.js: what a visitor sees first: a face that fills the page, and two buttons. The first touch of the face, or a
// button, begins a greeting of about twenty seconds. The other button opens the workbench (?tab=NAME: open from the
// start). ?view=face|upper|full chooses what the camera frames; else the face, and with the workbench all of the figure.
'use strict';

const works = () => document.documentElement.classList.contains('works');
const animates = () => !matchMedia('(prefers-reduced-motion: reduce)').matches;
const viewAsked = () => query.get('view') || (works() ? 'full' : 'face');
const kilobytesCame = () => Math.round(performance.getEntriesByType('resource').reduce((sum, { encodedBodySize }) => sum + encodedBodySize, 0) / 1000);

// words: said and shown; mood: an emotion meanwhile; moods: emotions that begin at a word; turn, light: how far the camera
// swings to each side and back, in radians, or the light, in degrees.
const greeting = () => [
    { words: 'Hello! Nice to meet you.', mood: 'joy' },
    { words: `I came in ${kilobytesCame()} kilobytes, and I live in ${Math.ceil(character.memory.all / 1e6)} megabytes of memory.`, turn: 0.6 },
    { words: 'I can be happy, or sad, or surprised, or angry.', moods: { happy: 'joy', sad: 'sadness', surprised: 'surprise', angry: 'anger' } },
    { words: 'The light goes where you like.', light: 110 },
    { words: 'I look where you point. Drag to turn me, and press more to see how I work.', mood: 'joy' },
];
const swingSeconds = 3.2;

let greets = null; // the present greeting: { part, emotion, amount }, the emotion from before
let greeted = false; // a touch greets once, the button again
let swing = null; // { seconds, most, shown, add }

const canGreet = () => Boolean(character && character.loaded && Module._web_face_shows() & 2);
const feels = (mood) => character.emotions.includes(mood);

function showGreeting() {
    byId('greet').textContent = greets ? 'Stop' : greeted ? 'Say it again' : 'Say hello';
    byId('greet').hidden = !canGreet();
    for (const id of ['greet', 'more']) byId(id).disabled = !character.loaded;
}

function beginSwing({ turn = 0, light = 0 } = {}) {
    if (swing) swing.add(-swing.shown);
    swing = null;
    if (!animates() || !(turn || light)) return;
    swing = { seconds: 0, most: turn || light, shown: 0, add: (by) => (turn ? character.turn(by, 0) : character.turnLight(by)) };
}

// In each frame: to one side, to the other, and back.
function showSwing({ seconds }) {
    if (!swing) return;
    swing.seconds += seconds;
    const by = swing.seconds < swingSeconds ? swing.most * Math.sin(2 * Math.PI * swing.seconds / swingSeconds) : 0;
    swing.add(by - swing.shown);
    swing.shown = by;
    if (swing.seconds >= swingSeconds) swing = null;
}

function feelAtWord({ word }) {
    const moods = greets && greets.part.moods, mood = moods && moods[word.toLowerCase().replace(/\W/g, '')];
    if (mood && feels(mood)) character.feel(mood);
}

async function greet() {
    const { emotion, amount } = character.chosen, mine = greets = { emotion, amount };
    greeted = true;
    showGreeting();
    for (const part of greeting()) {
        mine.part = part;
        beginSwing(part);
        if (!await character.speech.speak(part.words, { mood: feels(part.mood) ? part.mood : undefined }) || greets !== mine) break;
    }
    if (greets === mine) leaveGreeting();
}

function leaveGreeting() {
    const { emotion, amount } = greets;
    greets = null;
    beginSwing();
    character.feel(emotion, amount);
    showGreeting();
}

function stopGreeting() {
    if (!greets) return;
    leaveGreeting();
    character.speech.stop();
}

function showWorks(open) {
    stopGreeting();
    document.documentElement.classList.toggle('works', open);
    byId('more').setAttribute('aria-expanded', String(open));
    character.view = viewAsked();
    character.fit();
    (open ? byId('less') : byId('more')).focus({ preventScroll: true });
}

// After a pack is loaded, or if it cannot be.
function beginGreeting() {
    byId('controls').inert = false;
    byId('poster').classList.add('gone');
    if (character) showGreeting();
}

byId('greet').addEventListener('click', () => (greets ? stopGreeting() : greet()));
canvas.addEventListener('click', () => { if (!works() && !greeted && canGreet()) greet(); });
byId('more').addEventListener('click', () => showWorks(true));
byId('less').addEventListener('click', () => showWorks(false));
document.addEventListener('keydown', ({ key }) => { if (key === 'Escape') stopGreeting(); });
