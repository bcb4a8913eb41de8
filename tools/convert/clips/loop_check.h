/* loop_check.h: the gap between a clip's last frame and its first. */
#ifndef NOH_CONVERT_CLIPS_LOOP_CHECK_H
#define NOH_CONVERT_CLIPS_LOOP_CHECK_H

#include "raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct raw_loop_check {
    double difference_cm; /* largest difference of the first and the last frame, in object space */
    uint32_t joint;       /* where; MODEL_NONE for a clip without joints */
    double in_place_cm;   /* likewise with the topmost joint that travels moved back to its start: how a loop with root
                             motion closes */
    uint32_t in_place_joint;
    double float_cm;    /* of morph weights: difference x radius, summed over a group */
    double float_units; /* of scalars without a radius, in their own unit */
} raw_loop_check;

/* Compare at six points around each joint, shell_cm from it (3 is usual) in the first
 * frame. Returns 1 when out of memory. */
int raw_clip_check_loop(const raw_skeleton *skeleton, const raw_clip *clip, double shell_cm, raw_loop_check *out);

#ifdef __cplusplus
}
#endif
#endif
