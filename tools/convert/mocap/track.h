/* track.h: one joint's rotations or translations over a clip, in double precision, as the filters of mocap/ want them.
 * Rotations are unit quaternions, each in the hemisphere of the frame before. */
#ifndef NOH_CONVERT_MOCAP_TRACK_H
#define NOH_CONVERT_MOCAP_TRACK_H

#include "convert/clips/raw_clip.h"

typedef enum mocap_kind { MOCAP_ROTATION, MOCAP_TRANSLATION } mocap_kind;

typedef struct mocap_track {
    mocap_kind kind;
    uint32_t joint, frame_count, width; /* width: 4 or 3 */
    double *x;                          /* [frame_count][width] */
} mocap_track;

/* Room for any track of a clip; 1: out of memory. */
int mocap_track_alloc(const raw_clip *clip, mocap_track *out);
void mocap_track_free(mocap_track *track);

void mocap_track_read(const raw_clip *clip, uint32_t joint, mocap_kind kind, mocap_track *track);

/* Frames first to last - 1; quaternions are normalised. The others keep their bits. */
void mocap_track_write(const mocap_track *track, uint32_t first, uint32_t last, raw_clip *clip);

/* Radians, or the skeleton's units. */
double mocap_track_distance(const mocap_track *track, uint32_t a, uint32_t b);

/* The k-th smallest of `count` numbers, which it moves about. */
double mocap_rank(double *values, uint32_t count, uint32_t k);

#endif
