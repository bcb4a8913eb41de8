/* stage_actor.c: actors come and go, and stand somewhere. */
#include <string.h>

#include "motion/anim/root_internal.h"
#include "core/base/math_internal.h"
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"
#include "stage/character/character_internal.h"

/* ---- ids ---- */

uint32_t noh_stage_index(const noh_stage_kind *kind, const noh_stage_actor *a)
{
    return (uint32_t)(a - kind->actors);
}

noh_character *noh_stage_character(const noh_stage_kind *kind, uint32_t index)
{
    return (noh_character *)(void *)(kind->characters + (size_t)index * kind->character_bytes);
}

noh_stage_kind *noh_stage_kind_of(const noh_stage *s, uint32_t index)
{
    uint32_t k = 0;
    while (k + 1u < s->desc.kind_count && index >= s->kinds[k + 1u].first_actor) k++;
    return &s->kinds[k];
}

static noh_actor id_of(const noh_stage *s, uint32_t index)
{
    const noh_actor id = { s->actors[index].generation << 16 | index };
    return id;
}

noh_stage_actor *noh_stage_actor_of(const noh_stage *s, noh_actor actor, noh_stage_kind **kind)
{
    const uint32_t index = actor.id & 0xffffu;
    noh_stage_actor *a;
    NOH_ASSERT(s);
    if (index >= s->actor_count) return NULL;
    a = &s->actors[index];
    if (!a->alive || a->generation != actor.id >> 16) return NULL;
    if (kind) *kind = noh_stage_kind_of(s, index);
    return a;
}

noh_stage_actor *noh_stage_parent_of(const noh_stage *s, const noh_stage_actor *a, noh_stage_kind **kind)
{
    return a->parent ? noh_stage_actor_of(s, (noh_actor){ a->parent }, kind) : NULL;
}

const noh_stage_actor *noh_stage_root_of(const noh_stage *s, const noh_stage_actor *a)
{
    for (const noh_stage_actor *on; (on = noh_stage_parent_of(s, a, NULL)) != NULL;) a = on;
    return a;
}

noh_result noh_stage_gone(noh_error *error, noh_actor actor)
{
    return noh_fail(error, NOH_ERR_NOT_FOUND, "the actor is gone, or never was", actor.id & 0xffffu, 0);
}

noh_result noh_stage_change(noh_stage *s, noh_actor actor, noh_stage_actor **a, noh_stage_kind **kind, noh_error *error)
{
    noh_stage_actor *found = noh_stage_actor_of(s, actor, kind);
    if (!found) {
        return noh_stage_gone(error, actor);
    }
    if (s->phase == NOH_STAGE_STEPPING && s->callback_actor != actor.id) {
        return noh_fail(error, NOH_ERR_ARG, "within on_key only the key's own actor may be changed", actor.id & 0xffffu,
                        0);
    }
    if (s->phase > NOH_STAGE_STEPPING) {
        return noh_fail(error, NOH_ERR_ARG, "cannot change an actor during a frame", actor.id & 0xffffu, 0);
    }
    *a = found;
    return NOH_OK;
}

noh_actor noh_stage_actor_at(const noh_stage *stage, uint32_t index)
{
    const noh_actor nobody = { 0 };
    NOH_ASSERT(stage);
    return index < stage->actor_count && stage->actors[index].alive ? id_of(stage, index) : nobody;
}

/* ---- places ---- */

