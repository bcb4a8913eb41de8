/* skins.h: binds meshes to skeletons, before they are encoded. */
#ifndef NOH_CONVERT_SKIN_SKINS_H
#define NOH_CONVERT_SKIN_SKINS_H

#include <stdio.h>

#include "convert/model/model.h"

struct model_clips; /* clips/model_clips.h */

typedef struct skin_options {
    uint32_t influences; /* the most per vertex, 1 to MODEL_INFLUENCES_MAX; 0: NOH_INFLUENCES_MAX. More than that are
                          listed for the CPU (deform.h) */
    uint32_t palette;    /* joints that one draw may use; 0: as many as the format holds */
    const char *const
        *dual_quaternion; /* [dual_quaternion_count] meshes to skin by dual quaternions: names, or "all" */
    uint32_t dual_quaternion_count;
    int keep_parts; /* do not join rigid meshes that joints move */
    int rigid_faces; /* 1: skins_of_faces */
    FILE *report;   /* NULL: quiet */
} skin_options;

/* Before skeletons are made: in a model without skins, nodes that draw meshes with targets become joints that move these
 * (for lod_joints.h). 0, or 1 when out of memory. */
int skins_of_faces(model *m);

/* Bind every skinned mesh of a model to its skin, and every skin to its skeleton. Rigid meshes that a joint moves
 * become skinned ones (skin_rigid.h); a mesh that is drawn with several skins, or both with and without one, is copied.
 * What joints mirror is wound for it (skin_mirror.h). Weights that are left out give a warning. 0, or 1 and a filled
 * error. */
int skins_bind(model *m, struct model_clips *made, const skin_options *options, model_error *error);

#endif
