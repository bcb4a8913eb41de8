/* stage_state.c: the state out and in. */
#include <string.h>

#include "core/base/math_internal.h"
#include "stage/cast/stage_internal.h"
#include "core/base/assert_internal.h"
#include "stage/character/character_internal.h"
#include "stage/character/lod_pools_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/noh.h"

const void *noh_stage_state(const noh_stage *stage, size_t *bytes)
{
    NOH_ASSERT(stage && bytes);
    *bytes = stage->state_bytes;
    return stage->state;
}

#define FNV_PRIME 1099511628211u

/* Most of a state is 0, and eight bytes of 0 are one multiplication, by the eighth power of the prime.
 * source  G. Fowler, L. C. Noll, K.-P. Vo: FNV-1a, 64 bits */
uint64_t noh_stage_hash(const noh_stage *stage)
{
    const uint64_t p2 = (uint64_t)FNV_PRIME * FNV_PRIME, p8 = p2 * p2 * p2 * p2;
    uint64_t hash = 14695981039346656037u, word;
    NOH_ASSERT(stage && stage->state_bytes % sizeof word == 0);
    for (size_t i = 0; i < stage->state_bytes; i += sizeof word) {
        memcpy(&word, stage->state + i, sizeof word);
        if (!word) hash *= p8;
        for (size_t b = i; word && b < i + sizeof word; b++) hash = (hash ^ stage->state[b]) * FNV_PRIME;
    }
    return hash;
}

/* ---- a state from outside ---- */

typedef struct reader {
    const noh_stage *s;
    const uint8_t *state;
} reader;

/* The same place in the copy as in the stage's own state. */
static const void *in_copy(const reader *r, const void *own)
{
    return r->state + ((const uint8_t *)own - r->s->state);
}

/* What no kind uses is 0 in each state that a stage has: else the same stage would have several hashes. */
static int is_zero(const void *at, size_t bytes)
{
    const uint8_t *b = at;
    size_t i = 0;
    while (i < bytes && !b[i]) i++;
    return i == bytes;
}

/* Up to where the next part of a state begins. */
static int has_clean_end(const reader *r, const uint8_t *part, size_t bytes)
{
    return !bytes || is_zero((const uint8_t *)in_copy(r, part) + bytes, (0u - bytes) % NOH_MEMORY_ALIGN);
}

static const char *bad_unused(const reader *r, uint32_t kind)
{
    const noh_stage_kind *k = &r->s->kinds[kind];
    const size_t actors = k->desc->actor_count;
    const noh_stage_module *source = &k->modules[NOH_SLOT_SOURCE];
    const noh_stage_slot *slot = r->s->slots ? &r->s->slots->of[kind] : NULL;
    if (slot && slot->own) {
        const size_t bytes = (size_t)r->s->plan->kinds[kind].room.state_bytes;
        if (!is_zero((const uint8_t *)in_copy(r, slot->state) + slot->used, bytes - slot->used))
            return "state: the slot of a kind has bytes that its kind does not use, or has no kind: take the state of "
                   "a stage as noh_stage_state gives it";
    }
    if (!actors) return NULL;
    return has_clean_end(r, k->characters, actors * k->character_bytes) &&
                   has_clean_end(r, (const void *)k->held, actors * k->desc->held_float_count * sizeof *k->held) &&
                   has_clean_end(r, source->states, actors * source->stride) &&
                   has_clean_end(r, k->modifier_states, actors * k->modifier_bytes)
               ? NULL
               : "state: bytes between the parts of a kind are not 0";
}

static const char *bad_head(const reader *r)
{
    const noh_stage_head *head = (const void *)r->state;
    for (uint32_t i = 0; i < NOH_STAGE_KINDS_MAX; i++) {
        const noh_stage_free *f = &head->kinds[i];
        const int is_there = i < r->s->desc.kind_count && r->s->kinds[i].desc->actor_count;
        if (f->reserved || (!is_there && !is_zero(f, sizeof *f))) return "state: a head has bytes that nothing uses";
    }
    return NULL;
}

/* As despawning leaves it. */
static int is_gone(const reader *r, const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_module *source = &k->modules[NOH_SLOT_SOURCE];
    const size_t held = k->desc->held_float_count;
    const noh_stage_actor *a = (const noh_stage_actor *)in_copy(r, k->actors) + index;
    noh_stage_actor nobody;
    memset(&nobody, 0, sizeof nobody);
    nobody.generation = a->generation;
    nobody.next_free = a->next_free;
    return memcmp(&nobody, a, sizeof nobody) == 0 &&
           is_zero(in_copy(r, k->characters + index * k->character_bytes), k->character_bytes) &&
           is_zero(in_copy(r, k->held + index * held), held * sizeof *k->held) &&
           is_zero(in_copy(r, source->states + index * source->stride), source->stride) &&
           is_zero(in_copy(r, k->modifier_states + index * k->modifier_bytes), k->modifier_bytes);
}

