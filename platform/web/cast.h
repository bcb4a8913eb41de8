/* cast.h: what the page asks of a stage. The planner asks it when the page is built, to size the page's memory, and the
 * page when it runs. */
#ifndef NOH_PLATFORM_WEB_CAST_H
#define NOH_PLATFORM_WEB_CAST_H

#include "noh_gl.h"

enum { WEB_BODY, WEB_FACE, WEB_LAYERS };

typedef struct web_cast {
    noh_stage_desc desc; /* points at kinds */
    noh_kind_desc kinds[NOH_STAGE_KINDS_MAX];
    uint32_t nodes[NOH_STAGE_KINDS_MAX * NOH_STAGE_MESHES_MAX]; /* of all kinds but the first */
    noh_stage_plan plan;
    uint32_t skin_joints; /* of the largest skin */
    size_t bytes;         /* of the stage, then of the matrices that web_bounds works on */
} web_cast;

/* A kind for each skeleton of the pack that moves a mesh, with so many actors each; every float may be held. Must not
 * be moved afterwards.
 * errors  LIMIT more skeletons than kinds; as noh_stage_plan_make */
noh_result web_cast_plan(web_cast *cast, const noh_pack *pack, uint32_t actors, noh_morph_path path,
                         const noh_gl_caps *caps, noh_error *error);

/* Where the matrices begin. */
size_t web_cast_matrices(const web_cast *cast);

#endif
