/* common_eye.glsl: eyes, a cornea in front of an iris, wet and below lids; and teeth. It goes behind
 * common_environment.glsl: noh_gl_shader_prefix puts them together. Nothing of it is there without NOH_EYE and
 * NOH_TEETH, or with NOH_DEPTH_ONLY.
 *
 * An eye is a ball whose front a smaller sphere makes bulge, the cornea: it mirrors as that sphere would, whatever the
 * mesh is, and bends the way of what is seen of the iris, a plane below it. Where no iris was found, it is a wet ball. */
#if defined(NOH_EYE) && !defined(NOH_DEPTH_ONLY)
uniform vec4 noh_surface_values; /* noh_material.surface_values */
uniform vec3 noh_surface_more[2]; /* upper lid, lower lid */

in vec3 noh_v_gaze; /* where the eye looks, as long as its iris' radius; world */
in vec3 noh_v_up;   /* about across it, upwards; world */
in vec3 noh_v_out;  /* across both, from the nose; world */

/* The radius of the cornea over that of the iris: 7.8 mm over 6 mm. */
const float noh_cornea_radius = 1.3;
/* The way from the cornea's top down to the iris, over the iris' radius: 2.7 mm over 6 mm. */
const float noh_iris_depth = 0.45;

/* The part of a pixel of an eye. */
struct noh_eye {
    vec3 gaze;    /* unit; zero: not known */
    vec3 side;    /* the normal's part across gaze */
    float across; /* its length over that at the iris' rim */
};

noh_eye noh_eye_at(vec3 normal)
{
    noh_eye e = noh_eye(vec3(0.0), vec3(0.0), 2.0);
    if (noh_surface_values.w > 0.0) {
        e.gaze = normalize(noh_v_gaze);
        e.side = normal - e.gaze * dot(normal, e.gaze);
        e.across = dot(normal, e.gaze) > 0.0 ? length(e.side) / noh_surface_values.w : 2.0;
    }
    return e;
}

/* The normal of the cornea, unit: turned away from the gaze, back to the ball's own behind the rim. */
vec3 noh_cornea(noh_eye e, vec3 normal)
{
    float bend = 1.0 / (noh_cornea_radius * max(noh_surface_values.w, 0.2)); /* over that of the ball */
    return normalize(normal + e.side * (max(bend - 1.0, 0.0) * (1.0 - smoothstep(0.85, 1.25, e.across))));
}

/* Where the eye's texture is read: where the refracted line of sight meets the iris, less deep towards its rim.
 * position, normal, uv: of the pixel */
vec2 noh_eye_uv(vec3 position, vec3 normal, vec2 uv)
{
    vec3 n = normalize(normal), view = normalize(noh_camera - position);
    vec3 px = dFdx(position), py = dFdy(position), facet = cross(px, py);
    vec2 ux = dFdx(uv), uy = dFdy(uv);
    noh_eye e = noh_eye_at(n);
    float area = dot(facet, facet);
    if (e.across >= 1.0 || area < 1e-30) {
        return uv;
    }
    vec3 ray = refract(-view, noh_cornea(e, n), 1.0 / 1.336);
    float down = -dot(ray, e.gaze), depth = noh_iris_depth * length(noh_v_gaze) * (1.0 - e.across * e.across);
    vec3 shift = (ray + e.gaze * down) * (depth / max(down, 0.3));
    facet *= inversesqrt(area);
    shift -= e.gaze * (dot(shift, facet) / max(abs(dot(e.gaze, facet)), 0.3) * sign(dot(e.gaze, facet)));
    vec3 gx = cross(py, facet), gy = cross(facet, px);
    return uv + (ux * dot(shift, gx) + uy * dot(shift, gy)) / dot(px, gx);
}

/* How far a pixel is below the edge of the upper lid, above that of the lower one, and from the nose's side to the middle
 * of the eye, in radii of the ball. */
vec3 noh_from_lids(noh_surface s)
{
    float a = dot(s.geometric, noh_v_out) * inversesqrt(max(dot(noh_v_out, noh_v_out), 1e-20)); /* zero where x = 0 */
    float height = dot(s.geometric, normalize(noh_v_up));
    vec3 powers = vec3(1.0, a, a * a);
    return vec3(dot(noh_surface_more[0], powers) - height, height - dot(noh_surface_more[1], powers), a);
}

/* The share of light from all around that the lids let through: their edges darken the ball, the upper one more. */
float noh_lids(vec3 from)
{
    return mix(0.75, 1.0, smoothstep(-0.02, 0.3, from.x)) * mix(0.85, 1.0, smoothstep(-0.02, 0.2, from.y));
}

/* Tears stand along the lower lid: there the film rises to it, least in the corners. The normal that mirrors, unit. */
vec3 noh_wet_line(vec3 from, vec3 cornea)
{
    float rise = (1.0 - smoothstep(0.0, 0.06, from.y)) * (1.0 - smoothstep(0.25, 0.5, abs(from.z)));
    return normalize(cornea + normalize(noh_v_up) * rise);
}

/* The iris is a bowl behind a lens: it is bright on the side away from the light. The normal that matte light takes. */
vec3 noh_iris_normal(noh_surface s, noh_eye e)
{
    return normalize(s.normal - e.side * (1.4 * (1.0 - smoothstep(0.75, 1.0, e.across))));
}

/* The rim of an iris is dark, and fades into the white. */
float noh_iris_rim(noh_eye e)
{
    return 1.0 - 0.35 * smoothstep(0.7, 0.95, e.across) * (1.0 - smoothstep(0.98, 1.2, e.across));
}

float noh_on_cornea = 1.0; /* 1 on the cornea and on balls without an iris, 0 on the white: noh_eye_light sets it */

/* The lamp in an eye: a disc of eleven degrees, over its solid angle. At the cornea's rim the normal turns back, and
 * would smear it over the white. nh: cosine between the normal and the half vector */
float noh_lamp(float nh)
{
    return 8.7 * smoothstep(0.977, 0.986, 2.0 * nh * nh - 1.0) * noh_on_cornea;
}

/* Make a surface that of an eye for matte light. Returns the normal that mirrors, unit. */
vec3 noh_eye_light(inout noh_surface s)
{
    noh_eye e = noh_eye_at(s.geometric);
    vec3 mirror = s.normal;
    s.roughness = min(s.roughness, 0.12);
    if (e.gaze != vec3(0.0)) {
        mirror = noh_cornea(e, s.normal);
        noh_on_cornea = 1.0 - smoothstep(0.8, 1.0, e.across);
        s.albedo *= noh_iris_rim(e);
        s.normal = noh_iris_normal(s, e);
    }
    if (noh_surface_more[0].x > noh_surface_more[1].x) {
        vec3 from = noh_from_lids(s);
        mirror = noh_wet_line(from, mirror);
#if NOH_TRANSFER == 0 /* else the transfer knows the lids */
        float lids = noh_lids(from);
        s.occlusion *= lids;
#endif
    }
    return mirror;
}
#endif

#if defined(NOH_TEETH) && !defined(NOH_DEPTH_ONLY)
in float noh_v_open; /* 0..1: how much of the light outside reaches the place */
#endif
