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
#include "stage/modules/stage_stagger_internal.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What moves an actor besides clips and the ragdoll. It says what noh_stage_body.of is. */
typedef enum noh_stage_moves {
    NOH_MOVES_BY_CLIPS = 0,
    NOH_MOVES_UP_BEGINS, /* it gets up: `of.motions` */
    NOH_MOVES_UP,
    NOH_MOVES_STAGGERING, /* on its feet: `of.stagger` */
    NOH_MOVES_BRACING     /* its ragdoll: `of.brace` */
} noh_stage_moves;

/* State of an actor. */
typedef struct noh_stage_body {
    noh_ragdoll_pose bodies[2][NOH_RAGDOLL_BODIES_MAX]; /* metres from `origin`: of the last two poses; during a
                                                         * fall the ragdoll's bodies, and the bodies as the clips
                                                         * pose them */
    union {
        noh_ragdoll_motion motions[NOH_RAGDOLL_BODIES_MAX]; /* UP_BEGINS: of bodies[0]. UP: of each body's joint how far
                                                             * it is turned from its clips, and how fast: radians */
        noh_stage_stagger stagger;
        noh_stage_brace brace;
    } of;
    float offset[3], speed[3]; /* likewise where the first body's joint is, in its unit; while
                                                         * it falls offset: from its first body to its place, metres */
    float hertz[NOH_RAGDOLL_BODIES_MAX], animated[NOH_RAGDOLL_BODIES_MAX]; /* noh_body_hold */
    uint32_t held;                                                         /* bit i: body i */
    uint32_t rise_ticks; /* for how long it gets up; while it falls: for how long it has rested */
    int64_t rise_clock;  /* since then */
    int64_t clocks[2];   /* of the two poses */
    uint32_t doll;       /* 1 + index in the kind's set; 0: none */
    uint32_t poses;      /* how many of the two there are */
    uint8_t state;       /* noh_body_state, of the first three */
    uint8_t moves;       /* noh_stage_moves */
    uint8_t dead;
    uint8_t goals;   /* in a fall 1: bodies[1] is where its clips have them; after one: its last breath, in 255ths */
    float origin[3]; /* world, metres: near to its bodies, so that floats have as many digits everywhere */
} noh_stage_body;

NOH_STATIC_ASSERT(sizeof(noh_stage_body) == NOH_ACTOR_RAGDOLL_BYTES, stage_body);

/* Bodies of a rig; NOH_NONE: it has none. */
typedef struct noh_stage_parts {
    uint16_t has_legs; /* 1: thighs, shins and feet of both, in the order of noh_stage_ragdoll_kind.legs */
    uint16_t front;    /* noh_feet_front */
    uint32_t thighs[NOH_FEET_LEGS_MAX], shins[NOH_FEET_LEGS_MAX], feet[NOH_FEET_LEGS_MAX];
    uint32_t spine, chest, head;
    uint32_t arm_count, upper_arms[2], forearms[2];
} noh_stage_parts;

/* What a kind's actors share. */
typedef struct noh_stage_ragdoll_kind {
    noh_ragdoll_rig rig;
    noh_ragdoll_fit fit;
    const noh_world *world;
    float metres;        /* of one unit of the world */
    float mass;          /* of all bodies, kilograms */
    float stagger_speed; /* noh_kind_ragdoll */
    noh_feet_rig legs;
    noh_stage_parts parts;
    uint32_t count;      /* of `dolls` */
    uint32_t asks;       /* 1: there is room for answers of the physics of `world` */
    noh_ragdolls *dolls; /* state of all actors together: of those that fall at once */
    float *scratch;      /* [NOH_RAGDOLL_SCRATCH_FLOATS(asks)] aligned to 32 */
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
/* Let another actor have its doll. */
void noh_stage_give_doll(const noh_stage_kind *k, noh_stage_body *b);
/* A place as bodies that count from `origin` have it. */
noh_ragdoll_frame noh_stage_ragdoll_frame(const noh_stage_kind *k, const noh_place *place, const float origin[3]);
void noh_stage_ragdoll_weights(const noh_stage_kind *k, const noh_stage_body *b, float *weights); /* of each body */
/* ---- figures that lie breathe (stage_lie.c) ---- */

void noh_stage_step_lying(const noh_stage_ragdoll_kind *shared, noh_stage_body *b, uint32_t ticks);
void noh_stage_breathe_lying(const noh_stage_kind *k, const noh_stage_body *b, const noh_modifier_work *w);
uint8_t noh_stage_breath_left(const noh_stage_body *b, int64_t clock); /* for noh_stage_body.goals as it gets up */
void noh_stage_breathe_out(const noh_stage_kind *k, noh_stage_body *b, const noh_modifier_work *w);

void noh_stage_run_get_up(const noh_stage_kind *k, noh_stage_body *b, noh_modifier_work *w);

/* ---- pushes ---- */

typedef struct noh_stage_push {
    const float *point, *impulse; /* [3] in the world, metres; newton seconds */
} noh_stage_push;

/* Whether an actor is free, and has a scale that ragdolls have. */
int noh_stage_can_fall(const noh_stage_actor *a);
noh_result noh_stage_fall(noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b, noh_error *error);
/* Which bodies of the kind are which. */
void noh_stage_find_parts(noh_stage_ragdoll_kind *shared, const noh_ragdoll_source *source);
/* Let a standing actor take a push on its feet. Returns 0: it cannot, and nothing has changed. */
int noh_stage_begin_stagger(noh_stage_kind *k, noh_stage_actor *a, noh_stage_body *b, const noh_stage_push *push);
void noh_stage_step_stagger(noh_stage_kind *k, noh_stage_actor *a, noh_stage_body *b, uint32_t ticks);
void noh_stage_run_stagger(const noh_stage_kind *k, noh_stage_body *b, noh_modifier_work *w);
const char *noh_stage_check_stagger(const noh_stage_stagger *s); /* NULL, or why a state is bad */
/* Let an actor fall that braces for the ground.
 * push  NULL: as it moves already */
noh_result noh_stage_brace_fall(noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b,
                                const noh_stage_push *push, noh_error *error);
/* Let an actor fall with a push, or push one that has fallen. */
noh_result noh_stage_knock_down(noh_stage_kind *k, const noh_stage_actor *a, noh_stage_body *b,
                                const noh_stage_push *push, noh_error *error);
/* Where a bracing ragdoll wants its bodies: goals[body_count] in metres from origin[3], hertz[body_count]. */
void noh_stage_brace_goals(const noh_stage_ragdoll_kind *shared, const noh_stage_body *body, float *origin,
                           noh_ragdoll_pose *goals, float *hertz);
void noh_stage_step_brace(const noh_stage_ragdoll_kind *shared, noh_stage_body *body, uint32_t ticks);
void noh_stage_keep_feet_low(const noh_stage_ragdoll_kind *shared, const noh_stage_body *body);
const char *noh_stage_check_brace(const noh_stage_brace *b);

/* Whether a ragdoll moves its place. */
static inline int noh_stage_falls_free(const noh_stage_body *b)
{
    return b->state != NOH_BODY_STANDS && !(b->held & 1u);
}

#ifdef __cplusplus
}
#endif

#endif
