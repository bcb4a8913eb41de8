#include "facing.h"

#include <math.h>
#include <string.h>

#include "life/physics/ragdoll_rig_internal.h"
#include "noh/low_life.h"

#define SAME_WAY 0.8 /* cosine */

/* The way in the bind pose from one bone to another, on the ground. 0: one is missing, or they lie above each other. */
static int way_between(const noh_retarget_rig *rig, uint32_t from, uint32_t to, double way[2])
{
    float a[3], b[3], unused[4];
    if (rig->bones[from] == NOH_JOINT_ROOT || rig->bones[to] == NOH_JOINT_ROOT) return 0;
    noh_ragdoll_bind(rig->skeleton, rig->bones[from], a, unused);
    noh_ragdoll_bind(rig->skeleton, rig->bones[to], b, unused);
    way[0] = (double)b[0] - (double)a[0];
    way[1] = (double)b[2] - (double)a[2];
    const double length = hypot(way[0], way[1]);
    if (!(length > 0.0)) return 0;
    way[0] /= length;
    way[1] /= length;
    return 1;
}

double pack_facing(const noh_pack *pack)
{
    noh_ragdoll_source source;
    noh_retarget_rig rig;
    double legs[2], arms[2];
    memset(&source, 0, sizeof source);
    source.pack = pack;
    if (noh_pack_skeleton_at(pack, 0, &source.joints, NULL, NULL) || noh_retarget_rig_make(&source, &rig, NULL) ||
        !way_between(&rig, NOH_BONE_UPPER_LEG + NOH_BONE_RIGHT, NOH_BONE_UPPER_LEG, legs) ||
        !way_between(&rig, NOH_BONE_UPPER_ARM + NOH_BONE_RIGHT, NOH_BONE_UPPER_ARM, arms) ||
        legs[0] * arms[0] + legs[1] * arms[1] < SAME_WAY) {
        return 0.0;
    }
    const double ahead[2] = { -legs[1], legs[0] }; /* left x up */
    for (uint32_t side = 0; side < 2; side++) {
        const uint32_t foot = NOH_BONE_FOOT + side * NOH_BONE_RIGHT;
        double toes[2];
        if (!way_between(&rig, foot, foot + 1u, toes) || ahead[0] * toes[0] + ahead[1] * toes[1] < SAME_WAY) return 0.0;
    }
    return 90.0 * floor(atan2(ahead[0], ahead[1]) / 1.5707963267948966 + 0.5);
}
