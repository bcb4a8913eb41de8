#version 300 es
/* overlay.frag: colours as they are, or shaded by a light at the viewer to show their form. Linear light. */
precision highp float;

uniform vec3 u_key;     /* unit, towards the light */
uniform float u_shaded; /* 1: with form */

in vec3 v_normal;
in vec4 v_color;

layout(location = 0) out vec4 o_color;

void main()
{
    float light = 0.55 + 0.45 * abs(dot(normalize(v_normal), u_key));
    o_color = vec4(v_color.rgb * mix(1.0, light, u_shaded), v_color.a);
}
