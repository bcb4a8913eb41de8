/* common_wrinkle.glsl: noh_map_vector, the vector of a normal map; with NOH_WRINKLES noh_wrinkle_by_model, the wrinkle
 * strength of a pixel, and normals blended by it. It precedes common_material.glsl.
 *
 * Three models; the largest strength counts. A material selects them by bits of noh_wrinkle_models:
 *   1  area: how much the surface has shrunk in the pose, by derivatives
 *   2  regions: twelve, in three weight maps, each weighted by the face's expression
 *   4  channels: red of the first weight map always, green and blue by the weights of regions 3 and 6
 * The weight maps are read at vertices (common_vertex.glsl): three textures fewer at each pixel. With NOH_WRINKLE_PIXEL
 * each pixel reads a mask of codes instead, one texture, texel by texel. */
#if (defined(NOH_NORMAL_MAP) || defined(NOH_WRINKLES)) && !defined(NOH_DEPTH_ONLY)
/* The vector of a normal map's texel, not unit, its slopes scaled. Bytes cannot represent 0 exactly; 128 stands for it.
 * A map of two channels has no blue: z follows from x and y. */
vec3 noh_map_vector(vec3 texel, float scale)
{
    vec3 v = (texel * 255.0 - 128.0) / 127.0;
    if (texel.b == 0.0) v.z = sqrt(max(1.0 - dot(v.xy, v.xy), 0.0));
    return vec3(v.xy * scale, max(v.z, 1e-3));
}
#endif

#if defined(NOH_WRINKLES) && !defined(NOH_DEPTH_ONLY)
uniform highp ivec2 noh_wrinkle_models; /* enabled models; 255 times their strength */
uniform mediump sampler2D noh_wrinkle_texture;

in vec3 noh_v_rest;     /* relative to the middle of the mesh, before targets and joints */
in vec3 noh_v_moved;    /* displacement by targets */
#ifndef NOH_WRINKLE_PIXEL
in vec2 noh_v_wrinkles; /* 0..1 by regions and by channels */
#else
uniform highp sampler2D noh_wrinkle_weights_0; /* codes */
#ifdef NOH_CROWD
flat in highp ivec4 noh_v_regions;
#else
uniform vec4 noh_wrinkle_regions[3]; /* component c of the k-th: region 3 * c + k */
#endif

/* The weights of the k-th regions of the channels. */
vec4 noh_regions_of(int k)
{
#ifdef NOH_CROWD
    return vec4(noh_v_regions >> 8 * k & 255) / 255.0;
#else
    return noh_wrinkle_regions[k];
#endif
}

/* The strength by regions and by channels. In a channel's code, code / 90 is k of its region and the remainder its
 * strength; a remainder above 75 means none ("character wrinkle", computeWeight, with the remainder that its listing
 * omits). */
vec2 noh_wrinkles_at(vec2 uv)
{
    ivec4 code = ivec4(textureLod(noh_wrinkle_weights_0, uv, 0.0) * 255.0 + 0.5), k = code / 90, rest = code - 90 * k;
    vec4 weight = min(vec4(rest) * 0.014, 1.0) * vec4(lessThanEqual(rest, ivec4(75)));
    vec4 first = noh_regions_of(0), region = mix(first, noh_regions_of(1), vec4(equal(k, ivec4(1))));
    vec4 all = weight * mix(region, noh_regions_of(2), vec4(equal(k, ivec4(2))));
    vec2 by = vec2(max(max(all.x, all.y), max(all.z, all.w)), 0.0);
    weight *= vec4(equal(k, ivec4(0)));
    by.y = min(dot(weight.rgb, vec3(1.0, first.yz)), 1.0);
    return by * vec2(notEqual(noh_wrinkle_models.xx & ivec2(2, 4), ivec2(0)));
}
#endif

/* Area in the pose / area at rest, in bind space, independent of the camera and the joints. Both areas are spanned by
 * the same two pixels, so their ratio is exact for a triangle. */
float noh_area_ratio()
{
    vec3 x = dFdx(noh_v_rest), y = dFdy(noh_v_rest);
    float rest = length(cross(x, y));
    float now = length(cross(x + dFdx(noh_v_moved), y + dFdy(noh_v_moved)));
    return rest > 1e-18 ? now / rest : 1.0;
}

/* The response of the SparseMorphTargets sample: 0.3 at rest, more where the surface shrinks, hardly less where it
 * grows. With regions, which define the creases at rest, the 0.3 is omitted. */
float noh_wrinkle_by_area(float ratio)
{
    float shrunk = 1.0 - ratio;
    return clamp(((noh_wrinkle_models.x & 6) == 0 ? 0.3 : 0.0) + (shrunk < 0.0 ? 0.005 * shrunk : shrunk), 0.0, 1.0);
}

/* One value per model: area, regions, channels. uv: for masks read per pixel */
vec3 noh_wrinkle_by_model(vec2 uv)
{
#ifdef NOH_WRINKLE_PIXEL
    vec3 by = vec3(0.0, noh_wrinkles_at(uv));
#else
    vec3 by = vec3(0.0, noh_v_wrinkles);
#endif
    if ((noh_wrinkle_models.x & 1) != 0) {
        by.x = noh_wrinkle_by_area(noh_area_ratio());
    }
    return by * (float(noh_wrinkle_models.y) / 255.0);
}

#ifndef NOH_WRINKLE_PIXEL
vec3 noh_wrinkle_by_model()
{
    return noh_wrinkle_by_model(vec2(0.0));
}
#endif

/* Reoriented normal mapping (Barre-Brisebois, Hill: "Blending in Detail", 2012): the detail is rotated with the base
 * normal, so that neither flattens the other. base: unit; in tangent space. The result is as long as detail. */
vec3 noh_blend_normals(vec3 base, vec3 detail)
{
    vec3 t = base + vec3(0.0, 0.0, 1.0), u = detail * vec3(-1.0, -1.0, 1.0);
    return t * (dot(t, u) / t.z) - u;
}

/* A vector of a normal map with its wrinkles, not unit. */
vec3 noh_wrinkled(vec3 base, vec3 texel, vec3 by)
{
    float weight = max(by.x, max(by.y, by.z));
    return noh_blend_normals(normalize(base), noh_map_vector(texel, weight));
}
#endif
