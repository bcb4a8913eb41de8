/* uv_length.c: how far a picture slides over a surface. */
#include <math.h>

#include "model_build.h"

/* A mesh whose UVs are all in one place, or nearly, has no length of its own: then it is a share of its diagonal. */
#define LENGTH_LEAST 0.01
#define LENGTH_MOST 10.0

static double area_of(const float *a, const float *b, const float *c, uint32_t axes)
{
    double u[3] = { 0.0, 0.0, 0.0 }, v[3] = { 0.0, 0.0, 0.0 }, x, y, z;
    for (uint32_t k = 0; k < axes; k++) {
        u[k] = (double)b[k] - (double)a[k];
        v[k] = (double)c[k] - (double)a[k];
    }
    x = u[1] * v[2] - u[2] * v[1];
    y = u[2] * v[0] - u[0] * v[2];
    z = u[0] * v[1] - u[1] * v[0];
    return sqrt(x * x + y * y + z * z);
}

static double diagonal_of(const model_mesh *m)
{
    double sum = 0.0;
    for (size_t axis = 0; axis < 3; axis++) {
        double low = (double)m->position[axis], high = low;
        for (size_t v = 1; v < m->vertex_count; v++) {
            low = fmin(low, (double)m->position[3 * v + axis]);
            high = fmax(high, (double)m->position[3 * v + axis]);
        }
        sum += (high - low) * (high - low);
    }
    return sqrt(sum);
}

double model_uv_length(const model_mesh *m)
{
    const double diagonal = diagonal_of(m);
    double surface = 0.0, picture = 0.0, length;
    for (uint32_t i = 0; i + 2u < m->index_count; i += 3u) {
        const size_t a = m->indices[i], b = m->indices[i + 1u], c = m->indices[i + 2u];
        surface += area_of(m->position + 3 * a, m->position + 3 * b, m->position + 3 * c, 3);
        picture += area_of(m->uv + 2 * a, m->uv + 2 * b, m->uv + 2 * c, 2);
    }
    length = picture > 0.0 ? sqrt(surface / picture) : LENGTH_MOST * diagonal;
    if (!(length > LENGTH_LEAST * diagonal)) length = LENGTH_LEAST * diagonal;
    return length < LENGTH_MOST * diagonal ? length : LENGTH_MOST * diagonal;
}
