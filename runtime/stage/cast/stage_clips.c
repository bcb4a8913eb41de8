/* stage_clips.c: clips that are brought into a kind's reserve while the stage runs, and those that are wanted.
 *
 * A bank knows all its clips, and which of their bytes are in memory (clip_bank_reserve.c). What would start one that
 * is not asks here first. Clips in use stay: what tracks play that are on, or will be by a change that waits, and all
 * clips of a graph that plays. What is asked for together was used last, and is asked for only where it has room with
 * what plays: so bringing the rest of it takes none of it away. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "motion/anim/changes_internal.h"
#include "motion/bank/clip_bank_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/cast/stage_internal.h"
#include "stage/character/character_internal.h"

/* ---- the list of those that are wanted ---- */

/* [NOH_WANTED_CLIPS_MAX] in the stage's block; the game reads it through the statistics. NULL: no kind of the plan has
 * a reserve, and none comes (stage_slot.c) */
static noh_wanted_clip *wanted_of(const noh_stage *s)
{
    return (noh_wanted_clip *)(uintptr_t)s->stats.wanted;
}

/* clip: NOH_NONE: all of the kind */
static void forget(noh_stage *s, uint32_t kind, uint32_t clip)
{
    noh_stage_stats *stats = &s->stats;
    uint32_t left = 0;
    for (uint32_t i = 0; i < stats->wanted_count; i++) {
        const noh_wanted_clip w = stats->wanted[i];
        if (w.kind != kind || (clip != NOH_NONE && w.clip != clip)) wanted_of(s)[left++] = w;
    }
    stats->wanted_count = left;
}

static void want(noh_stage *s, const noh_stage_kind *k, uint32_t clip)
{
    noh_stage_stats *stats = &s->stats;
    const noh_pack_chunk *chunk = noh_stage_clip_chunk(k, clip);
    for (uint32_t i = 0; i < stats->wanted_count; i++) {
        if (stats->wanted[i].kind == k->bank_kind && stats->wanted[i].clip == clip) return;
    }
    if (stats->wanted_count == NOH_WANTED_CLIPS_MAX) { /* the oldest goes: perhaps it cannot be brought */
        forget(s, stats->wanted[0].kind, stats->wanted[0].clip);
    }
    noh_wanted_clip *w = &wanted_of(s)[stats->wanted_count++];
    w->kind = k->bank_kind;
    w->clip = clip;
    w->pack = k->bank->packs[clip];
    w->offset = chunk->offset;
    w->bytes = chunk->bytes;
}

void noh_stage_forget_wanted(noh_stage *s, uint32_t kind)
{
    forget(s, kind, NOH_NONE);
}

/* ---- what is used ---- */

/* What is done with each clip of a kind that something uses. */
typedef struct visit {
    const noh_stage_kind *k;
    noh_stage *wants; /* where absent ones become wanted; NULL: they do not */
    int touches;      /* 1: its time of use is now */
    uint32_t visited, absent;
} visit;

static void visit_own(visit *v, uint32_t clip)
{
    const int is_absent = noh_clip_is_absent(&v->k->bank->clips, clip);
    v->visited++;
    v->absent += is_absent ? 1u : 0u;
    if (v->touches) noh_clip_bank_touch(v->k->bank, clip);
    if (v->wants && is_absent) want(v->wants, v->k, clip);
}

/* A clip of the set: one of the bank, or one that stands for all that a source plays. */
static void visit_clip(visit *v, uint32_t clip)
{
    const uint32_t count = noh_stage_clip_count(v->k);
    const noh_module_type *type = v->k->modules[NOH_SLOT_SOURCE].type;
    uint32_t inner;
    if (clip < count) {
        visit_own(v, clip);
        return;
    }
    for (uint32_t i = 0; type && (inner = type->source->clip(v->k, clip - count, i)) != NOH_NONE; i++) {
        visit_own(v, inner);
    }
}

