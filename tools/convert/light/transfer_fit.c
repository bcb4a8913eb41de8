#include "transfer_fit.h"

#include <math.h>
#include <string.h>

#include "core/base/octahedral_internal.h"
#include "noh/low_gl.h"

void transfer_axis(const float *transfer, const float fallback[3], float axis[3])
{
    const float x = transfer[3], y = transfer[1], z = transfer[2], length = sqrtf(x * x + y * y + z * z);
    if (length < 1e-6f) {
        memcpy(axis, fallback, 3u * sizeof *axis);
        return;
    }
    axis[0] = x / length;
    axis[1] = y / length;
    axis[2] = z / length;
}

/* t_l = 4 pi / (2 l + 1) sum over m of T_lm Y_lm(axis), which is the integral of the transfer times P_l of the angle to
 * the axis. */
void transfer_lobe(const float *transfer, const float axis[3], noh_lobe *lobe)
{
    float basis[NOH_SH_COUNT_MAX], integrals[NOH_SH_ORDER_MAX];
    noh_sh_basis(NOH_SH_ORDER_MAX, axis, basis);
    for (uint32_t l = 0; l < NOH_SH_ORDER_MAX; l++) {
        integrals[l] = 0.0f;
        for (uint32_t k = l * l; k < (l + 1u) * (l + 1u); k++) {
            integrals[l] += transfer[k] * basis[k];
        }
        integrals[l] *= 12.5663706f / (float)(2u * l + 1u);
    }
    memcpy(lobe->axis, axis, sizeof lobe->axis);
    lobe->occlusion = integrals[0];
    for (uint32_t l = 0; l < NOH_SH_ORDER_MAX; l++) {
        lobe->shape[l] = integrals[0] > 1e-6f ? integrals[l] / integrals[0] : l == 0 ? 1.0f : 0.0f;
    }
}

static uint8_t signed_byte(float value)
{
    const float scaled = roundf(127.0f * value);
    return (uint8_t)(int8_t)(scaled < -127.0f ? -127.0f : scaled > 127.0f ? 127.0f : scaled);
}

static void unfold_bytes(const uint8_t bytes[2], float out[3])
{
    float length;
    noh_octahedral_unfold((float)(int8_t)bytes[0] / 127.0f, (float)(int8_t)bytes[1] / 127.0f, out);
    length = sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (uint32_t k = 0; k < 3u; k++) {
        out[k] /= length;
    }
}

/* The nearest of the nine pairs of bytes about the folded direction; `rounded` is its decoded direction. */
static void fold_axis(const float axis[3], uint8_t bytes[2], float rounded[3])
{
    const float sum = fabsf(axis[0]) + fabsf(axis[1]) + fabsf(axis[2]);
    float x = axis[0] / sum, y = axis[1] / sum, best = -2.0f;
    if (axis[2] < 0.0f) {
        const float folded = (1.0f - fabsf(y)) * (x >= 0.0f ? 1.0f : -1.0f);
        y = (1.0f - fabsf(x)) * (y >= 0.0f ? 1.0f : -1.0f);
        x = folded;
    }
    for (int i = 0; i < 9; i++) {
        const int across = i % 3 - 1, along = i / 3 - 1;
        const uint8_t pair[2] = { signed_byte(x + (float)across / 127.0f), signed_byte(y + (float)along / 127.0f) };
        float d[3], near;
        unfold_bytes(pair, d);
        near = d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2];
        if (near > best) {
            best = near;
            memcpy(bytes, pair, 2);
            memcpy(rounded, d, sizeof d);
        }
    }
}

void transfer_record(const float *transfer, const float axis[3], uint32_t order, uint32_t flags, uint8_t *record)
{
    float rounded[3];
    noh_lobe lobe;
    memcpy(rounded, axis, sizeof rounded);
    if (!(flags & NOH_TRANSFER_ON_NORMAL)) {
        fold_axis(axis, record + order, rounded);
    }
    transfer_lobe(transfer, rounded, &lobe);
    record[0] = (uint8_t)roundf(255.0f * (lobe.occlusion < 0.0f   ? 0.0f
                                          : lobe.occlusion > 1.0f ? 1.0f
                                                                  : lobe.occlusion));
    for (uint32_t l = 1; l < order; l++) {
        record[l] = signed_byte(lobe.shape[l]);
    }
}
