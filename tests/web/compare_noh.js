// compare_noh.js: the side of noh: the package's program, without the page around it.
import { Arrival, compile } from '/noh/package/program.js';
import { cameraOf, matrixOf } from './compare_shared.js';

export async function open(canvas, path) {
    const gl = canvas.getContext('webgl2', { antialias: true, depth: true, alpha: false, preserveDrawingBuffer: true });
    const [module, answer] = await Promise.all([compile(), fetch('/noh/page.nohz')]), arrival = await Arrival.begin(module, gl);
    arrival.push(new Uint8Array(await answer.arrayBuffer()));
    arrival.end();
    const M = await arrival.open({ path, characters: 1, alive: false });
    const text = (pointer) => M.text(pointer), check = (result) => M.check(result);
    M.open();
    M._web_set_level(0); // all targets, however small
    const count = M._web_target_count(), bounds = Array.from(M.HEAPF32.subarray(M._web_measure() >> 2, (M._web_measure() >> 2) + 6));
    const view = cameraOf(bounds), held = new Float32Array(count);
    M.HEAPF32.set([...matrixOf(view), ...view.eye, ...view.key], M._web_view() >> 2);
    return {
        version: `noh by ${text(M._web_path())}`,
        renderer: text(M._web_renderer()),
        names: Array.from({ length: count }, (_, i) => text(M._web_target_name(i))),
        bounds,
        gl,
        resize: (pixels) => Object.assign(canvas, { width: pixels, height: pixels }),
        draw(weights) {
            for (let t = 0; t < count; t++) {
                const weight = weights ? weights[t] : 0;
                if (weight !== held[t]) M._web_hold(t, held[t] = weight, 1);
            }
            check(M._web_step(0));
            check(M._web_draw());
        },
    };
}
