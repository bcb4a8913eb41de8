#version 300 es
/* overlay.vert: points in the world with a normal and a colour each; what lies on a surface is drawn nearer than it. */
precision highp float;

uniform mat4 u_view_projection;
uniform float u_nearer; /* of a depth range of 2 */

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_color;

out vec3 v_normal;
out vec4 v_color;

void main()
{
    v_normal = a_normal;
    v_color = a_color;
    gl_Position = u_view_projection * vec4(a_position, 1.0);
    gl_Position.z -= u_nearer * gl_Position.w;
}
