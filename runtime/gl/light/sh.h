/* sh.h: real spherical harmonics of order 1 to 6: functions on the sphere as 1, 4, 9, 16, 25 or 36 numbers.
 *
 *   noh_sh_basis         the basis functions in a direction
 *   noh_sh_evaluate      a function, from its coefficients, in a direction
 *   noh_sh_add_sample    projection: one sample of a function
 *   noh_sh_from_zonal    a function symmetric about an axis
 *   noh_sh_convolve      convolution with a kernel symmetric about its axis, by band
 *   noh_sh_cosine_lobe   the kernel of irradiance
 *   noh_sh_rotate        a rotated function
 *
 * Order n has the bands 0 to n - 1, band l has the 2 l + 1 functions m = -l to l, and coefficient (l, m) is number
 * l (l + 1) + m. The functions are orthonormal over the sphere and have no Condon-Shortley phase: band 0 is the
 * constant 0.2821, band 1 is 0.4886 times y, z, x. A zonal function has one coefficient per band, m = 0 about its axis.
 *
 * All functions use only sums, products, quotients and square roots: the same bits on every machine.
 * source   Ramamoorthi, Hanrahan: An efficient representation for irradiance environment maps, SIGGRAPH 2001; Sloan,
 *          Kautz, Snyder: Precomputed radiance transfer, SIGGRAPH 2002; Ivanic, Ruedenberg: Rotation matrices for real
 *          spherical harmonics, J. Phys. Chem. 100, 1996, with the additions and corrections of 102, 1998
 * Threads: no state; any thread. */
#ifndef NOH_LIGHT_SH_H
#define NOH_LIGHT_SH_H

#include <stdint.h>

#include "core/base/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NOH_SH_COUNT(order) ((order) * (order))

/* Compute the basis functions in a direction.
 * shapes  direction[3], basis[NOH_SH_COUNT(order)]
 * ranges  order 1..NOH_SH_ORDER_MAX; direction is unit
 * errors  at most 3e-6 absolute */
void noh_sh_basis(uint32_t order, const float direction[3], float *basis);

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

/* Multiply band l of coefs by bands[l]. For convolution with a symmetric kernel of zonal coefficients k_l, bands[l] =
 * sqrt(4 pi / (2 l + 1)) k_l.
 * source  Funk-Hecke theorem; Ramamoorthi, Hanrahan 2001, equation 5 */
void noh_sh_convolve(uint32_t order, const float *bands, float *coefs);

/* bands[NOH_SH_ORDER_MAX] of the clamped cosine over pi: 1, 2/3, 1/4, 0, -1/24, 0. Convolving radiance with it gives
 * the light reflected by a white matte surface, by its normal. */
extern const float noh_sh_cosine_lobe[NOH_SH_ORDER_MAX];

/* Rotate a function: its value in direction d moves to direction rotation * d.
 * shapes  rotation[9] 3 rows of 3, orthonormal with determinant 1; from, to [NOH_SH_COUNT(order)], to is not from
 * errors  at most 1e-6 of the length of each band
 * source  Ivanic, Ruedenberg 1996 and 1998: band l from bands l - 1 and 1 */
void noh_sh_rotate(uint32_t order, const float rotation[9], const float *from, float *to);

#ifdef __cplusplus
}
#endif

#endif
