/* srgb.h: bytes of a picture and the light that they stand for, by IEC 61966-2-1. */
#ifndef NOH_TESTS_SUPPORT_SRGB_H
#define NOH_TESTS_SUPPORT_SRGB_H

#include <math.h>
#include <stdint.h>

/* Light of 0 to 1, less or more is cut, to 0..255, not rounded. */
static inline double encoded(double linear)
{
    const double c = fmin(fmax(linear, 0.0), 1.0);
    return 255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1.0 / 2.4) - 0.055);
}

static inline double decoded(uint8_t byte)
{
    const double c = byte / 255.0;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

#endif
