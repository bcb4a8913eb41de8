#version 300 es
/* morph_rect.vert: a quad over one rectangle of one active target, in the tile of one instance of a mesh. With
 * MORPH_MRT, a fragment writes all layers; with MORPH_LAYERED, the geometry shader says which layer; else
 * u_layer does. */
#include "common_delta.glsl"

uniform usampler2D u_rects;   /* x | y << 16, w | h << 16, first delta texel, widths of its fields */
uniform usampler2D u_records; /* weight * scale of position, normal, tangent; tile x | y << 16 */
uniform ivec3 u_tables;       /* width log2 of rects, records, deltas */
uniform vec2 u_atlas;         /* 2 / size of the accumulation texture */
uniform int u_layer;

in uvec2 a_rect_record;       /* a rectangle, and the record of its target in this instance */

#if defined(MORPH_LAYERED)
flat out uvec3 v_place;       /* place (common_place.glsl), widths */
flat out vec3 v_weights;
#elif defined(MORPH_MRT)
flat out uvec3 f_place;
flat out vec3 f_weights;
#else
flat out uvec4 f_place;       /* place_of_layer */
#endif

void main()
{
    uvec4 rect = texelFetch(u_rects, table_texel(a_rect_record.x, u_tables.x), 0);
    uvec4 record = texelFetch(u_records, table_texel(a_rect_record.y, u_tables.y), 0);
    uvec2 size = uvec2(rect.y & 0xffffu, rect.y >> 16);
    uvec2 at = uvec2(rect.x & 0xffffu, rect.x >> 16) + uvec2(record.w & 0xffffu, record.w >> 16);
    uvec2 corner = uvec2(gl_VertexID & 1, gl_VertexID >> 1);
    uvec3 place = uvec3(rect.z - at.y * size.x - at.x, size.x, rect.w);
    vec3 weights = uintBitsToFloat(record.xyz);
    gl_Position = vec4(vec2(at + corner * size) * u_atlas - 1.0, 0.0, 1.0);
#if defined(MORPH_LAYERED)
    v_place = place;
    v_weights = weights;
#elif defined(MORPH_MRT)
    f_place = place;
    f_weights = weights;
#else
    f_place = place_of_layer(place, weights, u_layer);
#endif
}
