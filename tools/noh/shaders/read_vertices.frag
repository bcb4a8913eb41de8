#version 300 es
/* read_vertices.frag: pass the bits on. */
precision highp float;
precision highp int;

flat in uvec4 f_position;
flat in uvec4 f_normal;
flat in uvec4 f_tangent;

layout(location = 0) out uvec4 o_position;
layout(location = 1) out uvec4 o_normal;
layout(location = 2) out uvec4 o_tangent;

void main()
{
    o_position = f_position;
    o_normal = f_normal;
    o_tangent = f_tangent;
}
