/* place_people.h: who lives in a place (place_file.h), as agents and as a kind of a stage: what place_life makes of
 * them, place_draw draws, and `noh budget` counts. */
#ifndef NOH_NOH_CROWD_PLACE_PEOPLE_H
#define NOH_NOH_CROWD_PLACE_PEOPLE_H

#include "file/pack_file.h"
#include "noh/body.h"
#include "noh/crowd.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "place_file.h"

#define PLACE_NEAR 48u     /* whose feet are put on the ground */
#define PLACE_RAGDOLLS 16u /* who falls at once, where something makes them */

/* Of a stage with one kind of them. Do not move it: kind and feet point into it. */
typedef struct place_people {
    noh_kind_desc kind;
    noh_walkers_desc walkers; /* idle and run are not known yet */
    noh_kind_feet feet;
    noh_stage_part parts[1];
    noh_kind_ragdoll ragdoll;
    noh_world world;
    noh_plane floor;
    noh_obb boxes[PLACE_STEPS_MAX];
} place_people;

/* The layers of the kind. */
enum { PLACE_BODY, PLACE_ACT, PLACE_LAYERS };

/* agents    0: PLACE_AGENTS
 * ragdolls  of them that may fall at once; 0: none does
 * Prints an error and returns an exit code; 0 on success. */
int place_people_make(place_people *p, const pack_file *file, const place_file *place, uint32_t agents,
                      uint32_t ragdolls);

/* Of the place's crowd, with a flow field for each goal, then one for each object, as many as there may be. */
void place_crowd_desc(const place_file *place, uint32_t agents, noh_crowd_desc *desc);
/* Of what it uses; object_count 0: nothing. */
void place_smart_desc(const place_file *place, uint32_t agents, noh_smart_desc *desc);

#endif
