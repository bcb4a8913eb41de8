// index.js: characters of noh on a page: the element <noh-character>, and the Character behind it for a canvas of one's own.
export { NohCharacter } from './element.js';
export { Character } from './character.js';
export { convert } from './convert.js';
export { addGaze, addPointers } from './pointer.js';
export { shapesOfText } from './speech.js';
