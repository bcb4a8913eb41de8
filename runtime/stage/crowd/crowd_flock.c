/* crowd_flock.c: agents of a crowd by the rules of low_stage.h. */
#include "stage/crowd/crowd_internal.h"

#include "noh/crowd.h"
#include "noh/low_stage.h"

#define ACCELERATION 3.0f /* times the speed, per second */

/* Those that are near: posts, and the nearest points of walls. */
static void avoid_obstacles(const noh_crowd *c, const crowd_body *b, float force[2])
{
    const noh_crowd_obstacle *obstacles = CROWD_CONST(noh_crowd_obstacle, c, obstacle);
    const uint16_t *near = NULL;
    const uint32_t count = noh_crowd_near_of(c, b->at, &near);
    for (uint32_t k = 0; k < count; k++) {
        const noh_crowd_obstacle *o = &obstacles[near[k]];
        const vec2 away = noh_crowd_away_from(o, b->at);
        const float to[2] = { -away.x, -away.z };
        noh_flock_avoid(to, o->radius + b->radius, force);
    }
}

vec2 noh_crowd_flock(const noh_crowd *c, uint32_t rank, const crowd_runs *runs, vec2 wish, float speed)
{
    const crowd_body *bodies = CROWD_CONST(crowd_body, c, body), *b = &bodies[rank];
    const vec2 *velocities = CROWD_CONST(vec2, c, plan[1]);
    const uint16_t *names = CROWD_CONST(uint16_t, c, neighbor) + (size_t)rank * CROWD_NEIGHBORS;
    float to[CROWD_NEIGHBORS][2], other[CROWD_NEIGHBORS][2], force[2] = { wish.x, wish.z };
    float velocity[2] = { velocities[rank].x, velocities[rank].z };
    uint32_t count;
    for (count = 0; count < CROWD_NEIGHBORS && names[count] != CROWD_NO_NEIGHBOR; count++) {
        const uint32_t j = noh_crowd_rank_of(runs, names[count]);
        to[count][0] = bodies[j].at.x - b->at.x;
        to[count][1] = bodies[j].at.z - b->at.z;
        other[count][0] = velocities[j].x;
        other[count][1] = velocities[j].z;
        noh_flock_repel(to[count], force);
    }
    if (b->item & CROWD_FLOCK) noh_flock_join(velocity, to[0], other[0], count, force);
    avoid_obstacles(c, b, force);
    noh_flock_turn(velocity, force, speed, ACCELERATION * speed, CROWD_STEP_S);
    return v2(velocity[0], velocity[1]);
}
