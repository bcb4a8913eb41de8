/* lod_joints.h: coarse levels of a face whose targets are baked into virtual joints.
 *
 * A virtual joint is one more joint of the mesh's skin, which follows a joint of the skeleton and is moved by targets on
 * top (lod_joints_fit.h; noh_far_joints_header of format.h). The vertices of such a level are its own, have weights for
 * these joints, and no deltas: it is drawn as any skinned mesh. */
#ifndef NOH_CONVERT_LOD_LOD_JOINTS_H
#define NOH_CONVERT_LOD_LOD_JOINTS_H

#include "lod.h"
#include "lod_joints_fit.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LOD_JOINTS_MAX NOH_FAR_JOINTS_MAX /* 1,536 bytes of matrices for each instance */

typedef struct lod_joints {
    uint32_t level;       /* the finest one that they move; 0: there are none, and all that follows is 0 */
    uint32_t first_joint; /* of the virtual joints, in the mesh's skin */
    joint_fit fit;
    uint32_t *vertices; /* [vertex_count] of the mesh that they move */
    uint32_t vertex_count;
    float *boxes;                  /* [target_count][6] of what they do to these */
    float normal_most, normal_p99; /* certified: how far normals are off with each target at weight 1, radians */
} lod_joints;

/* Whether a mesh's coarse levels can have them: it is skinned by matrices, its skin has fewer joints than it may have,
 * and its targets move positions, but no texture coordinates. */
int lod_joints_allowed(const model *m, uint32_t mesh);

/* Fit joints to levels[count], the coarser levels of a mesh; what these share with finer ones is copied, after the
 * mesh's first full_count vertices. The joints are appended to the mesh's skin. Deltas become what the joints do, so
 * that the levels can be certified. If no target moves any of these levels, there are none.
 * 0, or 1 and *error: out of memory */
int lod_joints_make(model *m, uint32_t mesh, uint32_t full_count, lod_level *const *levels, uint32_t count,
                    lod_joints *out, model_error *error);

/* Once the levels are certified: keep the boxes of the deltas, and clear them. */
int lod_joints_bake(model_mesh *mesh, lod_joints *joints, model_error *error);
void lod_joints_free(lod_joints *joints);

#ifdef __cplusplus
}
#endif
#endif
