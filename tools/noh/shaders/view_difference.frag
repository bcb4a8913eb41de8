#version 300 es
/* view_difference.frag: how much two canvases differ, of their bytes, made stronger. */
precision highp float;

uniform highp sampler2D u_picture; /* sRGB textures: they read as linear light */
uniform highp sampler2D u_other;
uniform highp ivec2 u_corner; /* of the viewport */
uniform float u_gain;

layout(location = 0) out vec4 o_color;

vec3 bytes_of(vec3 light)
{
    return mix(light * 12.92, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, greaterThan(light, vec3(0.0031308)));
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy) - u_corner;
    vec3 a = bytes_of(texelFetch(u_picture, at, 0).rgb), b = bytes_of(texelFetch(u_other, at, 0).rgb);
    o_color = vec4(abs(a - b) * u_gain, 1.0);
}
