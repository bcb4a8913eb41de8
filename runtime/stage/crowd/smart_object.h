/* smart_object.h: objects that agents use: a bench to sit on, a stall to eat at, a drum to listen to.
 *
 *   noh_smart_size, noh_smart_init      objects and their agents, in one block
 *   noh_smart_enter, noh_smart_leave    add and remove an agent
 *   noh_smart_ask                       request the best free slot for a need
 *   noh_smart_arrive                    the agent has reached its slot
 *   noh_smart_release                   cancel a request or a use
 *   noh_smart_step                      advance time: needs grow, uses end, free slots are assigned
 *   noh_smart_use_of, noh_smart_most    the phase of an agent; its largest need
 *
 * An object stores where its slots are, the direction to face there, the clips to enter, use and leave a slot, and
 * which need it satisfies at what rate. Agents have needs, 0 to 1, which grow.
 *
 * An agent is in one of these phases:
 *   FREE      no request
 *   WAITING   in the queue for its need, because no slot is free
 *   GOING     a slot is reserved; ends with noh_smart_arrive
 *   ENTERING  for enter_ticks of the slot
 *   USING     until the need is gone, or use_ticks have passed
 *   LEAVING   for leave_ticks; then it is FREE
 * An agent holds its slot alone from GOING to the end of LEAVING. If it does not arrive within the object's
 * going_ticks, it loses the slot and is FREE. noh_smart_leave frees its slot at once.
 *
 * No agent starves: a free slot goes to the agent that has waited longest for its need. With n agents, s slots for a
 * need and no slot held longer than h ticks (noh_smart_hold_ticks), no agent waits longer than ceil(n / s) h.
 *
 * Results do not depend on addresses, and ties are broken by index: the same bits everywhere. The block has no
 * pointers, so a copy continues identically.
 * source  Granberg, Character Animation with Direct3D, 2009, chapter 13 (smart objects, without reservation)
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

/* A place for one agent. Clips are numbers chosen by the game, such as name hashes or indices; 0: none. */
typedef struct noh_smart_slot {
    float at[2];   /* x, z in the world */
    float face[2]; /* direction to face: unit x, z */
    uint32_t enter_clip, use_clip, leave_clip;
    uint32_t enter_ticks, leave_ticks;
    uint32_t use_ticks; /* longest use; above 0 */
} noh_smart_slot;

typedef struct noh_smart_object {
    uint32_t need;                   /* the need it satisfies, 0..need_count - 1 */
    float rate;                      /* satisfaction per second, above 0 */
    uint32_t going_ticks;            /* time to arrive; above 0 */
    uint32_t first_slot, slot_count; /* in the desc's slots */
} noh_smart_object;

typedef struct noh_smart_desc {
    uint32_t agent_max;                /* 1..NOH_CROWD_AGENTS_MAX */
    uint32_t need_count;               /* 1..NOH_SMART_NEEDS_MAX */
    uint32_t object_count;             /* 1..NOH_SMART_OBJECTS_MAX */
    uint32_t slot_count;               /* 1..NOH_SMART_SLOTS_MAX */
    const noh_smart_object *objects;   /* [object_count]; copied by init, like slots */
    const noh_smart_slot *slots;       /* [slot_count] */
    float growth[NOH_SMART_NEEDS_MAX]; /* of each need per second, 0.. */
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

/* The phase of an agent and its slot. */
typedef struct noh_smart_use {
    noh_smart_phase phase;
    uint32_t need;         /* from WAITING on */
    uint32_t object, slot; /* from GOING on; otherwise NOH_NONE. slot: index in the desc's slots */
    uint32_t ticks;        /* in this phase so far */
} noh_smart_use;

typedef struct noh_smart noh_smart;

/* The exact bytes: 160, plus 20 per object, 44 per slot, and per agent 36 and 4 per need; rounded up to 16. 0 for an
 * invalid desc. */
size_t noh_smart_size(const noh_smart_desc *desc);

/* Build smart objects without agents.
 * errors  ARG memory is NULL or misaligned, a number is out of range (where: the object or slot), or a slot belongs to
 *         no object or to two; LIMIT; MEMORY memory is too small */
noh_result noh_smart_init(void *memory, size_t bytes, const noh_smart_desc *desc, noh_smart **smart, noh_error *error);

/* Add an agent, FREE, replacing the agent at this index.
 * needs   [need_count] clamped to 0..1; NULL: all 0 */
void noh_smart_enter(noh_smart *smart, uint32_t agent, const float *needs);
/* Remove an agent in any phase and free its slot. */
void noh_smart_leave(noh_smart *smart, uint32_t agent);

/* Request a slot for a need of a FREE agent. The object with a free slot and the largest rate / (1 + distance in
 * metres) is chosen, and its nearest free slot; but if other agents already wait for this need, the agent queues behind
 * them.
 * at       [2] the agent's position, x, z
 * returns  1: it is now GOING or WAITING; 0: it was not FREE, or no object satisfies the need; nothing has changed */
int noh_smart_ask(noh_smart *smart, uint32_t agent, uint32_t need, const float at[2]);
/* Report that an agent has reached its slot.
 * returns  1: it was GOING and is now ENTERING; 0: nothing has changed */
int noh_smart_arrive(noh_smart *smart, uint32_t agent);
/* Cancel the request of an agent, which is then FREE; an agent that has arrived is then LEAVING.
 * returns  1: its phase has changed */
int noh_smart_release(noh_smart *smart, uint32_t agent);

/* Advance time: needs grow or are satisfied, phases end, and free slots go to waiting agents. Phases that end during
 * the step count as ending at its end. */
void noh_smart_step(noh_smart *smart, uint32_t ticks);

void noh_smart_use_of(const noh_smart *smart, uint32_t agent, noh_smart_use *use);
/* An agent's needs [need_count]; NULL: there is no such agent. */
const float *noh_smart_needs(const noh_smart *smart, uint32_t agent);
/* The agent's largest need that some object satisfies, the first of equal ones; NOH_NONE: none is above `least`. */
uint32_t noh_smart_most(const noh_smart *smart, uint32_t agent, float least);

/* A slot and an object, as in the desc. */
const noh_smart_slot *noh_smart_slot_at(const noh_smart *smart, uint32_t slot);
const noh_smart_object *noh_smart_object_at(const noh_smart *smart, uint32_t object);
/* The agent that holds a slot; NOH_NONE: it is free. */
uint32_t noh_smart_holder(const noh_smart *smart, uint32_t slot);

/* The longest time that a slot for a need may be held, with steps of at most `step_ticks`; the bound on waiting follows
 * from it. 0: no object satisfies the need. */
uint32_t noh_smart_hold_ticks(const noh_smart *smart, uint32_t need, uint32_t step_ticks);

#ifdef __cplusplus
}
#endif

#endif
