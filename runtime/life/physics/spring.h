/* low_life.h: what the library keeps to itself of runtime/noh/low_life.h. */
#ifndef NOH_SIM_SPRING_H
#define NOH_SIM_SPRING_H

#include <stddef.h>
#include <stdint.h>

#include "noh/base.h"
#include "noh/low_life.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Check a desc.
 * errors  ARG, LIMIT: as noh_spring_init */
noh_result noh_spring_check_desc(const noh_spring_desc *desc, noh_error *error);

/* Check a spring of this desc whose bytes come from outside.
 * shapes   spring: noh_spring_size bytes, aligned to 16
 * returns  NULL if it may be used, else a constant message */
const char *noh_spring_check(const noh_spring *spring, const noh_spring_desc *desc);

#ifdef __cplusplus
}
#endif

#endif
