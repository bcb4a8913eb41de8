/* model_pack.h: the pack of a model file for verbs that read packs: built as by `noh build`, and kept in a cache.
 *
 * The cache is a folder: $NOH_CACHE, else $XDG_CACHE_HOME/noh, else ~/.cache/noh. A pack's name is a hash of everything
 * that it depends on: this program, the options, the model's name, and the contents of the model and of all files that
 * it refers to, whose names are in a list of their own. Packs that were not used for longest are removed, so that the
 * folder keeps below $NOH_CACHE_MB megabytes (1024; 0: nothing is kept). The folder may be removed at any time. */
#ifndef NOH_NOH_FILE_MODEL_PACK_H
#define NOH_NOH_FILE_MODEL_PACK_H

#include "convert/convert.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct model_pack_desc {
    const char *path;
    const char *const *options; /* [option_count], at most 8, as on the command line of `noh build` */
    int option_count;
    int draft;      /* 1: for pictures: with --effort 1, unless the cache has the pack without it */
    FILE *progress; /* NULL: none */
} model_pack_desc;

/* The pack, to be freed with buffer_free; it opens. Warnings of a build, or of a cache that cannot be written, go to
 * stderr. 1 and *failure where the model cannot be built. */
int model_pack_make(const model_pack_desc *desc, byte_buffer *pack, convert_failure *failure);

#ifdef __cplusplus
}
#endif

#endif
