#include "core/base/trig_internal.h"
#include "noh/low_core.h"

#include <string.h>

#include "core/base/math_internal.h"

#define HALF_PI 1.57079632679489662
#define TURN_PER_RADIAN 683565275.576431634 /* 2^32 / (2 pi) */
#define RADIAN_PER_TURN 1.46291807926715968e-9
#define ANGLE_MAX 1e6f

/* Every angle is a whole number of quarter turns and a rest within pi/4, and a quarter turn swaps sine and cosine but
 * for signs; so two odd and even polynomials over that range are enough. Their coefficients are Chebyshev fits, which
 * spread the error over the range; the leading one is exactly 1, so that small angles keep their relative error. */
static float sin_poly(float x)
{
    float y = x * x;
    return x + x * y * (-0.166666646623f + y * (0.00833274827063f + y * -0.000195878908804f));
}

static float cos_poly(float x)
{
    float y = x * x;
    return (1.0f - 0.5f * y) + y * y * (0.0416666646595f + y * (-0.00138883030359f + y * 2.45479420851e-5f));
}

static void rotate_quarters(uint32_t quarters, float x, float *sine, float *cosine)
{
    float s = sin_poly(x), c = cos_poly(x);
    const float a = quarters & 1u ? c : s, b = quarters & 1u ? s : c;
    *sine = quarters & 2u ? -a : a;
    *cosine = (quarters + 1u) & 2u ? -b : b;
}

static int in_range(float radians)
{
    return radians >= -ANGLE_MAX && radians <= ANGLE_MAX;
}

void noh_sin_cos(float radians, float *sine, float *cosine)
{
    double quarters = in_range(radians) ? (double)radians / HALF_PI : 0.0;
    /* rounded to nearest; in double the rest is exact enough over the whole range */
    int32_t k = (int32_t)(quarters < 0.0 ? quarters - 0.5 : quarters + 0.5);
    rotate_quarters((uint32_t)k, in_range(radians) ? (float)((double)radians - (double)k * HALF_PI) : 0.0f, sine,
                    cosine);
}

void noh_sin_cos_turn(uint32_t turn, float *sine, float *cosine)
{
    uint32_t quarters = (turn + 0x20000000u) >> 30;
    int32_t rest = (int32_t)(turn + 0x20000000u - (quarters << 30)) - 0x20000000;
    rotate_quarters(quarters, (float)((double)rest * RADIAN_PER_TURN), sine, cosine);
}

/* The arc tangent of 0 <= x <= 1. Above tan(pi/8) the angle is counted from pi/4, by atan(x) = pi/4 + atan((x - 1) /
 * (x + 1)), so that the polynomial has to hold for |z| <= tan(pi/8) only. */
static float atan_unit(float x)
{
    float z = x > 0.414213562f ? (x - 1.0f) / (x + 1.0f) : x;
    float y = z * z;
    float a = z + z * y *
                      (-0.333333317612f +
                       y * (0.199995404837f + y * (-0.142639555980f + y * (0.107437314910f + y * -0.0645192820812f))));
    return x > 0.414213562f ? a + 0.785398163f : a;
}

/* Fold the direction into the first eighth of the circle, where the quotient is at most 1, and unfold the angle. */
float noh_atan2(float y, float x)
{
    float ax = x < 0.0f ? -x : x, ay = y < 0.0f ? -y : y;
    float angle;
    if (ax == 0.0f && ay == 0.0f) {
        return 0.0f;
    }
    angle = ay > ax ? 1.57079633f - atan_unit(ax / ay) : atan_unit(ay / ax);
    if (x < 0.0f) {
        angle = NOH_PI - angle;
    }
    return y < 0.0f ? -angle : angle;
}

/* 2^x = 2^whole * 2^f with |f| <= 1/2: the first factor is written into the exponent's bits, the second is a
 * polynomial. */
float noh_exp2(float x)
{
    float clamped = x > 127.999f ? 127.999f : x;
    int32_t whole;
    uint32_t bits;
    float f, power, part;
    if (!(clamped >= -126.0f)) {
        return 0.0f;
    }
    whole = (int32_t)(clamped < 0.0f ? clamped - 0.5f : clamped + 0.5f);
    f = clamped - (float)whole;
    part = 1.0f + f * (0.69314718056f +
                       f * (0.240226509223f +
                            f * (0.0555041088391f +
                                 f * (0.00961805667852f +
                                      f * (0.00133335023862f + f * (0.000154614446986f + f * 1.52973237607e-5f))))));
    if (whole > 127) { /* 2^128 is not a float, 2^128 times a part below 1 is */
        part *= 2.0f;
        whole = 127;
    }
    bits = (uint32_t)(whole + 127) << 23;
    memcpy(&power, &bits, sizeof power);
    return power * part;
}

/* x = m 2^e with m between sqrt(1/2) and sqrt(2), and ln m = 2 artanh z with z = (m - 1) / (m + 1), |z| < 0.172: five
 * terms of the series z + z^3 / 3 + z^5 / 5 + .. leave less than 1e-9. */
float noh_log2(float x)
{
    float m = x, z, square, series;
    int32_t e = 0;
    uint32_t bits;
    if (!(x > 0.0f)) {
        return -150.0f;
    }
    if (m < 1.17549435e-38f) { /* subnormal */
        m *= 16777216.0f;
        e = -24;
    }
    memcpy(&bits, &m, sizeof bits);
    e += (int32_t)(bits >> 23) - 127;
    bits = (bits & 0x7fffffu) | 0x3f800000u;
    memcpy(&m, &bits, sizeof m);
    if (m > 1.41421356f) {
        m *= 0.5f;
        e++;
    }
    z = (m - 1.0f) / (m + 1.0f);
    square = z * z;
    series = 1.0f + square * (1.0f / 3.0f + square * (0.2f + square * (1.0f / 7.0f + square * (1.0f / 9.0f))));
    return (float)e + 2.88539008f * z * series;
}

uint32_t noh_turn_from_radians(float radians)
{
    double turn = in_range(radians) ? (double)radians * TURN_PER_RADIAN : 0.0;
    return (uint32_t)(uint64_t)(int64_t)(turn < 0.0 ? turn - 0.5 : turn + 0.5);
}

float noh_radians_from_turn(uint32_t turn)
{
    return (float)((double)(int32_t)turn * RADIAN_PER_TURN);
}
