/* common_material.glsl: noh_surface_of, a pixel's material from its maps. It follows common_fragment.glsl in
 * noh_gl_shader_prefix. Empty with NOH_DEPTH_ONLY. Defines, written by noh_gl_variant_defines:
 *
 *   NOH_NORMAL_MAP    defined: the material has a normal map, and the mesh tangents
 *   NOH_SURFACE_MAP   defined: it has a map of occlusion, roughness, metallic
 *   NOH_EMISSIVE      defined: it emits light
 *   NOH_SPECULAR_MAP  defined: it has a map of the reflectance at normal incidence, with its weight in alpha, or with
 *                     NOH_SPECULAR_ROUGHNESS its roughness
 *   NOH_TOON          defined: it is a toon
 *   NOH_TOON_SHADE    defined: and its shade has a texture
 *   NOH_MATCAP        defined: and it has a matcap
 *   NOH_TOON_MASKS    defined: and it has masks of its edge and its rim
 *   NOH_HAIR          defined: it is hair
 *   NOH_WRINKLES      defined: it has a wrinkle map and weights of regions
 *   NOH_WRINKLE_PIXEL defined: the weights are in a mask that pixels read
 *   NOH_COLORS        defined: targets colour four regions of a map
 *   NOH_COMPLEXION    defined: instances have complexions (common_complexion.glsl) */
#ifndef NOH_DEPTH_ONLY
uniform vec3 noh_f0;       /* reflectance of non-metals at normal incidence; limited to noh_f90 */
uniform float noh_f90;     /* and at grazing angles */
#if defined(NOH_NORMAL_MAP) || defined(NOH_SURFACE_MAP)
uniform vec4 noh_maps;     /* normal scale, occlusion strength */
#endif
#ifdef NOH_NORMAL_MAP
uniform mediump sampler2D noh_normal_texture;
#endif
#ifdef NOH_SURFACE_MAP
uniform mediump sampler2D noh_surface_texture; /* r occlusion, g roughness, b metallic, a weight of f0 and f90 */
#endif
#ifdef NOH_SPECULAR_MAP
uniform mediump sampler2D noh_specular_texture;
#endif
#ifdef NOH_EMISSIVE
uniform vec3 noh_emissive;
uniform mediump sampler2D noh_emissive_texture;
#endif

#ifdef NOH_COLORS
uniform mediump sampler2D noh_color_texture; /* how far each of four regions covers the texel */
uniform vec4 noh_colors[4]; /* rgb: colour of a region, linear; a: its weight, in crowds 1 */
#ifdef NOH_CROWD
flat in vec4 noh_v_colors;
#endif

/* The weights of the regions at a pixel. */
vec4 noh_color_weights(vec2 uv)
{
    vec4 weights = texture(noh_color_texture, uv) * vec4(noh_colors[0].a, noh_colors[1].a, noh_colors[2].a, noh_colors[3].a);
#ifdef NOH_CROWD
    weights *= noh_v_colors;
#endif
    return weights;
}

vec3 noh_colored(vec3 albedo, vec4 weights)
{
    for (int i = 0; i < 4; i++) albedo = mix(albedo, noh_colors[i].rgb, weights[i]);
    return albedo;
}
#endif

#ifdef NOH_TOON
uniform vec4 noh_surface_values;  /* noh_material.surface_values */
uniform vec3 noh_surface_more[4]; /* hardness of the edge, power and lift of the rim; colour of the rim, of the outline;
                                   * width of the outline, 1 if the base colour multiplies its colour */
#ifdef NOH_TOON_SHADE
uniform mediump sampler2D noh_wrinkle_weights_0; /* the shade */
#endif
#ifdef NOH_MATCAP
uniform mediump sampler2D noh_wrinkle_weights_1; /* the matcap */
#endif
#ifdef NOH_TOON_MASKS
uniform mediump sampler2D noh_wrinkle_weights_2; /* r: shift of the edge, b: multiplies rim and matcap */
#endif
#endif

#ifdef NOH_HAIR
uniform vec4 noh_surface_values; /* xy: along the strands, in texture coordinates */
#endif

/* A pixel of a surface for lighting; in the world. */
struct noh_surface {
    vec3 position;
    vec3 view;       /* unit, towards the eye */
    vec3 normal;     /* unit, with the maps; on the visible side */
    vec3 geometric;  /* unit, of the mesh alone; on the visible side */
    vec3 albedo;     /* linear */
    float alpha;
    float metallic;  /* 0..1 */
    float roughness; /* 0..1, perceptual: its square is GGX's alpha */
    vec3 f0;         /* of non-metals */
    float occlusion; /* 1: open */
    vec3 emissive;   /* linear */
    vec3 wrinkles;   /* 0..1 by area, regions, channels; the largest counts */
    float f90;       /* of non-metals, at grazing angles */
#ifdef NOH_TOON
    vec3 shade;      /* linear colour where no light arrives */
#endif
#ifdef NOH_TOON_MASKS
    vec3 masks;      /* r: shift of the edge, b: share of rim and matcap */
#endif
#ifdef NOH_HAIR
    vec3 strand;     /* unit, along the hair, perpendicular to the normal */
#endif
};

#if defined(NOH_NORMAL_MAP) || defined(NOH_WRINKLES)
/* From tangent space to the world, unit whatever the length of v. The frame is made orthogonal at each pixel, because
 * targets, joints and filtering do not keep the tangent perpendicular to the normal. */
