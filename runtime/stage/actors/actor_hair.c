/* actor_hair.c: hair as a modifier of the stage, and hair of the largest heads outside of it. It moves in metres of the
 * model, whatever the scale of the actor. */
#include "life/hair/hair_internal.h"
#include "life/hair/haircut_internal.h"
#include "stage/actors/actor_hair_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/name_internal.h"
#include "core/base/vector_internal.h"
#include "stage/cast/stage_internal.h"
#include "deform/skin/skin_internal.h"

#define KEEPS 1.25f      /* a head with a slot counts as larger by this factor */
#define LEAP_M 0.2f      /* a head that moves farther in a frame, plus LEAP_SPEED, was teleported */
#define LEAP_SPEED 20.0f /* metres per second */

/* State of the modifier; a noh_hair follows. */
typedef struct hair_state {
    uint32_t begun; /* 0: there is no hair yet */
    uint32_t reserved[3];
} hair_state;

/* Hair that moves. */
typedef struct hair_slot {
    noh_hair *hair; /* in_state: in the state of the actor; NULL: none yet */
    uint32_t actor; /* 0: free */
    uint32_t is_wanted;
    float position[3];
    double origin[3]; /* of the stage, that `position` counts from, before any shift of the world */
} hair_slot;

/* One for each head. */
typedef struct hair_rank {
    uint32_t actor;
    float size;   /* pixels per metre, times KEEPS with a slot */
    uint32_t had; /* its slot in the last frame; NOH_NONE */
} hair_rank;

struct noh_actor_hair {
    const noh_actor_hair_desc *desc;
    uint32_t head_count;
    noh_hair_head *heads;
    hair_rank *ranks;
    hair_slot *slots;
    uint32_t *chosen; /* [near_max] heads whose hair moves, the largest first */
};

noh_result noh_actor_hair_desc_make(const noh_haircut *cut, const noh_pack *pack, uint32_t skeleton,
                                    noh_actor_hair_desc *out, noh_error *error)
{
    noh_skeleton s;
    const noh_skeleton_header *header;
    NOH_ASSERT(cut && pack && out);
    memset(out, 0, sizeof *out);
    out->cut = cut;
    out->joint = NOH_NONE;
    out->head_max = out->near_max = 1;
    if (!cut->joint[0]) return NOH_OK;
    const noh_result result = noh_pack_skeleton_at(pack, skeleton, &s, &header, error);
    if (result) return result;
    for (uint32_t i = 0; i < s.joint_count && out->joint == NOH_NONE; i++) {
        if (noh_names_equal(noh_pack_joint_name(pack, skeleton, i), cut->joint)) out->joint = i;
    }
    return out->joint == NOH_NONE
               ? noh_fail(error, NOH_ERR_NOT_FOUND, "the skeleton has no joint with the name that the haircut gives",
                          skeleton, 0)
               : NOH_OK;
}

/* ---- in the stage ---- */

/* How the joint moved from the bind pose, in metres, and the transform of the actor. */
static noh_hair_carrier carrier_in_step(const noh_modifier_work *w, const noh_actor_hair_desc *d)
{
    const noh_stage_kind *kind = w->kind;
    const float metres = d->cut->header->metres;
    noh_hair_carrier c;
    float at[3] = { 0.0f, 0.0f, 0.0f }, bind_at[3], bind[4], turn[4], turned_at[3];
    memset(&c, 0, sizeof c);
    c.rotation[3] = 1.0f;
    if (d->joint < w->skeleton->joint_count) {
        noh_stage_joint_at(kind, w->local, d->joint, c.rotation, at);
        noh_stage_joint_at(kind, w->skeleton->bind_pose, d->joint, bind, bind_at);
        noh_quat_conjugate(bind, bind);
        noh_quat_mul(c.rotation, bind, c.rotation);
        noh_quat_rotate(c.rotation, bind_at, bind_at);
        noh_sub3(at, bind_at, at);
    }
    if (noh_stage_turn(kind, noh_stage_index(kind, noh_stage_actor_of(w->stage, w->actor, NULL)), turn, turned_at)) {
        noh_quat_rotate(turn, at, at);
        noh_madd3(at, 1.0f, turned_at, at);
        noh_quat_mul(turn, c.rotation, c.rotation);
    }
    noh_quat_rotate(w->place.rotation, at, at);
    noh_madd3(at, 1.0f / w->place.scale, w->near_place, at);
    noh_quat_mul(w->place.rotation, c.rotation, c.rotation);
    noh_quat_normalize(c.rotation);
    noh_madd3(c.position, metres, at, c.position);
    memcpy(c.wind, d->wind, sizeof c.wind);
    return c;
}

