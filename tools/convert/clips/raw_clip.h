/* raw_clip.h: a clip between reader and encoder: every frame of every track at one sample rate, without loss. Units:
 * model units (metres in glTF, centimetres in .rcl and most BVH; `unit_cm` says which), seconds, quaternions xyzw. */
#ifndef NOH_CONVERT_CLIPS_RAW_CLIP_H
#define NOH_CONVERT_CLIPS_RAW_CLIP_H

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct raw_joint {
    char *name;
    uint32_t parent;                             /* index, lower than its own, or MODEL_NONE */
    float rotation[4], translation[3], scale[3]; /* bind pose, local to the parent */
    float end[3];  /* the end site of a BVH leaf joint, local to the joint; zero: not known */
    uint32_t node; /* glTF node, or MODEL_NONE */
} raw_joint;

/* Joints, parents first. */
typedef struct raw_skeleton {
    char *name;
    uint32_t joint_count;
    raw_joint *joints;
    double unit_cm; /* centimetres per unit: 100 for glTF, 1 for .rcl */
} raw_skeleton;

/* Scalar tracks that are sampled together: a node's morph weights, or named scalars. */
typedef struct raw_floats {
    char *name;    /* of the node, or of the float */
    uint32_t node; /* glTF node for morph weights, else MODEL_NONE */
    uint32_t width;
    float *values; /* [frame_count][width] */
    float *radius; /* [width] centimetres: how far a value of 1 moves the surface; NULL: errors are in the scalar's own
                      unit */
} raw_floats;

typedef struct raw_event {
    char *name;
    double time_s;
    uint8_t payload[8];
    float weight_min;
    uint8_t is_marker; /* a sync marker: it has a name and a time, and fires nothing */
} raw_event;

typedef struct raw_clip {
    char *name;
    double sample_rate_hz;
    uint32_t frame_count; /* at least 1; the clip lasts (frame_count - 1) / sample_rate_hz seconds */
    uint32_t joint_count; /* of its skeleton; 0: animates scalar tracks only */
    uint8_t loop;         /* marked as a loop: the last frame equals the first */
    float *rotations;     /* [frame_count][joint_count][4] unit */
    float *translations;  /* [frame_count][joint_count][3] */
    float *scales;        /* [frame_count][joint_count][3] */
    uint32_t float_count;
    raw_floats *floats;
    uint32_t event_count;
    raw_event *events;        /* keys and markers, in time order */
    const model_clip *source; /* the model's curves that the frames were sampled from, and still show; NULL: none */
    double source_error_cm;   /* the largest distance between these frames as played (lerp, normalise) and the source's
                               curves: of a vertex, or of a joint that moves none and of a scalar alone; 0: none */
} raw_clip;

/* One skeleton and its clips. */
typedef struct raw_set {
    raw_skeleton skeleton;
    uint32_t clip_count;
    raw_clip *clips;
    double error_cm, shell_cm; /* that fit its size (pack/size_warn.h); 0: the usual ones do */
    char *warning;             /* a sentence for the user about the file, or NULL */
} raw_set;

#ifdef __cplusplus
}
#endif
#endif
