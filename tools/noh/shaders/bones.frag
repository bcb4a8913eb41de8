#version 300 es
/* bones.frag: one light next to the viewer, one above. Writes linear light. */
precision highp float;

uniform vec3 u_key; /* unit, towards the light */

in vec3 v_normal;
in vec3 v_color;

layout(location = 0) out vec4 o_color;

void main()
{
    vec3 n = normalize(v_normal);
    float light = 0.35 + 0.2 * n.y + 0.65 * max(dot(n, u_key), 0.0);
    o_color = vec4(v_color * light, 1.0);
}
