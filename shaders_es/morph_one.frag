#version 300 es
/* morph_one.frag: one fragment gives the delta of one layer (per-layer passes, layered draws); blending adds it. */
#include "common_delta.glsl"
#include "common_place.glsl"

flat in uvec4 f_place;     /* place, left and right shift, weight */

layout(location = 0) out vec4 o_delta;

void main()
{
    uvec2 shifts = uvec2(f_place.z & 255u, f_place.z >> 8);
    o_delta = vec4(delta_field(delta_words(f_place.xy), shifts, uintBitsToFloat(f_place.w)), 0.0);
}
