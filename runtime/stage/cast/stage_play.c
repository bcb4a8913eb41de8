/* stage_play.c: layers of a controller. A layer owns some tracks: what is played takes a free one, or the lightest, and
 * the others of the layer fade out. */
#include <string.h>

#include "core/base/assert_internal.h"
#include "motion/anim/changes_internal.h"
#include "motion/anim/controller_pose_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "core/base/math_internal.h"
#include "motion/pose/inertial_internal.h"
#include "stage/cast/stage_internal.h"

#define FADE_TICKS 9600u

typedef noh_stage_player player;

noh_result noh_stage_open_player(noh_stage *s, noh_actor actor, uint32_t layer, player *p, noh_error *error)
{
    const noh_result result = noh_stage_change(s, actor, &p->a, &p->k, error);
    if (result != NOH_OK) {
        return result;
    }
    if (layer >= p->k->layer_count) {
        return noh_fail(error, NOH_ERR_ARG, "the kind has no such layer", layer, p->k->layer_count);
    }
    p->s = s;
    p->layer = &p->k->layers[layer];
    p->layer_index = layer;
    p->reference = 0;
    p->c = noh_character_controller(noh_stage_character(p->k, noh_stage_index(p->k, p->a)));
    return NOH_OK;
}

static noh_track *track_at(const player *p, uint32_t i)
{
    return &noh_controller_tracks(p->c)[p->layer->first_track + i];
}

/* ---- the track that was started last ---- */

static uint32_t started(const noh_stage_actor *a, uint32_t layer)
{
    return a->started[layer / 8u] >> 4u * (layer % 8u) & 15u;
}

static void set_started(noh_stage_actor *a, uint32_t layer, uint32_t track)
{
    uint32_t *word = &a->started[layer / 8u];
    const uint32_t shift = 4u * (layer % 8u);
    *word = (*word & ~(15u << shift)) | track << shift;
}

const noh_track *noh_actor_track(const noh_stage *stage, noh_actor actor, uint32_t layer)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    const noh_controller *c;
    const noh_track *track;
    if (!a || layer >= k->layer_count) {
        return NULL;
    }
    c = noh_character_controller(noh_stage_character(k, noh_stage_index(k, a)));
    track = noh_controller_track(c, k->layers[layer].first_track + started(a, layer));
    return track->mode == NOH_TRACK_OFF ? NULL : track;
}

noh_controller *noh_actor_controller(noh_stage *stage, noh_actor actor, const noh_clip_set **set)
{
    noh_stage_kind *k;
    const noh_stage_actor *a = noh_stage_actor_of(stage, actor, &k);
    if (!a) {
        return NULL;
    }
    if (set) {
        *set = &k->set;
    }
    return noh_character_controller(noh_stage_character(k, noh_stage_index(k, a)));
}

/* ---- fading ---- */

static uint32_t free_changes(const player *p)
{
    const noh_change *changes = (const noh_change *)(const void *)((const uint8_t *)p->c + p->c->changes_offset);
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->c->change_count; i++) {
        count += changes[i].state == NOH_CHANGE_FREE;
    }
    return count;
}

/* Fade a track out, and switch it off then. */
static noh_result fade_out(player *p, uint32_t i, uint32_t ticks, noh_error *error)
{
    noh_change_desc d;
    noh_result result;
    const uint32_t track = p->layer->first_track + i;
    if (ticks <= 1u) {
        return noh_controller_set_mode(p->c, track, NOH_TRACK_OFF);
    }
    memset(&d, 0, sizeof d);
    d.kind = NOH_CHANGE_WEIGHT;
    d.track = track;
    d.duration_ticks = ticks;
    d.curve = NOH_CURVE_SMOOTHSTEP;
    result = noh_controller_change(p->c, &p->k->set, &d, error);
    if (result == NOH_OK) {
        d.kind = NOH_CHANGE_MODE;
        d.delay_ticks = ticks;
        d.duration_ticks = 0;
        d.mode = NOH_TRACK_OFF;
        result = noh_controller_change(p->c, &p->k->set, &d, error);
    }
    return result;
}

static noh_result fade_in(player *p, uint32_t i, float weight, uint32_t ticks, noh_error *error)
{
    noh_change_desc d;
    memset(&d, 0, sizeof d);
    d.kind = NOH_CHANGE_WEIGHT;
    d.track = p->layer->first_track + i;
    d.duration_ticks = ticks;
    d.curve = NOH_CURVE_SMOOTHSTEP;
    d.weight = weight;
    return noh_controller_change(p->c, &p->k->set, &d, error);
}

