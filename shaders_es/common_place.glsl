/* common_place.glsl: the delta texel under a fragment of a block. */
uniform usampler2D u_deltas;

/* Three words, and with OCCLUSION the bits of what it changes of occlusion, over the scale of positions. entry: its tile's
 * place is told from the fragment's block on, and wraps where the texture of 2048 x 2048 ends that it may lie in. */
uvec4 delta_words(uint entry)
{
    return texelFetch(u_deltas, ivec2(gl_FragCoord.xy) + entry_tile(entry) & 2047, 0);
}
