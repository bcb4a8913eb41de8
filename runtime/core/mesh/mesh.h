/* mesh.h: meshes and skins of a pack, as pointers into the pack's bytes, and decoded vertices.
 *
 * Threads: views are read-only; any number of threads. */
#ifndef NOH_MESH_MESH_H
#define NOH_MESH_MESH_H

#include "core/pack/pack.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A mesh at one LOD level. A view: valid as long as the pack and its bytes are. Shapes are in format.h. */
typedef struct noh_mesh {
    const noh_pack *pack;
    const char *name;
    const noh_mesh_header *header;
    const float *positions;    /* [vertex_count][3], model units */
    const uint8_t *attributes; /* [vertex_count][attribute_stride] */
    const void *indices;       /* uint16_t or uint32_t [index_count] */
    const noh_submesh *submeshes;
    const noh_target *targets;
    const float *weights; /* [target_count], default weights */
    const noh_rect *rects;
    const uint32_t *texels;     /* [texel_count][3] */
    const float *target_boxes;  /* [target_count][6] */
    const uint32_t *influences; /* [vertex_count][NOH_INFLUENCE_WORDS(influence_count)] */
    const noh_palette *palettes;
    const uint16_t *palette_joints;
    const float *joint_boxes;            /* [joint_count of the skin][6] */
    const noh_transfer_header *transfer; /* followed by its arrays; NULL: none (transfer.h) */
} noh_mesh;

/* The joints that move a mesh. A view: valid as long as the pack and its bytes are. */
typedef struct noh_skin {
    const char *name;
    const noh_skin_header *header;
    const uint16_t *joints;    /* [joint_count], joints of skeleton header->skeleton */
    const float *inverse_bind; /* [joint_count][12] */
} noh_skin;

/* One vertex, decoded. */
typedef struct noh_vertex {
    float position[3];
    float normal[3];
    float tangent[4]; /* w: handedness; (0,0,0,0) without tangents */
    float uv[2];
    float color[4]; /* linear; white without colours */
} noh_vertex;

/* Get the n-th mesh at the finest level of the pack: 0, unless levels were stripped (`noh strip`).
 * errors  NOT_FOUND past mesh_count (where: the index, need: the count); *mesh is untouched */
noh_result noh_pack_mesh_at(const noh_pack *pack, uint32_t index, noh_mesh *mesh, noh_error *error);

/* The mesh at a LOD level; 0 is the full mesh. Past the last level it returns the coarsest, for a level that the pack
 * lacks the finest there is. Levels are absolute, whichever level `mesh` is at. Objects made from the result
 * (accumulators, skinned vertices, GL buffers) have this level's size and can also show every coarser level. */
noh_mesh noh_mesh_at_lod(const noh_mesh *mesh, uint32_t level);

/* An id of the full mesh: the CRC-32C of its chunk with all levels. It is equal in a pack and in packs stripped from
 * it, to match coarse levels with finer ones. */
uint32_t noh_mesh_source(const noh_mesh *mesh);

/* Get the n-th skin; header->skin of a mesh is the index of its skin.
 * errors  NOT_FOUND past skin_count, and so also NOH_NONE, which rigid meshes have (where: the index, need: the
 *         count) */
noh_result noh_pack_skin_at(const noh_pack *pack, uint32_t index, noh_skin *skin, noh_error *error);

/* Find a target by name; returns its index in weights[], or NOH_NONE. */
uint32_t noh_mesh_find_target(const noh_mesh *mesh, const char *name);

/* Decode a vertex of the bind pose, with the same arithmetic as shaders_es/common_attributes.glsl.
 * ranges  index below vertex_count */
void noh_mesh_vertex(const noh_mesh *mesh, uint32_t index, noh_vertex *out);

/* Decode a vertex's normal and tangent without normalising; their lengths are 0.57 to 1. Without tangents the tangent
 * is 0. */
void noh_mesh_directions(const noh_mesh *mesh, uint32_t index, float normal[3], float tangent[3]);

/* Byte offset of an attribute in a vertex's record; -1: the mesh has none. */
int noh_mesh_tangent_offset(const noh_mesh *mesh);
int noh_mesh_uv_offset(const noh_mesh *mesh);
int noh_mesh_color_offset(const noh_mesh *mesh);
int noh_mesh_uv_texel_offset(const noh_mesh *mesh);

/* A vertex's accumulation texel (header->touched_count or more: none, no target moves the vertex), and its palette (0
 * unless the mesh is split into several). */
uint32_t noh_mesh_accumulation_texel(const noh_mesh *mesh, uint32_t vertex);
uint32_t noh_mesh_palette(const noh_mesh *mesh, uint32_t vertex);

/* The accumulation texel of a vertex's texture coordinates; header->touched_count or more: none, no target moves
 * them. */
uint32_t noh_mesh_uv_texel(const noh_mesh *mesh, uint32_t vertex);

/* Get the joints and weights of a vertex of a skinned mesh.
 * shapes   joints[influence_count] indices into the skin's joints, weights[influence_count]
 * ranges  the weights sum to exactly 1 in float32; the first is the largest, except for rounding
 * returns  influence_count */
uint32_t noh_mesh_influences(const noh_mesh *mesh, uint32_t vertex, uint32_t joints[NOH_INFLUENCES_MAX],
                             float weights[NOH_INFLUENCES_MAX]);

/* The i-th index of the triangles.
 * ranges  i below index_count */
uint32_t noh_mesh_index(const noh_mesh *mesh, uint32_t i);

#ifdef __cplusplus
}
#endif

#endif
