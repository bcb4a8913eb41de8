/* world_ask_internal.h: the one place where rays and bodies ask the physics of a world. Threads: as body.h. */
#ifndef NOH_PHYSICS_WORLD_ASK_INTERNAL_H
#define NOH_PHYSICS_WORLD_ASK_INTERNAL_H

#include "noh/body.h"
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whether a world holds more than its own planes, capsules, boxes and field. */
int noh_world_asks(const noh_world *world);

/* Whether the jobs of a stage may ask a world: one whose physics answers a single thread is not asked by several. NULL
 * may be asked. */
int noh_world_may_ask(const noh_world *world, uint32_t job_count);

/* Find the first hits of rays. Answers that do not keep the rules of noh_world_physics become "no hit".
 * shapes  rays[count], hits[count]; distance at most the ray's, below 0: no hit */
void noh_world_ask_rays(const noh_world *world, const noh_world_ray *rays, uint32_t count, noh_world_hit *hits);

/* Find what bodies touch. Answers that do not keep the rules are left out, `along` is clamped.
 * shapes  bodies[count], touches[count] */
void noh_world_ask_touches(const noh_world *world, const noh_world_body *bodies, uint32_t count, noh_touches *touches);

#ifdef __cplusplus
}
#endif

#endif
