/* world.c: checks of a world, its height field, and rays against it. */
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"
#include "life/physics/world_internal.h"
#include "life/physics/world_ask_internal.h"
#include "life/physics/shape_internal.h"

#define NO_HIT 1e30f
#define STEEP 0.5f /* the normal's y of a plane that is a wall, at most */

/* ---- checks ---- */

static int is_unit(const float *v, int n)
{
    float sum = 0.0f;
    for (int i = 0; i < n; i++) sum += v[i] * v[i];
    return sum > 0.99f && sum < 1.01f;
}

static int is_size(float x)
{
    return x >= 0.0f && noh_is_finite(x);
}

static int good_box(const noh_obb *b)
{
    return noh_is_finite3(b->centre) && is_size(b->half[0]) && is_size(b->half[1]) && is_size(b->half[2]) &&
           is_unit(b->rotation, 4);
}

static int good_field(const noh_field *f)
{
    return f->heights && f->width >= 2 && f->width <= 65536u && f->depth >= 2 && f->depth <= 65536u &&
           noh_is_finite3(f->origin) && f->spacing > 0.0f && noh_is_finite(f->spacing) && noh_is_finite(f->scale);
}

noh_result noh_world_check(const noh_world *w, noh_error *error)
{
    if (w->plane_count > NOH_OBSTACLES_MAX || w->capsule_count > NOH_OBSTACLES_MAX ||
        w->box_count > NOH_OBSTACLES_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "a world has more than NOH_OBSTACLES_MAX obstacles of one kind", 0,
                        NOH_OBSTACLES_MAX);
    }
    for (uint32_t i = 0; i < w->plane_count; i++) {
        if (!is_unit(w->planes[i].normal, 3) || !noh_is_finite(w->planes[i].distance)) {
            return noh_fail(error, NOH_ERR_ARG, "a plane's normal is not unit, or its distance not finite", i, 0);
        }
    }
    for (uint32_t i = 0; i < w->capsule_count; i++) {
        const noh_capsule *c = &w->capsules[i];
        if (!noh_is_finite3(c->from) || !noh_is_finite3(c->to) || !is_size(c->radius)) {
            return noh_fail(error, NOH_ERR_ARG, "a capsule has a number that is not finite, or a radius below 0", i, 0);
        }
    }
    for (uint32_t i = 0; i < w->box_count; i++) {
        if (!good_box(&w->boxes[i])) {
            return noh_fail(error, NOH_ERR_ARG, "a box has a number out of its range", i, 0);
        }
    }
    if (w->field && !good_field(w->field)) {
        return noh_fail(error, NOH_ERR_ARG, "a height field has no area, or a number that is not finite", 0, 0);
    }
    if (w->physics && (!w->physics->rays || !w->physics->touches)) {
        return noh_fail(error, NOH_ERR_ARG, "the physics of a world lacks its function `rays` or `touches`", 0, 0);
    }
    if (!is_size(w->friction))
        return noh_fail(error, NOH_ERR_ARG, "friction of a world is below 0 or not finite", 0, 0);
    if (!(w->restitution >= 0.0f && w->restitution <= 1.0f))
        return noh_fail(error, NOH_ERR_ARG, "restitution of a world must be 0 to 1", 0, 0);
    return NOH_OK;
}

/* ---- height field ---- */

/* The four heights of a cell; base: y of height 0. */
static void corners_of(const noh_field *f, uint32_t column, uint32_t row, float base, float h[4])
{
    const uint16_t *at = f->heights + (size_t)row * f->width + column;
    h[0] = (float)at[0] * f->scale + base;
    h[1] = (float)at[1] * f->scale + base;
    h[2] = (float)at[f->width] * f->scale + base;
    h[3] = (float)at[f->width + 1u] * f->scale + base;
}

/* The cell, and the position within it. */
static uint32_t cell_of(float at, uint32_t count, float *part)
{
    uint32_t cell = (uint32_t)at;
    cell = cell > count - 2u ? count - 2u : cell;
    *part = at - (float)cell;
    return cell;
}

/* Height at u, v in a cell. */
static void height_in_cell(const noh_field *f, const float h[4], float u, float v, float *height, float normal[3])
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    *height = (h[0] + (h[1] - h[0]) * u) * (1.0f - v) + (h[2] + (h[3] - h[2]) * u) * v;
    if (normal) {
        normal[0] = -((h[1] - h[0]) * (1.0f - v) + (h[3] - h[2]) * v);
        normal[1] = f->spacing;
        normal[2] = -((h[2] - h[0]) * (1.0f - u) + (h[3] - h[1]) * u);
        noh_normalize3(normal, up);
    }
}

