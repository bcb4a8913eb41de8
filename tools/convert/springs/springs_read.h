/* springs_read.h: springs as text, one chain or collider a line:
 *
 *   chain JOINT [to JOINT] [stiffness N] [drag N] [gravity N] [radius N] [end X Y Z] [hits JOINT ...]
 *   collider JOINT RADIUS [X Y Z [X Y Z]]
 *
 * JOINT is a name, or the beginning of one and '*'. Without `to` a chain is the joint and all below it. Lengths are
 * metres; X Y Z are in the joint's space, in the skeleton's unit. */
#ifndef NOH_CONVERT_SPRINGS_SPRINGS_READ_H
#define NOH_CONVERT_SPRINGS_SPRINGS_READ_H

#include <stddef.h>
#include <stdint.h>

#include "convert/base/error.h"

typedef struct springs_chain {
    char *joint, *to; /* to: NULL: all below */
    char *hits;       /* names, each with a 0 behind it, and one more; NULL: all colliders */
    float stiffness, drag, radius, gravity, end[3];
    int has_end;
    uint32_t line;
} springs_chain;

typedef struct springs_collider {
    char *joint;
    float radius, from[3], to[3];
    uint32_t line;
} springs_collider;

typedef struct springs_text {
    springs_chain *chains;
    springs_collider *colliders;
    uint32_t chain_count, collider_count;
} springs_text;

springs_text *springs_text_new(void); /* NULL: out of memory */
void springs_text_free(springs_text *text);

/* Add the lines of a text. 0, or 1 with *line and *error; what was read before stays. */
int springs_text_add(springs_text *springs, const char *text, size_t size, uint32_t *line, model_error *error);

/* Add the lines of a file, which must have a chain. 0, or 1 with *line and *error. */
int springs_text_read(springs_text *springs, const char *path, uint32_t *line, model_error *error);

#endif
