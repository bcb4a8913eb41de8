/* common_place.glsl: the delta texel under a fragment of a rectangle. */
uniform usampler2D u_deltas;
uniform ivec3 u_tables;

uvec3 delta_words(uvec4 place)
{
    uvec2 local = uvec2(gl_FragCoord.xy) - place.xy;
    return texelFetch(u_deltas, table_texel(place.w + local.y * place.z + local.x, u_tables.z), 0).xyz;
}
