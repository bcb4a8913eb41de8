#version 300 es
/* morph_gather.frag: each fragment sums the deltas of its own vertex in registers and writes the three layers once, with TWO_LAYERS two.
 * It needs no blending, so any format that can be rendered to will do; with LAYERS_UINT it writes the bits of the
 * floats. */
#include "common_delta.glsl"

uniform usampler2D u_entries;  /* delta words, target; with OCCLUSION, in its high byte, what it changes of that */
uniform usampler2D u_starts;   /* where each touched vertex's entries begin; one more at the end. With OCCLUSION in front
                                * of them, backwards by target, what that is over the scale of positions */
uniform usampler2D u_records;  /* weight * scale of position, normal, tangent; bits */
uniform ivec3 u_tables;        /* width log2 of starts, records, entries */

flat in uvec4 f_tile;

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

void main()
{
    uint touched = f_tile.w & 0xffffffu;
    uvec2 local = uvec2(gl_FragCoord.xy) - uvec2(f_tile.x & 0xffffu, f_tile.x >> 16);
    uint vertex = min((local.y << (f_tile.w >> 24)) + local.x, touched); /* behind the last vertex: an empty list */
    uint from = texelFetch(u_starts, table_texel(f_tile.z + vertex, u_tables.x), 0).x;
    uint to = vertex < touched ? texelFetch(u_starts, table_texel(f_tile.z + vertex + 1u, u_tables.x), 0).x : from;
    vec3 position = vec3(0.0), normal = vec3(0.0), tangent = vec3(0.0);
    float occlusion = 0.0;
    for (uint i = from; i < to; i++) {
        uvec4 entry = texelFetch(u_entries, table_texel(i, u_tables.z), 0);
#ifdef OCCLUSION
        uint target = entry.w & 0xffffffu;
#else
        uint target = entry.w;
#endif
        uvec4 record = texelFetch(u_records, table_texel(f_tile.y + target, u_tables.y), 0);
#ifdef OCCLUSION
        uint ratio = texelFetch(u_starts, table_texel(f_tile.z - 1u - target, u_tables.x), 0).x;
        occlusion += float(int(entry.w) >> 24) * uintBitsToFloat(ratio) * uintBitsToFloat(record.x);
#endif
        position += delta_field(entry.xyz, delta_shifts(record.w, 0), uintBitsToFloat(record.x));
        normal += delta_field(entry.xyz, delta_shifts(record.w, 1), uintBitsToFloat(record.y));
#ifndef TWO_LAYERS
        tangent += delta_field(entry.xyz, delta_shifts(record.w, 2), uintBitsToFloat(record.z));
#endif
    }
    o_position = LAYER_VALUE(position, occlusion);
    o_normal = LAYER_VALUE(normal, 0.0);
#ifndef TWO_LAYERS
    o_tangent = LAYER_VALUE(tangent, 0.0);
#endif
}
