/* flock.h: flocking rules: away from neighbours and obstacles, along with neighbours, towards a goal. Vectors are on
 * the ground, x and z.
 *
 *   noh_flock_repel      away from a neighbour
 *   noh_flock_avoid      away from a round obstacle
 *   noh_flock_apart      half of the correction of an overlap
 *   noh_flock_join       along with neighbours, and towards their centre
 *   noh_flock_turn       turns the velocity towards the wish
 *
 * Agents of a crowd with NOH_CROWD_FORCES or NOH_CROWD_FLOCK follow these rules instead of planning ahead. The rules
 * suit few agents, and flocks; in dense crowds agents hardly advance, because repulsion outweighs the goal.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 13, with corrections (its repulsion vanishes at
 *          contact, its obstacles attract, its overlaps are resolved in place, its sums are normalised); Reynolds:
 *          Flocks, herds, and schools, 1987 (noh_flock_join)
 * Threads: no state; any thread. */
#ifndef NOH_CROWD_FLOCK_H
#define NOH_CROWD_FLOCK_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_FLOCK_RANGE 3.0f     /* metres within which neighbours repel each other */
#define NOH_FLOCK_REPULSION 5.0f /* metres per second squared, at contact of centres */
#define NOH_FLOCK_AVOIDANCE 10.0f

/* Add the repulsion of a neighbour: -5 (1 - d / 3) along the unit vector to it, for a distance d below 3. For d = 0
 * nothing is added.
 * shapes  to[2] from here to the neighbour; force[2] in and out */
void noh_flock_repel(const float to[2], float force[2]);

/* Add the repulsion of an obstacle of radius r: 10 (1 - d / 3 r) away from its centre, for a distance d below 3 r. For
 * d = 0 nothing is added.
 * shapes  to[2] from here to its centre; force[2] in and out */
void noh_flock_avoid(const float to[2], float radius, float force[2]);

/* Add half of the movement that separates two agents nearer than `size`; the neighbour adds the other half. At the same
 * position the direction follows from their ids.
 * shapes   to[2] from here to the neighbour; move[2] in and out
 * returns  1 if they overlap */
int noh_flock_apart(const float to[2], float size, uint32_t id, uint32_t other, float move[2]);

/* Add alignment and cohesion: the mean velocity of neighbours minus the agent's own, and the vector to their centre,
 * each per second.
 * shapes  velocity[2]; to[count][2], velocities[count][2]; force[2] in and out */
void noh_flock_join(const float velocity[2], const float *to, const float *velocities, uint32_t count, float force[2]);

/* Change the velocity by at most `acceleration` * seconds towards the wish, clamped to `speed`. The agent may walk
 * slowly or stop, and results do not depend on the step length.
 * shapes  velocity[2] in and out; wish[2] metres per second */
void noh_flock_turn(float velocity[2], const float wish[2], float speed, float acceleration, float seconds);

#ifdef __cplusplus
}
#endif

#endif
