/* wigs.c: whose hair of a kind moves. */
#include "life/hair/haircut.h"
#include "stage/actors/wigs.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"

#include <string.h>

#include "core/base/assert.h"
#include "life/hair/hair_internal.h"
#include "life/physics/vector_internal.h"
#include "stage/cast/stage_internal.h"

#define KEEPS 1.25f      /* who has hair that moves counts as that much larger */
#define LEAP_M 0.2f      /* in one frame, on top of LEAP_SPEED: not a movement */
#define LEAP_SPEED 20.0f /* metres a second */

/* Hair that moves. */
typedef struct wig_slot {
    uint64_t actor; /* 0: free */
    noh_hair *hair;
    float position[3];
    uint32_t is_wanted;
    double origin[3]; /* of the stage, which that counts from; in the world as it was before the stage shifted it */
} wig_slot;

/* Beside each body. */
typedef struct wig_rank {
    uint64_t actor;
    float size; /* pixels a metre, and a little more for who has a slot */
    uint32_t had;
} wig_rank;

struct noh_wigs {
    noh_wigs_desc desc;
    uint32_t body_count;
    noh_wigs_body *bodies;
    wig_rank *ranks;
    wig_slot *slots;
    uint32_t chosen[NOH_WIGS_NEAR_MAX];
};

/* ---- memory ---- */

static int is_possible(const noh_wigs_desc *d)
{
    return d->wig && d->actor_max && d->actor_max <= NOH_STAGE_ACTORS_MAX && d->near_max <= NOH_WIGS_NEAR_MAX &&
           noh_hair_size(&d->wig->cut->desc);
}

static noh_wigs *carve(noh_arena *arena, const noh_wigs_desc *d, uint8_t **hairs)
{
    noh_wigs *w = noh_arena_carve(arena, sizeof *w, 16);
    noh_wigs_body *bodies = noh_arena_carve(arena, d->actor_max * sizeof *bodies, 16);
    wig_rank *ranks = noh_arena_carve(arena, d->actor_max * sizeof *ranks, 16);
    wig_slot *slots = noh_arena_carve(arena, d->near_max * sizeof *slots, 16);
    *hairs = noh_arena_carve(arena, d->near_max * noh_hair_size(&d->wig->cut->desc), 16);
    if (!w) return NULL;
    memset(w, 0, sizeof *w);
    w->bodies = bodies;
    w->ranks = ranks;
    w->slots = slots;
    return w;
}

size_t noh_wigs_size(const noh_wigs_desc *desc)
{
    noh_arena arena = noh_arena_measure();
    uint8_t *hairs;
    if (!desc || !is_possible(desc)) return 0;
    (void)carve(&arena, desc, &hairs);
    return arena.used;
}

noh_result noh_wigs_init(void *memory, size_t bytes, const noh_wigs_desc *desc, noh_wigs **wigs, noh_error *error)
{
    noh_arena arena;
    uint8_t *hairs;
    NOH_ASSERT(desc && wigs);
    if (!is_possible(desc)) {
        return noh_fail(error, NOH_ERR_ARG, "wigs: no wig, actor_max, or near_max out of its range", 0, 0);
    }
    const noh_result result = noh_arena_open(&arena, memory, bytes, noh_wigs_size(desc), error);
    if (result) return result;
    noh_wigs *w = carve(&arena, desc, &hairs);
    const size_t each = noh_hair_size(&desc->wig->cut->desc);
    w->desc = *desc;
    for (uint32_t i = 0; i < desc->near_max; i++) {
        memset(&w->slots[i], 0, sizeof w->slots[i]);
        w->slots[i].hair = (noh_hair *)(void *)(hairs + i * each);
    }
    *wigs = w;
    return NOH_OK;
}

/* ---- who is seen ---- */

static float moves_at(float pixels_per_metre)
{
    const float t = pixels_per_metre / NOH_WIGS_MOVING_PIXELS - 1.0f;
    return t <= 0.0f ? 0.0f : t < 1.0f ? t * t * (3.0f - 2.0f * t) : 1.0f;
}

static uint32_t slot_of(const noh_wigs *w, uint64_t actor)
{
    for (uint32_t i = 0; i < w->desc.near_max; i++) {
        if (w->slots[i].actor == actor) return i;
    }
    return NOH_NONE;
}

static void see(noh_wigs *w, const noh_stage *s)
{
    const noh_wig *wig = w->desc.wig;
    const noh_stage_kind *k = &s->kinds[w->desc.kind];
    w->body_count = 0;
    for (uint32_t i = 0; i < k->desc->actor_count && w->body_count < w->desc.actor_max; i++) {
        const noh_actor actor = noh_stage_actor_at(s, k->first_actor + i);
        noh_wigs_body *b = &w->bodies[w->body_count];
        if (!actor.id || !noh_wig_seen(wig, s, actor, b->world, &b->pixels_per_metre, &b->views)) continue;
        if (!noh_haircut_strips(wig->cut, b->pixels_per_metre)) continue;
        const uint32_t slot = slot_of(w, actor.id);
        b->moves = moves_at(b->pixels_per_metre);
        b->slot = NOH_NONE;
        w->ranks[w->body_count++] = (wig_rank){ actor.id, b->pixels_per_metre * (slot == NOH_NONE ? 1.0f : KEEPS),
                                                slot };
    }
}

/* ---- whose hair moves ---- */

