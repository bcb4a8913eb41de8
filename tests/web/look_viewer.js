// look_viewer.js: a model by model-viewer in noh's light and from its camera; its own shadow on the ground. look.js waits
// for window.look.
const query = new URLSearchParams(window.location.search), side = Number(query.get('side'));

// About the point in front of the camera that is nearest to the model's middle. An orbit's angles: theta from +Z, phi from
// the zenith. The far plane is model-viewer's own, by the largest radius that is allowed.
function orbitOf({ eye, forward }, middle) {
    const distance = middle.reduce((sum, m, i) => sum + (m - eye[i]) * forward[i], 0), back = forward.map((f) => -f);
    return {
        'camera-target': eye.map((e, i) => `${(e + distance * forward[i]).toFixed(6)}m`).join(' '),
        'camera-orbit': `${Math.atan2(back[0], back[2])}rad ${Math.acos(back[1])}rad ${distance}m`,
        'max-camera-orbit': `auto 180deg ${1.5 * distance}m`,
    };
}

async function setUp() {
    const { ModelViewerElement } = await import('/viewer/dist/model-viewer.min.js');
    ModelViewerElement.minimumRenderScale = 1;
    ModelViewerElement.meshoptDecoderLocation = 'data:text/javascript,'; // the bundle has the decoder
    const viewer = document.createElement('model-viewer');
    const set = (attributes) => Object.entries(attributes).forEach(([name, value]) => viewer.setAttribute(name, value));
    const once = (event) => new Promise((resolve, reject) => {
        viewer.addEventListener(event, resolve, { once: true });
        viewer.addEventListener('error', ({ detail }) => reject(new Error(detail.type)), { once: true });
    });
    viewer.style.cssText = `width: ${side}px; height: ${side}px; background: transparent`;
    set({ 'interaction-prompt': 'none', 'shadow-intensity': '1', 'tone-mapping': 'neutral', loading: 'eager',
        'min-camera-orbit': 'auto 0deg 0m', 'min-field-of-view': '1deg', 'field-of-view': '30deg' });
    document.body.append(viewer);
    async function open(address) {
        const loaded = once('load');
        viewer.src = address;
        await loaded;
    }
    let light = '';
    async function draw(wanted) {
        const { x, y, z } = viewer.getBoundingBoxCenter();
        if (light !== wanted.light) {
            const changed = once('environment-change');
            light = wanted.light;
            viewer.environmentImage = `/out/${light}.hdr`;
            await changed;
        }
        set({ ...orbitOf(wanted.camera, [x, y, z]), exposure: String(wanted.exposure) });
        await viewer.updateComplete;
        viewer.jumpCameraToGoal();
        for (let i = 0; i < 3; i++) await new Promise((resolve) => { requestAnimationFrame(resolve); });
        return { model_viewer: viewer.toDataURL('image/png') };
    }
    return { open, draw };
}

setUp().then((look) => { window.look = look; });
