#include "light/environment.h"

#include <string.h>

#include "base/assert.h"
#include "base/limits.h"
#include "base/math_internal.h"
#include "base/name_internal.h"

/* white: the furnace. studio: a large soft box, a fill, a rim, a dark floor. room: a window to the left, a ceiling
 * that reflects it, a lamp behind, warm walls and floor. sky: blue with a bright zenith, sun, grass. */
static const noh_environment environments[NOH_ENVIRONMENT_COUNT] = {
    { "white", { 1.0f, 1.0f, 1.0f }, 0, { { { 0.0f, 0.0f, 0.0f }, 0.0f, 0, { 0.0f, 0.0f, 0.0f } } } },
    { "studio",
      { 0.12f, 0.12f, 0.13f },
      4,
      { { { -0.48f, 0.6f, 0.64f }, 0.8f, 1, { 7.5f, 7.2f, 6.8f } },
        { { 0.8f, 0.0f, 0.6f }, 0.5f, 2, { 1.1f, 1.2f, 1.35f } },
        { { 0.36f, 0.48f, -0.8f }, 0.85f, 1, { 5.0f, 5.2f, 5.6f } },
        { { 0.0f, 1.0f, 0.0f }, -0.2f, 2, { 0.45f, 0.45f, 0.48f } } } },
    { "room",
      { 0.16f, 0.14f, 0.12f },
      5,
      { { { -0.8f, 0.36f, 0.48f }, 0.82f, 0, { 5.2f, 5.6f, 6.2f } },
        { { 0.0f, 1.0f, 0.0f }, 0.0f, 1, { 0.75f, 0.72f, 0.66f } },
        { { 0.6f, 0.64f, -0.48f }, 0.93f, 1, { 7.0f, 5.6f, 3.8f } },
        { { 0.0f, -1.0f, 0.0f }, 0.1f, 1, { 0.22f, 0.15f, 0.09f } },
        { { 0.8f, 0.0f, 0.6f }, 0.3f, 2, { 0.45f, 0.38f, 0.3f } } } },
    { "sky",
      { 0.2f, 0.27f, 0.38f },
      4,
      { { { 0.0f, 1.0f, 0.0f }, 0.0f, 1, { 0.35f, 0.55f, 0.85f } },
        { { 0.48f, 0.64f, 0.6f }, 0.96f, 1, { 38.0f, 34.0f, 27.0f } },
        { { 0.48f, 0.64f, 0.6f }, 0.5f, 2, { 0.9f, 0.8f, 0.6f } },
        { { 0.0f, -1.0f, 0.0f }, 0.0f, 0, { 0.02f, -0.01f, -0.2f } } } },
};

uint32_t noh_environment_find(const char *name)
{
    NOH_ASSERT(name);
    for (uint32_t i = 0; i < NOH_ENVIRONMENT_COUNT; i++) {
        if (noh_names_equal(environments[i].name, name)) {
            return i;
        }
    }
    return NOH_NONE;
}

const noh_environment *noh_environment_at(uint32_t index)
{
    NOH_ASSERT(index < NOH_ENVIRONMENT_COUNT);
    return &environments[index];
}

static float power_of(float s, uint32_t power)
{
    return power == 0 ? 1.0f : power == 1 ? s : s * s;
}

void noh_environment_radiance(const noh_environment *environment, const float direction[3], float rgb[3])
{
    NOH_ASSERT(environment && direction && rgb && environment->lamp_count <= NOH_LAMPS_MAX);
    memcpy(rgb, environment->ambient, 3 * sizeof *rgb);
    for (uint32_t i = 0; i < environment->lamp_count; i++) {
        const noh_lamp *lamp = &environment->lamps[i];
        const float s = (noh_dot3(lamp->direction, direction) - lamp->edge) / (1.0f - lamp->edge);
        for (uint32_t c = 0; s > 0.0f && c < 3u; c++) {
            rgb[c] += lamp->color[c] * power_of(s < 1.0f ? s : 1.0f, lamp->power);
        }
    }
}

