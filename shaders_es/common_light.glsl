/* common_light.glsl: noh_light, the light from a surface to the eye. It follows common_environment.glsl in
 * noh_gl_shader_prefix. Empty with NOH_DEPTH_ONLY.
 *
 *   NOH_LIT   defined: by the light of common_environment.glsl. Else one key light with a wrapped edge and a highlight,
 *             a fill from sky and ground, and a soft rim */
#ifndef NOH_DEPTH_ONLY
#ifdef NOH_OUTLINE
vec3 noh_toon(noh_surface s, float lit)
{
    return noh_surface_more[2] * mix(vec3(1.0), s.albedo, noh_surface_more[3].y);
}
#elif defined(NOH_TOON)
/* The colour of a toon in white light: two tones and the edge between them, a rim and a matcap, as in
 * VRMC_materials_mtoon 1.0 of the VRM Consortium. The lamp is lower than the light's key, and in part the viewer's:
 * the edge of a high lamp would cross the face. lit: 0 in shadow */
vec3 noh_toon(noh_surface s, float lit)
{
    vec3 lamp = normalize(noh_key * vec3(1.0, 0.4, 1.0) + 0.3 * s.view);
    float hard = noh_surface_more[0].x, reach = dot(s.normal, lamp) + noh_surface_values.w + 1.0 - hard;
#ifdef NOH_TOON_MASKS
    reach += (255.0 * s.masks.r - 128.0) / 127.0;
#endif
    vec3 tone = mix(s.shade, s.albedo, clamp(reach / max(2.0 - 2.0 * hard, 1e-3), 0.0, 1.0) * lit), color = tone;
    float away = clamp(1.0 - dot(s.normal, s.view) + noh_surface_more[0].z, 1e-4, 1.0);
    color += noh_surface_more[1] * pow(away, noh_surface_more[0].y);
#ifdef NOH_MATCAP
    vec3 right = normalize(vec3(s.view.z, 1e-6, -s.view.x)), up = cross(s.view, right);
    color += texture(noh_wrinkle_weights_1, vec2(0.5) + 0.5 * vec2(dot(right, s.normal), -dot(up, s.normal))).rgb;
#endif
#ifdef NOH_TOON_MASKS
    color = mix(tone, color, s.masks.b);
#endif
    return color;
}
#endif
#if defined(NOH_SKIN) || defined(NOH_TEETH)
/* The share of outside light that a slit, twice as high as the unit of the depth, lets through. */
float noh_open()
{
    return inversesqrt(1.0 + noh_v_depth * noh_v_depth);
}

/* The share of light that leaves a hollow that lets this share in, by channel: light that is reflected on the way out
 * takes the colour of the walls (Jimenez et al.: Practical realtime strategies for accurate indirect occlusion,
 * SIGGRAPH 2016), which are red, so that teeth between them are neither grey nor white. The deepest is dark red. */
vec3 noh_bounced(vec3 albedo, float open)
{
#ifdef NOH_PHONE
    return mix(vec3(0.24, 0.08, 0.07), vec3(1.0), open);
#else
    float white = ((2.0404 * open - 4.7951) * open + 2.7552) * open;
    float black = ((0.6417 - 0.3324 * open) * open + 0.6903) * open;
    vec3 bounced = max(vec3(open), min(albedo, vec3(0.6, 0.15, 0.1)) * white + black);
#ifdef NOH_LIT
    return bounced;
#else
    return max(bounced, vec3(0.24, 0.08, 0.07));
#endif
#endif
}
#endif
/* Schlick's reflectance at an angle, from what it is at normal incidence to what it is at grazing angles. */
vec3 noh_fresnel(vec3 f0, float f90, float cosine)
{
    float away = clamp(1.0 - cosine, 0.0, 1.0), away2 = away * away;
    return f0 + (f90 - f0) * (away2 * away2 * away);
}

#ifndef NOH_HAIR
/* The cosine between a normal and the view. The slopes of a normal map that graze the view cover hardly any part of a
 * pixel on a surface that faces it: creases are no white lines. */
float noh_seen(noh_surface s, float cosine)
{
#ifdef NOH_NORMAL_MAP
    return max(cosine, 0.5 * abs(dot(s.geometric, s.view)));
#else
    return cosine;
#endif
}
#endif

#ifdef NOH_HAIR
/* Hair: matte light around the strand, and two highlights, one of the cuticle, white and nearer to the root, one that
 * has been through the strand, wider, of its colour and nearer to the tip (Kajiya, Kay 1989; the shifts as Scheuermann,
 * Practical real-time hair rendering and shading, 2004). Strands of every direction make up a card, so its edges are no
 * mirrors. even: ambient light on a matte surface; key: colour of the key light that arrives */
