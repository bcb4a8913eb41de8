/* light_surface.h: a mesh of a pack in a pose of its targets, among what may shade it. */
#ifndef NOH_CONVERT_LIGHT_LIGHT_SURFACE_H
#define NOH_CONVERT_LIGHT_LIGHT_SURFACE_H

#include "convert/base/error.h"
#include "noh/pack.h"
#include "ray_tree.h"

/* In the model space of the mesh. Occluders are the triangles of the full mesh, and of the other meshes that the pack's
 * nodes draw, in the bind pose; blended materials do not occlude. */
typedef struct light_surface {
    noh_mesh mesh;
    float *position, *normal; /* [vertex_count][3] in the pose; normals are unit */
    float *triangles;         /* [own_count + other_count][9], the mesh's own first */
    uint32_t *corners;        /* [own_count][3] their vertices */
    uint32_t own_count, other_count;
    /* [vertex_count] Coarse LOD levels may have vertices that no triangle of the full mesh uses, and that lie off its
     * surface, also inside: these take the light of the nearest used vertex. A used vertex maps to itself. */
    uint32_t *stand_in;
    /* A triangle that is nearer to a vertex than this shades nothing: a twelfth of the mean edge, half a millimetre on
     * a head of 5,000 vertices. Folds that lie on each other, or pass through each other by so little, are no shadow.
     */
    float least;
    ray_tree tree;
    float *layer_memory;
} light_surface;

/* The n-th mesh in the bind pose. 0, or 1 and a filled error; close in both cases. */
int light_surface_open(const noh_pack *pack, uint32_t mesh, light_surface *out, model_error *error);
/* Another pose: weights[target_count]. */
int light_surface_pose(light_surface *s, const float *weights, model_error *error);
void light_surface_close(light_surface *s);

/* light_surface.least for triangles [count][3] of vertices. */
float light_least(const float *positions, const uint32_t *corners, uint32_t count);

#endif
