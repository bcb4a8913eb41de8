#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#include <string.h>

#include "core/base/math_internal.h"
#include "deform/skin/skin_blend_internal.h"
#include "deform/skin/skin_internal.h"

/* Axes of 1000 : 1 need 14: each step halves the ratio until it is small, then doubles the number of correct digits. */
#define POLAR_STEPS 24

/* ---- polar decomposition ---- */

/* R of the polar decomposition A = R H by Newton's iteration R <- (R + R^-T) / 2 (Higham, Computing the polar
 * decomposition, 1986). Each singular value of R becomes the mean of itself and its reciprocal while the directions
 * stay: all converge to 1, quadratically once they are near. R^-T is the cofactors over the determinant. A is first
 * scaled to about unit size, which saves the steps that would only halve large values. m: 3 rows of 4, the fourth
 * column is unused. Returns 0 if A has no inverse. */
static int polar_rotation(const float a[12], float m[12])
{
    float size = noh_sqrt((noh_dot3(a, a) + noh_dot3(a + 4, a + 4) + noh_dot3(a + 8, a + 8)) / 3.0f), c[9],
          change = 1.0f;
    if (!(size > 1e-18f)) {
        return 0;
    }
    for (int i = 0; i < 12; i++) {
        m[i] = a[i] / size;
    }
    for (int step = 0; step < POLAR_STEPS && change > 1e-12f; step++) {
        float determinant;
        noh_cofactors(m, c);
        determinant = noh_dot3(m, c);
        if (!(determinant > 1e-7f || determinant < -1e-7f)) {
            return 0;
        }
        change = 0.0f;
        for (int i = 0; i < 9; i++) {
            float *e = &m[i / 3 * 4 + i % 3], next = 0.5f * (*e + c[i] / determinant), d = next - *e;
            change += d * d;
            *e = next;
        }
    }
    return 1;
}

/* The quaternion of a rotation. Each row below is the quaternion times four times one of its components, from sums and
 * differences of the matrix. The row of the largest component loses no digits, while small ones cancel; it is
 * normalised. (S. W. Shepperd, "Quaternion from rotation matrix", 1978) */
static void rotation_quaternion(const float m[12], float q[4])
{
    const float squares[4] = { 1.0f + m[0] - m[5] - m[10], 1.0f - m[0] + m[5] - m[10], 1.0f - m[0] - m[5] + m[10],
                               1.0f + m[0] + m[5] + m[10] };
    const float xy = m[1] + m[4], xz = m[2] + m[8], yz = m[6] + m[9], xw = m[9] - m[6], yw = m[2] - m[8],
                zw = m[4] - m[1];
    const float rows[4][4] = {
        { squares[0], xy, xz, xw }, { xy, squares[1], yz, yw }, { xz, yz, squares[2], zw }, { xw, yw, zw, squares[3] }
    };
    int largest = 3;
    for (int i = 0; i < 3; i++) {
        largest = squares[i] > squares[largest] ? i : largest;
    }
    memcpy(q, rows[largest], 4 * sizeof *q);
    noh_quat_normalize(q);
}

void noh_dual_quaternion_from_matrix(const float a[12], noh_dual_quaternion *out)
{
    static const float identity[12] = { 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f };
    const float t[3] = { a[3], a[7], a[11] };
    float r[12], sign, c[9];
    if (!polar_rotation(a, r)) {
        memcpy(r, identity, sizeof r);
    }
    sign = noh_cofactors(r, c); /* below 0 for a mirror: then -R is the rotation, and the stretch gets the sign */
    for (int i = 0; i < 12; i++) {
        r[i] *= sign;
    }
    rotation_quaternion(r, out->real);
    for (int i = 0; i < 9; i++) { /* H = R^T A */
        const int row = i / 3, column = i % 3;
        out->stretch[i] = r[row] * a[column] + r[4 + row] * a[4 + column] + r[8 + row] * a[8 + column];
    }
    /* d = 1/2 (t, 0) r */
    out->dual[0] = 0.5f * (out->real[3] * t[0] + t[1] * out->real[2] - t[2] * out->real[1]);
    out->dual[1] = 0.5f * (out->real[3] * t[1] + t[2] * out->real[0] - t[0] * out->real[2]);
    out->dual[2] = 0.5f * (out->real[3] * t[2] + t[0] * out->real[1] - t[1] * out->real[0]);
    out->dual[3] = -0.5f * noh_dot3(t, out->real);
}

void noh_skin_dual_quaternions(const float *matrices, uint32_t count, noh_dual_quaternion *out)
{
    for (size_t j = 0; j < count; j++) {
        noh_dual_quaternion_from_matrix(matrices + 12u * j, &out[j]);
    }
}

/* ---- vertices ---- */

