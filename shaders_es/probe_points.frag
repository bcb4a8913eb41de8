#version 300 es
// Writes a fifth of white.
precision highp float;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(0.2);
}
