/* triangle_order.c: for processors that have no package of meshoptimizer: triangles keep the order of the model. */
#include "convert/pack/triangle_order.h"

int triangle_order(uint32_t *indices, size_t count, const float *positions, size_t vertex_count)
{
    (void)indices;
    (void)count;
    (void)positions;
    (void)vertex_count;
    return 0;
}
