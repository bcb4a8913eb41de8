/* common_fade.glsl: the pattern by which LOD levels fade. Put it into your own fragment shader and discard a pixel
 * unless from <= noh_fade_noise(gl_FragCoord.xy) < to, the numbers of a noh_gl_lod.
 *
 * Each pixel has a number in [0, 1): x / p + y / p^2 modulo 1, p the plastic number (the sequence R2 of Roberts, "The
 * Unreasonable Effectiveness of Quasirandom Sequences", 2018). These numbers spread evenly over every small
 * neighbourhood, so a fade is a fine grain at every step. They are computed in integers, in units of 2^-32, so that
 * they are the same on every driver and in both draws of a fade. */
precision highp int;

highp float noh_fade_noise(highp vec2 pixel)
{
    uvec2 p = uvec2(pixel) * uvec2(0xc13fa9a9u, 0x91e10da6u);
    return float((p.x + p.y) >> 8) * (1.0 / 16777216.0);
}
