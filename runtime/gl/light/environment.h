/* environment.h: environment light, as a short description and as spherical harmonics.
 *
 *   noh_environment_find, noh_environment_at   built-in environments: white, studio, room, sky
 *   noh_environment_radiance                   radiance from a direction
 *   noh_light_from_environment                 its spherical harmonics, exact
 *   noh_light_rotate                           rotated light
 *   noh_light_irradiance                       light reflected by a white matte surface, by its normal
 *   noh_light_key                              split into one directional light and the rest
 *
 * An environment is an ambient radiance, up to eight lamps and up to two windows. A lamp is round: its radiance at the
 * angle a from its direction is colour * s^power, s = (cos a - edge) / (1 - edge), and 0 where s is not above 0. Its
 * spherical harmonics have a closed form. A window is an upright rectangle of uniform panes with dark bars around each,
 * as reflected in eyes. Its panes are integrated numerically, almost exactly.
 *
 * Radiance is linear RGB; a white matte surface under radiance 1 from all directions reflects 1. Y is up, +Z is towards
 * a viewer in front of the character.
 * Threads: no state; any thread. */
#ifndef NOH_LIGHT_ENVIRONMENT_H
#define NOH_LIGHT_ENVIRONMENT_H

#include <stdint.h>

#include "gl/light/sh.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_ENVIRONMENT_COUNT 4u

typedef struct noh_lamp {
    float direction[3]; /* unit, towards the lamp */
    float edge;         /* cosine of its half angle, -1 to below 1: 0 is a hemisphere */
    uint32_t power;     /* 0: uniform with a sharp edge; 1, 2: softer */
    float color[3];     /* radiance at its centre */
} noh_lamp;

/* An upright rectangle on the plane at distance 1. */
typedef struct noh_window {
    float direction[3]; /* unit, towards its centre; the plane is perpendicular to it */
    float half[2];      /* half of width and height on the plane; 0.5: 53 degrees in all */
    uint32_t panes[2];  /* columns and rows, 1..4 each */
    float bar;          /* share of a pane's width and height taken by bars, 0 to below 1 */
    float color[3];     /* radiance of the panes, added to the surroundings */
} noh_window;

typedef struct noh_environment {
    const char *name;
    float ambient[3];
    uint32_t lamp_count;
    noh_lamp lamps[NOH_LAMPS_MAX];
    uint32_t window_count;
    noh_window windows[NOH_WINDOWS_MAX];
} noh_environment;

/* Light as spherical harmonics of radiance, with red, green and blue per coefficient. */
typedef struct noh_light {
    uint32_t order; /* 1..NOH_SH_ORDER_MAX */
    float coefs[NOH_SH_COUNT_MAX][3];
} noh_light;

/* The index of a built-in environment by name; NOH_NONE if there is none. */
uint32_t noh_environment_find(const char *name);
/* A built-in environment.
 * ranges  index below NOH_ENVIRONMENT_COUNT */
const noh_environment *noh_environment_at(uint32_t index);

/* The radiance from a direction.
 * ranges  direction is unit */
void noh_environment_radiance(const noh_environment *environment, const float direction[3], float rgb[3]);

/* Compute the spherical harmonics of an environment.
 * ranges  order 1..NOH_SH_ORDER_MAX; lamp_count at most NOH_LAMPS_MAX, powers at most 2
 * errors  at most 3e-6 of the sum of the lamp colours; for windows with half below 0.7, 1e-5 of the window colours
 * source  the integral over a lamp is of a polynomial of degree at most 7, which Gauss-Legendre quadrature with four
 *         nodes integrates exactly (Abramowitz, Stegun: 25.4.29) */
void noh_light_from_environment(const noh_environment *environment, uint32_t order, noh_light *light);

/* Rotate light.
 * ranges  rotation as in noh_sh_rotate; to is not from */
void noh_light_rotate(const noh_light *from, const float rotation[9], noh_light *to);

/* The light reflected by a white matte surface, without shadows: convolution with the clamped cosine at the light's
 * order. May be below 0 opposite a sharp lamp, by a few per cent of it.
 * ranges  normal is unit */
void noh_light_irradiance(const noh_light *light, const float normal[3], float rgb[3]);

/* Split light into a directional key light, which can cast shadows, and the smallest possible rest. Key and rest add up
 * to the light in every coefficient.
 * direction  unit, towards the key light, the main direction of luminance
 * rgb        key light reflected by a white matte surface facing it; zeros if light has no direction
 * rest       must not be light
 * ranges     light's order at least 2
 * source     Sloan: Stupid spherical harmonics (SH) tricks, GDC 2008, Extracting conventional lights from SH */
void noh_light_key(const noh_light *light, float direction[3], float rgb[3], noh_light *rest);

#ifdef __cplusplus
}
#endif

#endif
