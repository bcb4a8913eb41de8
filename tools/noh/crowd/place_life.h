/* place_life.h: agents in a place (place_file.h): they walk from goal to goal along flow fields, and use objects to
 * satisfy their needs. */
#ifndef NOH_NOH_CROWD_PLACE_LIFE_H
#define NOH_NOH_CROWD_PLACE_LIFE_H

#include "crowd_measure.h"
#include "place_file.h"
#include "noh/crowd.h"

typedef struct place_life place_life;

/* place  must outlive it. agents 0: PLACE_AGENTS. Prints an error and returns an exit code; 0 on success. */
int place_life_open(const place_file *place, uint32_t agents, uint32_t seed, place_life **life);
void place_life_close(place_life *l);

/* One step of 1/30 s, with the decisions of all agents. */
void place_life_step(place_life *l);

/* An agent has fallen, or is on its feet again: a fallen agent has no needs, and releases its slot. */
void place_life_set_down(place_life *l, uint32_t index, int is_down);

/* Results so far. `done`: the time at which each agent had reached a goal or a slot. */
const crowd_measures *place_life_measures(const place_life *l);
uint32_t place_life_agents(const place_life *l);
uint32_t place_life_steps(const place_life *l);
size_t place_life_bytes(const place_life *l); /* of the crowd and what it uses */
double place_life_cpu_ns(const place_life *l);
uint32_t place_life_hash(const place_life *l); /* hash of the agents and of the holders of slots */
noh_crowd *place_life_crowd(const place_life *l);
const noh_crowd_agent *place_life_agent(const place_life *l, uint32_t index);
/* phase NOH_SMART_AWAY in a place without objects */
noh_smart_use place_life_use(const place_life *l, uint32_t index);
const noh_smart_slot *place_life_slot(const place_life *l, uint32_t slot);

#endif
