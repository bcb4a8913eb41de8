/* common_scatter.glsl: scattering of light in skin. It follows common_environment.glsl in noh_gl_shader_prefix. Empty
 * without NOH_SKIN, or with NOH_DEPTH_ONLY. */
#if defined(NOH_SKIN) && !defined(NOH_DEPTH_ONLY)
uniform vec4 noh_surface_values; /* x: millimetres in a unit of the world */

in float noh_v_depth; /* behind the lips: common_face.glsl */

/* The light of a lamp at angle acos(nl) that skin scatters back, by channel: light that enters nearby leaves here. It
 * is the integral of max(cos, 0) over a ring of this curvature, weighted by the diffusion profile of d'Eon and Luebke
 * (GPU Gems 3, chapter 14), which Penner tabulates (Pre-integrated skin shading, GPU Pro 2, 2011). A fit replaces his
 * texture: a line, and a hyperbola for |nl|, whose corner the curvature rounds. Its error is at most 0.006 (tested by
 * test_gl_surfaces); in the phone tier, a hyperbola alone, 0.03 up to a curvature of 0.5. nl: a cosine for each channel;
 * curvature: 1/mm; above 1 it counts as 1 */
vec3 noh_scatter(vec3 nl, float curvature)
{
    float c = clamp(curvature, 0.0, 1.0);
#ifdef NOH_PHONE
    return 0.5 * (nl + sqrt(nl * nl + vec3(0.0225, 0.0096, 0.0085) * (c * c)));
#else
    vec3 line = (vec3(-0.01368, -0.00198, -0.00044) * c + vec3(-0.02688, -0.00389, -0.0026)) * c + 0.5;
    vec3 bend = (vec3(0.00224, -0.00358, -0.00333) * c + vec3(-0.0504, -0.00704, 0.00543)) * c + 0.5;
    vec3 corner = (vec3(-0.02014, 0.00314, 0.00378) * c + vec3(0.16371, 0.09616, 0.09086)) * c;
    vec3 level = (vec3(-0.01574, 0.0, -0.00248) * c + vec3(0.03268, 0.0, -0.00487)) * c;
    return max(level + line * nl + bend * sqrt(nl * nl + corner * corner), 0.0);
#endif
}

/* The curvature of a surface, in 1/mm, from neighbouring pixels. Uses the larger distance of the two directions: at
 * grazing angles the other one is unreliable. In the phone tier, along the rows of the picture alone. */
float noh_curvature(vec3 position, vec3 geometric)
{
#ifdef NOH_PHONE
    vec3 along = dFdx(geometric), step = dFdx(position);
    return sqrt(dot(along, along) / max(dot(step, step), 1e-20)) / noh_surface_values.x;
#else
    vec3 nx = dFdx(geometric), ny = dFdy(geometric), px = dFdx(position), py = dFdy(position);
    float turn = max(dot(nx, nx), dot(ny, ny)), way = max(dot(px, px), dot(py, py));
    return sqrt(turn / max(way, 1e-20)) / noh_surface_values.x;
#endif
}

/* Light scatters farther than the finest bumps, red the farthest: each channel has a normal of its own, between the
 * normal of the maps and the normal of the mesh (Jensen et al., as in Penner). Returns the cosines to the key light. */
vec3 noh_scatter_cosines(noh_surface s, vec3 key)
{
    return mix(vec3(dot(s.normal, key)), vec3(dot(s.geometric, key)), vec3(0.7, 0.4, 0.25));
}

/* Pores smaller than a pixel do not glitter: they increase its roughness (Tokuyoshi, Kaplanyan: Improved geometric
 * specular antialiasing, I3D 2019). */
float noh_pore_roughness(float roughness, vec3 normal)
{
#if defined(NOH_PHONE) && !defined(NOH_NORMAL_MAP)
    return roughness;
#else
    vec3 x = dFdx(normal), y = dFdy(normal);
    float a = roughness * roughness, wider = min(0.5 * (dot(x, x) + dot(y, y)), 0.18);
    return sqrt(sqrt(min(a * a + wider, 1.0)));
#endif
}

/* The roughness of the two specular lobes of skin, of its oil and of the skin below, narrower and wider than the map's,
 * which is from 0.08 to 1; and the share of the narrow one. */
vec2 noh_lobes_at(float roughness)
{
    return vec2(max(0.80 * roughness, 0.08), min(1.30 * roughness, 1.0));
}

const float noh_narrow_lobe = 0.45;
#endif
