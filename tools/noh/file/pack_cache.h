/* pack_cache.h: built packs in a folder, by a hash of what they were built from (model_pack.h). */
#ifndef NOH_NOH_FILE_PACK_CACHE_H
#define NOH_NOH_FILE_PACK_CACHE_H

#include <stdint.h>

#include "convert/base/byte_buffer.h"
#include "convert/base/input_file.h"

typedef struct content_hash {
    uint64_t a, b;
} content_hash;

void content_hash_add(content_hash *h, const void *data, size_t bytes);
/* With its end, so that "ab", "c" differs from "a", "bc". */
void content_hash_add_text(content_hash *h, const char *text);
/* The file's bytes, or that it is not there. Returns whether it is. */
int content_hash_add_file(content_hash *h, const char *path);

/* model   its path; begun: the hash of everything but the files that it refers to
 * Returns 1 and the bytes, to be freed, of a pack that was kept; 0: there is none. */
int pack_cache_find(const char *model, content_hash begun, byte_buffer *pack);

/* Keep a pack. inputs: all that was read to build it, which began at start_ns (of the system's clock, since 1970):
 * where one has changed since, nothing is kept. A failure is a warning on stderr, once. */
void pack_cache_keep(const char *model, content_hash begun, const input_list *inputs, int64_t start_ns,
                     const byte_buffer *pack);

#endif
