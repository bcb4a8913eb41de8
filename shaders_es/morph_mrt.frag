#version 300 es
/* morph_mrt.frag: one fragment gives the deltas of all layers, with TWO_LAYERS of two; blending adds them. */
#include "common_delta.glsl"
#include "common_place.glsl"

flat in uvec3 f_place;     /* place (common_place.glsl), widths of the fields */
flat in vec3 f_weights;

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_normal;
#ifndef TWO_LAYERS
layout(location = 2) out vec4 o_tangent;
#endif

void main()
{
    uvec4 texel = delta_words(f_place.xy);
    uvec3 words = texel.xyz;
#ifdef OCCLUSION
    o_position = vec4(delta_field(words, delta_shifts(f_place.z, 0), f_weights.x), uintBitsToFloat(texel.w) * f_weights.x);
#else
    o_position = vec4(delta_field(words, delta_shifts(f_place.z, 0), f_weights.x), 0.0);
#endif
    o_normal = vec4(delta_field(words, delta_shifts(f_place.z, 1), f_weights.y), 0.0);
#ifndef TWO_LAYERS
    o_tangent = vec4(delta_field(words, delta_shifts(f_place.z, 2), f_weights.z), 0.0);
#endif
}
