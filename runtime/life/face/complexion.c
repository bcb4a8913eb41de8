/* complexion.c: colours of skin, hair and eyes by seed. */
#include "noh/face.h"

#include "core/base/assert_internal.h"
#include "life/face/face_internal.h"

typedef enum iris { BLUE, GREY, GREEN, HAZEL, BROWN, DARK, IRISES } iris;

/* Colours that occur together: means, with the spread of melanin in skin and hair. Densities; shares of 1. */
typedef struct complexion {
    float share, melanin, melanin_spread, blood, freckled;
    float hair, hair_spread, red;
    uint8_t irises[IRISES]; /* of 100 */
} complexion;

static const complexion complexions[] = {
    { 0.06f, -0.12f, 0.05f, 0.06f, 0.90f, -0.65f, 0.15f, 0.80f, { 35, 10, 35, 15, 5, 0 } },
    { 0.16f, -0.08f, 0.06f, 0.05f, 0.45f, -0.95f, 0.30f, 0.20f, { 55, 20, 15, 5, 5, 0 } },
    { 0.22f, 0.02f, 0.08f, 0.02f, 0.25f, -0.15f, 0.35f, 0.10f, { 25, 12, 13, 20, 30, 0 } },
    { 0.20f, 0.26f, 0.09f, 0.00f, 0.08f, 0.50f, 0.30f, 0.00f, { 3, 3, 9, 20, 55, 10 } },
    { 0.16f, 0.55f, 0.13f, -0.02f, 0.03f, 0.90f, 0.20f, 0.00f, { 0, 0, 2, 8, 50, 40 } },
    { 0.12f, 1.00f, 0.18f, -0.04f, 0.00f, 1.10f, 0.15f, 0.00f, { 0, 0, 0, 2, 33, 65 } },
    { 0.08f, 1.55f, 0.22f, -0.06f, 0.00f, 1.20f, 0.10f, 0.00f, { 0, 0, 0, 0, 15, 85 } },
};

/* Square roots of linear red, green, blue, in 255ths. */
static const uint8_t iris_colors[IRISES][3] = { { 90, 106, 120 }, { 104, 112, 116 }, { 88, 102, 84 },
                                                { 86, 70, 48 },   { 72, 48, 29 },    { 46, 31, 22 } };

static const complexion *draw_row(float uniform)
{
    uint32_t i = 0;
    while (i + 1u < sizeof complexions / sizeof complexions[0] && uniform >= complexions[i].share) {
        uniform -= complexions[i++].share;
    }
    return &complexions[i];
}

static iris draw_iris(const complexion *c, float uniform)
{
    uint32_t i = 0;
    float left = uniform * 100.0f;
    while (i + 1u < IRISES && left >= (float)c->irises[i]) left -= (float)c->irises[i++];
    return (iris)i;
}

/* A number as a byte of low..high in two's complement. */
static uint32_t byte_of(float value, float low, float high)
{
    value = value < low ? low : value > high ? high : value;
    return (uint32_t)(int32_t)(value < 0.0f ? value - 0.5f : value + 0.5f) & 255u;
}

static float three(uint32_t first, uint32_t second, uint32_t third)
{
    return (float)(first | second << 8 | third << 16);
}

void noh_complexion_random(uint32_t seed, float amount, float user[4])
{
    float u[8], n[8];
    NOH_ASSERT(user && amount >= 0.0f && amount <= 1.0f);
    for (uint32_t i = 0; i < 8u; i++) {
        u[i] = noh_face_uniform(seed, NOH_FACE_COMPLEXION, i);
        n[i] = noh_face_normal(u[i]);
    }
    const complexion *c = draw_row(u[0]);
    const uint8_t *color = iris_colors[draw_iris(c, u[1])];
    const float melanin = c->melanin + c->melanin_spread * n[2], hair = c->hair + c->hair_spread * n[3];
    const float freckles = u[4] < c->freckled ? 0.25f + 0.75f * u[4] / c->freckled : 0.0f;
    const float lips = 0.10f * n[5] - 0.08f * melanin, blood = c->blood + 0.035f * n[6];
    user[0] = three(byte_of(32.0f * amount * melanin, -8.0f, 80.0f), byte_of(64.0f * amount * blood, -16.0f, 16.0f),
                    byte_of(255.0f * amount * freckles, 0.0f, 255.0f));
    user[1] = three(byte_of(32.0f * amount * hair, -48.0f, 64.0f), byte_of(64.0f * amount * c->red, 0.0f, 96.0f),
                    byte_of(64.0f * amount * lips, -24.0f, 24.0f));
    user[2] = three(color[0], color[1], color[2]);
    user[3] = three(byte_of(255.0f * amount, 0.0f, 255.0f), byte_of(256.0f * u[7] - 0.5f, 0.0f, 255.0f),
                    byte_of(32.0f * amount * (0.2f + 0.1f * n[7]), -16.0f, 32.0f));
}