static noh_result fade_others(player *p, uint32_t but, uint32_t ticks, noh_error *error)
{
    noh_result result = NOH_OK;
    for (uint32_t i = 0; i < p->layer->track_count && result == NOH_OK; i++) {
        if (i != but && track_at(p, i)->mode != NOH_TRACK_OFF) {
            result = fade_out(p, i, ticks, error);
        }
    }
    return result;
}

/* ---- the bind pose behind a base layer ----
 *
 * The weights of base layers are relative, so a layer that plays alone would show in full until its weight is 0. What
 * fades it out, or in while it fades out, therefore says how far its tracks hide the bind pose. */

static int is_heard(const noh_track *t)
{
    return t->mode != NOH_TRACK_OFF && t->weight > 0.0f;
}

/* The layer fades to what else plays, or to the bind pose: its tracks hide less of it by and by. */
static void let_go(player *p)
{
    for (uint32_t i = 0; i < p->layer->track_count; i++) {
        noh_track *t = track_at(p, i);
        if (p->layer->mode != NOH_LAYER_BASE || !is_heard(t)) continue;
        t->full = t->weight / noh_track_cover(t);
        if (t->full > NOH_WEIGHT_MAX) t->full = NOH_WEIGHT_MAX;
        t->flags = (uint8_t)(t->flags & ~NOH_TRACK_RISES);
    }
}

/* Track `next` is about to fade in while the layer's others fade out. What they hide of the bind pose they hide until
 * they end; if that is not all of it, `next` hides the rest by and by. */
static void take_over(player *p, uint32_t next, float weight)
{
    float most = 0.0f;
    for (uint32_t i = 0; i < p->layer->track_count; i++) {
        noh_track *t = track_at(p, i);
        float cover;
        if (i == next || !is_heard(t)) continue;
        cover = noh_track_cover(t);
        t->full = cover < 1.0f ? -cover : 0.0f;
        if (cover > most) most = cover;
    }
    if (most > 0.0f && most < 1.0f) {
        track_at(p, next)->full = weight;
        track_at(p, next)->flags |= NOH_TRACK_RISES;
    }
}

/* ---- playing ---- */

static uint32_t free_track(const player *p)
{
    uint32_t lightest = 0;
    for (uint32_t i = 0; i < p->layer->track_count; i++) {
        if (track_at(p, i)->mode == NOH_TRACK_OFF) return i;
        if (track_at(p, i)->weight < track_at(p, lightest)->weight) lightest = i;
    }
    return lightest;
}

/* Whether a clip stands for what the kind's source plays. */
static int is_source(const player *p, uint32_t clip)
{
    return p->k->modules[NOH_SLOT_SOURCE].type && clip >= noh_stage_clip_count(p->k);
}

/* What a source plays and another one of its kind is to replace does not count: it ends at once. */
static int something_plays(const player *p, uint32_t but, int for_source)
{
    for (uint32_t i = 0; i < p->layer->track_count; i++) {
        const noh_track *t = track_at(p, i);
        if (i != but && t->mode != NOH_TRACK_OFF && t->weight > 0.0f && !(for_source && is_source(p, t->clip)))
            return 1;
    }
    return 0;
}

/* A source plays one thing at a time: what plays of it ends on all layers, and the new one begins. */
static void change_source(player *p, uint32_t clip)
{
    noh_change *changes = (noh_change *)(void *)((uint8_t *)p->c + p->c->changes_offset);
    if (!is_source(p, clip)) {
        return;
    }
    for (uint32_t i = 0; i < p->c->track_count; i++) {
        if (!is_source(p, noh_controller_track(p->c, i)->clip)) continue;
        noh_changes_drop(changes, p->c->change_count, i);
        (void)noh_controller_set_mode(p->c, i, NOH_TRACK_OFF);
    }
    p->k->modules[NOH_SLOT_SOURCE].type->source->begin(p->k, noh_stage_index(p->k, p->a),
                                                       clip - noh_stage_clip_count(p->k));
    p->s->source_begun = 1;
}

/* The position of a clip at the same part of its pass as what plays now. */
static int64_t phase_ticks(const player *p, uint32_t clip)
{
    const noh_track *from = track_at(p, started(p->a, p->layer_index));
    const noh_clip_entry *old, *next = &p->k->set.clips[clip];
    if (from->mode == NOH_TRACK_OFF || is_source(p, from->clip)) {
        return 0;
    }
    old = &p->k->set.clips[from->clip];
    return old->duration_ticks
               ? (int64_t)((uint64_t)noh_track_clip_tick(from, old, 0) * next->duration_ticks / old->duration_ticks)
               : 0;
}

