/* model_extra.h: the list of extra attributes that a build keeps, and how their numbers are stored. */
#ifndef NOH_CONVERT_MODEL_MODEL_EXTRA_H
#define NOH_CONVERT_MODEL_MODEL_EXTRA_H

#include "model.h"

/* Parse "NAME[:BITS],...": names are TEXCOORD_0 and up, or begin with _; BITS is 8 or 16. NULL: an empty list. */
int extras_parse(const char *text, extra_list *out, model_error *error);

/* Check that some mesh has each attribute of the model's list. */
int extras_check(const model *m, model_error *error);

/* How a mesh stores its extra attributes: components of 16 bits first, from the lowest bit of the first word. */
typedef struct extra_plan {
    noh_extra_row rows[NOH_EXTRAS_MAX];
    float errors[NOH_EXTRAS_MAX]; /* as noh_extra_name has them */
    uint32_t word_count;          /* 0: none; may be above NOH_EXTRA_WORDS_ROOM */
} extra_plan;

void extras_plan(const model *m, const model_mesh *mesh, extra_plan *out);

/* The words of a vertex. words[word_count] */
void extras_pack(const extra_plan *plan, const model_mesh *mesh, size_t vertex, uint32_t *words);

#endif
