/* sh_internal.h: the factors of spherical harmonics, for shaders that compute the polynomials. Threads: no state. */
#ifndef NOH_LIGHT_SH_INTERNAL_H
#define NOH_LIGHT_SH_INTERNAL_H

#include "noh/low_gl.h"

/* The function's value in a direction.
 * shapes  coefs[NOH_SH_COUNT(order)] */
float noh_sh_evaluate(uint32_t order, const float *coefs, const float direction[3]);

/* Add value * weight in a direction. For a projection, add samples in directions that cover the sphere, with their
 * solid angles as weights, which add up to 4 pi. */
void noh_sh_add_sample(uint32_t order, const float direction[3], float value, float weight, float *coefs);

/* Write coefs[NOH_SH_COUNT(order)] of the zonal function zonal[order], rotated from the z axis to `axis`: each band is
 * the basis in the axis, scaled.
 * source  Sloan, Luna, Snyder: Local, deformable precomputed radiance transfer, SIGGRAPH 2005, equation 3 */
void noh_sh_from_zonal(uint32_t order, const float *zonal, const float axis[3], float *coefs);

/* Rotate a function: its value in direction d moves to direction rotation * d.
 * shapes  rotation[9] 3 rows of 3, orthonormal with determinant 1; from, to [NOH_SH_COUNT(order)], to is not from
 * errors  at most 1e-6 of the length of each band
 * source  Ivanic, Ruedenberg 1996 and 1998: band l from bands l - 1 and 1 */
void noh_sh_rotate(uint32_t order, const float rotation[9], const float *from, float *to);

/* sqrt((2 l + 1) / (4 pi) (l - m)! / (l + m)!), times sqrt(2) for m > 0.
 * ranges  m at most l, l below NOH_SH_ORDER_MAX */
float noh_sh_normalisation(uint32_t l, uint32_t m);

#endif
