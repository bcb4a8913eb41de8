/* character_internal.h (private to character/): shared by character.c and skin_palette.c. */
#ifndef NOH_CHARACTER_CHARACTER_INTERNAL_H
#define NOH_CHARACTER_CHARACTER_INTERNAL_H

#include "noh/low_stage.h"

/* The palette of pose 0 or 1: [joint_count][12]. */
const float *noh_character_pose_palette(const noh_character *ch, uint32_t pose);

/* The largest factor by which a matrix of the shown pose stretches a length, at the time of noh_character_sphere. */
float noh_character_stretch(const noh_character *ch);

/* out = a + (b - a) * part, four floats at a time, so that compilers vectorise it. out may be a. */
void noh_mix_fours(const float *a, const float *b, float part, size_t fours, float *out);

#endif
