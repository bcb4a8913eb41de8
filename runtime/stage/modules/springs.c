/* springs.c: chains of joints that swing, as a modifier or a module.
 *
 * They swing in the world, in the model's units and from the model's scale: what a place says is divided by its scale,
 * so an actor of twice the size swings as the small one does, twice as far. */
#include "life/physics/spring_internal.h"
#include "life/physics/world_ask_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/vector_internal.h"
#include "stage/cast/stage_internal.h"
#include "stage/modules/springs_internal.h"

/* A chain as jobs use it. */
typedef struct swing {
    noh_spring_desc desc; /* the first: noh_spring_move.desc leads to its swing */
    uint32_t first_row;
    uint32_t collides;
    uint32_t state; /* where its spring lies in the state of an actor */
    uint32_t after; /* chains before this one that must have swung: what carries it is of the last of them */
    float length;   /* stretched out, metres */
} swing;

#define TOGETHER 8u /* chains that are stepped in one call */

/* What a job needs of them. */
typedef struct together {
    uint32_t count;
    noh_spring_move moves[TOGETHER];
    noh_spring_carrier carriers[TOGETHER];
    float shares[TOGETHER];
} together;

/* The memory of a job. */
typedef struct workspace {
    float *scratch; /* of noh_spring_step */
    together *chains;
    noh_spring_collider *all;     /* [collider_count] */
    noh_spring_collider *near_by; /* [TOGETHER][collider_count] */
    float *rotations;             /* [TOGETHER][joints of the longest chain][4] */
    noh_springs_world asks;       /* with a world: [TOGETHER][joints of the longest chain] */
} workspace;

struct noh_springs {
    uint32_t chain_count, state_bytes, scratch_bytes, longest;
    uint16_t collider_count, joint_count;
    float metres; /* of one unit of the skeleton */
    const noh_world *world;
    uint32_t *joints;             /* [row_count] of the skeleton */
    noh_spring_joint *rows;       /* [row_count] */
    swing *swings;                /* [chain_count] */
    noh_spring_capsule *capsules; /* [collider_count], radii in the skeleton's unit */
};

/* ---- of a pack ---- */

int noh_springs_of_pack(const noh_pack *pack, uint32_t skeleton, noh_springs_desc *desc)
{
    NOH_ASSERT(pack && desc);
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_SPRINGS].count; i++) {
        const uint8_t *bytes = noh_pack_chunk_at(pack, NOH_CHUNK_SPRINGS, i);
        const noh_springs_header *h = (const noh_springs_header *)(const void *)bytes;
        const noh_skeleton_header *s;
        if (h->skeleton != skeleton) continue;
        s = noh_pack_chunk_at(pack, NOH_CHUNK_SKELETON, skeleton);
        memset(desc, 0, sizeof *desc);
        (void)noh_pack_skeleton_at(pack, skeleton, &desc->skeleton, NULL, NULL);
        desc->metres = s->unit_cm / 100.0f;
        desc->rows = (const noh_spring_row *)(const void *)(bytes + h->rows_offset);
        desc->row_count = h->row_count;
        desc->chains = (const noh_spring_chain *)(const void *)(bytes + h->chains_offset);
        desc->chain_count = h->chain_count;
        desc->colliders = (const noh_spring_capsule *)(const void *)(bytes + h->colliders_offset);
        desc->collider_count = h->collider_count;
        return 1;
    }
    return 0;
}

/* ---- size and init ---- */

static void carve(noh_arena *arena, const noh_springs_desc *d, noh_springs **springs)
{
    noh_springs parts, *s = noh_arena_carve(arena, sizeof *s, 16);
    memset(&parts, 0, sizeof parts);
    parts.joints = noh_arena_carve(arena, d->row_count * sizeof *parts.joints, 16);
    parts.rows = noh_arena_carve(arena, d->row_count * sizeof *parts.rows, 16);
    parts.swings = noh_arena_carve(arena, d->chain_count * sizeof *parts.swings, 16);
    parts.capsules = noh_arena_carve(arena, d->collider_count * sizeof *parts.capsules, 16);
    if (s) *s = parts;
    *springs = s;
}

size_t noh_springs_size(const noh_springs_desc *desc)
{
    noh_arena arena = noh_arena_measure();
    noh_springs *none;
    NOH_ASSERT(desc);
    if (!desc->row_count || desc->row_count > NOH_JOINTS_MAX || !desc->chain_count ||
        desc->chain_count > desc->row_count || desc->collider_count > NOH_SPRING_COLLIDERS_MAX) {
        return 0;
    }
    carve(&arena, desc, &none);
    return arena.used;
}

