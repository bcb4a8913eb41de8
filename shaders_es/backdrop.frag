#version 300 es
/* backdrop.frag: the backdrop: the environment, blurred and dimmed, or a gradient of its colours from below and above.
 * After #version: the defines, common_fade.glsl, common_fragment.glsl and common_environment.glsl. */
uniform vec4 u_kind;    /* 1: the environment; 0: a gradient */
uniform vec4 u_ends[2]; /* ends of the gradient: below, above; linear */

in vec3 v_ray;

out vec4 o_color;

/* Add noise of one step of eight bits to an encoded colour, so that smooth gradients show no bands. */
vec3 dithered(vec3 c)
{
    vec3 noise = vec3(noh_fade_noise(gl_FragCoord.xy), noh_fade_noise(gl_FragCoord.yx + 64.0), noh_fade_noise(gl_FragCoord.xy + 192.0));
#ifdef NOH_ENCODE_SRGB
    return c + (noise - 0.5) / 255.0;
#else
    return c + (noise - 0.5) * (2.0 / 255.0) * sqrt(c); /* the target encodes: about a square root */
#endif
}

void main()
{
    vec3 d = normalize(v_ray), color;
    if (u_kind.x > 0.5) { /* a branch, because in software rendering each side is expensive */
        color = 0.85 * noh_mirror(d, 0.42);
    } else {
        color = 0.34 * mix(u_ends[0].rgb, u_ends[1].rgb, smoothstep(-0.45, 0.45, d.y));
    }
    color = max(mix(vec3(dot(color, vec3(0.2126, 0.7152, 0.0722))), color, 1.35), 0.0); /* balanced lights are pale */
    o_color = vec4(dithered(noh_encode(noh_expose(color))), 1.0);
}
