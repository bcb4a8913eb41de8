#version 300 es
/* view_picture.frag: the canvas in a window whose bytes are sRGB already. */
precision highp float;

uniform highp sampler2D u_picture; /* an sRGB texture: it reads as linear light */
uniform highp ivec2 u_corner;      /* of the viewport */

layout(location = 0) out vec4 o_color;

void main()
{
    vec3 light = texelFetch(u_picture, ivec2(gl_FragCoord.xy) - u_corner, 0).rgb;
    vec3 bytes = mix(light * 12.92, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, greaterThan(light, vec3(0.0031308)));
    o_color = vec4(bytes, 1.0);
}
