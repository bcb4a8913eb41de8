/* resample.h: raw clips at other sample rates. */
#ifndef NOH_CONVERT_CLIPS_RESAMPLE_H
#define NOH_CONVERT_CLIPS_RESAMPLE_H

#include "raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A copy at another sample rate, of the same length: n = round(duration * rate_hz) steps, at least
 * one, from the first frame to the last, both kept exactly; so its rate is n / duration.
 * Between frames it interpolates as the player does: lerp along the shorter chord, rotations normalised.
 * *out is filled, to be freed with raw_clip_clear. Returns 1 and *error where the rate is
 * not possible. */
int raw_clip_resample(const raw_clip *clip, double sample_rate_hz, raw_clip *out, model_error *error);

/* A copy of every step-th frame, from the first; what is left at the end is cut off, with
 * keys (events) moved to the new end. step is at least 1. */
int raw_clip_decimate(const raw_clip *clip, uint32_t step, raw_clip *out, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
