#version 300 es
/* morph_one.frag: one fragment writes the delta of one layer (per-layer passes, layered draws); blending adds it. */
#include "common_delta.glsl"
#include "common_place.glsl"

flat in uvec3 f_entry;     /* noh_entry_of_layer */

layout(location = 0) out vec4 o_delta;

void main()
{
    uvec2 shifts = uvec2(f_entry.y & 255u, f_entry.y >> 8);
    uvec4 texel = delta_words(f_entry.x);
    float weight = uintBitsToFloat(f_entry.z), fourth = 0.0;
#ifdef OCCLUSION
    fourth = uintBitsToFloat(texel.w) * weight; /* read only in the layer of positions */
#endif
    o_delta = vec4(noh_delta_field(texel.xyz, shifts, weight), fourth);
}
