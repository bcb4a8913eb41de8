/* mesh.h: a mesh of a pack, as pointers into the pack's bytes. */
#ifndef NOH_MESH_MESH_H
#define NOH_MESH_MESH_H

#include "pack/pack.h"

/* A view; valid as long as the pack's bytes are. Shapes are in format.h. */
typedef struct noh_mesh {
    const noh_pack *pack;
    const char *name;
    const noh_mesh_header *header;
    const float *positions;      /* [vertex_count][3], model units */
    const uint8_t *attributes;   /* [vertex_count][attribute_stride] */
    const void *indices;         /* uint16_t or uint32_t [index_count] */
    const noh_submesh *submeshes;
    const noh_target *targets;
    const float *weights;        /* [target_count], the asset's defaults */
    const noh_rect *rects;
    const uint32_t *texels;      /* [texel_count][3] */
} noh_mesh;

/* One vertex, decoded. */
typedef struct noh_vertex {
    float position[3];
    float normal[3];
    float tangent[4]; /* w: handedness; (0,0,0,0) without tangents */
    float uv[2];
    float color[4];   /* linear; white without colours */
} noh_vertex;

/* The n-th mesh. NOT_FOUND past mesh_count. */
noh_result noh_pack_mesh(const noh_pack *pack, uint32_t index, noh_mesh *mesh);

/* The target of that name; target_count when there is none. */
uint32_t noh_mesh_find_target(const noh_mesh *mesh, const char *name);

/* Decode a vertex of the rest pose: the arithmetic of shaders_es/common_attributes.glsl. */
void noh_mesh_vertex(const noh_mesh *mesh, uint32_t index, noh_vertex *out);

/* Byte offset of an attribute in its record, or -1 where the mesh has none. */
int noh_mesh_tangent_offset(const noh_mesh *mesh);
int noh_mesh_uv_offset(const noh_mesh *mesh);
int noh_mesh_color_offset(const noh_mesh *mesh);

/* The i-th index. */
uint32_t noh_mesh_index(const noh_mesh *mesh, uint32_t i);

#endif
