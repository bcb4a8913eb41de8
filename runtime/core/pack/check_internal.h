/* check_internal.h (private to pack/): the checkers of the chunks, one per type.
 *
 * Each sees only the bytes of its own chunk and the pack as far as it has been opened: chunks come in an order in which
 * none refers to a later one. Files call each other in one direction: check_mesh.c calls check_level.c and
 * check_skin.c, and all three call check_mesh_part.c and check.c. */
#ifndef NOH_PACK_CHECK_INTERNAL_H
#define NOH_PACK_CHECK_INTERNAL_H

#include "core/base/compiler_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"

typedef struct noh_check {
    const noh_pack *pack; /* what the chunks before this one hold */
    const uint8_t *bytes; /* of this chunk */
    uint32_t count;
    uint32_t file_offset;
    uint32_t cursor; /* where the next array has to begin */
    noh_error *error;
    noh_pack *opens; /* the same pack, for the arrays of this chunk */
} noh_check;

/* Fail at a byte of the chunk. */
noh_result noh_check_fail(const noh_check *check, const char *what, uint64_t offset);

/* A field of a record, and whether it is wrong. */
typedef struct noh_check_field {
    uint32_t at; /* byte in the record */
    int wrong;
} noh_check_field;

/* Fail at the first field that is wrong, of the record at a byte of the chunk. */
NOH_COLD noh_result noh_check_fields(const noh_check *check, const noh_check_field *fields, size_t count,
                                     const char *what, uint64_t record);

/* Fail if one of `count` words at a byte of the chunk is not zero. */
NOH_COLD noh_result noh_check_reserved(const noh_check *check, uint64_t at, uint32_t count);

/* The fixed head of a chunk. */
noh_result noh_check_head(noh_check *check, uint32_t bytes);

/* The next array, whose offset is the word at byte `field` of the chunk, has to begin at the next multiple of 16 and to
 * fit; the padding before it has to be zero. */
NOH_COLD noh_result noh_check_array(noh_check *check, size_t field, uint64_t count, uint32_t stride);

/* The chunk has to end where its last array did. */
noh_result noh_check_end(const noh_check *check);

/* The header of the chunk that this one is about, the n-th of the type `about`, n being the first word of this chunk.
 * NULL: there is none, or n is not above the n of the previous chunk of this type. */
const void *noh_check_subject(const noh_check *check, noh_chunk_type type, noh_chunk_type about);

noh_result noh_check_floats(const noh_check *check, const float *values, uint32_t count, const char *what);
/* `offset`: of the name's field. The field of its hash follows. */
NOH_COLD noh_result noh_check_name(const noh_check *check, uint32_t name, uint32_t hash, uint64_t offset);

/* noh_check_strings and so on: each chunk of its type, in check_strings.c and so on. It may rely on the chunks before
 * it, and sets what `opens` keeps of its own. Every program that opens a pack links all of them, and they are half of
 * the smallest one; compiled for size they open a pack in the same time. */
#define NOH_CHECKER(NAME, name, tag, many) NOH_COLD noh_result noh_check_##name(noh_check *check);
NOH_CHUNKS(NOH_CHECKER)
#undef NOH_CHECKER

/* check_materials.c: how many maps a pixel reads besides the base colour. */
NOH_COLD uint32_t noh_material_maps(const noh_material *m);

/* check_mesh_part.c: what every level of a mesh has; `h` is that level's header. */
NOH_COLD noh_result noh_check_texture_shape(const noh_check *check, const noh_mesh_header *h);
noh_result noh_check_indices(const noh_check *check, const noh_mesh_header *h);
noh_result noh_check_submeshes(const noh_check *check, const noh_mesh_header *h);
noh_result noh_check_draws(const noh_check *check, const noh_mesh_header *h);
noh_result noh_check_rects(const noh_check *check, const noh_mesh_header *h, const noh_target *t);
/* The sums over a level's targets are the counts in its header. */
noh_result noh_check_target_sums(const noh_check *check, const noh_mesh_header *h, uint64_t rects, uint64_t texels,
                                 uint64_t pairs);

/* Check the headers of a mesh's coarser levels, which follow the full level's header: present, and equal in all fields
 * that levels share. Called before the arrays are checked. */
NOH_COLD noh_result noh_check_level_headers(noh_check *check, const noh_mesh_header *h);

/* The levels that a mesh has in the pack, and so headers in its chunk; and where in the chunk a level's lies. */
static inline uint32_t noh_check_levels_there(const noh_mesh_header *h)
{
    return h->level_count - h->level_first;
}
static inline uint64_t noh_check_level_at(const noh_mesh_header *h)
{
    return (uint64_t)(h->level - h->level_first) * sizeof *h;
}

/* Sums over all levels of a mesh, of the arrays that each level has a part of. */
typedef struct noh_level_sums {
    uint64_t indices, submeshes;
} noh_level_sums;
noh_level_sums noh_check_level_sums(const noh_mesh_header *h);

/* The coarser levels, and every vertex's texel reference; after the full mesh and the arrays. */
noh_result noh_check_levels(const noh_check *check, const noh_mesh_header *h);

/* A mesh's skin, palettes and influences; after its counts, arrays and submeshes. */
noh_result noh_check_mesh_skin(const noh_check *check, const noh_mesh_header *h);

/* A vertex's texel reference and palette; without references its own number. */
uint32_t noh_check_texel_word(const noh_check *check, const noh_mesh_header *h, uint32_t vertex);

/* The joints of the n-th skin; 0 for NOH_NONE. */
uint32_t noh_check_skin_joints(const noh_pack *pack, uint32_t skin);

#endif
