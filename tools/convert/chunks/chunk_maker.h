/* chunk_maker.h: how the converter reads a type of chunk from text, and writes it. Each maker is one variable,
 * chunk_NAME, for the NAME in the list NOH_CHUNKS (format.h). Makers for models and clips are in pack/pack_write.c, all
 * others in files of this folder. */
#ifndef NOH_CONVERT_CHUNKS_CHUNK_MAKER_H
#define NOH_CONVERT_CHUNKS_CHUNK_MAKER_H

#include "convert/base/byte_buffer.h"
#include "convert/convert.h"
#include "convert/pack/pack_mesh.h"
#include "convert/sources.h"
#include "noh/format.h"
#include "noh/pack.h"

/* A pack that is being written. */
typedef struct pack_writer {
    const model *m;
    const mesh_levels *levels; /* or NULL */
    morph_encoding *const *encodings;
    const encoded_clips *clips; /* or NULL */
    byte_buffer out;            /* the chunks after the strings */
    string_table strings;
    noh_pack_chunk *chunks; /* [NOH_PACK_CHUNKS_MAX] */
    uint32_t chunk_count;
    uint32_t *skin_chunks; /* [skin_count] the n-th skin chunk, or NOH_NONE where no mesh is bound to it */
    mesh_extra *extras;    /* [mesh_count] */
    model_error *error;
    int refused; /* the error says why */
} pack_writer;

typedef struct chunk_maker {
    /* Read what the chunks are made of. *made stays NULL where there is nothing. 0, or 1 with the failure's error, and
     * its file and line where they are known. NULL: it is made of the model and its clips */
    int (*read)(const convert_options *options, const source *s, void **made, convert_failure *failure);
    int in_joint_order; /* 1: read once the joints are in their last order */
    void (*free)(void *made);
    /* Write all chunks of the type. NULL: another step adds them to the finished pack */
    void (*write)(pack_writer *w, const void *made);
    /* Check in the finished pack what noh_pack_open leaves to users of the chunk. NULL: nothing. 0, or 1 and the
     * error */
    int (*check)(const noh_pack *pack, model_error *error);
} chunk_maker;

#define NOH_CHUNK_MAKER(NAME, name, tag, many) extern const chunk_maker chunk_##name;
NOH_CHUNKS(NOH_CHUNK_MAKER)
#undef NOH_CHUNK_MAKER

const chunk_maker *chunk_maker_of(noh_chunk_type type);

/* A chunk is what is appended to w->out between these two. */
void chunk_begin(pack_writer *w, noh_chunk_type type, const char *name);
void chunk_end(pack_writer *w);

/* A string of the pack, and its hash. NULL: "" */
void chunk_name(pack_writer *w, const char *text, uint32_t *name, uint32_t *hash);

#endif
