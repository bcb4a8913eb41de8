#version 300 es
/* mesh.frag: enough light to judge a face by: one key light with a wrapped edge and a GGX highlight, a fill from sky
 * and ground, and a soft rim; or what a noh_debug_view shows. Behind #version goes noh_gl_shader_prefix, as before a
 * game's own. */
uniform vec3 noh_bounds_min;     /* of the mesh, for NOH_VIEW_POSITION */
uniform vec3 noh_bounds_size;

in vec3 v_world;
in vec3 v_normal;
in vec4 v_tangent;
in vec2 v_uv;
in vec4 v_color;
in vec3 v_model;

#ifndef NOH_DEPTH_ONLY
layout(location = 0) out vec4 o_color;
#endif

/* The isotropic GGX distribution (Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007),
 * times the visibility term of Smith in Schlick's approximation. nh, nl, nv: cosines between the normal, the half
 * vector, the light and the eye. */
float highlight(float nh, float nl, float nv, float roughness)
{
    float a = roughness * roughness, a2 = a * a;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float k = a * 0.5;
    float visibility = 0.25 / ((nl * (1.0 - k) + k) * (nv * (1.0 - k) + k));
    return a2 / (3.14159265 * d * d) * visibility;
}

vec3 shade(vec3 albedo, vec3 n, vec3 v)
{
    float roughness = max(noh_material.x, 0.08);
    vec3 f0 = mix(vec3(0.04), albedo, noh_material.y);
    vec3 diffuse = albedo * (1.0 - noh_material.y);
    vec3 h = normalize(noh_key + v);
    float nl = dot(n, noh_key), nv = max(dot(n, v), 1e-3), nh = max(dot(n, h), 0.0);
    float lit = max(nl, 0.0), wrapped = max((nl + 0.18) / 1.18, 0.0);
    vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(h, v), 0.0), 5.0);
    vec3 sky = mix(vec3(0.23, 0.20, 0.18), vec3(0.50, 0.54, 0.60), n.y * 0.5 + 0.5);
    vec3 color = diffuse * (vec3(1.02, 0.98, 0.92) * wrapped * wrapped + 0.62 * sky);
    color += fresnel * highlight(nh, lit, nv, roughness) * lit * 2.6;
    color += f0 * sky * (0.7 - 0.4 * roughness) * (0.15 + 0.85 * noh_material.y);
    color += 0.10 * sky * pow(1.0 - nv, 3.0) * (1.0 - 0.6 * roughness);
    return color;
}

#if NOH_DEBUG_VIEW == 4
vec3 level_color()
{
    const vec3 colors[8] = vec3[8](vec3(0.90), vec3(0.79, 0.35, 0.0), vec3(0.09, 0.46, 0.81), vec3(0.0, 0.34, 0.17),
                                   vec3(0.87, 0.78, 0.05), vec3(0.0, 0.17, 0.45), vec3(0.67, 0.11, 0.0), vec3(0.60, 0.19, 0.39));
    vec3 facet = normalize(cross(dFdx(v_world), dFdy(v_world)));
    return colors[int(noh_lod.z)] * (0.35 + 0.65 * max(dot(facet, noh_key), 0.0));
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
    vec4 base = noh_base(v_uv, v_color);
    vec3 n = normalize(v_normal);
    if (!gl_FrontFacing) {
        n = -n;
    }
#if NOH_DEBUG_VIEW == 1
    o_color = vec4(pow((v_model - noh_bounds_min) / max(noh_bounds_size, vec3(1e-9)), vec3(2.2)), 1.0);
#elif NOH_DEBUG_VIEW == 2
    o_color = vec4(pow(n * 0.5 + 0.5, vec3(2.2)), 1.0);
#elif NOH_DEBUG_VIEW == 3
    vec3 t = dot(v_tangent.xyz, v_tangent.xyz) > 0.0 ? normalize(v_tangent.xyz) : vec3(-1.0);
    o_color = vec4(pow(t * 0.5 + 0.5, vec3(2.2)), 1.0);
#elif NOH_DEBUG_VIEW == 4
    o_color = vec4(level_color(), 1.0);
#else
    noh_cut(base.a);
    vec3 color = noh_material.w > 0.5 ? base.rgb : shade(base.rgb, n, normalize(noh_camera - v_world));
    o_color = vec4(color, base.a);
#endif
    o_color.rgb = noh_encode(o_color.rgb);
    noh_fade(); /* last: the mip level of a texture depends on the neighbouring pixels */
}
#endif
