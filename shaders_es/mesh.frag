#version 300 es
/* mesh.frag: a lit surface, or a noh_debug_view. After #version: noh_gl_shader_prefix, as for a game's own shader. */
uniform vec3 noh_bounds_min;     /* of the mesh, for NOH_VIEW_POSITION */
uniform vec3 noh_bounds_size;

in vec3 v_world;
in vec3 v_normal;
in vec2 v_uv;
centroid in vec4 v_color;
/* Unused inputs are not declared, so they are neither interpolated nor computed. */
#if defined(NOH_NORMAL_MAP) || defined(NOH_WRINKLES) || NOH_DEBUG_VIEW == 3
in vec4 v_tangent;
#define TANGENT v_tangent
#else
#define TANGENT vec4(0.0)
#endif
#if NOH_DEBUG_VIEW == 1
in vec3 v_model;
#endif

#ifndef NOH_DEPTH_ONLY
layout(location = 0) out vec4 o_color;
#endif

#if NOH_DEBUG_VIEW == 5
vec3 matte_light(noh_surface s)
{
#ifdef NOH_LIT
    return noh_expose(noh_matte_light(s, noh_key_shadow(s.position, s.geometric)));
#else
    s.f0 = vec3(0.0);
    return noh_light(s);
#endif
}
#endif

#if NOH_DEBUG_VIEW == 4
vec3 level_color()
{
    const vec3 colors[8] = vec3[8](vec3(0.90), vec3(0.79, 0.35, 0.0), vec3(0.09, 0.46, 0.81), vec3(0.0, 0.34, 0.17),
                                   vec3(0.87, 0.78, 0.05), vec3(0.0, 0.17, 0.45), vec3(0.67, 0.11, 0.0), vec3(0.60, 0.19, 0.39));
    vec3 facet = normalize(cross(dFdx(v_world), dFdy(v_world)));
    return colors[int(noh_lod.z)] * (0.35 + 0.65 * max(dot(facet, noh_key), 0.0));
}
#endif

#if NOH_DEBUG_VIEW == 7
/* The model whose weight is the largest: area orange, regions blue, channels green; as strong as its weight. */
vec3 wrinkle_color(vec3 by)
{
    vec3 color = by.x > max(by.y, by.z) ? vec3(0.79, 0.35, 0.0) : by.y >= by.z ? vec3(0.09, 0.46, 0.81) : vec3(0.0, 0.55, 0.20);
    return mix(vec3(0.80), color, max(by.x, max(by.y, by.z)));
}
#endif

#ifdef NOH_DEPTH_ONLY
void main()
{
    noh_cut(noh_base(v_uv, v_color).a);
    noh_fade();
}
#else
void main()
{
#ifdef NOH_EYE
    vec4 base = noh_base(noh_eye_uv(v_world, v_normal, v_uv), v_color);
#else
    vec4 base = noh_base(v_uv, v_color);
#endif
    noh_surface s = noh_surface_of(base, v_world, v_normal, TANGENT, v_uv);
#if NOH_DEBUG_VIEW == 1
    o_color = vec4(pow((v_model - noh_bounds_min) / max(noh_bounds_size, vec3(1e-9)), vec3(2.2)), 1.0);
#elif NOH_DEBUG_VIEW == 2
    o_color = vec4(pow(s.normal * 0.5 + 0.5, vec3(2.2)), 1.0);
#elif NOH_DEBUG_VIEW == 3
    vec3 t = dot(v_tangent.xyz, v_tangent.xyz) > 0.0 ? normalize(v_tangent.xyz) : vec3(-1.0);
    o_color = vec4(pow(t * 0.5 + 0.5, vec3(2.2)), 1.0);
#elif NOH_DEBUG_VIEW == 7
    o_color = vec4(wrinkle_color(s.wrinkles) * (0.35 + 0.65 * max(dot(s.normal, noh_key), 0.0)), 1.0);
#elif NOH_DEBUG_VIEW == 4
    o_color = vec4(level_color(), 1.0);
#elif NOH_DEBUG_VIEW == 5
    noh_cut(base.a);
    s.albedo = vec3(1.0);
#ifdef NOH_TOON
    s.shade = vec3(0.0);
#endif
    s.metallic = 0.0;
    o_color = vec4(matte_light(s), 1.0);
#elif NOH_DEBUG_VIEW == 6
    noh_cut(base.a);
#ifdef NOH_LIT
    o_color = vec4(vec3(noh_rest_occlusion(s)), 1.0);
#else
    o_color = vec4(vec3(s.occlusion), 1.0);
#endif
#else
    float alpha = noh_cut(base.a);
    o_color = vec4(noh_material.w > 0.5 ? base.rgb : noh_light(s), alpha);
#endif
    o_color.rgb = noh_encode(o_color.rgb);
    noh_fade(); /* last: the mip level of a texture depends on the neighbouring pixels */
}
#endif
