/* pack_wire.h: the wire form of a pack: what runtime/core/wire/ reads. */
#ifndef CONVERT_PACK_PACK_WIRE_H
#define CONVERT_PACK_PACK_WIRE_H

#include "convert/base/byte_buffer.h"
#include "convert/model/model.h"
#include "noh/pack.h"

/* A grid that all positions of a mesh lie on: origin + step * a whole number, in float arithmetic. */
typedef struct wire_grid {
    float origin[3], step; /* step 0: none */
} wire_grid;

/* The steps of a pack's rounded values. */
typedef struct wire_steps {
    const wire_grid *grids; /* [mesh_count], or NULL */
    uint32_t normal_steps;  /* of a half; 32767 where they were not rounded */
    uint32_t uv_steps;      /* 65535 likewise */
    uint32_t weight_shift;  /* bits of weights that are 0 */
} wire_steps;

/* Bytes of the wire form by kind of data, for reports. first: up to the end of the coarse pack; 0: there is none. */
typedef struct wire_report {
    uint64_t triangles, positions, attributes, influences, deltas, textures, rest;
    uint64_t first;
} wire_report;

/* The packs, the coarse one first; each opens once it is complete, and the last is the whole pack.
 * returns  0, or 1: with *error, and `out` empty */
int pack_wire(const noh_pack *packs, uint32_t pack_count, const wire_steps *steps, byte_buffer *out,
              wire_report *report, model_error *error);

#endif
