#include "light_measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/light/transfer_fit.h"
#include "convert/light/transfer_make.h"

#define SEEN_LEAST 0.15
#define PROJECTION_RAYS 16384u /* for the lights' spherical harmonics */
#define SEED_ORDER 4u

/* ---- lights ---- */

static double random_unit(uint64_t *state)
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (double)(*state * 2685821657736338717u >> 11) / 9007199254740992.0;
}

typedef struct soft_lamp {
    double direction[3], sharpness, color[3];
} soft_lamp;

typedef struct random_light {
    soft_lamp lamps[3];
    uint32_t lamp_count;
} random_light;

/* Lamps in the upper half, of radiance that falls as exp(sharpness (cos - 1)). */
static random_light make_light(uint64_t *state, double sharpness)
{
    random_light light;
    light.lamp_count = 1u + (uint32_t)(3.0 * random_unit(state));
    for (uint32_t i = 0; i < light.lamp_count; i++) {
        soft_lamp *lamp = &light.lamps[i];
        const double up = random_unit(state), angle = 6.283185307179586 * random_unit(state);
        double strength;
        lamp->direction[0] = sqrt(1.0 - up * up) * cos(angle);
        lamp->direction[1] = up;
        lamp->direction[2] = sqrt(1.0 - up * up) * sin(angle);
        lamp->sharpness = sharpness * (0.5 + 1.5 * random_unit(state));
        strength = lamp->sharpness < 8.0 ? lamp->sharpness * 0.5 : 4.0;
        for (uint32_t c = 0; c < 3u; c++) {
            lamp->color[c] = strength * (0.3 + 0.7 * random_unit(state));
        }
    }
    return light;
}

static void radiance_of(const random_light *light, const float d[3], float rgb[3])
{
    static const double tint[3] = { 0.8, 0.9, 1.1 };
    double sum[3];
    for (uint32_t c = 0; c < 3u; c++) {
        sum[c] = tint[c] * (0.275 + 0.125 * (double)d[1]);
    }
    for (uint32_t i = 0; i < light->lamp_count; i++) {
        const soft_lamp *lamp = &light->lamps[i];
        const double cosine = lamp->direction[0] * (double)d[0] + lamp->direction[1] * (double)d[1] +
                              lamp->direction[2] * (double)d[2];
        for (uint32_t c = 0; c < 3u; c++) {
            sum[c] += lamp->color[c] * exp(lamp->sharpness * (cosine - 1.0));
        }
    }
    for (uint32_t c = 0; c < 3u; c++) {
        rgb[c] = (float)sum[c];
    }
}

static void project(const random_light *light, const light_rays *rays, noh_light *out)
{
    double sums[NOH_SH_COUNT_MAX][3];
    memset(sums, 0, sizeof sums);
    for (uint32_t i = 0; i < rays->count; i++) {
        float rgb[3];
        radiance_of(light, rays->directions + 3u * (size_t)i, rgb);
        for (uint32_t k = 0; k < 3u * NOH_SH_COUNT_MAX; k++) {
            sums[k / 3u][k % 3u] += (double)rays->basis[NOH_SH_COUNT_MAX * (size_t)i + k / 3u] * (double)rgb[k % 3u];
        }
    }
    out->order = NOH_SH_ORDER_MAX;
    for (uint32_t k = 0; k < 3u * NOH_SH_COUNT_MAX; k++) {
        out->coefs[k / 3u][k % 3u] = (float)(sums[k / 3u][k % 3u] * 12.566370614359172 / rays->count);
    }
}

static void make_lights(light_measure *m, const light_rays *fine)
{
    static const double sharpness[LIGHT_KINDS] = { 3.0, 30.0 };
    uint64_t state = 0x9e3779b97f4a7c15u;
    for (uint32_t i = 0; i < LIGHT_COUNT; i++) {
        const random_light light = make_light(&state, sharpness[i / LIGHTS_OF_KIND]);
        project(&light, fine, &m->lights[i]);
        for (uint32_t r = 0; r < m->rays.count; r++) {
            radiance_of(&light, m->rays.directions + 3u * (size_t)r, m->radiance + 3u * ((size_t)r * LIGHT_COUNT + i));
        }
    }
}

