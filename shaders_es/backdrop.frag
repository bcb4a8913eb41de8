#version 300 es
/* backdrop.frag: what is behind everything: the environment, blurred and dimmed, or its colours from below and above.
 * Behind #version go the defines, common_fade.glsl, common_fragment.glsl and common_environment.glsl. */
uniform vec4 u_kind; /* 1: the environment; 0: a gradient */

in vec3 v_ray;

out vec4 o_color;

void main()
{
    vec3 d = normalize(v_ray);
    vec3 blurred = 0.55 * noh_mirror(d, 0.42);
    vec3 even = 0.22 * mix(noh_ambient(vec3(0.0, -1.0, 0.0)), noh_ambient(vec3(0.0, 1.0, 0.0)), smoothstep(-0.45, 0.45, d.y));
    o_color = vec4(noh_encode(noh_expose(u_kind.x > 0.5 ? blurred : even)), 1.0);
}
