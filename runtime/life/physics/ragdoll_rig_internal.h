/* ragdoll_rig_internal.h: the private part of low_life.h. */
#ifndef NOH_SIM_RAGDOLL_RIG_INTERNAL_H
#define NOH_SIM_RAGDOLL_RIG_INTERNAL_H

#include "core/base/compiler_internal.h"
#include "core/base/vector_internal.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_life.h"
#include "noh/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_LEFT_IN_JAPANESE "\345\267\246" /* in UTF-8 */
#define NOH_RIGHT_IN_JAPANESE "\345\217\263"

/* The English word, in small letters, for a bone that MikuMikuDance names in Japanese, without its side; otherwise the
 * name itself. */
const char *noh_name_english(const char *name);

/* Get a joint's transform in the bind pose, in the skeleton's unit. */
void noh_ragdoll_bind(const noh_skeleton *skeleton, uint32_t joint, float position[3], float rotation[4]);

/* The row of the nearest joint above one, or NOH_NONE. */
uint32_t noh_ragdoll_row_above(const noh_ragdoll_source *source, const noh_ragdoll_row *rows, uint32_t count,
                               uint32_t joint);

/* The position of a vertex in the bind pose, by its heaviest joint. Scales of joints are the same in all directions. */
void noh_rig_vertex(const noh_skeleton *k, const noh_mesh *mesh, const noh_skin *skin, uint32_t vertex, uint32_t slot,
                    float point[3]);

/* Whether a joint is `below` itself, or one of the joints above it. */
static inline int noh_joint_is_above(const noh_skeleton *k, uint32_t joint, uint32_t below)
{
    while (below != NOH_JOINT_ROOT && below != joint) below = k->parents[below];
    return below == joint;
}

#ifdef __cplusplus
}
#endif

#endif
