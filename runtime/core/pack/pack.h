/* pack.h: open a .noh pack in place: in a mapped file, in flash, in an array.
 *
 * noh_pack_open checks every byte once; later calls check nothing again and copy nothing. The bytes must stay readable
 * and unchanged as long as the pack, or anything made from it, is used.
 *
 * Threads: an open pack is read-only; any number of threads. */
#ifndef NOH_PACK_PACK_H
#define NOH_PACK_PACK_H

#include "core/pack/format.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct noh_pack {
    const uint8_t *bytes;
    uint32_t byte_count;
    uint32_t library_version; /* version of noh that wrote it (version.h); 0: before 0.2.0 */
    uint32_t chunk_count;
    const noh_pack_chunk *chunks;
    const char *strings;
    uint32_t string_bytes;
    uint32_t texture_count, first_texture; /* chunk index of the first texture */
    uint32_t mesh_count, first_mesh;
    uint32_t skeleton_count, first_skeleton;
    uint32_t skin_count, first_skin;
    uint32_t clip_count, first_clip;
    uint32_t graph_count, first_graph;
    uint32_t transfer_count, first_transfer;
    uint32_t influences_count, first_influences;
    uint32_t wrinkles_count, first_wrinkles;
    uint32_t springs_count, first_springs;
    uint32_t material_count;
    const noh_material *materials;
    uint32_t node_count;
    const noh_node *nodes;
    const float *node_weights;
    uint32_t node_weight_count;
    uint32_t recipe_row_count; /* of the face recipe; 0: none */
    const noh_recipe_row *recipe_rows;
    uint32_t ragdoll_row_count; /* of the ragdoll table; 0: none */
    const noh_pack_ragdoll_row *ragdoll_rows;
    const noh_pack_hair_header *hair;       /* NULL: none */
    const noh_pack_terrain_header *terrain; /* NULL: none */
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
    const uint8_t *pixels; /* [bytes]: [height][width][4] or blocks, by header->format (etc2.h decodes blocks) */
} noh_texture_level;

/* Check a whole pack and open it.
 * memory  none; bytes must be aligned to NOH_MEMORY_ALIGN (arena.h)
 * errors  ARG bytes or pack is NULL, or bytes is misaligned; VERSION another format version (need: the version of this
 *         library); DATA the pack is damaged (where: the byte offset of the field at fault); LIMIT a limit of limits.h
 *         is exceeded. *pack is then untouched */
noh_result noh_pack_open(const void *bytes, size_t byte_count, noh_pack *pack, noh_error *error);

/* The string at a stored offset; "" past the strings. */
const char *noh_pack_string(const noh_pack *pack, uint32_t offset);

/* The name of the n-th chunk; "" past chunk_count. */
const char *noh_pack_chunk_name(const noh_pack *pack, uint32_t chunk);

/* Get the n-th texture.
 * errors  NOT_FOUND past texture_count (where: the index, need: the count); *texture is untouched */
noh_result noh_pack_texture_at(const noh_pack *pack, uint32_t index, noh_texture *texture, noh_error *error);

/* The bytes of a block of 4 x 4 texels; 0: the format has no blocks. */
uint32_t noh_texture_block_bytes(uint32_t format);

/* The bytes of a mip level; format is NOH_TEXTURE_RGBA8 or another of format.h. */
uint32_t noh_texture_bytes(uint32_t format, uint32_t width, uint32_t height);

/* A mip level of a texture.
 * ranges  level below texture->header->level_count */
noh_texture_level noh_texture_level_at(const noh_texture *texture, uint32_t level);

/* Check the chunk of the n-th graph: counts, arrays, names, nodes. noh_pack_open checks only its checksum;
 * noh_pack_graph_at (graph_pack.h) calls this function.
 * ranges  index below graph_count
 * errors  DATA the chunk is damaged (where: the byte in the pack) */
noh_result noh_pack_check_graph(const noh_pack *pack, uint32_t index, noh_error *error);

#ifdef __cplusplus
}
#endif

#endif
