#version 300 es
/* bench_quad.vert: the rectangle of one target. */
precision highp float;
precision highp int;

uniform ivec4 u_rect;  /* x, y, width, height */
uniform vec2 u_atlas;  /* 2 / size of the accumulation texture */

void main()
{
    ivec2 at = u_rect.xy + ivec2(gl_VertexID & 1, gl_VertexID >> 1) * u_rect.zw;
    gl_Position = vec4(vec2(at) * u_atlas - 1.0, 0.0, 1.0);
}
