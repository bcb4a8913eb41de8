/* lod_track.c: which samples are attached to which triangle, and where they are in each pose.
 *
 * Every removed point and the centroid of every original triangle is a sample that stays attached to the triangle
 * nearest to it (Kobbelt, Campagna and Seidel 1998). A collapse replaces a fan of triangles, and only the samples of
 * that fan can change their distance: so the error against the full mesh, not just against the previous step, is
 * measured locally, and errors of successive collapses cannot accumulate unnoticed. */
#include "lod_track.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* ---- memory ---- */

static int grow(lod_track *t, uint32_t count)
{
    uint32_t poses = t->surface->poses.count, capacity = t->capacity ? t->capacity : 64u;
    if (count <= t->capacity) {
        return 0;
    }
    while (capacity < count) {
        capacity *= 2u;
    }
    free(t->sample);
    free(t->squared);
    free(t->block);
    free(t->match);
    t->match = calloc(capacity, sizeof *t->match);
    t->sample = calloc(capacity, 3u * sizeof *t->sample);
    t->squared = calloc(capacity, 3u * sizeof *t->squared);
    t->block = calloc((size_t)poses * capacity, 12u * sizeof *t->block);
    if (!t->sample || !t->squared || !t->block || !t->match) {
        t->capacity = 0;
        return 1;
    }
    t->triangle = t->sample + capacity;
    t->owner = t->triangle + capacity;
    t->nearest = t->squared + capacity;
    t->worst = t->nearest + capacity;
    for (uint32_t i = 0; i < poses; i++) {
        t->views[i].stamp = 0;
        t->views[i].samples = t->block + (size_t)i * capacity * 12u;
        t->views[i].triangles = t->views[i].samples + (size_t)capacity * 3u;
    }
    t->capacity = capacity;
    return 0;
}

lod_track *lod_track_make(lod_surface *s)
{
    lod_track *t = calloc(1, sizeof *t);
    uint32_t vertices = s->mesh->vertex_count;
    if (!t) {
        return NULL;
    }
    t->surface = s;
    t->first = calloc(s->triangle_count + 1u, sizeof *t->first);
    t->next = calloc((size_t)vertices + s->triangle_count + 1u, sizeof *t->next);
    t->set = calloc(s->poses.words, 2u * sizeof *t->set);
    t->pose = calloc(s->poses.count, sizeof *t->pose);
    t->views = calloc(s->poses.count, sizeof *t->views);
    if (!t->first || !t->next || !t->set || !t->pose || !t->views) {
        lod_track_free(t);
        return NULL;
    }
    t->shows = t->set + s->poses.words;
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        t->first[i] = vertices + i;
        t->next[vertices + i] = LOD_NONE;
    }
    return t;
}

void lod_track_free(lod_track *t)
{
    if (t) {
        free(t->first);
        free(t->next);
        free(t->set);
        free(t->pose);
        free(t->views);
        free(t->sample);
        free(t->squared);
        free(t->block);
        free(t->match);
        free(t);
    }
}

/* ---- opening a fan ---- */

static void add_moves(lod_track *t, uint32_t vertex)
{
    const lod_poses *p = &t->surface->poses;
    for (uint32_t w = 0; w < p->words; w++) {
        t->set[w] |= p->moves[(size_t)vertex * p->words + w];
    }
}

static void add_point(lod_track *t, uint32_t point)
{
    uint32_t words = t->surface->poses.words;
    add_moves(t, point);
    for (uint32_t w = 0; w < words; w++) {
        t->shows[w] |= t->surface->shows[(size_t)point * words + w];
    }
}

static void list_poses(lod_track *t)
{
    uint32_t hot = t->pose_count ? t->pose[0] : 0;
    t->pose_count = 0;
    t->set[0] |= 1u;
    if (lod_set_has(t->set, hot)) {
        t->pose[t->pose_count++] = hot;
    }
    for (uint32_t i = 0; i < t->surface->poses.count; i++) {
        if (i != hot && lod_set_has(t->set, i)) {
            t->pose[t->pose_count++] = i;
        }
    }
}

static void list_samples(lod_track *t, uint32_t count)
{
    const lod_surface *s = t->surface;
    t->count = t->triangle_count = 0;
    for (uint32_t i = 0; i < t->fan->count; i++) {
        for (uint32_t id = t->first[t->fan->corner[i] / 3u]; id != LOD_NONE; id = t->next[id]) {
            t->sample[t->count++] = id;
            if (id < s->mesh->vertex_count) {
                add_point(t, id);
                continue;
            }
            t->triangle[t->triangle_count++] = id - s->mesh->vertex_count;
            for (uint32_t k = 0; k < 3u; k++) {
                add_moves(t, s->mesh->indices[(id - s->mesh->vertex_count) * 3u + k]);
            }
        }
    }
    t->sample[t->count++] = t->fan->point;
    t->padded = (count + LOD_LANES - 1u) / LOD_LANES * LOD_LANES;
}

