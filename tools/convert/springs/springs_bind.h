/* springs_bind.h: springs of a model by the numbers of its joints, as packs have them. */
#ifndef NOH_CONVERT_SPRINGS_SPRINGS_BIND_H
#define NOH_CONVERT_SPRINGS_SPRINGS_BIND_H

#include "convert/clips/raw_set.h"
#include "convert/springs/springs_read.h"
#include "noh/format.h"

/* Of one skeleton. */
typedef struct set_springs {
    noh_spring_row *rows;
    noh_spring_chain *chains;
    noh_spring_capsule *colliders;
    uint32_t row_count, chain_count, collider_count;
} set_springs;

/* Bind a text: each chain and collider in each skeleton that has its joints. *line and *error where none has, or where
 * a joint would swing twice. With `model_lines` a line that cannot be bound is a warning of the model instead.
 * shapes  out[set_count], zeros before; free in any case. To be called when joints are in their last order */
int springs_bind_text(const springs_text *text, model *m, raw_set *const *sets, uint32_t set_count, int model_lines,
                      set_springs *out, uint32_t *line, model_error *error);

/* Bind the model's extension. 0, or 1 when out of memory. */
int springs_bind_nodes(model *m, raw_set *const *sets, uint32_t set_count, set_springs *out);

/* Sort chains so that each follows the chain it is attached to. 0, or 1 when out of memory. */
int springs_sort(set_springs *springs, uint32_t set_count);

void springs_free(set_springs *springs, uint32_t set_count);

#endif