static const char *normal_place(const noh_place *in, noh_place *out)
{
    static const float identity[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    const float *q = in->rotation;
    float square = 0.0f;
    *out = *in;
    if (!noh_is_number3(in->position)) return "position of a place is not a number, or larger than 10^12";
    for (int i = 0; i < 4; i++) square += q[i] * q[i];
    if (!noh_is_finite(square)) return "rotation of a place is not finite";
    if (in->scale == 0.0f) out->scale = 1.0f;
    if (!noh_is_scale(out->scale)) return "scale of a place is not in 10^-12..10^12";
    if (q[0] == 0.0f && q[1] == 0.0f && q[2] == 0.0f && q[3] == 0.0f) {
        memcpy(out->rotation, identity, sizeof identity);
    } else if (square < 1e-12f) {
        return "rotation of a place has no length";
    } else {
        noh_quat_normalize(out->rotation);
    }
    return NULL;
}

void noh_place_matrix(const noh_place *place, float matrix[12])
{
    noh_transform t;
    memcpy(t.rotation, place->rotation, sizeof t.rotation);
    memcpy(t.translation, place->position, sizeof t.translation);
    for (int i = 0; i < 3; i++) t.scale[i] = place->scale;
    noh_transform_matrix(&t, matrix);
}

static void place_less(const noh_place *place, const float rest[3], const float origin[3], noh_place *out)
{
    *out = *place;
    for (int i = 0; i < 3; i++) {
        out->position[i] = (float)((double)place->position[i] - (double)origin[i] + (double)rest[i]);
    }
}

/* part  0: before the last step, 1: after it. In a difference to `origin` that is near, nothing is lost. */
static void mix_places(const noh_stage_actor *a, float part, const float origin[3], noh_place *out)
{
    noh_place before;
    if (part > 0.0f) {
        place_less(&a->place, a->rest, origin, out);
    } else {
        place_less(&a->before, a->rest_before, origin, out);
    }
    if (part > 0.0f && part < 1.0f) {
        place_less(&a->before, a->rest_before, origin, &before);
        if (memcmp(&before, out, sizeof before) == 0) return;
        for (int i = 0; i < 3; i++) {
            out->position[i] = before.position[i] + (out->position[i] - before.position[i]) * part;
        }
        noh_quat_nlerp(a->before.rotation, a->place.rotation, part, out->rotation);
        out->scale = a->before.scale + (a->place.scale - a->before.scale) * part;
    }
}

static float part_of_step(uint32_t behind_ticks, uint32_t step_ticks)
{
    if (behind_ticks == 0) return 1.0f;
    return behind_ticks < step_ticks ? (float)(step_ticks - behind_ticks) / (float)step_ticks : 0.0f;
}

static const float nowhere[3];

void noh_stage_shown_place(const noh_stage *s, const noh_stage_actor *a, const float origin[3], noh_place *out)
{
    mix_places(a, part_of_step(s->head->behind_ticks, s->head->step_ticks), a->parent ? nowhere : origin, out);
}

void noh_stage_keep_before(noh_stage_actor *a)
{
    a->before = a->place;
    memcpy(a->rest_before, a->rest, sizeof a->rest);
}

void noh_stage_keep_within(noh_place *place, float rest[3])
{
    for (int i = 0; i < 3; i++) {
        const float at = place->position[i];
        if (noh_is_number(at)) continue;
        place->position[i] = at < 0.0f ? -NOH_NUMBER_MAX : NOH_NUMBER_MAX;
        rest[i] = 0.0f;
    }
    if (!noh_is_scale(place->scale)) place->scale = place->scale > 1.0f ? NOH_NUMBER_MAX : 1.0f / NOH_NUMBER_MAX;
}

static void put(noh_stage_actor *a, const noh_place *place)
{
    a->place = *place;
    memset(a->rest, 0, sizeof a->rest);
    if (!NOH_PAGE) noh_stage_keep_within(&a->place, a->rest);
    memset(a->rotation_rest, 0, sizeof a->rotation_rest);
}

/* A place from outside a step: until the step that it belongs to is over, or a frame has shown it, `before` stays. */
static void go_to(noh_stage_actor *a, const noh_place *place)
{
    if (!a->on_its_way) noh_stage_keep_before(a);
    a->on_its_way = 1;
    put(a, place);
}

static void be_at(noh_stage_actor *a, const noh_place *place)
{
    put(a, place);
    noh_stage_keep_before(a);
}

noh_result noh_actor_set_place(noh_stage *stage, noh_actor actor, const noh_place *place, noh_error *error)
{
    noh_stage_actor *a = NULL;
    noh_place normal;
    noh_stage_kind *kind = NULL;
    const char *what;
    const noh_result result = noh_stage_change(stage, actor, &a, &kind, error);
    NOH_ASSERT(place);
    if (result != NOH_OK) {
        return result;
    }
    what = normal_place(place, &normal);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, actor.id & 0xffffu, 0);
    }
    go_to(a, &normal);
    return NOH_OK;
}

