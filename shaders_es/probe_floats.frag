#version 300 es
// Writes known floats to three layers at once. Layer i gets the texel i to the right, which reveals swapped and missing
// layers.
precision highp float;
precision highp int;
uniform highp sampler2D values; // 16 x 3
flat in highp int row;
layout(location = 0) out vec4 layer0;
layout(location = 1) out vec4 layer1;
layout(location = 2) out vec4 layer2;

void main() {
    int x = int(gl_FragCoord.x);
    layer0 = texelFetch(values, ivec2(x, row), 0);
    layer1 = texelFetch(values, ivec2((x + 1) & 15, row), 0);
    layer2 = texelFetch(values, ivec2((x + 2) & 15, row), 0);
}
