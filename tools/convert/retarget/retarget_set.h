/* retarget_set.h: clips of one humanoid on another (noh_retarget, low_life.h); feet stay where they stand. */
#ifndef NOH_CONVERT_RETARGET_RETARGET_SET_H
#define NOH_CONVERT_RETARGET_RETARGET_SET_H

#include <stdio.h>

#include "convert/clips/raw_clip.h"

/* Whether bones, lengths and the bind pose are equal, so that clips fit as they are. */
int retarget_same(const raw_skeleton *a, const raw_skeleton *b);

/* Give a set the joints of `to`, and its clips as these joints play them.
 * map     bones.h; NULL: by names alone
 * report  a line for each clip with its figures (feet.h); NULL: quiet
 * errors  1: no hips or no common bone is known, a pose that does not stand upright, the map is wrong, out of memory */
int retarget_set(raw_set *set, const raw_skeleton *to, const char *map, FILE *report, model_error *error);

#endif
