/* lod_fit.c: which points of a level may move, all poses, and the copies. */
#include "lod_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "convert/model/vertex_copy.h"
#include "lod_fit_pose.h"

#define ROUNDS_REST 50u
#define ROUNDS_TARGET 12u
#define SWEEPS 2u
#define HARDLY 0.02f /* of the farthest that any vertex moved: one that moved less keeps the full mesh's vertex */

typedef struct fit_job {
    model_mesh *mesh;
    const lod_level *level;
    fitter f;
    uint32_t *point_of; /* [vertex_count] */
    uint8_t *used;      /* [vertex_count] by the level */
    uint8_t *held;      /* [vertex_count] by point: it keeps its place */
    float *posed;       /* [vertex_count][3] the full mesh in a pose */
    float *rest;        /* [vertex_count][3] of the level, fitted */
    float *deltas;      /* [target_count][used_count][3] fitted */
    float *before;      /* [vertex_count][3] of the level in a pose, before a fit */
    float *weights;     /* [target_count] zeros */
    float *mixes;       /* [LOD_MIXES][target_count] */
    float *moved;       /* [used_count] how far each went in the pose where it went farthest */
} fit_job;

/* ---- points ---- */

/* Points that lie at one place at rest and that a target takes apart: lips and lids that touch. */
static int hold_torn(fit_job *j)
{
    const uint32_t count = j->mesh->vertex_count;
    model_mesh still = *j->mesh;
    uint32_t *place = model_zeros(count, 2u * sizeof *place), *only = place ? place + count : NULL;
    still.target_count = 0;
    if (!place || weld_vertices(&still, place)) {
        free(place);
        return 1;
    }
    for (uint32_t v = 0; v < count; v++) {
        only[v] = LOD_NONE;
    }
    for (uint32_t v = 0; v < count; v++) {
        const uint32_t p = j->point_of[v];
        if (only[place[v]] == LOD_NONE) {
            only[place[v]] = p;
        } else if (only[place[v]] != p) {
            j->held[p] = j->held[only[place[v]]] = 1;
        }
    }
    free(place);
    return 0;
}

static int choose_points(fit_job *j)
{
    fitter *f = &j->f;
    for (uint32_t i = 0; i < j->level->index_count; i++) {
        j->used[j->level->indices[i]] = 1;
    }
    if (weld_vertices(j->mesh, j->point_of) || hold_torn(j)) return 1;
    for (uint32_t v = 0; v < j->mesh->vertex_count; v++) {
        f->slot[v] = LOD_NONE;
        if (!j->used[v]) continue;
        f->used[f->used_count++] = v;
        if (!j->held[j->point_of[v]] && f->slot[j->point_of[v]] == LOD_NONE) {
            f->slot[j->point_of[v]] = 0;
            f->point[f->point_count++] = j->point_of[v];
        }
    }
    return 0;
}

/* ---- parts ---- */

/* The points of a submesh, and the centroids of its triangles. */
static void list_samples(const fit_job *j, fit_part *p, uint8_t *taken)
{
    memset(taken, 0, j->mesh->vertex_count);
    for (uint32_t i = 0; i < 3u * p->full_count; i++) {
        const uint32_t point = j->point_of[p->full[i]];
        if (!taken[point]) {
            taken[point] = 1;
            p->sample[p->sample_count++] = point;
        }
    }
    for (uint32_t t = 0; t < p->full_count; t++) {
        p->sample[p->sample_count++] = j->mesh->vertex_count + t;
    }
}

/* At the first corner of the first triangle. */
static fit_match *new_matches(size_t count)
{
    fit_match *matches = model_zeros(count, sizeof *matches);
    for (size_t i = 0; matches && i < count; i++) {
        matches[i].place[0] = 1.0f;
    }
    return matches;
}

