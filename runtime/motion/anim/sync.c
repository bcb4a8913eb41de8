#include "motion/anim/sync_internal.h"
#include "core/base/assert_internal.h"
#include "motion/anim/time_internal.h"
#include "motion/anim/tracks_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

/* ---- phases ---- */

static uint32_t interval_count(const noh_clip_entry *m)
{
    return m->marker_count ? m->marker_count : 1u;
}

/* The marker of phase 0: the first one with the smallest id. */
static uint32_t canonical(const noh_clip_set *set, const noh_clip_entry *m)
{
    const noh_marker *markers = set->markers + m->first_marker;
    uint32_t best = 0;
    for (uint32_t i = 1; i < m->marker_count; i++) {
        if (markers[i].id < markers[best].id) {
            best = i;
        }
    }
    return best;
}

/* The position of the n-th marker, n from 0; beyond the last one they continue in the next pass. */
static int64_t marker_position(const noh_clip_set *set, const noh_clip_entry *m, uint32_t n)
{
    uint32_t count = interval_count(m);
    int64_t pass = noh_position_of(m->duration_ticks) * (int64_t)(n / count);
    return m->marker_count ? pass + noh_position_of(set->markers[m->first_marker + n % count].tick) : pass;
}

/* Intervals count from the marker of phase 0, not from the clip's start, so that equal phases are equal steps in all
 * clips of a group. */
noh_phase noh_sync_phase(const noh_clip_set *set, const noh_clip_entry *clip, int64_t position)
{
    NOH_ASSERT(set && clip && clip->duration_ticks > 0);
    uint32_t count = interval_count(clip), first = canonical(set, clip), n = 0;
    int64_t rest = noh_time_clip(position, clip->duration_ticks, NOH_LOOP_REPEAT), begin, end;
    noh_phase p;
    if (rest < marker_position(set, clip, 0)) {
        rest += noh_position_of(clip->duration_ticks); /* before the first marker: the last interval, across the seam */
    }
    while (n + 1 < count && marker_position(set, clip, n + 1) <= rest) {
        n++;
    }
    begin = marker_position(set, clip, n);
    end = marker_position(set, clip, n + 1);
    p.interval = (n + count - first) % count;
    p.fraction = (double)(rest - begin) / (double)(end - begin);
    return p;
}

int64_t noh_sync_position(const noh_clip_set *set, const noh_clip_entry *clip, noh_phase phase)
{
    uint32_t count = interval_count(clip), n = ((uint32_t)phase.interval + canonical(set, clip)) % count;
    int64_t begin = marker_position(set, clip, n), end = marker_position(set, clip, n + 1);
    int64_t position = begin + (int64_t)((double)(end - begin) * phase.fraction + 0.5);
    NOH_ASSERT(set && clip && clip->duration_ticks > 0 && phase.interval >= 0);
    return noh_time_clip(position, clip->duration_ticks, NOH_LOOP_REPEAT);
}

int noh_sync_fits(const noh_clip_set *set, const noh_clip_entry *a, const noh_clip_entry *b)
{
    NOH_ASSERT(set && a && b);
    uint32_t first_a = canonical(set, a), first_b = canonical(set, b);
    if (a->marker_count != b->marker_count) {
        return 0;
    }
    for (uint32_t i = 0; i < a->marker_count; i++) {
        uint32_t ia = (first_a + i) % a->marker_count, ib = (first_b + i) % b->marker_count;
        if (set->markers[a->first_marker + ia].id != set->markers[b->first_marker + ib].id) {
            return 0;
        }
    }
    return 1;
}

/* ---- groups ---- */

static int is_member(const noh_track *track, uint32_t group)
{
    return track->sync_group == group && track->mode != NOH_TRACK_OFF;
}

uint32_t noh_sync_leader(const noh_track *tracks, uint32_t track_count, uint32_t group)
{
    uint32_t best = track_count;
    NOH_ASSERT(tracks || !track_count);
    for (uint32_t i = 0; i < track_count; i++) {
        if (is_member(&tracks[i], group) && (best == track_count || tracks[i].weight > tracks[best].weight)) {
            best = i;
        }
    }
    return best;
}

static const noh_clip_entry *clip_of(const noh_clip_set *set, const noh_track *track)
{
    return &set->clips[track->clip];
}

/* The position with a given phase, one in each pass, that is nearest to another position: add whole durations, rounded,
 * to the one in the first pass. */
