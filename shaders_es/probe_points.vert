#version 300 es
// Eight points of size 4 over every second block of 4 x 4 of a target of 16 x 16.
void main() {
    vec2 block = vec2(float((gl_VertexID & 1) * 2 + ((gl_VertexID >> 1 & 1) ^ 1)), float(gl_VertexID >> 1));
    gl_Position = vec4((block * 4.0 + 2.0) / 8.0 - 1.0, 0.0, 1.0);
    gl_PointSize = 4.0;
}
