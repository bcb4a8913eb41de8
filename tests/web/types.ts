// types.ts: what a program of TypeScript does with the package; it is compiled, never run.
import { Character, NohCharacter, addPointers, shapesOfText } from 'noh-character';
import { NohObject3D } from 'noh-character/three';
import { PerspectiveCamera, Scene, WebGLRenderer } from 'three';

const element = document.querySelector('noh-character');
if (element) {
    const known: NohCharacter = element;
    element.addEventListener('key', (event) => { const name: string = event.detail.name, weight: number = event.detail.weight; console.log(name, weight); });
    element.addEventListener('error', ({ detail }) => console.log(detail.message));
    element.addEventListener('click', (event) => console.log(event.clientX));
    known.play('walk', { layer: 'body', fade: 0.2 });
    known.setWeight('smile', 1).catch(({ message }) => console.log(message));
    known.ready.then((shown: NohCharacter) => shown.play('walk'));
    known.degrees = 40;
    known.autoLife = true;
    Object.assign(known, { program: 'face' } satisfies Partial<NohCharacter>);
    known.tier = known.character?.tier ?? 'auto';
    // @ts-expect-error there is no such tier
    known.tier = 'tablet';
    known.background = 'rgb(0 0 0 / 50%)';
    known.voice = async (text) => ({ sound: new AudioBuffer({ length: 800 * text.length, sampleRate: 16000 }), visemes: [{ viseme: 10, ms: 0 }] });
    // @ts-expect-error a background is a text
    known.background = 0;
    const x: number | undefined = known.queryHotspot('hotspot-nose')?.canvasPosition.x;
    element.addEventListener('pick', ({ detail }) => console.log(detail.vertex + (x ?? 0)));
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

const renderer = new WebGLRenderer(), scene = new Scene(), view = new PerspectiveCamera();
const object = new NohObject3D(renderer, { alive: true });
scene.add(object);
object.load('face.nohz').then((loaded) => { loaded.character.play('smile'); loaded.meshes[0].castShadow = true; });
object.update(1 / 60, view);
// @ts-expect-error a camera is needed, for the detail
object.update(1 / 60);
