/* motions.h: the skeletons and clips of one pack, encoded. */
#ifndef NOH_CONVERT_MOTIONS_H
#define NOH_CONVERT_MOTIONS_H

#include <stdio.h>

#include "convert/clip/clip_encode.h"
#include "convert/motion/motion_errors.h"
#include "convert/clip/named_errors.h"

typedef struct motion_clip {
    uint32_t set; /* index into motions.sets */
    const raw_clip *raw;
    byte_buffer bytes;
    clip_report report;
    motion_errors errors;
} motion_clip;

typedef struct motions {
    raw_set **sets;      /* [set_count]; borrowed */
    uint32_t set_count;
    motion_clip *clips;  /* [clip_count] */
    uint32_t clip_count;
} motions;

typedef struct motion_settings {
    double rate_hz;  /* 0: as the source has it */
    double unit_cm;  /* of .bvh; 0: 1 */
    int check_loops; /* mark every clip as a loop, and report the gap between its ends */
    int skeletons_only; /* no clips: what a mesh pack needs */
    clip_options clip;
    named_errors clip_errors, joint_errors; /* over those of `clip` */
    const model *m; /* bound to the sets: errors of fewer joints and lower update rates are measured on its vertices; NULL: on the shell */
    FILE *report, *progress; /* or NULL */
} motion_settings;

/* Encode every clip. 0, or 1 and a filled error; free in both cases. */
int motions_encode(raw_set **sets, uint32_t set_count, const motion_settings *settings, motions *out, model_error *error);
void motions_free(motions *m);

/* Append the bytes of a skeleton chunk, of a motion chunk. */
void pack_skeleton(const raw_skeleton *skeleton, string_table *strings, byte_buffer *out);
void pack_motion(const motions *m, const motion_clip *clip, string_table *strings, byte_buffer *out);

#endif
