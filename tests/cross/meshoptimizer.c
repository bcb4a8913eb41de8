/* The one function that the converter's C files take from meshoptimizer, for processors that
 * have no package of it: the order of triangles stays as it is. */
#include <meshoptimizer.h>

#include <string.h>

void meshopt_optimizeVertexCache(unsigned int *destination, const unsigned int *indices, size_t index_count, size_t vertex_count)
{
    (void)vertex_count;
    memmove(destination, indices, index_count * sizeof *indices);
}