static noh_track_desc track_desc(const player *p, uint32_t clip, const noh_play *play, int silent)
{
    noh_track_desc d;
    memset(&d, 0, sizeof d);
    d.clip = clip;
    d.position_ticks = play->flags & NOH_PLAY_PHASE ? phase_ticks(p, clip) : play->start_ticks;
    d.speed = play->speed;
    d.weight = play->weight;
    d.loop = play->loop;
    d.sync_group = play->sync_group;
    d.mask = p->layer->mask;
    d.group = p->layer->mode == NOH_LAYER_OVER ? NOH_GROUP_HIGH : NOH_GROUP_LOW;
    if (p->layer->mode == NOH_LAYER_ADD) {
        d.flags |= NOH_TRACK_ADDITIVE | (play->flags & NOH_PLAY_FROM_BIND ? 0u : NOH_TRACK_REFERENCE_START);
        d.reference = p->reference;
    }
    if (silent) d.flags |= NOH_TRACK_SILENT;
    return d;
}

static noh_result no_change_free(uint32_t wanted, noh_error *error)
{
    return noh_fail(error, NOH_ERR_LIMIT, "too many changes over time are under way: raise change_count", 0, wanted);
}

/* Room for the changes of all tracks of the layer: checked first, so that a call that fails has changed nothing. What
 * the tracks that are faded have waiting is ended before. */
static noh_result make_room(player *p, uint32_t but, noh_error *error)
{
    noh_change *changes = (noh_change *)(void *)((uint8_t *)p->c + p->c->changes_offset);
    uint32_t wanted = 1, own = 0;
    for (uint32_t i = 0; i < p->layer->track_count; i++) {
        wanted += i != but && track_at(p, i)->mode != NOH_TRACK_OFF ? 2u : 0u;
    }
    for (uint32_t i = 0; i < p->c->change_count; i++) {
        own += changes[i].state != NOH_CHANGE_FREE && changes[i].track - p->layer->first_track < p->layer->track_count;
    }
    if (free_changes(p) + own < wanted) {
        return no_change_free(wanted, error);
    }
    for (uint32_t i = 0; i < p->layer->track_count; i++) {
        noh_changes_drop(changes, p->c->change_count, p->layer->first_track + i);
    }
    return NOH_OK;
}

/* The kind's set, with the poses of the actor's source now and a moment ago. */
static noh_clip_set set_for_inertia(const player *p, noh_stage_sampler *sampler)
{
    const noh_module_type *type = p->k->modules[NOH_SLOT_SOURCE].type;
    noh_clip_set set = p->k->set;
    if (type) {
        type->source->sample(p->s, &p->s->jobs[0], p->k, noh_stage_index(p->k, p->a), 0, NOH_INERTIA_BEFORE_TICKS, &set,
                             sampler);
    }
    return set;
}

/* Over to a clip by inertia: it alone plays on the layer from now on, and the leap decays. */
static noh_result leap(player *p, uint32_t clip, const noh_play *play, noh_error *error)
{
    const uint32_t ticks = play->fade_ticks ? play->fade_ticks : FADE_TICKS, track = free_track(p);
    const noh_track_desc d = track_desc(p, clip, play, 0);
    noh_pose_scratch scratch;
    noh_stage_sampler sampler;
    noh_clip_set set = set_for_inertia(p, &sampler);
    noh_track probe;
    noh_result result = noh_track_start(&probe, &set, &d, error);
    if (result == NOH_OK) {
        result = noh_pose_scratch_init(p->s->inertia_scratch, p->s->inertia_bytes, &set, 1, &scratch, error);
    }
    if (result == NOH_OK) result = noh_controller_inertia_capture(p->c, &set, &scratch, error);
    if (result == NOH_OK) result = make_room(p, track, error);
    if (result == NOH_OK) change_source(p, clip);
    if (result == NOH_OK) result = fade_others(p, track, 1, error);
    if (result == NOH_OK) {
        result = noh_controller_start(p->c, &p->k->set, p->layer->first_track + track, &d, error);
    }
    set = set_for_inertia(p, &sampler);
    if (result == NOH_OK) result = noh_controller_inertia_begin(p->c, &set, &scratch, ticks, error);
    if (result == NOH_OK) {
        set_started(p->a, p->layer_index, track);
        noh_character_wake(noh_stage_character(p->k, noh_stage_index(p->k, p->a)));
    }
    return result;
}

/* Find a free track, and a free change for its fade in, while other tracks continue to play. */
static noh_result make_room_beside(const player *p, uint32_t track, noh_error *error)
{
    if (track_at(p, track)->mode != NOH_TRACK_OFF) {
        return noh_fail(error, NOH_ERR_LIMIT, "all tracks of the layer play: raise its track_count", p->layer_index,
                        p->layer->track_count + 1u);
    }
    return free_changes(p) ? NOH_OK : no_change_free(1, error);
}

