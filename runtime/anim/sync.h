/* sync.h: tracks that keep step: by phase, or by markers where their motions have them.
 *
 * The tracks of a sync group share a phase: the marker interval they are in and how
 * far through it. A motion without markers is one interval. Markers of one group's
 * motions must be the same ids in the same cyclic order; the smallest id is where
 * phase 0 lies, so that a walk that starts on the left foot keeps step with a run
 * that starts on the right. All move at the weighted mean of their own phase speeds;
 * the heaviest leads and the others are steered onto its phase, every
 * NOH_SYNC_TICKS of the controller's clock and whenever the group changes. Between,
 * their rates are constant: events stay exact, and independent of the step size; where
 * a marker is passed between, a follower is off by part of those few milliseconds. */
#ifndef NOH_ANIM_SYNC_H
#define NOH_ANIM_SYNC_H

#include "anim/tracks.h"

#define NOH_SYNC_TICKS 480 /* 10 ms */

typedef struct noh_phase {
    int64_t interval; /* 0..markers - 1, from the canonical marker on */
    double fraction;  /* 0..1 of that interval */
} noh_phase;

/* The phase of a position, and the position of a phase in the first pass.
 * ranges  repeating motion with a duration */
noh_phase noh_sync_phase(const noh_anim_set *set, const noh_motion *motion, int64_t position);
int64_t noh_sync_position(const noh_anim_set *set, const noh_motion *motion, noh_phase phase);

/* Whether two motions can keep step. */
int noh_sync_fits(const noh_anim_set *set, const noh_motion *a, const noh_motion *b);

/* The leading track of a group: on, heaviest, lowest index; track_count when there is none. */
uint32_t noh_sync_leader(const noh_track *tracks, uint32_t track_count, uint32_t group);

/* Place a track on the phase of another, in its own pass; nothing fires. */
void noh_sync_join(const noh_anim_set *set, noh_track *track, const noh_track *leader);

/* Set the rates of all groups for the next `ticks`. */
void noh_sync_rates(const noh_anim_set *set, noh_track *tracks, uint32_t track_count, int64_t ticks);

#endif