static int is_sound(double x)
{
    return x >= -(double)NOH_SOUND_MAX && x <= (double)NOH_SOUND_MAX;
}

static const char *bad_place(const noh_place *place)
{
    float length = 0.0f;
    if (!noh_is_number3(place->position)) return "state: an actor's place is not a number";
    for (int i = 0; i < 4; i++) length += place->rotation[i] * place->rotation[i];
    if (!(length > 0.9f && length < 1.1f) || !noh_is_scale(place->scale))
        return "state: an actor's rotation is not unit, or its scale not in 10^-12..10^12";
    return NULL;
}

static int is_too_deep(const reader *r, const noh_stage_actor *a)
{
    const noh_stage_actor *actors = in_copy(r, r->s->actors);
    for (uint32_t depth = 0; depth <= NOH_ATTACH_DEPTH_MAX; depth++) {
        const uint32_t index = a->parent & 0xffffu;
        if (!a->parent || index >= r->s->actor_count) return 0;
        if (!actors[index].alive || actors[index].generation != a->parent >> 16) return 0;
        a = &actors[index];
    }
    return 1;
}

static const char *bad_actor(const reader *r, const noh_stage_kind *k, const noh_stage_actor *a)
{
    const char *what;
    if (a->generation == 0 || a->generation > 0xffffu) return "state: bad generation of an actor";
    if (a->alive > 1u || a->was_seen > 3u || a->on_its_way > 1u) return "state: an actor has a bad flag";
    if (a->next_free > k->desc->actor_count) return "state: bad list of free actors";
    if (!a->alive) return NULL;
    if (a->reserved || !is_zero(a->look.reserved, sizeof a->look.reserved))
        return "state: an actor has bytes that nothing uses";
    what = bad_place(&a->place);
    if (!what) what = bad_place(&a->before);
    for (int i = 0; i < 3 && !what; i++) {
        if (!noh_is_number(a->rest[i]) || !noh_is_number(a->rest_before[i]) || !is_sound(a->home[i]) ||
            !is_sound(a->moved.translation[i]))
            what = "state: an actor's place is not a number";
    }
    for (int i = 0; i < 4 && !what; i++) {
        if (!(a->rotation_rest[i] > -0.01f && a->rotation_rest[i] < 0.01f))
            what = "state: an actor's rotation is not unit";
    }
    if (what) return what;
    if (!(a->look.pixels >= 0.0f && a->look.pixels <= NOH_PIXELS_MAX))
        return "state: pixels of an actor's appearance is out of range";
    if (a->look.wrinkle_models > 7u) return "state: unknown models of wrinkles";
    if (a->look.texture_set > k->desc->texture_set_count) return "state: a texture set out of range";
    if (a->parent && (a->parent & 0xffffu) >= r->s->actor_count) return "state: a parent out of range";
    if (a->parent && a->joint == NOH_STAGE_WORN &&
        !noh_stage_can_wear(k, (uint32_t)(noh_stage_kind_of(r->s, a->parent & 0xffffu) - r->s->kinds)))
        return "state: an actor is worn by one of another kind than worn_by has";
    if (is_too_deep(r, a)) return "state: an actor is attached to itself, or over too many others";
    for (uint32_t l = 0; l < k->layer_count; l++) {
        if ((a->started[l / 8u] >> 4u * (l % 8u) & 15u) >= k->layers[l].track_count)
            return "state: bad track of a layer";
    }
    return NULL;
}

static const char *bad_held(const noh_stage_kind *k, const noh_stage_held *held)
{
    for (uint32_t i = 0; i < k->desc->held_float_count; i++) {
        if (!(held[i].amount >= 0.0f && held[i].amount <= 1.0f) || !noh_is_number(held[i].value))
            return "state: a held float is not a number";
        if (held[i].amount > 0.0f && held[i].index >= k->float_count) return "state: a held float out of range";
    }
    return NULL;
}

/* The free actors are a list from first to last that meets each of them once. */
static const char *bad_list(const reader *r, const noh_stage_kind *k, const noh_stage_free *f)
{
    const noh_stage_actor *actors = in_copy(r, k->actors);
    uint32_t at = f->first, last = 0, met = 0, gone = 0;
    for (uint32_t i = 0; i < k->desc->actor_count; i++) gone += !actors[i].alive;
    while (at && met <= gone) {
        if (at > k->desc->actor_count || actors[at - 1u].alive) return "state: bad list of free actors";
        last = at;
        at = actors[at - 1u].next_free;
        met++;
    }
    return met != gone || f->last != last || f->count != k->desc->actor_count - gone ? "state: bad list of free actors"
                                                                                     : NULL;
}

