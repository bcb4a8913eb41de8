/* far_joints.c: virtual joints, which stand for the targets in coarse levels. */
#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "noh/deform.h"
#include "noh/low_motion.h"
#include "noh/format.h"
#include "noh/pack.h"

#include <string.h>

/* The i-th number of a word, -512..511. */
static float number_of(uint32_t word, uint32_t i)
{
    const uint32_t bits = word >> 10u * i & 0x3ffu;
    return (float)((int32_t)(bits ^ 0x200u) - 0x200);
}

/* Moves and turns of all joints in units of their scales, target by target. */
static void sum_motions(const noh_far_joints_header *h, const float *weights, float sums[][6])
{
    const uint32_t *motion = (const uint32_t *)(const void *)((const uint8_t *)h + h->motions_offset);
    memset(sums, 0, h->joint_count * sizeof *sums);
    for (uint32_t t = 0; t < h->target_count; t++, motion += 2u * h->joint_count) {
        if (weights[t] == 0.0f) continue;
        for (size_t j = 0; j < h->joint_count; j++) {
            for (uint32_t k = 0; k < 6u; k++) sums[j][k] += weights[t] * number_of(motion[2u * j + k / 3u], k % 3u);
        }
    }
}

void noh_mesh_move_far_joints(const noh_mesh *mesh, const float *weights, float *matrices)
{
    NOH_ASSERT(mesh && weights && matrices);
    const noh_far_joints_header *h = mesh->far_joints;
    float sums[NOH_FAR_JOINTS_MAX][6];
    const float *centres, *scales;
    if (!h || mesh->header->level < h->level) return;
    centres = (const float *)(const void *)((const uint8_t *)h + h->centres_offset);
    scales = (const float *)(const void *)((const uint8_t *)h + h->scales_offset);
    sum_motions(h, weights, sums);
    for (size_t j = 0; j < h->joint_count; j++) {
        const float *c = centres + 3u * j;
        float *matrix = matrices + 12u * (h->first_joint + j), b[3], w[3], local[12];
        for (uint32_t k = 0; k < 3u; k++) {
            b[k] = sums[j][k] * scales[2u * j];
            w[k] = sums[j][3u + k] * scales[2u * j + 1u];
        }
        for (uint32_t k = 0; k < 3u; k++) {
            const uint32_t x = (k + 1u) % 3u, y = (k + 2u) % 3u;
            local[4u * k + k] = 1.0f;
            local[4u * k + x] = -w[y];
            local[4u * k + y] = w[x];
            local[4u * k + 3u] = b[k] - (w[x] * c[y] - w[y] * c[x]);
        }
        noh_matrix_multiply(matrix, local, matrix);
    }
}
