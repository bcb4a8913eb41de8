/* shape.c: boxes by separating axes, rays by slabs and quadratics. */
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#include "core/base/math_internal.h"
#include "core/base/vector_internal.h"
#include "life/physics/shape_internal.h"

/* ---- boxes ---- */

int noh_aabb_contains(const noh_aabb *box, const float point[3])
{
    for (int i = 0; i < 3; i++) {
        if (!(point[i] >= box->min[i] && point[i] <= box->max[i])) return 0;
    }
    return 1;
}

/* Transform a point or, about the origin, a direction into the space of a rotation. */
static void into(const float rotation[4], const float v[3], float out[3])
{
    float back[4];
    noh_quat_conjugate(rotation, back);
    noh_quat_rotate(back, v, out);
}

static void into_box(const noh_obb *box, const float point[3], float out[3])
{
    float from_centre[3];
    noh_sub3(point, box->centre, from_centre);
    into(box->rotation, from_centre, out);
}

int noh_obb_contains(const noh_obb *box, const float point[3])
{
    float p[3];
    into_box(box, point, p);
    return noh_abs(p[0]) <= box->half[0] && noh_abs(p[1]) <= box->half[1] && noh_abs(p[2]) <= box->half[2];
}

void noh_obb_closest(const noh_obb *box, const float point[3], float closest[3])
{
    float p[3];
    if (noh_obb_contains(box, point)) {
        for (int i = 0; i < 3; i++) closest[i] = point[i];
        return;
    }
    into_box(box, point, p);
    for (int i = 0; i < 3; i++) p[i] = noh_clamped(p[i], -box->half[i], box->half[i]);
    noh_quat_rotate(box->rotation, p, p);
    noh_madd3(box->centre, 1.0f, p, closest);
}

/* Box b in the space of box a: its centre, its axes as columns, and their magnitudes plus the margin. */
typedef struct pair {
    float centre[3], axes[3][3], sizes[3][3];
} pair;

static pair pair_of(const noh_obb *a, const noh_obb *b)
{
    static const float units[3][3] = { { 1.0f, 0.0f, 0.0f }, { 0.0f, 1.0f, 0.0f }, { 0.0f, 0.0f, 1.0f } };
    pair p;
    into_box(a, b->centre, p.centre);
    for (int j = 0; j < 3; j++) {
        float axis[3];
        noh_quat_rotate(b->rotation, units[j], axis);
        into(a->rotation, axis, axis);
        for (int i = 0; i < 3; i++) {
            p.axes[i][j] = axis[i];
            p.sizes[i][j] = noh_abs(axis[i]) + 1e-6f;
        }
    }
    return p;
}

/* Whether the boxes are separated along a side of a or of b. */
static int sides_part(const pair *p, const float a[3], const float b[3])
{
    for (int i = 0; i < 3; i++) {
        const float *s = p->sizes[i];
        if (noh_abs(p->centre[i]) > a[i] + b[0] * s[0] + b[1] * s[1] + b[2] * s[2]) return 1;
    }
    for (int j = 0; j < 3; j++) {
        const float at = p->centre[0] * p->axes[0][j] + p->centre[1] * p->axes[1][j] + p->centre[2] * p->axes[2][j];
        const float reach = a[0] * p->sizes[0][j] + a[1] * p->sizes[1][j] + a[2] * p->sizes[2][j];
        if (noh_abs(at) > reach + b[j]) return 1;
    }
    return 0;
}

/* Whether the boxes are separated along the product of edge i of a and edge j of b. */
static int edges_part(const pair *p, const float a[3], const float b[3], int i, int j)
{
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    const float at = p->centre[i2] * p->axes[i1][j] - p->centre[i1] * p->axes[i2][j];
    const float reach_a = a[i1] * p->sizes[i2][j] + a[i2] * p->sizes[i1][j];
    const float reach_b = b[j1] * p->sizes[i][j2] + b[j2] * p->sizes[i][j1];
    return noh_abs(at) > reach_a + reach_b;
}

int noh_obb_overlap(const noh_obb *a, const noh_obb *b)
{
    const pair p = pair_of(a, b);
    if (sides_part(&p, a->half, b->half)) return 0;
    for (int k = 0; k < 9; k++) {
        if (edges_part(&p, a->half, b->half, k / 3, k % 3)) return 0;
    }
    return 1;
}

/* ---- rays ---- */

