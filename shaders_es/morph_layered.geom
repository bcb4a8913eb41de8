#version 320 es
/* morph_layered.geom: one invocation per layer sends the triangle to it by gl_Layer, like the geometry shader of
 * Microsoft's SparseMorphTargets sample (DirectX SDK) for its three render targets. */
#include "common_delta.glsl"

#ifdef TWO_LAYERS
layout(triangles, invocations = 2) in;
#else
layout(triangles, invocations = 3) in;
#endif
layout(triangle_strip, max_vertices = 3) out;

flat in uvec4 v_entry[];

flat out uvec3 f_entry;

void main()
{
    int layer = gl_InvocationID;
    uvec3 entry = noh_entry_of_layer(v_entry[0], layer);
    for (int i = 0; i < 3; i++) {
        f_entry = entry;
        gl_Layer = layer;
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
    EndPrimitive();
}
