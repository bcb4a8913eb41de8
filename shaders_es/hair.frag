#version 300 es
/* hair.frag: light on a strip of hair, and the choice of pixels by pass. After #version: the defines, common_fade.glsl,
 * common_fragment.glsl and common_environment.glsl. */
uniform vec4 u_alpha; /* range of alpha drawn: from, up to */
uniform vec4 u_widths;
uniform vec4 u_root, u_tip;
uniform vec4 u_eye, u_light;

in vec3 v_position;
in vec3 v_tangent;
in vec3 v_normal;
in vec2 v_at;
flat in float v_strip;
flat in vec2 v_melanin; /* of the head's complexion, as in noh_hair_of */
flat in float v_fade; /* 0: hidden, the hair painted on the head shows instead */

out vec4 o_color;

/* Brightness and end of a strand; strands lie side by side on a strip. */
vec2 strand(float cell)
{
    return fract(sin(vec2(cell * 12.9898 + v_strip * 78.233, cell * 39.346 + v_strip * 11.135)) * 43758.5453);
}

void main()
{
    float x = (v_at.x * 0.5 + 0.5) * 6.0, fine = clamp(1.6 - 1.6 * fwidth(x), 0.0, 1.0);
    vec2 own = strand(floor(x));
    float between = fract(x) * 2.0 - 1.0;
    float edge = 1.0 - smoothstep(0.55, 1.0, abs(v_at.x));
    float end = mix(0.92, 0.72 + 0.28 * own.y, fine);
    float begin = mix(0.03, 0.004 + 0.08 * own.x * own.x, fine); /* irregular, so the hairline is not sharp */
    float grown = smoothstep(0.0, begin, v_at.y); /* strands begin as thin points, and soon fill the strip */
    float filled = mix(grown, min(1.0, 3.0 * grown) * (1.0 - smoothstep(1.4 * grown - 0.4, 1.4 * grown, abs(between))), fine);
    float alpha = min(1.0, 1.6 * edge) * filled * (1.0 - smoothstep(end - 0.12, end, v_at.y));
    if (alpha < u_alpha.x || alpha >= u_alpha.y || noh_fade_noise(gl_FragCoord.xy) >= v_fade) {
        discard;
    }
#ifndef NOH_DEPTH_ONLY
    vec3 t = normalize(v_tangent), n = normalize(v_normal), view = normalize(u_eye.xyz - v_position);
    vec3 albedo = noh_hair_of(mix(u_root.rgb, u_tip.rgb, v_at.y), v_melanin);
    albedo *= mix(1.0, 0.6 + 0.8 * own.x, fine) * (0.8 + 0.4 * v_strip);
    float deep = mix(1.0, 0.7 + 0.3 * (1.0 - between * between), fine) * mix(0.6, 1.0, smoothstep(0.0, 0.15, v_at.y));
#ifdef NOH_LIT
    vec3 key = noh_key, key_color = noh_key_color * noh_key_shadow(v_position, n);
    vec3 even = noh_ambient(n);
#else
    vec3 key = u_light.xyz, key_color = vec3(1.02, 0.98, 0.92);
    vec3 even = 0.62 * mix(vec3(0.23, 0.20, 0.18), vec3(0.50, 0.54, 0.60), n.y * 0.5 + 0.5);
#endif
    float tl = dot(t, key), nl = dot(n, key);
    vec3 h = normalize(key + view);
    float shift = 0.12 * mix(0.0, own.x - 0.5, fine) + 0.1 * (v_strip - 0.5);
    float first = noh_strand_lobe(normalize(t + (shift - 0.08) * n), h, 90.0), second = noh_strand_lobe(normalize(t + (shift + 0.12) * n), h, 22.0);
    float facing = clamp(mix(0.25, 1.0, nl), 0.0, 1.0);
    vec3 color = albedo * (even * deep + key_color * (facing * sqrt(max(1.0 - tl * tl, 0.0))));
    color += u_widths.w * smoothstep(-0.2, 0.4, nl) * key_color * (0.10 * first + (2.5 * albedo + 0.02) * second) * deep;
    color += u_widths.w * 0.05 * even * deep * (0.3 + 0.7 * pow(1.0 - abs(dot(t, view)), 2.0));
#ifdef NOH_LIT
    color = noh_expose(color);
#endif
    o_color = vec4(noh_encode(color), u_alpha.y > 1.0 ? 1.0 : clamp(alpha, 0.0, 1.0)); /* 1 where nothing blends */
#else
    o_color = vec4(1.0);
#endif
}
