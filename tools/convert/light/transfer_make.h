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

/* Set `mark` [vertex_count] where a material's vertices, of all levels, are on a surface of this kind, and no target moves
 * them. Other vertices, and other kinds, stay as they are. Two kinds have other records than at rest: eyeballs follow
 * joints, and what lids cover comes into sight, so they have the mean of what is seen at rest (NOH_SURFACE_EYE); teeth
 * are as the target that opens the lips most shows them (NOH_SURFACE_TEETH). */
void transfer_mark_still(const noh_mesh *mesh, uint32_t material, uint32_t surface, uint8_t value, uint8_t *mark);
void transfer_data_free(transfer_data *d);

#endif
