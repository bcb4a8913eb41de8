#version 300 es
/* view_marks.vert: triangles in the world with a colour each. */
precision highp float;

uniform mat4 u_view_projection;

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec4 a_color;

out vec4 v_color;

void main()
{
    v_color = a_color;
    gl_Position = u_view_projection * vec4(a_position, 1.0);
}
