/* common_delta.glsl: decodes delta texels (format.h). A texel is three words, one per axis, each with signed fields for
 * position, normal and tangent, from the top bit down. Two shifts extract a field: left to the top bit, then right with
 * sign extension. */
precision highp float;
precision highp int;
precision highp usampler2D;

/* An entry has three words, weight * scale of position, normal and tangent, and a fourth: the position of its tile in
 * blocks x | y << 9, the widths of the first two fields << 18 and << 23. The tangent takes the rest of a word
 * (gl_morph_tiles.c). */
ivec2 noh_entry_tile(uint entry)
{
    return ivec2(entry << 2 & 2044u, entry >> 7 & 2044u);
}

/* The left and right shift of a layer's field. */
uvec2 noh_entry_shifts(uint entry, int layer)
{
    uint position = entry >> 18 & 31u, normal = entry >> 23 & 31u, both = position + normal;
    return layer == 0 ? uvec2(0u, 32u - position) : layer == 1 ? uvec2(position, 32u - normal) : uvec2(both);
}

vec3 noh_delta_field(uvec3 words, uvec2 shifts, float weight)
{
    return vec3(ivec3(words << shifts.x) >> shifts.y) * weight;
}

/* The inputs of a fragment that writes one layer, in one varying: the entry's fourth word, the layer's shifts and
 * weight. Primitives are small and numerous, so varyings cost as much as pixels. */
uvec3 noh_entry_of_layer(uvec4 entry, int layer)
{
    uvec2 shifts = noh_entry_shifts(entry.w, layer);
    return uvec3(entry.w, shifts.x | shifts.y << 8, layer == 0 ? entry.x : layer == 1 ? entry.y : entry.z);
}

/* The position of texel i in a table, which is folded into rows of 1 << width_log2 texels. */
ivec2 noh_table_texel(uint i, int width_log2)
{
    return ivec2(int(i & ((1u << width_log2) - 1u)), int(i >> width_log2));
}
