/* pack.h: open a pack (a .noh file made by `noh build`) and read its meshes, skins and textures. Skeletons and clips:
 * clip.h. The bytes themselves: format.h. */

#ifndef NOH_PACK_H
#define NOH_PACK_H

#include <stdint.h>

#include "base.h"
#include "format.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ======== packs ========
 * Open a .noh pack in place: in a mapped file, in flash, in an array.
 *
 * noh_pack_open checks every byte once; later calls check nothing again and copy nothing. The bytes must stay readable
 * and unchanged as long as the pack, or anything made from it, is used.
 *
 * Threads: an open pack is read-only; any number of threads. */

/* The chunks of a type, which are neighbours. */
typedef struct noh_chunk_run {
    uint32_t count, first; /* first: chunk index */
} noh_chunk_run;

typedef struct noh_pack {
    const uint8_t *bytes;
    uint32_t byte_count;
    uint32_t library_version; /* version of noh that wrote it (base.h); 0: before 0.2.0 */
    uint32_t chunk_count;
    const noh_pack_chunk *chunks;
    noh_chunk_run runs[NOH_CHUNK_TYPES]; /* by noh_chunk_type */
    /* arrays of chunks that are there once, for those who index them often */
    const char *strings;
    uint32_t string_bytes;
    uint32_t material_count;
    const noh_material *materials;
    const noh_node *nodes;
    const float *node_weights;
    uint32_t node_count;
    uint32_t recipe_row_count; /* of the face recipe; 0: none */
    const noh_recipe_row *recipe_rows;
    uint32_t ragdoll_row_count; /* of the ragdoll table; 0: none */
    const noh_pack_ragdoll_row *ragdoll_rows;
} noh_pack;

typedef struct noh_texture {
    const char *name;
    const noh_texture_header *header;
    const uint8_t *pixels; /* all mip levels, one after another, in header->format */
} noh_texture;

/* A mip level of a texture. */
typedef struct noh_texture_level {
    uint32_t width, height;
    uint32_t bytes;
    const uint8_t *pixels; /* [bytes]: [height][width][4] or blocks, by header->format (low_core.h decodes blocks) */
} noh_texture_level;

/* Check a whole pack and open it.
 * memory  none; bytes must be aligned to NOH_MEMORY_ALIGN (low_core.h)
 * errors  ARG bytes or pack is NULL, or bytes is misaligned; VERSION another format version (need: the version of this
 *         library); DATA the pack is damaged (where: the byte offset of the field at fault); LIMIT a limit of base.h
 *         is exceeded. *pack is then untouched */
noh_result noh_pack_open(const void *bytes, size_t byte_count, noh_pack *pack, noh_error *error);

/* The string at a stored offset; "" past the strings. */
const char *noh_pack_string(const noh_pack *pack, uint32_t offset);

/* The bytes of the n-th chunk of a type, which begin with its header; NULL past the last. */
const void *noh_pack_chunk_at(const noh_pack *pack, noh_chunk_type type, uint32_t index);

/* The name of the n-th chunk; "" past chunk_count. */
const char *noh_pack_chunk_name(const noh_pack *pack, uint32_t chunk);

/* Get the n-th texture.
 * errors  NOT_FOUND past the last texture (where: the index, need: the count); *texture is untouched */
noh_result noh_pack_texture_at(const noh_pack *pack, uint32_t index, noh_texture *texture, noh_error *error);

/* A mip level of a texture.
 * ranges  level below texture->header->level_count */
noh_texture_level noh_texture_level_at(const noh_texture *texture, uint32_t level);

/* ======== meshes ======== */

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
    const float *joint_boxes;                /* [joint_count of the skin][6] */
    const noh_transfer_header *transfer;     /* followed by its arrays; NULL: none (light.h) */
    const noh_far_joints_header *far_joints; /* likewise (deform.h) */
    const noh_extras_header *extras;         /* likewise (noh_mesh_extra) */
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
 * errors  NOT_FOUND past the last mesh (where: the index, need: the count); *mesh is untouched */
noh_result noh_pack_mesh_at(const noh_pack *pack, uint32_t index, noh_mesh *mesh, noh_error *error);

/* The mesh at a LOD level; 0 is the full mesh. Past the last level it returns the coarsest, for a level that the pack
 * lacks the finest there is. Levels are absolute, whichever level `mesh` is at. Objects made from the result
 * (accumulators, skinned vertices, GL buffers) have this level's size and can also show every coarser level. */
noh_mesh noh_mesh_at_lod(const noh_mesh *mesh, uint32_t level);

/* An id of the full mesh: the CRC-32C of its chunk with all levels. It is equal in a pack and in packs stripped from
 * it, to match coarse levels with finer ones. */
uint32_t noh_mesh_source(const noh_mesh *mesh);

/* Get the n-th skin; header->skin of a mesh is the index of its skin.
 * errors  NOT_FOUND past the last skin, and so also NOH_NONE, which rigid meshes have (where: the index, need: the
 *         count) */
noh_result noh_pack_skin_at(const noh_pack *pack, uint32_t index, noh_skin *skin, noh_error *error);

/* Find a target by name; returns its index in weights[], or NOH_NONE. */
uint32_t noh_mesh_find_target(const noh_mesh *mesh, const char *name);

/* Decode a vertex of the bind pose, with the same arithmetic as shaders_es/common_attributes.glsl.
 * ranges  index below vertex_count */
