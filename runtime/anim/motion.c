#include "anim/motion.h"

static const char *bad_count(const noh_anim_set *set)
{
    if (set->motion_count == 0 || set->motion_count > NOH_MOTIONS_MAX) return "motion_count of a set is 0, or above NOH_MOTIONS_MAX";
    if (set->joint_count > NOH_JOINTS_MAX) return "joint_count of a set is above NOH_JOINTS_MAX";
    if (set->joint_count == 0 && set->float_count == 0) return "joint_count and float_count of a set are both 0";
    if (set->float_count > NOH_FLOATS_MAX) return "float_count of a set is above NOH_FLOATS_MAX";
    if (set->mask_count > NOH_MASKS_MAX) return "mask_count of a set is above NOH_MASKS_MAX";
    return NULL;
}

static const char *bad_pointer(const noh_anim_set *set)
{
    if (!set->motions) return "motions of a set is NULL";
    if (!set->events && set->event_count) return "events of a set is NULL, and event_count is not 0";
    if (!set->markers && set->marker_count) return "markers of a set is NULL, and marker_count is not 0";
    if (!set->bind_pose) return "bind_pose of a set is NULL";
    if (!set->masks && set->mask_count) return "masks of a set is NULL, and mask_count is not 0";
    if (!set->sample) return "sample of a set is NULL";
    if (set->roots && set->joint_count == 0) return "roots of a set without joints";
    return NULL;
}

static const char *bad_events(const noh_anim_set *set, const noh_motion *motion)
{
    const uint32_t duration = motion->duration_ticks;
    if (motion->first_event > set->event_count || motion->event_count > set->event_count - motion->first_event) {
        return "event range of a clip passes the set's events";
    }
    for (uint32_t i = 0; i < motion->event_count; i++) {
        const noh_event_key *key = &set->events[motion->first_event + i];
        if (key->tick > duration) return "event tick past the duration of its clip";
        if (i > 0 && key->tick < key[-1].tick) return "event order of a clip: ticks fall";
        if (!(key->weight_min >= 0.0f)) return "event weight_min is negative or not a number";
    }
    return NULL;
}

static const char *bad_markers(const noh_anim_set *set, const noh_motion *motion)
{
    const uint32_t duration = motion->duration_ticks;
    if (motion->first_marker > set->marker_count || motion->marker_count > set->marker_count - motion->first_marker) {
        return "marker range of a clip passes the set's markers";
    }
    for (uint32_t i = 0; i < motion->marker_count; i++) {
        const noh_marker *marker = &set->markers[motion->first_marker + i];
        if (marker->tick >= duration) return "marker tick past the duration of its clip";
        if (i > 0 && marker->tick <= marker[-1].tick) return "marker order of a clip: ticks do not rise";
    }
    return NULL;
}

static const char *bad_motion(const noh_anim_set *set, const noh_motion *motion)
{
    const char *what;
    if (motion->loop < NOH_LOOP_ONCE || motion->loop > NOH_LOOP_PING_PONG) return "loop of a clip is no loop mode";
    if (motion->duration_ticks > NOH_DURATION_MAX) return "duration_ticks of a clip is above NOH_DURATION_MAX";
    if (motion->flags & ~NOH_MOTION_FLAGS) return "motion flags of a clip hold unknown bits";
    what = bad_events(set, motion);
    return what ? what : bad_markers(set, motion);
}

noh_result noh_anim_set_check(const noh_anim_set *set, noh_error *error)
{
    const char *what = bad_count(set);
    what = what ? what : bad_pointer(set);
    if (what) {
        return noh_fail(error, NOH_ERR_ARG, what, 0, 0);
    }
    for (uint32_t i = 0; i < set->motion_count; i++) {
        what = bad_motion(set, &set->motions[i]);
        if (what) {
            return noh_fail(error, NOH_ERR_DATA, what, i, 0);
        }
    }
    return NOH_OK;
}

uint32_t noh_anim_set_find(const noh_anim_set *set, uint32_t name_hash)
{
    for (uint32_t i = 0; i < set->motion_count; i++) {
        if (set->motions[i].name_hash == name_hash) return i;
    }
    return NOH_NONE;
}
