#version 300 es
// One triangle over the whole target, from gl_VertexID alone. Each instance reads
// another row of the values.
uniform highp int first_row;
flat out highp int row;

void main() {
    row = first_row + gl_InstanceID;
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
