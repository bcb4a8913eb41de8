/* The loop over update periods and ticks within them, for any error: measure_internal.h. */
#include "stage/character/time_lod_internal.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_stage.h"
#include "stage/character/measure_internal.h"

/* These ticks include the frames at 24, 30, 60 and 120 Hz, where interpolated curves have corners and errors are
 * largest. */
#define START_TICKS 400u /* between the starts of two measured periods */
#define PLACE_TICKS 200u /* between two measured ticks within a period */

static void carve_one(noh_arena *arena, const noh_clip_set *set, noh_rate_pose *pose)
{
    pose->model = (float *)noh_arena_carve(arena, 12u * sizeof(float) * (size_t)set->joint_count, 4);
    pose->floats = (float *)noh_arena_carve(arena, set->float_count * sizeof(float), 4);
}

void noh_rate_carve(noh_arena *arena, const noh_clip_set *set, noh_rate_work *w)
{
    w->pose = (noh_transform *)noh_arena_carve(arena, set->joint_count * sizeof(noh_transform), 4);
    carve_one(arena, set, &w->from);
    carve_one(arena, set, &w->to);
    carve_one(arena, set, &w->right);
}

float noh_rate_floats_off(const noh_time_probe *p, const noh_rate_work *w, float part)
{
    float sum = 0.0f;
    for (uint32_t i = 0; p->float_radius_m && i < p->set->float_count; i++) {
        float from = w->from.floats[i],
              off = (from + (w->to.floats[i] - from) * part - w->right.floats[i]) * p->float_radius_m[i];
        sum += off < 0.0f ? -off : off;
    }
    return sum;
}

static void sample(const noh_time_probe *p, uint32_t clip, int64_t tick, noh_rate_work *w, noh_rate_pose *out)
{
    noh_probe_sample(p, clip, tick, w->travel, w->pose, out->model, out->floats);
}

/* At the start and the end of an update period the shown pose is exact; in between it is a linear mix of the two, which
 * is compared with the exact pose. Instances are staggered, so a period may begin at any tick: starts are tried
 * START_TICKS apart, from the clip's first tick until playback repeats or stops. */
static float measure(const noh_time_probe *p, uint32_t clip, uint32_t period, noh_rate_off off, void *user,
                     noh_rate_work *w)
{
    const noh_clip_entry *m = &p->set->clips[clip];
    const int64_t end = (int64_t)m->duration_ticks * (m->loop == NOH_LOOP_PING_PONG ? 2 : 1);
    float worst = 0.0f;
    for (int64_t start = 0; start < end; start += START_TICKS) {
        sample(p, clip, start, w, &w->from);
        sample(p, clip, start + (int64_t)period, w, &w->to);
        for (uint32_t at = PLACE_TICKS; at < period; at += PLACE_TICKS) {
            sample(p, clip, start + (int64_t)at, w, &w->right);
            worst = off(user, p, w, (float)at / (float)period, worst);
        }
    }
    return worst;
}

void noh_rate_measure(const noh_time_probe *p, uint32_t clip, noh_rate_off off, void *user, noh_rate_work *w,
                      float *error_m)
{
    noh_probe_travel(p, clip, w->pose, w->from.floats, w->travel);
    for (int r = 0; r < NOH_UPDATE_RATE_COUNT; r++) {
        const uint32_t period = noh_update_period((noh_update_rate)r);
        error_m[r] = period ? measure(p, clip, period, off, user, w) : 0.0f;
    }
}
