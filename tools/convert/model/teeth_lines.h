/* teeth_lines.h: lines between teeth that are modelled as one band. */
#ifndef NOH_CONVERT_MODEL_TEETH_LINES_H
#define NOH_CONVERT_MODEL_TEETH_LINES_H

#include "convert/model/model.h"

#define TEETH_CROWN 0.16f /* the height of a crown, in widths of the jaw */

/* 0 to 1 between two values, which may fall. */
float teeth_smooth(float from, float to, float x);

/* Two jaws of one part of a mesh, whose vertices no other part uses. */
typedef struct teeth_rows {
    model_mesh *mesh;
    const model_submesh *part;
    const uint8_t *used;    /* [vertex_count] of islands_part */
    const uint32_t *island; /* [vertex_count] of islands_find */
    const float *middle;    /* [vertex_count] the height of each island's middle, at its first vertex */
    float split;            /* islands with a middle below it are of the lower jaw */
    float width, edge[2];   /* of the jaws; the heights where the lower and the upper teeth bite */
} teeth_rows;

/* A jaw of one band looks like a mouthguard. Where each jaw is one island of too few vertices to divide teeth, and the
 * model has skin with a normal map, so it is meant to look real, the part gets texture coordinates along the arch and a
 * texture with lines between neighbours, as far apart as people's teeth are wide for a jaw of that width. What may have a
 * look of its own stays: bands below plain skin, a material that other parts use or that has maps, and texture
 * coordinates that targets move. Adds a warning. Returns 1: out of memory. */
int teeth_lines_paint(model *m, const teeth_rows *rows);

#endif
