// webp.js: decodes the WebP pictures in the files of a model, for webp_browser.c.

const base64 = /data:[^"']*?;base64,(UklGR[A-Za-z0-9+/]+=*)/g; // "RIFF"
const text = (bytes, at, count) => String.fromCharCode(...bytes.subarray(at, at + count));
const lengthAt = (bytes, at) => Math.min(8 + new DataView(bytes.buffer, bytes.byteOffset + at, 8).getUint32(4, true), bytes.length - at);

// Pictures in bytes: of their own, or in the buffers of a model.
function* picturesIn(bytes) {
    for (let at = bytes.indexOf(82); at >= 0 && at + 16 < bytes.length; at = bytes.indexOf(82, at + 1)) { // "R"
        if (text(bytes, at, 4) === 'RIFF' && text(bytes, at + 8, 7) === 'WEBPVP8') yield bytes.slice(at, at + lengthAt(bytes, at));
    }
}

function* picturesOf({ name, bytes }) {
    yield* picturesIn(bytes);
    if (!/\.gltf$/i.test(name)) return;
    for (const [, coded] of new TextDecoder().decode(bytes).matchAll(base64)) yield* picturesIn(Uint8Array.from(atob(coded), (c) => c.charCodeAt(0)));
}

function hash(bytes) {
    let sum = 2166136261;
    for (const byte of bytes) sum = Math.imul(sum ^ byte, 16777619);
    return (sum >>> 0).toString(16).padStart(8, '0');
}

// By WebGL, because a 2D canvas multiplies colours by alpha, which transparent texels lose.
function pixels(gl, picture) {
    const { width, height } = picture, out = new Uint8Array(8 + 4 * width * height), texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, out.subarray(8));
    gl.deleteTexture(texture);
    new Uint32Array(out.buffer, 0, 2).set([width, height]);
    return out;
}

// Map of name to bytes. A picture that the browser cannot decode is left out.
export async function decodeAll(files) {
    const found = new Map(), all = files.flatMap((file) => [...picturesOf(file)]), gl = all.length ? new OffscreenCanvas(1, 1).getContext('webgl2') : null;
    if (!gl) return found;
    gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
    const most = gl.getParameter(gl.MAX_TEXTURE_SIZE), asStored = { premultiplyAlpha: 'none', colorSpaceConversion: 'none' };
    for (const bytes of all) {
        const picture = await createImageBitmap(new Blob([bytes], { type: 'image/webp' }), asStored).catch(() => null);
        if (picture && Math.max(picture.width, picture.height) <= most) found.set(`${bytes.length}-${hash(bytes)}`, pixels(gl, picture));
        if (picture) picture.close();
    }
    gl.getExtension('WEBGL_lose_context').loseContext();
    return found;
}
