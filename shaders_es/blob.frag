#version 300 es
/* blob.frag: the darkness of a spot, in alpha. */
precision highp float;

in vec2 v_at;
in float v_darkness;

out vec4 o_color;

void main()
{
    float left = max(1.0 - dot(v_at, v_at), 0.0);
    o_color = vec4(0.0, 0.0, 0.0, v_darkness * left * left);
}
