#include "triangle_order.h"

#include <meshoptimizer.h>
#include <new>

#define OVERDRAW_LOSS 1.05f /* vertex cache misses may grow by this factor for less overdraw */

int triangle_order(uint32_t *indices, size_t count, const float *positions, size_t vertex_count)
{
    try { /* meshoptimizer throws where memory is refused, and the callers are C */
        meshopt_optimizeVertexCache(indices, indices, count, vertex_count);
        meshopt_optimizeOverdraw(indices, indices, count, positions, vertex_count, 12, OVERDRAW_LOSS);
        return 0;
    } catch (const std::bad_alloc &) {
        return 1;
    }
}