static void modify(noh_modifier_work *w)
{
    const noh_actor_hair_desc *d = w->user;
    const noh_hair_desc *desc = &d->cut->desc;
    hair_state *state = w->state;
    noh_hair *hair = (noh_hair *)(void *)(state + 1);
    const noh_hair_carrier carrier = carrier_in_step(w, d);
    if (state->begun && noh_modifier_home_moved(w)) {
        float by[3];
        for (int i = 0; i < 3; i++) by[i] = w->home_moved[i] * d->cut->header->metres / w->place.scale;
        noh_hair_shift(hair, by);
    }
    if (w->cut && !noh_hair_carries(&carrier)) state->begun = 0; /* it begins where the head is next known to be */
    if (!state->begun) {
        state->begun = noh_hair_init(hair, noh_hair_size(desc), desc, &carrier, &hair, NULL) == NOH_OK;
    } else if (w->cut) {
        noh_hair_reset(hair, desc, &carrier);
    } else {
        (void)noh_hair_step(hair, desc, &carrier, w->ticks);
    }
}

static const char *check(const void *user, const void *state)
{
    const noh_actor_hair_desc *d = user;
    const hair_state *s = state;
    if (s->begun > 1u) return "state: hair.begun is neither 0 nor 1";
    return s->begun ? noh_hair_check((const noh_hair *)(const void *)(s + 1), &d->cut->desc) : NULL;
}

noh_modifier noh_actor_hair_modifier(const noh_actor_hair_desc *desc)
{
    noh_modifier modifier;
    NOH_ASSERT(desc && desc->cut);
    memset(&modifier, 0, sizeof modifier);
    modifier.name = "hair";
    modifier.modify = modify;
    modifier.check = check;
    modifier.user = desc;
    modifier.state_bytes = (uint32_t)(sizeof(hair_state) + noh_hair_size(&desc->cut->desc));
    return modifier;
}

/* The kind's modifier that simulates this hair. */
static uint32_t modifier_of(const noh_stage_kind *k, const noh_actor_hair_desc *d)
{
    uint32_t i = 0;
    while (i < k->desc->modifier_count && noh_stage_modifiers_of(k)[i].user != d) i++;
    return i;
}

/* ---- memory ---- */

static int is_possible(const noh_actor_hair_desc *d)
{
    return d->cut && d->head_max && d->head_max <= NOH_STAGE_ACTORS_MAX && d->near_max <= NOH_HAIR_NEAR_MAX &&
           noh_hair_size(&d->cut->desc);
}

static noh_actor_hair *carve(noh_arena *arena, const noh_actor_hair_desc *d, uint8_t **hairs)
{
    noh_actor_hair *h = noh_arena_carve(arena, sizeof *h, 16);
    noh_hair_head *heads = noh_arena_carve(arena, d->head_max * sizeof *heads, 16);
    hair_rank *ranks = noh_arena_carve(arena, d->head_max * sizeof *ranks, 16);
    hair_slot *slots = noh_arena_carve(arena, d->near_max * sizeof *slots, 16);
    uint32_t *chosen = noh_arena_carve(arena, d->near_max * sizeof *chosen, 16);
    *hairs = noh_arena_carve(arena, d->in_state ? 0 : d->near_max * noh_hair_size(&d->cut->desc), 16);
    if (!h) return NULL;
    *h = (noh_actor_hair){ d, 0, heads, ranks, slots, chosen };
    return h;
}