noh_result noh_actor_place(const noh_stage *stage, noh_actor actor, noh_place *place, noh_error *error)
{
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, NULL);
    NOH_ASSERT(place);
    if (!a) {
        return noh_stage_gone(error, actor);
    }
    *place = a->place;
    return NOH_OK;
}

noh_result noh_actor_place_between(const noh_stage *stage, noh_actor actor, float alpha, noh_place *place,
                                   noh_error *error)
{
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, NULL);
    NOH_ASSERT(place);
    if (!a) {
        return noh_stage_gone(error, actor);
    }
    if (!(alpha >= 0.0f && alpha <= 1.0f)) {
        return noh_fail(error, NOH_ERR_ARG, "alpha is outside of 0..1", 0, 0);
    }
    mix_places(a, part_of_step(noh_stage_behind(stage, alpha), stage->head->step_ticks), nowhere, place);
    return NOH_OK;
}

noh_result noh_actor_cut(noh_stage *stage, noh_actor actor, noh_error *error)
{
    noh_stage_actor *a = NULL;
    noh_stage_kind *k = NULL;
    const noh_result result = noh_stage_change(stage, actor, &a, &k, error);
    if (result != NOH_OK) {
        return result;
    }
    noh_stage_keep_before(a);
    a->was_seen = 0;
    noh_character_cut(noh_stage_character(k, noh_stage_index(k, a)));
    return NOH_OK;
}

/* ---- coming and going ---- */

static noh_result make_character(noh_stage_kind *k, uint32_t index, int64_t clock, noh_error *error)
{
    noh_character_desc desc = noh_stage_character_desc(k, index);
    noh_character *made;
    desc.start_clock = clock;
    return noh_character_init(noh_stage_character(k, index), k->character_bytes, &desc, &made, error);
}

static const char *cannot_spawn(const noh_stage *s, uint32_t kind)
{
    if (kind >= s->desc.kind_count) return "no such kind";
    if (!s->kinds[kind].pools) return "the slot of the kind is empty: noh_stage_set_kind fills it";
    return s->phase != NOH_STAGE_IDLE ? "cannot spawn during a step or a frame" : NULL;
}

noh_result noh_stage_spawn(noh_stage *stage, uint32_t kind, const noh_place *place, noh_actor *actor, noh_error *error)
{
    NOH_ASSERT(stage && actor);
    static const noh_place origin = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }, 1.0f };
    const char *what = cannot_spawn(stage, kind);
    noh_stage_free *f;
    noh_stage_actor *a;
    noh_place normal;
    noh_result result;
    if (!what) what = normal_place(place ? place : &origin, &normal);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, kind, 0);
    }
    f = &stage->head->kinds[kind];
    if (!f->first) {
        return noh_fail(error, NOH_ERR_LIMIT, "all actors of the kind are there", kind,
                        stage->kinds[kind].desc->actor_count);
    }
    a = &stage->kinds[kind].actors[f->first - 1u];
    result = make_character(&stage->kinds[kind], f->first - 1u, stage->head->clock, error);
    if (result != NOH_OK) {
        return result;
    }
    f->first = a->next_free;
    if (!f->first) f->last = 0;
    f->count++;
    a->next_free = 0;
    a->alive = 1;
    be_at(a, &normal);
    *actor = id_of(stage, (uint32_t)(a - stage->actors));
    noh_stage_take_floats(&stage->kinds[kind], noh_stage_index(&stage->kinds[kind], a));
    for (uint32_t slot = 0; slot < NOH_SLOT_COUNT; slot++) {
        const noh_module_type *type = stage->kinds[kind].modules[slot].type;
        if (type && type->spawn) {
            type->spawn(stage, &stage->kinds[kind], noh_stage_index(&stage->kinds[kind], a), *actor);
        }
    }
    return NOH_OK;
}

