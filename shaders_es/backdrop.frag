#version 300 es
/* backdrop.frag: the backdrop: the environment, blurred and dimmed, or a gradient of its colours from below and above.
 * After #version: the defines, common_fade.glsl, common_fragment.glsl and common_environment.glsl. */
uniform vec4 u_kind;    /* 1: the environment; 0: a gradient */
uniform vec4 u_ends[2]; /* ends of the gradient: below, above; linear */

in vec3 v_ray;

out vec4 o_color;

void main()
{
    vec3 d = normalize(v_ray), color;
    if (u_kind.x > 0.5) { /* a branch, because in software rendering each side is expensive */
        color = 0.55 * noh_mirror(d, 0.42);
    } else {
        color = 0.22 * mix(u_ends[0].rgb, u_ends[1].rgb, smoothstep(-0.45, 0.45, d.y));
    }
    o_color = vec4(noh_encode(noh_expose(color)), 1.0);
}
