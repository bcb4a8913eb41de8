#include "noh/base.h"
#include "noh/low_gl.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "gl/light/sh_internal.h"

#define BANDS NOH_SH_ORDER_MAX
#define BAND_WIDTH (2u * BANDS - 1u) /* functions of the last band */

/* sqrt((2 l + 1) / (4 pi) (l - m)! / (l + m)!), times sqrt(2) for m > 0: [m][l - m]. */
static const float normalisation[BANDS][BANDS] = {
    { 0.282094792f, 0.488602512f, 0.630783131f, 0.746352665f, 0.846284375f, 0.93560258f },
    { 0.488602512f, 0.36418281f, 0.3046972f, 0.267618617f, 0.241571547f, 0.0f },
    { 0.182091405f, 0.0963537148f, 0.0630783131f, 0.0456527313f, 0.0f, 0.0f },
    { 0.0393362393f, 0.0168583883f, 0.00931882475f, 0.0f, 0.0f, 0.0f },
    { 0.00596034034f, 0.00219646806f, 0.0f, 0.0f, 0.0f, 0.0f },
    { 0.000694584187f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f },
};

/* sqrt(4 pi / (2 l + 1)) */
static const float zonal_scale[BANDS] = { 3.5449077f, 2.04665342f, 1.58533092f, 1.33984917f, 1.1816359f, 1.06882989f };

const float noh_sh_cosine_lobe[NOH_SH_ORDER_MAX] = { 1.0f, 2.0f / 3.0f, 0.25f, 0.0f, -1.0f / 24.0f, 0.0f };

float noh_sh_normalisation(uint32_t l, uint32_t m)
{
    NOH_ASSERT(m <= l && l < BANDS);
    return normalisation[m][l - m];
}

/* One m: the associated Legendre functions by the recurrence in l, without their factor (1 - z^2)^(m/2), which is part
 * of (x + i y)^m; `cosine` and `sine` are the real and imaginary parts of this power. */
static void basis_of_m(uint32_t order, uint32_t m, float z, float first, const float power[2], float *basis)
{
    float before = 0.0f, now = first;
    for (uint32_t l = m; l < order; l++) {
        const float value = normalisation[m][l - m] * now;
        const float next = (z * (float)(2u * l + 1u) * now - (float)(l + m) * before) / (float)(l + 1u - m);
        float *middle = basis + l * (l + 1u);
        middle[m] = value * power[0];
        if (m) {
            *(middle - m) = value * power[1];
        }
        before = now;
        now = next;
    }
}

void noh_sh_basis(uint32_t order, const float direction[3], float *basis)
{
    float power[2] = { 1.0f, 0.0f }, first = 1.0f; /* (x + i y)^m; (2 m - 1)!! */
    NOH_ASSERT(direction && basis && order >= 1 && order <= NOH_SH_ORDER_MAX);
    for (uint32_t m = 0; m < order; m++) {
        const float x = power[0] * direction[0] - power[1] * direction[1];
        const float y = power[0] * direction[1] + power[1] * direction[0];
        basis_of_m(order, m, direction[2], first, power, basis);
        power[0] = x;
        power[1] = y;
        first *= (float)(2u * m + 1u);
    }
}

float noh_sh_evaluate(uint32_t order, const float *coefs, const float direction[3])
{
    float basis[NOH_SH_COUNT_MAX], sum = 0.0f;
    noh_sh_basis(order, direction, basis);
    for (uint32_t i = 0; i < NOH_SH_COUNT(order); i++) {
        sum += coefs[i] * basis[i];
    }
    return sum;
}

void noh_sh_add_sample(uint32_t order, const float direction[3], float value, float weight, float *coefs)
{
    float basis[NOH_SH_COUNT_MAX];
    noh_sh_basis(order, direction, basis);
    for (uint32_t i = 0; i < NOH_SH_COUNT(order); i++) {
        coefs[i] += basis[i] * (value * weight);
    }
}

static void scale_bands(uint32_t order, const float *bands, const float *also, float *coefs)
{
    for (uint32_t l = 0; l < order; l++) {
        for (uint32_t i = l * l; i < (l + 1u) * (l + 1u); i++) {
            coefs[i] *= also ? bands[l] * also[l] : bands[l];
        }
    }
}

