/* common_place.glsl: the delta texel under a fragment of a block. */
uniform usampler2D u_deltas;

/* Three words, and with OCCLUSION a fourth: the bits of the occlusion delta, divided by the scale of positions. entry:
 * the position of its tile is relative to the fragment's block, and wraps at 2048, the size of the largest texture. */
uvec4 delta_words(uint entry)
{
    return texelFetch(u_deltas, ivec2(gl_FragCoord.xy) + noh_entry_tile(entry) & 2047, 0);
}
