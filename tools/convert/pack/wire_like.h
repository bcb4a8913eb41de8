/* wire_like.h: which morph targets, and which vertices, are like which others. */
#ifndef CONVERT_PACK_WIRE_LIKE_H
#define CONVERT_PACK_WIRE_LIKE_H

#include "core/wire/wire_internal.h"

/* The order in which targets are written, and the target from which each is stored as a difference: rows of a filter's
 * plan, for the filter's mesh. Returns 1 when out of memory. */
int wire_plan_targets(const noh_wire_filter *filter, uint32_t *plan);

/* For each place in the order of vertices 1 + the first place with the same position, or 0: the plan of positions.
 * Returns 1 when there is no memory. */
int wire_plan_positions(const noh_wire_filter *filter, uint32_t *plan);

#endif
