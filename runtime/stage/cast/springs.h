/* modules.h: what the library keeps to itself of runtime/noh/modules.h. */
#ifndef NOH_STAGE_SPRINGS_H
#define NOH_STAGE_SPRINGS_H

#include "noh/base.h"
#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_SPRINGS_FADE_PIXELS 16.0f

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
