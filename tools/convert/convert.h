/* convert.h: makes the bytes of one pack from files, and reports the result. */
#ifndef NOH_CONVERT_CONVERT_H
#define NOH_CONVERT_CONVERT_H

#include <stdio.h>

#include "convert/base/input_file.h"
#include "convert/light/transfer_make.h"
#include "convert/pack/pack_clips.h"
#include "noh/pack.h"
#include "convert/pack/pack_strip.h"
#include "convert/pack/pack_write.h"
#include "convert/sources.h"
#include "convert/wrinkle/color_make.h"
#include "convert/wrinkle/wrinkle_make.h"

typedef enum convert_only { CONVERT_ALL, CONVERT_MESH, CONVERT_CLIPS } convert_only;

typedef struct convert_options {
    morph_options morph; /* rank, level_count and skip_radius are filled in by convert_files */
    lod_settings lod;
    clips_settings clip;
    source_options source;       /* skin.report is filled in by convert_files */
    wrinkle_settings wrinkles;   /* zeros: none; report is filled in by convert_files */
    color_settings colors;       /* likewise */
    transfer_settings transfer;  /* order 0: none; progress is filled in by convert_files */
    const char *const *surfaces; /* [surface_count] "MATERIAL=KIND", see surface_kind.h */
    uint32_t surface_count;
    const char *const *tints; /* [tint_count] "MATERIAL=on|off", see tint.h */
    uint32_t tint_count;
    const char *const *priorities; /* [priority_count] "MATERIAL=N", see priority.h */
    uint32_t priority_count;
    joint_match_options joints; /* how clips of other files find their joints */
    uint8_t blocks;             /* MODEL_BLOCKS_*: how textures are compressed */
    uint32_t texture_max;       /* textures are halved until no side is longer; 0: NOH_TEXTURE_SIZE_MAX */
    int whole_textures;         /* 1: textures are not trimmed (texture/texture_trim.h) */
    convert_only only;
    const char *names;                  /* a text file of names, see names.h; NULL: the table alone */
    const char *events;                 /* a text file of callback keys; NULL: none */
    const char *texts[NOH_CHUNK_TYPES]; /* the file of a chunk's text (chunks/chunk_maker.h): graphs, springs, recipe,
                                           ragdoll, haircut, terrain; NULL: none */
    const char *const *spring_lines;    /* [spring_line_count] lines of springs, after the file's */
    uint32_t spring_line_count;
    terrain_options ground; /* of the terrain */
    int choose_levels;      /* 1: LOD levels of a face by choices.h; lod has none then */
    int keep_looks;         /* 1: eyes, faces and lashes of one colour stay (model/eye_paint.h) */
    int no_correctives;     /* 1: names of targets do not make correctives */
    strip_levels lod_from;  /* count 0: all levels stay */
    FILE *report;           /* NULL: quiet */
    FILE *warnings;         /* NULL: with the report (convert_warnings) */
    input_list *inputs;     /* receives the files that were read or looked for; NULL: not wanted */
    FILE *progress;         /* a terminal, for progress; NULL: none */
} convert_options;

typedef struct convert_failure {
    const char *file; /* which input */
    uint32_t line;    /* of a text; 0: not known */
    model_error error;
} convert_failure;

/* Read, join (sources.h; the first input with meshes gives the model; none is needed with a terrain), encode and write.
 * 0 on success: *out is the whole pack, to be freed with buffer_free. The same inputs and options give the same bytes
 * on every machine. */
int convert_files(const char *const *inputs, int input_count, const convert_options *options, byte_buffer *out,
                  convert_failure *failure);

/* Where warnings go: NULL: nowhere. */
FILE *convert_warnings(const convert_options *options);

/* Report one encoded mesh: counts, bits, and its bytes compared with other engines' layouts. scale: model_mesh_scale,
 * so that errors are printed in world units. */
void convert_report_mesh(FILE *out, const model_mesh *mesh, const morph_encoding *e, float scale, float error_um);

/* Report the certified errors of each LOD level. */
void convert_report_lods(FILE *out, const model_mesh *mesh, const mesh_levels *levels, float scale);

/* Report the skin of each skinned mesh of a finished pack, and the parts that the mesh was split into. */
void convert_report_skins(FILE *out, const noh_pack *pack);

/* Report the textures of a finished pack that lose much as blocks. */
void convert_report_textures(FILE *out, const noh_pack *pack);

#endif
