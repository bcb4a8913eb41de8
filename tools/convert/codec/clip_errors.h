/* clip_errors.h: the error of an encoded clip that is posed with fewer joints, or at lower update rates. The runtime
 * chooses LOD levels by it (low_stage.h). */
#ifndef NOH_CONVERT_CODEC_CLIP_ERRORS_H
#define NOH_CONVERT_CODEC_CLIP_ERRORS_H

#include "stage/character/time_lod_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_stage.h"
#include "convert/base/byte_buffer.h"
#include "convert/clips/moved_vertices.h"
#include "convert/clips/raw_clip.h"

/* In the skeleton's unit; as noh_clip_header has them. */
typedef struct clip_errors {
    float joint[NOH_LOD_LEVELS_MAX]; /* [level_count] */
    float update_rate[NOH_CLIP_UPDATE_RATES];
    float shell;          /* distance of the points from each joint; 0: errors are of vertices */
    uint32_t level_count; /* 0 without joints */
    /* The largest distance of a vertex from where the source has it (source_pose.h), in centimetres, as the runtime
     * plays the clip: at its frames, and at the eighths between them, by whole ticks. Negative: it moves no vertex. */
    double frame_error_cm, between_error_cm;
} clip_errors;

/* Where a clip's error is measured. Borrowed. */
typedef struct error_points {
    const float *joint_radius; /* [joint_count] radius of what each joint moves (skin/joint_radius.h); NULL: no mesh is
                                  bound to the skeleton, points lie `shell_cm` from each joint */
    const noh_time_lod_points *points; /* vertices on which update rates are measured; read only with `joint_radius` */
    const moved_vertices *vertices;    /* all of them */
    double shell_cm;
} error_points;

/* Measure a clip as its decoder plays it.
 * clip     `raw`, encoded
 * errors   1 and *error: out of memory, or an error too large for a float */
int clip_errors_measure(const raw_skeleton *skeleton, const raw_clip *raw, const byte_buffer *clip,
                        const error_points *at, clip_errors *out, model_error *error);

#endif
