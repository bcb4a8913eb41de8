/* springs_chain.h (private to springs/): chains added one after another. */
#ifndef NOH_CONVERT_SPRINGS_SPRINGS_CHAIN_H
#define NOH_CONVERT_SPRINGS_SPRINGS_CHAIN_H

#include "convert/springs/springs_bind.h"
#include "noh/format.h"

/* A way down a skeleton, each joint below the one before. */
typedef struct springs_path {
    const raw_skeleton *skeleton;
    noh_spring_row *rows; /* [count] */
    uint32_t count, collides;
    float end[3]; /* of the last joint's bone, in its space */
} springs_path;

/* Where a joint lies in the space of one above it, at rest. */
void springs_place(const raw_skeleton *skeleton, uint32_t joint, uint32_t above, float out[3]);

/* Add the parts of a path that can swing: a chain for each run of joints that are parent and child, have a parent and
 * bones with lengths, and are in no other chain. *left_out: joints that do not swing for another reason than being in
 * one. 0, or 1 when out of memory. */
int springs_add_path(set_springs *out, const springs_path *path, uint32_t *left_out);

int springs_swings(const set_springs *springs, uint32_t joint);

/* Add a collider; its bit in *bit, 0 where there are too many. 0, or 1 when out of memory. */
int springs_add_collider(set_springs *out, const noh_spring_capsule *collider, uint32_t *bit);

#endif
