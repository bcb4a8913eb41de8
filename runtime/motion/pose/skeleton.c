#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"


static int finite_all(const float *values, uint32_t count)
{
    int fine = 1;
    for (uint32_t i = 0; i < count; i++) {
        fine = fine && values[i] - values[i] == 0.0f;
    }
    return fine;
}

static const char *bad_joint(const noh_skeleton *s, uint32_t i)
{
    const noh_transform *t = &s->bind_pose[i];
    float square = noh_quat_dot(t->rotation, t->rotation);
    if (s->parents[i] != NOH_JOINT_ROOT && s->parents[i] >= i) return "a joint's parent does not come before it";
    if (!finite_all(t->rotation, 4) || !finite_all(t->translation, 3) || !finite_all(t->scale, 3))
        return "a joint's bind pose is not finite";
    if (!(square > 0.999f && square < 1.001f)) return "a joint's bind rotation is not unit";
    if (s->inverse_bind && !finite_all(s->inverse_bind + 12u * (size_t)i, 12))
        return "a joint's inverse bind matrix is not finite";
    return NULL;
}

noh_result noh_skeleton_check(const noh_skeleton *skeleton, noh_error *error)
{
    if (skeleton->joint_count == 0 || skeleton->joint_count > NOH_JOINTS_MAX) {
        return noh_fail(error, NOH_ERR_ARG, "joint_count of a skeleton must be 1 to NOH_JOINTS_MAX", 0,
                        skeleton->joint_count);
    }
    if (!skeleton->parents) return noh_fail(error, NOH_ERR_ARG, "parents of a skeleton is NULL", 0, 0);
    if (!skeleton->bind_pose) return noh_fail(error, NOH_ERR_ARG, "bind_pose of a skeleton is NULL", 0, 0);
    for (uint32_t i = 0; i < skeleton->joint_count; i++) {
        const char *what = bad_joint(skeleton, i);
        if (what) {
            return noh_fail(error, NOH_ERR_DATA, what, i, 0);
        }
    }
    return NOH_OK;
}
