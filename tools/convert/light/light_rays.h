/* light_rays.h: the visible sky of a vertex, by rays in directions that cover the sphere evenly. */
#ifndef NOH_CONVERT_LIGHT_LIGHT_RAYS_H
#define NOH_CONVERT_LIGHT_LIGHT_RAYS_H

#include "light_surface.h"

/* Directions of a spherical Fibonacci lattice, and the basis in each.
 * source  Gonzalez: Measurement of areas on a sphere using Fibonacci and latitude-longitude lattices, 2010 */
typedef struct light_rays {
    uint32_t count;
    float *directions; /* [count][3] */
    float *basis;      /* [count][NOH_SH_COUNT_MAX] */
} light_rays;

/* Returns 1 when out of memory. */
int light_rays_make(uint32_t count, light_rays *out);
void light_rays_free(light_rays *r);

/* The share of a direction's light that a matte surface reflects: the cosine to the normal over the sum of cosines of
 * all directions, so that white light from everywhere reflects as exactly 1. 0 behind the surface. */
float light_rays_sum(const light_rays *r, const float normal[3]); /* of the cosines */

/* Which directions in front of a vertex are blocked: blocked[count] 1, else 0. */
void light_rays_blocked(const light_rays *r, const light_surface *s, uint32_t vertex, uint8_t *blocked);

/* The transfer of a vertex, order 6: the cosine lobe about its normal, exact, minus the blocked part.
 * shapes  transfer[NOH_SH_COUNT_MAX]; blocked[count] as scratch
 * source  Sloan, Kautz, Snyder: Precomputed radiance transfer, SIGGRAPH 2002, equation 9 */
void light_rays_transfer(const light_rays *r, const light_surface *s, uint32_t vertex, uint8_t *blocked,
                         float *transfer);

/* Add what reaches a vertex by one reflection: where a triangle of the same mesh blocks a ray with its
 * front, `albedo` times the value there, interpolated between its corners. Other meshes and backs reflect nothing.
 * shapes  blocked[count] of light_rays_blocked; values[vertex_count][stride]; sums[stride] */
void light_rays_bounce(const light_rays *r, const light_surface *s, uint32_t vertex, const uint8_t *blocked,
                       float albedo, const float *values, uint32_t stride, float *sums);

#endif
