/* sync_internal.h (private to anim/): synchronised tracks: by phase, or by markers if their clips have them.
 *
 * The tracks of a sync group share a phase: a marker interval and the fraction of it that has passed. A clip without
 * markers is one interval. The clips of a group must have the same marker ids in the same cyclic order; phase 0 is at
 * the smallest id, so a walk that starts on the left foot synchronises with a run that starts on the right.
 *
 * All tracks of a group move at the weighted mean of their own phase speeds. The heaviest leads; the others are steered
 * to its phase, every NOH_SYNC_TICKS of the controller's clock and whenever the group changes. Between these times
 * speeds are constant, so events stay exact and independent of the step size; if a marker is passed in between, a
 * follower is off by less than those 10 milliseconds.
 *
 * Threads: as low_motion.h. */
#ifndef NOH_ANIM_SYNC_INTERNAL_H
#define NOH_ANIM_SYNC_INTERNAL_H

#include "noh/clip.h"

#define NOH_SYNC_TICKS 480 /* 10 ms */

typedef struct noh_phase {
    int64_t interval; /* 0..markers - 1, from the marker of phase 0 */
    double fraction;  /* 0..1 of that interval */
} noh_phase;

/* The phase of a position, and the position of a phase in the first pass.
 * ranges  a repeating clip of a duration above 0 */
noh_phase noh_sync_phase(const noh_clip_set *set, const noh_clip_entry *clip, int64_t position);
int64_t noh_sync_position(const noh_clip_set *set, const noh_clip_entry *clip, noh_phase phase);

/* Whether the markers of two clips match. */
int noh_sync_fits(const noh_clip_set *set, const noh_clip_entry *a, const noh_clip_entry *b);

/* Get the leader of a group: the heaviest track that is not off, the first of equal ones; track_count if there is
 * none. */
uint32_t noh_sync_leader(const noh_track *tracks, uint32_t track_count, uint32_t group);

/* Move a track to the phase of another one, at the nearest position, without firing callbacks. */
void noh_sync_join(const noh_clip_set *set, noh_track *track, const noh_track *leader);

/* Set speed_now of all synchronised tracks for the next `ticks`. */
void noh_sync_speeds(const noh_clip_set *set, noh_track *tracks, uint32_t track_count, int64_t ticks);

#endif
