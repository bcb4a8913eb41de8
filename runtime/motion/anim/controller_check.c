/* Checking a controller's block: clip.h, noh_controller_check. */
#include <string.h>

#include "core/base/arena_internal.h"
#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "motion/anim/changes_internal.h"
#include "motion/anim/controller_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

/* Bounds that every step keeps. Positions beyond NOH_POSITION_MAX are rebased; the present speed of a synchronised
 * track is the mean speed of its group, in intervals per tick (at most 256), times its own interval (at most 2^28
 * ticks). */
#define SYNC_SPEED_NOW_MAX ((int64_t)1 << 53)
#define SPEED_NOW_MAX ((int64_t)1 << 61)

static int is_within(int64_t value, int64_t most)
{
    return value >= -most && value <= most;
}

static const char *bad_head(const noh_controller *c, size_t bytes, const noh_clip_set *set)
{
    const uint64_t tracks = sizeof *c, changes = tracks + (uint64_t)c->track_count * sizeof(noh_track);
    const uint64_t inertia = changes + (uint64_t)c->change_count * sizeof(noh_change);
    const int inertial = (c->flags & NOH_CONTROLLER_INERTIAL) != 0;
    noh_controller_desc d = { NULL, 0, 0, 0 };
    d.set = set;
    d.track_count = c->track_count;
    d.change_count = c->change_count;
    d.flags = inertial ? NOH_CONTROLLER_INERTIAL : 0u;
    if (c->track_count == 0 || c->change_count == 0 || noh_controller_size(&d) == 0)
        return "controller: impossible counts";
    if (c->clip_count != set->clip_count || c->joint_count != set->joint_count || c->float_count != set->float_count ||
        c->mask_count != set->mask_count)
        return "controller: made for another set";
    if (c->bytes != noh_controller_size(&d) || c->bytes > bytes)
        return "controller: its size does not match its counts";
    if (c->tracks_offset != tracks || c->changes_offset != changes) return "controller: bad offset of a table";
    if (inertial ? c->inertia_offset != inertia || c->inertia_floats_offset != inertia + 48u * (uint64_t)c->joint_count
                 : c->inertia_offset || c->inertia_floats_offset || c->inertia_ticks)
        return "controller: bad offset of inertia";
    if (!(c->priority_blend >= 0.0f && c->priority_blend <= 1.0f)) return "controller: priority_blend must be 0 to 1";
    if (c->lod_joint_count > c->joint_count || (c->joint_count && !c->lod_joint_count))
        return "controller: bad lod_joint_count";
    return NULL;
}

static const char *bad_track(const noh_clip_set *set, const noh_track *t)
{
    int64_t most = NOH_POSITION_MAX, least = -NOH_POSITION_MAX;
    if (t->clip >= set->clip_count) return "track: clip is not a clip of the set";
    if (t->mask > set->mask_count) return "track: mask is above mask_count of the set";
    if (t->loop > NOH_LOOP_PING_PONG || t->mode > NOH_TRACK_ON || t->group > NOH_GROUP_HIGH)
        return "track: bad loop, mode or group";
    if (t->sync_group > NOH_SYNC_GROUPS_MAX) return "track: sync_group is above NOH_SYNC_GROUPS_MAX";
    if (t->sync_group && (t->loop != NOH_LOOP_REPEAT || set->clips[t->clip].duration_ticks < NOH_SYNC_DURATION_MIN ||
                          set->clips[t->clip].duration_ticks > NOH_SYNC_DURATION_MAX))
        return "track: cannot be synchronised";
    if (!(t->weight >= 0.0f && t->weight <= NOH_WEIGHT_MAX)) return "track: weight must be 0 to NOH_WEIGHT_MAX";
    if (t->reference > set->clip_count) return "track: reference is not a clip of the set";
    if (!(t->full >= -1.0f && t->full <= NOH_WEIGHT_MAX)) return "track: full must be -1 to NOH_WEIGHT_MAX";
    if (!is_within(t->speed, NOH_SPEED_MAX)) return "track: speed is above NOH_SPEED_MAX";
    if (!is_within(t->speed_now, t->sync_group ? SYNC_SPEED_NOW_MAX : SPEED_NOW_MAX))
        return "track: speed_now is out of range";
    if (t->loop == NOH_LOOP_ONCE) {
        least = 0;
        most = noh_position_of(set->clips[t->clip].duration_ticks);
    }
    return t->position < least || t->position > most ? "track: its position is out of range" : NULL;
}

