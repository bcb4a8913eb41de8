/* common_walk.glsl: the sums of a vertex, from the list of the active targets of its block of 4 x 4 accumulation texels
 * (gl_morph_lists.c). The path gather calls noh_walk in a fragment shader, once for each update; with NOH_DIRECT, the
 * vertex shader of each draw calls it. It follows common_delta.glsl.
 *
 *   NOH_TWO_LAYERS   defined: tangents are not summed
 *   NOH_DEPTH_ONLY   defined: only positions are summed
 *   NOH_OCCLUSION    defined: so are changes of occlusion (light.h) */
#ifdef NOH_TRANSFER
#if NOH_TRANSFER > 0
#define NOH_OCCLUSION
#endif
#endif

#if defined(NOH_GATHER) || defined(NOH_DIRECT)
uniform highp usampler2D noh_deltas; /* delta words in tiles of 4 x 4; with NOH_OCCLUSION, its delta as float bits */
uniform highp usampler2D noh_lists;  /* entries (common_delta.glsl); the top bit of a fourth word: the list ends here */
uniform highp usampler2D noh_starts; /* where each block's list begins */

struct noh_sums {
    vec3 position, normal, tangent;
    float occlusion;
};

/* A product fused with its sum would be rounded once, not twice as on the CPU. So each product passes through an
 * exclusive or with a bit that is never set, which a compiler cannot know. `precise` needs ES 3.2. */
#define NOH_NEVER_SET 0x40000000u
#define NOH_UNFUSED(product) uintBitsToFloat(floatBitsToUint(product) ^ (entry.w & NOH_NEVER_SET))

/* block: index in the table of starts; inside: texel in the block; then log2 of the widths of both tables */
noh_sums noh_walk(uint block, ivec2 inside, int lists_log2, int starts_log2)
{
    uint i = texelFetch(noh_starts, noh_table_texel(block, starts_log2), 0).x;
    noh_sums s = noh_sums(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    uvec4 entry;
    do { /* a list is never empty */
        entry = texelFetch(noh_lists, noh_table_texel(i, lists_log2), 0);
        uvec4 texel = texelFetch(noh_deltas, noh_entry_tile(entry.w) + inside, 0);
        vec3 weights = uintBitsToFloat(entry.xyz);
#ifdef NOH_OCCLUSION
        s.occlusion += NOH_UNFUSED(uintBitsToFloat(texel.w) * weights.x);
#endif
        s.position += NOH_UNFUSED(noh_delta_field(texel.xyz, noh_entry_shifts(entry.w, 0), weights.x));
#ifndef NOH_DEPTH_ONLY
        s.normal += NOH_UNFUSED(noh_delta_field(texel.xyz, noh_entry_shifts(entry.w, 1), weights.y));
#ifndef NOH_TWO_LAYERS
        s.tangent += NOH_UNFUSED(noh_delta_field(texel.xyz, noh_entry_shifts(entry.w, 2), weights.z));
#endif
#endif
        i++;
    } while (int(entry.w) >= 0);
    return s;
}
#endif
