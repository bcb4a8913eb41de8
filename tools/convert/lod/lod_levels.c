#include "lod_levels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "lod_fit.h"

#define FRAMES_BUILT 12u     /* frames that the builder sees */
#define FRAMES_CERTIFIED 28u /* frames that the levels are measured in */
#define FINEST_ERROR (1.0f / 4000.0f)
#define ERROR_STEP 4.0f
#define COARSEST_ERROR (1.0f / 16.0f) /* also for shares: with a larger error, the shape is lost */
#define LEVELS_BY_ERROR 5u            /* the coarsest is off by 1/62 of the diagonal */
#define CLIP_LOSS 1.05f               /* the largest cost of a fit in frames of clips */
#define LEAST_SAVED 0.95f             /* of the finer level's triangles: a level with more is left out */

typedef struct pose_list {
    uint32_t count, pairs; /* the first `pairs` poses are pairs of targets; the rest are not the list's */
    float **poses;         /* [count][vertex_count][3] */
} pose_list;

/* ---- pairs of targets ---- */

/* Whether `name` with the first `left` in it turned into `right` is `other`. */
static int is_other_side(const char *name, const char *other, const char *left, const char *right)
{
    const char *found = strstr(name, left);
    const size_t before = found ? (size_t)(found - name) : 0u, length = strlen(right);
    return found && !strncmp(name, other, before) && !strncmp(other + before, right, length) &&
           !strcmp(found + strlen(left), other + before + length);
}

/* Whether they end in L and R, or in l and r after a separator, and are otherwise alike. */
static int is_other_end(const char *name, const char *other)
{
    const size_t last = strlen(name) - 1u;
    const int marked = last > 1u && strchr("._- ", name[last - 1u]);
    return strlen(other) == last + 1u && !strncmp(name, other, last) &&
           ((name[last] == 'L' && other[last] == 'R') || (marked && name[last] == 'l' && other[last] == 'r'));
}

/* Whether two targets are the left and the right half of one expression, by the names that artists give. */
static int is_pair(const char *name, const char *other)
{
    static const char *const sides[3][2] = { { "Left", "Right" }, { "left", "right" }, { "LEFT", "RIGHT" } };
    for (int i = 0; i < 3; i++) {
        if (is_other_side(name, other, sides[i][0], sides[i][1])) {
            return 1;
        }
    }
    return strlen(name) > 1u && is_other_end(name, other);
}

static uint32_t right_of(const model_mesh *mesh, uint32_t target)
{
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        if (is_pair(mesh->targets[target].name, mesh->targets[t].name)) {
            return t;
        }
    }
    return MODEL_NONE;
}

static int add_pair(const model_mesh *mesh, uint32_t left, uint32_t right, pose_list *out)
{
    float *pose = model_zeros(mesh->vertex_count, 3u * sizeof *pose);
    out->poses[out->count++] = pose;
    for (size_t i = 0; pose && i < 3u * (size_t)mesh->vertex_count; i++) {
        pose[i] = mesh->position[i] + mesh->targets[left].position[i] + mesh->targets[right].position[i];
    }
    return !pose;
}

/* ---- the poses of the certificate ---- */

static void poses_free(pose_list *p)
{
    for (uint32_t i = 0; p->poses && i < p->pairs; i++) {
        free(p->poses[i]);
    }
    free(p->poses);
}

/* Pairs first, then the frames. */
static int poses_make(const model_mesh *mesh, const lod_frames *frames, pose_list *out)
{
    int failed = 0;
    memset(out, 0, sizeof *out);
    out->poses = model_zeros(mesh->target_count + frames->count, sizeof *out->poses);
    if (!out->poses) {
        return 1;
    }
    for (uint32_t t = 0; t < mesh->target_count && !failed; t++) {
        uint32_t right = right_of(mesh, t);
        failed = right != MODEL_NONE && add_pair(mesh, t, right, out);
    }
    out->pairs = out->count;
    for (uint32_t i = 0; i < frames->count; i++) {
        out->poses[out->count++] = frames->poses[i];
    }
    return failed;
}

static float larger(float a, float b)
{
    return a > b ? a : b;
}

float lod_worst(const lod_errors *e)
{
    return larger(larger(e->rest, e->targets), larger(e->pairs, e->clip));
}