int light_measure_open(light_measure *m, uint32_t ray_count)
{
    light_rays fine = { 0, NULL, NULL };
    int failed;
    memset(m, 0, sizeof *m);
    m->radiance = malloc(3u * LIGHT_COUNT * sizeof(float) * ray_count);
    failed = !m->radiance || light_rays_make(ray_count, &m->rays) || light_rays_make(PROJECTION_RAYS, &fine);
    if (!failed) {
        make_lights(m, &fine);
    }
    light_rays_free(&fine);
    return failed;
}

void light_measure_close(light_measure *m)
{
    light_rays_free(&m->rays);
    free(m->radiance);
}

/* ---- a mesh ---- */

typedef struct mesh_work {
    light_measure *m;
    light_surface surface;
    noh_transfer stored, seed;
    noh_transfer_header seed_header;
    uint8_t *seed_records, *blocked;
    uint8_t *kept;    /* [vertex_count] */
    float *occlusion; /* of the pose, stored */
    float *direct;    /* [vertex_count][3 * LIGHT_COUNT] without reflections; NULL where the transfer has none */
} mesh_work;

/* The reflected light of a vertex under every light, by brute force, and the share of the sky it sees. */
static double brute_force(const mesh_work *w, uint32_t vertex, float sums[3u * LIGHT_COUNT])
{
    const light_rays *rays = &w->m->rays;
    const float *n = w->surface.normal + 3u * (size_t)vertex;
    const float scale = 1.0f / light_rays_sum(rays, n);
    double seen = 0.0;
    memset(sums, 0, 3u * LIGHT_COUNT * sizeof *sums);
    light_rays_blocked(rays, &w->surface, vertex, w->blocked);
    for (uint32_t i = 0; i < rays->count; i++) {
        const float *d = rays->directions + 3u * (size_t)i, *radiance = w->m->radiance + 3u * LIGHT_COUNT * (size_t)i;
        const float weight = scale * (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]);
        if (weight <= 0.0f || w->blocked[i]) {
            continue;
        }
        seen += (double)weight;
        for (uint32_t k = 0; k < 3u * LIGHT_COUNT; k++) {
            sums[k] += weight * radiance[k];
        }
    }
    return seen;
}

static void measure_direct(const mesh_work *w)
{
    for (uint32_t v = 0; w->direct && v < w->surface.mesh.header->vertex_count; v++) {
        (void)brute_force(w, v, w->direct + 3u * LIGHT_COUNT * (size_t)v);
    }
}

/* brute_force, with one reflection where the transfer has one. */
static double brute_force_again(const mesh_work *w, uint32_t vertex, float sums[3u * LIGHT_COUNT])
{
    const double seen = brute_force(w, vertex, sums);
    if (w->direct) {
        light_rays_bounce(&w->m->rays, &w->surface, vertex, w->blocked, (float)w->stored.header->bounce / 255.0f,
                          w->direct, 3u * LIGHT_COUNT, sums);
    }
    return seen;
}

static void add_errors(const mesh_work *w, uint32_t vertex, const float *truth, int posed)
{
    const float *n = w->surface.normal + 3u * (size_t)vertex;
    for (uint32_t i = 0; i < LIGHT_COUNT; i++) {
        float rgb[LIGHT_METHODS][3];
        noh_transfer_shade(&w->surface.mesh, &w->stored, vertex, n, posed ? w->occlusion : NULL, &w->m->lights[i],
                           rgb[LIGHT_STORED]);
        noh_transfer_shade(&w->surface.mesh, &w->seed, vertex, n, NULL, &w->m->lights[i], rgb[LIGHT_SEED]);
        for (uint32_t k = 0; k < LIGHT_METHODS * 3u; k++) {
            light_error *e = &w->m->sums[posed][k / 3u][i];
            const double difference = (double)rgb[k / 3u][k % 3u] - (double)truth[3u * i + k % 3u];
            e->square += difference * difference;
            e->reference += (double)truth[3u * i + k % 3u] * (double)truth[3u * i + k % 3u];
        }
    }
}