static int comes_on(const noh_controller *c, uint32_t track)
{
    const noh_change *changes = (const noh_change *)(const void *)((const uint8_t *)c + c->changes_offset);
    for (uint32_t i = 0; i < c->change_count; i++) {
        if (changes[i].state == NOH_CHANGE_WAITING && changes[i].kind == NOH_CHANGE_MODE && changes[i].track == track &&
            changes[i].to != NOH_TRACK_OFF)
            return 1;
    }
    return 0;
}

/* state: a copy of the stage's, or its own */
static void visit_kind(visit *v, const noh_stage *s, const uint8_t *state)
{
    const noh_stage_kind *k = v->k;
    const noh_stage_actor *actors = (const void *)(state + ((const uint8_t *)k->actors - s->state));
    for (uint32_t a = 0; a < k->desc->actor_count; a++) {
        const uint8_t *at = state + (k->characters + (size_t)a * k->character_bytes - s->state);
        const noh_controller *c = noh_character_controller((noh_character *)(uintptr_t)at);
        for (uint32_t t = 0; actors[a].alive && t < c->track_count; t++) {
            const noh_track *track = noh_controller_track(c, t);
            if (track->mode == NOH_TRACK_OFF && !comes_on(c, t)) continue;
            visit_clip(v, track->clip);
            if (track->reference) visit_clip(v, track->reference - 1u);
        }
    }
}

static int has_reserve(const noh_stage_kind *k)
{
    return k->bank && k->bank->clips.reserve;
}

/* Of all kinds that share a bank. */
static void visit_owner(visit *v, const noh_stage *s, uint32_t owner, const uint8_t *state)
{
    for (uint32_t i = owner; i < s->desc.kind_count; i++) {
        v->k = &s->kinds[i];
        if (v->k->bank_kind == owner && v->k->bank) visit_kind(v, s, state);
    }
}

static void use_clips(const noh_stage *s, uint32_t owner)
{
    visit v = { .touches = 1 };
    noh_clip_bank_tick(s->kinds[owner].bank);
    visit_owner(&v, s, owner, s->state);
}

void noh_stage_use_clips(noh_stage *s)
{
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        if (has_reserve(&s->kinds[i]) && s->kinds[i].bank_kind == i) use_clips(s, i);
    }
}

/* ---- what is there ---- */

/* What was touched since use_clips, if it is not too much together. *absent: how many of it */
static noh_result check_fit(const noh_stage *s, uint32_t owner, uint32_t *absent, noh_error *error)
{
    const noh_clip_bank *bank = s->kinds[owner].bank;
    const uint64_t need = noh_clip_bank_touched(bank, absent);
    return need <= bank->clips.reserve->room
               ? NOH_OK
               : noh_fail(error, NOH_ERR_MEMORY,
                          "what plays and clips that have to be there together fill the reserve: raise clip_reserve of "
                          "the kind to `need` bytes, or stop something",
                          owner, need);
}

static void visit_clips(visit *v, const uint32_t *clips, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (clips[i] != NOH_NONE) visit_clip(v, clips[i]);
    }
}

noh_result noh_stage_check_there(noh_stage *s, const noh_stage_kind *k, const uint32_t *clips, uint32_t count,
                                 noh_error *error)
{
    visit seen = { .k = k }, asked = { .k = k, .wants = s };
    uint32_t absent = 1;
    noh_result result = NOH_OK;
    if (!has_reserve(k)) return NOH_OK;
    visit_clips(&seen, clips, count);
    if (!seen.absent) return NOH_OK;
    if (seen.visited > 1u) { /* of one clip alone bringing says whether it has room */
        visit together = { .k = k, .touches = 1 };
        use_clips(s, k->bank_kind);
        visit_clips(&together, clips, count);
        result = check_fit(s, k->bank_kind, &absent, error);
    }
    if (result != NOH_OK) return result;
    visit_clips(&asked, clips, count);
    return noh_fail(error, NOH_ERR_NOT_FOUND,
                    "the clip, or one of the graph's, is not in memory: bring what noh_stage_stats has in wanted",
                    (uint64_t)(k - s->kinds), absent);
}

