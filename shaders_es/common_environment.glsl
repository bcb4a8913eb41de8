/* common_environment.glsl: ambient light, one key light and its shadow, a tone map: see noh_lighting in noh_gl.h. It
 * follows common_material.glsl in noh_gl_shader_prefix. Empty with NOH_DEPTH_ONLY. Defines, written by
 * noh_gl_variant_defines:
 *
 *   NOH_LIT          defined: the renderer is lit (noh_gl_renderer_desc.lit)
 *   NOH_AT_VERTICES  defined in vertex shaders: only ambient light
 *   NOH_SHADOW_TAPS  with NOH_LIT, 1 to 4 (default): how often the shadow map is read, so that no pixel makes more than 8
 *                    fetches; 0: the map is soft, and read once */
#if defined(NOH_LIT) && !defined(NOH_DEPTH_ONLY)
#ifndef NOH_SHADOW_TAPS
#define NOH_SHADOW_TAPS 4
#endif
uniform vec4 noh_lighting[18];

/* The ambient light reflected by a white matte surface, by its normal: spherical harmonics of order 3 (Ramamoorthi,
 * Hanrahan: An efficient representation for irradiance environment maps, SIGGRAPH 2001). */
vec3 noh_ambient(vec3 n)
{
    vec3 c = noh_lighting[0].rgb + noh_lighting[1].rgb * n.y + noh_lighting[2].rgb * n.z + noh_lighting[3].rgb * n.x;
    c += noh_lighting[4].rgb * (n.x * n.y) + noh_lighting[5].rgb * (n.y * n.z) + noh_lighting[6].rgb * (3.0 * n.z * n.z - 1.0);
    c += noh_lighting[7].rgb * (n.x * n.z) + noh_lighting[8].rgb * (n.x * n.x - n.y * n.y);
    return max(c, vec3(0.0));
}

#ifndef NOH_AT_VERTICES
uniform mediump samplerCube noh_environment;
#if NOH_SHADOW_TAPS > 0
uniform highp sampler2DShadow noh_shadow_map;
#else
uniform highp sampler2D noh_shadow_map;
#endif

#define noh_key_color noh_lighting[12].rgb /* the light reflected by a white matte surface that faces it */
#define noh_key_gloss noh_lighting[12].w   /* share of it in highlights */

/* The light mirrored from a direction by a surface of this roughness. */
vec3 noh_mirror(vec3 r, float roughness)
{
    vec3 d = vec3(dot(noh_lighting[9].xyz, r), dot(noh_lighting[10].xyz, r), dot(noh_lighting[11].xyz, r));
    return textureLod(noh_environment, d, 4.0 * roughness).rgb;
}

#if NOH_SHADOW_TAPS == 0
/* noh_lighting[0].w: the blur's width by the lamp's; [1].w: the farthest depth.
 * Chebyshev's bound on the light at a depth, by two moments of the casters' depth (Donnelly, Lauritzen: Variance shadow
 * maps, I3D 2006). A blurred edge is made as narrow as the lamp's penumbra, by the distance of the caster: of two
 * planes the moments give it exactly. What leaks is cut (A. Lauritzen: Summed-area variance shadow maps, GPU Gems 3,
 * 2007). */
float noh_shadow_soft(vec3 at)
{
    vec2 m = texture(noh_shadow_map, at.xy).rg;
    float behind = max(min(4.0 * at.z - 3.0, noh_lighting[1].w) - m.x, 0.0), spread = max(m.y - m.x * m.x, 0.000036);
    float light = spread / (spread + behind * behind);
#ifndef NOH_PHONE /* there an edge is as wide as the blur */
    float narrow = noh_lighting[0].w * (1.0 - light) / max(behind, 1e-5);
    light = (light - 0.5) * clamp(narrow, 1.0, 5.0) + 0.5;
#endif
    return clamp(1.25 * light - 0.25, 0.0, 1.0);
}
#else
float noh_shadow_tap(vec3 at, float x, float y)
{
    return texture(noh_shadow_map, at + noh_lighting[13].w * vec3(x, y, 0.0)); /* w: three quarters of a texel */
}
#endif