/* The seed's records: about the normal, order 4, fitted to the rays that `noh build` casts. */
static int make_seed(mesh_work *w)
{
    light_rays rays = { 0, NULL, NULL };
    const int failed = light_rays_make(TRANSFER_RAYS, &rays);
    uint8_t *blocked = malloc(TRANSFER_RAYS);
    for (uint32_t v = 0; v < w->surface.mesh.header->vertex_count && !failed && blocked; v++) {
        float transfer[NOH_SH_COUNT_MAX];
        light_rays_transfer(&rays, &w->surface, v, blocked, transfer);
        transfer_record(transfer, w->surface.normal + 3u * (size_t)v, SEED_ORDER, NOH_TRANSFER_ON_NORMAL,
                        w->seed_records + SEED_ORDER * (size_t)v);
    }
    w->seed_header.order = SEED_ORDER;
    w->seed_header.flags = NOH_TRANSFER_ON_NORMAL;
    w->seed.header = &w->seed_header;
    w->seed.records = w->seed_records;
    light_rays_free(&rays);
    free(blocked);
    return failed || !blocked;
}

/* The vertices of materials that do not blend, without eyeballs and teeth, whose records are not of the bind pose. */
static void keep_opaque(mesh_work *w)
{
    const noh_mesh *mesh = &w->surface.mesh;
    for (uint32_t i = 0; i < 3u * w->surface.own_count; i++) {
        w->kept[w->surface.corners[i]] = 1;
    }
    for (uint32_t i = 0; i < mesh->pack->material_count; i++) {
        transfer_mark_still(mesh, i, NOH_SURFACE_EYE, 0, w->kept);
        transfer_mark_still(mesh, i, NOH_SURFACE_TEETH, 0, w->kept);
    }
}

static int measure_poses(mesh_work *w, const float *weights, model_error *error)
{
    const uint32_t count = w->surface.mesh.header->vertex_count;
    float truth[3u * LIGHT_COUNT];
    keep_opaque(w);
    measure_direct(w);
    for (uint32_t v = 0; v < count; v++) {
        w->kept[v] = w->kept[v] && brute_force_again(w, v, truth) > SEEN_LEAST;
        if (w->kept[v]) {
            w->m->vertices++;
            add_errors(w, v, truth, 0);
        }
    }
    w->m->vertices_all += count;
    if (light_surface_pose(&w->surface, weights, error)) {
        return 1;
    }
    measure_direct(w);
    noh_transfer_accumulate(&w->surface.mesh, weights, w->occlusion);
    for (uint32_t v = 0; v < count; v++) {
        if (w->kept[v]) {
            (void)brute_force_again(w, v, truth);
            add_errors(w, v, truth, 1);
        }
    }
    return 0;
}

int light_measure_mesh(light_measure *m, const noh_pack *pack, uint32_t mesh, const float *weights, model_error *error)
{
    mesh_work w;
    int failed;
    memset(&w, 0, sizeof w);
    w.m = m;
    failed = light_surface_open(pack, mesh, &w.surface, error);
    if (!failed) {
        const noh_mesh_header *h = w.surface.mesh.header;
        w.kept = model_zeros(h->vertex_count, 1);
        w.blocked = model_zeros(m->rays.count, 1);
        w.seed_records = model_zeros(h->vertex_count, SEED_ORDER);
        w.occlusion = model_zeros((size_t)h->morph_height << h->morph_width_log2, sizeof *w.occlusion);
        (void)noh_transfer_of(&w.surface.mesh, &w.stored, NULL);
        if (w.stored.header->bounce) {
            w.direct = model_zeros(h->vertex_count, 3u * LIGHT_COUNT * sizeof *w.direct);
        }
        failed = (w.stored.header->bounce && !w.direct) || !w.kept || !w.blocked || !w.seed_records || !w.occlusion ||
                         make_seed(&w)
                     ? model_fail(error, w.surface.mesh.name, "out of memory")
                     : 0;
    }
    if (!failed) {
        failed = measure_poses(&w, weights, error);
    }
    light_surface_close(&w.surface);
    free(w.kept);
    free(w.blocked);
    free(w.seed_records);
    free(w.occlusion);
    free(w.direct);
    return failed;
}

double light_measure_rms(const light_measure *m, int posed, light_method method, uint32_t kind)
{
    double sum = 0.0;
    for (uint32_t i = kind * LIGHTS_OF_KIND; i < (kind + 1u) * LIGHTS_OF_KIND; i++) {
        const light_error *e = &m->sums[posed][method][i];
        sum += e->reference > 0.0 ? sqrt(e->square / e->reference) : 0.0;
    }
    return sum / LIGHTS_OF_KIND;
}
