/* The functions of meshoptimizer that the converter's C files call, for processors that have no package of it: they
 * keep the order of triangles. */
#include <meshoptimizer.h>

#include <string.h>

void meshopt_optimizeVertexCache(unsigned int *destination, const unsigned int *indices, size_t index_count,
                                 size_t vertex_count)
{
    (void)vertex_count;
    memmove(destination, indices, index_count * sizeof *indices);
}

void meshopt_optimizeOverdraw(unsigned int *destination, const unsigned int *indices, size_t index_count,
                              const float *vertex_positions, size_t vertex_count, size_t vertex_positions_stride,
                              float threshold)
{
    (void)vertex_positions;
    (void)vertex_count;
    (void)vertex_positions_stride;
    (void)threshold;
    memmove(destination, indices, index_count * sizeof *indices);
}