size_t noh_actor_hair_size(const noh_actor_hair_desc *desc)
{
    noh_arena arena = noh_arena_measure();
    uint8_t *hairs;
    if (!desc || !is_possible(desc)) return 0;
    (void)carve(&arena, desc, &hairs);
    return arena.used;
}

noh_result noh_actor_hair_init(void *memory, size_t bytes, const noh_actor_hair_desc *desc, noh_actor_hair **hair,
                               noh_error *error)
{
    noh_arena arena;
    uint8_t *hairs;
    NOH_ASSERT(desc && hair);
    if (!is_possible(desc)) {
        return noh_fail(error, NOH_ERR_ARG, "hair: the desc has no haircut, or head_max or near_max is out of range", 0,
                        0);
    }
    const noh_result result = noh_arena_open(&arena, memory, bytes, noh_actor_hair_size(desc), error);
    if (result) return result;
    noh_actor_hair *h = carve(&arena, desc, &hairs);
    const size_t each = noh_hair_size(&desc->cut->desc);
    for (uint32_t i = 0; i < desc->near_max; i++) {
        memset(&h->slots[i], 0, sizeof h->slots[i]);
        if (!desc->in_state) h->slots[i].hair = (noh_hair *)(void *)(hairs + i * each);
    }
    *hair = h;
    return NOH_OK;
}

/* ---- visible heads ---- */

static float moves_at(float pixels_per_metre)
{
    const float t = pixels_per_metre / NOH_HAIR_MOVING_PIXELS - 1.0f;
    return t <= 0.0f ? 0.0f : t < 1.0f ? t * t * (3.0f - 2.0f * t) : 1.0f;
}

static uint32_t slot_of(const noh_actor_hair *h, uint32_t actor)
{
    for (uint32_t i = 0; i < h->desc->near_max; i++) {
        if (h->slots[i].actor == actor) return i;
    }
    return NOH_NONE;
}

/* Two bytes of a complexion: more melanin of its hair, and red. */
static uint16_t melanin_of(const noh_stage *stage, const noh_appearance *look)
{
    const float bytes = look->user[1];
    const int is_there = stage->desc.user_values == NOH_USER_COMPLEXION && bytes > 0.0f && bytes < 16777216.0f;
    return is_there ? (uint16_t)((uint32_t)bytes & 0xffffu) : 0u;
}

/* The head of an actor as the last frame showed it. Returns 0 if it was not shown. */
static int see(const noh_actor_hair_desc *d, const noh_stage *stage, noh_actor actor, noh_hair_head *out)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    if (!a || stage->shown[a - stage->actors].frame != stage->frame) return 0;
    const noh_stage_shown *shown = &stage->shown[a - stage->actors];
    const float units = 1.0f / d->cut->header->metres;
    float to_joint[12] = { units, 0.0f, 0.0f, 0.0f, 0.0f, units, 0.0f, 0.0f, 0.0f, 0.0f, units, 0.0f };
    float joint[12], rotation[4], at[3];
    memcpy(joint, shown->world, sizeof joint);
    if (d->joint < k->skeleton.joint_count && noh_stage_joint(stage, actor, d->joint, joint, NULL) == NOH_OK) {
        noh_stage_joint_at(k, k->skeleton.bind_pose, d->joint, rotation, at);
        noh_quat_conjugate(rotation, rotation);
        for (int i = 0; i < 3; i++) {
            float axis[3] = { i == 0 ? units : 0.0f, i == 1 ? units : 0.0f, i == 2 ? units : 0.0f };
            noh_quat_rotate(rotation, axis, axis);
            for (int r = 0; r < 3; r++) to_joint[4 * r + i] = axis[r];
        }
        noh_quat_rotate(rotation, at, at);
        for (int r = 0; r < 3; r++) to_joint[4 * r + 3] = -at[r];
    }
    noh_matrix_multiply(joint, to_joint, out->world);
    out->pixels_per_metre = shown->scale / d->cut->header->metres * noh_stage_size(stage, a);
    out->views = k->finer.hidden ? 0u : (uint16_t)shown->views; /* without its head yet */
    out->melanin = melanin_of(stage, &a->look);
    return 1;
}

