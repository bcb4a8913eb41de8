// compare_element_model_viewer.js: the side of model-viewer: its element, in its neutral environment, with its shadow under the
// model or none. Its frames are asked for through its own renderer.
import { ModelViewerElement } from '@google/model-viewer';
import model from '@google/model-viewer/package.json';

// What is kept under a symbol of this name, by the object or its classes.
function inside(object, name) {
    for (let at = object; at; at = Object.getPrototypeOf(at)) {
        const symbol = Object.getOwnPropertySymbols(at).find(({ description }) => description === name);
        if (symbol) return object[symbol];
    }
    throw new Error(`model-viewer has no '${name}' any more`);
}

export async function open(place, shadow) {
    const element = new ModelViewerElement();
    Object.assign(element, { src: '/asset.glb', shadowIntensity: shadow ? 1 : 0, fieldOfView: '30deg', interactionPrompt: 'none', minimumRenderScale: 1 });
    Object.assign(element.style, { width: '512px', height: '512px' });
    place.append(element);
    await new Promise((resolve, reject) => {
        element.addEventListener('load', resolve, { once: true });
        element.addEventListener('error', ({ detail }) => reject(new Error(detail.type)), { once: true });
    });
    await element.updateComplete;
    const scene = inside(element, 'scene'), renderer = inside(element, 'renderer'), three = renderer.threeRenderer;
    while (!element.modelIsVisible) await new Promise((resolve) => setTimeout(resolve, 20));
    three.setAnimationLoop(null); // the comparison asks for frames
    return {
        version: `model-viewer ${model.version}`, gl: three.getContext(),
        draw() {
            scene.queueRender();
            renderer.render(performance.now());
        },
    };
}
