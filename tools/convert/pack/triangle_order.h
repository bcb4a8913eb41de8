/* triangle_order.h: the order of triangles by meshoptimizer. */
#ifndef NOH_TRIANGLE_ORDER_H
#define NOH_TRIANGLE_ORDER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Sort triangles for the vertex cache, then for little overdraw: outer triangles first. Where thousands meet in a
 * vertex, they stay as they are.
 * shapes   indices[count], positions[vertex_count][3]
 * returns  1: out of memory; the order is then any */
int triangle_order(uint32_t *indices, size_t count, const float *positions, size_t vertex_count);

#ifdef __cplusplus
}
#endif

#endif
