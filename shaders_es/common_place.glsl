/* common_place.glsl: the delta texel under a fragment of a rectangle. */
uniform usampler2D u_deltas;
uniform ivec3 u_tables;

/* place: the number of the delta texel that would lie under fragment (0, 0), which may wrap
 * below zero and back, and the rectangle's width. */
uvec3 delta_words(uvec2 place)
{
    uvec2 at = uvec2(gl_FragCoord.xy);
    return texelFetch(u_deltas, table_texel(place.x + at.y * place.y + at.x, u_tables.z), 0).xyz;
}