static noh_result begin(player *p, uint32_t clip, const noh_play *play, noh_error *error)
{
    const int beside = (play->flags & NOH_PLAY_BESIDE) != 0;
    const uint32_t ticks = play->fade_ticks ? play->fade_ticks : FADE_TICKS, track = free_track(p);
    const float weight = play->weight > 0.0f ? play->weight : 1.0f;
    const int from_nothing = p->layer->mode == NOH_LAYER_BASE && p->layer->moves_joints &&
                             !something_plays(p, track, is_source(p, clip));
    const int at_once = ticks <= 1u || from_nothing;
    const noh_track_desc d = track_desc(p, clip, play, !at_once);
    noh_track probe;
    noh_result result = noh_track_start(&probe, &p->k->set, &d, error);
    if (result == NOH_OK) result = beside ? make_room_beside(p, track, error) : make_room(p, track, error);
    if (result == NOH_OK) change_source(p, clip);
    if (result == NOH_OK) {
        result = noh_controller_start(p->c, &p->k->set, p->layer->first_track + track, &d, error);
    }
    if (result == NOH_OK && !beside) result = fade_others(p, track, ticks, error);
    if (result == NOH_OK && !at_once) {
        if (!beside && p->layer->mode == NOH_LAYER_BASE) take_over(p, track, weight);
        result = fade_in(p, track, weight, ticks, error);
    }
    if (result == NOH_OK) {
        set_started(p->a, p->layer_index, track);
        noh_character_wake(noh_stage_character(p->k, noh_stage_index(p->k, p->a)));
    }
    return result;
}

noh_result noh_stage_leap_to(noh_stage *stage, noh_actor actor, uint32_t layer, uint32_t clip, uint32_t ticks,
                             const uint32_t *but, uint32_t but_count, noh_error *error)
{
    noh_play play = { .fade_ticks = 1, .loop = NOH_LOOP_ONCE };
    noh_inertia_joint *left;
    player p;
    noh_result result = noh_stage_open_player(stage, actor, layer, &p, error);
    if (!NOH_PAGE && result == NOH_OK) result = noh_stage_check_there(stage, p.k, &clip, 1, error);
    if (result != NOH_OK) return result;
    if (!p.k->desc->inertia) return begin(&p, clip, &play, error);
    play.fade_ticks = ticks;
    result = leap(&p, clip, &play, error);
    left = (noh_inertia_joint *)(void *)((uint8_t *)p.c + p.c->inertia_offset);
    for (uint32_t i = 0; i < but_count && result == NOH_OK; i++) memset(&left[but[i]], 0, sizeof *left);
    return result;
}

/* Whether the clip plays already, and is not on its way out. */
static int plays(const player *p, uint32_t clip)
{
    const noh_change *changes = (const noh_change *)(const void *)((const uint8_t *)p->c + p->c->changes_offset);
    const uint32_t i = started(p->a, p->layer_index);
    const noh_track *track = track_at(p, i);
    for (uint32_t c = 0; c < p->c->change_count; c++) {
        if (changes[c].state == NOH_CHANGE_WAITING && changes[c].kind == NOH_CHANGE_MODE &&
            changes[c].track == p->layer->first_track + i && changes[c].to == NOH_TRACK_OFF) {
            return 0;
        }
    }
    return track->mode != NOH_TRACK_OFF && track->clip == clip && !noh_track_ended(track, &p->k->set.clips[clip]);
}

noh_result noh_stage_play_clip(player *p, uint32_t clip, const noh_play *play, noh_error *error)
{
    if ((play->flags & NOH_PLAY_KEEP) && plays(p, clip)) {
        return NOH_OK;
    }
    if ((play->flags & NOH_PLAY_INERTIA) && !p->k->desc->inertia) {
        return noh_fail(error, NOH_ERR_ARG, "the kind has no room for inertia: set noh_kind_desc.inertia",
                        (uint64_t)(p->k - p->s->kinds), 0);
    }
    if (!NOH_PAGE) {
        const uint32_t clips[2] = { clip, p->reference ? p->reference - 1u : NOH_NONE };
        const noh_result result = noh_stage_check_there(p->s, p->k, clips, 2, error);
        if (result != NOH_OK) return result;
    }
    return play->flags & NOH_PLAY_INERTIA ? leap(p, clip, play, error) : begin(p, clip, play, error);
}