/* What a transition by inertia adds: of joints, then of floats. */
static const char *bad_inertia(const noh_controller *c)
{
    const float *offsets = (const float *)(const void *)((const uint8_t *)c + c->inertia_offset);
    const size_t count = c->inertia_offset ? 12u * (size_t)c->joint_count + 2u * (size_t)c->float_count : 0;
    return noh_are_sound(offsets, count) ? NULL : "controller: an inertial offset is not a number";
}

/* Whether the bits of a change's end value are a weight valid for its kind. */
static int is_weight(const noh_change *change, int64_t bits)
{
    const float most = change->kind == NOH_CHANGE_PRIORITY ? 1.0f : NOH_WEIGHT_MAX;
    const uint32_t word = (uint32_t)bits;
    float weight;
    memcpy(&weight, &word, sizeof weight);
    return bits >= 0 && bits <= UINT32_MAX && weight >= 0.0f && weight <= most;
}

/* A waiting change must be due in the future, and a running one must not be over: steps rely on both. */
static const char *bad_change(const noh_controller *c, const noh_change *change)
{
    if (change->state > NOH_CHANGE_RUNNING) return "change: bad state";
    if (change->state == NOH_CHANGE_FREE) return NULL;
    if (change->kind > NOH_CHANGE_PRIORITY || change->curve > NOH_CURVE_JUMP) return "change: bad kind or curve";
    if (change->track >= c->track_count) return "change: track is not below track_count";
    if (change->state == NOH_CHANGE_WAITING && change->start <= c->clock) return "change: waits for a tick in the past";
    if (change->state == NOH_CHANGE_RUNNING &&
        (change->start > c->clock || change->start < c->clock - (int64_t)change->duration)) {
        return "change: running before its start or after its end";
    }
    if (change->state == NOH_CHANGE_RUNNING && change->start == c->clock - (int64_t)change->duration)
        return "change: running after its end";
    switch (change->kind) {
    case NOH_CHANGE_SPEED:
        return is_within(change->to, NOH_SPEED_MAX) && is_within(change->from, NOH_SPEED_MAX) ? NULL
                                                                                              : "change: bad speed";
    case NOH_CHANGE_POSITION:
        return is_within(change->to, 2 * NOH_POSITION_MAX) && is_within(change->from, 2 * NOH_POSITION_MAX)
                   ? NULL
                   : "change: bad position";
    case NOH_CHANGE_MODE:
        return change->to >= 0 && change->to <= NOH_TRACK_ON && !change->duration ? NULL : "change: bad mode";
    default:
        return is_weight(change, change->to) && (change->state == NOH_CHANGE_WAITING || is_weight(change, change->from))
                   ? NULL
                   : "change: bad weight";
    }
}

noh_result noh_controller_check(const void *memory, size_t bytes, const noh_clip_set *set, noh_error *error)
{
    const noh_controller *c = (const noh_controller *)memory;
    const noh_result result = noh_arena_check(memory, 0, error);
    const noh_change *changes;
    const char *what;
    NOH_ASSERT(set);
    if (result) {
        return result;
    }
    what = bytes < sizeof *c ? "controller: too few bytes" : bad_head(c, bytes, set);
    if (what) {
        return noh_fail(error, NOH_ERR_DATA, what, 0, 0);
    }
    for (uint32_t i = 0; i < c->track_count; i++) {
        what = bad_track(set, noh_controller_track(c, i));
        if (what) return noh_fail(error, NOH_ERR_DATA, what, i, 0);
    }
    changes = (const noh_change *)(const void *)((const uint8_t *)memory + c->changes_offset);
    for (uint32_t i = 0; i < c->change_count; i++) {
        what = bad_change(c, &changes[i]);
        if (what) return noh_fail(error, NOH_ERR_DATA, what, i, 0);
    }
    what = bad_inertia(c);
    return what ? noh_fail(error, NOH_ERR_DATA, what, 0, 0) : NOH_OK;
}