/* Rows that are there, of no other chain, and each joint a child of the one before. `next`: the first free row. */
static int chain_hangs_together(const noh_springs_desc *d, const noh_spring_chain *c, uint32_t next)
{
    const noh_skeleton *k = &d->skeleton;
    if (c->first_row != next || !c->row_count || c->row_count > d->row_count - next) return 0;
    for (uint32_t i = 0; i < c->row_count; i++) {
        const uint32_t joint = d->rows[next + i].joint;
        if (joint >= k->joint_count || k->parents[joint] == NOH_JOINT_ROOT) return 0;
        if (i && k->parents[joint] != d->rows[next + i - 1u].joint) return 0;
    }
    return d->collider_count == 32u || !(c->collides >> d->collider_count);
}

/* 1: no joint stands in two rows. */
static int joints_differ(const noh_springs_desc *d)
{
    uint8_t taken[NOH_JOINTS_MAX / 8u];
    memset(taken, 0, sizeof taken);
    for (uint32_t i = 0; i < d->row_count; i++) {
        const uint32_t joint = d->rows[i].joint, bit = 1u << (joint & 7u);
        if (taken[joint >> 3] & bit) return 0;
        taken[joint >> 3] = (uint8_t)(taken[joint >> 3] | bit);
    }
    return 1;
}

/* A vector in a joint's space at rest, as long as it is in model space: the scales of the joint and of those above it
 * are taken along. */
static void scale_vector(const noh_skeleton *skeleton, uint32_t joint, const float v[3], float out[3])
{
    float turn[4] = { 0.0f, 0.0f, 0.0f, 1.0f }, back[4];
    memcpy(out, v, 3 * sizeof *out);
    for (uint32_t up = joint; up != NOH_JOINT_ROOT; up = skeleton->parents[up]) {
        const noh_transform *t = &skeleton->bind_pose[up];
        if (t->scale[0] != 1.0f || t->scale[1] != 1.0f || t->scale[2] != 1.0f) {
            noh_quat_rotate(turn, out, out);
            for (int i = 0; i < 3; i++) out[i] *= t->scale[i];
            noh_quat_conjugate(turn, back);
            noh_quat_rotate(back, out, out);
        }
        noh_quat_mul(t->rotation, turn, turn);
    }
}

/* A joint of a chain as its spring has it: lengths in units of the skeleton. */
static noh_spring_joint joint_of_row(const noh_springs_desc *d, const noh_spring_chain *c, uint32_t row)
{
    const float units = 1.0f / d->metres;
    const noh_spring_row *from = &d->rows[row];
    const int is_last = row + 1u == c->first_row + c->row_count;
    noh_spring_joint j;
    scale_vector(&d->skeleton, from->joint,
                 is_last ? c->end : d->skeleton.bind_pose[d->rows[row + 1u].joint].translation, j.bone);
    memcpy(j.rest, d->skeleton.bind_pose[from->joint].rotation, sizeof j.rest);
    j.stiffness = from->stiffness * units;
    j.drag = from->drag;
    j.radius = from->radius * units;
    for (int i = 0; i < 3; i++) j.gravity[i] = from->gravity[i] * units;
    return j;
}

static noh_result check_rows(const noh_springs_desc *d, const noh_spring_chain *c, noh_error *error)
{
    if (c->row_count > NOH_SPRING_JOINTS_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "springs: a chain has more joints than the limit", c->row_count,
                        NOH_SPRING_JOINTS_MAX);
    }
    for (uint32_t i = c->first_row; i < c->first_row + c->row_count; i++) {
        const noh_spring_joint joint = joint_of_row(d, c, i);
        const noh_spring_desc alone = { &joint, 1, 0, d->restitution };
        if (noh_spring_check_desc(&alone, NULL)) {
            return noh_fail(error, NOH_ERR_ARG,
                            "springs: a row's bone has no length, or a number or the restitution is out of its range",
                            i, 0);
        }
    }
    return NOH_OK;
}

