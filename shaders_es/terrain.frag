#version 300 es
/* terrain.frag: light on a height field, in one colour where it is flat and one where it is steep. After #version: the
 * defines, common_fade.glsl, common_fragment.glsl and common_environment.glsl. */
uniform vec4 u_flat, u_steep; /* linear colours */
uniform vec4 u_light;         /* without NOH_LIT: unit, towards the light */

in vec3 v_position;
in vec3 v_normal;

out vec4 o_color;

void main()
{
#ifndef NOH_DEPTH_ONLY
    vec3 n = normalize(v_normal), albedo = mix(u_steep.rgb, u_flat.rgb, smoothstep(0.75, 0.93, n.y));
#ifdef NOH_LIT
    vec3 light = noh_ambient(n) + noh_key_color * (max(dot(n, noh_key), 0.0) * noh_key_shadow(v_position, n));
    vec3 color = noh_expose(albedo * light);
#else
    vec3 even = 0.62 * mix(vec3(0.23, 0.20, 0.18), vec3(0.50, 0.54, 0.60), n.y * 0.5 + 0.5);
    vec3 color = albedo * (even + vec3(1.02, 0.98, 0.92) * max(dot(n, u_light.xyz), 0.0));
#endif
    o_color = vec4(noh_encode(color), 1.0);
#else
    o_color = vec4(1.0);
#endif
}
