/* motion.h: point masses: fixed time steps, two integrators, and distance constraints.
 *
 *   noh_steps_take       number of fixed steps in a frame's time
 *   noh_point_move       semi-implicit Euler: first velocity, then position
 *   noh_verlet_move      from the last two positions, steps of any length
 *   noh_distance_keep    a rod or a spring between two points
 *
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 6, corrected: its Euler gains energy, its Verlet
 *          lacks a square, its spring has neither stiffness nor mass; Hairer, Lubich, Wanner: Geometric Numerical
 *          Integration, 2006, section I.1; Macklin, Mueller, Chentanez: XPBD, 2016
 * Threads: no state; any thread. */
#ifndef NOH_SIM_MOTION_H
#define NOH_SIM_MOTION_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_GRAVITY 9.82f /* metres per second squared */

/* ---- time ---- */

/* Time left over from frame to frame. Initialise to zero. */
typedef struct noh_steps {
    uint32_t left;    /* ticks (1/48,000 s) short of a full step */
    uint32_t dropped; /* ticks dropped by all calls; saturates */
} noh_steps;

/* Convert elapsed time to steps of step_ticks; the remainder is kept for the next call. More than `limit` steps in a
 * call are dropped and counted: the simulation then runs slow, but the next frame does not get slower still.
 * ranges   step_ticks and limit above 0
 * returns  steps to make now, 0..limit */
uint32_t noh_steps_take(noh_steps *steps, uint32_t ticks, uint32_t step_ticks, uint32_t limit);

/* ---- points ---- */

/* Advance a point by semi-implicit Euler, which keeps energy bounded; updating the position first lets it grow.
 * shapes  position[3], velocity[3] in and out; acceleration[3] */
void noh_point_move(float position[3], float velocity[3], const float acceleration[3], float seconds);

/* Advance a point by Verlet: x + (x - before) keep h / h' + a h (h + h') / 2, h' the previous step. Afterwards `before`
 * is the old x.
 * ranges  seconds and seconds_before above 0; keep 0..1 is the share of its velocity that a point keeps per step */
void noh_verlet_move(float position[3], float before[3], const float acceleration[3], float seconds,
                     float seconds_before, float keep);

/* Move two points towards a distance, in proportion to their inverse masses. Points closer than 1e-6 have no direction
 * and stay, as do two points without inverse mass.
 * ranges    inverse_mass 0 (pinned).., compliance in metres per newton: 0 a rod, else 1 / stiffness
 * lambda    of this constraint, 0 at the start of a step; NULL for a single iteration
 * returns   the error in distance before the move */
float noh_distance_keep(float a[3], float inverse_mass_a, float b[3], float inverse_mass_b, float distance,
                        float compliance, float seconds, float *lambda);

#ifdef __cplusplus
}
#endif

#endif