int noh_field_height(const noh_field *f, float x, float z, float *height, float normal[3])
{
    const float column = (x - f->origin[0]) / f->spacing, row = (z - f->origin[2]) / f->spacing;
    float u, v, h[4];
    if (!(column >= 0.0f && row >= 0.0f && column <= (float)(f->width - 1u) && row <= (float)(f->depth - 1u))) {
        return 0;
    }
    const uint32_t c = cell_of(column, f->width, &u), r = cell_of(row, f->depth, &v);
    corners_of(f, c, r, f->origin[1], h);
    height_in_cell(f, h, u, v, height, normal);
    return 1;
}

/* A double has digits that a float far from the origin lacks. */
static double along_grid(const noh_field *f, const float origin[3], int axis, float at)
{
    return (((double)origin[axis] - (double)f->origin[axis]) + (double)at) / (double)f->spacing;
}

int noh_field_height_about(const noh_field *f, const float origin[3], float x, float z, float *height, float normal[3])
{
    const double column = along_grid(f, origin, 0, x), row = along_grid(f, origin, 2, z);
    float h[4];
    if (!(column >= 0.0 && row >= 0.0 && column <= (double)(f->width - 1u) && row <= (double)(f->depth - 1u))) {
        return 0;
    }
    const uint32_t c = (uint32_t)column < f->width - 2u ? (uint32_t)column : f->width - 2u;
    const uint32_t r = (uint32_t)row < f->depth - 2u ? (uint32_t)row : f->depth - 2u;
    corners_of(f, c, r, f->origin[1] - origin[1], h);
    height_in_cell(f, h, (float)(column - (double)c), (float)(row - (double)r), height, normal);
    return 1;
}

float noh_plane_distance(const noh_plane *p, const float origin[3])
{
    double distance = (double)p->distance;
    for (int i = 0; i < 3; i++) distance -= (double)p->normal[i] * (double)origin[i];
    return (float)distance;
}

/* ---- rays against all of it ---- */

/* The distance to the nearest box or capsule; NO_HIT: there is none. */
static float ray_shapes(const noh_world *w, const float origin[3], const noh_ray *ray)
{
    float nearest = NO_HIT;
    for (uint32_t i = 0; i < w->box_count; i++) {
        noh_obb box = w->boxes[i];
        noh_sub3(box.centre, origin, box.centre);
        const float far = noh_ray_obb(ray, &box);
        if (far > 0.0f && far < nearest) nearest = far;
    }
    for (uint32_t i = 0; i < w->capsule_count; i++) {
        const noh_capsule *c = &w->capsules[i];
        float from[3], to[3];
        noh_sub3(c->from, origin, from);
        noh_sub3(c->to, origin, to);
        const float far = noh_ray_capsule(ray, from, to, c->radius);
        if (far > 0.0f && far < nearest) nearest = far;
    }
    return nearest;
}

static int ask_ray(const noh_world *w, const float origin[3], const noh_ray *ray, noh_world_hit *hit)
{
    noh_world_ray asked = { { origin[0], origin[1], origin[2] }, *ray };
    noh_world_ask_rays(w, &asked, 1, hit);
    return hit->distance > 0.0f;
}

int noh_world_ground_below(const noh_world *w, const float origin[3], const float at[3], float top, float *height)
{
    const noh_ray down = { { at[0], top, at[2] }, { 0.0f, -1.0f, 0.0f }, NO_HIT };
    noh_world_hit hit;
    float found = top - ray_shapes(w, origin, &down), y;
    for (uint32_t i = 0; i < w->plane_count; i++) {
        const float *n = w->planes[i].normal;
        if (n[1] < 0.1f) continue;
        y = (noh_plane_distance(&w->planes[i], origin) - n[0] * at[0] - n[2] * at[2]) / n[1];
        if (y <= top && y > found) found = y;
    }
    if (w->field && noh_field_height_about(w->field, origin, at[0], at[2], &y, NULL) && y <= top && y > found) {
        found = y;
    }
    if (ask_ray(w, origin, &down, &hit) && top - hit.distance > found) found = top - hit.distance;
    *height = found;
    return found > -1e29f;
}

float noh_world_wall_ahead(const noh_world *w, const float origin[3], const noh_ray *ray)
{
    noh_world_hit hit;
    float nearest = ray_shapes(w, origin, ray);
    for (uint32_t i = 0; i < w->plane_count; i++) {
        const float *n = w->planes[i].normal, towards = -noh_dot3(n, ray->direction);
        const float over = noh_dot3(n, ray->from) - noh_plane_distance(&w->planes[i], origin);
        if (n[1] < STEEP && towards > 1e-3f && over > 0.0f && over < nearest * towards) nearest = over / towards;
    }
    if (ask_ray(w, origin, ray, &hit) && hit.normal[1] < STEEP && hit.distance < nearest) nearest = hit.distance;
    return nearest;
}