static noh_result check_desc(const noh_springs_desc *d, noh_error *error)
{
    uint32_t next = 0;
    if (!(d->metres > 0.0f) || !noh_is_finite(d->metres) || d->skeleton.joint_count > NOH_JOINTS_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "springs: `metres` must be above 0, and the skeleton valid", 0, 0);
    }
    for (uint32_t i = 0; i < d->chain_count; i++) {
        if (!chain_hangs_together(d, &d->chains[i], next)) {
            return noh_fail(error, NOH_ERR_ARG,
                            "springs: a chain's rows do not follow the previous chain's rows, its joints are not "
                            "parent and child, or a collider does not exist",
                            i, 0);
        }
        const noh_result result = check_rows(d, &d->chains[i], error);
        if (result) return result;
        next += d->chains[i].row_count;
    }
    if (next != d->row_count || !joints_differ(d)) {
        return noh_fail(error, NOH_ERR_ARG, "springs: a row is in no chain, or a joint in two", next, 0);
    }
    for (uint32_t i = 0; i < d->collider_count; i++) {
        const noh_spring_capsule *c = &d->colliders[i];
        if (c->joint >= d->skeleton.joint_count || !noh_is_finite3(c->from) || !noh_is_finite3(c->to) ||
            !(c->radius >= 0.0f) || !noh_is_finite(c->radius / d->metres)) {
            return noh_fail(error, NOH_ERR_ARG, "springs: a collider's joint does not exist, or a number is bad", i, 0);
        }
    }
    return NOH_OK;
}

static uint32_t bits_of(uint32_t mask)
{
    uint32_t count = 0;
    for (; mask; mask &= mask - 1u) count++;
    return count;
}

static noh_spring_desc spring_of(const noh_springs_desc *d, const noh_spring_chain *c, const noh_spring_joint *joints)
{
    const noh_spring_desc spring = { joints, c->row_count, bits_of(c->collides), d->restitution };
    return spring;
}

/* Of one actor: what chains swing, then the springs of as many chains as are given. */
static size_t state_bytes_of(const noh_springs_desc *d, uint32_t chains)
{
    size_t bytes = (d->chain_count * sizeof(uint32_t) + 15u) & ~(size_t)15u;
    for (uint32_t i = 0; i < chains; i++) {
        const noh_spring_desc spring = spring_of(d, &d->chains[i], NULL);
        bytes += noh_spring_size(&spring);
    }
    return bytes;
}

static uint32_t longest_of(const noh_springs_desc *d)
{
    uint32_t longest = 0;
    for (uint32_t i = 0; i < d->chain_count; i++) {
        if (d->chains[i].row_count > longest) longest = d->chains[i].row_count;
    }
    return longest;
}

static size_t carve_workspace(noh_arena *arena, uint32_t colliders, uint32_t longest, int asks, workspace *out)
{
    out->scratch = noh_arena_carve(arena, NOH_SPRING_SCRATCH_FLOATS(colliders) * sizeof(float), 16);
    out->chains = noh_arena_carve(arena, sizeof *out->chains, 16);
    out->all = noh_arena_carve(arena, colliders * sizeof *out->all, 16);
    out->near_by = noh_arena_carve(arena, TOGETHER * colliders * sizeof *out->near_by, 16);
    out->rotations = noh_arena_carve(arena, TOGETHER * 4u * (size_t)longest * sizeof(float), 16);
    if (asks) {
        out->asks.balls = noh_arena_carve(arena, TOGETHER * (size_t)longest * sizeof *out->asks.balls, 16);
        out->asks.touches = noh_arena_carve(arena, TOGETHER * (size_t)longest * sizeof *out->asks.touches, 16);
    }
    return arena->used;
}

void noh_springs_measure(const noh_springs_desc *desc, size_t *state_bytes, size_t *scratch_bytes)
{
    noh_arena arena = noh_arena_measure();
    workspace none;
    NOH_ASSERT(desc && state_bytes && scratch_bytes);
    *state_bytes = state_bytes_of(desc, desc->chain_count);
    *scratch_bytes = carve_workspace(&arena, desc->collider_count, longest_of(desc), desc->world != NULL, &none);
}

/* The number of the last chain before this one, plus 1, that has a joint above its first; 0: none has. */
static uint32_t hangs_after(const noh_springs_desc *d, uint32_t chain)
{
    uint32_t joint = d->rows[d->chains[chain].first_row].joint, after = 0;
    while ((joint = d->skeleton.parents[joint]) != NOH_JOINT_ROOT) {
        for (uint32_t i = after; i < chain; i++) {
            const noh_spring_row *rows = d->rows + d->chains[i].first_row;
            for (uint32_t r = 0; r < d->chains[i].row_count; r++) {
                if (rows[r].joint == joint) after = i + 1u;
            }
        }
    }
    return after;
}

