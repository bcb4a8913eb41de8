/* transfer_make.h: the transfer of one mesh of a pack. */
#ifndef NOH_CONVERT_LIGHT_TRANSFER_MAKE_H
#define NOH_CONVERT_LIGHT_TRANSFER_MAKE_H

#include <stdio.h>

#include "light_rays.h"
#include "noh/pack.h"

#define TRANSFER_RAYS 1024u /* directions over the sphere, half of them in front of a vertex */

typedef struct transfer_settings {
    uint32_t order;  /* 4 or 6; 0: none */
    uint32_t flags;  /* NOH_TRANSFER_* */
    FILE *progress;  /* a terminal; NULL: none */
    uint32_t bounce; /* as in noh_transfer_header */
} transfer_settings;

/* The arrays of a transfer chunk. */
typedef struct transfer_data {
    uint8_t *records; /* [vertex_count][NOH_TRANSFER_RECORD_BYTES] */
    float *scales;    /* [target_count] */
    int8_t *deltas;   /* [texel_count] */
} transfer_data;

/* 0, or 1 and a filled error; free in both cases. */
int transfer_make(const noh_pack *pack, uint32_t mesh, const light_rays *rays, const transfer_settings *settings,
                  transfer_data *out, model_error *error);
/* Whether a vertex of the mesh's part is on an eyeball that no target moves, and so follows a joint. Its record is the mean
 * of what is seen at rest: what the lids cover comes into sight. */
int transfer_turns(const noh_mesh *mesh, const noh_submesh *part, uint32_t vertex);
void transfer_data_free(transfer_data *d);

#endif
