/* common_fade.glsl: the pattern by which LOD levels fade. Put it into your own fragment shader and keep a pixel
 * where from <= fade_noise(gl_FragCoord.xy) < to, of a noh_gl_lod.
 *
 * A number in [0, 1) for each pixel, in integers, so that every driver and both draws of a fade have the same one:
 * multiples of the plastic number's powers (Roberts 2018, the sequence R2), which spread evenly over every small
 * neighbourhood, so that a fade is a fine grain at every step. */
precision highp int;

highp float fade_noise(highp vec2 pixel)
{
    uvec2 p = uvec2(pixel) * uvec2(0xc13fa9a9u, 0x91e10da6u);
    return float((p.x + p.y) >> 8) * (1.0 / 16777216.0);
}
