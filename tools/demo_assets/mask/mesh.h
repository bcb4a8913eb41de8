/* A part in one pose: places, normals and tangents of its vertices. */
#ifndef MASK_MESH_H
#define MASK_MESH_H

#include "model.h"

typedef struct {
    int count;
    V3 *position, *normal, *tangent;
    double *handedness; /* +1 or -1 */
} Frame;

/* Which vertices share a place, at rest and with the jaw open, and so a normal: `first[i]` is the lowest vertex at the
 * place of vertex i. Lips that meet at rest keep their own normals. */
int *mesh_weld(const Part *part);

Frame mesh_frame(const Part *part, const int *first, const Pose *pose);
void mesh_free(Frame *frame);

#endif
