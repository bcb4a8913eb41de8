#version 320 es
/* bench_quad.geom: the triangle once for each layer. */
layout(triangles) in;
layout(triangle_strip, max_vertices = 9) out;

flat out int f_layer;

void main()
{
    for (int layer = 0; layer < 3; layer++) {
        for (int i = 0; i < 3; i++) {
            f_layer = layer;
            gl_Layer = layer;
            gl_Position = gl_in[i].gl_Position;
            EmitVertex();
        }
        EndPrimitive();
    }
}
