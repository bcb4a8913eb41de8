/* skin_list.h: vertices that many joints move, on the CPU.
 *
 * What draws a mesh, and what is compared with that, has up to NOH_INFLUENCES_MAX joints a vertex: the strongest. Where
 * a model has more and was built with `noh build --influences N`, N over that, its pack also lists all joints of those
 * vertices, each with a count of its own, up to NOH_SKIN_LIST_MAX. Simulation, baking and pictures made without a GPU
 * move them by the list: noh_skin_vertices first, then noh_skin_list_vertices, which does those of the list again.
 * Meshes by dual quaternions have none.
 *
 * source  Granberg, Character Animation with Direct3D, 2009, chapter 3: a mesh may have any number of influences when
 *         the CPU skins it
 *
 * Threads: no state; any thread. */
#ifndef NOH_DEFORM_SKIN_LIST_H
#define NOH_DEFORM_SKIN_LIST_H

#include "deform/morph/morph.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of one mesh and all of its levels; it points into the pack. */
typedef struct noh_skin_list {
    const noh_influences_header *header;
    const uint32_t *vertices; /* [vertex_count] ascending */
    const uint32_t *firsts;   /* [vertex_count + 1] */
    const float *weights;     /* [influence_count] */
    const uint16_t *joints;   /* [influence_count] indices into the skin's joints */
} noh_skin_list;

/* The list of the n-th mesh.
 * errors  NOT_FOUND  no vertex of it has so many joints, or the pack was built without them */
noh_result noh_pack_skin_list(const noh_pack *pack, uint32_t mesh, noh_skin_list *list, noh_error *error);

/* How many vertices of the list are below `vertex`: where one is, if it is there. */
uint32_t noh_skin_list_place(const noh_skin_list *list, uint32_t vertex);

/* Write those of vertices first..first+count-1 that are in the list again, moved by all of their joints; the others'
 * places are not touched. Arrays and ranges as noh_skin_vertices has them.
 * returns  how many were written */
uint32_t noh_skin_list_vertices(const noh_skin_list *list, const noh_mesh *mesh, const float *matrices,
                                const noh_morph_layers *layers, uint32_t first, uint32_t count, float *positions,
                                float *normals, float *tangents);

#ifdef __cplusplus
}
#endif

#endif
