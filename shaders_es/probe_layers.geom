#version 320 es
// Sends the triangle to each of three layers.
layout(triangles, invocations = 3) in;
layout(triangle_strip, max_vertices = 3) out;
flat out highp int layer;

void main() {
    for (int i = 0; i < 3; i++) {
        gl_Position = gl_in[i].gl_Position;
        gl_Layer = gl_InvocationID;
        layer = gl_InvocationID;
        EmitVertex();
    }
    EndPrimitive();
}