/* The worst submesh in each pose, and then the worst pose of each kind. */
static lod_errors worst(const model_mesh *mesh, const pose_list *poses, const lod_distance *distances)
{
    const uint32_t columns = 1u + mesh->target_count + poses->count, first_pose = 1u + mesh->target_count;
    lod_errors e = { 0.0f, 0.0f, 0.0f, 0.0f, 0.0f };
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const lod_distance *row = distances + (size_t)s * columns;
        e.rest = larger(e.rest, row[0].max);
        e.rest_p99 = larger(e.rest_p99, row[0].p99);
        for (uint32_t i = 1; i < columns; i++) {
            float *kind = i < first_pose ? &e.targets : i < first_pose + poses->pairs ? &e.pairs : &e.clip;
            *kind = larger(*kind, row[i].max);
        }
    }
    return e;
}

static lod_errors at_least(lod_errors e, const lod_errors *finer)
{
    e.rest = larger(e.rest, finer->rest);
    e.rest_p99 = larger(e.rest_p99, finer->rest_p99);
    e.targets = larger(e.targets, finer->targets);
    e.pairs = larger(e.pairs, finer->pairs);
    e.clip = larger(e.clip, finer->clip);
    return e;
}

/* Those from `first` to before `end`. */
static int certify(const model_mesh *mesh, const pose_list *poses, uint32_t first, uint32_t end, mesh_levels *out,
                   model_error *error)
{
    lod_distance *distances = model_zeros((size_t)mesh->submesh_count * (1u + mesh->target_count + poses->count),
                                          sizeof *distances);
    int failed = !distances && model_fail_memory(error);
    for (uint32_t k = first; k < end && !failed; k++) {
        failed = lod_certify(mesh, &out->built->levels[out->which[k]], (const float *const *)poses->poses, poses->count,
                             distances, error);
        if (!failed) {
            out->errors[k] = at_least(worst(mesh, poses, distances), &out->errors[k - 1]);
        }
    }
    free(distances);
    return failed;
}

/* ---- building ---- */

static float diagonal(const model_mesh *mesh)
{
    float low[3] = { 0.0f, 0.0f, 0.0f }, high[3] = { 0.0f, 0.0f, 0.0f };
    for (uint32_t i = 0; i < 3u * mesh->vertex_count; i++) {
        float p = mesh->position[i];
        low[i % 3u] = i < 3u || p < low[i % 3u] ? p : low[i % 3u];
        high[i % 3u] = i < 3u || p > high[i % 3u] ? p : high[i % 3u];
    }
    for (int c = 0; c < 3; c++) {
        high[c] -= low[c];
    }
    return sqrtf(high[0] * high[0] + high[1] * high[1] + high[2] * high[2]);
}

typedef struct shown {
    FILE *out;
    uint32_t mesh, mesh_count;
} shown;

static void show_progress(void *user, uint32_t done, uint32_t total)
{
    const shown *s = user;
    fprintf(s->out, "\r\033[KLOD levels of mesh %u of %u: %.0f %% ", s->mesh + 1u, s->mesh_count,
            100.0 * done / (total ? total : 1u));
    fflush(s->out);
}

/* Distances that are measured for all meshes together, in about a minute of a processor: the mask with four levels takes
 * a fifth of them. */
#define WORK_MAX (UINT64_C(1) << 32)

/* A mesh's share of them. */
static uint64_t work_of(const model *m, uint32_t index)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        sum += m->meshes[i].index_count;
    }
    return WORK_MAX / sum * m->meshes[index].index_count;
}

static int build(const model *m, uint32_t index, const lod_settings *settings, lod_part part, const lod_frames *frames,
                 mesh_levels *out, model_error *error)
{
    static const float shares[NOH_LOD_LEVELS_MAX] = LOD_SHARES;
    const model_mesh *mesh = &m->meshes[index];
    shown progress = { settings->progress, index, m->mesh_count };
    float errors[NOH_LOD_LEVELS_MAX];
    lod_options o = { 0 };
    o.mode = settings->mode;
    o.color_edges = settings->color_edges;
    o.poses = (const float *const *)frames->poses;
    o.pose_count = frames->count < FRAMES_BUILT ? frames->count : FRAMES_BUILT;
    o.level_count = (settings->by_error ? LEVELS_BY_ERROR : settings->level_count) - 1u;
    o.ratios = shares + 1;
    o.error_max = settings->mode == LOD_QUALITY ? diagonal(mesh) * COARSEST_ERROR : 0.0f; /* else costs are guesses */
    o.asset_triangles = part.asset_triangles;
    o.work_max = work_of(m, index);
    o.progress = settings->progress ? show_progress : NULL;
    o.user = &progress;
    if (part.share > 0.0f) {
        o.level_count = 1;
        o.ratios = &part.share;
    }
    if (settings->by_error) {
        o.errors = errors;
        errors[0] = diagonal(mesh) * FINEST_ERROR;
        for (uint32_t i = 1; i < o.level_count; i++) {
            errors[i] = errors[i - 1u] * ERROR_STEP;
        }
    }
    return lod_build(mesh, &o, &out->built, error);
}

