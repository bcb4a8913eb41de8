#version 300 es
/* morph_one.frag: one fragment adds to one layer (per-layer passes, layered draws). */
#include "common_delta.glsl"
#include "common_place.glsl"

flat in uvec4 f_place;
flat in float f_weight;
flat in uvec2 f_shifts;

layout(location = 0) out vec4 o_delta;

void main()
{
    o_delta = vec4(delta_field(delta_words(f_place), f_shifts, f_weight), 0.0);
}