static int make_part(fit_job *j, uint32_t submesh, uint8_t *taken)
{
    const model_submesh *sub = &j->mesh->submeshes[submesh];
    fit_part *p = &j->f.parts[j->f.part_count++];
    p->full = j->mesh->indices + sub->first_index;
    p->full_count = sub->index_count / 3u;
    p->coarse = j->level->indices + j->level->submesh_first[submesh];
    p->coarse_count = j->level->submesh_count[submesh] / 3u;
    p->sample = model_zeros(4u * (size_t)p->full_count, sizeof *p->sample);
    p->match = new_matches(4u * (size_t)p->full_count);
    p->back = new_matches((size_t)FIT_BACK * p->coarse_count);
    if (!p->sample || !p->match || !p->back ||
        lod_tree_make(p->full, p->full_count, j->mesh->position, &p->full_tree) ||
        lod_tree_make(p->coarse, p->coarse_count, j->mesh->position, &p->coarse_tree)) {
        return 1;
    }
    list_samples(j, p, taken);
    return 0;
}

static int make_parts(fit_job *j)
{
    uint8_t *taken = model_zeros(j->mesh->vertex_count, 1);
    size_t rows = 0;
    int failed = !taken;
    for (uint32_t s = 0; s < j->mesh->submesh_count && !failed; s++) {
        if (j->mesh->submeshes[s].index_count >= 3u && j->level->submesh_count[s] >= 3u) {
            failed = make_part(j, s, taken);
            rows += j->f.parts[j->f.part_count - 1u].sample_count +
                    (size_t)FIT_BACK * j->f.parts[j->f.part_count - 1u].coarse_count;
        }
    }
    free(taken);
    j->f.rows = failed ? NULL : model_zeros(rows, sizeof *j->f.rows);
    return failed || !j->f.rows;
}

static int make(fit_job *j)
{
    const size_t vertices = j->mesh->vertex_count;
    fitter *f = &j->f;
    j->point_of = model_zeros(vertices, sizeof *j->point_of);
    j->used = model_zeros(vertices, 1);
    j->held = model_zeros(vertices, 1);
    j->posed = model_zeros(vertices, 12u);
    j->rest = model_zeros(vertices, 12u);
    f->mesh = j->mesh;
    f->vertex_count = j->mesh->vertex_count;
    f->point_of = j->point_of;
    f->parts = model_zeros(j->mesh->submesh_count, sizeof *f->parts);
    f->used = model_zeros(vertices, sizeof *f->used);
    f->point = model_zeros(vertices, sizeof *f->point);
    f->start = model_zeros(vertices, 12u);
    f->at = model_zeros(vertices, 12u);
    f->moves = model_zeros(vertices, 1);
    f->slot = model_zeros(vertices, sizeof *f->slot);
    f->seen = model_zeros(vertices, sizeof *f->seen);
    f->slot_point = model_zeros(vertices, sizeof *f->slot_point);
    if (!j->point_of || !j->used || !j->held || !j->posed || !j->rest || !f->parts || !f->used || !f->point ||
        !f->start || !f->at || !f->moves || !f->slot || !f->seen || !f->slot_point || choose_points(j)) {
        return 1;
    }
    j->deltas = model_zeros((size_t)j->mesh->target_count * f->used_count, 12u);
    j->before = model_zeros(vertices, 12u);
    j->weights = model_zeros(j->mesh->target_count, sizeof *j->weights);
    j->mixes = model_zeros((size_t)j->mesh->target_count * LOD_MIXES, sizeof *j->mixes);
    j->moved = model_zeros(f->used_count, sizeof *j->moved);
    f->unknowns = model_zeros(f->point_count, 12u * sizeof *f->unknowns);
    f->best = model_zeros(f->point_count, 12u);
    return !j->deltas || !j->before || !j->weights || !j->mixes || !j->moved || !f->unknowns || !f->best ||
           make_parts(j);
}

static void job_free(fit_job *j)
{
    for (uint32_t i = 0; j->f.parts && i < j->f.part_count; i++) {
        fit_part *p = &j->f.parts[i];
        lod_tree_free(&p->full_tree);
        lod_tree_free(&p->coarse_tree);
        free(p->sample);
        free(p->match);
        free(p->back);
    }
    free(j->f.parts);
    free(j->f.used);
    free(j->f.point);
    free(j->f.start);
    free(j->f.at);
    free(j->f.moves);
    free(j->f.slot);
    free(j->f.seen);
    free(j->f.slot_point);
    free(j->f.rows);
    free(j->f.unknowns);
    free(j->f.best);
    free(j->point_of);
    free(j->used);
    free(j->held);
    free(j->posed);
    free(j->rest);
    free(j->deltas);
    free(j->before);
    free(j->weights);
    free(j->mixes);
    free(j->moved);
}

