/* environment.h: light from all around, as a short description and as spherical harmonics.
 *
 *   noh_environment_find, noh_environment_at   the built-in ones: white, studio, room, sky
 *   noh_environment_radiance                   what comes from a direction
 *   noh_light_from_environment                 its spherical harmonics, exact
 *   noh_light_rotate                           the same, turned
 *   noh_light_irradiance                       what a white matte surface reflects, by its normal alone
 *   noh_light_key                              taken apart: one directional light, and the rest
 *
 * An environment is an ambient radiance, up to eight lamps and up to two windows. A lamp is round: its radiance at the
 * angle a from its direction is colour * s^power, s = (cos a - edge) / (1 - edge), and nothing where s is not above 0.
 * Such a lamp's spherical harmonics have a closed form. A window is an upright rectangle of even panes, with dark bars
 * round each: what an eye reflects of a room. Its panes are integrated by a rule that is as good as exact.
 *
 * Radiance is linear RGB; a white matte surface under radiance 1 from everywhere reflects 1. Y is up, +Z is towards
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
    uint32_t power;     /* 0: even with a sharp edge; 1, 2: softer */
    float color[3];     /* radiance in its middle */
} noh_lamp;

/* Upright rectangle on the plane at distance 1. */
typedef struct noh_window {
    float direction[3]; /* unit, towards its middle; the plane is perpendicular to it */
    float half[2];      /* width and height over 2, on that plane: 0.5 is half of 53 degrees */
    uint32_t panes[2];  /* columns and rows, 1..4 each */
    float bar;          /* share of a pane's width and height that its bars take, 0 to below 1 */
    float color[3];     /* radiance of the panes, above that of what is around */
} noh_window;

typedef struct noh_environment {
    const char *name;
    float ambient[3];
    uint32_t lamp_count;
    noh_lamp lamps[NOH_LAMPS_MAX];
    uint32_t window_count;
    noh_window windows[NOH_WINDOWS_MAX];
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
 * errors  at most 3e-6 of the sum of the colours; windows with half below 0.7: 1e-5 of theirs
 * source  the integral over a lamp is one of a polynomial of degree 7 at most, which Gauss-Legendre quadrature with
 * four nodes has exactly (Abramowitz, Stegun: 25.4.29) */
void noh_light_from_environment(const noh_environment *environment, uint32_t order, noh_light *light);

/* ranges  rotation as in noh_sh_rotate; to is not from */
void noh_light_rotate(const noh_light *from, const float rotation[9], noh_light *to);

/* Light of the order that it has, convolved with the clamped cosine: without shadows. May be below 0 behind a sharp
 * lamp, by a few per cent of it.
 * ranges  normal is unit */
void noh_light_irradiance(const noh_light *light, const float normal[3], float rgb[3]);

/* Take the directional light out that leaves the least: a key light, which can cast a shadow. Key and rest together are
 * the light, in every coefficient.
 * direction  unit, towards it: where most of the luminance comes from
 * rgb        what a white matte surface that faces it reflects of it; zeros where light has no direction
 * rest       is not light
 * ranges     light's order at least 2
 * source     Sloan: Stupid spherical harmonics (SH) tricks, GDC 2008, Extracting conventional lights from SH */
void noh_light_key(const noh_light *light, float direction[3], float rgb[3], noh_light *rest);

#ifdef __cplusplus
}
#endif

#endif
