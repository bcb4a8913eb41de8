/* common_attributes.glsl: normals and tangents from the pack's pairs of 16-bit integers.
 *
 * A direction is projected onto the octahedron |x| + |y| + |z| = 1, whose lower half is folded over the upper one,
 * leaving two numbers in -1..1 (Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors",
 * 2014). The attributes are integers because drivers differ in how they convert normalised ones. */
vec3 noh_unfold(vec2 p)
{
    vec3 v = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float fold = max(-v.z, 0.0);
    v.xy += vec2(v.x >= 0.0 ? -fold : fold, v.y >= 0.0 ? -fold : fold);
    return normalize(v);
}

vec3 noh_direction_of_pair(ivec2 pair)
{
    return noh_unfold(vec2(pair) / 32767.0);
}

/* The lowest bit of y is the handedness, here the sign of w. A mesh without tangents gets an arbitrary unit vector. */
vec4 noh_tangent_of_pair(ivec2 pair)
{
    return vec4(noh_unfold(vec2(pair.x, pair.y >> 1) / vec2(32767.0, 16383.0)), (pair.y & 1) != 0 ? -1.0 : 1.0);
}
