/* common_delta.glsl: how a delta texel is decoded (runtime/pack/format.h). It is three words, one per axis, each with
 * signed fields for position, normal and tangent, from the top bit down. A field is extracted by two shifts: left until
 * its sign is that of the word, then right, which copies the sign. */
precision highp float;
precision highp int;
precision highp usampler2D;

/* The left and right shift of a layer's field. bits: the widths of the fields, position | normal << 8 |
 * tangent << 16. */
uvec2 delta_shifts(uint bits, int layer)
{
    uint position = bits & 255u, normal = (bits >> 8) & 255u, tangent = (bits >> 16) & 255u;
    uint left = layer == 0 ? 0u : layer == 1 ? position : position + normal;
    uint width = layer == 0 ? position : layer == 1 ? normal : tangent;
    return uvec2(left, 32u - width);
}

vec3 delta_field(uvec3 words, uvec2 shifts, float weight)
{
    return vec3(ivec3(words << shifts.x) >> shifts.y) * weight;
}

/* What a fragment that writes one layer needs, in one varying: its place (common_place.glsl), the layer's shifts, the
 * layer's weight. Rectangles are many and small, so the varyings of a triangle cost as much as its pixels. */
uvec4 place_of_layer(uvec3 place, vec3 weights, int layer)
{
    uvec2 shifts = delta_shifts(place.z, layer);
    return uvec4(place.xy, shifts.x | shifts.y << 8, floatBitsToUint(layer == 0 ? weights.x : layer == 1 ? weights.y : weights.z));
}

/* Where texel i of a table lies, which is folded into rows of 1 << width_log2 texels. */
ivec2 table_texel(uint i, int width_log2)
{
    return ivec2(int(i & ((1u << width_log2) - 1u)), int(i >> width_log2));
}