static void fill(noh_springs *s, const noh_springs_desc *d)
{
    size_t bytes, scratch, state = state_bytes_of(d, 0);
    for (uint32_t i = 0; i < d->chain_count; i++) {
        const noh_spring_chain *c = &d->chains[i];
        swing *w = &s->swings[i];
        memset(w, 0, sizeof *w);
        for (uint32_t row = c->first_row; row < c->first_row + c->row_count; row++) {
            s->joints[row] = d->rows[row].joint;
            s->rows[row] = joint_of_row(d, c, row);
            w->length += noh_length3(s->rows[row].bone) * d->metres;
        }
        w->desc = spring_of(d, c, s->rows + c->first_row);
        w->first_row = c->first_row;
        w->collides = c->collides;
        w->state = (uint32_t)state;
        w->after = hangs_after(d, i);
        state += noh_spring_size(&w->desc);
    }
    for (uint32_t i = 0; i < d->collider_count; i++) {
        const noh_spring_capsule *from = &d->colliders[i];
        s->capsules[i] = *from;
        s->capsules[i].radius /= d->metres;
        scale_vector(&d->skeleton, from->joint, from->from, s->capsules[i].from);
        scale_vector(&d->skeleton, from->joint, from->to, s->capsules[i].to);
    }
    noh_springs_measure(d, &bytes, &scratch);
    s->state_bytes = (uint32_t)bytes;
    s->scratch_bytes = (uint32_t)scratch;
}

noh_result noh_springs_init(void *memory, size_t bytes, const noh_springs_desc *desc, noh_springs **springs,
                            noh_error *error)
{
    noh_arena arena;
    noh_springs *s;
    NOH_ASSERT(desc && springs);
    if (!noh_springs_size(desc)) {
        return noh_fail(error, NOH_ERR_LIMIT, "springs: no rows or chains, or more rows or colliders than the limit",
                        desc->row_count, NOH_JOINTS_MAX);
    }
    noh_result result = check_desc(desc, error);
    if (!result && state_bytes_of(desc, desc->chain_count) > NOH_MODIFIER_BYTES_MAX) {
        result = noh_fail(error, NOH_ERR_LIMIT, "springs: the state of one actor would pass the limit of a modifier",
                          desc->chain_count, NOH_MODIFIER_BYTES_MAX);
    }
    if (!result) result = noh_arena_open(&arena, memory, bytes, noh_springs_size(desc), error);
    if (result) return result;
    carve(&arena, desc, &s);
    s->chain_count = desc->chain_count;
    s->collider_count = (uint16_t)desc->collider_count;
    s->joint_count = (uint16_t)desc->skeleton.joint_count;
    s->metres = desc->metres;
    s->world = desc->world;
    s->longest = longest_of(desc);
    fill(s, desc);
    *springs = s;
    return NOH_OK;
}

/* ---- in a job ---- */

/* From model space to where they swing. */
static void to_world(const noh_modifier_work *w, const float model[3], float out[3])
{
    noh_quat_rotate(w->place.rotation, model, out);
    noh_madd3(out, 1.0f / w->place.scale, w->near_place, out);
}

static void follow_home(const noh_modifier_work *w, const noh_springs *s)
{
    const uint32_t *begun = w->state;
    float by[3];
    for (int i = 0; i < 3; i++) by[i] = w->home_moved[i] / w->place.scale;
    for (uint32_t i = 0; i < s->chain_count; i++) {
        if (begun[i]) noh_spring_shift((noh_spring *)(void *)((uint8_t *)w->state + s->swings[i].state), by);
    }
}

static void pose_capsule(const noh_modifier_work *w, const noh_spring_capsule *c, noh_spring_collider *out)
{
    float rotation[4], at[3];
    noh_stage_joint_at(w->kind, w->local, c->joint, rotation, at);
    noh_quat_rotate(rotation, c->from, out->from);
    noh_quat_rotate(rotation, c->to, out->to);
    noh_madd3(out->from, 1.0f, at, out->from);
    noh_madd3(out->to, 1.0f, at, out->to);
    to_world(w, out->from, out->from);
    to_world(w, out->to, out->to);
    out->radius = c->radius;
}

/* What carries a chain: its first joint's place, and the rotation of that joint's parent. */
static noh_spring_carrier carrier_of(const noh_modifier_work *w, uint32_t joint)
{
    noh_spring_carrier c;
    float own[4], at[3];
    noh_stage_joint_at(w->kind, w->local, joint, c.rotation, at);
    noh_quat_conjugate(w->local[joint].rotation, own);
    noh_quat_mul(c.rotation, own, c.rotation);
    noh_quat_mul(w->place.rotation, c.rotation, c.rotation);
    noh_quat_normalize(c.rotation);
    to_world(w, at, c.position);
    return c;
}

