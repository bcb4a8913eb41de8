/* common_eye.glsl: eyes, wet, with a cornea over the iris and under lids; and teeth. It follows common_environment.glsl
 * in noh_gl_shader_prefix. Empty without NOH_EYE and NOH_TEETH, or with NOH_DEPTH_ONLY.
 *
 * An eye is a ball with a bulge in front, the cornea, part of a smaller sphere. The cornea mirrors like this sphere,
 * whatever the mesh is, and refracts the view of the iris, a plane below it. An eye without a detected iris is a wet
 * ball. */
#if defined(NOH_EYE) && !defined(NOH_DEPTH_ONLY)
uniform vec4 noh_surface_values; /* noh_material.surface_values */
uniform vec3 noh_surface_more[2]; /* upper lid, lower lid */

in vec3 noh_v_gaze; /* gaze direction, as long as the radius of the iris; world */
in vec4 noh_v_up;   /* about perpendicular to it, upwards; world. w: 1 or -1 by the side of the nose */

/* Radius of the cornea / radius of the iris: 7.8 mm / 6 mm. */
const float noh_cornea_radius = 1.3;
/* Depth of the iris below the top of the cornea / radius of the iris: 2.7 mm / 6 mm. */
const float noh_iris_depth = 0.45;

/* A pixel of an eye. */
struct noh_eye {
    vec3 gaze;    /* unit; zero: unknown */
    vec3 side;    /* component of the normal perpendicular to gaze */
    float across; /* its length, 1 at the rim of the iris */
};

/* Half a pixel in these lengths. Edges on the iris are at least a pixel wide, so that they do not break up from far. */
float noh_half_pixel(noh_eye e)
{
    return 0.5 * fwidth(e.across);
}

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

/* The normal of the cornea, unit: bent away from the gaze, and equal to the ball's beyond the rim. */
vec3 noh_cornea(noh_eye e, vec3 normal)
{
    float bend = 1.0 / (noh_cornea_radius * max(noh_surface_values.w, 0.2)); /* relative to the ball */
    return normalize(normal + e.side * (max(bend - 1.0, 0.0) * (1.0 - smoothstep(0.85, 1.25, e.across))));
}

/* The texture coordinates of an eye: where the refracted view ray meets the iris, whose depth decreases towards its
 * rim. position, normal, uv: of the pixel */
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

/* Distances of a pixel below the edge of the upper lid, above the edge of the lower lid, and from the middle of the eye
 * away from the nose, in radii of the ball. */
vec3 noh_from_lids(noh_surface s)
{
    vec3 out_of = cross(noh_v_up.xyz, noh_v_gaze); /* away from the nose, or towards it */
    float a = noh_v_up.w * dot(s.geometric, out_of) * inversesqrt(max(dot(out_of, out_of), 1e-20));
    float height = dot(s.geometric, normalize(noh_v_up.xyz));
    vec3 powers = vec3(1.0, a, a * a);
    return vec3(dot(noh_surface_more[0], powers) - height, height - dot(noh_surface_more[1], powers), a);
}

/* The share of ambient light that the lids let through: their edges darken the ball, the upper lid more. */
float noh_lids(vec3 from)
{
    return mix(0.75, 1.0, smoothstep(-0.02, 0.3, from.x)) * mix(0.85, 1.0, smoothstep(-0.02, 0.2, from.y));
}

/* Tears along the lower lid: the film rises to it, least in the corners. Returns the normal for reflections, unit. */
vec3 noh_wet_line(vec3 from, vec3 cornea)
{
    float rise = (1.0 - smoothstep(0.0, 0.06, from.y)) * (1.0 - smoothstep(0.25, 0.5, abs(from.z)));
    return normalize(cornea + normalize(noh_v_up.xyz) * rise);
}

/* The iris is a bowl behind a lens: it is bright on the side away from the light. Returns the normal for matte
 * light. */
vec3 noh_iris_normal(noh_surface s, noh_eye e)
{
    return normalize(s.normal - e.side * (1.4 * (1.0 - smoothstep(0.75, 1.0, e.across))));
}

/* The rim of an iris is dark, and fades into the white. Wider, it is paler by as much: half_pixel: from
 * noh_half_pixel */
float noh_iris_rim(noh_eye e, float half_pixel)
{
    return 1.0 - 0.35 * (smoothstep(0.7 - half_pixel, 0.95 + half_pixel, e.across) - smoothstep(0.98 - half_pixel, 1.2 + half_pixel, e.across));
}

float noh_on_cornea = 1.0; /* 1 on the cornea and on balls without an iris, 0 on the white: noh_eye_light sets it */

/* The lamp's reflection in an eye: a disc of eleven degrees, divided by its solid angle. Limited to the cornea: at its
 * rim the normal turns back and would smear the reflection over the white. nh: cosine between the normal and the half
 * vector */
float noh_lamp(float nh)
{
    return 8.7 * smoothstep(0.977, 0.986, 2.0 * nh * nh - 1.0) * noh_on_cornea;
}

/* Adapt a surface to an eye, for matte light. Returns the normal for reflections, unit. */
vec3 noh_eye_light(inout noh_surface s)
{
    noh_eye e = noh_eye_at(s.geometric);
    vec3 mirror = s.normal;
    s.roughness = min(s.roughness, 0.12);
    if (e.gaze != vec3(0.0)) {
        mirror = noh_cornea(e, s.normal);
        float half_pixel = noh_half_pixel(e);
        noh_on_cornea = 1.0 - smoothstep(0.8 - half_pixel, 1.0 + half_pixel, e.across);
        s.albedo *= noh_iris_rim(e, half_pixel);
        s.normal = noh_iris_normal(s, e);
    }
    if (noh_surface_more[0].x > noh_surface_more[1].x) {
        vec3 from = noh_from_lids(s);
        mirror = noh_wet_line(from, mirror);
#if NOH_TRANSFER == 0 /* a transfer includes the lids */
        float lids = noh_lids(from);
        s.occlusion *= lids;
#endif
    }
    return mirror;
}
#endif

#if defined(NOH_TEETH) && !defined(NOH_DEPTH_ONLY)
in float noh_v_depth; /* behind the lips: common_face.glsl */
#endif