static void shift(noh_place *place, float rest[3], const float by[3])
{
    for (int i = 0; i < 3; i++) {
        noh_split((double)place->position[i] + (double)rest[i] + (double)by[i], &place->position[i], &rest[i]);
    }
    if (!NOH_PAGE) noh_stage_keep_within(place, rest);
}

void noh_stage_shift_actor(noh_stage_actor *a, const float by[3])
{
    shift(&a->place, a->rest, by);
    shift(&a->before, a->rest_before, by);
}

noh_result noh_stage_shift_origin(noh_stage *stage, const float by[3], noh_error *error)
{
    NOH_ASSERT(stage && by);
    const float back[3] = { -by[0], -by[1], -by[2] };
    if (stage->phase != NOH_STAGE_IDLE || !noh_is_number(by[0]) || !noh_is_number(by[1]) || !noh_is_number(by[2])) {
        return noh_fail(error, NOH_ERR_ARG,
                        stage->phase != NOH_STAGE_IDLE ? "cannot shift the origin during a step or a frame"
                                                       : "shift of the origin is not a number, or larger than 10^12",
                        0, 0);
    }
    for (uint32_t i = 0; i < stage->actor_count; i++) {
        noh_stage_actor *a = &stage->actors[i];
        if (!a->alive) continue;
        if (!a->parent) noh_stage_shift_actor(a, back);
        for (int n = 0; n < 3; n++) a->home[n] -= (double)by[n];
    }
    for (uint32_t i = 0; i < stage->desc.kind_count * NOH_SLOT_COUNT; i++) {
        noh_stage_kind *k = &stage->kinds[i / NOH_SLOT_COUNT];
        const noh_module_type *type = k->modules[i % NOH_SLOT_COUNT].type;
        if (type && type->shift) type->shift(k, by);
    }
    for (int n = 0; n < 3; n++) {
        stage->origin[n] -= by[n];
        stage->shifted[n] += (double)by[n];
    }
    return NOH_OK;
}

/* What hung on it stays where it was shown. */
static void let_go(const noh_stage *s, noh_stage_actor *child, const noh_place *shown)
{
    child->parent = 0;
    child->joint = 0;
    be_at(child, shown);
    noh_stage_shift_actor(child, s->origin);
}

static float length3(const float *m)
{
    return noh_sqrt(m[0] * m[0] + m[4] * m[4] + m[8] * m[8]);
}

/* The place of a matrix without shear or reflection.
 * source  K. Shoemake, "Quaternions" (1994): from the largest of the four squares */
static void place_of_matrix(const float m[12], noh_place *place)
{
    const float s = length3(m);
    float r[9], *q = place->rotation;
    for (int i = 0; i < 9; i++) r[i] = s > 0.0f ? m[4 * (i / 3) + i % 3] / s : 0.0f;
    place->scale = s > 0.0f ? s : 1.0f;
    for (int i = 0; i < 3; i++) place->position[i] = m[4 * i + 3];
    if (r[0] + r[4] + r[8] > 0.0f) {
        q[3] = 1.0f + r[0] + r[4] + r[8], q[0] = r[7] - r[5], q[1] = r[2] - r[6], q[2] = r[3] - r[1];
    } else if (r[0] > r[4] && r[0] > r[8]) {
        q[0] = 1.0f + r[0] - r[4] - r[8], q[1] = r[1] + r[3], q[2] = r[2] + r[6], q[3] = r[7] - r[5];
    } else if (r[4] > r[8]) {
        q[1] = 1.0f - r[0] + r[4] - r[8], q[0] = r[1] + r[3], q[2] = r[5] + r[7], q[3] = r[2] - r[6];
    } else {
        q[2] = 1.0f - r[0] - r[4] + r[8], q[0] = r[2] + r[6], q[1] = r[5] + r[7], q[3] = r[3] - r[1];
    }
    noh_quat_normalize(q);
}

