#include "core/base/assert_internal.h"
#include "motion/anim/tracks_internal.h"
#include "stage/character/time_lod_internal.h"
#include "noh/clip.h"
#include "noh/low_stage.h"

#include <string.h>

#include "motion/anim/clock_internal.h"

uint32_t noh_update_period(noh_update_rate rate)
{
    static const uint32_t periods[NOH_UPDATE_RATE_COUNT] = { 0, NOH_TICKS_PER_SECOND / 30u, NOH_TICKS_PER_SECOND / 15u,
                                                             NOH_TICKS_PER_SECOND / 8u };
    NOH_ASSERT((unsigned)rate < NOH_UPDATE_RATE_COUNT);
    return periods[rate];
}

void noh_time_lod_init(noh_time_lod *t, uint32_t instance)
{
    NOH_ASSERT(t);
    memset(t, 0, sizeof *t);
    t->instance = instance;
}

/* The instance's first update tick after a clock. Update ticks are a period apart; their phase is the fractional part
 * of instance * golden ratio, in 32-bit fixed point, times the period. */
static int64_t next_due(uint32_t instance, int64_t clock, uint32_t period)
{
    const uint32_t golden = 2654435769u; /* 2^32 divided by the golden ratio */
    int64_t phase = (int64_t)(((uint64_t)(instance * golden) * period) >> 32),
            rest = noh_clock_since(clock, phase) % (int64_t)period;
    return noh_clock_add(clock, (int64_t)period - (rest < 0 ? rest + (int64_t)period : rest));
}

void noh_time_lod_frame(noh_time_lod *t, int64_t clock, noh_update_rate rate)
{
    NOH_ASSERT(t && (unsigned)rate < NOH_UPDATE_RATE_COUNT);
    const int64_t shown = noh_clock_add(clock, -(int64_t)t->behind_ticks), ticks = noh_clock_since(shown, t->clock);
    t->frame_ticks = ticks < 0 ? 0 : ticks > UINT32_MAX ? UINT32_MAX : (uint32_t)ticks;
    t->clock = shown;
    t->chosen_rate = (uint8_t)rate;
    if (rate < t->shown_rate) {
        noh_time_lod_wake(t); /* the current mix is too coarse now */
    }
}

noh_due noh_time_lod_due(const noh_time_lod *t)
{
    NOH_ASSERT(t);
    int unseen = t->frame_ticks > NOH_TIME_LOD_UNSEEN_TICKS;
    if (!t->posed || (unseen && t->clock > t->to_clock)) {
        return NOH_DUE_AT_ONCE;
    }
    return t->clock >= t->due_clock ? NOH_DUE : NOH_DUE_NOT;
}

uint32_t noh_time_lod_late(const noh_time_lod *t)
{
    NOH_ASSERT(t);
    int64_t late = noh_clock_since(t->clock, t->due_clock);
    return late < 0 || !t->posed ? 0 : late > UINT32_MAX ? UINT32_MAX : (uint32_t)late;
}

/* The game's clock in this frame. */
static int64_t present(const noh_time_lod *t)
{
    return noh_clock_add(t->clock, t->behind_ticks);
}

/* Pose the instance for the present, and show only this pose. */
static noh_time_update update_exactly(noh_time_lod *t)
{
    noh_time_update u = { 0, 1.0f, 0 };
    t->from_clock = t->to_clock = present(t);
    t->due_clock = noh_clock_add(t->clock, 1);       /* due in the next frame */
    if (t->behind_ticks) t->due_clock = t->to_clock; /* due after the next step */
    u.pose_clock = t->to_clock;
    u.pose = t->to_pose;
    return u;
}

/* The end of a mix that begins at from_clock: the instance's next update tick, but at most a period away. After a
 * restart, when source and target may differ greatly, it is at least half a period away, so that the shown motion is
 * not rushed. A controller cannot play backwards, so the end is never before the game's clock.
 * period  0: at the game's clock */
static int64_t interval_end(const noh_time_lod *t, uint32_t period, int restart)
{
    const int64_t longest = noh_clock_add(t->from_clock, period), soonest = present(t);
    const int64_t shortest = noh_clock_add(t->from_clock, period / 2u);
    int64_t end = period ? next_due(t->instance, t->clock, period) : soonest;
    end = end > longest ? longest : end;
    end = restart && end < shortest ? shortest : end;
    return end < soonest ? soonest : end;
}