static const char *bad_play(const player *p, const noh_play *play)
{
    if (play->flags & ~(NOH_PLAY_KEEP | NOH_PLAY_PHASE | NOH_PLAY_INERTIA | NOH_PLAY_BESIDE | NOH_PLAY_FROM_BIND))
        return "flags of a play has unknown bits";
    if ((play->flags & NOH_PLAY_INERTIA) && (play->flags & NOH_PLAY_BESIDE))
        return "flags of a play: NOH_PLAY_INERTIA and NOH_PLAY_BESIDE exclude each other";
    if ((play->reference || (play->flags & NOH_PLAY_FROM_BIND)) && p->layer->mode != NOH_LAYER_ADD)
        return "a play has a reference, but its layer is not additive: use a layer of NOH_LAYER_ADD";
    if (play->reference && (play->flags & NOH_PLAY_FROM_BIND))
        return "a play has a reference and NOH_PLAY_FROM_BIND: leave one out";
    return NULL;
}

noh_result noh_actor_play(noh_stage *stage, noh_actor actor, uint32_t layer, const char *clip, const noh_play *play,
                          noh_error *error)
{
    static const noh_play plain;
    const noh_play *how = play ? play : &plain;
    const char *what;
    uint32_t index;
    player p;
    const noh_result result = noh_stage_open_player(stage, actor, layer, &p, error);
    NOH_ASSERT(clip);
    if (result != NOH_OK) {
        return result;
    }
    index = noh_stage_find(stage, (uint32_t)(p.k - stage->kinds), NOH_NAME_CLIP, clip);
    if (index == NOH_NONE) {
        return noh_fail(
            error, NOH_ERR_NOT_FOUND,
            "the kind has no clip of that name: noh info lists a pack's clips; clips of other skeletons are left out",
            (uint64_t)(p.k - stage->kinds), noh_stage_clip_count(p.k));
    }
    what = bad_play(&p, how);
    if (what) return noh_fail(error, NOH_ERR_ARG, what, how->flags, 0);
    if (how->reference) {
        const uint32_t reference = noh_stage_find(stage, (uint32_t)(p.k - stage->kinds), NOH_NAME_CLIP, how->reference);
        if (reference == NOH_NONE) {
            return noh_fail(error, NOH_ERR_NOT_FOUND, "the kind has no clip of the name of the reference",
                            (uint64_t)(p.k - stage->kinds), noh_stage_clip_count(p.k));
        }
        p.reference = reference + 1u;
    }
    return noh_stage_play_clip(&p, index, how, error);
}

noh_result noh_actor_stop(noh_stage *stage, noh_actor actor, uint32_t layer, uint32_t fade_ticks, noh_error *error)
{
    player p;
    noh_result result = noh_stage_open_player(stage, actor, layer, &p, error);
    if (result == NOH_OK) result = make_room(&p, NOH_NONE, error);
    if (result == NOH_OK) let_go(&p);
    if (result == NOH_OK) result = fade_others(&p, NOH_NONE, fade_ticks ? fade_ticks : FADE_TICKS, error);
    if (result == NOH_OK) noh_character_wake(noh_stage_character(p.k, noh_stage_index(p.k, p.a)));
    return result;
}

/* ---- held floats ---- */

noh_result noh_actor_hold_float(noh_stage *stage, noh_actor actor, uint32_t index, float value, float amount,
                                noh_error *error)
{
    noh_stage_actor *a;
    noh_stage_kind *k;
    noh_stage_held *held, *at = NULL;
    const noh_result result = noh_stage_change(stage, actor, &a, &k, error);
    if (result != NOH_OK) {
        return result;
    }
    if (index >= k->float_count) {
        return noh_fail(error, NOH_ERR_NOT_FOUND, "the kind has no such float", index, k->float_count);
    }
    if (!noh_is_number(value) || !(amount >= 0.0f && amount <= 1.0f)) {
        return noh_fail(error, NOH_ERR_ARG, "a held float is not a number, or its amount is not in 0..1", index, 0);
    }
    held = k->held + (size_t)noh_stage_index(k, a) * k->desc->held_float_count;
    for (uint32_t i = 0; i < k->desc->held_float_count; i++) {
        if (held[i].amount > 0.0f && held[i].index == index) {
            at = &held[i];
            break;
        }
        if (!at && !(held[i].amount > 0.0f)) at = &held[i];
    }
    if (!at && amount > 0.0f) {
        return noh_fail(error, NOH_ERR_LIMIT, "no held float left: raise held_float_count of the kind", index,
                        k->desc->held_float_count);
    }
    if (at) {
        at->index = index;
        at->value = value;
        at->amount = amount;
    }
    return NOH_OK;
}
