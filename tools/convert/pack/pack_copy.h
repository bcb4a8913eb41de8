/* pack_copy.h: copies a pack chunk by chunk. */
#ifndef NOH_CONVERT_PACK_PACK_COPY_H
#define NOH_CONVERT_PACK_PACK_COPY_H

#include "convert/base/byte_buffer.h"
#include "convert/base/error.h"
#include "noh/pack.h"

/* Appends what becomes of chunk `index`; its first byte is the next of `out`. */
typedef void pack_copy_chunk(void *context, uint32_t index, byte_buffer *out);

/* The chunk as it is. */
void pack_copy_as_is(const noh_pack *pack, uint32_t index, byte_buffer *out);

/* Appends the pack to `out`, which is empty: the same chunks in the same order, each processed by `chunk`, and new
 * checksums. Nonzero, with `out` freed, if memory runs out. */
int pack_copy(const noh_pack *pack, pack_copy_chunk *chunk, void *context, byte_buffer *out, model_error *error);

#endif
