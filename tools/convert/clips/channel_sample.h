/* channel_sample.h: a source's animation curves at any time, in double precision. */
#ifndef NOH_CONVERT_CLIPS_CHANNEL_SAMPLE_H
#define NOH_CONVERT_CLIPS_CHANNEL_SAMPLE_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The value of a channel at a time; constant before the first key and after the last.
 * Rotations are unit quaternions, interpolated along the shorter arc (LINEAR) or normalised (CUBICSPLINE).
 * snap_s  a key at most this far away gives its value unchanged
 * out     [channel->width]
 * errors  1: a rotation has no length, as where a spline passes through zero; out is then the key before
 * source  glTF 2.0, appendix C */
int channel_sample(const model_channel *channel, double time_s, double snap_s, double *out);

/* The value of one key, without its tangents. */
const float *channel_key(const model_channel *channel, uint32_t key);

#ifdef __cplusplus
}
#endif
#endif
