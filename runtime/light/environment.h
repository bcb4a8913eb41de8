/* environment.h: light from all around, as a short description and as spherical harmonics.
 *
 *   noh_environment_find, noh_environment_at   the built-in ones: white, studio, room, sky
 *   noh_environment_radiance                   what comes from a direction
 *   noh_light_from_environment                 its spherical harmonics, exact
 *   noh_light_rotate                           the same, turned
 *   noh_light_irradiance                       what a white matte surface reflects, by its normal alone
 *
 * An environment is an ambient radiance and up to eight lamps. A lamp is round: its radiance at the angle a from its
 * direction is colour * s^power, s = (cos a - edge) / (1 - edge), and nothing where s is not above 0. Such a lamp's
 * spherical harmonics have a closed form, so nothing is sampled.
 *
 * Radiance is linear RGB; a white matte surface under radiance 1 from everywhere reflects 1. Y is up, +Z is towards
 * the viewer who sees a character from the front.
 * Threads: no state; any thread. */
#ifndef NOH_LIGHT_ENVIRONMENT_H
#define NOH_LIGHT_ENVIRONMENT_H

#include <stdint.h>

#include "light/sh.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_ENVIRONMENT_COUNT 4u

typedef struct noh_lamp {
    float direction[3]; /* unit, towards the lamp */
    float edge;         /* cosine of its half angle, -1 to below 1: 0 is a hemisphere */
    uint32_t power;     /* 0: even with a sharp edge; 1, 2: softer */
    float color[3];     /* radiance in its middle */
} noh_lamp;

typedef struct noh_environment {
    const char *name;
    float ambient[3];
    uint32_t lamp_count;
    noh_lamp lamps[NOH_LAMPS_MAX];
} noh_environment;

/* Light as spherical harmonics of radiance, three numbers a coefficient: red, green, blue. */
typedef struct noh_light {
    uint32_t order; /* 1..NOH_SH_ORDER_MAX */
    float coefs[NOH_SH_COUNT_MAX][3];
} noh_light;

/* The index of a built-in environment; NOH_NONE when there is none of that name. */
uint32_t noh_environment_find(const char *name);
/* ranges  index below NOH_ENVIRONMENT_COUNT */
const noh_environment *noh_environment_at(uint32_t index);

/* ranges  direction is unit */
void noh_environment_radiance(const noh_environment *environment, const float direction[3], float rgb[3]);

/* ranges  order 1..NOH_SH_ORDER_MAX; lamp_count at most NOH_LAMPS_MAX, powers at most 2
 * errors  at most 3e-6 of the sum of the colours
 * source  the integral over a lamp is one of a polynomial of degree 7 at most, which Gauss-Legendre quadrature with
 * four nodes has exactly (Abramowitz, Stegun: 25.4.29) */
void noh_light_from_environment(const noh_environment *environment, uint32_t order, noh_light *light);

/* ranges  rotation as in noh_sh_rotate; to is not from */
void noh_light_rotate(const noh_light *from, const float rotation[9], noh_light *to);

/* Light of the order that it has, convolved with the clamped cosine: without shadows. May be below 0 behind a sharp
 * lamp, by a few per cent of it.
 * ranges  normal is unit */
void noh_light_irradiance(const noh_light *light, const float normal[3], float rgb[3]);

#ifdef __cplusplus
}
#endif

#endif
