/* zoom_path.c: the camera of a zoom in each frame, and the levels entered there. */
#include <math.h>
#include <string.h>

#include "zoom.h"
#include "cli/message.h"

/* The path extends this factor beyond the outermost switches, so that the last fade can end. */
#define BEYOND_NEAR 1.1
#define BEYOND_FAR 1.3

#define SIDE_LEAST 16.0 /* pixels */
#define SIDE_MOST (8192.0 / ZOOM_FINE)

#define PROBE_AWAY 16.0 /* times the distance at which the scene fills a picture: farther than any reach */
#define PROBE_PIXELS 1024u

/* ---- the subject ---- */

int zoom_subject_open(const zoom_subject *s, gpu *g, int by_error, uint32_t fade_ticks, figure *f)
{
    figure_desc desc = s->desc;
    int status;
    desc.without_springs = 1; /* they fade, and levels alone are compared */
    desc.by_error = by_error;
    desc.lod.fade_ticks = fade_ticks;
    status = figure_open(f, &desc, g);
    if (status) {
        return status;
    }
    status = figure_play_options(f, s->clips, s->time_s);
    if (!status) status = figure_hold_options(f, s->weights);
    if (status) {
        figure_close(f);
        return status;
    }
    figure_pause(f);
    return 0;
}

/* ---- the way ---- */

/* Pixels per metre at which a level with this error uses up the share of the error budget that meshes have. */
static double scale_of_share(const zoom_path *p, float error_m)
{
    const noh_lod_settings *lod = &p->shaken.desc.lod;
    return error_m > 0.0f ? (double)lod->pixels * (double)lod->shares[NOH_LOD_MESH] / (double)error_m : 0.0;
}

/* The range of scales from where the finest level is chosen, despite hysteresis, to where the coarsest is. Returns 0
 * where no actor has levels. */
static int find_scales(const zoom_path *p, double *near, double *far)
{
    *near = *far = 0.0;
    for (uint32_t k = 0; k < p->shaken.stage_desc.kind_count; k++) {
        const noh_kind_plan *plan = &p->shaken.plan.kinds[k];
        if (plan->level_count > plan->finest_level + 1u) {
            const double first = scale_of_share(p, plan->levels[plan->finest_level + 1u].error_m) * BEYOND_NEAR;
            const double last = scale_of_share(p, plan->levels[plan->level_count - 1u].error_m) *
                                (1.0 - (double)p->shaken.desc.lod.hysteresis) / BEYOND_FAR;
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
    return p->side / (2.0 * half_view() * scale) + p->reach;
}

/* The largest scale of all actors in the last frame: pixels per metre. */
static double largest_scale(const figure *f)
{
    double most = 0.0;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        noh_actor_detail d;
        if (noh_actor_detail_of(f->stage, f->actors[k], &d, NULL) == NOH_OK) {
            most = fmax(most, (double)d.pixels_per_metre);
        }
    }
    return most;
}

/* Query the stage's scale at one distance: the scale of the nearest point gives its distance. */
static int find_reach(zoom_path *p)
{
    const double away = p->at.distance * PROBE_AWAY;
    orbit far = p->at;
    noh_gl_camera camera;
    double scale;
    int status;
    far.distance = away;
    orbit_camera(&far, &camera);
    status = figure_look(&p->shaken, &camera, PROBE_PIXELS);
    scale = status ? 0.0 : largest_scale(&p->shaken);
    p->reach = scale > 0.0 ? away - PROBE_PIXELS / (2.0 * half_view() * scale) : p->at.radius;
    return status;
}

static int plan(zoom_path *p, const char *path, double near, double far)
{
    double near_scale, far_scale;
    if (!find_scales(p, &near_scale, &far_scale) && (near <= 0.0 || far <= 0.0 || !p->side)) {
        return tool_fail(
            path,
            "no LOD level differs from the full mesh: build levels with `noh build --lod N`, or give --near, --far "
            "and --size");
    }
    if (!p->side) {
        const double wanted = near_scale * 2.0 * half_view() *
                              (p->at.distance - p->at.radius); /* so that the scene fills it */
        p->side = 2u * (uint32_t)fmin(SIDE_MOST / 2.0, fmax(SIDE_LEAST / 2.0, ceil(wanted / 2.0)));
    }
    p->near = near > 0.0 ? near : distance_of(p, near_scale);
    p->far = far > 0.0 ? far : distance_of(p, far_scale);
    if (p->near <= p->at.radius || p->far <= p->near) {
        return tool_usage("--near must exceed the scene's radius, %g, and --far must exceed --near; they are %g and %g",
                          p->at.radius, p->near, p->far);
    }
    if (p->near <= p->reach) p->reach = p->at.radius; /* so near that the finest level is certain */
    return 0;
}

int zoom_path_open(zoom_path *p, const zoom_subject *s, double near, double far, uint32_t side, uint32_t frames)
{
    bounds box;
    int status;
    memset(p, 0, sizeof *p);
    p->side = side;
    p->frames = frames;
    status = zoom_subject_open(s, NULL, 1, 1, &p->shaken);
    if (!status) status = figure_pose(&p->shaken);
    if (status) {
        return status;
    }
    box = figure_bounds(&p->shaken, FRAME_FULL);
    p->at = orbit_fit(&box, 1.0, 0.0);
    status = find_reach(p);
    return status ? status : plan(p, s->desc.file->path, near, far);
}

void zoom_path_close(zoom_path *p)
{
    if (p->shaken.stage) figure_close(&p->shaken);
    memset(p, 0, sizeof *p);
}

/* ---- frame by frame ---- */

static int way_of(const zoom_path *p, uint32_t frame)
{
    return frame >= p->frames / 2u;
}

void zoom_path_place(zoom_path *p, uint32_t frame, double factor)
{
    const uint32_t half = p->frames / 2u, step = way_of(p, frame) ? p->frames - frame : frame;
    const double margin = p->reach - p->at.radius, near = p->near - margin, far = p->far - margin;
    p->at.distance = margin + near * pow(far / near, (double)step / half) * factor;
}

static noh_stage_view view_at(zoom_path *p, uint32_t frame, double factor, uint32_t height)
{
    noh_gl_camera camera;
    zoom_path_place(p, frame, factor);
    orbit_camera(&p->at, &camera);
    return figure_view(&camera, height);
}

int zoom_path_show(zoom_path *p, uint32_t frame, double factor, figure *f)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_stage_view views[2];
    noh_result result;
    views[1] = view_at(p, frame + 1u, 1.0, 0);
    views[0] = view_at(p, frame, factor, p->side);
    views[0].cut = frame == 0;
    result = noh_stage_step(f->stage, ZOOM_TICKS, NULL, NULL, &error);
    if (!result) result = noh_stage_frame_begin(f->stage, views, 2, &error);
    if (!result) result = noh_stage_frame_end(f->stage, &error);
    return result ? tool_fail_error(f->desc.file->path, &error) : 0;
}

