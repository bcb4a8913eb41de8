/* common_complexion.glsl: the complexion of an instance: melanin, blood and freckles of its skin, its lips, hair, brows
 * and irises, from the four floats of noh_user(). It precedes common_vertex.glsl and common_light.glsl in
 * noh_gl_shader_prefix. Empty without NOH_COMPLEXION (noh_stage_desc.user_values), or with NOH_DEPTH_ONLY. */
#if defined(NOH_COMPLEXION) && !defined(NOH_DEPTH_ONLY)
#ifdef NOH_AT_VERTICES
flat out vec4 noh_v_complexion; /* skin: melanin, blood, freckles, lips; eye: iris, its share; hair: melanin, red */
#ifdef NOH_SKIN
out vec4 noh_v_freckles; /* place in the bind pose; how many freckles are there, 0..1 */
#endif

/* The three bytes of a float; and as numbers of -128..127. */
vec3 noh_bytes_of(float three)
{
    int bits = int(three);
    return vec3(bits & 255, bits >> 8 & 255, bits >> 16 & 255);
}

vec3 noh_signed_of(float three)
{
    vec3 bytes = noh_bytes_of(three);
    return bytes - 256.0 * vec3(greaterThan(bytes, vec3(127.5)));
}

#ifdef NOH_SKIN
/* Freckles are where the sun shines: on what faces forwards or upwards. rest, normal: in the bind pose */
void noh_freckles_vertex(vec3 rest, vec3 normal)
{
    float seed = noh_bytes_of(noh_user().w).y;
    float sun = smoothstep(0.35, 1.0, dot(normal, vec3(0.0, 0.45, 0.89)));
    noh_v_freckles = vec4(rest * noh_surface_values.x + seed * vec3(3.7, 1.3, 2.9), sun);
}
#endif

/* part: of the complexion that the material shows: 0 none, 1 skin, 2 eye, 3 hair, 4 brows */
void noh_complexion_vertex(int part)
{
    vec4 user = noh_user();
    noh_v_complexion = vec4(0.0);
    if (user == vec4(0.0) || part == 0) return;
#if defined(NOH_SKIN)
    vec3 skin = noh_signed_of(user.x);
    noh_v_complexion = vec4(skin.x / 32.0, skin.y / 64.0, noh_bytes_of(user.x).z / 255.0, noh_signed_of(user.y).z / 64.0);
#elif defined(NOH_EYE)
    vec3 root = noh_bytes_of(user.z) / 255.0;
    noh_v_complexion = vec4(root * root, noh_bytes_of(user.w).x / 255.0);
#else
    vec3 hair = noh_signed_of(user.y);
    noh_v_complexion.xy = vec2(hair.x / 32.0, hair.y / 64.0);
    if (part == 4) noh_v_complexion.x += noh_signed_of(user.w).z / 32.0;
#endif
}
#else
flat in vec4 noh_v_complexion;

#if defined(NOH_SKIN)
in vec4 noh_v_freckles;

/* Optical density of a unit of melanin and of blood, by channel: melanin absorbs blue the most (Jacques, "Skin optics",
 * 1998), haemoglobin green. Light that the surface scatters back before it reaches melanin stays: the floor. */
const vec3 noh_melanin = vec3(1.0, 1.35, 1.85), noh_blood = vec3(0.15, 1.0, 0.85);
const vec3 noh_melanin_floor = vec3(0.05, 0.08, 0.11);

uint noh_cell_bits(ivec3 cell, uint layer)
{
    uvec3 c = uvec3(cell) * uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du);
    uint bits = c.x ^ c.y ^ c.z ^ layer * 0x27d4eb2fu;
    bits = (bits ^ bits >> 15) * 0x2c1b3c6du;
    bits = (bits ^ bits >> 12) * 0x297a2d39u;
    return bits ^ bits >> 15;
}

/* How much freckles of one size darken a pixel: each cell of a grid in the bind pose has at most one, a ball
 * that crosses the skin. place: in cells; wide: half of a pixel; share: of the cells that have one */
float noh_freckle(vec3 place, float wide, float share, uint layer)
{
    uint bits = noh_cell_bits(ivec3(floor(place)), layer);
    float radius = 0.14 + 0.10 * float(bits >> 24) / 255.0, edge = max(0.6 * radius, min(wide, 0.2));
    vec3 jitter = vec3(bits & 63u, bits >> 6 & 63u, bits >> 12 & 63u) / 63.0;
    vec3 middle = mix(vec3(1.6 * radius), vec3(1.0 - 1.6 * radius), jitter);
    float within = 1.0 - smoothstep(radius - edge, radius + edge, distance(fract(place), middle));
    within *= 0.4 + 0.6 * float(bits & 7u) / 7.0;
    return float(bits >> 18 & 63u) < 63.0 * share ? within * radius * radius / (radius * radius + wide * wide) : 0.0;
}

/* Melanin and blood are layers that absorb: their densities add to the skin's own, which keeps its texture (Tsumura et
 * al., 1999, 2003). The skin's own blood, from the ratios of its channels, tells lips from the rest, and grey and blue
 * texels, which are lashes or cloth, from both. */
vec3 noh_complexioned(vec3 albedo, vec3 normal)
{
    vec3 place = noh_v_freckles.xyz;
    float wide = 0.5 * length(fwidth(place)), share = 0.75 * noh_v_complexion.z * noh_v_freckles.w;
    if (noh_v_complexion == vec4(0.0)) return albedo;
    vec3 ln = log(max(albedo, vec3(1e-3)));
    float lips = smoothstep(0.5, 0.9, 1.047 * (ln.r - ln.g) - 0.733 * (ln.g - ln.b));
    float spots = noh_freckle(place / 2.3, wide / 2.3, share, 0u);
#ifndef NOH_PHONE
    spots = max(spots, 0.8 * noh_freckle(place / 4.1, wide / 4.1, share, 1u));
#endif
    float melanin = noh_v_complexion.x * (1.0 - 0.4 * lips) + 0.4 * spots * (1.0 - lips);
    vec3 light = mix(exp(-melanin * noh_melanin), vec3(1.0), noh_melanin_floor);
    light *= exp(-(noh_v_complexion.y + noh_v_complexion.w * lips) * noh_blood);
    float is_skin = smoothstep(0.0, 0.2, ln.r - ln.b) * (1.0 - clamp(noh_v_depth, 0.0, 1.0)); /* not inside the mouth */
    return min(albedo * mix(vec3(1.0), light, is_skin), vec3(1.0));
}
#elif defined(NOH_EYE)
/* The iris takes a colour and keeps its relief; the white stays. */
vec3 noh_complexioned(vec3 albedo, vec3 normal)
{
    noh_eye e = noh_eye_at(normal);
    float half_pixel = noh_half_pixel(e), light = dot(albedo, vec3(0.2126, 0.7152, 0.0722));
    if (noh_v_complexion.a == 0.0) return albedo;
    float most = max(albedo.r, max(albedo.g, albedo.b)), least = min(albedo.r, min(albedo.g, albedo.b));
    float rim = mix(1.0, 1.35, smoothstep(0.3, 0.5, 1.0 - least / max(most, 1e-4))); /* what has a colour is no white */
    float iris = 1.0 - smoothstep(0.85 * rim - half_pixel, rim + half_pixel, e.across);
    return mix(albedo, noh_v_complexion.rgb * (1.6 * light / (light + 0.06)), noh_v_complexion.a * iris);
}
#else
vec3 noh_complexioned(vec3 albedo, vec3 normal)
{
    return noh_hair_of(albedo, noh_v_complexion.xy);
}
#endif
#endif
#endif
