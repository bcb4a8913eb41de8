/* feet.h: feet of a retargeted clip that stand, and figures of how well it fits. Clips and skeletons: raw_clip.h. */
#ifndef NOH_CONVERT_RETARGET_FEET_H
#define NOH_CONVERT_RETARGET_FEET_H

#include "convert/clips/raw_clip.h"
#include "convert/mocap/contacts.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"

/* Two clips of equal frames: the source's, and what was made of it. bones: [NOH_BONES] of each. */
typedef struct retarget_pair {
    const raw_skeleton *skeletons[2];
    const raw_clip *clips[2];
    const uint16_t *bones[2];
    const contacts *stands; /* of the source's clip; NULL: not known */
} retarget_pair;

/* How much higher the clip's ground is than the ground of the source at rest, in its unit: by where feet stand, or, where
 * none does, by the lowest foot below the ground. 1: out of memory. */
int feet_ground(const retarget_pair *pair, double *ground);

/* Add to out[frames][2][3] what both feet of the target need in each frame to stay where they stand, horizontal, in its
 * unit. Nothing changes at both ends of the clip. 1: out of memory. */
int feet_lock(const retarget_pair *pair, float (*out)[2][3]);

typedef struct retarget_figures {
    /* of a foot while it stands, as a share of a stride, which counts as a quarter of a leg or more; 0: no steps */
    double slide;
    double penetration_cm;        /* of feet and toes, at the 95th percentile of frames */
    double source_penetration_cm; /* the source's own */
    double reach_cm;              /* between a hand and where the source's is, by the length of the arm; mean */
    double against;               /* share of frames with a knee or an elbow bent against the source's, by 5 degrees */
} retarget_figures;

/* facing: cosine and sine of the turn about +y from the source to the target. ground: feet_ground. 1: out of memory. */
int feet_measure(const retarget_pair *pair, const double facing[2], double ground, retarget_figures *out);

#endif