static void add_scaled(float *sum, const float *values, float factor, int count)
{
    for (int i = 0; i < count; i++) {
        sum[i] += factor * values[i];
    }
}

/* The weighted sums of one vertex's joints, with the rotation part unit. r and -r are one rotation: those on the far
 * side of the strongest joint's are negated, or the blend would take the long way round. |r| is then at least that
 * joint's weight, so nothing is divided by 0. */
static void blend(const noh_dual_quaternion *joints, const uint32_t *places, const float *weights, uint32_t count,
                  noh_dual_quaternion *sum)
{
    float inverse;
    memset(sum, 0, sizeof *sum);
    for (uint32_t i = 0; i < count; i++) {
        const noh_dual_quaternion *joint = &joints[places[i]];
        float shorter = noh_quat_dot(joint->real, joints[places[0]].real) < 0.0f ? -weights[i] : weights[i];
        add_scaled(sum->real, joint->real, shorter, 4);
        add_scaled(sum->dual, joint->dual, shorter, 4);
        add_scaled(sum->stretch, joint->stretch, weights[i], 9);
    }
    inverse = 1.0f / noh_sqrt(noh_quat_dot(sum->real, sum->real));
    for (int i = 0; i < 4; i++) {
        sum->real[i] *= inverse;
        sum->dual[i] *= inverse;
    }
}

/* Stretch the vertex (noh_skin_apply with a matrix that does not move the origin), then rotate and translate it. */
static void move(const noh_dual_quaternion *q, noh_vertex *vertex)
{
    const float *r = q->real, *d = q->dual, *h = q->stretch;
    float stretch[12] = { h[0], h[1], h[2], 0.0f, h[3], h[4], h[5], 0.0f, h[6], h[7], h[8], 0.0f };
    float t[3] = { 2.0f * (r[3] * d[0] - d[3] * r[0] + (r[1] * d[2] - r[2] * d[1])),
                   2.0f * (r[3] * d[1] - d[3] * r[1] + (r[2] * d[0] - r[0] * d[2])),
                   2.0f * (r[3] * d[2] - d[3] * r[2] + (r[0] * d[1] - r[1] * d[0])) };
    noh_skin_apply(stretch, vertex);
    noh_quat_rotate(r, vertex->position, vertex->position);
    noh_quat_rotate(r, vertex->normal, vertex->normal);
    noh_quat_rotate(r, vertex->tangent, vertex->tangent);
    for (int i = 0; i < 3; i++) {
        vertex->position[i] += t[i];
    }
}

void noh_skin_vertex_dual(const noh_mesh *mesh, const noh_dual_quaternion *joints, const noh_morph_layers *layers,
                          uint32_t index, noh_vertex *out)
{
    NOH_ASSERT(joints && out && mesh->header->skin != NOH_NONE);
    uint32_t places[NOH_INFLUENCES_MAX];
    float weights[NOH_INFLUENCES_MAX];
    uint32_t count = noh_mesh_influences(mesh, index, places, weights);
    noh_dual_quaternion sum;
    blend(joints, places, weights, count, &sum);
    if (layers) {
        noh_morph_vertex(mesh, layers, index, out);
    } else {
        noh_mesh_vertex(mesh, index, out);
    }
    move(&sum, out);
}

void noh_skin_point_dual(const noh_mesh *mesh, const noh_dual_quaternion *joints, uint32_t index, const float p[3],
                         float out[3])
{
    NOH_ASSERT(joints && out && mesh->header->skin != NOH_NONE);
    uint32_t places[NOH_INFLUENCES_MAX];
    float weights[NOH_INFLUENCES_MAX];
    const uint32_t count = noh_mesh_influences(mesh, index, places, weights);
    noh_dual_quaternion sum;
    noh_vertex vertex;
    blend(joints, places, weights, count, &sum);
    noh_mesh_vertex(mesh, index, &vertex);
    memcpy(vertex.position, p, sizeof vertex.position);
    move(&sum, &vertex);
    memcpy(out, vertex.position, 3 * sizeof *out);
}

void noh_skin_vertices_dual(const noh_mesh *mesh, const noh_dual_quaternion *joints, const noh_morph_layers *layers,
                            uint32_t first, uint32_t count, float *positions, float *normals, float *tangents)
{
    for (uint32_t i = 0; i < count; i++) {
        noh_vertex vertex;
        noh_skin_vertex_dual(mesh, joints, layers, first + i, &vertex);
        if (positions) memcpy(positions + 3u * (size_t)i, vertex.position, 12);
        if (normals) memcpy(normals + 3u * (size_t)i, vertex.normal, 12);
        if (tangents) memcpy(tangents + 4u * (size_t)i, vertex.tangent, 16);
    }
}
