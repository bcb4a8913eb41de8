#version 300 es
/* read_vertices.vert: every vertex as the renderer sees it, one pixel each. */
precision highp float;
precision highp int;
#include "../../../shaders_es/common_layers.glsl"
#include "../../../shaders_es/common_attributes.glsl"

uniform ivec2 u_size; /* of the target, pixels */

layout(location = 0) in vec3 a_position;
layout(location = 1) in ivec2 a_normal;
layout(location = 2) in ivec2 a_tangent;

flat out uvec4 f_position;
flat out uvec4 f_normal;
flat out uvec4 f_tangent;

void main()
{
    vec4 rest_tangent = tangent_of_pair(a_tangent);
    vec3 position = a_position, normal = direction_of_pair(a_normal), tangent = rest_tangent.xyz;
    ivec2 pixel = ivec2(gl_VertexID % u_size.x, gl_VertexID / u_size.x);
    morph_fetch(gl_VertexID, position, normal, tangent);
    morph_frame(normal, tangent);
    f_position = uvec4(floatBitsToUint(position), 0u);
    f_normal = uvec4(floatBitsToUint(normal), 0u);
    f_tangent = uvec4(floatBitsToUint(tangent), floatBitsToUint(rest_tangent.w));
    gl_PointSize = 1.0;
    gl_Position = vec4((vec2(pixel) + 0.5) / vec2(u_size) * 2.0 - 1.0, 0.0, 1.0);
}
