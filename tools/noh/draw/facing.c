#include "facing.h"

#include <string.h>

#include "core/base/vector_internal.h"
#include "life/physics/ragdoll_rig_internal.h"
#include "life/reach/bone_names_internal.h"
#include "noh/low_life.h"

#define SAME_WAY 0.8f /* cosine */

/* The way in the bind pose from one bone to another, on the ground, of length 1. 0: one is missing, or they lie above
 * each other. */
static int way_between(const noh_skeleton *joints, const uint16_t *bones, uint32_t from, uint32_t to, float way[3])
{
    static const float none[3] = { 0.0f, 0.0f, 0.0f };
    float a[3], b[3], unused[4];
    if (bones[from] == NOH_JOINT_ROOT || bones[to] == NOH_JOINT_ROOT) return 0;
    noh_ragdoll_bind(joints, bones[from], a, unused);
    noh_ragdoll_bind(joints, bones[to], b, unused);
    noh_sub3(b, a, way);
    way[1] = 0.0f;
    noh_normalize3(way, none);
    return noh_dot3(way, way) > 0.0f;
}

/* Names alone tell left from right: what is found by its place is on the side where it is expected. */
static void find_bones(const noh_pack *pack, uint32_t joint_count, uint16_t bones[NOH_BONES + 1])
{
    memset(bones, 0xFF, (NOH_BONES + 1) * sizeof *bones); /* NOH_JOINT_ROOT */
    for (uint32_t j = joint_count; j-- > 0;) {
        const char *name = noh_pack_joint_name(pack, 0, j);
        if (name) bones[noh_bone_of(name)] = (uint16_t)j;
    }
    bones[NOH_BONES] = NOH_JOINT_ROOT;
}

static double steps_of(float x, float z)
{
    if (x * x > z * z) return x > 0.0f ? 90.0 : -90.0;
    return z < 0.0f ? 180.0 : 0.0;
}

double pack_facing(const noh_pack *pack)
{
    static const float up[3] = { 0.0f, 1.0f, 0.0f };
    uint16_t bones[NOH_BONES + 1];
    noh_skeleton joints;
    float legs[3], arms[3], ahead[3];
    if (noh_pack_skeleton_at(pack, 0, &joints, NULL, NULL)) return 0.0;
    find_bones(pack, joints.joint_count, bones);
    if (!way_between(&joints, bones, NOH_BONE_UPPER_LEG + NOH_BONE_RIGHT, NOH_BONE_UPPER_LEG, legs) ||
        !way_between(&joints, bones, NOH_BONE_UPPER_ARM + NOH_BONE_RIGHT, NOH_BONE_UPPER_ARM, arms) ||
        noh_dot3(legs, arms) < SAME_WAY) {
        return 0.0;
    }
    noh_cross3(legs, up, ahead);
    for (uint32_t side = 0; side < 2; side++) {
        const uint32_t foot = NOH_BONE_FOOT + side * NOH_BONE_RIGHT;
        float toes[3];
        if (!way_between(&joints, bones, foot, foot + 1u, toes) || noh_dot3(ahead, toes) < SAME_WAY) return 0.0;
    }
    return steps_of(ahead[0], ahead[2]);
}