static int64_t nearest(const noh_clip_set *set, const noh_clip_entry *m, noh_phase phase, int64_t to)
{
    int64_t duration = noh_position_of(m->duration_ticks);
    int64_t apart = to - noh_sync_position(set, m, phase);
    return to - apart + noh_floor_div(apart + duration / 2, duration) * duration;
}

void noh_sync_join(const noh_clip_set *set, noh_track *track, const noh_track *leader)
{
    NOH_ASSERT(set && track && leader && track != leader);
    noh_phase phase = noh_sync_phase(set, clip_of(set, leader), leader->position);
    noh_track_place(track, clip_of(set, track), nearest(set, clip_of(set, track), phase, track->position));
}

/* Length of a phase's marker interval in this clip, 1/65,536 ticks. */
static double interval_length(const noh_clip_set *set, const noh_clip_entry *m, noh_phase phase)
{
    uint32_t n = ((uint32_t)phase.interval + canonical(set, m)) % interval_count(m);
    return (double)(marker_position(set, m, n + 1) - marker_position(set, m, n));
}

/* Weighted mean of the group's phase speeds, in intervals per tick; the leader's own if all weights are 0. */
static double mean_speed(const noh_clip_set *set, const noh_track *tracks, uint32_t track_count, uint32_t leader,
                         noh_phase phase)
{
    double sum = 0.0, weights = 0.0;
    for (uint32_t i = 0; i < track_count; i++) {
        if (is_member(&tracks[i], tracks[leader].sync_group)) {
            sum += (double)tracks[i].weight * (double)tracks[i].speed /
                   interval_length(set, clip_of(set, &tracks[i]), phase);
            weights += (double)tracks[i].weight;
        }
    }
    return weights > 0.0 ? sum / weights
                         : (double)tracks[leader].speed / interval_length(set, clip_of(set, &tracks[leader]), phase);
}

static int64_t rounded(double x)
{
    return (int64_t)(x < 0.0 ? x - 0.5 : x + 0.5);
}

/* The speed that brings a follower to the leader's phase in `ticks`. Of all positions with that phase (one per pass) it
 * uses the nearest to where the follower would be after as many passes as the leader; that keeps both in the same pass
 * even if an interval is short in one clip and long in the other. A follower never moves against its leader, which
 * would pass keys twice; it waits instead. */
static void steer(const noh_clip_set *set, noh_track *track, noh_phase goal, double travelled, int64_t leader_speed,
                  int64_t ticks)
{
    const noh_clip_entry *m = clip_of(set, track);
    int64_t expected = track->position + rounded(travelled * (double)m->duration_ticks * 65536.0);
    int64_t way = nearest(set, m, goal, expected) - track->position;
    int64_t speed = noh_floor_div(way + ticks / 2, ticks);
    track->speed_now = (leader_speed > 0 && speed < 0) || (leader_speed < 0 && speed > 0) || leader_speed == 0 ? 0
                                                                                                               : speed;
}

/* The leader moves at the group's mean phase speed, times its own interval; the others are steered to its future
 * phase. */
static void group_speeds(const noh_clip_set *set, noh_track *tracks, uint32_t track_count, uint32_t leader,
                         int64_t ticks)
{
    noh_track *lead = &tracks[leader];
    const noh_clip_entry *m = clip_of(set, lead);
    noh_phase now = noh_sync_phase(set, m, lead->position), goal;
    lead->speed_now = rounded(mean_speed(set, tracks, track_count, leader, now) * interval_length(set, m, now));
    goal = noh_sync_phase(set, m, lead->position + lead->speed_now * ticks);
    for (uint32_t i = 0; i < track_count; i++) {
        if (i != leader && is_member(&tracks[i], lead->sync_group)) {
            steer(set, &tracks[i], goal, (double)(lead->speed_now * ticks) / ((double)m->duration_ticks * 65536.0),
                  lead->speed_now, ticks);
        }
    }
}

void noh_sync_speeds(const noh_clip_set *set, noh_track *tracks, uint32_t track_count, int64_t ticks)
{
    NOH_ASSERT(set && (tracks || !track_count) && ticks > 0);
    for (uint32_t group = 1; group <= NOH_SYNC_GROUPS_MAX; group++) {
        uint32_t leader = noh_sync_leader(tracks, track_count, group);
        if (leader < track_count) {
            group_speeds(set, tracks, track_count, leader, ticks);
        }
    }
}
