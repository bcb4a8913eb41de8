/* islands.h: which vertices of a mesh are connected. */
#ifndef NOH_CONVERT_MODEL_ISLANDS_H
#define NOH_CONVERT_MODEL_ISLANDS_H

#include "convert/model/model.h"

/* For each vertex the first one of its island: vertices that triangles join, or that share a position, whatever their
 * normals and UVs. island, work: [vertex_count] */
void islands_find(const model_mesh *mesh, uint32_t *island, uint32_t *work);

/* For each vertex the next one of its island, MODEL_NONE after the last. next: [count] */
void islands_chain(const uint32_t *island, uint32_t count, uint32_t *next);

/* Write the vertices of a chain from `first` on that are before `end`, in order. Returns their count. */
uint32_t islands_list(const uint32_t *next, uint32_t first, uint32_t end, uint32_t *out);

/* All of it for a mesh. */
typedef struct mesh_islands {
    uint32_t *first; /* [vertex_count] of islands_find */
    uint32_t *next;  /* [vertex_count] of islands_chain */
    uint32_t *room;  /* [vertex_count] for one list */
} mesh_islands;

/* Returns 1: out of memory. islands_close, also then. */
int islands_open(const model_mesh *mesh, mesh_islands *out);
void islands_close(mesh_islands *islands);

/* Which vertices the triangles of a part use, [vertex_count], to be freed; NULL: out of memory. Its range may have
 * vertices of other parts, and lacks copies of split vertices. */
uint8_t *islands_part(const model_mesh *mesh, const model_submesh *part);

/* The root of a vertex in a union-find; what is passed on the way moves nearer to it. */
uint32_t islands_root(uint32_t *parent, uint32_t v);
void islands_join(uint32_t *parent, uint32_t a, uint32_t b); /* the smaller root stays */

#endif
