#version 300 es
/* read_layers.vert: a point for each accumulation texel of a tile, with its deltas as bits, through the same fetch that
 * a mesh's vertex shader uses. Works for every layer format, and with NOH_DIRECT. */
precision highp float;
precision highp int;
#include "../../../shaders_es/common_delta.glsl"
#include "../../../shaders_es/common_walk.glsl"
#include "../../../shaders_es/common_layers.glsl"

uniform ivec2 u_size; /* of the tile */

flat out uvec3 f_position;
flat out uvec3 f_normal;
flat out uvec3 f_tangent;

void main()
{
    vec3 position = vec3(0.0), normal = vec3(0.0), tangent = vec3(0.0);
    noh_morph_fetch(gl_VertexID, position, normal, tangent);
    f_position = floatBitsToUint(position);
    f_normal = floatBitsToUint(normal);
    f_tangent = floatBitsToUint(tangent);
    ivec2 at = ivec2(gl_VertexID % u_size.x, gl_VertexID / u_size.x);
    gl_Position = vec4((vec2(at) + 0.5) / vec2(u_size) * 2.0 - 1.0, 0.0, 1.0);
    gl_PointSize = 1.0;
}