/* Where an actor is in the world, less the stage's origin: its own place, or that on its parent's joint. */
static void world_place(const noh_stage *s, const noh_stage_actor *a, noh_place *out)
{
    float matrix[12];
    noh_stage_shown_place(s, a, s->origin, out);
    if (a->parent) {
        noh_place_matrix(out, matrix);
        noh_stage_carry(s, a, matrix);
        place_of_matrix(matrix, out);
    }
}

static void let_go_all(noh_stage *s, uint32_t parent)
{
    for (uint32_t i = 0; i < s->actor_count; i++) {
        noh_stage_actor *child = &s->actors[i];
        if (child->alive && child->parent == parent) {
            noh_place shown;
            world_place(s, child, &shown);
            let_go(s, child, &shown);
        }
    }
}

static void free_actor(noh_stage *s, noh_stage_actor *a, noh_stage_kind *k)
{
    noh_stage_free *f = &s->head->kinds[k - s->kinds];
    const uint32_t own = noh_stage_index(k, a) + 1u, generation = a->generation;
    memset(noh_stage_character(k, own - 1u), 0, k->character_bytes);
    memset(k->held + (size_t)(own - 1u) * k->desc->held_float_count, 0, k->desc->held_float_count * sizeof *k->held);
    noh_stage_clear_modules(k, own - 1u);
    memset(a, 0, sizeof *a);
    a->generation = generation == 0xffffu ? 1u : generation + 1u;
    if (f->last) {
        k->actors[f->last - 1u].next_free = own;
    } else {
        f->first = own;
    }
    f->last = own;
    f->count--;
    s->shown[a - s->actors].frame = 0;
}

noh_result noh_stage_despawn(noh_stage *stage, noh_actor actor, noh_error *error)
{
    noh_stage_actor *a = NULL;
    noh_stage_kind *k = NULL;
    noh_result result = noh_stage_change(stage, actor, &a, &k, error);
    if (result == NOH_OK && stage->phase != NOH_STAGE_IDLE) {
        result = noh_fail(error, NOH_ERR_ARG, "cannot despawn during a step or a frame", 0, 0);
    }
    if (result == NOH_OK) {
        let_go_all(stage, actor.id);
        free_actor(stage, a, k);
    }
    return result;
}

/* ---- looks and links ---- */

#define WRINKLE_MODELS_ALL (NOH_WRINKLE_BY_AREA | NOH_WRINKLE_BY_REGION | NOH_WRINKLE_BY_CHANNEL)

noh_result noh_actor_set_appearance(noh_stage *stage, noh_actor actor, const noh_appearance *look, noh_error *error)
{
    noh_stage_actor *a = NULL;
    noh_stage_kind *k = NULL;
    const noh_result result = noh_stage_change(stage, actor, &a, &k, error);
    NOH_ASSERT(look);
    if (result != NOH_OK) {
        return result;
    }
    if (!(look->pixels >= 0.0f && look->pixels <= NOH_PIXELS_MAX)) {
        return noh_fail(error, NOH_ERR_ARG, "pixels of a look is not in 0..1e6", actor.id & 0xffffu, 0);
    }
    if (look->texture_set > k->desc->texture_set_count) {
        return noh_fail(error, NOH_ERR_ARG, "texture_set of a look is none of the kind's", actor.id & 0xffffu,
                        k->desc->texture_set_count);
    }
    if (look->wrinkle_models > WRINKLE_MODELS_ALL) {
        return noh_fail(error, NOH_ERR_ARG, "wrinkle_models of a look has unknown bits", actor.id & 0xffffu,
                        look->wrinkle_models);
    }
    a->look = *look;
    memset(a->look.reserved, 0, sizeof a->look.reserved); /* states are compared as bytes */
    return NOH_OK;
}

uint32_t noh_stage_steps_to(const noh_stage *s, const noh_stage_actor *a, const noh_stage_actor *to)
{
    uint32_t steps = 0;
    for (; a && a != to; steps++) a = noh_stage_parent_of(s, a, NULL);
    return a ? steps : NOH_NONE;
}

