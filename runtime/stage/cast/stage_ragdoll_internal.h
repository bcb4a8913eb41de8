/* stage_ragdoll_internal.h: the ragdolls of a kind and of its actors, a module of the stage. */
#ifndef NOH_STAGE_STAGE_RAGDOLL_INTERNAL_H
#define NOH_STAGE_STAGE_RAGDOLL_INTERNAL_H

#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "stage/cast/stage_internal.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum noh_stage_rise { NOH_RISE_NOT = 0, NOH_RISE_BEGINS, NOH_RISE_GOES_ON } noh_stage_rise;

/* State of an actor. */
typedef struct noh_stage_body {
    noh_ragdoll_pose bodies[2][NOH_RAGDOLL_BODIES_MAX]; /* metres from `origin`: of the last two poses; during a
                                                         * fall the ragdoll's bodies, and the bodies as the clips
                                                         * pose them */
    noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX]; /* RISE_BEGINS: of bodies[0]. RISE_GOES_ON: of each body's joint
                                                         * how far it is turned from its clips, and how fast: radians */
    float offset[3], speed[3];                          /* likewise where the first body's joint is, in its unit; while
                                                         * it falls offset: from its first body to its place, metres */
    float hertz[NOH_RAGDOLL_BODIES_MAX], animated[NOH_RAGDOLL_BODIES_MAX]; /* noh_body_hold */
    uint32_t held;                                                         /* bit i: body i */
    uint32_t rise_ticks;                                                   /* for how long it gets up */
    int64_t rise_clock;                                                    /* since then */
    int64_t clocks[2];                                                     /* of the two poses */
    uint32_t doll;                                                         /* 1 + index in the kind's set; 0: none */
    uint32_t poses;                                                        /* how many of the two there are */
    uint8_t state;                                                         /* noh_body_state, of the first three */
    uint8_t rise;                                                          /* noh_stage_rise */
    uint8_t dead;
    uint8_t goals;   /* 1: bodies[1] is where its clips have them */
    float origin[3]; /* world, metres: near to its bodies, so that floats have as many digits everywhere */
} noh_stage_body;

NOH_STATIC_ASSERT(sizeof(noh_stage_body) == NOH_ACTOR_RAGDOLL_BYTES, stage_body);

/* What a kind's actors share. */
typedef struct noh_stage_ragdoll_kind {
    noh_ragdoll_rig rig;
    noh_ragdoll_fit fit;
    const noh_world *world;
    float metres;        /* of one unit of the world */
    uint32_t count;      /* of `dolls` */
    noh_ragdolls *dolls; /* state of all actors together: of those that fall at once */
    float *scratch;      /* [NOH_RAGDOLL_SCRATCH_FLOATS] aligned to 32 */
} noh_stage_ragdoll_kind;

/* NULL: the kind has no ragdolls. */
static inline const noh_stage_ragdoll_kind *noh_stage_ragdoll_kind_of(const noh_stage_kind *k)
{
    return k->modules[NOH_SLOT_BODY].shared;
}

/* The state of an actor's body; the kind has ragdolls. */
static inline noh_stage_body *noh_stage_body_of(const noh_stage_kind *k, uint32_t index)
{
    const noh_stage_module *m = &k->modules[NOH_SLOT_BODY];
    return (noh_stage_body *)(void *)(m->states + index * m->stride);
}

/* *b stays as it is where the result is not NOH_OK. */
noh_result noh_stage_open_body(noh_stage *stage, noh_actor actor, noh_stage_actor **a, noh_stage_kind **k,
                               noh_stage_body **b, noh_error *error);
/* A place as bodies that count from `origin` have it. */
noh_ragdoll_frame noh_stage_ragdoll_frame(const noh_stage_kind *k, const noh_place *place, const float origin[3]);
void noh_stage_ragdoll_weights(const noh_stage_kind *k, const noh_stage_body *b, float *weights); /* of each body */
void noh_stage_run_get_up(const noh_stage_kind *k, noh_stage_body *b, noh_modifier_work *w);
/* Whether a ragdoll moves its place. */
static inline int noh_stage_falls_free(const noh_stage_body *b)
{
    return b->state != NOH_BODY_STANDS && !(b->held & 1u);
}

#ifdef __cplusplus
}
#endif

#endif
