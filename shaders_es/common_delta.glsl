/* common_delta.glsl: how a delta texel is decoded (runtime/pack/format.h). Three words, one per axis, each with a field for
 * position, normal and tangent. A signed field is extracted by two shifts: left until its sign is the word's, then right,
 * which copies the sign. */
precision highp float;
precision highp int;
precision highp usampler2D;

/* Bit widths come packed: position | normal << 8 | tangent << 16. Result: left and right shift. */
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

/* What a fragment that writes one layer needs, in one varying: place, that layer's shifts and
 * weight. Rectangles are many and small, so what a triangle carries costs as much as its pixels. */
uvec4 place_of_layer(uvec3 place, vec3 weights, int layer)
{
    uvec2 shifts = delta_shifts(place.z, layer);
    return uvec4(place.xy, shifts.x | shifts.y << 8, floatBitsToUint(layer == 0 ? weights.x : layer == 1 ? weights.y : weights.z));
}

/* The i-th texel of a table that is folded into rows of 1 << width_log2. */
ivec2 table_texel(uint i, int width_log2)
{
    return ivec2(int(i & ((1u << width_log2) - 1u)), int(i >> width_log2));
}
