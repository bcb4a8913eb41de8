/* mesh_join.h: joins several meshes to one, each with its own transform and all following joints of one skin. */
#ifndef NOH_CONVERT_SKIN_MESH_JOIN_H
#define NOH_CONVERT_SKIN_MESH_JOIN_H

#include "convert/model/model.h"

typedef struct mesh_part {
    const model_mesh *mesh;
    double place[16];       /* from its space to the joined mesh's; a mirroring one reverses the winding of its
                               triangles */
    const uint32_t *places; /* [joints of its own skin] places in the joined mesh's skin; NULL: it is rigid */
    uint32_t place_rigid;   /* the joint that a rigid part follows */
} mesh_part;

/* Join them, in order. Triangles of one material become one submesh, drawn at once. Parts with targets must have the
 * same ones by name and order. Attributes that a part lacks get neutral values. *out is to be added to a model; the
 * caller sets its name and skin. Returns 1 when out of memory. */
int mesh_join(const mesh_part *parts, uint32_t part_count, model_mesh *out);

/* A deep copy of a mesh. Returns 1 when out of memory. */
int mesh_copy(const model_mesh *mesh, model_mesh *out);

#endif
