#version 300 es
/* mesh.vert: a morphed mesh as its shaders see it. */
precision highp float;
precision highp int;
#include "common_layers.glsl"
#include "common_attributes.glsl"

uniform mat4 u_view_projection;
uniform vec4 u_world[3];        /* rows of 3 x 4 */
uniform vec4 u_normal[3];       /* rows of the inverse transpose of its 3 x 3 part */
uniform vec4 u_uv;              /* offset, scale */

layout(location = 0) in vec3 a_position;
layout(location = 1) in ivec2 a_normal;
layout(location = 2) in ivec2 a_tangent;
layout(location = 3) in vec2 a_uv;
layout(location = 4) in vec4 a_color;

out vec3 v_world;
out vec3 v_normal;
out vec4 v_tangent;
out vec2 v_uv;
out vec4 v_color;
out vec3 v_model;

void main()
{
    vec4 rest_tangent = tangent_of_pair(a_tangent);
    vec3 position = a_position, normal = direction_of_pair(a_normal), tangent = rest_tangent.xyz;
    morph_fetch(gl_VertexID, position, normal, tangent);
    morph_frame(normal, tangent);
    vec4 p = vec4(position, 1.0);
    v_world = vec3(dot(u_world[0], p), dot(u_world[1], p), dot(u_world[2], p));
    v_normal = vec3(dot(u_normal[0].xyz, normal), dot(u_normal[1].xyz, normal), dot(u_normal[2].xyz, normal));
    v_tangent = vec4(dot(u_world[0].xyz, tangent), dot(u_world[1].xyz, tangent), dot(u_world[2].xyz, tangent), rest_tangent.w);
    v_uv = u_uv.xy + u_uv.zw * a_uv;
    v_color = vec4(a_color.rgb * a_color.rgb, a_color.a);
    v_model = position;
    gl_Position = u_view_projection * vec4(v_world, 1.0);
}
