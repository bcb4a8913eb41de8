/* ragdoll_read.h: an artist's ragdoll as text: one body a line, JOINT [hinge] [forward|backward|upward] [bend MIN MAX]
 * [side ANGLE] [twist ANGLE] [friction NM], angles in degrees. */
#ifndef NOH_CONVERT_BASE_RAGDOLL_READ_H
#define NOH_CONVERT_BASE_RAGDOLL_READ_H

#include <stdint.h>

#include "noh/base.h"
#include "convert/base/error.h"

typedef struct ragdoll_line {
    char *joint;
    uint32_t line;
    uint32_t hinge, toward;
    float bend_min, bend_max, side, twist, friction; /* as noh_pack_ragdoll_row has them */
} ragdoll_line;

typedef struct ragdoll_text {
    ragdoll_line rows[NOH_RAGDOLL_BODIES_MAX];
    uint32_t count;
} ragdoll_text;

/* 0, or 1 with *line and *error; free in both cases. */
int ragdoll_read(const char *path, ragdoll_text **out, uint32_t *line, model_error *error);
void ragdoll_free(ragdoll_text *ragdoll);

#endif
