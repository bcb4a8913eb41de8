/* stage_desc_file.h: reads a noh_stage_desc from a text (noh help FORMATS). */
#ifndef NOH_NOH_BUDGET_STAGE_DESC_FILE_H
#define NOH_NOH_BUDGET_STAGE_DESC_FILE_H

#include "file/pack_file.h"
#include "noh/base.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

#define STAGE_DESC_CLIPS_MAX 32u        /* packs of clips of one kind */
#define STAGE_DESC_TEXTURE_SETS_MAX 16u /* of one kind */
#define STAGE_DESC_PACKS_MAX (NOH_STAGE_KINDS_MAX * (STAGE_DESC_CLIPS_MAX + STAGE_DESC_TEXTURE_SETS_MAX + 2u))
#define STAGE_DESC_PEERS_MAX 4u

/* The desc points into the rest: neither is copied. */
typedef struct stage_desc_file {
    noh_stage_desc desc; /* gpu and morph_path are the caller's to set */
    noh_kind_desc kinds[NOH_STAGE_KINDS_MAX];
    noh_kind_desc others[NOH_STAGE_KINDS_MAX]; /* of kinds that change */
    uint32_t slot_of[NOH_STAGE_KINDS_MAX];     /* of each kind in the text: 1 + the kind whose slot it takes; 0: none */
    noh_layer_desc layers[NOH_STAGE_KINDS_MAX][NOH_LAYERS_MAX];
    noh_kind_face faces[NOH_STAGE_KINDS_MAX];
    noh_kind_ragdoll ragdolls[NOH_STAGE_KINDS_MAX];
    const noh_pack *map_packs[NOH_STAGE_KINDS_MAX]; /* with the skeleton of clips that play through a map; NULL: none */
    noh_retarget maps[NOH_STAGE_KINDS_MAX];
    noh_skeleton map_skeletons[NOH_STAGE_KINDS_MAX][2];
    noh_retarget_joint map_joints[NOH_STAGE_KINDS_MAX][NOH_JOINTS_MAX];
    noh_modifier modifiers[NOH_STAGE_KINDS_MAX][NOH_MODIFIERS_MAX];
    noh_texture_set texture_sets[NOH_STAGE_KINDS_MAX][STAGE_DESC_TEXTURE_SETS_MAX];
    uint32_t nodes[NOH_STAGE_KINDS_MAX][NOH_STAGE_MESHES_MAX];
    noh_reflection reflection; /* without texels */
    noh_gl_light_desc light;
    const noh_pack *clips[NOH_STAGE_KINDS_MAX][STAGE_DESC_CLIPS_MAX];
    pack_file packs[STAGE_DESC_PACKS_MAX]; /* each file once, so that kinds share it */
    char *pack_paths[STAGE_DESC_PACKS_MAX];
    uint32_t pack_count;
    char *text;                                 /* names lie in it */
    noh_stage_peers share;                      /* of `desc`, where the text says so */
    noh_stage_peer peers[STAGE_DESC_PEERS_MAX]; /* the caller makes their plans */
    noh_stage_plan peer_plans[STAGE_DESC_PEERS_MAX];
    struct stage_desc_file *peer_files[STAGE_DESC_PEERS_MAX];
    struct stage_desc_file *reader_of; /* whose peer it is; NULL: of none. The first of the row has the packs of all */
} stage_desc_file;

/* Read the text and open its packs, whose paths are relative to the text's folder. Prints an error, "FILE:LINE: ...",
 * and returns an exit code; 0 on success, and the file is then to be freed. */
int stage_desc_file_read(const char *path, stage_desc_file **out);
void stage_desc_file_free(stage_desc_file *file);

#endif
