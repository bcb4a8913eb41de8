/* skin_list.h: skinning on the CPU of vertices with any number of joints.
 *
 * Drawn meshes, and everything compared with them, use up to NOH_INFLUENCES_MAX joints per vertex: the strongest. If a
 * model has more and was built with `noh build --influences N`, N above that, its pack also lists all joints of those
 * vertices, up to NOH_SKIN_LIST_MAX each. Use the list for simulation, baking and pictures without a GPU: call
 * noh_skin_vertices first, then noh_skin_list_vertices, which overwrites the listed vertices. Dual quaternion meshes
 * have no list.
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

/* The list of one mesh and all its LOD levels; points into the pack. */
typedef struct noh_skin_list {
    const noh_influences_header *header;
    const uint32_t *vertices; /* [vertex_count] ascending */
    const uint32_t *firsts;   /* [vertex_count + 1] */
    const float *weights;     /* [influence_count] */
    const uint16_t *joints;   /* [influence_count] indices into the skin's joints */
} noh_skin_list;

/* Get the list of a mesh by index.
 * errors  NOT_FOUND no vertex of the mesh has more than NOH_INFLUENCES_MAX joints, or the pack was built without the
 *         list */
noh_result noh_pack_skin_list(const noh_pack *pack, uint32_t mesh, noh_skin_list *list, noh_error *error);

/* Get the number of listed vertices below `vertex`: its place in the list, if it is there. */
uint32_t noh_skin_list_place(const noh_skin_list *list, uint32_t vertex);

/* Overwrite the listed ones of vertices first..first+count-1, moved by all their joints; other vertices are not
 * changed. Arrays and ranges as for noh_skin_vertices.
 * returns  the number of vertices written */
uint32_t noh_skin_list_vertices(const noh_skin_list *list, const noh_mesh *mesh, const float *matrices,
                                const noh_morph_layers *layers, uint32_t first, uint32_t count, float *positions,
                                float *normals, float *tangents);

#ifdef __cplusplus
}
#endif

#endif