#if NOH_SHADOW_TAPS == 4
/* noh_lighting[2].w: the map's side, pixels.
 * A tent four texels wide, in two dimensions the product of two, from four hardware-filtered taps: each reads the
 * two texels between which it lies with the weights of the tent (I. Castano: Shadow mapping summary, part 1, 2013). */
float noh_shadow_tent(vec3 at)
{
    float texel = noh_lighting[13].w / 0.75;
    vec2 p = at.xy * noh_lighting[2].w + 0.5, base = floor(p), f = p - base;
    vec2 from = (base - 1.0 + 0.5 / (3.0 - 2.0 * f)) * texel, to = (base + 1.0 - 0.5 / (1.0 + 2.0 * f)) * texel;
    float low = texture(noh_shadow_map, vec3(from, at.z));
    float low_right = texture(noh_shadow_map, vec3(to.x, from.y, at.z));
    float high = texture(noh_shadow_map, vec3(from.x, to.y, at.z));
    float high_right = texture(noh_shadow_map, vec3(to, at.z));
    vec2 share = 0.25 + 0.5 * f; /* of the farther two texels */
    low += share.x * (low_right - low); /* a Mali-G52 takes two products for a mix, one for this */
    high += share.x * (high_right - high);
    return low + share.y * (high - low);
}
#endif

/* 1: the key light reaches the point, 0: the point is in shadow. Filtered taps, or one of a soft map. The point is
 * offset along the normal, by the depth that a texel of the map may span on a slope. */
float noh_key_shadow(vec3 position, vec3 normal)
{
    if (noh_lighting[13].z <= 0.0) {
        return 1.0;
    }
    float facing = clamp(dot(normal, noh_key), 0.0, 1.0), slope = sqrt(1.0 - facing * facing);
    vec4 p = vec4(position + normal * (noh_lighting[13].z * (0.7 + 2.0 * slope)), 1.0);
    vec3 at = (noh_lighting[14] * p.x + noh_lighting[15] * p.y + noh_lighting[16] * p.z + noh_lighting[17]).xyz;
#if NOH_SHADOW_TAPS == 0
    float sum = noh_shadow_soft(at);
#else
    at.z = min(at.z, 1.0) - 0.0003;
#if NOH_SHADOW_TAPS == 1
    float sum = noh_shadow_tap(at, 0.0, 0.0);
#elif NOH_SHADOW_TAPS == 2
    float sum = 0.5 * (noh_shadow_tap(at, -0.9, -0.4) + noh_shadow_tap(at, 0.9, 0.4));
#elif NOH_SHADOW_TAPS == 3
    float sum = noh_shadow_tap(at, 0.4, -1.0) + noh_shadow_tap(at, 0.67, 0.85) + noh_shadow_tap(at, -1.07, 0.15);
    sum /= 3.0;
#else
    float sum = noh_shadow_tent(at);
#endif
#endif
    vec2 edge = noh_lighting[13].w * 2.0 + abs(at.xy - 0.5);
    bool inside = edge.x < 0.5 && edge.y < 0.5; /* outside the map there is no shadow */
    return inside ? sum : 1.0;
}

/* Khronos PBR Neutral Tone Mapper, 2024: colours up to 0.8 less the reflection of a dielectric stay, peaks above are
 * compressed, and lose saturation the brighter they were. */
vec3 noh_neutral(vec3 c)
{
    float least = min(min(c.r, min(c.g, c.b)), 0.08);
    c -= least - 6.25 * least * least;
    float peak = max(max(c.r, max(c.g, c.b)), 0.76); /* at 0.76 nothing is compressed */
    float compressed = 1.0 - 0.0576 / (peak - 0.52);
    float less = compressed / (peak * (0.15 * (peak - compressed) + 1.0));
    return max(c * less + (compressed - peak * less), 0.0);
}

/* A linear colour after exposure and tone map. */
vec3 noh_expose(vec3 c)
{
    c *= noh_lighting[13].x;
    if (noh_lighting[13].y > 1.5) {
        return noh_neutral(c);
    }
    /* K. Narkowicz: ACES filmic tone mapping curve, 2015, of 0.6 c, less its limit */
    vec3 filmic = max(1.0329218 - (0.3974101 * c + 0.1653053) / (c * (c + 0.4046639) + 0.1600366), 0.0);
    return noh_lighting[13].y > 0.5 ? filmic : c;
}
#endif
#endif
