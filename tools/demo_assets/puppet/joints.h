/* The puppet's skeleton: names, parents and bind places of its joints. */
#ifndef PUPPET_JOINTS_H
#define PUPPET_JOINTS_H

#include "shared/maths.h"
#include "shared/sides.h"

/* Joints in the middle, then the left ones, then the right ones. */
enum { ROOT, HIPS, SPINE, CHEST, NECK, HEAD, JAW, MIDDLE_JOINTS };
enum {
    SHOULDER,
    UPPER_ARM,
    FOREARM,
    SLEEVE, /* the bag of the sleeve, which hangs from the forearm */
    HAND,
    THUMB, /* each finger has two joints */
    THUMB_TIP,
    INDEX,
    INDEX_TIP,
    MIDDLE,
    MIDDLE_TIP,
    RING,
    RING_TIP,
    LITTLE,
    LITTLE_TIP,
    THIGH,
    SHIN,
    FOOT,
    TOES,
    SKIRT, /* the hem of a leg of the hakama, which hangs from the knee */
    SIDE_JOINTS
};
enum { JOINT_COUNT = MIDDLE_JOINTS + 2 * SIDE_JOINTS };

/* The joint of one side: side_joint(LEFT, SHIN). */
int side_joint(int side, int joint);

const char *joint_name(int joint);
int joint_parent(int joint); /* -1 for the root; parents come first */

/* A joint's position in the bind pose, in the scene; there no joint is rotated. */
V3 joint_place(int joint);

/* The place for the left side's arm at `x`, on the line from shoulder to wrist. */
V3 arm_line(double x);

/* The position of the mask's own origin in the bind pose. */
V3 mask_origin(void);

#endif
