/* vmc.h: a person's movement as the VMC protocol sends it, by OSC (osc.h): bones, where the root stands, and weights of
 * expressions. Any bytes may be given; what is wrong is counted and left out.
 * Source: the Virtual Motion Capture protocol, performer to marionette (https://protocol.vmc.info/english). */
#ifndef NOH_NOH_CAPTURE_VMC_H
#define NOH_NOH_CAPTURE_VMC_H

#include <stddef.h>
#include <stdint.h>

#include "noh/base.h"

#define VMC_BONES 55u       /* Unity's humanoid */
#define VMC_VALUES_MAX 256u /* expressions */

/* Bones by number; of a pair the left one, and the right one after it. */
enum {
    VMC_HIPS = 0,
    VMC_UPPER_LEG = 1,
    VMC_LOWER_LEG = 3,
    VMC_FOOT = 5,
    VMC_UPPER_ARM = 13,
    VMC_LOWER_ARM = 15,
    VMC_HAND = 17
};

/* The name of a bone as the protocol has it (LeftUpperArm). */
extern const char *const vmc_bone_names[VMC_BONES];

/* Local, in Unity's axes: metres, y up, z ahead, x to the right; a rotation 0 where the figure stands in a T. */
typedef struct vmc_bone {
    int is_known; /* 1: it was received */
    float position[3], rotation[4];
} vmc_bone;

typedef struct vmc_value {
    char name[NOH_NAME_BYTES_MAX];
    float next, value; /* value: as of the last Apply */
} vmc_value;

typedef struct vmc {
    vmc_bone bones[VMC_BONES], root;
    vmc_value values[VMC_VALUES_MAX];
    uint32_t value_count;
    uint32_t packets, messages, bad, unread; /* unread: of other addresses */
} vmc;

/* A packet. */
void vmc_take(vmc *v, const uint8_t *bytes, size_t count);

#endif
