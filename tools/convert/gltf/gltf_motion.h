/* gltf_motion.h: from a model's nodes, skins and animations to skeletons and sampled clips.
 *
 * Skeletons. Skins that share joints, or whose joints lie below each other's, share one
 * skeleton. It holds their joints, the animated nodes below these, and of the nodes above
 * them those that are animated or have a transform: a skeleton's object space is the scene,
 * and nothing is folded or rounded. Animated nodes that belong to no skin form one more skeleton.
 *
 * Clips. Each skeleton gets the animations that move a joint of it or the weights of its meshes.
 * Frames lie at equal times from 0 to the animation's last key, both exactly: with R Hz asked
 * for there are n = round(duration * R), at least 1, steps, and the sample rate is n / duration. */
#ifndef NOH_CONVERT_GLTF_MOTION_H
#define NOH_CONVERT_GLTF_MOTION_H

#include "convert/motion/raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct motion_options {
    double rate_hz; /* 0: the rate of the keys, where they lie on a grid of 15 Hz or more and are linear. Else the
                     * lowest of the grid's multiples, or of 30, 60 and 120, at which playing the frames strays from
                     * the curves by at most 1/1000 of the skeleton's size; at most 120 */
} motion_options;

/* The joints of a model's skin in its skeleton. */
typedef struct motion_skin {
    uint32_t set;
    uint32_t *joints; /* [model_skin.joint_count] */
} motion_skin;

/* The joint at or next above a node; MODEL_NONE twice where nothing moves it. */
typedef struct motion_node {
    uint32_t set, joint;
} motion_node;

typedef struct motion {
    uint32_t set_count, skin_count;
    raw_set **sets;     /* [set_count] */
    motion_skin *skins; /* [skin_count], as the model's */
    motion_node *nodes; /* [the model's node_count] */
} motion;

/* Adds warnings to the model. Returns 0 and *out, or 1 and *error. */
int motion_from_model(model *m, const motion_options *options, motion **out, model_error *error);
void motion_free(motion *made);

#ifdef __cplusplus
}
#endif
#endif
