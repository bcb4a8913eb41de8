#include "motion/anim/clip_set_internal.h"
#include "noh/base.h"
#include "noh/clip.h"

const char *noh_clip_set_excess(const noh_clip_set *set)
{
    if (set->joint_count > NOH_JOINTS_MAX) return "joint_count of a set is above NOH_JOINTS_MAX";
    if (set->float_count > NOH_FLOATS_MAX) return "float_count of a set is above NOH_FLOATS_MAX";
    return NULL;
}

static const char *bad_count(const noh_clip_set *set)
{
    if (set->clip_count == 0 || set->clip_count > NOH_CLIPS_MAX)
        return "clip_count of a set must be 1 to NOH_CLIPS_MAX";
    if (set->joint_count == 0 && set->float_count == 0) return "joint_count and float_count of a set are both 0";
    if (set->mask_count > NOH_MASKS_MAX) return "mask_count of a set is above NOH_MASKS_MAX";
    return noh_clip_set_excess(set);
}

static const char *bad_pointer(const noh_clip_set *set)
{
    if (!set->clips) return "clips of a set is NULL";
    if (!set->events && set->event_count) return "events of a set is NULL, and event_count is not 0";
    if (!set->markers && set->marker_count) return "markers of a set is NULL, and marker_count is not 0";
    if (!set->bind_pose) return "bind_pose of a set is NULL";
    if (!set->masks && set->mask_count) return "masks of a set is NULL, and mask_count is not 0";
    if (!set->sample) return "sample of a set is NULL";
    if (set->roots && set->joint_count == 0) return "roots of a set must be NULL: it has no joints";
    return NULL;
}

static const char *bad_events(const noh_clip_set *set, const noh_clip_entry *clip)
{
    const uint32_t duration = clip->duration_ticks;
    if (clip->first_event > set->event_count || clip->event_count > set->event_count - clip->first_event) {
        return "events of a clip lie outside the set's events";
    }
    for (uint32_t i = 0; i < clip->event_count; i++) {
        const noh_event_key *key = &set->events[clip->first_event + i];
        if (key->tick > duration) return "an event's tick is after the end of its clip";
        if (i > 0 && key->tick < key[-1].tick) return "events of a clip are not in tick order";
        if (!(key->weight_min >= 0.0f)) return "weight_min of an event is negative or not a number";
    }
    return NULL;
}

static const char *bad_markers(const noh_clip_set *set, const noh_clip_entry *clip)
{
    const uint32_t duration = clip->duration_ticks;
    if (clip->first_marker > set->marker_count || clip->marker_count > set->marker_count - clip->first_marker) {
        return "markers of a clip lie outside the set's markers";
    }
    for (uint32_t i = 0; i < clip->marker_count; i++) {
        const noh_marker *marker = &set->markers[clip->first_marker + i];
        if (marker->tick >= duration) return "a marker's tick is not before the end of its clip";
        if (i > 0 && marker->tick <= marker[-1].tick) return "markers of a clip are not in increasing tick order";
    }
    return NULL;
}

static const char *bad_clip(const noh_clip_set *set, const noh_clip_entry *clip)
{
    const char *what;
    if (clip->loop < NOH_LOOP_ONCE || clip->loop > NOH_LOOP_PING_PONG) return "loop of a clip is not a noh_loop";
    if (clip->duration_ticks > NOH_DURATION_MAX) return "duration_ticks of a clip is above NOH_DURATION_MAX";
    if (clip->flags & ~NOH_CLIP_FLAGS) return "flags of a clip must be bits of NOH_CLIP_FLAGS";
    what = bad_events(set, clip);
    return what ? what : bad_markers(set, clip);
}

noh_result noh_clip_set_check(const noh_clip_set *set, noh_error *error)
{
    const char *what = bad_count(set);
    what = what ? what : bad_pointer(set);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    for (uint32_t i = 0; i < set->clip_count; i++) {
        what = bad_clip(set, &set->clips[i]);
        if (what) {
            return noh_fail(error, NOH_ERR_DATA, what, i, 0);
        }
    }
    return NOH_OK;
}

uint32_t noh_clip_set_find(const noh_clip_set *set, uint32_t name_hash)
{
    for (uint32_t i = 0; i < set->clip_count; i++) {
        if (set->clips[i].name_hash == name_hash) return i;
    }
    return NOH_NONE;
}
