/* cast.h: the stage of a page. plan.c uses it when the page is built, to size its memory, and the page when it runs. */
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

#define WEB_SHADOW_PX 512u /* as in `noh render` */

/* Options of the stage. */
typedef struct web_wants {
    uint32_t actors; /* per kind */
    noh_morph_path path;
    int lit;              /* 1: lit by an environment, with a shadow map */
    int alive;            /* 1: faces, if eyes are found, and springs */
    int without_transfer; /* 1: ignore precomputed light of vertices */
    int elsewhere;        /* 1: another renderer draws: no shaders, light or hair of noh */
    int64_t held_ticks;   /* for which figures that stand were held still */
    noh_shading shading;
} web_wants;

/* A kind that stands without a clip. */
typedef struct web_stand {
    noh_kind_stand rig;
    const web_wants *wants;
} web_stand;

typedef struct web_cast {
    web_wants wants;
    noh_stage_desc desc; /* points at kinds and light */
    noh_kind_desc kinds[NOH_STAGE_KINDS_MAX];
    noh_kind_face faces[NOH_STAGE_KINDS_MAX];
    uint32_t faces_found;      /* a bit for each kind */
    noh_reflection reflection; /* without texels: not needed before the stage is created */
    noh_gl_light_desc light;
    noh_haircut cut;
    noh_actor_hair_desc hair;                       /* of all actors of its kind */
    noh_modifier modifiers[NOH_STAGE_KINDS_MAX][2]; /* of each kind: how it stands, then its hair */
    const noh_modifier *hair_part;
    web_stand stands[NOH_STAGE_KINDS_MAX];
    uint32_t stand_count;                                       /* kinds that stand without a clip */
    int has_hair;                                               /* 0: the pack has none */
    noh_error cannot_fall;                                      /* OK: actors of the first kind can */
    uint32_t nodes[NOH_STAGE_KINDS_MAX * NOH_STAGE_MESHES_MAX]; /* of all kinds but the first */
    noh_stage_plan plan;
    /* Offsets of the page's other data, after the stage: matrices for web_bounds, texels of a reflection, hair, and
     * scratch memory for baking reflections and finding faces; then the state handed from one stage to the next */
    size_t matrices_at, texels_at, hair_at, scratch_at, scratch_bytes;
    size_t heads_bytes;            /* of the noh_actor_hair; what draws it follows */
    size_t bytes;                  /* of all of it */
    uint64_t cpu_bytes, gpu_bytes; /* of the stage and its hair */
} web_cast;

/* Plan a kind for each skeleton of the pack that moves a mesh; every float can be held. The cast must not be moved
 * afterwards.
 * scratch  [scratch_bytes] to find faces; web_cast_scratch returns the size needed. With less, no faces are found
 * errors   LIMIT more skeletons than kinds; as noh_stage_plan_make */
noh_result web_cast_plan(web_cast *cast, const noh_pack *pack, const web_wants *wants, void *scratch,
                         size_t scratch_bytes, const noh_gl_caps *caps, noh_error *error);
size_t web_cast_scratch(const noh_pack *pack);

/* Parts of a plan; body.wasm and face.wasm have not all of them (without_falls.c, face_only.c).
 * springs  of a kind that is alive
 * stand    to each humanoid of a pack whose clips move no joint
 * hair     to the first kind with the joint that carries it
 * fall     of the first kind, on a floor at height 0, as in `noh render --push` */
void web_cast_add_springs(noh_kind_desc *kind);
void web_cast_add_stand(web_cast *cast, const noh_pack *pack);
noh_result web_cast_add_hair(web_cast *cast, const noh_pack *pack, noh_error *error);
void web_cast_add_fall(web_cast *cast);

/* Where the front of the pack's figures is: pack_facing, or 0 in face.wasm. */
float web_cast_facing(const noh_pack *pack);

#endif
