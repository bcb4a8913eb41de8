/* pack_clips.h: the skeletons and clips of one pack, encoded. */
#ifndef NOH_CONVERT_PACK_PACK_CLIPS_H
#define NOH_CONVERT_PACK_PACK_CLIPS_H

#include <stdio.h>

#include "convert/base/recipe_read.h"
#include "convert/codec/clip_encode.h"
#include "convert/codec/clip_errors.h"
#include "convert/codec/named_errors.h"
#include "convert/terrain/terrain_read.h"

typedef struct encoded_clip {
    uint32_t set; /* index into encoded_clips.sets */
    const raw_clip *raw;
    byte_buffer bytes;
    clip_report report;
    clip_errors errors;
} encoded_clip;

typedef struct encoded_clips {
    raw_set **sets; /* [set_count]; borrowed */
    uint32_t set_count;
    encoded_clip *clips; /* [clip_count] */
    uint32_t clip_count;
    void *const *chunks; /* [NOH_CHUNK_TYPES] what the makers have read (chunks/chunk_maker.h); NULL: nothing */
} encoded_clips;

typedef struct clips_settings {
    int check_loops;    /* mark every clip as a loop, and report the gap between its ends */
    int skeletons_only; /* no clips, for a pack of meshes */
    clip_options clip;  /* error_cm 0: as fits the skeleton's size */
    int raises;         /* 1: where single precision cannot hold the bound, it is raised; filled in by clips_encode */
    named_errors clip_errors, joint_errors; /* they override the bounds of `clip` */
    /* bound to the sets: on its vertices the errors of fewer joints and lower update rates are measured; NULL: on the
     * shell */
    const model *m;
    FILE *report, *warnings, *progress; /* or NULL */
} clips_settings;

/* Encode every clip. 0, or 1 and a filled error; free in both cases. */
int clips_encode(raw_set **sets, uint32_t set_count, const clips_settings *settings, encoded_clips *out,
                 model_error *error);
void clips_free(encoded_clips *m);

/* Append the bytes of a skeleton chunk; of a clip chunk. */
void pack_skeleton(const raw_skeleton *skeleton, string_table *strings, byte_buffer *out);
void pack_clip(const encoded_clips *m, const encoded_clip *clip, string_table *strings, byte_buffer *out);

#endif
