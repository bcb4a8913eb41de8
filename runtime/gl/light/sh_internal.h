/* sh_internal.h: the factors of spherical harmonics, for shaders that compute the polynomials. Threads: no state. */
#ifndef NOH_LIGHT_SH_INTERNAL_H
#define NOH_LIGHT_SH_INTERNAL_H


/* sqrt((2 l + 1) / (4 pi) (l - m)! / (l + m)!), times sqrt(2) for m > 0.
 * ranges  m at most l, l below NOH_SH_ORDER_MAX */
float noh_sh_normalisation(uint32_t l, uint32_t m);

#endif
