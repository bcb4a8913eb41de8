// types.ts: what a program of TypeScript does with the package; it is compiled, never run.
import { Character, NohCharacter, addPointers, shapesOfText } from 'noh-character';

const element = document.querySelector('noh-character');
if (element) {
    const known: NohCharacter = element;
    element.addEventListener('key', (event) => { const name: string = event.detail.name, weight: number = event.detail.weight; console.log(name, weight); });
    element.addEventListener('error', ({ detail }) => console.log(detail.message));
    element.addEventListener('click', (event) => console.log(event.clientX));
    known.play('walk', { layer: 'body', fade: 0.2 });
    known.setWeight('smile', 1);
    const bytes: number = known.memory ? known.memory.all : 0;
    console.log(bytes, known.clips.map((clip) => clip.seconds));
    known.load(new Uint8Array(3)).then((shown: boolean) => console.log(shown));
    // @ts-expect-error a weight is a number
    known.setWeight('smile', 'much');
    // @ts-expect-error there is no such layer
    known.play('walk', { layer: 'feet' });
}
const character = new Character(document.createElement('canvas'), { light: 'room', characters: 3 });
const end: () => void = addPointers(character.canvas, character);
character.setLight({ shadow: 'blob' });
character.load(fetch('face.nohz')).then(end);
console.log(shapesOfText('Papa', 1)[0]?.shape);
// @ts-expect-error memory is read, not written
character.memory = null;
