// compare_element_noh.js: the side of noh: its element, as a site has it, with its default light.
import '/noh/package/element.js';

export async function open(place, shadow) {
    const element = document.createElement('noh-character');
    Object.assign(element, { src: '/noh/page.nohz', program: 'face', pixels: 'all', shadow: shadow ? 'on' : 'off', background: 'plain' });
    element.style.height = '512px';
    place.append(element);
    await element.ready;
    const { character } = element;
    while (!character.whole) await new Promise((resolve) => character.addEventListener('load', resolve, { once: true }));
    await character.prepared;
    character.stopped = true; // the comparison asks for frames
    return { version: 'noh', gl: character.gl, outside: character.memory.all, draw: () => character.advance(0) };
}
