/* shape_match.h: gives the scalars of a facial capture (face_csv.h) to the targets of a model that mean the same. */
#ifndef NOH_CONVERT_CLIPS_SHAPE_MATCH_H
#define NOH_CONVERT_CLIPS_SHAPE_MATCH_H

#include "raw_clip.h"

/* Replace a clip's scalars by the weights of each node whose mesh has targets of their names (names.h); a target
 * without a side takes the mean of left and right. Other targets keep their defaults. Scalars that no target takes are
 * left out, with a warning of `m`; where none is taken, all stay as they are. Returns 1: out of memory. */
int shapes_match(model *m, const char *path, raw_clip *clip);

#endif
