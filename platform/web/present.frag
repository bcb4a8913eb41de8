#version 300 es
/* present.frag: the resolved picture onto the canvas. Reading it decoded sRGB to linear light;
 * a canvas encodes nothing, so that is done here. */
precision highp float;
uniform highp sampler2D u_picture;
layout(location = 0) out vec4 o_color;

vec3 encoded(vec3 c)
{
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308))));
}

void main()
{
    o_color = vec4(encoded(texelFetch(u_picture, ivec2(gl_FragCoord.xy), 0).rgb), 1.0);
}