/* How much of its swing a chain shows, 0..1: none where it looks too short. */
static float share_of(const noh_modifier_work *w, const swing *g)
{
    const float pixels = w->pixels_per_metre * g->length / NOH_SPRINGS_FADE_PIXELS;
    return pixels >= 1.0f ? 1.0f : pixels <= 0.5f ? 0.0f : 2.0f * pixels - 1.0f;
}

/* Into the pose; `share` below 1 leaves the rest of the way to the rotations at rest. */
static void show(const noh_modifier_work *w, const noh_springs *s, const swing *g, float share, const float *rotations)
{
    for (uint32_t i = 0; i < g->desc.joint_count; i++) {
        float *local = w->local[s->joints[g->first_row + i]].rotation;
        if (share < 1.0f) {
            noh_quat_nlerp(g->desc.joints[i].rest, rotations + 4u * (size_t)i, share, local);
        } else {
            memcpy(local, rotations + 4u * (size_t)i, 4 * sizeof *local);
        }
    }
}

static void rest(const noh_modifier_work *w, const noh_springs *s, const swing *g)
{
    for (uint32_t i = 0; i < g->desc.joint_count; i++) {
        memcpy(w->local[s->joints[g->first_row + i]].rotation, g->desc.joints[i].rest, 4 * sizeof(float));
    }
}

/* Swing those that were put together, all at once. */
static void swing_together(const noh_modifier_work *w, const noh_springs *s, const workspace *space)
{
    together *t = space->chains;
    if (!NOH_PAGE && space->asks.world) noh_springs_ask(w, &space->asks, t->moves, t->count);
    (void)noh_spring_step(t->moves, t->count, w->ticks, space->scratch);
    noh_spring_rotations(t->moves, t->count);
    for (uint32_t i = 0; i < t->count; i++) {
        const swing *g = (const swing *)(const void *)t->moves[i].desc;
        show(w, s, g, t->shares[i], t->moves[i].rotations);
    }
    t->count = 0;
}

/* The colliders that a chain has, out of all. */
static const noh_spring_collider *gather(const noh_springs *s, const swing *g, const workspace *space)
{
    noh_spring_collider *out = space->near_by + space->chains->count * (size_t)s->collider_count;
    uint32_t count = 0;
    for (uint32_t k = 0; k < s->collider_count; k++) {
        if (g->collides >> k & 1u) out[count++] = space->all[k];
    }
    return out;
}

/* A chain joins those that are put together, or rests. */
static void add_chain(const noh_modifier_work *w, const noh_springs *s, uint32_t chain, const workspace *space)
{
    const swing *g = &s->swings[chain];
    together *t = space->chains;
    noh_spring_move *move = &t->moves[t->count];
    uint32_t *begun = (uint32_t *)w->state + chain;
    noh_spring *spring = (noh_spring *)(void *)((uint8_t *)w->state + g->state);
    t->shares[t->count] = share_of(w, g);
    if (!(t->shares[t->count] > 0.0f)) {
        *begun = 0;
        rest(w, s, g);
        return;
    }
    t->carriers[t->count] = carrier_of(w, s->joints[g->first_row]);
    move->spring = spring;
    move->desc = &g->desc;
    move->carrier = &t->carriers[t->count];
    move->colliders = gather(s, g, space);
    move->touches = NULL;
    move->rotations = space->rotations + t->count * 4u * (size_t)s->longest;
    if (w->cut || !*begun) { /* at rest: there is no time to go by, and nothing to go on from */
        *begun = noh_spring_init(spring, noh_spring_size(&g->desc), &g->desc, move->carrier, &spring, NULL) == NOH_OK;
        if (*begun) {
            noh_spring_rotations(move, 1);
            show(w, s, g, t->shares[t->count], move->rotations);
        }
        return;
    }
    t->count++;
}

