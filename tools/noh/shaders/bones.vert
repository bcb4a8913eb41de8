#version 300 es
/* bones.vert: triangles in model space with a normal and a colour each. */
precision highp float;

uniform mat4 u_view_projection;

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec3 a_color;

out vec3 v_normal;
out vec3 v_color;

void main()
{
    v_normal = a_normal;
    v_color = a_color;
    gl_Position = u_view_projection * vec4(a_position, 1.0);
}
