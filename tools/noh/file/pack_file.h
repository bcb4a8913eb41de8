/* pack_file.h: a pack mapped from a file, unpacked from its wire form, or built from a model. */
#ifndef NOH_NOH_FILE_PACK_FILE_H
#define NOH_NOH_FILE_PACK_FILE_H

#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/pack.h"
#include "platform.h"

typedef struct pack_file {
    const char *path;
    noh_file file; /* empty where the file is no pack */
    void *made;    /* the pack, unpacked or built; NULL where the file is one */
    noh_pack pack;
} pack_file;

/* Map and open a pack, or unpack a wire form, or build a model (model_pack.h); prints the error, which says what other
 * files are, and returns an exit code, 0 on success. */
int pack_file_open(pack_file *file, const char *path);
/* The same for pictures: a model's clips are built with --effort 1, in a quarter of the time, to the same bounds. */
int pack_file_open_draft(pack_file *file, const char *path);
/* The first, with messages about `subject`: "cast.txt:3: head.noh". */
int pack_file_open_as(pack_file *file, const char *path, const char *subject);
void pack_file_close(pack_file *file);

/* Read the header of the pack's n-th clip; prints an error about a broken one and returns an exit code. */
int tool_clip_info(const pack_file *file, uint32_t index, noh_pack_clip *clip, noh_clip_info *info);
double tool_clip_seconds(const noh_clip_info *info);

#endif
