/* markers.h: recordings of optical capture: the places of markers, frame by frame.
 *
 *   trc_read   .trc, tables of OpenSim and others; y is up
 *   c3d_read   .c3d, as www.c3d.org describes it: integers or floats of Intel, DEC and MIPS processors; turned so that
 *              the axis of POINT:Y_SCREEN is up, or z where it names none
 *   markers_set
 *
 * Nothing is solved for a skeleton: each marker becomes a joint of its name below a joint "markers" at the origin, and
 * moves by translation. Frames in which a camera missed it are interpolated; a marker that no frame has is left out. */
#ifndef NOH_CONVERT_CLIPS_MARKERS_H
#define NOH_CONVERT_CLIPS_MARKERS_H

#include "raw_clip.h"

typedef struct markers {
    uint32_t count, frame_count;
    char **names;  /* [count] on the heap */
    float *places; /* [frame_count][count][3]; x is NaN: not seen */
    double rate_hz, unit_cm;
    char *warning; /* of the reader, or NULL */
} markers;

/* unit_cm: 0: the file's own. All return 0 and *out, to be freed with raw_set_free, or 1 and *error. */
int trc_read(const char *path, double unit_cm, raw_set **out, model_error *error);
int c3d_read(const char *path, double unit_cm, raw_set **out, model_error *error);

/* One clip named after the file. *m is freed. */
int markers_set(markers *m, const char *path, raw_set **out, model_error *error);

/* Names and places for the counts in *m. Returns 1 when out of memory, or above the limits, with *error. */
int markers_alloc(markers *m, model_error *error);
void markers_free(markers *m);

/* Centimetres of "mm", "cm", "m", "in"; 0: unknown. */
double markers_unit_cm(const char *name, size_t size);

#endif
