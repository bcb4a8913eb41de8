#version 300 es
// Writes the bits of the floats of probe_floats.frag to integer layers.
precision highp float;
precision highp int;
uniform highp sampler2D values; // 16 x 3
flat in highp int row;
layout(location = 0) out highp uvec4 layer0;
layout(location = 1) out highp uvec4 layer1;
layout(location = 2) out highp uvec4 layer2;

void main() {
    int x = int(gl_FragCoord.x);
    layer0 = floatBitsToUint(texelFetch(values, ivec2(x, row), 0));
    layer1 = floatBitsToUint(texelFetch(values, ivec2((x + 1) & 15, row), 0));
    layer2 = floatBitsToUint(texelFetch(values, ivec2((x + 2) & 15, row), 0));
}