void noh_sh_from_zonal(uint32_t order, const float *zonal, const float axis[3], float *coefs)
{
    noh_sh_basis(order, axis, coefs);
    scale_bands(order, zonal, zonal_scale, coefs);
}

void noh_sh_convolve(uint32_t order, const float *bands, float *coefs)
{
    NOH_ASSERT(bands && coefs && order >= 1 && order <= NOH_SH_ORDER_MAX);
    scale_bands(order, bands, NULL, coefs);
}

/* ---- rotation ---- */

/* The matrices of one band, m and n from -l to l, and of the previous band. */
typedef struct sh_turn {
    float first[3][3]; /* of band 1: y, z, x */
    float before[BAND_WIDTH][BAND_WIDTH];
    float now[BAND_WIDTH][BAND_WIDTH];
    int l;
} sh_turn;

/* P of the paper: band l - 1 times band 1. */
static float product(const sh_turn *t, int i, int a, int b)
{
    const int l = t->l, middle = l - 1;
    const float *first = t->first[i + 1], *before = t->before[a + middle];
    if (b == l) {
        return first[2] * before[l - 1 + middle] - first[0] * before[1 - l + middle];
    }
    if (b == -l) {
        return first[2] * before[1 - l + middle] + first[0] * before[l - 1 + middle];
    }
    return first[1] * before[b + middle];
}

static float product_v(const sh_turn *t, int m, int n)
{
    const float root = 1.41421356f;
    if (m == 0) {
        return product(t, 1, 1, n) + product(t, -1, -1, n);
    }
    if (m > 0) {
        return m == 1 ? root * product(t, 1, 0, n) : product(t, 1, m - 1, n) - product(t, -1, 1 - m, n);
    }
    return m == -1 ? root * product(t, -1, 0, n) : product(t, 1, m + 1, n) + product(t, -1, -m - 1, n);
}

/* |m| is at most l - 2. */
static float product_w(const sh_turn *t, int m, int n)
{
    return m > 0 ? product(t, 1, m + 1, n) + product(t, -1, -m - 1, n)
                 : product(t, 1, m - 1, n) - product(t, -1, 1 - m, n);
}

/* An element of band l's matrix: u U + v V + w W of the paper's table. */
static float element(const sh_turn *t, int m, int n)
{
    const int l = t->l, size = m < 0 ? -m : m, edge = n == l || n == -l;
    const float below = (float)(edge ? 2 * l * (2 * l - 1) : (l + n) * (l - n));
    const float v = 0.5f * noh_sqrt((float)((m ? 1 : 2) * (l + size - 1) * (l + size)) / below);
    float sum = (m ? v : -v) * product_v(t, m, n);
    if (size < l) {
        sum += noh_sqrt((float)((l + m) * (l - m)) / below) * product(t, 0, m, n);
    }
    if (m && size < l - 1) {
        sum -= 0.5f * noh_sqrt((float)((l - size - 1) * (l - size)) / below) * product_w(t, m, n);
    }
    return sum;
}

static void next_band(sh_turn *t)
{
    memcpy(t->before, t->now, sizeof t->before);
    t->l++;
    for (int m = -t->l; m <= t->l; m++) {
        for (int n = -t->l; n <= t->l; n++) {
            t->now[m + t->l][n + t->l] = element(t, m, n);
        }
    }
}

void noh_sh_rotate(uint32_t order, const float rotation[9], const float *from, float *to)
{
    static const uint8_t axis[3] = { 1, 2, 0 }; /* band 1 is y, z, x */
    sh_turn t;
    NOH_ASSERT(rotation && from && to && from != to && order >= 1 && order <= NOH_SH_ORDER_MAX);
    memset(&t, 0, sizeof t);
    for (uint32_t i = 0; i < 9u; i++) {
        t.first[i / 3u][i % 3u] = t.now[i / 3u][i % 3u] = rotation[3u * axis[i / 3u] + axis[i % 3u]];
    }
    to[0] = from[0];
    for (uint32_t l = 1; l < order; l++) {
        t.l = (int)l;
        if (l > 1) {
            t.l--;
            next_band(&t);
        }
        for (uint32_t m = 0; m < 2u * l + 1u; m++) {
            float sum = 0.0f;
            for (uint32_t n = 0; n < 2u * l + 1u; n++) {
                sum += t.now[m][n] * from[l * l + n];
            }
            to[l * l + m] = sum;
        }
    }
}
