/* pack_write.h: from a model and its encoded targets to the bytes of a pack. */
#ifndef NOH_CONVERT_PACK_PACK_WRITE_H
#define NOH_CONVERT_PACK_PACK_WRITE_H

#include "convert/base/byte_buffer.h"
#include "convert/lod/lod_levels.h"
#include "convert/morph/morph_encode.h"

/* Refuse what no pack can hold: before encoding, and after. 0, or 1 and a filled error that names the limit. */
int pack_check_model(const model *m, model_error *error);
int pack_check_encoding(const model_mesh *m, const morph_encoding *e, model_error *error);

/* Why a pack could not be made when it had this size: the limit, or memory. Returns 1. */
int pack_fail_size(size_t bytes, model_error *error);

struct encoded_clips;

/* Build a pack. levels[mesh_count], or NULL: no mesh has coarser ones; encodings[mesh_count], none of them NULL; made
 * NULL: no clips, and no mesh is bound to a skin. 0, or 1 and a filled error. */
int pack_write(const model *m, const mesh_levels *levels, morph_encoding *const *encodings,
               const struct encoded_clips *made, byte_buffer *out, model_error *error);

#endif
