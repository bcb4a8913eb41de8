#version 300 es
/* morph_gather.frag: each fragment sums the deltas of its own vertex in registers and writes the three layers once,
 * with TWO_LAYERS two. It needs no blending, so any renderable format works; with LAYERS_UINT it writes the bits of the
 * floats. All fragments of a block of 4 x 4 read the same list: one entry per active target. */
#include "common_delta.glsl"

uniform usampler2D u_deltas;   /* delta words in tiles of 4 x 4; with OCCLUSION, its delta as float bits too */
uniform usampler2D u_lists;    /* entries (common_delta.glsl); the top bit of a fourth word: the list ends here */
uniform usampler2D u_starts;   /* where each block's list begins */
#define WIDTH_LOG2 8           /* of both */

flat in uvec3 f_tile;

#ifdef LAYERS_UINT
#define LAYER uvec4
#define LAYER_VALUE(v, w) floatBitsToUint(vec4(v, w))
#else
#define LAYER vec4
#define LAYER_VALUE(v, w) vec4(v, w)
#endif
layout(location = 0) out LAYER o_position;
layout(location = 1) out LAYER o_normal;
#ifndef TWO_LAYERS
layout(location = 2) out LAYER o_tangent;
#endif

/* A product fused with its sum would be rounded once, not twice as on the CPU. So each product passes through an
 * exclusive or with a bit that is never set, which a compiler cannot know. `precise` needs ES 3.2. */
#define NEVER_SET 0x40000000u
#define UNFUSED(product) uintBitsToFloat(floatBitsToUint(product) ^ (entry.w & NEVER_SET))

void main()
{
    uvec2 local = uvec2(gl_FragCoord.xy) - uvec2(f_tile.x & 0xffffu, f_tile.x >> 16);
    uint block = f_tile.y + (local.y >> 2 << f_tile.z) + (local.x >> 2);
    uint i = texelFetch(u_starts, table_texel(block, WIDTH_LOG2), 0).x;
    ivec2 inside = ivec2(local & 3u);
    vec3 position = vec3(0.0), normal = vec3(0.0), tangent = vec3(0.0);
    float occlusion = 0.0;
    uvec4 entry;
    do { /* a list is never empty */
        entry = texelFetch(u_lists, table_texel(i, WIDTH_LOG2), 0);
        uvec4 texel = texelFetch(u_deltas, entry_tile(entry.w) + inside, 0);
        vec3 weights = uintBitsToFloat(entry.xyz);
#ifdef OCCLUSION
        occlusion += UNFUSED(uintBitsToFloat(texel.w) * weights.x);
#endif
        position += UNFUSED(delta_field(texel.xyz, entry_shifts(entry.w, 0), weights.x));
        normal += UNFUSED(delta_field(texel.xyz, entry_shifts(entry.w, 1), weights.y));
#ifndef TWO_LAYERS
        tangent += UNFUSED(delta_field(texel.xyz, entry_shifts(entry.w, 2), weights.z));
#endif
        i++;
    } while (int(entry.w) >= 0);
    o_position = LAYER_VALUE(position, occlusion);
    o_normal = LAYER_VALUE(normal, 0.0);
#ifndef TWO_LAYERS
    o_tangent = LAYER_VALUE(tangent, 0.0);
#endif
}
