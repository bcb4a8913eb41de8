/* islands.h: which vertices of a mesh hang together. */
#ifndef NOH_CONVERT_MODEL_ISLANDS_H
#define NOH_CONVERT_MODEL_ISLANDS_H

#include "convert/model/model.h"

/* For each vertex the first one of its island: vertices that triangles join, or that share a position, whatever their
 * normals and UVs. island, work: [vertex_count] */
void islands_find(const model_mesh *mesh, uint32_t *island, uint32_t *work);

/* The root of a vertex in a union-find; what is passed on the way moves nearer to it. */
uint32_t islands_root(uint32_t *parent, uint32_t v);

#endif
