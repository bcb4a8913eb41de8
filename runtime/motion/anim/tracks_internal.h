/* tracks_internal.h: the private part of low_motion.h. */
#ifndef NOH_ANIM_TRACKS_INTERNAL_H
#define NOH_ANIM_TRACKS_INTERNAL_H

#include "motion/anim/events_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#ifdef __cplusplus
extern "C" {
#endif

NOH_STATIC_ASSERT(sizeof(noh_track) == 48, track);

/* Start a track from a desc.
 * errors  ARG names the field; the track is then unchanged */
noh_result noh_track_start(noh_track *track, const noh_clip_set *set, const noh_track_desc *desc, noh_error *error);

/* Move a track to a position without firing callbacks; keys exactly there fire when play moves on. */
void noh_track_place(noh_track *track, const noh_clip_entry *clip, int64_t position);

/* Get the passage of the next `ticks` (clip.h). */
noh_passage noh_track_passage(const noh_track *track, const noh_clip_entry *clip, int64_t ticks);

/* Get the ticks until the next key is passed, 1..ticks; 0 if there is none within `ticks`. */
int64_t noh_track_next_event(const noh_track *track, const noh_clip_set *set, int64_t ticks);

/* Test whether a ONCE track has reached its end in the direction of play. */
int noh_track_ended(const noh_track *track, const noh_clip_entry *clip);

/* Get how much a track of the low group covers the bind pose, 0..1. For each joint the track that covers most counts;
 * tracks with NOH_TRACK_RISES cover part of the rest. The sum of the weights does not matter. */
float noh_track_cover(const noh_track *track);

#ifdef __cplusplus
}
#endif

#endif
