/* hair_grow.h: control hairs, patches and spheres out of a haircut's text.
 *
 * Roots stand in rows from the crown to the hairline, the same number in each, so that four neighbours are a patch. A
 * hair grows along the comb's direction on the skull, higher above it the longer it is: what grows in front lies on
 * what grows behind. Where the skull falls away below, it hangs. Where the text has curves, hair takes their shapes
 * instead. */
#ifndef NOH_CONVERT_MODEL_HAIR_GROW_H
#define NOH_CONVERT_MODEL_HAIR_GROW_H

#include "convert/base/hair_read.h"
#include "noh/base.h"

typedef struct hair_grown {
    float *points; /* [hair_count][point_count][3] */
    uint32_t hair_count, point_count;
    uint32_t (*patches)[4];
    uint32_t patch_count;
    float spheres[NOH_HAIR_SPHERES_MAX][4];
    uint32_t sphere_count;
} hair_grown;

/* 1: out of memory. Free in both cases. */
int hair_grow(const hair_text *text, hair_grown *out);
void hair_grown_free(hair_grown *grown);

#endif
