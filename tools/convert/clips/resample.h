/* resample.h: raw clips at other sample rates. */
#ifndef NOH_CONVERT_CLIPS_RESAMPLE_H
#define NOH_CONVERT_CLIPS_RESAMPLE_H

#include "raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A copy of the same length at another sample rate: n = round(duration * sample_rate_hz) steps, at least one, from the
 * first frame to the last, both kept exactly; its sample rate is n / duration. Between frames it interpolates as the
 * player does: lerp along the shorter chord, rotations normalised. *out is to be freed with raw_clip_clear. Returns 1
 * and *error if the sample rate is impossible or memory runs out. */
int raw_clip_resample(const raw_clip *clip, double sample_rate_hz, raw_clip *out, model_error *error);

/* A copy of every step-th frame, from the first. Frames left over at the end are cut off, and keys after the new end
 * are moved to it. step is at least 1. */
int raw_clip_decimate(const raw_clip *clip, uint32_t step, raw_clip *out, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