static void modify(noh_modifier_work *w)
{
    const noh_springs *s = w->user;
    noh_arena arena;
    workspace space;
    uint32_t first = 0; /* of the chains that are put together */
    if (w->skeleton->joint_count < s->joint_count) return;
    if (noh_arena_open(&arena, w->scratch, s->scratch_bytes, s->scratch_bytes, NULL)) return;
    (void)carve_workspace(&arena, s->collider_count, s->longest, s->world != NULL, &space);
    space.chains->count = 0;
    space.asks.metres = s->metres;
    const int asks = !NOH_PAGE && s->world && noh_world_may_ask(s->world, w->stage->desc.job_count);
    space.asks.world = asks ? s->world : NULL;
    if (noh_modifier_home_moved(w)) follow_home(w, s);
    for (uint32_t i = 0; i < s->collider_count; i++) pose_capsule(w, &s->capsules[i], &space.all[i]);
    for (uint32_t i = 0; i < s->chain_count; i++) {
        if (space.chains->count == TOGETHER || s->swings[i].after > first) {
            swing_together(w, s, &space);
            first = i;
        }
        add_chain(w, s, i, &space);
    }
    swing_together(w, s, &space);
}

static const char *check(const void *user, const void *state)
{
    const noh_springs *s = user;
    const uint32_t *begun = state;
    for (uint32_t i = 0; i < s->chain_count; i++) {
        const swing *g = &s->swings[i];
        if (begun[i] > 1u) return "state: springs: a chain has a bad flag";
        if (!begun[i]) continue;
        const void *spring = (const uint8_t *)state + g->state;
        const char *what = noh_spring_check(spring, &g->desc);
        if (what) return what;
    }
    return NULL;
}

/* ---- the springs of a kind's pack as a module ---- */

static int is_there(const noh_kind_desc *d, const void *desc)
{
    noh_springs_desc springs;
    (void)desc;
    return noh_springs_of_pack(d->mesh, d->skeleton, &springs);
}

static const char *bad(const noh_kind_desc *d, const void *desc)
{
    noh_springs_desc springs;
    if (!NOH_PAGE && desc && noh_world_check(desc, NULL)) return "world of a kind's springs: see noh_world_check";
    return noh_springs_of_pack(d->mesh, d->skeleton, &springs) &&
                   state_bytes_of(&springs, springs.chain_count) > NOH_MODIFIER_BYTES_MAX
               ? "springs of a kind: the springs of its mesh's pack have more bytes than NOH_MODIFIER_BYTES_MAX"
               : NULL;
}

static const char *refuse(const void *desc, uint32_t job_count)
{
    if (NOH_PAGE || noh_world_may_ask(desc, job_count)) return NULL;
    return "springs of a kind: the physics of their world answers one thread, and the stage has several jobs: set its "
           "`threads`, or job_count to 1";
}

static uint32_t hash(const noh_kind_desc *d, const void *desc)
{
    (void)d, (void)desc;
    return 1;
}

static noh_result measure(const noh_kind_desc *d, const void *desc, const noh_stage_needs *n, noh_module_needs *needs,
                          noh_error *error)
{
    noh_springs_desc springs;
    (void)n, (void)error;
    if (!noh_springs_of_pack(d->mesh, d->skeleton, &springs)) return NOH_OK;
    springs.world = desc;
    noh_springs_measure(&springs, &needs->actor_bytes, &needs->scratch_bytes);
    needs->kind_bytes = noh_springs_size(&springs);
    return NOH_OK;
}

static noh_result init(noh_stage_kind *k, const void *desc, noh_error *error)
{
    noh_springs_desc of_pack;
    noh_springs *springs;
    if (!noh_springs_of_pack(k->desc->mesh, k->desc->skeleton, &of_pack)) return NOH_OK;
    of_pack.world = desc;
    return noh_springs_init(k->modules[NOH_SLOT_SPRINGS].shared, noh_springs_size(&of_pack), &of_pack, &springs, error);
}

static noh_result check_module(const noh_stage_kind *k, const void *state, noh_error *error)
{
    const char *what = check(k->modules[NOH_SLOT_SPRINGS].shared, state);
    return what ? noh_fail(error, NOH_ERR_DATA, what, 0, 0) : NOH_OK;
}

noh_module noh_springs_module(const noh_world *world)
{
    static const noh_module_type of_pack = {
        .slot = NOH_SLOT_SPRINGS,
        .kind_name = "springs",
        .hash = hash,
        .is_there = is_there,
        .bad = bad,
        .refuse = refuse,
        .measure = measure,
        .init = init,
        .check = check_module,
        .modify = modify,
    };
    return (noh_module){ &of_pack, world };
}

noh_modifier noh_springs_modifier(const noh_springs *springs)
{
    NOH_ASSERT(springs);
    return (noh_modifier){ .name = "springs",
                           .modify = modify,
                           .check = check,
                           .user = springs,
                           .state_bytes = springs->state_bytes,
                           .scratch_bytes = springs->scratch_bytes };
}