vec3 noh_hair_light(noh_surface s, vec3 even, vec3 key)
{
    float tl = dot(s.strand, noh_key), nl = dot(s.normal, noh_key), along = 1.0 - abs(dot(s.strand, s.view));
    float narrow = clamp(22.0 / max(s.roughness * s.roughness, 0.01), 22.0, 300.0); /* 90 at a roughness of 0.5 */
    vec3 h = normalize(noh_key + s.view), tint = 2.5 * s.albedo + 0.02;
    float first = noh_strand_lobe(normalize(s.strand - 0.08 * s.normal), h, narrow);
    float second = noh_strand_lobe(normalize(s.strand + 0.12 * s.normal), h, 0.25 * narrow);
    vec3 color = s.albedo * (even + key * (clamp(0.25 + 0.75 * nl, 0.0, 1.0) * sqrt(max(1.0 - tl * tl, 0.0))));
    color += s.f0 * (25.0 * smoothstep(-0.2, 0.4, nl)) * key * (0.06 * first + tint * second);
    return color + s.f0 * even * (0.3 + 0.7 * along * along) * 1.25 + s.emissive;
}
#endif

#ifdef NOH_LIT
/* The isotropic GGX distribution times Smith's visibility, correlated in height (Heitz: Understanding the
 * masking-shadowing function in microfacet-based BRDFs, JCGT 3, 2014), divided by 4 nl nv, times pi. In the phone tier,
 * and for skin, the visibility is the fit of Hammon (PBR diffuse lighting for GGX+Smith microsurfaces, GDC 2017). */
float noh_gloss(float nh, float nl, float nv, float roughness)
{
    float a = roughness * roughness, a2 = a * a, nh2 = nh * nh, d = nh2 * a2 + (1.0 - nh2);
#if defined(NOH_PHONE) || defined(NOH_SKIN)
    float v = mix(2.0 * nl * nv, nl + nv, a);
#else
    float v = nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2);
#endif
    return 0.5 * a2 / (d * d * max(v, 1e-5));
}

/* The share of uniform ambient light that a GGX surface reflects. x: at a reflectance of 1 at normal incidence; y: what
 * is added at 0. Polynomials fitted to our own integral, for roughness from 0.08: errors at most 0.03, 0.011 on average
 * (tested by test_gl_light). In the phone tier at most 0.1, 0.02 on average. For skin, which
 * reflects 0.03 of x, at most 0.07 in x and 0.05 in y, 0.04 and 0.01 on average. */
vec2 noh_albedo_of(float roughness, float nv)
{
#ifdef NOH_PHONE
    float r = roughness, away = 1.0 - nv, away2 = away * away, grazing = away2 * away2;
    vec2 all_edge = vec2(grazing * r * (1.4894 * r - 0.7315) + r * (0.1437 - 0.8209 * r) + 1.0066,
                         grazing * (r * (1.2122 * r - 2.2171) + 1.0498));
    return clamp(all_edge, 0.0, 1.0);
#elif defined(NOH_SKIN)
    float r = roughness, y = 1.0 - nv, y2 = y * y;
    vec2 all_edge = vec2(r * r * r * (0.5985 * y2 - 0.6819) + 0.945, y2 * y2 * ((1.2504 * r - 2.3135) * r + 1.0701));
    return clamp(all_edge, 0.0, 1.0);
#else
    vec4 r = vec4(1.0, roughness, roughness * roughness, roughness * roughness * roughness);
    float y = 1.0 - nv, y2 = y * y, y5 = y2 * y2 * y, y10 = y5 * y5;
    vec4 p = vec4(1.0, y, y5, y10 * y10);
    vec4 all = vec4(dot(vec4(0.9284, 0.8216, -2.0490, 0.5797), r), dot(vec4(0.1452, -0.9647, 0.6314, 0.5740), r), dot(vec4(0.0256, -1.7157, 5.7461, -3.9288), r), dot(vec4(-0.2394, 2.2160, -4.1401, 2.3712), r));
    vec4 edge = vec4(dot(vec4(0.0413, -0.4453, 0.9476, -0.5651), r), dot(vec4(-0.1707, 1.9821, -3.9622, 2.1975), r), dot(vec4(1.4333, -4.4640, 4.4523, -1.3693), r), dot(vec4(-0.1007, -1.3338, 4.0245, -2.6212), r));
    return clamp(vec2(dot(all, p), dot(edge, p)), 0.0, 1.0);
#endif
}