/* Pose the instance for its next update. The new mix must begin with the currently shown pose to avoid a jump; there
 * are three cases:
 *   in time  the mix has just ended, within the last frame: its target is the new source, and the new mix begins where
 *            it ended, not at this frame, so that frames that fall between update ticks lose no time
 *   early    the mix is still under way (noh_time_lod_wake): the mix as it is now becomes the source, from now on
 *   held     the target has been shown for more than a frame (the scheduler was late): it is the source, from now on */
static noh_time_update update_ahead(noh_time_lod *t, uint32_t period)
{
    noh_time_update u = { 0, 1.0f, 0 };
    const int early = t->clock < t->to_clock;
    const int held = t->to_clock < noh_clock_add(t->clock, -(int64_t)t->frame_ticks);
    if (early) {
        u.keep = noh_time_lod_fraction(t);
    } else {
        t->to_pose ^= 1u;
    }
    t->from_clock = early || held ? t->clock : t->to_clock;
    t->to_clock = t->due_clock = interval_end(t, period, early || held);
    u.pose_clock = t->to_clock;
    u.pose = t->to_pose;
    return u;
}

noh_time_update noh_time_lod_update(noh_time_lod *t)
{
    NOH_ASSERT(t->to_pose < 2u);
    uint32_t period = noh_update_period((noh_update_rate)t->chosen_rate);
    int exact = noh_time_lod_due(t) == NOH_DUE_AT_ONCE;
    if (t->frame_ticks >= period) {
        period = 0;
        exact |= t->behind_ticks == 0;
    }
    t->posed = 1;
    t->shown_rate = t->chosen_rate;
    return exact ? update_exactly(t) : update_ahead(t, period);
}

float noh_time_lod_fraction(const noh_time_lod *t)
{
    NOH_ASSERT(t);
    int64_t since = noh_clock_since(t->clock, t->from_clock), span = noh_clock_since(t->to_clock, t->from_clock);
    return since >= span || span <= 0 ? 1.0f : since > 0 ? (float)since / (float)span : 0.0f;
}

void noh_time_lod_wake(noh_time_lod *t)
{
    NOH_ASSERT(t);
    t->due_clock = t->clock < t->due_clock ? t->clock : t->due_clock;
}

/* The square of a track's playback speed, its own or its sync group's, whichever is faster; at least 1. Between two
 * updates a mix differs from a smooth motion by up to period^2 / 8 times the acceleration (the error of linear
 * interpolation), and a clip played s times as fast has s^2 times the acceleration. */
static float speed_squared(const noh_track *track)
{
    const float present = (float)track->speed_now / (float)NOH_SPEED_ONE,
                own = (float)track->speed / (float)NOH_SPEED_ONE;
    const float square = present * present > own * own ? present * present : own * own;
    return square > 1.0f ? square : 1.0f;
}

/* Blended tracks are averaged, and the error of a mean of poses is at most their largest error; additive tracks add
 * their weighted errors. */
void noh_time_lod_error(const noh_controller *c, const float *clip_error_m, float *error_m)
{
    float added[NOH_UPDATE_RATE_COUNT] = { 0.0f };
    NOH_ASSERT(c && clip_error_m && error_m);
    for (int r = 0; r < NOH_UPDATE_RATE_COUNT; r++) {
        error_m[r] = 0.0f;
    }
    for (uint32_t i = 0; i < c->track_count; i++) {
        const noh_track *track = noh_controller_track(c, i);
        const float *of_clip = clip_error_m + (size_t)track->clip * NOH_UPDATE_RATE_COUNT;
        if (track->mode != NOH_TRACK_ON || !(track->weight > 0.0f)) {
            continue;
        }
        for (int r = 0; r < NOH_UPDATE_RATE_COUNT; r++) {
            float off = of_clip[r] * speed_squared(track) * (track->flags & NOH_TRACK_TURNS ? 2.0f : 1.0f);
            if (track->flags & NOH_TRACK_ADDITIVE) {
                added[r] += track->weight * off;
            } else {
                error_m[r] = off > error_m[r] ? off : error_m[r];
            }
        }
    }
    for (int r = 0; r < NOH_UPDATE_RATE_COUNT; r++) {
        error_m[r] += added[r];
    }
}
