/* motion.h: points that move: steps of equal length, two integrators, and distances that are kept.
 *
 *   noh_steps_take       how many fixed steps a frame's time makes
 *   noh_point_move       semi-implicit Euler: first the velocity, then the place
 *   noh_verlet_move      from the last two places, steps of any length
 *   noh_distance_keep    a rod or a spring between two points
 *
 * source   Granberg, Character Animation with Direct3D, 2009, chapter 6, corrected: its Euler gains energy, its Verlet
 *          lacks a square, its spring knows neither stiffness nor mass; Hairer, Lubich, Wanner: Geometric Numerical
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

/* Time that is left over from frame to frame. Zero to begin. */
typedef struct noh_steps {
    uint32_t left;    /* ticks (1/48,000 s) that make no step yet */
    uint32_t dropped; /* ticks that were thrown away, of all calls; stays at the largest number */
} noh_steps;

/* Time passes, and makes steps of step_ticks. What is left is kept for the next call. More than `limit` steps in a
 * call are dropped, and counted: the simulation is slow then, and not slower still the frame after.
 * ranges   step_ticks and limit above 0
 * returns  steps to make now, 0..limit */
uint32_t noh_steps_take(noh_steps *steps, uint32_t ticks, uint32_t step_ticks, uint32_t limit);

/* ---- points ---- */

/* Semi-implicit Euler: keeps energy bounded where v after x lets it grow.
 * shapes  position[3], velocity[3] in and out; acceleration[3] */
void noh_point_move(float position[3], float velocity[3], const float acceleration[3], float seconds);

/* Verlet: x + (x - before) keep h / h' + a h (h + h') / 2, h' the step before; `before` is x afterwards.
 * ranges  seconds and seconds_before above 0; keep 0..1 is the share of its speed that a point keeps in a step */
void noh_verlet_move(float position[3], float before[3], const float acceleration[3], float seconds,
                     float seconds_before, float keep);

/* Move two points towards a distance: each by its share of the inverse masses. Points that are nearer than 1e-6 have no
 * direction and stay, as do two without inverse mass.
 * ranges    inverse_mass 0 (pinned).., compliance in metres per newton: 0 a rod, else 1 / stiffness
 * lambda    of this constraint, 0 at the start of a step; NULL for one iteration
 * returns   by how much they were off */
float noh_distance_keep(float a[3], float inverse_mass_a, float b[3], float inverse_mass_b, float distance,
                        float compliance, float seconds, float *lambda);

#ifdef __cplusplus
}
#endif

#endif
