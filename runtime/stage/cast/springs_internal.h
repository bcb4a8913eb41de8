/* springs_internal.h: the private part of modules.h. */
#ifndef NOH_STAGE_SPRINGS_INTERNAL_H
#define NOH_STAGE_SPRINGS_INTERNAL_H

#include "noh/base.h"
#include "noh/modules.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_SPRINGS_FADE_PIXELS 16.0f

/* The exact bytes; 0 for counts that are impossible. */
size_t noh_springs_size(const noh_springs_desc *desc);

/* errors  ARG memory is NULL or misaligned, a chain's rows are not there or not parent and child, a joint swings twice,
 *         or a number is out of its range (where: the chain, row or collider); LIMIT a count, or the state of
 *         one actor would have more than NOH_MODIFIER_BYTES_MAX; MEMORY it is too small */
noh_result noh_springs_init(void *memory, size_t bytes, const noh_springs_desc *desc, noh_springs **springs,
                            noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
