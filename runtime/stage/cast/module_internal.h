/* module_internal.h: what a stage asks of its modules.
 *
 * A module is what actors of a kind can do beyond layers of clips: animation graphs, faces, ragdolls, springs, motion matching. It is a
 * constant table of functions in files of its own, which noh_kind_desc names. The stage finds it through the slots of a
 * kind alone, so that a program which names no module links none of its code. A function that a module has no use for
 * is NULL.
 *
 *   desc     is_there, bad, hash, measure: of a noh_kind_desc with its defaults filled in
 *   init     once the kind has its meshes, floats, layers and bounds
 *   actors   spawn, despawn, shift, check
 *   a step   step_actor, root, carries, steer; step, after all actors of the kind
 *   a frame  controller, sample; modify, in the order of the slots; turn
 *   names    name_count, name */
#ifndef NOH_STAGE_MODULE_INTERNAL_H
#define NOH_STAGE_MODULE_INTERNAL_H

#include "motion/anim/controller_pose_internal.h"
#include "stage/character/character_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/low_stage.h"
#include "noh/modules.h"
#include "noh/noh.h"

#ifdef __cplusplus
extern "C" {
#endif

struct noh_stage_actor;
struct noh_stage_job_part;
struct noh_stage_kind;
struct noh_stage_layer;
struct noh_stage_needs;

/* A kind has at most one module in a slot. Poses are changed in the order of the slots. */
typedef enum noh_module_slot {
    NOH_SLOT_SOURCE, /* what plays on a track as a clip does */
    NOH_SLOT_FACE,
    NOH_SLOT_MODIFIERS, /* noh_kind_desc.modifiers */
    NOH_SLOT_BODY,
    NOH_SLOT_SPRINGS,
    NOH_SLOT_MATCH,
    NOH_SLOT_COUNT
} noh_module_slot;

typedef struct noh_module_needs {
    size_t kind_bytes;    /* of what its actors share: noh_stage_module.shared */
    size_t actor_bytes;   /* of state, of each actor */
    size_t pool_bytes;    /* of state, of all actors together */
    size_t scratch_bytes; /* of each job; all modules of all kinds share it */
} noh_module_needs;

/* A module of a kind of a stage. */
typedef struct noh_stage_module {
    const struct noh_module_type *type; /* NULL: none in this slot */
    void *shared;
    uint8_t *states; /* [actor_count] of all actors of the kind, `stride` bytes apart */
    size_t stride;
    void *pool;
    int turns;                            /* 1: it turns models within their places: noh_module_type.turn */
    float error_m[NOH_UPDATE_RATE_COUNT]; /* what its motion adds to the errors of update rates */
} noh_stage_module;

/* Samples a set some of whose clips stand for what the source of an actor plays: these have the poses made of it. */
typedef struct noh_stage_sampler {
    noh_clip_sample_fn sample; /* of all other clips */
    void *user;
    uint32_t first_source_clip;
    uint32_t tick;                 /* of the first pose, where there are two */
    const noh_transform *poses[2]; /* NULL: none */
    const float *floats[2];
    const noh_transform *bind_pose; /* where there is none */
    const float *float_defaults;
} noh_stage_sampler;

/* A step of an actor, for noh_stage_on_key. */
typedef struct noh_stage_stepper {
    noh_stage *s;
    struct noh_stage_kind *k;
    struct noh_stage_actor *a;
    int64_t before; /* the clock of the actor's controller at the start of the step */
} noh_stage_stepper;

typedef struct noh_module_type {
    noh_module_slot slot;
    /* Of its bytes in noh_stage_plan_parts: what actors share, their states, the pool. NULL: states count as
     * "characters" */
    const char *kind_name, *state_name, *pool_name;
    uint32_t (*hash)(const noh_kind_desc *kind, const void *desc); /* what states depend on besides their bytes */
    int (*is_there)(const noh_kind_desc *kind, const void *desc);  /* 0: the desc asks for nothing */
    const char *(*bad)(const noh_kind_desc *kind, const void *desc);
    const char *(*refuse)(const void *desc, uint32_t job_count); /* as noh_modifier.refuse */
    noh_result (*measure)(const noh_kind_desc *kind, const void *desc, const struct noh_stage_needs *clips,
                          noh_module_needs *needs, noh_error *error);
    noh_result (*init)(struct noh_stage_kind *k, const void *desc, noh_error *error);

    void (*spawn)(const noh_stage *s, const struct noh_stage_kind *k, uint32_t index, noh_actor actor);
    void (*despawn)(struct noh_stage_kind *k,
                    uint32_t index); /* gives back its part of the pool; its state is zeroed */
    void (*shift)(struct noh_stage_kind *k, const float by[3]); /* the world's origin moves by `by` */
    /* A state of an actor from outside, and a pool. */
    noh_result (*check)(const struct noh_stage_kind *k, const void *state, noh_error *error);
    const char *(*check_pool)(const struct noh_stage_kind *k, const void *pool);

    /* Of an actor, once its clips have moved on and moved it. */
    void (*steer)(noh_stage *s, struct noh_stage_kind *k, uint32_t index, uint32_t ticks);
    void (*step)(struct noh_stage_kind *k, uint32_t ticks);
    /* Which of its feet the clip that plays has standing: slower than `slow`, model units a second. Bit 0: the foot with
     * the larger x */
    uint32_t (*stands)(const noh_stage *s, const struct noh_stage_kind *k, uint32_t index, float slow);
    int (*carries)(const struct noh_stage_kind *k, uint32_t index); /* 1: it moves the actor's place, clips do not */
    /* With noh_stage_module.turns: how it turns the model within its place. Points rotate, then move by `at`. */
    void (*turn)(const struct noh_stage_kind *k, uint32_t index, float rotation[4], float at[3]);
    void (*modify)(noh_modifier_work *work); /* `state` and `user` are its own: user `shared` */

    const struct noh_source_type *source; /* in NOH_SLOT_SOURCE */
} noh_module_type;

/* What plays on a track in place of a clip: number n stands for the clip n behind those that the kind has by name. */
typedef struct noh_source_type {
    void (*begin)(struct noh_stage_kind *k, uint32_t index, uint32_t number);
    /* In place of noh_character_step: keys in the order of time. */
    void (*step_actor)(noh_stage_stepper *t, noh_character *ch, uint32_t ticks);
    int (*root)(const struct noh_stage_kind *k, uint32_t index, noh_given_root *given); /* 0: nothing plays */
    noh_controller *(*controller)(const struct noh_stage_kind *k, uint32_t index);      /* NULL: nothing plays */
    /* Let `set` sample through `sampler`, which has the pose of an actor `ahead` ticks from now, and the pose `ago`
     * ticks before it if `ago` is not 0, in the scratch of the job; no pose where nothing plays. */
    void (*sample)(const noh_stage *s, const struct noh_stage_job_part *job, const struct noh_stage_kind *k,
                   uint32_t index, int64_t ahead, int64_t ago, noh_clip_set *set, noh_stage_sampler *sampler);
    /* The i-th clip of what it plays as `number`; NOH_NONE: no more. */
    uint32_t (*clip)(const struct noh_stage_kind *k, uint32_t number, uint32_t i);
    uint32_t (*name_count)(const struct noh_stage_kind *k, noh_name what);
    const char *(*name)(const struct noh_stage_kind *k, noh_name what, uint32_t index);
} noh_source_type;

/* ---- the slots of a kind ---- */

/* What a kind names for a slot; type NULL: nothing. */
noh_module noh_stage_wanted(const noh_kind_desc *kind, uint32_t slot);
/* Of a desc: only what is there stays. */
void noh_stage_fill_modules(noh_kind_desc *kind);
const char *noh_stage_bad_modules(const noh_kind_desc *kind, uint32_t job_count);
uint32_t noh_stage_hash_module(const noh_kind_desc *kind, uint32_t slot); /* 0: none */
noh_result noh_stage_measure_modules(const noh_kind_desc *kind, struct noh_stage_needs *needs, noh_error *error);
/* Whether something changes poses before they are shown. */
int noh_stage_has_modifiers(const noh_kind_desc *kind);
void noh_stage_open_modules(struct noh_stage_kind *k, const struct noh_stage_needs *needs); /* where their states lie */
noh_result noh_stage_init_modules(struct noh_stage_kind *k, noh_error *error);
/* Leave no byte of an actor in the states and pools of modules. */
void noh_stage_clear_modules(struct noh_stage_kind *k, uint32_t index);
/* A state or pool of a module in a copy of the stage's state. */
noh_result noh_stage_check_modules(const struct noh_stage_kind *k, uint32_t index, const uint8_t *state,
                                   const uint8_t *copy, noh_error *error);
const char *noh_stage_check_pools(const struct noh_stage_kind *k, const uint8_t *state, const uint8_t *copy);
/* Whether a module moves the place of an actor. */
int noh_stage_is_carried(const struct noh_stage_kind *k, uint32_t index);
int noh_stage_turns(const struct noh_stage_kind *k); /* 1: a module turns its models */
/* How a module turns an actor's model within its place, as shown. Returns 0: no module does. */
int noh_stage_turn(const struct noh_stage_kind *k, uint32_t index, float rotation[4], float at[3]);
/* The controller of what an actor's source plays; NULL: nothing. */
noh_controller *noh_stage_inner(const struct noh_stage_kind *k, uint32_t index);

#ifdef __cplusplus
}
#endif

#endif
