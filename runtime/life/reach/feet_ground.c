/* feet_ground.c: finds the ground straight below a point. */
#include "core/base/assert_internal.h"
#include "noh/body.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "core/base/vector_internal.h"
#include "life/physics/shape_internal.h"
#include "life/physics/world_ask_internal.h"
#include "life/reach/feet_internal.h"

static const float up[3] = { 0.0f, 1.0f, 0.0f };

typedef struct nearest {
    float distance; /* below 0: none yet */
    float normal[3];
} nearest;

static void take(nearest *n, float distance, const float normal[3])
{
    if (distance > 0.0f && (n->distance < 0.0f || distance < n->distance)) {
        n->distance = distance;
        memcpy(n->normal, normal, sizeof n->normal);
    }
}

static void take_plane(nearest *n, const noh_ray *ray, const noh_plane *p)
{
    const float above = noh_dot3(p->normal, ray->from) - p->distance;
    const float distance = p->normal[1] > 1e-4f ? above / p->normal[1] : -1.0f;
    if (distance <= ray->distance_max) take(n, distance, p->normal);
}

/* The side of the box on which a point of its surface lies: where it is farthest out, relative to the box's size. */
static void take_box(nearest *n, const noh_ray *ray, const noh_obb *b)
{
    const float distance = noh_ray_obb(ray, b);
    float at[3], back[4], side[3] = { 0.0f, 0.0f, 0.0f }, least = 1e30f;
    int axis = 1;
    if (!(distance > 0.0f)) return;
    noh_madd3(ray->from, distance, ray->direction, at);
    noh_sub3(at, b->centre, at);
    noh_quat_conjugate(b->rotation, back);
    noh_quat_rotate(back, at, at);
    for (int i = 0; i < 3; i++) {
        const float inside = b->half[i] - (at[i] < 0.0f ? -at[i] : at[i]);
        if (inside < least) least = inside, axis = i;
    }
    side[axis] = at[axis] < 0.0f ? -1.0f : 1.0f;
    noh_quat_rotate(b->rotation, side, side);
    take(n, distance, side);
}

static void take_capsule(nearest *n, const noh_ray *ray, const noh_capsule *c)
{
    const float distance = noh_ray_capsule(ray, c->from, c->to, c->radius);
    float at[3], along[2], axis[3], normal[3];
    if (!(distance > 0.0f)) return;
    noh_madd3(ray->from, distance, ray->direction, at);
    noh_segments_closest(c->from, c->to, at, at, along);
    noh_sub3(c->to, c->from, axis);
    noh_madd3(c->from, along[0], axis, axis);
    noh_sub3(at, axis, normal);
    noh_normalize3(normal, up);
    take(n, distance, normal);
}

static void take_field(nearest *n, const noh_ray *ray, const noh_field *f)
{
    float height, normal[3];
    if (!noh_field_height(f, ray->from[0], ray->from[2], &height, normal)) return;
    if (ray->from[1] - height <= ray->distance_max) take(n, ray->from[1] - height, normal);
}

/* The nearest ground of a world's own shapes. */
static nearest look_at_shapes(const noh_world *w, const noh_ray *ray)
{
    nearest n = { -1.0f, { 0.0f, 1.0f, 0.0f } };
    for (uint32_t i = 0; i < w->plane_count; i++) take_plane(&n, ray, &w->planes[i]);
    for (uint32_t i = 0; i < w->box_count; i++) take_box(&n, ray, &w->boxes[i]);
    for (uint32_t i = 0; i < w->capsule_count; i++) take_capsule(&n, ray, &w->capsules[i]);
    if (w->field) take_field(&n, ray, w->field);
    return n;
}

void noh_ground_below_all(const noh_ground *ground, const noh_ray *rays, uint32_t count, noh_world_hit *hits)
{
    noh_world_ray asked[NOH_GROUND_RAYS_MAX];
    const noh_world *w = ground->world;
    NOH_ASSERT(count <= NOH_GROUND_RAYS_MAX);
    memset(asked, 0, sizeof asked);
    for (uint32_t i = 0; i < count; i++) {
        hits[i] = (noh_world_hit){ -1.0f, { 0.0f, 1.0f, 0.0f } };
        if (!ground->below) continue;
        const float depth = rays[i].distance_max;
        const float distance = ground->below(ground->user, rays[i].from, depth, hits[i].normal);
        hits[i].distance = distance >= 0.0f && distance <= depth ? distance : -1.0f;
    }
    if (ground->below || !w || !count) return;
    for (uint32_t i = 0; i < count; i++) asked[i] = (noh_world_ray){ { 0.0f, 0.0f, 0.0f }, rays[i] };
    noh_world_ask_rays(w, asked, count, hits);
    for (uint32_t i = 0; i < count; i++) {
        nearest n = look_at_shapes(w, &rays[i]);
        take(&n, hits[i].distance, hits[i].normal);
        hits[i].distance = n.distance;
        memcpy(hits[i].normal, n.normal, sizeof n.normal);
    }
}

float noh_ground_below(const noh_ground *ground, const float from[3], float depth, float normal[3])
{
    const noh_ray ray = { { from[0], from[1], from[2] }, { 0.0f, -1.0f, 0.0f }, depth };
    noh_world_hit hit;
    NOH_ASSERT(depth >= 0.0f);
    noh_ground_below_all(ground, &ray, 1, &hit);
    memcpy(normal, hit.normal, sizeof hit.normal);
    return hit.distance;
}
