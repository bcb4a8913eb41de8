/* seam.h: seams between skinned meshes, such as a head on a body.
 *
 * Such a seam shows nothing in any pose if the vertices on both sides have the same places, normals and weights, and no
 * target moves one side alone. An artist with a file for each part gets that only by luck.
 *
 * A seam is found by its shape, not by names: an open border of each mesh; each border lies along the
 * whole of the other within a tenth of its size at rest, and the surfaces continue in opposite directions, which a neck
 * in a collar does not. Of several the nearest is taken. A neck that ends inside of the head has no such border, and
 * needs none.
 * LOD levels coarsen each mesh for itself: there a closed seam opens by the error of the level.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 16, which gives a head the body's bones and
 * leaves the seam to the modeller */
#ifndef NOH_CONVERT_SKIN_SEAM_H
#define NOH_CONVERT_SKIN_SEAM_H

#include <stdio.h>

#include "convert/model/model.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum seam_mode { SEAM_CHECK, SEAM_MEND, SEAM_OFF } seam_mode;

/* Of one seam: the worst of its pairs of vertices. Lengths in the world, at rest. */
typedef struct seam_findings {
    uint32_t mesh_a, mesh_b; /* a < b */
    uint32_t pair_count;     /* vertices of both that are nearest to each other */
    uint32_t lone_count;     /* vertices without such a partner: they lie on an edge of the other border at best */
    double size;             /* diagonal of the border's box */
    double gap, where[3];    /* how far apart, and where; of lone ones from the other border */
    double normal_degrees;   /* where the surface is bent by less than 60 */
    double weight;           /* of one joint, on both sides */
    uint32_t weight_node;    /* that joint */
    double delta;            /* how far a target moves one side from the other, at weight 1 */
    const char *target;      /* its name; NULL: none does. Of the model */
    double bind_gap;         /* how far apart one of their joints would take them alone: bound in different poses */
    uint32_t bind_node;
} seam_findings;

/* Measure all seams: *out [*count], to be freed; NULL and 0: none. Returns 1 when out of memory. */
int seams_measure(const model *m, seam_findings **out, uint32_t *count);

/* Whether nobody will see it: places to a 1e-5 of its size, normals to 1 degree, weights to 1/255. */
int seam_is_closed(const seam_findings *seam);

/* Before skins_bind. SEAM_CHECK: an open seam becomes a warning. SEAM_MEND: both sides are given the mean of their
 * places, normals (but at creases) and weights; targets that both meshes have move them alike, and others leave the
 * border where it is. Vertices without a partner go onto the nearest edge of the other border. What is still open
 * becomes a warning. report  NULL: quiet. Returns 1 when out of memory. */
int seams_close(model *m, seam_mode mode, FILE *report, model_error *error);

#ifdef __cplusplus
}
#endif
#endif
