/* lod_poses.c: the shapes that the levels have to follow, as rows of positions by vertex. */
#include "lod_internal.h"

#include <stdlib.h>
#include <string.h>

#define SPARSE_SHARE 0.25 /* of the targets, in every other mix */
#define DENSE_SHARE 0.5
#define DEFAULT_SEED UINT64_C(0x6e6f68206d697865)

/* For each mix, a random share of the targets at weights from 0 to 1. */
static void mix_weights(uint64_t *state, float *weights, uint32_t count, double share)
{
    for (uint32_t t = 0; t < count; t++) {
        double chosen = lod_random(state), weight = lod_random(state);
        weights[t] = chosen < share ? (float)weight : 0.0f;
    }
}

void lod_poses_mixes(uint32_t target_count, float *out)
{
    uint64_t state = DEFAULT_SEED;
    for (uint32_t i = 0; i < LOD_MIXES; i++) {
        mix_weights(&state, out + (size_t)i * target_count, target_count, SPARSE_SHARE);
    }
}

static void put(const lod_poses *p, uint32_t vertex, uint32_t pose, const float *position)
{
    float *row = p->position + ((size_t)vertex * p->count + pose) * 3u;
    const float *rest = p->position + (size_t)vertex * p->count * 3u;
    memcpy(row, position, 3u * sizeof *row);
    if (row[0] != rest[0] || row[1] != rest[1] || row[2] != rest[2]) {
        p->moves[(size_t)vertex * p->words + pose / 64u] |= UINT64_C(1) << (pose % 64u);
    }
}

static void put_mix(const model_mesh *mesh, const lod_poses *p, uint32_t pose, const float *weights)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float at[3];
        memcpy(at, mesh->position + (size_t)v * 3u, sizeof at);
        for (uint32_t t = 0; t < mesh->target_count; t++) {
            const float *delta = mesh->targets[t].position + (size_t)v * 3u;
            for (uint32_t k = 0; k < 3u; k++) {
                at[k] += weights[t] * delta[k];
            }
        }
        put(p, v, pose, at);
    }
}

static void put_rest_and_targets(const model_mesh *mesh, const lod_poses *p)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *rest = mesh->position + (size_t)v * 3u;
        put(p, v, 0, rest);
        for (uint32_t t = 0; t < mesh->target_count; t++) {
            const float *delta = mesh->targets[t].position + (size_t)v * 3u;
            float at[3] = { rest[0] + delta[0], rest[1] + delta[1], rest[2] + delta[2] };
            put(p, v, 1u + t, at);
        }
    }
}

int lod_poses_make(const model_mesh *mesh, const lod_options *o, lod_poses *out)
{
    uint32_t mixes = mesh->target_count > 1u ? (o->mix_count ? o->mix_count : LOD_MIXES) : 0;
    uint64_t state = o->mix_seed ? o->mix_seed : DEFAULT_SEED;
    float *weights = calloc(mesh->target_count + 1u, sizeof *weights);
    uint32_t given = 1u + mesh->target_count + mixes;
    out->first_given = given;
    out->count = given + o->pose_count;
    out->words = (out->count + 63u) / 64u;
    out->position = calloc((size_t)mesh->vertex_count * out->count + 1u, 3u * sizeof *out->position);
    out->moves = calloc((size_t)mesh->vertex_count * out->words + 1u, sizeof *out->moves);
    out->weight = calloc(out->count, sizeof *out->weight);
    if (!weights || !out->position || !out->moves || !out->weight) {
        free(weights);
        return 1; /* the caller frees the poses */
    }
    for (uint32_t i = 0; i < out->count; i++) {
        out->weight[i] = i < given ? 1.0f : o->pose_weight * o->pose_weight;
    }
    out->weight[0] = LOD_REST_WEIGHT * LOD_REST_WEIGHT;
    put_rest_and_targets(mesh, out);
    for (uint32_t i = 0; i < mixes; i++) {
        mix_weights(&state, weights, mesh->target_count, i % 2u ? DENSE_SHARE : SPARSE_SHARE);
        put_mix(mesh, out, 1u + mesh->target_count + i, weights);
    }
    for (uint32_t i = 0; i < o->pose_count; i++) {
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            put(out, v, given + i, o->poses[i] + (size_t)v * 3u);
        }
    }
    free(weights);
    return 0;
}

void lod_poses_free(lod_poses *p)
{
    free(p->position);
    free(p->moves);
    free(p->weight);
}
