/* pose.h: the transform of a joint, local to its parent. A pose is an array of transforms in skeleton order, parents
 * first.
 *
 * Threads: no state; any thread. */
#ifndef NOH_POSE_POSE_H
#define NOH_POSE_POSE_H

#ifdef __cplusplus
extern "C" {
#endif

/* One joint, local to its parent: model = parent * translation * rotation * scale. */
typedef struct noh_transform {
    float rotation[4];    /* unit quaternion, xyzw */
    float translation[3]; /* model units */
    float scale[3];
} noh_transform;

#ifdef __cplusplus
}
#endif

#endif