/* ---- poses ---- */

static void note_moved(fit_job *j)
{
    for (uint32_t i = 0; i < j->f.used_count; i++) {
        const float *a = j->f.at + 3u * (size_t)j->f.used[i], *b = j->f.start + 3u * (size_t)j->f.used[i];
        const float d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
        const float distance = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        j->moved[i] = distance > j->moved[i] ? distance : j->moved[i];
    }
}

static void fit_rest(fit_job *j)
{
    const size_t bytes = 12u * (size_t)j->mesh->vertex_count;
    j->f.full = j->mesh->position;
    memcpy(j->f.start, j->mesh->position, bytes);
    memcpy(j->f.at, j->mesh->position, bytes);
    memset(j->f.moves, 1, j->mesh->vertex_count);
    fit_pose(&j->f, ROUNDS_REST);
    memcpy(j->rest, j->f.at, bytes);
    note_moved(j);
}

static void start_deltas(fit_job *j)
{
    for (uint32_t t = 0; t < j->mesh->target_count; t++) {
        for (uint32_t i = 0; i < j->f.used_count; i++) {
            memcpy(j->deltas + 3u * ((size_t)t * j->f.used_count + i),
                   j->mesh->targets[t].position + 3u * (size_t)j->f.used[i], 12u);
        }
    }
}

static int is_moved(const float *delta)
{
    return delta[0] != 0.0f || delta[1] != 0.0f || delta[2] != 0.0f;
}

/* The full mesh and the level with targets at weights. */
static void set_pose(fit_job *j, const float *weights)
{
    const model_mesh *mesh = j->mesh;
    fitter *f = &j->f;
    memcpy(j->posed, mesh->position, 12u * (size_t)mesh->vertex_count);
    memcpy(f->at, j->rest, 12u * (size_t)mesh->vertex_count);
    memset(f->moves, 0, mesh->vertex_count);
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        const float *delta = mesh->targets[t].position, *fitted = j->deltas + 3u * (size_t)t * f->used_count;
        for (size_t v = 0; weights[t] != 0.0f && v < mesh->vertex_count; v++) {
            if (is_moved(delta + 3u * v)) {
                f->moves[v] = 1;
                for (size_t i = 3u * v; i < 3u * v + 3u; i++) j->posed[i] += weights[t] * delta[i];
            }
        }
        for (size_t i = 0; weights[t] != 0.0f && i < 3u * (size_t)f->used_count; i++) {
            f->at[3u * (size_t)f->used[i / 3u] + i % 3u] += weights[t] * fitted[i];
        }
    }
    memcpy(f->start, j->posed, 12u * (size_t)mesh->vertex_count);
    for (uint32_t i = 0; i < f->used_count; i++) { /* points too, where the level uses another of their vertices */
        memcpy(f->at + 3u * (size_t)j->point_of[f->used[i]], f->at + 3u * (size_t)f->used[i], 12u);
    }
    memcpy(j->before, f->at, 12u * (size_t)mesh->vertex_count);
    f->full = j->posed;
}

/* The change of the pose, as the smallest change of deltas that gives it. A target only moves vertices that it moved
 * before, so that its deltas stay few. */
static void share_out(fit_job *j, const float *weights)
{
    const model_mesh *mesh = j->mesh;
    for (uint32_t i = 0; i < j->f.used_count; i++) {
        const size_t v = 3u * (size_t)j->f.used[i];
        float squares = 0.0f; /* at least 1 in the end: the part of a weak target is dropped */
        for (uint32_t t = 0; t < mesh->target_count; t++) {
            squares += is_moved(mesh->targets[t].position + v) ? weights[t] * weights[t] : 0.0f;
        }
        squares = squares > 1.0f ? squares : 1.0f;
        for (uint32_t t = 0; t < mesh->target_count; t++) {
            float *delta = j->deltas + 3u * ((size_t)t * j->f.used_count + i);
            for (uint32_t k = 0; k < 3u && weights[t] != 0.0f && is_moved(mesh->targets[t].position + v); k++) {
                delta[k] += (j->f.at[v + k] - j->before[v + k]) * weights[t] / squares;
            }
        }
    }
}

