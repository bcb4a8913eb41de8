/* crowd.h: what the library keeps to itself of crowd.h. */
#ifndef NOH_CROWD_CROWD_H
#define NOH_CROWD_CROWD_H

#include <stddef.h>
#include <stdint.h>

#include "noh/crowd.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The agent steers only by the rules of low_stage.h: neighbours and obstacles repel it. FLOCK: it also moves along with its
 * neighbours. */
#define NOH_CROWD_FORCES 2u
#define NOH_CROWD_FLOCK 6u

#ifdef __cplusplus
}
#endif

#endif