static void see_all(noh_actor_hair *h, const noh_stage *s)
{
    const noh_actor_hair_desc *d = h->desc;
    const noh_stage_kind *k = &s->kinds[d->kind];
    h->head_count = 0;
    for (uint32_t i = 0; i < k->desc->actor_count && h->head_count < d->head_max; i++) {
        const noh_actor actor = noh_stage_actor_at(s, k->first_actor + i);
        noh_hair_head *head = &h->heads[h->head_count];
        if (!actor.id || !see(d, s, actor, head)) continue;
        if (!noh_haircut_strips(d->cut, head->pixels_per_metre)) continue;
        const uint32_t slot = slot_of(h, actor.id);
        head->moves = d->in_state ? 1.0f : moves_at(head->pixels_per_metre);
        head->slot = NOH_NONE;
        h->ranks[h->head_count++] = (hair_rank){ actor.id, head->pixels_per_metre * (slot == NOH_NONE ? 1.0f : KEEPS),
                                                 slot };
    }
}

/* ---- whose hair moves ---- */

/* Fill `chosen` with the largest heads; among equals the first ones win. Returns their number. */
static uint32_t choose(noh_actor_hair *h)
{
    const uint32_t most = h->desc->near_max;
    uint32_t count = 0;
    for (uint32_t i = 0; i < h->head_count && most; i++) {
        const float size = h->ranks[i].size;
        uint32_t at;
        if (!(h->heads[i].moves > 0.0f)) continue;
        if (count == most && !(size > h->ranks[h->chosen[count - 1u]].size)) continue;
        if (count < most) count++;
        for (at = count - 1u; at && size > h->ranks[h->chosen[at - 1u]].size; at--) h->chosen[at] = h->chosen[at - 1u];
        h->chosen[at] = i;
    }
    return count;
}

/* Metres of the hair in one unit of the world. */
static float metres_of(const noh_hair_head *head)
{
    const float *w = head->world, scale = noh_sqrt(w[0] * w[0] + w[4] * w[4] + w[8] * w[8]);
    return scale > 0.0f ? 1.0f / scale : 0.0f;
}

static noh_hair_carrier carrier_of(const noh_actor_hair_desc *d, const noh_hair_head *head)
{
    noh_dual_quaternion turned;
    noh_hair_carrier c;
    float m[12];
    const float units = metres_of(head);
    for (int i = 0; i < 12; i++) m[i] = head->world[i] * units;
    noh_dual_quaternion_from_matrix(m, &turned);
    memcpy(c.rotation, turned.real, sizeof c.rotation);
    for (int i = 0; i < 3; i++) c.position[i] = m[4 * i + 3];
    memcpy(c.wind, d->wind, sizeof c.wind);
    return c;
}

static int leaps(const hair_slot *s, const noh_hair_carrier *c, uint32_t ticks)
{
    float moved[3];
    const float most = LEAP_M + LEAP_SPEED * (float)ticks / (float)NOH_TICKS_PER_SECOND;
    noh_sub3(c->position, s->position, moved);
    return noh_dot3(moved, moved) > most * most;
}

/* Move the last position of the head to the present origin of the stage. metres: as metres_of */
static void follow_origin(hair_slot *s, const noh_stage *stage, float metres)
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

