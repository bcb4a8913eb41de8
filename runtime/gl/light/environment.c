#include "noh/base.h"
#include "noh/light.h"
#include "noh/low_gl.h"

#include <string.h>

#include "core/base/assert_internal.h"
#include "core/base/math_internal.h"
#include "core/base/name_internal.h"
#include "gl/light/sh_internal.h"
#include "gl/light/light_internal.h"

/* white: the furnace. studio: a large soft box, a fill, a rim, a dark floor. room: a window to the left, a ceiling
 * that reflects it, a lamp behind, warm walls and floor. sky: blue with a bright zenith, sun, ground. Colours are
 * balanced so that skin in each reflects more red than green and more green than blue, also in shadow. */
static const noh_environment environments[NOH_ENVIRONMENT_COUNT] = {
    { .name = "white", .ambient = { 1.0f, 1.0f, 1.0f } },
    { .name = "studio",
      .ambient = { 0.125f, 0.12f, 0.117f },
      .lamp_count = 3,
      .lamps = { { { 0.8f, 0.0f, 0.6f }, 0.5f, 2, { 1.23f, 1.19f, 1.15f } },
                 { { 0.36f, 0.48f, -0.8f }, 0.85f, 1, { 5.25f, 5.2f, 5.15f } },
                 { { 0.0f, 1.0f, 0.0f }, -0.2f, 2, { 0.455f, 0.45f, 0.445f } } },
      .window_count = 1,
      .windows = { { { -0.48f, 0.6f, 0.64f }, { 0.42f, 0.42f }, { 1, 1 }, 0.0f, { 7.8f, 7.5f, 7.1f } } } },
    { .name = "room",
      .ambient = { 0.155f, 0.14f, 0.128f },
      .lamp_count = 4,
      .lamps = { { { 0.0f, 1.0f, 0.0f }, 0.0f, 1, { 0.75f, 0.72f, 0.66f } },
                 { { 0.6f, 0.64f, -0.48f }, 0.93f, 1, { 7.0f, 5.8f, 4.6f } },
                 { { 0.0f, -1.0f, 0.0f }, 0.1f, 1, { 0.22f, 0.16f, 0.11f } },
                 { { 0.8f, 0.0f, 0.6f }, 0.3f, 2, { 0.45f, 0.40f, 0.36f } } },
      .window_count = 1,
      .windows = { { { -0.64f, 0.48f, 0.6f }, { 0.42f, 0.55f }, { 2, 3 }, 0.12f, { 11.2f, 11.0f, 10.9f } } } },
    { .name = "sky",
      .ambient = { 0.26f, 0.29f, 0.345f },
      .lamp_count = 4,
      .lamps = { { { 0.0f, 1.0f, 0.0f }, 0.0f, 1, { 0.30f, 0.43f, 0.66f } },
                 { { 0.48f, 0.64f, 0.6f }, 0.96f, 1, { 37.0f, 34.0f, 29.5f } },
                 { { 0.48f, 0.64f, 0.6f }, 0.5f, 2, { 0.9f, 0.79f, 0.66f } },
                 { { 0.0f, -1.0f, 0.0f }, 0.0f, 0, { 0.05f, 0.0f, -0.12f } } } },
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

/* Axes of a window's plane. */
static void window_axes(const noh_window *w, float right[3], float up[3])
{
    const float *d = w->direction;
    const float y = d[1] < 0.999f && d[1] > -0.999f ? 1.0f : 0.0f, z = 1.0f - y;
    const float t = y * d[1] + z * d[2];
    up[0] = -t * d[0];
    up[1] = y - t * d[1];
    up[2] = z - t * d[2];
    noh_normalize3(up, w->direction);
    right[0] = up[1] * d[2] - up[2] * d[1];
    right[1] = up[2] * d[0] - up[0] * d[2];
    right[2] = up[0] * d[1] - up[1] * d[0];
}

/* 1 if x in -1..1 along one side lies in a pane. */
static int is_pane(float x, uint32_t panes, float bar)
{
    const float at = 0.5f * (x + 1.0f) * (float)panes;
    const float part = at - (float)(uint32_t)at;
    return part > 0.5f * bar && part < 1.0f - 0.5f * bar;
}

static int is_in_window(const noh_window *w, const float direction[3])
{
    const float t = noh_dot3(w->direction, direction);
    float right[3], up[3], x, y;
    if (t < 1e-3f) return 0;
    window_axes(w, right, up);
    x = noh_dot3(right, direction) / (t * w->half[0]);
    y = noh_dot3(up, direction) / (t * w->half[1]);
    return x > -1.0f && x < 1.0f && y > -1.0f && y < 1.0f && is_pane(x, w->panes[0], w->bar) &&
           is_pane(y, w->panes[1], w->bar);
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
    NOH_ASSERT(environment->window_count <= NOH_WINDOWS_MAX);
    for (uint32_t i = 0; i < environment->window_count; i++) {
        const noh_window *w = &environment->windows[i];
        for (uint32_t c = 0; is_in_window(w, direction) && c < 3u; c++) rgb[c] += w->color[c];
    }
}

/* Gauss and Legendre, on 0..1: exact to degree 7. */
static const float nodes[4] = { 0.0694318442f, 0.330009478f, 0.669990522f, 0.930568156f };
static const float weights[4] = { 0.173927423f, 0.326072577f, 0.326072577f, 0.173927423f };

/* The zonal coefficients of a lamp of colour 1: 2 pi sqrt((2 l + 1) / (4 pi)) times the integral of s^power P_l(t) over
 * t from the edge to 1. That is a polynomial of degree 7 at most, so four nodes of Gauss and Legendre are exact. */
static void lamp_zonal(const noh_lamp *lamp, uint32_t order, float *zonal)
{
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

/* One pane of colour 1: corner and size on the window's plane. A point at x, y of that plane has the solid angle
 * dx dy / (1 + x^2 + y^2)^(3/2). */
static void add_pane(const noh_window *w, uint32_t order, const float corner[2], const float size[2], float *coefs)
{
    float right[3], up[3], direction[3];
    window_axes(w, right, up);
    for (uint32_t i = 0; i < 64u; i++) { /* four nodes for each half of each side */
        const uint32_t a = i % 8u, b = i / 8u, right_half = a / 4u, upper_half = b / 4u;
        const float x = corner[0] + 0.5f * size[0] * (nodes[a % 4u] + (float)right_half);
        const float y = corner[1] + 0.5f * size[1] * (nodes[b % 4u] + (float)upper_half);
        const float l2 = 1.0f + x * x + y * y;
        for (uint32_t k = 0; k < 3u; k++) direction[k] = w->direction[k] + x * right[k] + y * up[k];
        noh_normalize3(direction, w->direction);
        noh_sh_add_sample(order, direction, 1.0f,
                          0.25f * weights[a % 4u] * weights[b % 4u] * size[0] * size[1] / (l2 * noh_sqrt(l2)), coefs);
    }
}

static void add_window(const noh_window *w, noh_light *light)
{
    float coefs[NOH_SH_COUNT_MAX] = { 0.0f };
    float cell[2], size[2];
    NOH_ASSERT(w->panes[0] >= 1 && w->panes[0] <= 4 && w->panes[1] >= 1 && w->panes[1] <= 4);
    for (uint32_t k = 0; k < 2u; k++) {
        cell[k] = 2.0f * w->half[k] / (float)w->panes[k];
        size[k] = cell[k] * (1.0f - w->bar);
    }
    for (uint32_t i = 0; i < w->panes[0] * w->panes[1]; i++) {
        const uint32_t at[2] = { i % w->panes[0], i / w->panes[0] };
        float corner[2];
        for (uint32_t k = 0; k < 2u; k++) corner[k] = ((float)at[k] + 0.5f * w->bar) * cell[k] - w->half[k];
        add_pane(w, light->order, corner, size, coefs);
    }
    for (uint32_t k = 0; k < 3u * NOH_SH_COUNT(light->order); k++) {
        light->coefs[k / 3u][k % 3u] += w->color[k % 3u] * coefs[k / 3u];
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
    for (uint32_t i = 0; i < environment->window_count; i++) add_window(&environment->windows[i], light);
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

void noh_light_key(const noh_light *light, float direction[3], float rgb[3], noh_light *rest)
{
    NOH_ASSERT(light && direction && rgb && rest && rest != light && light->order >= 2u);
    static const float luminance[3] = { 0.2126f, 0.7152f, 0.0722f };
    static const uint32_t first[3] = { 3, 1, 2 }; /* x, y, z of band 1 */
    const uint32_t fitted = light->order < 4u ? light->order : 4u;
    float basis[NOH_SH_COUNT_MAX], length = 0.0f, d2;
    *rest = *light;
    for (uint32_t k = 0; k < 3u; k++) {
        direction[k] = noh_dot3(luminance, light->coefs[first[k]]);
        length += direction[k] * direction[k];
        rgb[k] = 0.0f;
    }
    if (length <= 1e-8f * light->coefs[0][1] * light->coefs[0][1]) {
        memcpy(direction, (const float[3]){ 0.0f, 1.0f, 0.0f }, 3 * sizeof *direction);
        return;
    }
    noh_normalize3(direction, direction);
    noh_sh_basis(light->order, direction, basis);
    /* Least squares over bands 1 to 3; uniform light from all directions gives 0. The squared basis functions of band l
     * sum to (2 l + 1) / (4 pi). */
    d2 = (float)(fitted * fitted - 1u) * 0.0795774715f;
    for (uint32_t c = 0; c < 3u; c++) {
        float sum = 0.0f;
        for (uint32_t i = 1; i < NOH_SH_COUNT(fitted); i++) sum += light->coefs[i][c] * basis[i];
        sum = sum > 0.0f ? sum / d2 : 0.0f;
        rgb[c] = sum * 0.318309886f;
        for (uint32_t i = 0; i < NOH_SH_COUNT(light->order); i++) rest->coefs[i][c] -= sum * basis[i];
    }
}

/* The brightest part counts with this share, so that faces lit from behind are not burnt out at their rims. */
#define KEY_SHARE 0.6f
#define EXPOSED 1.1f

float noh_light_exposure(const noh_light *light, const float rotation[9])
{
    static const float luminance[3] = { 0.2126f, 0.7152f, 0.0722f }, face[3] = { 0.0f, 0.33f, 0.944f };
    noh_light turned, rest;
    float rgb[3], direction[3], key[3], ahead, most;
    NOH_ASSERT(light && light->order >= 2u);
    turned = *light;
    if (rotation) noh_light_rotate(light, rotation, &turned);
    noh_light_irradiance(&turned, face, rgb);
    ahead = noh_dot3(luminance, rgb);
    noh_light_key(&turned, direction, key, &rest);
    noh_light_irradiance(&turned, direction, rgb);
    most = KEY_SHARE * noh_dot3(luminance, rgb);
    ahead = ahead > most ? ahead : most;
    return ahead > 1e-6f ? EXPOSED / ahead : 1.0f;
}
