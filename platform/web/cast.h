/* cast.h: what the page asks of a stage. The planner asks it when the page is built, to size the page's memory, and the
 * page when it runs. */
#ifndef NOH_PLATFORM_WEB_CAST_H
#define NOH_PLATFORM_WEB_CAST_H

#include "noh/base.h"
#include "noh/body.h"
#include "noh/gl_device.h"
#include "noh/light.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

enum { WEB_BODY, WEB_FACE, WEB_LAYERS };

#define WEB_SHADOW_PX 1024u /* as `noh render` has it */

/* What is to be there. */
typedef struct web_wants {
    uint32_t actors; /* of each kind */
    noh_morph_path path;
    int lit;              /* 1: by an environment, with a shadow map */
    int alive;            /* 1: faces, where eyes are found, and springs */
    int without_transfer; /* 1: light that was worked out for each vertex is left out */
    int elsewhere;        /* 1: another renderer draws: no shaders, no light and no hair of ours */
} web_wants;

typedef struct web_cast {
    web_wants wants;
    noh_stage_desc desc; /* points at kinds and light */
    noh_kind_desc kinds[NOH_STAGE_KINDS_MAX];
    noh_kind_face faces[NOH_STAGE_KINDS_MAX];
    uint32_t faces_found;      /* a bit for each kind */
    noh_reflection reflection; /* without its texels, which nothing asks for before the stage is made */
    noh_gl_light_desc light;
    noh_haircut cut;
    noh_wig wig;
    noh_stage_part hair_part;
    uint32_t hair_kind;                                         /* whose actors wear it; NOH_NONE: the pack has none */
    noh_error cannot_fall;                                      /* OK: actors of the first kind can */
    uint32_t nodes[NOH_STAGE_KINDS_MAX * NOH_STAGE_MESHES_MAX]; /* of all kinds but the first */
    noh_stage_plan plan;
    /* What else the page keeps, behind the stage: the matrices that web_bounds works on, the texels of a reflection,
     * where hair is, what is needed while a reflection is made or faces are found, and the state that another stage
     * goes on with */
    size_t matrices_at, texels_at, hair_at, scratch_at, scratch_bytes;
    size_t hair_bytes;             /* of one actor's; 0: none */
    size_t bytes;                  /* of all of it */
    uint64_t cpu_bytes, gpu_bytes; /* of the stage and its hair */
} web_cast;

/* A kind for each skeleton of the pack that moves a mesh; every float may be held. Must not be moved afterwards.
 * scratch  [scratch_bytes] to find faces in; web_cast_scratch tells how much is enough. With less there are none
 * errors   LIMIT more skeletons than kinds; as noh_stage_plan_make */
noh_result web_cast_plan(web_cast *cast, const noh_pack *pack, const web_wants *wants, void *scratch,
                         size_t scratch_bytes, const noh_gl_caps *caps, noh_error *error);
size_t web_cast_scratch(const noh_pack *pack);

#endif