static void choose_levels(const model_mesh *mesh, mesh_levels *out)
{
    float before = (float)mesh->index_count;
    for (uint32_t i = 0; i < out->built->level_count; i++) {
        const uint32_t count = out->built->levels[i].index_count;
        if (count && (float)count <= before * LEAST_SAVED) {
            out->which[out->count++] = i;
            before = (float)count;
        }
    }
}

static int rank_vertices(const model_mesh *mesh, mesh_levels *out, model_error *error)
{
    out->rank = model_zeros(mesh->vertex_count, sizeof *out->rank);
    for (uint32_t k = 1; out->rank && k < out->count; k++) {
        const lod_level *level = &out->built->levels[out->which[k]];
        for (uint32_t i = 0; i < level->index_count; i++) {
            out->rank[level->indices[i]] = (uint8_t)k;
        }
    }
    return out->rank ? 0 : model_fail_memory(error);
}

/* ---- vertices of their own ---- */

/* The finest level from which on all together may have them; levels->count: none. */
static uint32_t first_own(const model_mesh *mesh, const lod_settings *settings, const mesh_levels *levels)
{
    const float share = settings->own_share != 0.0f ? settings->own_share : LOD_OWN_SHARE;
    float left = settings->mode == LOD_FAST ? 0.0f : share * (float)mesh->vertex_count;
    uint32_t k = levels->count;
    while (k > 1u && left >= (float)levels->built->levels[levels->which[k - 1u]].vertex_count) {
        left -= (float)levels->built->levels[levels->which[--k]].vertex_count;
    }
    return k;
}

static float largest_still(const lod_errors *e)
{
    return larger(larger(e->rest, e->targets), e->pairs);
}

/* Whether a fit may stay: no farther at rest and in expressions, and not much farther where joints bend. One part that
 * is stuck may hold up the largest error while all others come nearer. */
static int is_nearer(const lod_errors *now, const lod_errors *before)
{
    return largest_still(now) <= largest_still(before) && now->rest_p99 <= before->rest_p99 &&
           now->clip <= CLIP_LOSS * before->clip;
}

/* Fit a level and, if that moved any vertex, measure it again. */
static int fit_level(model *m, uint32_t index, uint32_t k, lod_frames *frames, mesh_levels *out, model_error *error)
{
    const uint32_t node = lod_skinned_node(m, index);
    model_mesh *mesh = &m->meshes[index];
    const uint32_t vertex_count = mesh->vertex_count;
    pose_list poses = { 0, 0, NULL };
    int failed = lod_fit(mesh, &out->built->levels[out->which[k]], error);
    if (failed || mesh->vertex_count == vertex_count) {
        return failed;
    }
    failed = (node != MODEL_NONE && lod_frames_again(m, node, frames)) || poses_make(mesh, frames, &poses)
                 ? model_fail(error, mesh->name, "out of memory")
                 : certify(mesh, &poses, k, k + 1u, out, error);
    poses_free(&poses);
    return failed;
}

/* Fit a level, or leave it as it was where that takes it farther. */
static int try_level(model *m, uint32_t index, uint32_t k, lod_frames *frames, mesh_levels *out, model_error *error)
{
    model_mesh *mesh = &m->meshes[index];
    lod_level *level = &out->built->levels[out->which[k]];
    const size_t bytes = level->index_count * sizeof *level->indices;
    const uint32_t vertex_count = mesh->vertex_count;
    const lod_errors before = out->errors[k];
    uint32_t *indices = model_zeros(bytes, 1);
    int failed;
    if (!indices) return model_fail(error, mesh->name, "out of memory");
    memcpy(indices, level->indices, bytes);
    failed = fit_level(m, index, k, frames, out, error);
    if (!failed && !is_nearer(&out->errors[k], &before)) {
        mesh->vertex_count = vertex_count;
        memcpy(level->indices, indices, bytes);
        out->errors[k] = before;
    }
    free(indices);
    return failed;
}

