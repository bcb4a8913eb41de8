/* model_clips.h: from a model's nodes, skins and animations to skeletons and sampled clips.
 *
 * Skeletons. Skins that share joints, or whose joints lie below another skin's, share one skeleton. It holds their
 * joints, the animated nodes below these, and the nodes above them that are animated or have a transform: a
 * skeleton's object space is the scene, and no transforms are merged or rounded. Animated nodes that belong to no skin
 * form one more skeleton.
 *
 * Clips. Each skeleton gets the animations that animate one of its joints or the weights of its meshes. Frames are
 * equally spaced from 0 to the animation's last key, both exact: a request for R Hz gives n = round(duration * R)
 * steps, at least 1, and a sample rate of n / duration. */
#ifndef NOH_CONVERT_CLIPS_MODEL_CLIPS_H
#define NOH_CONVERT_CLIPS_MODEL_CLIPS_H

#include "convert/clips/raw_clip.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sample_options {
    double sample_rate_hz; /* 0: the lowest of the rates of the keys' grid and its multiples, or of 30, 60 and 120, at
                            * which playing the frames moves no vertex off the curves by more than 1/1000 of the size
                            * of what moves; at most 120 */
} sample_options;

/* The joints of a model's skin in its skeleton. */
typedef struct clip_skin {
    uint32_t set;
    uint32_t *joints; /* [model_skin.joint_count] */
} clip_skin;

/* The joint at a node, or the next one above it; both MODEL_NONE where no joint moves the node. */
typedef struct node_joint {
    uint32_t set, joint;
} node_joint;

typedef struct model_clips {
    uint32_t set_count, skin_count;
    raw_set **sets;    /* [set_count] */
    clip_skin *skins;  /* [skin_count], as the model's */
    node_joint *nodes; /* [the model's node_count] */
} model_clips;

/* Adds warnings to the model. Returns 0 and *out, or 1 and *error. */
int clips_from_model(model *m, const sample_options *options, model_clips **out, model_error *error);
void model_clips_free(model_clips *made);

#ifdef __cplusplus
}
#endif
#endif
