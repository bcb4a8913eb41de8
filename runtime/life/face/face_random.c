/* face_random.c: random numbers as functions of a seed, a stream and an index. No generator state is kept, and numbers
 * may be drawn in any order. */
#include "core/base/math_internal.h"
#include "core/base/trig_internal.h"
#include "life/face/face_internal.h"

/* The finaliser of MurmurHash3 (Austin Appleby), twice: each bit of the result depends on each bit of the three
 * inputs. */
static uint32_t mixed(uint32_t h)
{
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return h ^ h >> 16;
}

float noh_face_uniform(uint32_t seed, uint32_t stream, uint32_t index)
{
    const uint32_t h = mixed(mixed(seed * 0x9e3779b9u + stream) + index * 0x7feb352du);
    return ((float)(h >> 9) + 0.5f) / 8388608.0f;
}

static float polynomial(const float *c, int count, float x)
{
    float sum = 0.0f;
    while (count-- > 0) {
        sum = sum * x + c[count];
    }
    return sum;
}

/* Wichura, "Algorithm AS 241: the percentage points of the normal distribution", Applied Statistics 37, 1988: rational
 * functions of q^2 in the middle and of sqrt(-ln p) in the tails. Its short form, about seven digits. */
float noh_face_normal(float uniform)
{
    static const float middle[4] = { 3.3871327179f, 50.434271938f, 159.29113202f, 59.109374720f };
    static const float middle_below[4] = { 1.0f, 17.895169469f, 78.757757664f, 67.187563600f };
    static const float tail[4] = { 1.4234372777f, 2.7568153900f, 1.3067284816f, 0.17023821103f };
    static const float tail_below[3] = { 1.0f, 0.73700164250f, 0.12021132975f };
    const float q = uniform - 0.5f;
    float r, value;
    if (q >= -0.425f && q <= 0.425f) {
        r = 0.180625f - q * q;
        return q * polynomial(middle, 4, r) / polynomial(middle_below, 4, r);
    }
    r = noh_sqrt(-0.69314718f * noh_log2(q < 0.0f ? uniform : 1.0f - uniform)) - 1.6f;
    /* accurate to p = 1e-11: uniform is never nearer to 0 */
    value = polynomial(tail, 4, r) / polynomial(tail_below, 3, r);
    return q < 0.0f ? -value : value;
}

float noh_face_log_normal(float uniform, float mean, float sigma)
{
    /* the mean of exp(mu + sigma n) is exp(mu + sigma^2 / 2) */
    return mean * noh_exp2(1.44269504f * (sigma * noh_face_normal(uniform) - 0.5f * sigma * sigma));
}
