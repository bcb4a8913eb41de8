/* pack_round.h: a pack whose values are rounded, so that its wire form is small. */
#ifndef CONVERT_PACK_PACK_ROUND_H
#define CONVERT_PACK_PACK_ROUND_H

#include "convert/base/byte_buffer.h"
#include "convert/base/error.h"
#include "pack_wire.h"
#include "noh/pack.h"

#define ROUND_NORMAL_STEPS 255u  /* of a half of the octahedron: half a degree at most */
#define ROUND_UV_STEPS 4095u     /* of a mesh's range of texture coordinates */
#define ROUND_WEIGHT_SHIFT 8u    /* joint weights are multiples of 2^-14 */
#define ROUND_DELTA_STEP 0.0039f /* of differences of normals and tangents, per component: 0.002 off at most */

typedef struct round_desc {
    double bound_m;    /* the farthest that rounding moves a vertex at rest, metres; 0: nothing is rounded */
    int keep_tangents; /* also where no material uses them */
} round_desc;

/* The changes to a mesh. */
typedef struct round_mesh {
    int had_tangents, dropped_tangents;
    double moved_m;   /* farthest from where it was, at rest, metres */
    double turned;    /* normals at rest: the largest angle, degrees */
    double delta_off; /* differences of normals at weight 1, per component */
    wire_grid grid;
} round_mesh;

/* A pack in `out`, and meshes[mesh_count]. Without a bound, and where no tangents are dropped, it is the same to the
 * byte. 0, or 1 and a filled error. */
int pack_round(const noh_pack *pack, const round_desc *desc, byte_buffer *out, round_mesh *meshes, model_error *error);

#endif
