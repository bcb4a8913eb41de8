// speech.js: speech of the faces (package/speech.js): from the microphone, a sound file, or a typed sentence that the
// browser speaks.
'use strict';

const said = (words) => { byId('speech-text').textContent = words; };

// Read by tests: the current speech.
Object.defineProperty(window.noh, 'said', { get: () => character.speech.now });

function showSaid({ words, speaks, source }) {
    const listens = speaks && source === 'microphone';
    byId('listen').setAttribute('aria-pressed', String(listens));
    byId('listen').textContent = listens ? 'stop listening' : 'microphone';
    if (words) said(words);
}

byId('listen').addEventListener('click', () => {
    if (byId('listen').getAttribute('aria-pressed') !== 'true') return character.speech.listen();
    character.speech.stop();
    return said('');
});

byId('open-sound').addEventListener('click', () => byId('sound').click());
byId('sound').addEventListener('change', async () => {
    const file = byId('sound').files[0];
    if (file) await character.speech.speak(file, { interrupt: true });
    byId('sound').value = ''; // the same file may be chosen again
});

byId('say').addEventListener('submit', (event) => {
    const words = byId('line').value.trim();
    event.preventDefault();
    if (words) return character.speech.speak(words, { interrupt: true });
    character.speech.stop();
    return said('Type a sentence first.');
});

function showCaption({ words }) { byId('caption').textContent = words; }

// Hidden without a face with mouth shapes. Some browsers list their voices only after a first request.
function beginSpeech() {
    byId('speech').hidden = !(Module._web_face_shows() & 2);
    if (window.speechSynthesis) window.speechSynthesis.getVoices();
}
