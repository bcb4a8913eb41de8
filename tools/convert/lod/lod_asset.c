/* lod_asset.c: levels of all meshes of an asset, of like error.
 *
 * Every mesh is simplified to far below the coarsest share, which gives its triangles by error. For each level the
 * least error is sought at which all meshes together have no more triangles than the level's share; each is cut
 * there. */
#include "lod_levels.h"

#include <math.h>
#include <stdlib.h>

#include "convert/model/model_build.h"

#define DEPTH 0.25f /* how far each mesh is simplified, as a share of the coarsest level's share */
#define HALVINGS 64u

typedef struct part {
    const lod *order; /* NULL: nothing is drawn */
    uint32_t full;    /* triangles */
    double scale;     /* world units per unit */
    lod_frames frames;
} part;

/* The collapses of a list whose cost is at most `error`, in world units. */
static uint32_t collapses_within(const part *p, double error)
{
    uint32_t low = 0, high = p->order->collapse_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2u;
        if (p->order->collapses[middle].cost * p->scale <= error) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

static double triangles_within(const part *parts, uint32_t count, double error)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t n = parts[i].order ? collapses_within(&parts[i], error) : 0u;
        sum += n ? parts[i].order->collapses[n - 1u].triangles : parts[i].full;
    }
    return sum;
}

/* The least error at which there are no more than `goal` triangles; the largest there is where none is enough. */
static double error_for(const part *parts, uint32_t count, double goal)
{
    double low = 0.0, high = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const lod *l = parts[i].order;
        const double last = l && l->collapse_count ? l->collapses[l->collapse_count - 1u].cost * parts[i].scale : 0.0;
        high = last > high ? last : high;
    }
    for (uint32_t i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (low + high);
        if (triangles_within(parts, count, middle) > goal) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

static void find_errors(const part *parts, uint32_t count, uint32_t level_count, double *errors)
{
    static const float shares[NOH_LOD_LEVELS_MAX] = LOD_SHARES;
    double full = 0.0, least = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        full += parts[i].full;
        least += parts[i].order ? parts[i].order->least : 0u;
    }
    for (uint32_t k = 1; k < level_count; k++) {
        errors[k] = error_for(parts, count, ceil(least + shares[k] * (full - least)));
    }
}

static int cut(const model *m, part *parts, const lod_settings *settings, mesh_levels *out, model_error *error)
{
    double errors[NOH_LOD_LEVELS_MAX] = { 0.0 };
    find_errors(parts, m->mesh_count, settings->level_count, errors);
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        uint32_t collapses[NOH_LOD_LEVELS_MAX];
        for (uint32_t k = 1; out[i].built && k < settings->level_count; k++) {
            collapses[k - 1u] = collapses_within(&parts[i], errors[k]);
        }
        if (out[i].built && lod_cut(&m->meshes[i], out[i].built, collapses, settings->level_count - 1u)) {
            return model_fail(error, m->meshes[i].name, "out of memory for the LOD levels");
        }
    }
    return 0;
}

static int make_together(model *m, const lod_settings *settings, uint32_t triangles, part *parts,
                         mesh_levels *out, model_error *error)
{
    static const float shares[NOH_LOD_LEVELS_MAX] = LOD_SHARES;
    const lod_part deep = { triangles, shares[settings->level_count - 1u] * DEPTH };
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (mesh_levels_build(m, i, settings, deep, &parts[i].frames, &out[i], error)) {
            return 1;
        }
        parts[i].order = out[i].built;
        parts[i].full = m->meshes[i].index_count / 3u;
        parts[i].scale = model_mesh_scale(m, i);
    }
    if (cut(m, parts, settings, out, error)) {
        return 1;
    }
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        if (mesh_levels_finish(m, i, settings, &parts[i].frames, &out[i], error)) {
            return 1;
        }
    }
    return 0;
}

int model_levels_make(model *m, const lod_settings *settings, mesh_levels *out, model_error *error)
{
    uint32_t drawn = 0, triangles = 0;
    part *parts;
    int failed = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        drawn += m->meshes[i].index_count > 0;
        triangles += m->meshes[i].index_count / 3u;
    }
    if (drawn < 2u || settings->by_error || settings->level_count < 2u) {
        for (uint32_t i = 0; i < m->mesh_count && !failed; i++) {
            failed = mesh_levels_make(m, i, settings, &out[i], error);
        }
        return failed;
    }
    parts = model_zeros(m->mesh_count, sizeof *parts);
    failed = !parts ? model_fail(error, "", "out of memory for the LOD levels")
                    : make_together(m, settings, triangles, parts, out, error);
    for (uint32_t i = 0; parts && i < m->mesh_count; i++) {
        lod_frames_free(&parts[i].frames);
    }
    free(parts);
    return failed;
}
