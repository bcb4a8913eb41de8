/* springs.h: springs of a kind: chains of its joints that swing as its actors move.
 *
 *   noh_springs_of_pack                  the springs of a pack (noh build --springs), which stages run by themselves
 *   noh_springs_size, noh_springs_init   chains and colliders of a skeleton, shared by all actors that have it
 *   noh_springs_part                     the part that runs them, for noh_kind_desc.parts
 *
 * A kind whose pack brings springs needs none of these calls: its stage makes them, and runs them after all other
 * parts, unless noh_kind_desc.without_springs. The calls are for springs that the game describes itself.
 *
 * All of it is a part (part.h): what swings is state of the stage, planned, saved, forked and hashed with all else, and
 * has the same bits for any number of jobs. Each chain is a spring of spring.h, carried by the parent of its first
 * joint as clips, faces and the parts before have posed it. Clips that move a joint of a chain are overruled: its rest
 * is the bind pose.
 *
 * A chain that looks shorter than NOH_SPRINGS_FADE_PIXELS fades into its rest, and stands at rest, at no cost, from
 * half of that length down; it begins anew from rest, and fades in. All chains are at rest after a cut.
 * Threads: noh_springs_init as any init; afterwards it is read only. */
#ifndef NOH_STAGE_SPRINGS_H
#define NOH_STAGE_SPRINGS_H

#include "core/pack/pack.h"
#include "motion/pose/skeleton.h"
#include "life/physics/spring.h"
#include "stage/cast/part.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_SPRINGS_FADE_PIXELS 16.0f

/* Rows, chains and capsules are those of format.h. All is read at init. */
typedef struct noh_springs_desc {
    noh_skeleton skeleton; /* of the kinds that use it */
    float metres;          /* of one unit of the skeleton: noh_skeleton_header.unit_cm / 100 */
    const noh_spring_row *rows;
    uint32_t row_count; /* 1..NOH_JOINTS_MAX */
    uint32_t chain_count;
    const noh_spring_chain *chains; /* they come in this order: one that hangs on another behind it */
    const noh_spring_capsule *colliders;
    uint32_t collider_count; /* 0..NOH_SPRING_COLLIDERS_MAX */
    float restitution;       /* noh_spring_desc.restitution of all chains; 0 of a pack's */
} noh_springs_desc;

typedef struct noh_springs noh_springs;

/* What a pack has for one of its skeletons; it points into the pack.
 * returns  0: there are none, and *desc is untouched */
int noh_springs_of_pack(const noh_pack *pack, uint32_t skeleton, noh_springs_desc *desc);

/* The exact bytes; 0 for counts that are impossible. */
size_t noh_springs_size(const noh_springs_desc *desc);

/* errors  ARG memory is NULL or misaligned, a chain's rows are not there or not parent and child, a joint swings twice,
 *         or a number is out of its range (where: the chain, row or collider); LIMIT a count, or the state of
 *         one actor would have more than NOH_STAGE_PART_BYTES_MAX; MEMORY it is too small */
noh_result noh_springs_init(void *memory, size_t bytes, const noh_springs_desc *desc, noh_springs **springs,
                            noh_error *error);

/* Bytes of each actor and of each job that their part will have; of a desc that noh_springs_init takes. */
void noh_springs_measure(const noh_springs_desc *desc, size_t *state_bytes, size_t *scratch_bytes);

/* The part; the springs must outlive the stage. Of each actor: 4 bytes a chain rounded up to 16, and a noh_spring each.
 * The kind's skeleton is that of the desc: a kind with fewer joints is not swung. */
noh_stage_part noh_springs_part(const noh_springs *springs);

#ifdef __cplusplus
}
#endif

#endif
