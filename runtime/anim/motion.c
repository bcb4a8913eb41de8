#include "anim/motion.h"

static const char *bad_count(const noh_anim_set *set)
{
    if (set->motion_count == 0 || set->motion_count > NOH_MOTIONS_MAX) return "motion_count";
    if (set->joint_count > NOH_JOINTS_MAX || (set->joint_count == 0 && set->float_count == 0)) return "joint_count";
    if (set->float_count > NOH_FLOATS_MAX) return "float_count";
    if (set->mask_count > NOH_MASKS_MAX) return "mask_count";
    return NULL;
}

static const char *bad_pointer(const noh_anim_set *set)
{
    if (!set->motions) return "motions";
    if (!set->events && set->event_count) return "events";
    if (!set->markers && set->marker_count) return "markers";
    if (!set->bind_pose) return "bind_pose";
    if (!set->masks && set->mask_count) return "masks";
    if (!set->sample) return "sample";
    if (set->roots && set->joint_count == 0) return "roots";
    return NULL;
}

static const char *bad_events(const noh_anim_set *set, const noh_motion *motion)
{
    const noh_event_key *keys;
    if (motion->first_event > set->event_count || motion->event_count > set->event_count - motion->first_event) {
        return "event range";
    }
    keys = set->events + motion->first_event;
    for (uint32_t i = 0; i < motion->event_count; i++) {
        if (keys[i].tick > motion->duration_ticks) return "event tick past the duration";
        if (i > 0 && keys[i].tick < keys[i - 1].tick) return "event order";
        if (!(keys[i].weight_min >= 0.0f)) return "event weight_min"; /* NaN too */
    }
    return NULL;
}

static const char *bad_markers(const noh_anim_set *set, const noh_motion *motion)
{
    const noh_marker *markers;
    if (motion->first_marker > set->marker_count || motion->marker_count > set->marker_count - motion->first_marker) {
        return "marker range";
    }
    markers = set->markers + motion->first_marker;
    for (uint32_t i = 0; i < motion->marker_count; i++) {
        if (markers[i].tick >= motion->duration_ticks) return "marker tick past the duration";
        if (i > 0 && markers[i].tick <= markers[i - 1].tick) return "marker order";
    }
    return NULL;
}

static const char *bad_motion(const noh_anim_set *set, const noh_motion *motion)
{
    const char *what;
    if (motion->loop < NOH_LOOP_ONCE || motion->loop > NOH_LOOP_PING_PONG) return "loop";
    if (motion->duration_ticks > NOH_DURATION_MAX) return "duration_ticks";
    if (motion->flags & ~NOH_MOTION_FLAGS) return "motion flags";
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
    uint32_t i = 0;
    while (i < set->motion_count && set->motions[i].name_hash != name_hash) {
        i++;
    }
    return i;
}
