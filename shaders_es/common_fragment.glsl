/* common_fragment.glsl: what a fragment shader is given: the light, the camera, the material, and which of its pixels
 * are drawn. It goes behind common_fade.glsl: noh_gl_shader_prefix puts them together. Defines, which
 * noh_gl_variant_defines writes:
 *
 *   NOH_DEPTH_ONLY    defined: depth alone is drawn; o_color is not wanted, discards are
 *   NOH_ALPHA_CUT     defined with it where the material cuts by alpha; elsewhere base colours are then white
 *   NOH_FADE          defined: draw only some of the pixels (noh_gl_lod)
 *   NOH_ENCODE_SRGB   defined: the target does not encode to sRGB
 *   NOH_DEBUG_VIEW    a noh_debug_view */
uniform vec3 noh_camera;                             /* world */
uniform vec3 noh_key;                                /* unit, towards the light, world */
uniform vec3 noh_lod;                                /* pixels from and to, level */
uniform vec4 noh_base_color;
uniform vec4 noh_material;                           /* roughness, metallic, alpha cutoff or -1, 1: unlit, -1: strands;
                                                      * and 0.25 more where the texture's colours are premultiplied */
uniform mediump sampler2D noh_base_color_texture;

/* Alpha of strands is painted to be blended in sRGB, as most programs do. Blended in linear light, dark strands on
 * light skin come out thin and pale. So much alpha leaves as much of them as they have there, over what is 0.75 in
 * sRGB; light strands keep theirs. */
float noh_strand_alpha(vec4 color)
{
    float dark = max(0.75 - sqrt(dot(color.rgb, vec3(0.2126, 0.7152, 0.0722))), 0.0);
    return 1.0 - pow(1.0 - min(color.a, 1.0), 1.0 + 2.06 * dark * dark);
}

/* The material's colour times the vertex's, linear, with alpha. */
vec4 noh_base(vec2 uv, vec4 color)
{
#if !defined(NOH_DEPTH_ONLY) || defined(NOH_ALPHA_CUT)
    vec4 texel = texture(noh_base_color_texture, uv);
    if (fract(noh_material.w) > 0.125) texel.rgb /= max(texel.a, 0.002); /* transparent texels are black: what is
                                                                          * filtered is so much darker at an edge */
    vec4 base = noh_base_color * color * texel;
#ifndef NOH_ENCODE_SRGB
    if (noh_material.w < -0.5) base.a = noh_strand_alpha(base);
#endif
    return base;
#else
    return color;
#endif
}

/* Discard what an alpha-cut material leaves out. */
void noh_cut(float alpha)
{
#if !defined(NOH_DEPTH_ONLY) || defined(NOH_ALPHA_CUT)
    if (alpha < noh_material.z) {
        discard;
    }
#endif
}

/* Discard the pixels that another LOD level draws. Textures with mip levels are better read before: the level depends
 * on the neighbouring pixels. */
void noh_fade()
{
#ifdef NOH_FADE
    float noise = noh_fade_noise(gl_FragCoord.xy);
    if (noise < noh_lod.x || noise >= noh_lod.y) {
        discard;
    }
#endif
}

/* A linear colour as the target wants it. sRGB's power is our fit of two roots, off by a tenth of a byte at most and by
 * nothing at white: where no GPU draws, powers took a sixteenth of a frame. */
vec3 noh_encode(vec3 c)
{
#ifdef NOH_ENCODE_SRGB
    vec3 root = sqrt(c), curve = 0.827702 * root + 0.302118 * sqrt(root) - 0.052254 * c - 0.077566;
    return mix(curve, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308))));
#else
    return c;
#endif
}
