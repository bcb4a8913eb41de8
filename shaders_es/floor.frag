#version 300 es
/* floor.frag: the share of light that a shadow leaves on a level floor, by channel; the picture is multiplied by it.
 * Alpha: the mean share that is taken.
 * After #version: the defines, common_fade.glsl, common_fragment.glsl and common_environment.glsl. */
in vec3 v_position;
in vec2 v_at;

out vec4 o_color;

void main()
{
    vec3 up = vec3(0.0, 1.0, 0.0), key = noh_key_color * max(noh_key.y, 0.0), rest = noh_ambient(up);
    float taken = (1.0 - noh_key_shadow(v_position, up)) * (1.0 - smoothstep(0.5, 1.0, length(v_at)));
    vec3 left = 1.0 - key / max(rest + key, vec3(1e-6)) * taken;
#ifdef NOH_ENCODE_SRGB
    left = pow(left, vec3(1.0 / 2.2)); /* for encoded values */
#endif
    o_color = vec4(left, 1.0 - dot(left, vec3(1.0 / 3.0))); /* alpha: darkens what lies behind a transparent picture */
}
