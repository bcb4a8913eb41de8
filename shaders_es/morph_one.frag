#version 300 es
/* morph_one.frag: one fragment gives the delta of one layer (per-layer passes, layered draws); blending adds it. */
#include "common_delta.glsl"
#include "common_place.glsl"

flat in uvec4 f_place;     /* place, left and right shift, weight */

layout(location = 0) out vec4 o_delta;

void main()
{
    uvec2 shifts = uvec2(f_place.z & 255u, f_place.z >> 8);
    uvec4 texel = delta_words(f_place.xy);
    float weight = uintBitsToFloat(f_place.w), fourth = 0.0;
#ifdef OCCLUSION
    fourth = uintBitsToFloat(texel.w) * weight; /* in other layers than that of positions it is not read */
#endif
    o_delta = vec4(delta_field(texel.xyz, shifts, weight), fourth);
}
