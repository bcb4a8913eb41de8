/* common_place.glsl: the delta texel under a fragment of a rectangle. */
uniform usampler2D u_deltas;
uniform ivec3 u_tables;

/* Three words, and with OCCLUSION the bits of what it changes of occlusion, over the scale of positions. place: the index of the delta texel that would lie under fragment (0, 0) if the rectangle reached that far, and the
 * rectangle's width. The index may be negative, that is wrap; adding the fragment's own offset wraps it back. */
uvec4 delta_words(uvec2 place)
{
    uvec2 at = uvec2(gl_FragCoord.xy);
    return texelFetch(u_deltas, table_texel(place.x + at.y * place.y + at.x, u_tables.z), 0);
}