/* Of what is attached to an actor, the most attachments to it. */
static uint32_t steps_below(const noh_stage *s, const noh_stage_actor *a)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < s->actor_count; i++) {
        const uint32_t steps = s->actors[i].alive ? noh_stage_steps_to(s, &s->actors[i], a) : NOH_NONE;
        if (steps != NOH_NONE && steps > most) most = steps;
    }
    return most;
}

/* From now on its place is relative to the joint, or to the place of the one that wears it. */
static noh_result attach(const noh_stage *stage, noh_stage_actor *a, noh_actor parent, uint32_t joint, noh_error *error)
{
    const noh_stage_actor *p = noh_stage_actor_of(stage, parent, NULL);
    const uint32_t index = (uint32_t)(a - stage->actors);
    uint32_t depth;
    if (noh_stage_steps_to(stage, p, a) != NOH_NONE) {
        return noh_fail(error, NOH_ERR_ARG,
                        "an actor would be attached to itself: the parent is the actor, or is attached to it; detach "
                        "that first",
                        index, 0);
    }
    depth = noh_stage_steps_to(stage, p, noh_stage_root_of(stage, p)) + 1u + steps_below(stage, a);
    if (depth > NOH_ATTACH_DEPTH_MAX) {
        return noh_fail(error, NOH_ERR_LIMIT, "more than NOH_ATTACH_DEPTH_MAX attachments follow on each other", index,
                        depth);
    }
    a->parent = parent.id;
    a->joint = joint;
    return NOH_OK;
}

noh_result noh_actor_attach(noh_stage *stage, noh_actor actor, noh_actor parent, uint32_t joint, noh_error *error)
{
    noh_stage_actor *a = NULL;
    const noh_stage_actor *p;
    noh_stage_kind *k = NULL, *of_parent = NULL;
    noh_result result = noh_stage_change(stage, actor, &a, &k, error);
    if (result != NOH_OK) {
        return result;
    }
    if (!parent.id) {
        noh_place shown;
        world_place(stage, a, &shown);
        let_go(stage, a, &shown);
        return NOH_OK;
    }
    p = noh_stage_actor_of(stage, parent, &of_parent);
    if (!p) {
        return noh_stage_gone(error, parent);
    }
    if (joint >= of_parent->skeleton.joint_count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the parent has no such joint", joint,
                        of_parent->skeleton.joint_count);
    }
    result = attach(stage, a, parent, joint, error);
    if (result == NOH_OK) noh_stage_keep_before(a);
    return result;
}

noh_result noh_actor_wear(noh_stage *stage, noh_actor garment, noh_actor wearer, noh_error *error)
{
    static const noh_place here = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }, 1.0f };
    noh_stage_actor *a = NULL;
    const noh_stage_actor *p;
    noh_stage_kind *k = NULL, *of_wearer = NULL;
    noh_result result = noh_stage_change(stage, garment, &a, &k, error);
    if (result != NOH_OK) {
        return result;
    }
    p = noh_stage_actor_of(stage, wearer, &of_wearer);
    if (!p) {
        return noh_stage_gone(error, wearer);
    }
    if (!noh_stage_can_wear(k, (uint32_t)(of_wearer - stage->kinds))) {
        return noh_fail(error, NOH_ERR_ARG,
                        "the actor cannot wear this garment: set the bit of its kind in worn_by of the garment's kind",
                        garment.id & 0xffffu, (uint32_t)(of_wearer - stage->kinds));
    }
    if (!noh_stage_fits(stage, k, of_wearer)) {
        return noh_fail(error, NOH_ERR_NOT_FOUND,
                        "no joint of the garment has the name of a joint of the wearer: rename its joints",
                        garment.id & 0xffffu, 0);
    }
    result = attach(stage, a, wearer, NOH_STAGE_WORN, error);
    if (result != NOH_OK) {
        return result;
    }
    be_at(a, &here);
    noh_character_cut(noh_stage_character(k, noh_stage_index(k, a)));
    return NOH_OK;
}
