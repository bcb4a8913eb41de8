/* world_ask.c: questions to the physics of a world, and which of its answers count. */
#include "life/physics/world_ask_internal.h"

#include "core/base/vector_internal.h"

int noh_world_asks(const noh_world *w)
{
    return w->physics != NULL;
}

int noh_world_may_ask(const noh_world *w, uint32_t job_count)
{
    return !w || !w->physics || w->physics->threads || job_count <= 1u;
}

static int is_normal(const float v[3])
{
    const float square = noh_dot3(v, v);
    return square > 0.99f && square < 1.01f;
}

/* ---- rays ---- */

static void keep_hit(const noh_ray *ray, noh_world_hit *hit)
{
    const int good = hit->distance >= 0.0f && hit->distance <= ray->distance_max && is_normal(hit->normal);
    if (!good) hit->distance = -1.0f;
}

void noh_world_ask_rays(const noh_world *w, const noh_world_ray *rays, uint32_t count, noh_world_hit *hits)
{
    for (uint32_t i = 0; i < count; i++) hits[i] = (noh_world_hit){ -1.0f, { 0.0f, 1.0f, 0.0f } };
    if (!w->physics || !count) return;
    w->physics->rays(w->physics->user, rays, count, hits);
    for (uint32_t i = 0; i < count; i++) keep_hit(&rays[i].ray, &hits[i]);
}

/* ---- touches ---- */

static void keep_touches(noh_touches *t)
{
    const uint32_t count = t->count < NOH_TOUCHES_MAX ? t->count : NOH_TOUCHES_MAX;
    t->count = 0;
    for (uint32_t i = 0; i < count; i++) {
        noh_touch touch = t->at[i];
        if (!is_normal(touch.plane.normal) || !noh_is_finite(touch.plane.distance) || !noh_is_finite(touch.along)) {
            continue;
        }
        touch.along = touch.along < -1.0f ? -1.0f : touch.along > 1.0f ? 1.0f : touch.along;
        t->at[t->count++] = touch;
    }
}

void noh_world_ask_touches(const noh_world *w, const noh_world_body *bodies, uint32_t count, noh_touches *touches)
{
    for (uint32_t i = 0; i < count; i++) touches[i].count = 0;
    if (!w->physics || !count) return;
    w->physics->touches(w->physics->user, bodies, count, touches);
    for (uint32_t i = 0; i < count; i++) keep_touches(&touches[i]);
}
