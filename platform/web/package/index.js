// index.js: characters of noh on a page: the element <noh-character>, and its Character for a canvas of your own.
export { NohCharacter } from './element.js';
export { Character } from './character.js';
export { convert } from './convert.js';
export { addGaze, addPointers } from './pointer.js';
export { shapesOfText } from './speech.js';