static noh_result check_modules(const reader *r, const noh_stage_kind *k, uint32_t index, noh_error *error)
{
    const noh_stage_modifier_head *head = in_copy(r, k->modifier_states + index * k->modifier_bytes);
    if (k->modifier_bytes && (head->was_posed > 1u || head->reserved)) {
        return noh_fail(error, NOH_ERR_DATA, "state: bad head of an actor's modifiers", 0, 0);
    }
    return noh_stage_check_modules(k, index, r->s->state, r->state, error);
}

/* What a slot has beyond the actors of its kind: their generations, and nothing else. */
static const char *bad_rest(const reader *r, uint32_t kind)
{
    const noh_stage *s = r->s;
    const uint32_t end = kind + 1u < s->desc.kind_count ? s->kinds[kind + 1u].first_actor : s->actor_count;
    const noh_stage_actor *actors = in_copy(r, s->actors);
    for (uint32_t i = s->kinds[kind].first_actor + s->kinds[kind].desc->actor_count; i < end; i++) {
        noh_stage_actor nobody;
        memset(&nobody, 0, sizeof nobody);
        nobody.generation = actors[i].generation;
        if (nobody.generation > 0xffffu || memcmp(&nobody, &actors[i], sizeof nobody) != 0)
            return "state: an actor where the slot of a kind has none";
    }
    return NULL;
}

static noh_result check_kind(const reader *r, uint32_t kind, noh_error *error)
{
    const noh_stage_kind *k = &r->s->kinds[kind];
    const noh_stage_actor *actors = in_copy(r, k->actors);
    const noh_stage_head *head = (const void *)r->state;
    const char *what = bad_unused(r, kind);
    noh_result result = NOH_OK;
    if (what) return noh_fail(error, NOH_ERR_DATA, what, kind, 0);
    for (uint32_t i = 0; i < k->desc->actor_count && result == NOH_OK; i++) {
        const uint8_t *character = in_copy(r, k->characters + (size_t)i * k->character_bytes);
        what = bad_actor(r, k, &actors[i]);
        if (!what && !actors[i].alive && !is_gone(r, k, i)) what = "state: a despawned actor has a state";
        if (!what) what = bad_held(k, in_copy(r, k->held + (size_t)i * k->desc->held_float_count));
        if (what) return noh_fail(error, NOH_ERR_DATA, what, k->first_actor + i, 0);
        if (actors[i].alive) result = noh_character_check(character, k->character_bytes, &k->set, &k->table, error);
        if (actors[i].alive && result == NOH_OK) result = check_modules(r, k, i, error);
    }
    if (result == NOH_OK) what = noh_stage_check_pools(k, r->s->state, r->state);
    if (what) return noh_fail(error, NOH_ERR_DATA, what, kind, 0);
    what = result == NOH_OK ? bad_list(r, k, &head->kinds[kind]) : NULL;
    if (!what && result == NOH_OK) what = bad_rest(r, kind);
    if (!what && result == NOH_OK && k->pools) {
        return noh_lod_pools_check(in_copy(r, k->pools), k->pools, error);
    }
    return what ? noh_fail(error, NOH_ERR_DATA, what, kind, 0) : result;
}

static noh_result check_state(const noh_stage *s, const void *state, size_t bytes, noh_error *error)
{
    const noh_stage_head *head = state;
    const reader r = { s, state };
    noh_result result = NOH_OK;
    if (s->phase != NOH_STAGE_IDLE) {
        return noh_fail(error, NOH_ERR_ARG, "cannot restore state during a step or a frame", 0, 0);
    }
    if ((uintptr_t)state % NOH_MEMORY_ALIGN) {
        return noh_fail(error, NOH_ERR_ARG, "a state is misaligned", 0, 0);
    }
    if (bytes != s->state_bytes || head->magic != NOH_STAGE_MAGIC || head->hash != s->head->hash) {
        return noh_fail(error, NOH_ERR_DATA, "not a state of a stage with this plan and these kinds in its slots", 0,
                        s->state_bytes);
    }
    const char *what = NOH_PAGE ? NULL : bad_head(&r);
    if (what) return noh_fail(error, NOH_ERR_DATA, what, 0, 0);
    for (uint32_t i = 0; !NOH_PAGE && i < s->desc.kind_count && result == NOH_OK; i++) {
        result = check_kind(&r, i, error);
    }
    return result;
}

noh_result noh_stage_set_state(noh_stage *stage, const void *state, size_t bytes, noh_error *error)
{
    noh_result result;
    NOH_ASSERT(stage && state);
    result = check_state(stage, state, bytes, error);
    if (!NOH_PAGE && result == NOH_OK) result = noh_stage_check_state_clips(stage, state, error);
    if (result == NOH_OK) {
        memcpy(stage->state, state, bytes);
        memset(stage->shown, 0, stage->actor_count * sizeof *stage->shown);
        stage->events_held = 0;
    }
    return result;
}