static void simulate(noh_actor_hair *h, uint32_t index, const noh_stage *stage, uint32_t ticks)
{
    const noh_hair_desc *desc = &h->desc->cut->desc;
    noh_hair_head *head = &h->heads[index];
    hair_slot *s = &h->slots[head->slot];
    const noh_hair_carrier carrier = carrier_of(h->desc, head);
    follow_origin(s, stage, metres_of(head));
    if (s->actor != h->ranks[index].actor) {
        s->actor = noh_hair_init(s->hair, noh_hair_size(desc), desc, &carrier, &s->hair, NULL) == NOH_OK
                       ? h->ranks[index].actor
                       : 0;
        if (!s->actor) head->slot = NOH_NONE;
    } else if (leaps(s, &carrier, ticks)) {
        noh_hair_reset(s->hair, desc, &carrier);
    } else {
        (void)noh_hair_step(s->hair, desc, &carrier, ticks);
    }
    if (noh_hair_carries(&carrier)) memcpy(s->position, carrier.position, sizeof s->position);
}

/* Refer to the hair that the stage simulates. */
static void refer(noh_actor_hair *h, uint32_t index, noh_stage *stage, uint32_t modifier)
{
    const noh_actor actor = { h->ranks[index].actor };
    hair_slot *s = &h->slots[h->heads[index].slot];
    hair_state *state = noh_actor_modifier(stage, actor, modifier);
    s->actor = actor.id;
    s->hair = state && state->begun ? (noh_hair *)(void *)(state + 1) : NULL;
}

void noh_actor_hair_frame(noh_actor_hair *hair, noh_stage *stage, uint32_t ticks)
{
    uint32_t count, free_slot = 0;
    NOH_ASSERT(hair && stage && hair->desc->kind < stage->desc.kind_count);
    const noh_actor_hair_desc *d = hair->desc;
    const uint32_t modifier = modifier_of(&stage->kinds[d->kind], d);
    NOH_ASSERT(!d->in_state || modifier < stage->kinds[d->kind].desc->modifier_count);
    see_all(hair, stage);
    count = choose(hair);
    for (uint32_t i = 0; i < d->near_max; i++) hair->slots[i].is_wanted = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t had = hair->ranks[hair->chosen[i]].had;
        hair->heads[hair->chosen[i]].slot = had;
        if (had != NOH_NONE) hair->slots[had].is_wanted = 1;
    }
    for (uint32_t i = 0; i < count; i++) {
        noh_hair_head *head = &hair->heads[hair->chosen[i]];
        while (head->slot == NOH_NONE && hair->slots[free_slot].is_wanted) free_slot++;
        if (head->slot == NOH_NONE) head->slot = free_slot;
        hair->slots[head->slot].is_wanted = 1;
        if (d->in_state) {
            refer(hair, hair->chosen[i], stage, modifier);
        } else {
            simulate(hair, hair->chosen[i], stage, ticks);
        }
    }
    for (uint32_t i = 0; i < d->near_max; i++) {
        if (!hair->slots[i].is_wanted) hair->slots[i].actor = 0;
    }
}

/* ---- for drawing ---- */

const noh_hair_head *noh_actor_hair_heads(const noh_actor_hair *hair, uint32_t *count)
{
    NOH_ASSERT(hair && count);
    *count = hair->head_count;
    return hair->heads;
}

void noh_actor_hair_points(const noh_actor_hair *hair, uint32_t head, float *points)
{
    NOH_ASSERT(hair && points && head < hair->head_count);
    const noh_hair_head *b = &hair->heads[head];
    const noh_hair_desc *d = &hair->desc->cut->desc;
    const size_t count = (size_t)d->hair_count * d->point_count * 3u;
    const noh_hair *moved = b->slot == NOH_NONE ? NULL : hair->slots[b->slot].hair;
    if (!moved) {
        memcpy(points, d->rest, count * sizeof *points);
        return;
    }
    noh_hair_points(moved, d, points);
    for (size_t i = 0; i < count && b->moves < 1.0f; i++) points[i] = d->rest[i] + b->moves * (points[i] - d->rest[i]);
}

const noh_actor_hair_desc *noh_actor_hair_desc_of(const noh_actor_hair *hair)
{
    NOH_ASSERT(hair);
    return hair->desc;
}