/* The share of mirrored light that occlusion lets through: the rougher the surface, the less, compared with matte
 * light. S. Lagarde, C. de Rousiers: Moving Frostbite to physically based rendering, SIGGRAPH 2014, listing 26. */
float noh_gloss_occlusion(float nv, float occlusion, float roughness)
{
    if (occlusion >= 1.0) {
        return 1.0; /* as below, without the powers */
    }
    return clamp(pow(nv + occlusion, exp2(-16.0 * roughness * roughness - 1.0)) - 1.0 + occlusion, 0.0, 1.0);
}

/* The diffuse reflection of the key light, by channel, relative to white. shadow: from noh_key_shadow, computed once
 * for matte light and gloss */
vec3 noh_key_matte(noh_surface s, float shadow)
{
#ifdef NOH_SKIN
    float facing = dot(s.geometric, noh_key);
    float part = 1.0 + smoothstep(-0.1, 0.1, facing) * (shadow - 1.0);
#ifdef NOH_PHONE
    float root = sqrt(part);
    vec3 through = vec3(0.2 * part + 0.8 * root, part, part * (0.8 + 0.2 * part));
#else
    float red = pow(part, 0.6);
    vec3 through = vec3(red, part, red * red);
#endif
    return noh_scatter(noh_scatter_cosines(s, noh_key), noh_curvature(s.position, s.geometric)) * through;
#else
    return vec3(max(dot(s.normal, noh_key), 0.0) * shadow);
#endif
}

#ifdef NOH_PHONE
in vec3 noh_v_ambient; /* common_vertex.glsl */
#endif

/* The ambient light of a matte surface. In the phone tier it is filtered from the vertices; a normal map bends it by its
 * linear terms. */
vec3 noh_rest_ambient(noh_surface s)
{
#if !defined(NOH_PHONE)
    return noh_ambient(s.normal);
#elif defined(NOH_NORMAL_MAP) || defined(NOH_WRINKLES)
    vec3 by = s.normal - s.geometric;
    vec3 bent = noh_lighting[1].rgb * by.y + noh_lighting[2].rgb * by.z + noh_lighting[3].rgb * by.x;
    return max(noh_v_ambient + bent, vec3(0.0));
#else
    return noh_v_ambient;
#endif
}

#if NOH_TRANSFER > 0
in vec4 noh_v_transfer; /* common_transfer.glsl */

/* The ambient light that reaches a matte surface. Maps scale the vertices' light by the change that they make without a
 * transfer, and darken it where they are darker than the mesh. */
vec3 noh_rest_light(noh_surface s)
{
    if (!gl_FrontFacing) {
        return noh_rest_ambient(s) * s.occlusion; /* the transfer is for the other side */
    }
#ifdef NOH_PHONE
    vec3 bent = min(noh_rest_ambient(s) / max(noh_v_ambient, vec3(1e-3)), vec3(4.0));
#else
    vec3 bent = min(noh_ambient(s.normal) / max(noh_ambient(s.geometric), vec3(1e-3)), vec3(4.0));
#endif
    return max(noh_v_transfer.rgb, vec3(0.0)) * bent * min(1.0, s.occlusion / max(noh_v_transfer.a, 1e-3));
}

/* The occlusion of mirrored light. */
float noh_rest_occlusion(noh_surface s)
{
    return gl_FrontFacing ? min(s.occlusion, clamp(noh_v_transfer.a, 0.0, 1.0)) : s.occlusion;
}
#else
vec3 noh_rest_light(noh_surface s)
{
    return noh_rest_ambient(s) * s.occlusion;
}

float noh_rest_occlusion(noh_surface s)
{
    return s.occlusion;
}
#endif

/* The light that reaches a matte surface, relative to white. In a mouth the depth dims the key light, and the transfer,
 * if there is one, dims the rest, but never all of it. */
vec3 noh_matte_light(noh_surface s, float shadow)
{
    vec3 key = noh_key_color * noh_key_matte(s, shadow);
#if NOH_TRANSFER > 0 && (defined(NOH_SKIN) || defined(NOH_TEETH))
    float open = clamp(noh_v_transfer.a, 0.0, 1.0), least = max(open, 0.06);
    vec3 unoccluded = noh_rest_light(s) / least + noh_lighting[0].rgb * (0.35 * (1.0 - smoothstep(0.0, 0.25, open)));
    return unoccluded * noh_bounced(s.albedo, least) + key * noh_bounced(s.albedo, noh_open());
#else
    return noh_rest_light(s) + key;
#endif
}
#else
/* The isotropic GGX distribution (Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007),
 * times the visibility term of Smith in Schlick's approximation, times pi. nh, nl, nv: cosines between the normal, the
 * half vector, the light and the eye. */
