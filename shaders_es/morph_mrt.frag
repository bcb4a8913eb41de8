#version 300 es
/* morph_mrt.frag: one fragment writes the deltas of all layers, or with TWO_LAYERS of two; blending adds them. */
#include "common_delta.glsl"
#include "common_place.glsl"

flat in uvec4 f_entry;     /* common_delta.glsl */

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_normal;
#ifndef TWO_LAYERS
layout(location = 2) out vec4 o_tangent;
#endif

void main()
{
    uvec4 texel = delta_words(f_entry.w);
    uvec3 words = texel.xyz;
    vec3 weights = uintBitsToFloat(f_entry.xyz);
#ifdef OCCLUSION
    o_position = vec4(noh_delta_field(words, noh_entry_shifts(f_entry.w, 0), weights.x),
                      uintBitsToFloat(texel.w) * weights.x);
#else
    o_position = vec4(noh_delta_field(words, noh_entry_shifts(f_entry.w, 0), weights.x), 0.0);
#endif
    o_normal = vec4(noh_delta_field(words, noh_entry_shifts(f_entry.w, 1), weights.y), 0.0);
#ifndef TWO_LAYERS
    o_tangent = vec4(noh_delta_field(words, noh_entry_shifts(f_entry.w, 2), weights.z), 0.0);
#endif
}