float noh_ray_aabb(const noh_ray *ray, const noh_aabb *box)
{
    float enter = 0.0f, leave = ray->distance_max;
    for (int i = 0; i < 3; i++) {
        const float d = ray->direction[i];
        if (d == 0.0f) { /* parallel to the slab: inside it or never */
            if (ray->from[i] < box->min[i] || ray->from[i] > box->max[i]) return -1.0f;
            continue;
        }
        const float low = (box->min[i] - ray->from[i]) / d, high = (box->max[i] - ray->from[i]) / d;
        const float near = low < high ? low : high, far = low < high ? high : low;
        enter = near > enter ? near : enter;
        leave = far < leave ? far : leave;
    }
    return enter <= leave ? enter : -1.0f;
}

float noh_ray_obb(const noh_ray *ray, const noh_obb *box)
{
    noh_ray local = *ray;
    noh_aabb sides;
    into_box(box, ray->from, local.from);
    into(box->rotation, ray->direction, local.direction);
    for (int i = 0; i < 3; i++) {
        sides.max[i] = box->half[i];
        sides.min[i] = -box->half[i];
    }
    return noh_ray_aabb(&local, &sides);
}

/* The first root of a t^2 + 2 b t + c from 0 on, with c > 0: it begins outside. Below 0 if there is none. */
static float first_root(float a, float b, float c)
{
    const float square = b * b - a * c;
    return a > 0.0f && b < 0.0f && square >= 0.0f ? c / (-b + noh_sqrt(square)) : -1.0f;
}

static float ray_ball(const noh_ray *ray, const float centre[3], float radius)
{
    float from[3];
    noh_sub3(ray->from, centre, from);
    const float c = noh_dot3(from, from) - radius * radius;
    return c <= 0.0f ? 0.0f : first_root(noh_dot3(ray->direction, ray->direction), noh_dot3(from, ray->direction), c);
}

/* Intersect with the round side of a capsule, between its ends. */
static float ray_side(const noh_ray *ray, const float from[3], const float axis[3], float radius)
{
    const float length = noh_dot3(axis, axis);
    float start[3], across[3], along[3];
    if (!(length > 0.0f)) return -1.0f;
    noh_sub3(ray->from, from, start);
    noh_madd3(start, -noh_dot3(start, axis) / length, axis, across);
    noh_madd3(ray->direction, -noh_dot3(ray->direction, axis) / length, axis, along);
    const float c = noh_dot3(across, across) - radius * radius;
    const float t = c <= 0.0f ? 0.0f : first_root(noh_dot3(along, along), noh_dot3(across, along), c);
    if (t < 0.0f) return -1.0f;
    const float at = (noh_dot3(start, axis) + t * noh_dot3(ray->direction, axis)) / length;
    return at >= 0.0f && at <= 1.0f ? t : -1.0f;
}

float noh_ray_capsule(const noh_ray *ray, const float from[3], const float to[3], float radius)
{
    float axis[3], hits[3], best = -1.0f;
    noh_sub3(to, from, axis);
    hits[0] = ray_ball(ray, from, radius);
    hits[1] = ray_ball(ray, to, radius);
    hits[2] = ray_side(ray, from, axis, radius);
    for (int i = 0; i < 3; i++) {
        if (hits[i] >= 0.0f && hits[i] <= ray->distance_max && (best < 0.0f || hits[i] < best)) best = hits[i];
    }
    return best;
}

/* ---- segments ---- */

/* Along a, for a point of b at `t`: a . (b(t) - a_from) / a . a; 0 for a point. */
static float project(float length, float along)
{
    return length > 1e-20f ? noh_clamped(along / length, 0.0f, 1.0f) : 0.0f;
}

void noh_segments_closest(const float a_from[3], const float a_to[3], const float b_from[3], const float b_to[3],
                          float along[2])
{
    float a[3], b[3], r[3];
    noh_sub3(a_to, a_from, a);
    noh_sub3(b_to, b_from, b);
    noh_sub3(a_from, b_from, r);
    const float aa = noh_dot3(a, a), bb = noh_dot3(b, b), ab = noh_dot3(a, b);
    const float ar = noh_dot3(a, r), br = noh_dot3(b, r), denominator = aa * bb - ab * ab;
    const float s = denominator > 1e-7f * aa * bb ? noh_clamped((ab * br - ar * bb) / denominator, 0.0f, 1.0f) : 0.0f;
    along[1] = project(bb, ab * s + br);
    along[0] = project(aa, ab * along[1] - ar);
}
