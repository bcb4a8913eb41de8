/* place_people.h: the agents of a place (place_file.h) and their kind on a stage, for place_life, place_draw and
 * `noh budget`. */
#ifndef NOH_NOH_CROWD_PLACE_PEOPLE_H
#define NOH_NOH_CROWD_PLACE_PEOPLE_H

#include "file/pack_file.h"
#include "noh/body.h"
#include "noh/crowd.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "place_file.h"

#define PLACE_NEAR 48u     /* feet are placed on the ground */
#define PLACE_RAGDOLLS 16u /* bodies that can fall at once */

/* The kind of a stage with one kind of agents. Do not move it: kind and feet point into it. */
typedef struct place_people {
    noh_kind_desc kind;
    noh_walkers_desc walkers; /* idle and run are not known yet */
    noh_kind_feet feet;
    noh_modifier parts[1];
    noh_kind_ragdoll ragdoll;
    noh_world world;
    noh_plane floor;
    noh_obb boxes[PLACE_STEPS_MAX];
} place_people;

/* The layers of the kind. */
enum { PLACE_BODY, PLACE_ACT, PLACE_LAYERS };

/* agents    0: PLACE_AGENTS
 * ragdolls  bodies that may fall at once; 0: none
 * Prints an error and returns an exit code; 0 on success. */
int place_people_make(place_people *p, const pack_file *file, const place_file *place, uint32_t agents,
                      uint32_t ragdolls);

/* The desc of the place's crowd, with a flow field for each goal, then one for each object, up to the limit. */
void place_crowd_desc(const place_file *place, uint32_t agents, noh_crowd_desc *desc);
/* The smart objects; object_count 0: none. */
void place_smart_desc(const place_file *place, uint32_t agents, noh_smart_desc *desc);

#endif
