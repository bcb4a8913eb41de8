#version 300 es
/* morph_block.vert: with MORPH_POINTS a point over a block of 4 x 4 texels, else a corner of a quad over a strip of
 * such blocks, of one active target in the tile of one instance of a mesh. With MORPH_MRT, a fragment writes all
 * layers; with MORPH_LAYERED, the geometry shader selects the layer; else u_layer does. */
#include "common_delta.glsl"

uniform usampler2D u_records; /* entries (common_delta.glsl) without a tile position */
uniform ivec3 u_tables;       /* width log2 of records */
uniform vec2 u_atlas;         /* 2 / size of the accumulation texture */
uniform int u_layer;

in uvec3 a_block;             /* texel of the accumulation texture x | y << 16, delta texel likewise, record */

#if defined(MORPH_LAYERED)
flat out uvec4 v_entry;
#elif defined(MORPH_MRT)
flat out uvec4 f_entry;
#else
flat out uvec3 f_entry;       /* noh_entry_of_layer */
#endif

void main()
{
    uvec4 entry = texelFetch(u_records, noh_table_texel(a_block.z, u_tables.x), 0);
    uvec2 at = uvec2(a_block.x & 0xffffu, a_block.x >> 16);
    uvec2 place = uvec2(a_block.y & 0xffffu, a_block.y >> 16) - at; /* whole blocks */
    entry.w |= place.x >> 2 & 511u | (place.y >> 2 & 511u) << 9;
#ifdef MORPH_POINTS
    gl_Position = vec4((vec2(at) + 2.0) * u_atlas - 1.0, 0.0, 1.0);
    gl_PointSize = 4.0;
#else
    gl_Position = vec4(vec2(at) * u_atlas - 1.0, 0.0, 1.0);
#endif
#if defined(MORPH_LAYERED)
    v_entry = entry;
#elif defined(MORPH_MRT)
    f_entry = entry;
#else
    f_entry = noh_entry_of_layer(entry, u_layer);
#endif
}
