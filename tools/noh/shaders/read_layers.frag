#version 300 es
/* read_layers.frag: writes the bits of read_layers.vert. */
precision highp float;
precision highp int;

flat in uvec3 f_position;
flat in uvec3 f_normal;
flat in uvec3 f_tangent;

layout(location = 0) out uvec4 o_position;
layout(location = 1) out uvec4 o_normal;
layout(location = 2) out uvec4 o_tangent;

void main()
{
    o_position = uvec4(f_position, 0u);
    o_normal = uvec4(f_normal, 0u);
    o_tangent = uvec4(f_tangent, 0u);
}
