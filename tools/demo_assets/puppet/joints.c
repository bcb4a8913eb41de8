#include "joints.h"

typedef struct {
    const char *name[SIDES]; /* of a joint in the middle: the first */
    int parent;              /* of a side's joint: another of that side, or UP_ plus one of the middle */
    V3 place;
} Joint;

#define UP_(middle) (-1 - (middle))

static const Joint middle[MIDDLE_JOINTS] = {
    { { "root" }, -1, { 0, 0, 0 } },
    { { "hips" }, ROOT, { 0, 0.900, 0 } },
    { { "spine" }, HIPS, { 0, 0.990, -0.010 } },
    { { "chest" }, SPINE, { 0, 1.120, -0.012 } },
    { { "neck" }, CHEST, { 0, 1.365, -0.012 } },
    { { "head" }, NECK, { 0, 1.420, 0.000 } },
    { { "jaw" }, HEAD, { 0, 1.496, 0.053 } },
};

/* The arms hang at 45 degrees, thumbs in front. */
/* clang-format off */
static const Joint left[SIDE_JOINTS] = {
    { { "shoulder.L", "shoulder.R" }, UP_(CHEST), { 0.030, 1.295, -0.005 } },
    { { "upper_arm.L", "upper_arm.R" }, SHOULDER, { 0.160, 1.285, -0.005 } },
    { { "forearm.L", "forearm.R" }, UPPER_ARM, { 0.351, 1.094, -0.005 } },
    { { "sleeve.L", "sleeve.R" }, FOREARM, { 0.425, 1.020, -0.005 } },
    { { "hand.L", "hand.R" }, FOREARM, { 0.517, 0.928, -0.005 } },
    { { "thumb.L", "thumb.R" }, HAND, { 0.532, 0.902, 0.026 } },
    { { "thumb_tip.L", "thumb_tip.R" }, THUMB, { 0.549, 0.874, 0.044 } },
    { { "index.L", "index.R" }, HAND, { 0.582, 0.863, 0.021 } },
    { { "index_tip.L", "index_tip.R" }, INDEX, { 0.609, 0.836, 0.023 } },
    { { "middle.L", "middle.R" }, HAND, { 0.582, 0.863, 0.003 } },
    { { "middle_tip.L", "middle_tip.R" }, MIDDLE, { 0.611, 0.834, 0.004 } },
    { { "ring.L", "ring.R" }, HAND, { 0.582, 0.863, -0.014 } },
    { { "ring_tip.L", "ring_tip.R" }, RING, { 0.609, 0.836, -0.016 } },
    { { "little.L", "little.R" }, HAND, { 0.582, 0.863, -0.031 } },
    { { "little_tip.L", "little_tip.R" }, LITTLE, { 0.604, 0.841, -0.035 } },
    { { "thigh.L", "thigh.R" }, UP_(HIPS), { 0.090, 0.840, 0.000 } },
    { { "shin.L", "shin.R" }, THIGH, { 0.100, 0.455, 0.012 } },
    { { "foot.L", "foot.R" }, SHIN, { 0.106, 0.078, -0.012 } },
    { { "toes.L", "toes.R" }, FOOT, { 0.110, 0.018, 0.118 } },
    { { "skirt.L", "skirt.R" }, SHIN, { 0.112, 0.420, 0.006 } },
};
/* clang-format on */

int side_joint(int side, int joint)
{
    return MIDDLE_JOINTS + side * SIDE_JOINTS + joint;
}

static int side_of(int joint)
{
    return (joint - MIDDLE_JOINTS) / SIDE_JOINTS;
}

static const Joint *joint_data(int joint)
{
    return joint < MIDDLE_JOINTS ? &middle[joint] : &left[(joint - MIDDLE_JOINTS) % SIDE_JOINTS];
}

const char *joint_name(int joint)
{
    return joint_data(joint)->name[joint < MIDDLE_JOINTS ? 0 : side_of(joint)];
}

int joint_parent(int joint)
{
    int parent = joint_data(joint)->parent;
    if (joint < MIDDLE_JOINTS) {
        return parent;
    }
    return parent < 0 ? UP_(parent) : side_joint(side_of(joint), parent);
}

V3 joint_place(int joint)
{
    V3 place = joint_data(joint)->place;
    if (joint >= MIDDLE_JOINTS) {
        place.x *= side_sign(side_of(joint));
    }
    return place;
}

V3 arm_line(double x)
{
    V3 top = left[UPPER_ARM].place, end = left[HAND].place;
    return v3_add(top, v3_scale(v3_sub(end, top), (x - top.x) / (end.x - top.x)));
}

V3 mask_origin(void)
{
    return v3(0, 1.500, 0.098);
}
