/* smart_object.h: things that agents use: a bench to sit on, a stall to eat at, a drum to listen to.
 *
 *   noh_smart_size, noh_smart_init      objects and the agents who may use them, in one block
 *   noh_smart_enter, noh_smart_leave    an agent comes, goes (or dies)
 *   noh_smart_ask                       it wants a slot for a need, the best one that is free
 *   noh_smart_arrive                    it stands at its slot
 *   noh_smart_release                   it has changed its mind
 *   noh_smart_step                      time moves on: needs grow, uses end, slots are passed on
 *   noh_smart_use_of, noh_smart_most    what an agent is about; what it needs most
 *
 * The object holds the knowledge: where its slots are, which way one faces there, by which clips one enters, uses and
 * leaves it, and which need it satisfies at what rate. Agents hold needs, 0 to 1, which grow.
 *
 * An agent is in one of these phases:
 *   FREE      it wants nothing
 *   WAITING   no slot for its need is free: it is in the queue of that need
 *   GOING     a slot is reserved for it; noh_smart_arrive ends it
 *   ENTERING  for enter_ticks of the slot
 *   USING     until the need is gone, or use_ticks have passed
 *   LEAVING   for leave_ticks; then it is FREE
 * A slot is one agent's from GOING to the end of LEAVING, and no other's. Who does not arrive within the object's
 * going_ticks loses it, and is FREE. Who leaves the crowd, or dies, gives it back at once.
 *
 * Nobody starves: a slot that becomes free goes to whoever waits longest for its need, before any that ask later. So
 * with n agents, s slots of a need and no slot held longer than h ticks (noh_smart_hold_ticks), none waits longer than
 * ceil(n / s) h.
 *
 * What follows does not depend on addresses, and the order of equal ones is that of their indices: the same bits
 * everywhere. A block without pointers: a copy goes on as it would.
 * source  Granberg, Character Animation with Direct3D, 2009, chapter 13, which names smart objects and leaves their
 *         reservation open
 * Threads: smart objects belong to one thread at a time. */
#ifndef NOH_CROWD_SMART_OBJECT_H
#define NOH_CROWD_SMART_OBJECT_H

#include <stddef.h>
#include <stdint.h>

#include "core/base/limits.h"
#include "core/base/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A place for one agent. Clips are numbers of the game's: hashes of names, indices; 0 for none. */
typedef struct noh_smart_slot {
    float at[2];   /* x, z in the world */
    float face[2]; /* the way one faces there: unit x, z */
    uint32_t enter_clip, use_clip, leave_clip;
    uint32_t enter_ticks, leave_ticks;
    uint32_t use_ticks; /* at most; above 0 */
} noh_smart_slot;

typedef struct noh_smart_object {
    uint32_t need;                   /* that it satisfies, 0..need_count - 1 */
    float rate;                      /* by so much a second, above 0 */
    uint32_t going_ticks;            /* within which one has to arrive; above 0 */
    uint32_t first_slot, slot_count; /* in the desc's slots */
} noh_smart_object;

typedef struct noh_smart_desc {
    uint32_t agent_max;                /* 1..NOH_CROWD_AGENTS_MAX */
    uint32_t need_count;               /* 1..NOH_SMART_NEEDS_MAX */
    uint32_t object_count;             /* 1..NOH_SMART_OBJECTS_MAX */
    uint32_t slot_count;               /* 1..NOH_SMART_SLOTS_MAX */
    const noh_smart_object *objects;   /* [object_count]; copied by init, as are slots */
    const noh_smart_slot *slots;       /* [slot_count] */
    float growth[NOH_SMART_NEEDS_MAX]; /* of each need in a second, 0.. */
} noh_smart_desc;

typedef enum noh_smart_phase {
    NOH_SMART_AWAY = 0, /* no such agent */
    NOH_SMART_FREE,
    NOH_SMART_WAITING,
    NOH_SMART_GOING,
    NOH_SMART_ENTERING,
    NOH_SMART_USING,
    NOH_SMART_LEAVING
} noh_smart_phase;

/* What an agent is about. */
typedef struct noh_smart_use {
    noh_smart_phase phase;
    uint32_t need;         /* from WAITING on */
    uint32_t object, slot; /* from GOING on; else NOH_NONE. slot: in the desc's slots */
    uint32_t ticks;        /* in this phase so far */
} noh_smart_use;

typedef struct noh_smart noh_smart;

/* The exact bytes: 160, 20 an object, 44 a slot, and for each agent 36 and 4 a need; rounded up to 16. 0 for an
 * impossible desc. */
size_t noh_smart_size(const noh_smart_desc *desc);

/* Nobody is there.
 * errors  ARG memory is NULL or misaligned, a number is out of its range (where: the object or slot), or a slot is no
 *         object's or two objects'; LIMIT; MEMORY it is too small */
noh_result noh_smart_init(void *memory, size_t bytes, const noh_smart_desc *desc, noh_smart **smart, noh_error *error);

/* An agent comes, FREE, in place of the one that was there.
 * needs  [need_count] 0..1: what is outside is clamped; NULL: all 0 */
void noh_smart_enter(noh_smart *smart, uint32_t agent, const float *needs);
/* It is gone, wherever it was: its slot is free. */
void noh_smart_leave(noh_smart *smart, uint32_t agent);

/* An agent that is FREE wants a slot for a need. Of the objects with a free slot the one with the largest rate / (1 +
 * distance in metres) is taken, of its slots the nearest; but where others wait for that need it waits behind them.
 * at       [2] x, z, where it is
 * returns  1: it is GOING or WAITING now; 0: it was not FREE, or no object satisfies the need: nothing has changed */
int noh_smart_ask(noh_smart *smart, uint32_t agent, uint32_t need, const float at[2]);
/* returns  1: it was GOING, and ENTERs; 0: nothing has changed */
int noh_smart_arrive(noh_smart *smart, uint32_t agent);
/* An agent no longer wants what it waits or goes for: it is FREE. Who has arrived LEAVES.
 * returns  1: it has changed its phase */
int noh_smart_release(noh_smart *smart, uint32_t agent);

/* Time passes: needs grow and are satisfied, phases end, free slots are passed on to those who wait. Ends within the
 * step count as its end. */
void noh_smart_step(noh_smart *smart, uint32_t ticks);

void noh_smart_use_of(const noh_smart *smart, uint32_t agent, noh_smart_use *use);
/* [need_count] NULL: there is no such agent. */
const float *noh_smart_needs(const noh_smart *smart, uint32_t agent);
/* The largest of the needs that an object satisfies, the first of equal ones. returns NOH_NONE: none is above `least`
 */
uint32_t noh_smart_most(const noh_smart *smart, uint32_t agent, float least);

/* As the desc had it. */
const noh_smart_slot *noh_smart_slot_at(const noh_smart *smart, uint32_t slot);
const noh_smart_object *noh_smart_object_at(const noh_smart *smart, uint32_t object);
/* Who holds a slot; NOH_NONE: it is free. */
uint32_t noh_smart_holder(const noh_smart *smart, uint32_t slot);

/* The longest that a slot for a need may be held, steps of `step_ticks` at most: what the bound of waiting follows
 * from. 0: no object satisfies it. */
uint32_t noh_smart_hold_ticks(const noh_smart *smart, uint32_t need, uint32_t step_ticks);

#ifdef __cplusplus
}
#endif

#endif
