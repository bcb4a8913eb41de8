/* transfer_fit.h: from a transfer of 36 coefficients to the few bytes of a lobe. */
#ifndef NOH_CONVERT_LIGHT_TRANSFER_FIT_H
#define NOH_CONVERT_LIGHT_TRANSFER_FIT_H

#include <stdint.h>

#include "noh/light.h"

/* The axis of a lobe: where band 1 points, the mean direction of the light that arrives; `fallback` where there is
 * none. */
void transfer_axis(const float *transfer, const float fallback[3], float axis[3]);

/* The lobe about an axis that is nearest to a transfer: for each band the projection on the zonal function. Its
 * occlusion is not clamped. */
void transfer_lobe(const float *transfer, const float axis[3], noh_lobe *lobe);

/* The record's bytes. The axis is rounded first, and the lobe fitted about the rounded one, so that only its direction
 * suffers. */
void transfer_record(const float *transfer, const float axis[3], uint32_t order, uint32_t flags, uint8_t *record);

#endif
