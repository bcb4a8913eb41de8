#include "support/game_physics.h"

#include "core/base/math_internal.h"
#include "life/physics/world_internal.h"
#include "noh/low_life.h"

#include <math.h>
#include <string.h>

/* Rays that go straight down, or level ones, which meet walls. */
static void answer_rays(void *user, const noh_world_ray *rays, uint32_t count, noh_world_hit *hits)
{
    game_physics *g = user;
    const noh_ground ground = { g->shapes, NULL, NULL };
    if (!g->table.threads) {
        g->rays += count;
        g->batches++;
    }
    for (uint32_t i = 0; i < count; i++) {
        const noh_ray *r = &rays[i].ray;
        const float *o = rays[i].origin, at[3] = { o[0] + r->from[0], o[1] + r->from[1], o[2] + r->from[2] };
        float normal[3] = { 0.0f, 1.0f, 0.0f };
        if (r->direction[1] < -0.5f) {
            hits[i].distance = noh_ground_below(&ground, at, r->distance_max, normal);
        } else {
            hits[i].distance = noh_world_wall_ahead(g->shapes, o, r);
            for (int k = 0; k < 3; k++) normal[k] = -r->direction[k];
        }
        memcpy(hits[i].normal, normal, sizeof normal);
        if (g->spoils && g->rays % 2u) hits[i].distance = NAN;
        if (g->spoils && !(g->rays % 2u)) hits[i].normal[1] = 3.0f;
    }
}

/* Answers that break the rules, each in its own way. */
static void spoil(noh_touches *t, uint32_t which)
{
    noh_touch bad = { { { 0.0f, 1.0f, 0.0f }, 1.0f }, 1.0f };
    if (which % 4u == 0) bad.plane.normal[0] = 2.0f;
    if (which % 4u == 1) bad.plane.normal[2] = NAN;
    if (which % 4u == 2) bad.plane.distance = INFINITY;
    if (which % 4u == 3) bad.along = NAN;
    memmove(t->at + 1, t->at, (NOH_TOUCHES_MAX - 1u) * sizeof *t->at);
    t->at[0] = bad;
    t->count++;
    while (t->count < NOH_TOUCHES_MAX) t->at[t->count++] = bad;
    t->count += 5u;
}

static void answer_touches(void *user, const noh_world_body *bodies, uint32_t count, noh_touches *touches)
{
    game_physics *g = user;
    if (!g->table.threads) {
        g->touches += count;
        g->batches++;
    }
    for (uint32_t i = 0; i < count; i++) {
        const noh_world_body *b = &bodies[i];
        const int is_ball = memcmp(b->capsule.from, b->capsule.to, sizeof b->capsule.to) == 0;
        const uint8_t *bytes = (const uint8_t *)b;
        for (size_t k = 0; !g->table.threads && k < sizeof *b; k++) g->hash = (g->hash ^ bytes[k]) * 16777619u;
        touches[i].count = 0;
        for (uint32_t p = 0; p < g->shapes->plane_count; p++) {
            const noh_plane *plane = &g->shapes->planes[p];
            for (int end = 0; end < (is_ball ? 1 : 2); end++) {
                noh_touch *t = &touches[i].at[touches[i].count++];
                t->plane = *plane;
                t->plane.distance = noh_plane_distance(plane, b->origin);
                t->along = end ? -1.0f : 1.0f;
                if (g->spoils) t->along *= 7.0f; /* clamped */
            }
        }
        if (g->spoils) spoil(&touches[i], i);
    }
}

noh_world game_world(game_physics *g, const noh_world *shapes)
{
    noh_world w;
    memset(&w, 0, sizeof w);
    memset(g, 0, sizeof *g);
    g->table = (noh_world_physics){ answer_rays, answer_touches, g, 0 };
    g->shapes = shapes;
    g->hash = 2166136261u;
    w.friction = shapes->friction;
    w.restitution = shapes->restitution;
    w.physics = &g->table;
    return w;
}
