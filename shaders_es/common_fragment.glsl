/* common_fragment.glsl: inputs of a fragment shader: the light, the camera, the material, and the drawn pixels. It
 * follows common_fade.glsl in noh_gl_shader_prefix. Defines, written by noh_gl_variant_defines:
 *
 *   NOH_DEPTH_ONLY    defined: only depth is drawn; o_color is unused, discards apply
 *   NOH_ALPHA_CUT     defined if the material cuts or blends by alpha. With NOH_DEPTH_ONLY and without it, base colours
 *                     are white
 *   NOH_FADE          defined: draw only some of the pixels (noh_gl_lod)
 *   NOH_ENCODE_SRGB   defined: the target does not encode to sRGB
 *   NOH_DEBUG_VIEW    a noh_debug_view */
uniform vec3 noh_camera;                             /* world */
uniform vec3 noh_key;                                /* unit, towards the light, world */
uniform vec3 noh_lod;                                /* pixels from and to, level */
uniform vec4 noh_base_color;
uniform vec4 noh_material;                           /* roughness, metallic, alpha cutoff (plus 2 where alpha becomes
                                                      * coverage, plus 6 where edges are dithered) or -1, 1: unlit, -1: strands; plus 0.25 if the
                                                      * texture's colours are premultiplied */
uniform mediump sampler2D noh_base_color_texture;

/* The alpha of strands is painted for blending in sRGB, as in most programs. Blended in linear light, dark strands on
 * light skin look thin and pale. This alpha gives dark strands the result of sRGB blending over a background of 0.75 in
 * sRGB; light strands keep their alpha. */
float noh_strand_alpha(vec4 color)
{
    float dark = max(0.75 - sqrt(dot(color.rgb, vec3(0.2126, 0.7152, 0.0722))), 0.0);
    return 1.0 - pow(1.0 - min(color.a, 1.0), 1.0 + 2.06 * dark * dark);
}

/* The specular reflection of a strand: a highlight around the cone of its tangent. */
float noh_strand_lobe(vec3 tangent, vec3 h, float sharpness)
{
    float c = dot(tangent, h);
    return smoothstep(-1.0, 0.0, c) * pow(max(1.0 - c * c, 0.0), 0.5 * sharpness);
}

/* Eumelanin darkens hair, pheomelanin makes it red; densities of d'Eon et al., "An energy-conserving hair reflectance
 * model", 2011, divided by the density of green. Less melanin is a share of the hair's own density: a power.
 * by  more melanin, or less; red */
const vec3 noh_eumelanin = vec3(0.60, 1.0, 1.97), noh_pheomelanin = vec3(0.47, 1.0, 2.63);

vec3 noh_hair_of(vec3 albedo, vec2 by)
{
    if (by == vec2(0.0)) return albedo;
    vec3 kept = pow(max(albedo, vec3(1e-4)), vec3(exp(min(by.x, 0.0))));
    return min(kept * exp(-max(by.x, 0.0) * noh_eumelanin - by.y * noh_pheomelanin), vec3(1.0));
}

#ifdef NOH_TOON_SHADE
vec3 noh_pixel_color = vec3(1.0); /* the vertex's, for the shade's own texture */
#endif

/* The material's colour times the vertex's, linear, with alpha. */
vec4 noh_base(vec2 uv, vec4 color)
{
#if !defined(NOH_DEPTH_ONLY) || defined(NOH_ALPHA_CUT)
    vec4 texel = texture(noh_base_color_texture, uv);
#ifdef NOH_ALPHA_CUT
    if (fract(noh_material.w) > 0.125) texel.rgb /= max(texel.a, 0.002); /* transparent texels are black, so filtering
                                                                          * darkens edges by as much */
#endif
#ifdef NOH_TOON_SHADE
    noh_pixel_color = color.rgb;
#endif
    vec4 base = noh_base_color * color * texel;
#if defined(NOH_ALPHA_CUT) && !defined(NOH_ENCODE_SRGB)
    if (noh_material.w < -0.5) base.a = noh_strand_alpha(base);
#endif
    return base;
#else
    return color;
#endif
}

/* Discard the pixels that an alpha-cut material does not draw. Returns the alpha to write: 1 where nothing blends; where
 * alpha becomes coverage, the share of the pixel inside the line of the cutoff, from how fast alpha changes there. In a
 * target of one sample the pixels of such an edge are drawn or not by this share. */
float noh_cut(float alpha)
{
    float written = 1.0;
#ifdef NOH_ALPHA_CUT
    float least = noh_material.z;
#ifndef NOH_DEPTH_ONLY
    if (least > 1.5) {
        float dither = clamp(least - 4.0, 0.0, 1.0);
        alpha = clamp((alpha - least + 2.0 + 4.0 * dither) / max(fwidth(alpha), 1e-4) + 0.5, 0.0, 1.0);
        least = max(dither * fract(dot(gl_FragCoord.xy, vec2(0.7548777, 0.5698403))), 1e-3);
        written = max(alpha, dither);
    } else
#endif
    if (least < 0.0) {
        written = alpha;
    }
    if (alpha < least) {
        discard;
    }
#endif
    return written;
}

/* Discard the pixels that another LOD level draws. Read textures with mip levels before: the mip level depends on the
 * neighbouring pixels. */
void noh_fade()
{
#ifdef NOH_FADE
    float noise = noh_fade_noise(gl_FragCoord.xy);
    if (noise < noh_lod.x || noise >= noh_lod.y) {
        discard;
    }
#endif
}

/* A linear colour in the target's encoding. The power of sRGB is approximated by two roots, with an error of at most a
 * tenth of a byte, and exact at white: in software rendering, powers took a sixteenth of a frame. */
vec3 noh_encode(vec3 c)
{
#ifdef NOH_ENCODE_SRGB
    vec3 root = sqrt(c), curve = 0.827702 * root + 0.302118 * sqrt(root) - 0.052254 * c - 0.077566;
    return mix(curve, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308))));
#else
    return c;
#endif
}
