/* bounds_internal.h: the private part of deform.h. */
#ifndef NOH_DEFORM_BOUNDS_INTERNAL_H
#define NOH_DEFORM_BOUNDS_INTERNAL_H

#include "noh/deform.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Make an empty box (minimum above maximum); unite two boxes (out may be a or b); test whether a box is empty. */
void noh_box_empty(float box[6]);
void noh_box_unite(const float a[6], const float b[6], float out[6]);
static inline int noh_box_is_empty(const float box[6])
{
    return box[0] > box[3];
}

#ifdef __cplusplus
}
#endif

#endif
