/* zoom_path.c: the camera of a zoom in each frame, and the levels chosen there. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "zoom.h"
#include "cli/message.h"

/* The path extends this factor beyond the outermost switches, so that the last fade can end. */
#define BEYOND_NEAR 1.1
#define BEYOND_FAR 1.3

#define SIDE_LEAST 16.0 /* pixels */
#define SIDE_MOST (8192.0 / ZOOM_FINE)

/* ---- the way ---- */

/* Pixels per metre at which a level with this error uses up the share of the error budget that meshes have. */
static double scale_of_share(const zoom_path *p, float error_m)
{
    return error_m > 0.0f ? (double)p->settings.pixels * (double)p->settings.shares[NOH_LOD_MESH] / (double)error_m
                          : 0.0;
}

/* The range of scales from where the finest level is chosen, despite hysteresis, to where the coarsest is. Returns 0
 * where no item has levels. */
static int find_scales(const zoom_path *p, double *near, double *far)
{
    *near = *far = 0.0;
    for (uint32_t i = 0; i < p->lod.item_count; i++) {
        const noh_lod_table *t = &p->lod.items[i].table;
        if (t->mesh_level_count > t->mesh_level_first + 1u) {
            const double first = scale_of_share(p, t->meshes[t->mesh_level_first + 1u].error_m) * BEYOND_NEAR;
            const double last = scale_of_share(p, t->meshes[t->mesh_level_count - 1u].error_m) *
                                (1.0 - (double)p->settings.hysteresis) / BEYOND_FAR;
            *near = first > *near ? first : *near;
            *far = *far == 0.0 || last < *far ? last : *far;
        }
    }
    return *far > 0.0;
}

static double half_view(void)
{
    return tan(ORBIT_VIEW_RAD / 2.0);
}

/* The distance at which the scene's nearest point has this scale. */
static double distance_of(const zoom_path *p, double scale)
{
    return p->side / (2.0 * half_view() * scale) + p->at.radius;
}

static int plan(zoom_path *p, const char *path, double near, double far)
{
    double near_scale, far_scale;
    if (!find_scales(p, &near_scale, &far_scale) && (near <= 0.0 || far <= 0.0 || !p->side)) {
        return tool_fail(
            path,
            "no LOD level differs from the full mesh (`noh build --lod N` makes them): give --near, --far and --size");
    }
    if (!p->side) {
        const double wanted = near_scale * 2.0 * half_view() *
                              (p->at.distance - p->at.radius); /* so that the scene fills it */
        p->side = 2u * (uint32_t)fmin(SIDE_MOST / 2.0, fmax(SIDE_LEAST / 2.0, ceil(wanted / 2.0)));
    }
    p->near = near > 0.0 ? near : distance_of(p, near_scale);
    p->far = far > 0.0 ? far : distance_of(p, far_scale);
    if (p->near <= p->at.radius || p->far <= p->near) {
        return tool_usage("--near wants more than the scene's radius, %g, --far more than --near; they are %g and %g",
                          p->at.radius, p->near, p->far);
    }
    return 0;
}

int zoom_path_open(zoom_path *p, const pack_file *file, const scene *s, const noh_lod_settings *settings, double near,
                   double far, uint32_t side, uint32_t frames)
{
    const bounds box = scene_bounds(s, file, 0);
    int status;
    memset(p, 0, sizeof *p);
    p->settings = *settings;
    p->at = orbit_fit(&box, 1.0);
    p->side = side;
    p->frames = frames;
    status = scene_lod_open(&p->lod, file, s);
    if (status) {
        return status;
    }
    p->entries = calloc(s->item_count + 1u, sizeof *p->entries);
    return p->entries ? plan(p, file->path, near, far) : tool_fail(file->path, "out of memory");
}

void zoom_path_close(zoom_path *p)
{
    scene_lod_close(&p->lod);
    free(p->entries);
    memset(p, 0, sizeof *p);
}

/* ---- frame by frame ---- */

static int way_of(const zoom_path *p, uint32_t frame)
{
    return frame >= p->frames / 2u;
}

float zoom_path_place(zoom_path *p, uint32_t frame, double factor)
{
    const uint32_t half = p->frames / 2u, step = way_of(p, frame) ? p->frames - frame : frame;
    p->at.distance = p->near * pow(p->far / p->near, (double)step / half) * factor;
    return noh_lod_scale((float)(p->at.distance - p->at.radius), (float)ORBIT_VIEW_RAD, p->side);
}

void zoom_path_choose(zoom_path *p, uint32_t frame, float pixels_per_metre)
{
    for (uint32_t i = 0; i < p->lod.item_count; i++) {
        const noh_lod *now = &p->lod.items[i].state;
        const uint8_t before = now->mesh;
        const int started = now->started;
        scene_lod_choose(&p->lod, i, &p->settings, pixels_per_metre, (int64_t)ZOOM_TICKS * frame);
        p->entries[i].entered[way_of(p, frame)][now->mesh] += started && now->mesh != before;
    }
}

uint32_t zoom_path_most_entered(const zoom_path *p)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < p->lod.item_count * 2u * NOH_LOD_LEVELS_MAX; i++) {
        const uint32_t times =
            p->entries[i / (2u * NOH_LOD_LEVELS_MAX)].entered[i / NOH_LOD_LEVELS_MAX % 2u][i % NOH_LOD_LEVELS_MAX];
        most = times > most ? times : most;
    }
    return most;
}

uint32_t zoom_path_entered(const zoom_path *p, int way)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->lod.item_count * NOH_LOD_LEVELS_MAX; i++) {
        count += p->entries[i / NOH_LOD_LEVELS_MAX].entered[way][i % NOH_LOD_LEVELS_MAX] != 0;
    }
    return count;
}

/* ---- a shaking camera ---- */

static void start_again(zoom_path *p)
{
    for (uint32_t i = 0; i < p->lod.item_count; i++) {
        memset(&p->lod.items[i].state, 0, sizeof p->lod.items[i].state);
        memset(&p->entries[i], 0, sizeof p->entries[i]);
    }
}

uint32_t zoom_path_jitter(zoom_path *p, double jitter)
{
    const uint32_t fade_ticks = p->settings.fade_ticks;
    uint64_t state = 0x9e3779b97f4a7c15ull;
    uint32_t most;
    p->settings.fade_ticks = 1;
    start_again(p);
    for (uint32_t frame = 0; frame < p->frames; frame++) {
        double unit;
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        unit = (double)((state * 2685821657736338717ull) >> 40) / 8388608.0 - 1.0;
        zoom_path_choose(p, frame, zoom_path_place(p, frame, 1.0 + jitter * unit));
    }
    most = zoom_path_most_entered(p);
    start_again(p);
    p->settings.fade_ticks = fade_ticks;
    return most;
}