static int own_vertices(model *m, uint32_t index, const lod_settings *settings, lod_frames *frames, mesh_levels *out,
                        model_error *error)
{
    int failed = 0;
    for (uint32_t k = first_own(&m->meshes[index], settings, out); k < out->count && !failed; k++) {
        failed = try_level(m, index, k, frames, out, error);
    }
    return failed;
}

/* ---- virtual joints ---- */

/* Bake the targets of coarse levels, and measure these again. */
static int bake_targets(model *m, uint32_t index, const lod_settings *settings, uint32_t full_count, lod_frames *frames,
                        mesh_levels *out, model_error *error)
{
    const uint32_t node = lod_skinned_node(m, index);
    const uint32_t first = settings->face_joints < out->count ? settings->face_joints : out->count - 1u;
    lod_level *levels[NOH_LOD_LEVELS_MAX];
    pose_list poses = { 0, 0, NULL };
    int failed;
    if (!settings->face_joints || out->count < 2u || !lod_joints_allowed(m, index)) return 0;
    for (uint32_t k = first; k < out->count; k++) levels[k - first] = &out->built->levels[out->which[k]];
    failed = lod_joints_make(m, index, full_count, levels, out->count - first, &out->joints, error);
    if (failed || !out->joints.vertex_count) return failed;
    out->joints.level = first;
    failed = lod_frames_again(m, node, frames) || poses_make(&m->meshes[index], frames, &poses)
                 ? model_fail(error, m->meshes[index].name, "out of memory")
                 : certify(&m->meshes[index], &poses, first, out->count, out, error);
    poses_free(&poses);
    return failed || lod_joints_bake(&m->meshes[index], &out->joints, error);
}

int mesh_levels_build(const model *m, uint32_t index, const lod_settings *settings, lod_part part, lod_frames *frames,
                      mesh_levels *out, model_error *error)
{
    const uint32_t node = lod_skinned_node(m, index);
    int failed;
    memset(frames, 0, sizeof *frames);
    memset(out, 0, sizeof *out);
    out->count = 1;
    if ((settings->level_count < 2 && !settings->by_error) || !m->meshes[index].index_count) {
        return 0;
    }
    failed = node != MODEL_NONE && lod_frames_choose(m, node, FRAMES_CERTIFIED, frames) &&
             model_fail(error, m->meshes[index].name, "frames of its clips could not be skinned");
    memcpy(out->cap_error, frames->cap_error, sizeof out->cap_error);
    return failed || build(m, index, settings, part, frames, out, error);
}

int mesh_levels_finish(model *m, uint32_t index, const lod_settings *settings, lod_frames *frames, mesh_levels *out,
                       model_error *error)
{
    const model_mesh *mesh = &m->meshes[index];
    const uint32_t full_count = mesh->vertex_count;
    pose_list poses = { 0, 0, NULL };
    int failed = 0;
    if (out->built) {
        choose_levels(mesh, out);
        failed = (poses_make(mesh, frames, &poses) && model_fail_memory(error)) ||
                 certify(mesh, &poses, 1, out->count, out, error) ||
                 own_vertices(m, index, settings, frames, out, error) ||
                 bake_targets(m, index, settings, full_count, frames, out, error) || rank_vertices(mesh, out, error);
    }
    poses_free(&poses);
    lod_frames_free(frames);
    return failed;
}

int mesh_levels_make(model *m, uint32_t mesh, const lod_settings *settings, mesh_levels *out, model_error *error)
{
    const lod_part whole = { 0, 0.0f };
    lod_frames frames;
    if (mesh_levels_build(m, mesh, settings, whole, &frames, out, error)) {
        lod_frames_free(&frames);
        return 1;
    }
    return mesh_levels_finish(m, mesh, settings, &frames, out, error);
}

void mesh_levels_free(mesh_levels *levels)
{
    lod_free(levels->built);
    lod_joints_free(&levels->joints);
    free(levels->rank);
    memset(levels, 0, sizeof *levels);
}

lod_view mesh_levels_view(const mesh_levels *levels, uint32_t level)
{
    const lod_level *l = &levels->built->levels[levels->which[level]];
    const lod_view view = { l->indices, l->submesh_first, l->submesh_count };
    return view;
}
