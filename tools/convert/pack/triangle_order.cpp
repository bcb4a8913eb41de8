#include "triangle_order.h"

#include <meshoptimizer.h>
#include <new>
#include <vector>

#define OVERDRAW_LOSS 1.05f /* vertex cache misses may grow by this factor for less overdraw */
#define STEPS_MAX 1024u     /* for each index */

/* After each triangle the sort looks at all others of its vertices: where thousands meet in one, as in a fan or in
 * triangles that repeat, it would take hours. */
static bool is_sorted_soon(const uint32_t *indices, size_t count, size_t vertex_count)
{
    std::vector<uint32_t> meet(vertex_count);
    uint64_t steps = 0;
    for (size_t i = 0; i < count; i++) meet[indices[i]]++;
    for (const uint32_t n : meet) steps += uint64_t{ n } * n;
    return steps <= uint64_t{ STEPS_MAX } * count;
}

int triangle_order(uint32_t *indices, size_t count, const float *positions, size_t vertex_count)
{
    try { /* meshoptimizer throws where memory is refused, and the callers are C */
        if (!is_sorted_soon(indices, count, vertex_count)) return 0;
        meshopt_optimizeVertexCache(indices, indices, count, vertex_count);
        meshopt_optimizeOverdraw(indices, indices, count, positions, vertex_count, 12, OVERDRAW_LOSS);
        return 0;
    } catch (const std::bad_alloc &) {
        return 1;
    }
}
