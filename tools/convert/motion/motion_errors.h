/* motion_errors.h: the error of an encoded clip with fewer joints, and at lower update rates. The runtime chooses LOD
 * levels by these (character/detail.h). */
#ifndef NOH_CONVERT_MOTION_ERRORS_H
#define NOH_CONVERT_MOTION_ERRORS_H

#include "character/time_lod_points.h"
#include "convert/pack/byte_buffer.h"
#include "pack/format.h"
#include "raw_clip.h"

/* In the skeleton's unit; as noh_motion_header has them. */
typedef struct motion_errors {
    float joint[NOH_JOINT_LEVELS_MAX]; /* [level_count] */
    float rate[NOH_MOTION_RATES];
    float shell;                       /* 0: of vertices */
    uint32_t level_count;              /* 0 without joints */
} motion_errors;

/* Where a clip's error is measured. Borrowed. */
typedef struct motion_flesh {
    const float *reach;            /* [joint_count] radius of what each joint moves (joint_reach); NULL: no mesh is bound to the
                                    * skeleton, points lie `shell_cm` from each joint */
    const noh_time_points *points; /* vertices on which update rates are measured; read only with `reach` */
    double shell_cm;
} motion_flesh;

/* Measure a clip as its decoder plays it.
 * clip     the encoded one, of `raw`
 * errors   1 and *error: out of memory, or errors beyond what a float holds */
int motion_errors_measure(const raw_skeleton *skeleton, const raw_clip *raw, const byte_buffer *clip, const motion_flesh *flesh, motion_errors *out,
                          model_error *error);

#endif