/* chosen: the largest, by size, among equals those that come first. Returns how many. */
static uint32_t choose(noh_wigs *w)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < w->body_count && w->desc.near_max; i++) {
        const float size = w->ranks[i].size;
        uint32_t at;
        if (!(w->bodies[i].moves > 0.0f)) continue;
        if (count == w->desc.near_max && !(size > w->ranks[w->chosen[count - 1u]].size)) continue;
        if (count < w->desc.near_max) count++;
        for (at = count - 1u; at && size > w->ranks[w->chosen[at - 1u]].size; at--) w->chosen[at] = w->chosen[at - 1u];
        w->chosen[at] = i;
    }
    return count;
}

/* Of a unit of the world, as the hair counts. */
static float metres_of(const noh_wigs_body *b)
{
    const float *w = b->world, scale = noh_sqrt(w[0] * w[0] + w[4] * w[4] + w[8] * w[8]);
    return scale > 0.0f ? 1.0f / scale : 0.0f;
}

static noh_hair_carrier carrier_of(const noh_wig *wig, const noh_wigs_body *b)
{
    noh_dual_quaternion turned;
    noh_hair_carrier c;
    float m[12];
    const float *w = b->world;
    const float units = metres_of(b);
    for (int i = 0; i < 12; i++) m[i] = w[i] * units;
    noh_dual_quaternion_from_matrix(m, &turned);
    memcpy(c.rotation, turned.real, sizeof c.rotation);
    for (int i = 0; i < 3; i++) c.position[i] = m[4 * i + 3];
    memcpy(c.wind, wig->wind, sizeof c.wind);
    return c;
}

static int leaps(const wig_slot *s, const noh_hair_carrier *c, uint32_t ticks)
{
    float moved[3];
    const float most = LEAP_M + LEAP_SPEED * (float)ticks / (float)NOH_TICKS_PER_SECOND;
    noh_sub3(c->position, s->position, moved);
    return noh_dot3(moved, moved) > most * most;
}

/* Where the head was, as the stage's origin is now; metres: of a unit. */
static void follow_origin(wig_slot *s, const noh_stage *stage, float metres)
{
    float by[3];
    for (int i = 0; i < 3; i++) {
        const double origin = (double)stage->origin[i] + stage->shifted[i];
        by[i] = (float)(origin - s->origin[i]) * metres;
        s->origin[i] = origin;
    }
    if (s->actor && (by[0] != 0.0f || by[1] != 0.0f || by[2] != 0.0f)) {
        noh_hair_shift(s->hair, by);
        noh_sub3(s->position, by, s->position);
    }
}

static void move(noh_wigs *w, uint32_t body, const noh_stage *stage, uint32_t ticks)
{
    const noh_hair_desc *desc = &w->desc.wig->cut->desc;
    noh_wigs_body *b = &w->bodies[body];
    wig_slot *s = &w->slots[b->slot];
    const noh_hair_carrier carrier = carrier_of(w->desc.wig, b);
    follow_origin(s, stage, metres_of(b));
    if (s->actor != w->ranks[body].actor) {
        s->actor = noh_hair_init(s->hair, noh_hair_size(desc), desc, &carrier, &s->hair, NULL) == NOH_OK
                       ? w->ranks[body].actor
                       : 0;
        if (!s->actor) b->slot = NOH_NONE;
    } else if (leaps(s, &carrier, ticks)) {
        noh_hair_reset(s->hair, desc, &carrier);
    } else {
        (void)noh_hair_step(s->hair, desc, &carrier, ticks);
    }
    memcpy(s->position, carrier.position, sizeof s->position);
}

void noh_wigs_frame(noh_wigs *wigs, noh_stage *stage, uint32_t ticks)
{
    uint32_t count, free_slot = 0;
    NOH_ASSERT(wigs && stage && wigs->desc.kind < stage->desc.kind_count);
    see(wigs, stage);
    count = choose(wigs);
    for (uint32_t i = 0; i < wigs->desc.near_max; i++) wigs->slots[i].is_wanted = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t had = wigs->ranks[wigs->chosen[i]].had;
        wigs->bodies[wigs->chosen[i]].slot = had;
        if (had != NOH_NONE) wigs->slots[had].is_wanted = 1;
    }
    for (uint32_t i = 0; i < count; i++) {
        noh_wigs_body *b = &wigs->bodies[wigs->chosen[i]];
        while (b->slot == NOH_NONE && wigs->slots[free_slot].is_wanted) free_slot++;
        if (b->slot == NOH_NONE) b->slot = free_slot;
        wigs->slots[b->slot].is_wanted = 1;
        move(wigs, wigs->chosen[i], stage, ticks);
    }
    for (uint32_t i = 0; i < wigs->desc.near_max; i++) {
        if (!wigs->slots[i].is_wanted) wigs->slots[i].actor = 0;
    }
}

/* ---- what is drawn ---- */

const noh_wigs_body *noh_wigs_bodies(const noh_wigs *wigs, uint32_t *count)
{
    NOH_ASSERT(wigs && count);
    *count = wigs->body_count;
    return wigs->bodies;
}

void noh_wigs_points(const noh_wigs *wigs, uint32_t body, float *points)
{
    NOH_ASSERT(wigs && points && body < wigs->body_count);
    const noh_wigs_body *b = &wigs->bodies[body];
    const noh_hair_desc *d = &wigs->desc.wig->cut->desc;
    const size_t count = (size_t)d->hair_count * d->point_count * 3u;
    if (b->slot == NOH_NONE) {
        memcpy(points, d->rest, count * sizeof *points);
        return;
    }
    noh_hair_points(wigs->slots[b->slot].hair, d, points);
    for (size_t i = 0; i < count && b->moves < 1.0f; i++) points[i] = d->rest[i] + b->moves * (points[i] - d->rest[i]);
}

const noh_wigs_desc *noh_wigs_desc_of(const noh_wigs *wigs)
{
    NOH_ASSERT(wigs);
    return &wigs->desc;
}
