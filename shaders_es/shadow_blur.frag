#version 300 es
/* shadow_blur.frag: moments of a shadow map (runtime/gl/draw/gl_shadow.c), blurred by a Gaussian along one axis: along
 * x from depths, of twice the side; along y from the blurred rows. */
precision highp float;
precision highp int;

uniform highp sampler2D u_from;
uniform vec4 u_blur[2]; /* axis, sigma in texels of u_from, side of the target; the floor's depth by clip x, y, 1, and
                         * whether there is a floor */

out vec2 o_moments;

/* In the light's view from -1 to 1 through the sphere of noh_view_shadow. What is nearer to the light counts as -1;
 * where nothing was drawn there is the floor, or a depth of 1. */
vec2 noh_moments(ivec2 at)
{
    float z = texelFetch(u_from, at, 0).x, d = clamp(4.0 * z - 3.0, -1.0, 1.0);
    if (z >= 1.0 && u_blur[1].w > 0.0) {
        d = dot(u_blur[1].xyz, vec3((vec2(at) + 0.5) / u_blur[0].w - 1.0, 1.0)); /* of clip space */
        d = clamp(2.0 * d - 1.0, -1.0, 6.0);
    }
    return vec2(d, d * d);
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(u_from, 0) - 1;
    float sigma = u_blur[0].z, all = 0.0;
    vec2 sum = vec2(0.0);
    bool from_depth = u_blur[0].x > 0.0;
    int reach = int(2.0 * sigma + 0.5);
    for (int i = -reach; i <= reach; i++) {
        float x = float(i) / sigma, weight = exp(-0.5 * x * x);
        ivec2 tap = at + ivec2(0, i);
        vec2 m;
        if (from_depth) { /* two texels to a texel of the target: every other tap reads the other row */
            x = (float(i) + 0.5) / sigma;
            weight = exp(-0.5 * x * x);
            tap = 2 * at + ivec2(i + 1, i & 1);
            m = noh_moments(clamp(tap, ivec2(0), last));
        } else {
            m = texelFetch(u_from, clamp(tap, ivec2(0), last), 0).xy;
        }
        weight *= u_blur[1].w > 0.0 || m.x < 0.999 ? 1.0 : 0.0001; /* emptiness lights no rim */
        sum += weight * m;
        all += weight;
    }
    o_moments = sum / all;
}
