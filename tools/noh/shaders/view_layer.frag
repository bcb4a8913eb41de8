#version 300 es
/* view_layer.frag: one accumulator layer as a picture: x, y, z as red, green, blue; grey is no change. */
precision highp float;
precision highp int;
#include "../../../shaders_es/common_layers.glsl"

uniform highp int u_layer;
uniform float u_gain;

layout(location = 0) out vec4 o_color;

void main()
{
    o_color = vec4(vec3(0.5) + u_gain * NOH_LAYER_FETCH(ivec2(gl_FragCoord.xy), u_layer).xyz, 1.0);
}