float noh_gloss(float nh, float nl, float nv, float roughness)
{
    float a = roughness * roughness, a2 = a * a;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float k = a * 0.5;
    return 0.25 * a2 / (d * d * (nl * (1.0 - k) + k) * (nv * (1.0 - k) + k));
}

/* Light from sky and ground. */
vec3 noh_sky(float up)
{
    return vec3(0.365, 0.37, 0.39) + up * vec3(0.135, 0.17, 0.21);
}

/* The diffuse reflection of the key light, by channel. A plain ball reflects 1.18 / 3 of a lamp in total, where cosines
 * sum to a half: skin is scaled to the same total. */
vec3 noh_key_matte(noh_surface s)
{
#ifdef NOH_SKIN
    return (2.36 / 3.0) * noh_scatter(noh_scatter_cosines(s, noh_key), noh_curvature(s.position, s.geometric));
#else
    float wrapped = max((dot(s.normal, noh_key) + 0.18) / 1.18, 0.0);
    return vec3(wrapped * wrapped);
#endif
}
#endif

/* The highlight of the key light, divided by its colour, without reflectance, times pi. nh, nl, nv: cosines between the
 * normal for reflections, and the half vector, the light and the eye */
float noh_key_glossed(float nh, float nl, float nv, float roughness)
{
#ifdef NOH_SKIN
    vec2 lobes = noh_lobes_at(roughness);
    return nl * mix(noh_gloss(nh, nl, nv, lobes.y), noh_gloss(nh, nl, nv, lobes.x), noh_narrow_lobe);
#elif defined(NOH_EYE)
    return nl > 0.0 ? 3.14159265 * noh_lamp(nh) : 0.0;
#else
    return nl * noh_gloss(nh, nl, nv, roughness);
#endif
}

#ifdef NOH_LIT
#ifdef NOH_TOON
/* noh_lighting[3..5].w: the mean light and the key.
 * Colours are the artist's: the light, the same for the whole figure, tints them by half of its hue, and darkens them
 * where there is less than white; more does not bleach them, and no tone map changes them. */