void zoom_path_count(zoom_path *p, uint32_t frame, const figure *f)
{
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        zoom_entries *e = &p->entries[k];
        noh_actor_detail d;
        if (noh_actor_detail_of(f->stage, f->actors[k], &d, NULL)) continue;
        e->entered[way_of(p, frame)][d.level] += e->seen && d.level != e->level;
        e->level = d.level;
        e->seen = 1;
    }
}

uint32_t zoom_path_most_entered(const zoom_path *p)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < NOH_STAGE_KINDS_MAX * 2u * NOH_LOD_LEVELS_MAX; i++) {
        const uint32_t times =
            p->entries[i / (2u * NOH_LOD_LEVELS_MAX)].entered[i / NOH_LOD_LEVELS_MAX % 2u][i % NOH_LOD_LEVELS_MAX];
        most = times > most ? times : most;
    }
    return most;
}

uint32_t zoom_path_entered(const zoom_path *p, int way)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < NOH_STAGE_KINDS_MAX * NOH_LOD_LEVELS_MAX; i++) {
        count += p->entries[i / NOH_LOD_LEVELS_MAX].entered[way][i % NOH_LOD_LEVELS_MAX] != 0;
    }
    return count;
}

/* ---- a shaking camera ---- */

int zoom_path_jitter(zoom_path *p, double jitter, uint32_t *most)
{
    uint64_t state = 0x9e3779b97f4a7c15ull;
    int status = 0;
    for (uint32_t frame = 0; frame < p->frames && !status; frame++) {
        double unit;
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        unit = (double)((state * 2685821657736338717ull) >> 40) / 8388608.0 - 1.0;
        status = zoom_path_show(p, frame, 1.0 + jitter * unit, &p->shaken);
        if (!status) zoom_path_count(p, frame, &p->shaken);
    }
    *most = zoom_path_most_entered(p);
    memset(p->entries, 0, sizeof p->entries);
    return status;
}