void noh_mesh_vertex(const noh_mesh *mesh, uint32_t index, noh_vertex *out);

/* The i-th index of the triangles.
 * ranges  i below index_count */
uint32_t noh_mesh_index(const noh_mesh *mesh, uint32_t i);

/* ======== wrinkles ========
 * Weights of the regions of a face, from its morph weights: twelve that wrinkle, four that change colour (a blush).
 *
 *   noh_wrinkles_of       the matrix of a mesh
 *   noh_wrinkles_weights  region weights from morph weights
 *
 * source   "character wrinkle" (region weights from expressions, for which it gives no formula)
 * Threads: constant data; any thread. */

/* A view: valid as long as the pack and its bytes are. */
typedef struct noh_wrinkles {
    uint32_t target_count;
    const uint8_t *matrix; /* [target_count][NOH_WRINKLE_FOLDS], 255: all at weight 1 */
    const uint8_t *colors; /* as at noh_wrinkles_header.colors_offset; NULL: no colours */
    uint32_t color_material, color_texture;
} noh_wrinkles;

/* Get the wrinkles of a mesh; the same at every LOD level.
 * errors  NOT_FOUND the mesh has no wrinkles or colours: its pack was built without --wrinkles, --region-mask and
 *         --color-map; *wrinkles is untouched */
noh_result noh_wrinkles_of(const noh_mesh *mesh, noh_wrinkles *wrinkles, noh_error *error);

/* Compute region weights from morph weights: the sum of weight times matrix, clamped to 0..1. Channel c of the
 * material's weight map k is region 3 * c + k, channel c of the colour map region NOH_WRINKLE_FOLDS + c.
 * shapes  weights[target_count]; regions[NOH_WRINKLE_REGIONS]
 * ranges  weights finite; those below 0 count as 0 */
void noh_wrinkles_weights(const noh_wrinkles *wrinkles, const float *weights, float *regions);

/* ======== packs as they are sent ========
 * Packs compressed for transfer, a few times smaller, and unpacked as they arrive.
 *
 * `noh pack` makes the wire form (.nohz) of a pack. A noh_wire takes the file in pieces of any size and builds the pack
 * in the caller's block. A pack with LOD levels arrives as two: first a pack of the coarsest levels, with all clips,
 * materials and textures, then the whole pack, for which only meshes are sent again. noh_pack_open checks each before
 * noh_wire_pack returns it. A stage can start with the coarse pack and load the whole one as `finer` (noh.h).
 *
 * Memory: the state has the same size for every file, at most NOH_WIRE_STATE_BYTES. The block holds the whole pack at
 * its start, then the coarse pack, then working space for meshes. After the whole file only the first
 * noh_wire_info.pack_bytes are needed, if the coarse pack is no longer used.
 *
 * The same file gives the same bytes on every machine.
 *
 * Threads: a noh_wire belongs to one thread at a time. The packs that it returned are read-only. */

#define NOH_WIRE_VERSION 2u         /* version written; versions 1 and later can be read */
#define NOH_WIRE_HEAD_BYTES 64u     /* of a file, for noh_wire_info_read */
#define NOH_WIRE_STATE_BYTES 49152u /* largest noh_wire */

typedef struct noh_wire noh_wire;

/* The head of a wire file. */
typedef struct noh_wire_info {
    uint32_t file_bytes;
    uint32_t block_bytes;  /* block for unpacking */
    uint32_t pack_bytes;   /* of the whole pack, at the block's start */
    uint32_t coarse_bytes; /* of the coarse pack; 0: there is none */
} noh_wire_info;

/* Read the first NOH_WIRE_HEAD_BYTES of a file.
 * errors  DATA not a wire file, or damaged; VERSION another version (need: the version of this library) */
noh_result noh_wire_info_read(const void *bytes, size_t byte_count, noh_wire_info *info, noh_error *error);

typedef struct noh_wire_desc {
    void *block;        /* aligned to NOH_MEMORY_ALIGN; owned by the caller; holds the packs */
    size_t block_bytes; /* at least noh_wire_info.block_bytes */
} noh_wire_desc;

/* Bytes of a noh_wire, at most NOH_WIRE_STATE_BYTES. */
size_t noh_wire_size(void);

/* Build a noh_wire in memory[bytes].
 * errors  ARG memory, desc or block is NULL or misaligned; MEMORY memory is too small (need: the bytes) */
noh_result noh_wire_init(void *memory, size_t bytes, const noh_wire_desc *desc, noh_wire **wire, noh_error *error);

/* Take the next bytes of the file, any number. After an error every further push fails; packs returned before stay
 * valid.
 * errors  DATA the bytes are damaged, or continue past the file's end (where: the byte in the file, or as in
 *         noh_pack_open); VERSION; MEMORY the block is too small (need: the bytes); ARG bytes is NULL */
noh_result noh_wire_push(noh_wire *wire, const void *bytes, size_t byte_count, noh_error *error);

/* Get the best pack available: the coarse one, later the whole one.
 * errors  NOT_FOUND no pack is complete yet */
noh_result noh_wire_pack(const noh_wire *wire, noh_pack *pack, noh_error *error);

/* Whether the whole pack is complete and the file has ended; never 1 for a truncated file. */
int noh_wire_is_complete(const noh_wire *wire);

#ifdef __cplusplus
}
#endif

#endif
