/* wire_like.h: which morph targets, and which vertices, are like which others. */
#ifndef CONVERT_PACK_WIRE_LIKE_H
#define CONVERT_PACK_WIRE_LIKE_H

#include "core/wire/wire_internal.h"

/* The order in which targets are written, and the one that each is told as a difference from: rows of a filter's plan,
 * for the mesh that the filter is about. Returns 1 when there is no memory. */
int wire_plan_targets(const noh_wire_filter *filter, uint32_t *plan);

/* For each place in the order of vertices 1 + the first place with the same position, or 0: the plan of positions.
 * Returns 1 when there is no memory. */
int wire_plan_positions(const noh_wire_filter *filter, uint32_t *plan);

#endif
