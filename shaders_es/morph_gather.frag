#version 300 es
/* morph_gather.frag: each fragment sums the deltas of its own vertex in registers and writes the three layers once,
 * with NOH_TWO_LAYERS two. It needs no blending, so any renderable format works; with LAYERS_UINT it writes the bits of
 * the floats. All fragments of a block of 4 x 4 read the same list: one entry per active target. */
#define NOH_GATHER
#include "common_delta.glsl"
#include "common_walk.glsl"

#define WIDTH_LOG2 8 /* of the tables of lists and starts */

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
#ifndef NOH_TWO_LAYERS
layout(location = 2) out LAYER o_tangent;
#endif

void main()
{
    uvec2 local = uvec2(gl_FragCoord.xy) - uvec2(f_tile.x & 0xffffu, f_tile.x >> 16);
    uint block = f_tile.y + (local.y >> 2 << f_tile.z) + (local.x >> 2);
    noh_sums s = noh_walk(block, ivec2(local & 3u), WIDTH_LOG2, WIDTH_LOG2);
    o_position = LAYER_VALUE(s.position, s.occlusion);
    o_normal = LAYER_VALUE(s.normal, 0.0);
#ifndef NOH_TWO_LAYERS
    o_tangent = LAYER_VALUE(s.tangent, 0.0);
#endif
}
