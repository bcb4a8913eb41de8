/* quarter.c: quarter turns about y. */
#include "core/base/quarter_internal.h"

uint32_t noh_quarter_of(float x, float z)
{
    if (x * x > z * z) return x > 0.0f ? 1u : 3u;
    return z < 0.0f ? 2u : 0u;
}

void noh_quarter_turn(uint32_t quarter, const float in[3], float out[3])
{
    static const float turns[5] = { 0.0f, 1.0f, 0.0f, -1.0f, 0.0f }; /* sines; a cosine is the next one */
    const float sine = turns[quarter & 3u], cosine = turns[(quarter & 3u) + 1u], x = in[0], z = in[2];
    out[0] = cosine * x + sine * z;
    out[1] = in[1];
    out[2] = cosine * z - sine * x;
}
