#version 300 es
/* bench_quad.frag: one target's delta, weighted; blending adds it. */
precision highp float;
precision highp int;
precision highp sampler2D;

uniform sampler2D u_positions;
uniform sampler2D u_normals;
uniform sampler2D u_tangents;
uniform ivec4 u_rect;
uniform float u_weight;

flat in int f_layer;

layout(location = 0) out vec4 o_sum;

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy) - u_rect.xy;
    vec3 delta;
    if (f_layer == 0) {
        delta = texelFetch(u_positions, texel, 0).xyz;
    } else if (f_layer == 1) {
        delta = texelFetch(u_normals, texel, 0).xyz;
    } else {
        delta = texelFetch(u_tangents, texel, 0).xyz;
    }
    o_sum = vec4(delta * u_weight, 0.0);
}
