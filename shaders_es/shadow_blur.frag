#version 300 es
/* shadow_blur.frag: moments of a shadow map (runtime/gl/draw/gl_shadow.c), in four passes: of 4 x 4
 * depths; blurred along x; along y; at twice the side, filtered. */
precision highp float;
precision highp int;

uniform highp sampler2D u_from;
uniform vec4 u_blur[3]; /* pass, side of the blurred map, 2 / side of u_from; weights of a texel and of its three
                         * neighbours on each side; the floor's depth by clip x, y, 1, and whether there is a floor */

out vec2 o_moments;

bool noh_counts(vec2 m)
{
    return u_blur[2].w > 0.0 || m.x < 0.999; /* emptiness lights no rim */
}

/* In the light's view from -1 to 1 through the sphere of noh_view_shadow. What is nearer to the light counts as -1;
 * where nothing was drawn there is the floor, or a depth of 1. */
vec2 noh_moments(ivec2 first)
{
    ivec2 last = textureSize(u_from, 0) - 1;
    vec2 sum = vec2(0.0);
    float all = 0.0;
    for (int i = 0; i < 16; i++) {
        ivec2 at = min(first + ivec2(i & 3, i >> 2), last);
        float z = texelFetch(u_from, at, 0).x, d = clamp(4.0 * z - 3.0, -1.0, 1.0);
        if (z >= 1.0 && u_blur[2].w > 0.0) {
            d = dot(u_blur[2].xyz, vec3((vec2(at) + 0.5) * u_blur[0].z - 1.0, 1.0)); /* of clip space */
            d = clamp(2.0 * d - 1.0, -1.0, 6.0);
        }
        if (noh_counts(vec2(d))) {
            sum += vec2(d, d * d);
            all += 1.0;
        }
    }
    return all > 0.0 ? sum / all : vec2(1.0);
}

vec2 noh_blurred(ivec2 at, ivec2 axis)
{
    int last = int(u_blur[0].y) - 1;
    vec2 sum = vec2(0.0);
    float all = 0.0;
    for (int i = -3; i <= 3; i++) {
        vec2 m = texelFetch(u_from, clamp(at + i * axis, ivec2(0), ivec2(last)), 0).xy;
        float weight = noh_counts(m) ? u_blur[1][abs(i)] : 0.0;
        sum += weight * m;
        all += weight;
    }
    return all > 0.0 ? sum / all : vec2(1.0);
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (u_blur[0].x == 0.0) {
        o_moments = noh_moments(4 * at);
    } else if (u_blur[0].x < 3.0) {
        o_moments = noh_blurred(at, u_blur[0].x == 1.0 ? ivec2(1, 0) : ivec2(0, 1));
    } else {
        o_moments = texture(u_from, gl_FragCoord.xy * (0.5 / u_blur[0].y)).xy;
    }
}
