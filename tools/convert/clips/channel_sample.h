/* channel_sample.h: the source's own curves at any time, in double precision. */
#ifndef NOH_CONVERT_CLIPS_CHANNEL_SAMPLE_H
#define NOH_CONVERT_CLIPS_CHANNEL_SAMPLE_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The value of a channel at a time; before the first and after the last key their values hold.
 * Rotations are unit, interpolated along the shorter arc (LINEAR) or normalised (CUBICSPLINE).
 * snap_s  a key that lies no further off gives its value as it is
 * out     [channel->width]
 * errors  1 where a rotation has no length: a spline through zero
 * source  glTF 2.0, appendix C */
int channel_sample(const model_channel *channel, double time_s, double snap_s, double *out);

/* The value of one key, without its tangents. */
const float *channel_key(const model_channel *channel, uint32_t key);

#ifdef __cplusplus
}
#endif
#endif
