/* common_light.glsl: noh_light, the light that a surface sends to the eye: one key light with a wrapped edge and a GGX
 * highlight, a fill from sky and ground, and a soft rim. It goes behind common_material.glsl: noh_gl_shader_prefix puts
 * them together. Nothing of it is there with NOH_DEPTH_ONLY. */
#ifndef NOH_DEPTH_ONLY
/* The isotropic GGX distribution (Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007),
 * times the visibility term of Smith in Schlick's approximation. nh, nl, nv: cosines between the normal, the half
 * vector, the light and the eye. */
float noh_highlight(float nh, float nl, float nv, float roughness)
{
    float a = roughness * roughness, a2 = a * a;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float k = a * 0.5;
    float visibility = 0.25 / ((nl * (1.0 - k) + k) * (nv * (1.0 - k) + k));
    return a2 / (3.14159265 * d * d) * visibility;
}

vec3 noh_light(noh_surface s)
{
    float roughness = max(s.roughness, 0.08);
    vec3 f0 = mix(s.f0, s.albedo, s.metallic);
    vec3 diffuse = s.albedo * (1.0 - s.metallic);
    vec3 h = normalize(noh_key + s.view);
    float nl = dot(s.normal, noh_key), nv = max(dot(s.normal, s.view), 1e-3), nh = max(dot(s.normal, h), 0.0);
    float lit = max(nl, 0.0), wrapped = max((nl + 0.18) / 1.18, 0.0);
    vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(h, s.view), 0.0), 5.0);
    vec3 sky = s.occlusion * mix(vec3(0.23, 0.20, 0.18), vec3(0.50, 0.54, 0.60), s.normal.y * 0.5 + 0.5);
    vec3 color = diffuse * (vec3(1.02, 0.98, 0.92) * wrapped * wrapped + 0.62 * sky);
    color += fresnel * noh_highlight(nh, lit, nv, roughness) * lit * 2.6;
    color += f0 * sky * (0.7 - 0.4 * roughness) * (0.15 + 0.85 * s.metallic);
    color += 0.10 * sky * pow(1.0 - nv, 3.0) * (1.0 - 0.6 * roughness);
    return color + s.emissive;
}
#endif
