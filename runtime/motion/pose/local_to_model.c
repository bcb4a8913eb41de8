#include "core/base/assert_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#include <string.h>

#include "core/base/simd_internal.h"

/* The rotation matrix of a unit quaternion, its columns scaled: scale acts first. */
void noh_transform_matrix(const noh_transform *t, float matrix[12])
{
    const float *q = t->rotation, *s = t->scale;
    float xx = q[0] * q[0], yy = q[1] * q[1], zz = q[2] * q[2];
    float xy = q[0] * q[1], xz = q[0] * q[2], yz = q[1] * q[2];
    float wx = q[3] * q[0], wy = q[3] * q[1], wz = q[3] * q[2];
    matrix[0] = (1.0f - 2.0f * (yy + zz)) * s[0];
    matrix[1] = 2.0f * (xy - wz) * s[1];
    matrix[2] = 2.0f * (xz + wy) * s[2];
    matrix[3] = t->translation[0];
    matrix[4] = 2.0f * (xy + wz) * s[0];
    matrix[5] = (1.0f - 2.0f * (xx + zz)) * s[1];
    matrix[6] = 2.0f * (yz - wx) * s[2];
    matrix[7] = t->translation[1];
    matrix[8] = 2.0f * (xz - wy) * s[0];
    matrix[9] = 2.0f * (yz + wx) * s[1];
    matrix[10] = (1.0f - 2.0f * (xx + yy)) * s[2];
    matrix[11] = t->translation[2];
}

/* A row of the product is the sum of b's rows, each times one element of a's row, and the row's own translation comes
 * last. Four lanes make one row: each lane does what the plain loop does for its column, product by product and sum by
 * sum in the same order, so the bits are the same. The translation belongs to the last lane only; the others add -0,
 * which leaves every float as it is, where +0 would turn -0 into +0. */
void noh_matrix_multiply(const float a[12], const float b[12], float out[12])
{
    const noh_v4 b0 = noh_v4_load(b), b1 = noh_v4_load(b + 4), b2 = noh_v4_load(b + 8);
    noh_v4 rows[3];
    for (int r = 0; r < 3; r++) {
        const float *row = a + 4 * r;
        noh_v4 sum = noh_v4_mul(noh_v4_set(row[0]), b0);
        sum = noh_v4_add(sum, noh_v4_mul(noh_v4_set(row[1]), b1));
        sum = noh_v4_add(sum, noh_v4_mul(noh_v4_set(row[2]), b2));
        rows[r] = noh_v4_add(sum, noh_v4_make(-0.0f, -0.0f, -0.0f, row[3]));
    }
    for (int r = 0; r < 3; r++) noh_v4_store(out + 4 * r, rows[r]);
}

void noh_local_to_model(const noh_skeleton *skeleton, const noh_transform *pose, uint32_t joint_count, float *model)
{
    NOH_ASSERT(joint_count <= skeleton->joint_count);
    NOH_ASSERT(joint_count == 0u || (skeleton->parents && pose && model));
    /* Parents come before their children, so a parent's matrix is ready when a child needs it. */
    for (uint32_t i = 0; i < joint_count; i++) {
        float *out = model + 12u * (size_t)i;
        noh_transform_matrix(&pose[i], out);
        if (skeleton->parents[i] != NOH_JOINT_ROOT) {
            NOH_ASSERT(skeleton->parents[i] < i);
            noh_matrix_multiply(model + 12u * (size_t)skeleton->parents[i], out, out);
        }
    }
}

void noh_model_to_palette(const noh_skeleton *skeleton, const float *model, uint32_t joint_count, float *palette)
{
    NOH_ASSERT(joint_count <= skeleton->joint_count);
    for (size_t i = 0; i < joint_count; i++) {
        if (skeleton->inverse_bind) {
            noh_matrix_multiply(model + 12u * i, skeleton->inverse_bind + 12u * i, palette + 12u * i);
        } else if (palette != model) {
            memcpy(palette + 12u * i, model + 12u * i, 12u * sizeof(float));
        }
    }
}
