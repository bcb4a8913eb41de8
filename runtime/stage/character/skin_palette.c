#include "core/base/assert_internal.h"
#include "stage/character/time_lod_internal.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/pack.h"

#include <string.h>

#include "stage/character/character_internal.h"

void noh_pose_skin(const noh_skeleton *skeleton, const noh_skin *skin, const noh_transform *pose, float *model,
                   float *matrices)
{
    NOH_ASSERT(skeleton && skin && pose && model && matrices && model != matrices);
    noh_local_to_model(skeleton, pose, skeleton->joint_count, model);
    noh_skin_matrices(skin, model, matrices);
}

/* With two matrices. */
static int has_joint_twice(const noh_skin *skin)
{
    for (uint32_t i = 0; i < skin->header->joint_count; i++) {
        for (uint32_t k = 0; k < i; k++) {
            if (skin->joints[i] == skin->joints[k] &&
                memcmp(skin->inverse_bind + 12u * i, skin->inverse_bind + 12u * k, 12u * sizeof(float))) {
                return 1;
            }
        }
    }
    return 0;
}

int noh_skin_skeleton(const noh_skin *skin, const noh_skeleton *skeleton, float *inverse_bind, noh_skeleton *out)
{
    static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    NOH_ASSERT(skin && skeleton && inverse_bind && out);
    *out = *skeleton;
    out->inverse_bind = NULL;
    if (has_joint_twice(skin)) {
        return 0;
    }
    for (size_t j = 0; j < skeleton->joint_count; j++) {
        memcpy(inverse_bind + 12u * j, identity, sizeof identity);
    }
    for (size_t i = 0; i < skin->header->joint_count; i++) {
        NOH_ASSERT(skin->joints[i] < skeleton->joint_count);
        memcpy(inverse_bind + 12u * (size_t)skin->joints[i], skin->inverse_bind + 12u * i, sizeof identity);
    }
    out->inverse_bind = inverse_bind;
    return 1;
}

/* A character's two palettes hold the joints' model-space matrices or, if the skeleton of its updates had inverse bind
 * matrices, the products of both. Mixing is linear, so it may come before or after this product; here it comes first,
 * joint by joint, and then the product if it is still missing. */
void noh_character_skin(const noh_character *ch, const noh_skin *skin, float *matrices)
{
    NOH_ASSERT(ch->time.posed && skin && matrices);
    const uint32_t to = ch->time.to_pose;
    const float *source = noh_character_pose_palette(ch, to ^ 1u), *target = noh_character_pose_palette(ch, to);
    const float part = noh_time_lod_fraction(&ch->time);
    const int multiplied = (int)(ch->multiplied >> to & 1u);
    NOH_ASSERT(part >= 1.0f || (int)(ch->multiplied >> (to ^ 1u) & 1u) == multiplied);
    for (size_t k = 0; k < skin->header->joint_count; k++) {
        const size_t joint = skin->joints[k];
        float *matrix = matrices + 12u * k;
        NOH_ASSERT(joint < ch->joint_count);
        if (part >= 1.0f) {
            memcpy(matrix, target + 12u * joint, 12u * sizeof(float));
        } else {
            noh_mix_fours(source + 12u * joint, target + 12u * joint, part, 3, matrix);
        }
        if (!multiplied) {
            noh_matrix_multiply(matrix, skin->inverse_bind + 12u * k, matrix);
        }
    }
}