vec3 noh_light(noh_surface s)
{
    vec3 light = noh_lighting[13].x * vec3(noh_lighting[3].w, noh_lighting[4].w, noh_lighting[5].w);
    float most = max(light.r, max(light.g, light.b));
#ifdef NOH_OUTLINE
    vec3 color = noh_toon(s, 1.0);
#else
    vec3 color = noh_toon(s, noh_key_shadow(s.position, s.geometric));
#endif
    return color * mix(vec3(most), light, 0.5) / max(most, 1.0) + s.emissive;
}
#elif defined(NOH_HAIR)
vec3 noh_light(noh_surface s)
{
    float shadow = noh_key_shadow(s.position, s.geometric);
    return noh_expose(noh_hair_light(s, noh_rest_light(s), noh_key_color * shadow));
}
#else
vec3 noh_light(noh_surface s)
{
    vec3 mirror = s.normal; /* normal for reflections; s.normal is for matte light */
#ifdef NOH_SKIN
    s.roughness = noh_pore_roughness(s.roughness, s.normal);
#endif
#ifdef NOH_EYE
    mirror = noh_eye_light(s);
#endif
    float roughness = clamp(s.roughness, 0.08, 1.0);
    float across = dot(mirror, s.view);
    float nv = clamp(noh_seen(s, abs(across)), 1e-3, 1.0); /* outlines of thin parts, past grazing, are no mirrors */
    vec3 f0 = mix(s.f0, s.albedo, s.metallic);
    float f90 = mix(s.f90, 1.0, s.metallic);
    vec2 part = noh_albedo_of(roughness, nv);
    vec3 gloss = f0 * (part.x - part.y) + f90 * part.y; /* uniform light, reflected once */
#if defined(NOH_PHONE) || defined(NOH_SKIN)
    float again = 1.0; /* for skin at most 1.02 */
#else
    vec3 again = 1.0 + f0 * (1.0 / max(part.x, 0.1) - 1.0); /* and after further bounces between the facets */
#endif
    float shadow = noh_key_shadow(s.position, s.geometric); /* here, because later it spills a register of a Mali G52 */
    vec3 matte = s.albedo * (1.0 - s.metallic) * (1.0 - min(gloss * again, 1.0));
    vec3 mirrored = noh_mirror(2.0 * across * mirror - s.view, roughness);
    mirrored *= noh_gloss_occlusion(nv, noh_rest_occlusion(s), roughness);
    vec3 color = matte * noh_matte_light(s, shadow);
#if defined(NOH_SKIN) || defined(NOH_TEETH)
    float open = noh_open();
    mirrored *= open * open * open * open; /* lips cover what grazing light would reach */
    shadow *= open;
#if NOH_TRANSFER == 0
    color *= noh_bounced(s.albedo, open);
#endif
#ifndef NOH_PHONE
    color += noh_lighting[0].rgb * ((1.0 - open) * vec3(0.045, 0.022, 0.019)); /* by the walls, whatever is painted dark */
#endif
#endif
    color += gloss * again * mirrored;
    if (noh_key_gloss > 0.0) {
        /* The half vector h is noh_key + s.view, divided by its length: its cosines need no vector. */
        float lv = 1.0 + dot(noh_key, s.view), shorter = inversesqrt(max(2.0 * lv, 1e-6)), nl = dot(mirror, noh_key);
        float nh = clamp((nl + across) * shorter, 0.0, 1.0);
        vec3 fresnel = noh_fresnel(f0, f90, lv * shorter);
        float glossed = noh_key_gloss * shadow * noh_key_glossed(nh, max(nl, 0.0), nv, roughness);
        color += fresnel * again * noh_key_color * glossed;
    }
    return noh_expose(color + s.emissive);
}
#endif
#else
#ifdef NOH_TOON
vec3 noh_light(noh_surface s)
{
    return noh_toon(s, 1.0) + s.emissive;
}
#elif defined(NOH_HAIR)
vec3 noh_light(noh_surface s)
{
    return noh_hair_light(s, 0.62 * s.occlusion * noh_sky(s.normal.y), vec3(1.02, 0.98, 0.92));
}
#else
vec3 noh_light(noh_surface s)
{
    vec3 mirror = s.normal; /* normal for reflections; s.normal is for matte light */
#ifdef NOH_SKIN
    s.roughness = noh_pore_roughness(s.roughness, s.normal);
#endif
#ifdef NOH_EYE
    mirror = noh_eye_light(s);
#endif
    float roughness = max(s.roughness, 0.08);
    vec3 f0 = mix(s.f0, s.albedo, s.metallic);
    float f90 = mix(s.f90, 1.0, s.metallic);
    vec3 diffuse = s.albedo * (1.0 - s.metallic);
    vec3 lamp = noh_key;
    float square = 1.0;
#ifdef NOH_EYE
    lamp -= 0.35 * normalize(noh_v_up.xyz); /* low enough to be visible below the lid */
    square = dot(lamp, lamp);
#endif
    float across = dot(mirror, s.view), nv = max(noh_seen(s, across), 1e-3), lv = dot(lamp, s.view);
#ifdef NOH_EYE
    lv = max(lv, -1.0); /* the lamp's vector may be longer than 1: reflectance would exceed 1 */
#endif
    float shorter = inversesqrt(square + 1.000001 + 2.0 * lv); /* the half vector needs no vector, as above */
    float nh = max(dot(mirror, lamp) + across, 0.0) * shorter;
#ifdef NOH_PHONE
    vec3 fresnel = f0;
#else
    /* noh_fresnel as two products: here they take less, in lit light they cost registers */
    float away = 1.0 - (lv + 1.0) * shorter, away2 = away * away, part = away2 * away2 * away;
    vec3 fresnel = f0 * (1.0 - part) + f90 * part;
#endif
    vec3 even = 0.62 * diffuse + f0 * ((0.7 - 0.4 * roughness) * (0.15 + 0.85 * s.metallic));
#ifndef NOH_PHONE
    float rim = 1.0 - nv;
    even += rim * rim * rim * (0.1 - 0.06 * roughness);
#endif
    vec3 color = diffuse * (noh_key_matte(s) * vec3(1.02, 0.98, 0.92)) + even * (s.occlusion * noh_sky(s.normal.y));
    color += fresnel * (0.8276 * noh_key_glossed(nh, max(dot(mirror, noh_key), 0.0), nv, roughness));
#if defined(NOH_SKIN) || defined(NOH_TEETH)
    color *= noh_bounced(s.albedo, noh_open());
#endif
    return color + s.emissive;
}
#endif
#endif
#endif