vec3 noh_map_normal(vec3 v, vec3 normal, vec4 tangent)
{
    vec3 t = tangent.xyz - normal * dot(normal, tangent.xyz);
    float length2 = dot(t, t);
    t *= inversesqrt(max(length2, 1e-20));
    return length2 > 1e-20 ? normalize(t * v.x + cross(normal, t) * (tangent.w * v.y) + normal * v.z) : normal;
}
#endif

#ifdef NOH_HAIR
/* The direction of the strands on the surface, from the change of position and texture coordinates between pixels. */
vec3 noh_strand(vec3 position, vec3 normal, vec2 uv)
{
    vec2 ux = dFdx(uv), uy = dFdy(uv), along = noh_surface_values.xy;
    vec3 t = dFdx(position) * (along.x * uy.y - along.y * uy.x) + dFdy(position) * (ux.x * along.y - ux.y * along.x);
    t *= ux.x * uy.y < ux.y * uy.x ? -1.0 : 1.0;
    t -= normal * dot(normal, t);
    float length2 = dot(t, t);
    return length2 > 1e-30 ? t * inversesqrt(length2) : normalize(cross(normal, vec3(normal.y, -normal.x, 0.01)));
}
#endif

#ifdef NOH_COMPLEXION
vec3 noh_complexioned(vec3 albedo, vec3 normal); /* common_complexion.glsl */
#endif

/* base: from noh_base; normal, tangent: of noh_vertex, filtered */
noh_surface noh_surface_of(vec4 base, vec3 position, vec3 normal, vec4 tangent, vec2 uv)
{
    noh_surface s;
    float side = gl_FrontFacing ? 1.0 : -1.0;
    s.position = position;
    s.view = normalize(noh_camera - position);
    s.albedo = base.rgb;
#ifdef NOH_COMPLEXION
    s.albedo = noh_complexioned(s.albedo, normalize(normal));
#endif
#ifdef NOH_COLORS
    vec4 colored = noh_color_weights(uv);
    s.albedo = noh_colored(s.albedo, colored);
#endif
    s.alpha = base.a;
    s.roughness = noh_material.x;
#ifdef NOH_SKIN
    s.metallic = 0.0; /* whatever the material says: skin is no metal */
#else
    s.metallic = noh_material.y;
#endif
#ifdef NOH_SKIN
    s.f0 = vec3(noh_f0.g); /* white */
#else
    s.f0 = noh_f0;
#endif
    s.f90 = noh_f90;
    s.occlusion = 1.0;
    s.emissive = vec3(0.0);
    s.wrinkles = vec3(0.0);
    s.geometric = normal * (side * inversesqrt(dot(normal, normal))); /* to the visible side, and unit */
    s.normal = s.geometric;
#if defined(NOH_NORMAL_MAP) || defined(NOH_WRINKLES)
    vec3 mapped = vec3(0.0, 0.0, 1.0);
#ifdef NOH_NORMAL_MAP
    mapped = noh_map_vector(texture(noh_normal_texture, uv).rgb, noh_maps.x);
#endif
#ifdef NOH_WRINKLES
    s.wrinkles = noh_wrinkle_by_model(uv);
    mapped = noh_wrinkled(mapped, texture(noh_wrinkle_texture, uv).rgb, s.wrinkles);
#endif
    mapped.x *= side;
    s.normal = noh_map_normal(mapped, s.geometric, tangent);
#endif
#ifdef NOH_HAIR
    /* A tuft has no side that is seen at a grazing angle, and a card looks the same from both sides. */
    s.normal *= side;
    s.normal = normalize(s.normal + (1.5 - dot(s.normal, s.view)) * s.view);
    s.strand = noh_strand(position, s.normal, uv);
#endif
#ifdef NOH_SURFACE_MAP
    vec4 map = texture(noh_surface_texture, uv);
    s.occlusion = 1.0 + noh_maps.y * (map.r - 1.0);
    s.roughness *= map.g;
#ifndef NOH_SKIN
    s.metallic *= map.b;
#endif
    s.f0 *= map.a;
    s.f90 *= map.a;
#endif
#ifdef NOH_SPECULAR_MAP
    vec4 specular = texture(noh_specular_texture, uv);
    s.f0 *= specular.rgb;
#ifdef NOH_SPECULAR_ROUGHNESS
    s.roughness *= specular.a;
#else
    s.f0 *= specular.a;
    s.f90 *= specular.a;
#endif
#endif
    s.f0 = min(s.f0, vec3(s.f90)); /* KHR_materials_specular */
#ifdef NOH_TOON_SHADE
    s.shade = noh_pixel_color * texture(noh_wrinkle_weights_0, uv).rgb;
#ifdef NOH_COLORS
    s.shade = noh_colored(s.shade, colored);
#endif
    s.shade *= noh_surface_values.rgb;
#elif defined(NOH_TOON)
    s.shade = noh_surface_values.rgb * s.albedo;
#endif
#ifdef NOH_TOON_MASKS
    s.masks = texture(noh_wrinkle_weights_2, uv).rgb;
#endif
#ifdef NOH_EMISSIVE
    s.emissive = noh_emissive * texture(noh_emissive_texture, uv).rgb;
#endif
    return s;
}
#endif
