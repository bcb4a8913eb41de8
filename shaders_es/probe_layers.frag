#version 320 es
// Writes the layer's index as a colour: 51, 102, 153 in eight bits.
flat in highp int layer;
layout(location = 0) out highp vec4 color;

void main() {
    color = vec4(0.2 * float(layer + 1));
}
