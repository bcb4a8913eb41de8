/* actor_hair_internal.h: the private part of modules.h. */
#ifndef NOH_ACTORS_ACTOR_HAIR_INTERNAL_H
#define NOH_ACTORS_ACTOR_HAIR_INTERNAL_H

#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

/* heads[*count], valid until the next frame. */
const noh_hair_head *noh_actor_hair_heads(const noh_actor_hair *hair, uint32_t *count);

/* shapes  points[hair_count][point_count][3], head space */
void noh_actor_hair_points(const noh_actor_hair *hair, uint32_t head, float *points);

const noh_actor_hair_desc *noh_actor_hair_desc_of(const noh_actor_hair *hair);

#define NOH_HAIR_MOVING_PIXELS 60.0f

#ifdef __cplusplus
}
#endif

#endif
