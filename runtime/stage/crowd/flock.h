/* flock.h: the rules by which each of a flock steers by itself: away from neighbours and obstacles, along with the
 * others, towards a goal. Vectors are on the ground, x and z.
 *
 *   noh_flock_repel      away from a neighbour
 *   noh_flock_avoid      away from a round obstacle
 *   noh_flock_apart      half of the way out of an overlap
 *   noh_flock_join       along with neighbours, and to the middle of them
 *   noh_flock_turn       the velocity, a step nearer to what all of that asks for
 *
 * Agents of a crowd with NOH_CROWD_FORCES or NOH_CROWD_FLOCK follow these rules in place of plans that look ahead. They
 * suit few, and flocks: in a crowd they hardly get on, since repulsion drowns the goal.
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 13, corrected: its repulsion vanishes at contact,
 *          its obstacles attract, its overlaps are resolved in place, its sums lose their size; Reynolds: Flocks,
 *          herds, and schools, 1987 (noh_flock_join)
 * Threads: no state; any thread. */
#ifndef NOH_CROWD_FLOCK_H
#define NOH_CROWD_FLOCK_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_FLOCK_RANGE 3.0f     /* metres in which neighbours repel each other */
#define NOH_FLOCK_REPULSION 5.0f /* metres per second squared, at contact of centres */
#define NOH_FLOCK_AVOIDANCE 10.0f

/* Add -5 (1 - d / 3) along the unit vector to the neighbour, at a distance d below 3.
 * shapes  to[2] from here to the neighbour; force[2] in and out. Without a direction (d 0) nothing is added */
void noh_flock_repel(const float to[2], float force[2]);

/* Add 10 (1 - d / 3 r) away from the centre of an obstacle of radius r, at a distance d below 3 r.
 * shapes  to[2] from here to its centre; force[2] in and out. Without a direction nothing is added */
void noh_flock_avoid(const float to[2], float radius, float force[2]);

/* Half of what parts two that are nearer than `size`; the other half is the neighbour's, who finds the same by itself.
 * In one place they part along a direction that follows from their ids.
 * shapes   to[2] from here to the neighbour; move[2] in and out
 * returns  1 where they overlap */
int noh_flock_apart(const float to[2], float size, uint32_t id, uint32_t other, float move[2]);

/* Add what makes a flock: the mean velocity of neighbours less one's own, and towards the middle of them, each per
 * second.
 * shapes  velocity[2]; to[count][2], velocities[count][2]; force[2] in and out */
void noh_flock_join(const float velocity[2], const float *to, const float *velocities, uint32_t count, float force[2]);

/* The velocity changes by at most `acceleration` * seconds towards the wish, whose length is at most `speed`: so it may
 * be slow, and stop, and a second is a second in steps of any length.
 * shapes  velocity[2] in and out; wish[2] metres per second */
void noh_flock_turn(float velocity[2], const float wish[2], float speed, float acceleration, float seconds);

#ifdef __cplusplus
}
#endif

#endif