static void fit_mix(fit_job *j, const float *weights, uint32_t rounds)
{
    set_pose(j, weights);
    fit_pose(&j->f, rounds);
    share_out(j, weights);
    note_moved(j);
}

static void fit_target(fit_job *j, uint32_t target, uint32_t rounds)
{
    j->weights[target] = 1.0f;
    fit_mix(j, j->weights, rounds);
    j->weights[target] = 0.0f;
}

/* Targets, and then mixes of them in turn with targets: errors that a target hides by sliding along the surface show
 * where it is mixed with others. */
static void fit_targets(fit_job *j)
{
    const uint32_t targets = j->mesh->target_count, mixes = targets > 1u ? LOD_MIXES : 0u;
    for (uint32_t t = 0; t < targets; t++) {
        fit_target(j, t, ROUNDS_TARGET);
    }
    for (uint32_t sweep = 0; sweep < SWEEPS && mixes; sweep++) {
        for (uint32_t t = 0; t < targets; t++) {
            fit_target(j, t, 1);
        }
        for (uint32_t m = 0; m < mixes; m++) {
            fit_mix(j, j->mixes + (size_t)m * targets, 1);
        }
    }
}

/* ---- copies ---- */

static void write_copy(const fit_job *j, uint32_t i, size_t copy)
{
    model_mesh *mesh = j->mesh;
    memcpy(mesh->position + 3u * copy, j->rest + 3u * (size_t)j->f.used[i], 12u);
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        memcpy(mesh->targets[t].position + 3u * copy, j->deltas + 3u * ((size_t)t * j->f.used_count + i), 12u);
    }
}

static int copy_moved(fit_job *j, lod_level *level)
{
    const uint32_t before = j->mesh->vertex_count;
    uint32_t *sources = model_zeros(j->f.used_count, 2u * sizeof *sources),
             *of = sources ? sources + j->f.used_count : NULL, count = 0;
    uint32_t *copy_of = model_zeros(before, sizeof *copy_of);
    float farthest = 0.0f;
    int failed = !sources || !copy_of;
    for (uint32_t i = 0; i < j->f.used_count; i++) {
        farthest = j->moved[i] > farthest ? j->moved[i] : farthest;
    }
    for (uint32_t v = 0; v < before && !failed; v++) {
        copy_of[v] = v;
    }
    for (uint32_t i = 0; i < j->f.used_count && !failed; i++) {
        if (j->moved[i] > HARDLY * farthest) {
            copy_of[j->f.used[i]] = before + count;
            of[count] = i;
            sources[count++] = j->f.used[i];
        }
    }
    failed = failed || (count && model_copy_vertices(j->mesh, sources, count));
    if (!failed) {
        for (uint32_t i = 0; i < count; i++) {
            write_copy(j, of[i], (size_t)before + i);
        }
        for (uint32_t i = 0; i < level->index_count; i++) {
            level->indices[i] = copy_of[level->indices[i]];
        }
    }
    free(sources);
    free(copy_of);
    return failed;
}

int lod_fit(model_mesh *mesh, lod_level *level, model_error *error)
{
    fit_job j;
    int failed;
    memset(&j, 0, sizeof j);
    j.mesh = mesh;
    j.level = level;
    failed = make(&j);
    if (!failed) {
        start_deltas(&j);
        lod_poses_mixes(mesh->target_count, j.mixes);
        fit_rest(&j);
        fit_targets(&j);
        failed = copy_moved(&j, level);
    }
    job_free(&j);
    return failed ? model_fail(error, mesh->name, "out of memory for the vertices of a LOD level") : 0;
}
