#version 300 es
/* read_layers.frag: the accumulated deltas of one tile, as bits, through the same
 * fetch that a mesh's vertex shader uses. Works for every layer format. */
precision highp float;
precision highp int;
#include "../../../shaders_es/common_layers.glsl"

layout(location = 0) out uvec4 o_position;
layout(location = 1) out uvec4 o_normal;
layout(location = 2) out uvec4 o_tangent;

void main()
{
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 position = vec3(0.0), normal = vec3(0.0), tangent = vec3(0.0);
    noh_morph_fetch((p.y << noh_morph.z) + p.x, position, normal, tangent);
    o_position = uvec4(floatBitsToUint(position), 0u);
    o_normal = uvec4(floatBitsToUint(normal), 0u);
    o_tangent = uvec4(floatBitsToUint(tangent), 0u);
}
