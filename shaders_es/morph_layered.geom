#version 320 es
/* morph_layered.geom: the primitive goes to the three layers (row A8). */
#include "common_delta.glsl"

layout(triangles, invocations = 3) in;
layout(triangle_strip, max_vertices = 3) out;

flat in uvec4 v_place[];
flat in vec3 v_weights[];
flat in uint v_bits[];

flat out uvec4 f_place;
flat out float f_weight;
flat out uvec2 f_shifts;

void main()
{
    int layer = gl_InvocationID;
    for (int i = 0; i < 3; i++) {
        f_place = v_place[0];
        f_weight = layer == 0 ? v_weights[0].x : layer == 1 ? v_weights[0].y : v_weights[0].z;
        f_shifts = delta_shifts(v_bits[0], layer);
        gl_Layer = layer;
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
    EndPrimitive();
}
