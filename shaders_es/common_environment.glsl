/* common_environment.glsl: light from all around, one key light and its shadow, a tone map: what noh_lighting of
 * gl_light.h says. It goes behind common_material.glsl: noh_gl_shader_prefix puts them together. Nothing of it is there
 * with NOH_DEPTH_ONLY. Defines, which noh_gl_variant_defines writes:
 *
 *   NOH_LIT   defined: the renderer is lit (noh_gl_renderer_desc.lit) */
#if defined(NOH_LIT) && !defined(NOH_DEPTH_ONLY)
uniform vec4 noh_lighting[18];
uniform mediump samplerCube noh_environment;
uniform highp sampler2DShadow noh_shadow_map;

#define noh_key_color noh_lighting[12].rgb /* what a white matte surface that faces it reflects */
#define noh_key_gloss noh_lighting[12].w   /* share of it that glosses */

/* What a white matte surface reflects of the light from all around, by its normal: spherical harmonics of order 3
 * (Ramamoorthi, Hanrahan: An efficient representation for irradiance environment maps, SIGGRAPH 2001). */
vec3 noh_ambient(vec3 n)
{
    vec3 c = noh_lighting[0].rgb + noh_lighting[1].rgb * n.y + noh_lighting[2].rgb * n.z + noh_lighting[3].rgb * n.x;
    c += noh_lighting[4].rgb * (n.x * n.y) + noh_lighting[5].rgb * (n.y * n.z) + noh_lighting[6].rgb * (3.0 * n.z * n.z - 1.0);
    c += noh_lighting[7].rgb * (n.x * n.z) + noh_lighting[8].rgb * (n.x * n.x - n.y * n.y);
    return max(c, vec3(0.0));
}

/* What a surface of this roughness mirrors from a direction. */
vec3 noh_mirror(vec3 r, float roughness)
{
    vec3 d = vec3(dot(noh_lighting[9].xyz, r), dot(noh_lighting[10].xyz, r), dot(noh_lighting[11].xyz, r));
    return textureLod(noh_environment, d, 4.0 * roughness).rgb;
}

/* 1: the key light reaches the point, 0: something is in its way. Four taps, each of which the hardware filters. The
 * point is moved along the normal by as much as a texel of the map may hide of a slope. */
float noh_key_shadow(vec3 position, vec3 normal)
{
    if (noh_lighting[13].z <= 0.0) {
        return 1.0;
    }
    float slope = 1.0 - clamp(dot(normal, noh_key), 0.0, 1.0);
    vec4 p = vec4(position + normal * (noh_lighting[13].z * (0.7 + 2.0 * slope)), 1.0);
    vec3 at = (noh_lighting[14] * p.x + noh_lighting[15] * p.y + noh_lighting[16] * p.z + noh_lighting[17]).xyz * 0.5 + 0.5;
    at.z = min(at.z, 1.0) - 0.0003;
    float step = noh_lighting[13].w; /* three quarters of a texel */
    float sum = texture(noh_shadow_map, at + vec3(-step, -0.4 * step, 0.0)) + texture(noh_shadow_map, at + vec3(0.4 * step, -step, 0.0));
    sum += texture(noh_shadow_map, at + vec3(step, 0.4 * step, 0.0)) + texture(noh_shadow_map, at + vec3(-0.4 * step, step, 0.0));
    vec2 edge = step * 2.0 + abs(at.xy - 0.5);
    return edge.x < 0.5 && edge.y < 0.5 ? 0.25 * sum : 1.0; /* outside the map nothing is known to be in the way */
}

/* A linear colour after exposure and tone map. */
vec3 noh_expose(vec3 c)
{
    c *= noh_lighting[13].x;
    vec3 filmic = c * 0.6; /* K. Narkowicz: ACES filmic tone mapping curve, 2015 */
    filmic = (filmic * (2.51 * filmic + 0.03)) / (filmic * (2.43 * filmic + 0.59) + 0.14);
    return noh_lighting[13].y > 0.5 ? filmic : c;
}
#endif