/* The zonal coefficients of a lamp of colour 1: 2 pi sqrt((2 l + 1) / (4 pi)) times the integral of s^power P_l(t) over
 * t from the edge to 1. That is a polynomial of degree 7 at most, so four nodes of Gauss and Legendre are exact. */
static void lamp_zonal(const noh_lamp *lamp, uint32_t order, float *zonal)
{
    static const float nodes[4] = { 0.0694318442f, 0.330009478f, 0.669990522f, 0.930568156f };
    static const float weights[4] = { 0.173927423f, 0.326072577f, 0.326072577f, 0.173927423f };
    static const float scale[NOH_SH_ORDER_MAX] = { 1.77245385f, 3.06998012f, 3.9633273f,
                                                   4.6894721f,  5.31736155f, 5.87856444f };
    const float width = 1.0f - lamp->edge;
    memset(zonal, 0, order * sizeof *zonal);
    for (uint32_t i = 0; i < 4u; i++) {
        const float t = lamp->edge + width * nodes[i], weight = width * weights[i] * power_of(nodes[i], lamp->power);
        float before = 0.0f, now = 1.0f; /* Legendre polynomials */
        for (uint32_t l = 0; l < order; l++) {
            const float next = ((float)(2u * l + 1u) * t * now - (float)l * before) / (float)(l + 1u);
            zonal[l] += scale[l] * weight * now;
            before = now;
            now = next;
        }
    }
}

void noh_light_from_environment(const noh_environment *environment, uint32_t order, noh_light *light)
{
    float zonal[NOH_SH_ORDER_MAX], coefs[NOH_SH_COUNT_MAX];
    NOH_ASSERT(environment && light && order >= 1 && order <= NOH_SH_ORDER_MAX);
    NOH_ASSERT(environment->lamp_count <= NOH_LAMPS_MAX);
    memset(light, 0, sizeof *light);
    light->order = order;
    for (uint32_t c = 0; c < 3u; c++) {
        light->coefs[0][c] = environment->ambient[c] * 3.5449077f; /* sqrt(4 pi) */
    }
    for (uint32_t i = 0; i < environment->lamp_count; i++) {
        const noh_lamp *lamp = &environment->lamps[i];
        NOH_ASSERT(lamp->power <= 2u && lamp->edge >= -1.0f && lamp->edge < 1.0f);
        lamp_zonal(lamp, order, zonal);
        noh_sh_from_zonal(order, zonal, lamp->direction, coefs);
        for (uint32_t k = 0; k < 3u * NOH_SH_COUNT(order); k++) {
            light->coefs[k / 3u][k % 3u] += lamp->color[k % 3u] * coefs[k / 3u];
        }
    }
}

void noh_light_rotate(const noh_light *from, const float rotation[9], noh_light *to)
{
    float before[NOH_SH_COUNT_MAX], after[NOH_SH_COUNT_MAX];
    NOH_ASSERT(from && to && from != to);
    memset(to, 0, sizeof *to);
    memset(before, 0, sizeof before); /* gcc does not see that the order is at least 1 */
    to->order = from->order;
    for (uint32_t c = 0; c < 3u; c++) {
        for (uint32_t i = 0; i < NOH_SH_COUNT(from->order); i++) {
            before[i] = from->coefs[i][c];
        }
        noh_sh_rotate(from->order, rotation, before, after);
        for (uint32_t i = 0; i < NOH_SH_COUNT(from->order); i++) {
            to->coefs[i][c] = after[i];
        }
    }
}

void noh_light_irradiance(const noh_light *light, const float normal[3], float rgb[3])
{
    float basis[NOH_SH_COUNT_MAX];
    NOH_ASSERT(light && normal && rgb);
    noh_sh_basis(light->order, normal, basis);
    noh_sh_convolve(light->order, noh_sh_cosine_lobe, basis);
    memset(rgb, 0, 3 * sizeof *rgb);
    for (uint32_t i = 0; i < 3u * NOH_SH_COUNT(light->order); i++) {
        rgb[i % 3u] += basis[i / 3u] * light->coefs[i / 3u][i % 3u];
    }
}
