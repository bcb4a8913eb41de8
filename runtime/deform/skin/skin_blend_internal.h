/* skin_blend_internal.h (private to deform/): cofactors of a matrix, and a vertex moved by it. */
#ifndef NOH_DEFORM_SKIN_BLEND_INTERNAL_H
#define NOH_DEFORM_SKIN_BLEND_INTERNAL_H

#include "noh/deform.h"
#include "noh/pack.h"

/* c[3][3] rows: the cofactors of a matrix of 3 rows of 4, which transform normals as the matrix transforms points,
 * times its determinant. Returns the determinant's sign: a mirror's cofactors point inward. */
static inline float noh_cofactors(const float m[12], float c[9])
{
    float determinant;
    c[0] = m[5] * m[10] - m[6] * m[9];
    c[1] = m[6] * m[8] - m[4] * m[10];
    c[2] = m[4] * m[9] - m[5] * m[8];
    c[3] = m[2] * m[9] - m[1] * m[10];
    c[4] = m[0] * m[10] - m[2] * m[8];
    c[5] = m[1] * m[8] - m[0] * m[9];
    c[6] = m[1] * m[6] - m[2] * m[5];
    c[7] = m[2] * m[4] - m[0] * m[6];
    c[8] = m[0] * m[5] - m[1] * m[4];
    determinant = m[0] * c[0] + m[1] * c[1] + m[2] * c[2];
    return determinant < 0.0f ? -1.0f : 1.0f;
}

/* Move a point of the morphed surface by a vertex's joints, with the same bits as noh_skin_position and
 * noh_skin_vertex_dual. */
void noh_skin_point(const noh_mesh *mesh, const float *matrices, uint32_t index, const float p[3], float out[3]);
void noh_skin_point_dual(const noh_mesh *mesh, const noh_dual_quaternion *joints, uint32_t index, const float p[3],
                         float out[3]);

/* Get a vertex before its joints move it, with morph targets applied. layers NULL: no morph targets. */
void noh_skin_rest(const noh_mesh *mesh, const noh_morph_layers *layers, uint32_t index, noh_vertex *out);

/* Move a vertex by a matrix: position, normal, tangent. */
void noh_skin_apply(const float m[12], noh_vertex *vertex);

#endif
