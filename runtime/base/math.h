/* math.h: the little that the library needs, without libm.
 *
 * Square roots are the processor's (correctly rounded everywhere); everything
 * else is plain +, -, * and /, with contraction off, so that results are the
 * same bits on every machine. */
#ifndef NOH_BASE_MATH_H
#define NOH_BASE_MATH_H

/* Built with -fno-math-errno this is one instruction, not a call; the symbol
 * check in `make check` proves it. */
static inline float noh_sqrt(float x)
{
    return __builtin_sqrtf(x);
}

static inline float noh_dot3(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Make v unit; a vector too short to have a direction becomes `fallback`. */
static inline void noh_normalize3(float v[3], const float fallback[3])
{
    float square = noh_dot3(v, v);
    if (square > 1e-30f) {
        float inverse = 1.0f / noh_sqrt(square);
        v[0] *= inverse;
        v[1] *= inverse;
        v[2] *= inverse;
    } else {
        v[0] = fallback[0];
        v[1] = fallback[1];
        v[2] = fallback[2];
    }
}

#endif
