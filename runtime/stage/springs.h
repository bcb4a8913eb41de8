/* springs.h: springs of a kind: chains of its joints that swing as its actors move.
 *
 *   noh_springs_size, noh_springs_init   chains and colliders of a skeleton, shared by all actors of kinds that have it
 *   noh_springs_part                     the part that swings them, for noh_kind_desc.parts
 *
 * All of it is a part (part.h): what swings is state of the stage, planned, saved, forked and hashed with all else, and
 * has the same bits for any number of jobs. Each chain is a spring of sim/spring.h, carried by the parent of its first
 * joint as clips, faces and the parts before have posed it. Clips that move a joint of a chain are overruled: its rest
 * is the bind pose.
 *
 * A chain whose first joint the level of detail leaves out stands at rest, and is at rest when it comes back; so are
 * all chains after a cut.
 * Threads: noh_springs_init as any init; afterwards it is read only. */
#ifndef NOH_STAGE_SPRINGS_H
#define NOH_STAGE_SPRINGS_H

#include "pose/skeleton.h"
#include "sim/spring.h"
#include "stage/part.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A joint that swings. */
typedef struct noh_spring_row {
    uint32_t joint;
    float stiffness, drag, radius, gravity; /* as in noh_spring_joint, in metres */
} noh_spring_row;

/* Rows whose joints each are a child of the one before; the first has a parent. */
typedef struct noh_spring_chain {
    uint32_t first_row, row_count; /* 1..NOH_SPRING_JOINTS_MAX */
    uint32_t collides;             /* bit i: with collider i */
    float end[3];                  /* where the last joint's bone ends, in its space, in the skeleton's unit */
} noh_spring_chain;

/* A capsule that goes along with a joint; a sphere where `from` and `to` are equal. */
typedef struct noh_spring_capsule {
    uint32_t joint;
    float from[3], to[3]; /* in the joint's space, in the skeleton's unit */
    float radius;         /* metres, 0.. */
} noh_spring_capsule;

/* All is read at init. */
typedef struct noh_springs_desc {
    noh_skeleton skeleton; /* of the kinds that use it */
    float metres;          /* of one unit of the skeleton: noh_skeleton_header.unit_cm / 100 */
    const noh_spring_row *rows;
    uint32_t row_count; /* 1..NOH_JOINTS_MAX */
    uint32_t chain_count;
    const noh_spring_chain *chains; /* they come in this order: one that hangs on another behind it */
    const noh_spring_capsule *colliders;
    uint32_t collider_count; /* 0..NOH_SPRING_COLLIDERS_MAX */
} noh_springs_desc;

typedef struct noh_springs noh_springs;

/* The exact bytes; 0 for counts that are impossible. */
size_t noh_springs_size(const noh_springs_desc *desc);

/* errors  ARG memory is NULL or misaligned, a chain's rows are not there or not parent and child, a joint swings twice,
 *         or a number is out of its range (where: the chain, row or collider); LIMIT a count, or the state of
 *         one actor would have more than NOH_STAGE_PART_BYTES_MAX; MEMORY it is too small */
noh_result noh_springs_init(void *memory, size_t bytes, const noh_springs_desc *desc, noh_springs **springs,
                            noh_error *error);

/* The part; the springs must outlive the stage. Of each actor: 4 bytes a chain rounded up to 16, and a noh_spring each.
 * The kind's skeleton is that of the desc: a kind with fewer joints is not swung. */
noh_stage_part noh_springs_part(const noh_springs *springs);

#ifdef __cplusplus
}
#endif

#endif