int lod_track_open(lod_track *t, const lod_fan *fan)
{
    uint32_t count = 1;
    t->fan = fan;
    for (uint32_t i = 0; i < fan->count; i++) {
        for (uint32_t id = t->first[fan->corner[i] / 3u]; id != LOD_NONE; id = t->next[id]) {
            count++;
        }
    }
    if (grow(t, count + LOD_LANES)) {
        return 1;
    }
    memset(t->set, 0, t->surface->poses.words * 2u * sizeof *t->set);
    add_point(t, fan->point);
    for (uint32_t i = 0; i < fan->ring_count; i++) {
        add_moves(t, fan->ring[i]);
    }
    list_samples(t, count);
    list_poses(t);
    t->stamp++;
    return 0;
}

uint64_t lod_track_work(const lod_track *t)
{
    return t->work;
}

const uint32_t *lod_track_triangles(const lod_track *t, uint32_t *count)
{
    *count = t->triangle_count;
    return t->triangle;
}

static void sample_position(const lod_surface *s, uint32_t id, uint32_t pose, float *out)
{
    const uint32_t *corner;
    const float *a, *b, *c;
    if (id < s->mesh->vertex_count) {
        memcpy(out, lod_posed(&s->poses, id, pose), 3u * sizeof *out);
        return;
    }
    corner = s->mesh->indices + (size_t)(id - s->mesh->vertex_count) * 3u;
    a = lod_posed(&s->poses, corner[0], pose);
    b = lod_posed(&s->poses, corner[1], pose);
    c = lod_posed(&s->poses, corner[2], pose);
    for (uint32_t k = 0; k < 3u; k++) {
        out[k] = (a[k] + b[k] + c[k]) * (1.0f / 3.0f);
    }
}

const lod_pose_view *lod_track_view(lod_track *t, uint32_t pose)
{
    const lod_surface *s = t->surface;
    lod_pose_view *v = &t->views[pose];
    if (v->stamp == t->stamp) {
        return v;
    }
    v->stamp = t->stamp;
    for (uint32_t i = 0; i < t->padded; i++) {
        float at[3];
        sample_position(s, t->sample[i < t->count ? i : t->count - 1u], pose, at);
        for (uint32_t k = 0; k < 3u; k++) {
            v->samples[k * t->capacity + i] = at[k];
        }
    }
    for (uint32_t i = 0; i < t->triangle_count; i++) {
        for (uint32_t k = 0; k < 3u; k++) {
            memcpy(v->triangles + (size_t)i * 9u + k * 3u,
                   lod_posed(&s->poses, s->mesh->indices[t->triangle[i] * 3u + k], pose), 3u * sizeof(float));
        }
    }
    return v;
}

/* ---- attaching ---- */

void lod_track_fill(float *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        values[i] = FLT_MAX;
    }
}

/* For one new triangle: the largest distance of each sample over the poses. A sample is attached to the triangle where
 * it is least. */
static void offer_owner(lod_track *t, const lod_move *m, uint32_t which)
{
    float *worst = t->worst;
    memset(worst, 0, t->padded * sizeof *worst);
    for (uint32_t i = 0; i < t->pose_count; i++) {
        const lod_pose_view *v = lod_track_view(t, t->pose[i]);
        float triangle[9];
        lod_move_triangle(t->surface, m->kept[which], m->to, t->pose[i], triangle);
        lod_track_fill(t->squared, t->padded);
        t->work += t->padded;
        lod_distance_triangle(triangle, v->samples, v->samples + t->capacity, v->samples + 2u * t->capacity, t->padded,
                              t->squared);
        for (uint32_t k = 0; k < t->count; k++) {
            float squared = t->squared[k] * t->surface->poses.weight[t->pose[i]];
            worst[k] = squared > worst[k] ? squared : worst[k];
        }
    }
    for (uint32_t k = 0; k < t->count; k++) {
        if (which == 0 || worst[k] < t->nearest[k]) {
            t->nearest[k] = worst[k];
            t->owner[k] = m->kept[which] / 3u;
        }
    }
}

void lod_track_commit(lod_track *t, const lod_move *m)
{
    for (uint32_t i = 0; i < m->kept_count; i++) {
        offer_owner(t, m, i);
    }
    for (uint32_t i = 0; i < t->fan->count; i++) {
        t->first[t->fan->corner[i] / 3u] = LOD_NONE;
    }
    for (uint32_t k = 0; k < t->count; k++) {
        t->next[t->sample[k]] = t->first[t->owner[k]];
        t->first[t->owner[k]] = t->sample[k];
    }
    t->stamp++;
}