/* Of the kinds of one bank. *absent: how many were asked for */
static noh_result check_owner(noh_stage *s, uint32_t owner, const uint8_t *state, uint32_t *absent, noh_error *error)
{
    visit seen = { 0 }, together = { .touches = 1 }, asked = { .wants = s };
    noh_result result;
    *absent = 0;
    visit_owner(&seen, s, owner, state);
    if (!seen.absent) return NOH_OK;
    use_clips(s, owner);
    visit_owner(&together, s, owner, state);
    result = check_fit(s, owner, absent, error);
    if (result == NOH_OK) visit_owner(&asked, s, owner, state);
    return result;
}

noh_result noh_stage_check_state_clips(noh_stage *s, const uint8_t *state, noh_error *error)
{
    uint32_t first = 0, absent = 0;
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        uint32_t of_kind;
        if (!has_reserve(&s->kinds[i]) || s->kinds[i].bank_kind != i) continue;
        const noh_result result = check_owner(s, i, state, &of_kind, error);
        if (result != NOH_OK) return result;
        if (!absent) first = i;
        absent += of_kind;
    }
    return absent ? noh_fail(error, NOH_ERR_NOT_FOUND,
                             "state: it plays clips that are not in memory: bring what noh_stage_stats has in wanted",
                             first, absent)
                  : NOH_OK;
}

void noh_stage_empty_clips(noh_stage *s, uint32_t kind)
{
    for (uint32_t i = 0; i < s->desc.kind_count; i++) {
        const noh_stage_kind *k = &s->kinds[i];
        if (!has_reserve(k) || (kind != NOH_NONE && kind != i)) continue;
        if (k->bank_kind == i) noh_clip_bank_empty(k->bank);
    }
}

/* ---- the call ---- */

static const char *cannot_load(const noh_stage *s, uint32_t kind)
{
    if (kind >= s->desc.kind_count) return "no such kind";
    return s->phase == NOH_STAGE_IDLE ? NULL : "cannot load or ask for clips during a step or a frame";
}

static noh_result bring(noh_stage *s, noh_stage_kind *k, uint32_t clip, const void *chunk, noh_error *error)
{
    const noh_pack_chunk *own = noh_stage_clip_chunk(k, clip);
    noh_clip_header header;
    noh_result result;
    if (noh_crc32c(0, chunk, own->bytes) != own->crc)
        return noh_fail(error, NOH_ERR_DATA, "the bytes of a clip are not its chunk in the pack", clip, own->bytes);
    memcpy(&header, chunk, sizeof header);
    if (header.clip_offset > own->bytes || header.clip_bytes > own->bytes - header.clip_offset)
        return noh_fail(error, NOH_ERR_DATA, "the coded bytes of a clip are not in its chunk: build the pack again",
                        clip, own->bytes);
    use_clips(s, k->bank_kind);
    result = noh_clip_bank_bring(k->bank, clip, (const uint8_t *)chunk + header.clip_offset, header.clip_bytes, error);
    if (result == NOH_OK) {
        s->kinds[k->bank_kind].holds_all = 0;
        forget(s, k->bank_kind, clip);
    }
    return result;
}

noh_result noh_stage_load_clip(noh_stage *stage, uint32_t kind, uint32_t clip, const void *chunk, noh_error *error)
{
    const char *what;
    noh_stage_kind *k;
    NOH_ASSERT(stage);
    what = cannot_load(stage, kind);
    if (what) return noh_fail(error, NOH_ERR_ARG, what, kind, stage->desc.kind_count);
    k = &stage->kinds[kind];
    if (!has_reserve(k)) {
        return noh_fail(error, NOH_ERR_UNSUPPORTED,
                        "the clips of the kind are read in place: set clip_reserve of "
                        "noh_kind_desc",
                        kind, 0);
    }
    if (clip >= noh_stage_clip_count(k))
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the kind has no such clip", clip, noh_stage_clip_count(k));
    if (!noh_clip_is_absent(&k->bank->clips, clip)) return NOH_OK;
    if (chunk) return bring(stage, k, clip, chunk, error);
    want(stage, k, clip);
    return NOH_OK;
}
