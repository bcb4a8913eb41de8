/* crowd_measure.h: measures agents: overlaps, and agents that could walk but stand. */
#ifndef NOH_NOH_CROWD_CROWD_MEASURE_H
#define NOH_NOH_CROWD_CROWD_MEASURE_H

#include "crowd_scene.h"
#include "noh/crowd.h"

/* Agents by cells, rebuilt in each step. */
typedef struct crowd_meter {
    uint32_t *head, *next; /* [CROWD_METER_SIDE^2], [count] */
    uint32_t *slow, *held; /* [count]: steps so far of standing with room in front, of standing at all */
    uint32_t count;
} crowd_meter;

#define CROWD_METER_SIDE 256u

/* returns 0 when out of memory: close it in any case */
int crowd_meter_open(crowd_meter *meter, uint32_t count);
void crowd_meter_close(crowd_meter *meter);

/* Add a step: before[count] and now[count] are the agents on both sides of it; ahead[count], unit vectors: their
 * wanted directions. */
void crowd_meter_add(crowd_meter *meter, const noh_crowd_agent *before, const noh_crowd_agent *now,
                     const float (*ahead)[2], crowd_measures *m);

#endif
