/* shapes.c: the faces and frames in which levels are compared. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare.h"

#define SEED UINT64_C(0x756e7365656e)

static double random_unit(uint64_t *state)
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (double)((*state * UINT64_C(0x2545f4914f6cdd1d)) >> 40) / 16777216.0;
}

void shapes_mixed(const model_mesh *mesh, const float *weights, float *position, float *normal)
{
    for (size_t i = 0; i < (size_t)mesh->vertex_count * 3u; i++) {
        position[i] = mesh->position[i];
        for (uint32_t t = 0; t < mesh->target_count; t++) {
            position[i] += weights[t] * mesh->targets[t].position[i];
        }
    }
    for (size_t v = 0; normal && v < mesh->vertex_count; v++) {
        float *n = normal + v * 3u, length;
        for (uint32_t k = 0; k < 3u; k++) {
            n[k] = mesh->normal[v * 3u + k];
            for (uint32_t t = 0; t < mesh->target_count; t++) {
                n[k] += weights[t] * mesh->targets[t].normal[v * 3u + k];
            }
        }
        length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (uint32_t k = 0; k < 3u && length > 0.0f; k++) {
            n[k] /= length;
        }
    }
}

static void random_mix(const model_mesh *mesh, uint64_t *state, float *out)
{
    float *weights = compare_zeros(mesh->target_count, sizeof *weights);
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        double chosen = random_unit(state), weight = random_unit(state);
        weights[t] = chosen < 0.25 ? (float)weight : 0.0f;
    }
    shapes_mixed(mesh, weights, out, NULL);
    free(weights);
}

static int moves_a_node(const model_clip *clip)
{
    for (uint32_t i = 0; i < clip->channel_count; i++) {
        if (clip->channels[i].path == MODEL_PATH_ROTATION) {
            return 1;
        }
    }
    return 0;
}

/* Clips in turn, at random times. */
static void add_frames(const model *m, uint32_t node, uint32_t count, uint64_t *state, shapes *out)
{
    const model_mesh *mesh = &m->meshes[m->nodes[node].mesh];
    uint32_t moving = 0;
    for (uint32_t c = 0; c < m->clip_count; c++) {
        moving += (uint32_t)moves_a_node(&m->clips[c]);
    }
    for (uint32_t c = 0; moving && out->frame_count < count; c = (c + 1u) % m->clip_count) {
        float **to = &out->poses[out->mix_count + out->frame_count];
        if (!moves_a_node(&m->clips[c])) {
            continue;
        }
        *to = compare_zeros((size_t)mesh->vertex_count * 3u, sizeof **to);
        if (lod_frame_pose(m, node, c, random_unit(state) * (double)m->clips[c].duration_s, *to)) {
            abort();
        }
        out->frame_count++;
    }
}

void shapes_make(const model *m, uint32_t mesh, uint32_t mixes, uint32_t frames, shapes *out)
{
    uint64_t state = SEED;
    uint32_t node = lod_skinned_node(m, mesh);
    out->poses = compare_zeros(mixes + frames, sizeof *out->poses);
    out->mix_count = out->frame_count = 0;
    for (uint32_t i = 0; i < mixes; i++, out->mix_count++) {
        out->poses[i] = compare_zeros((size_t)m->meshes[mesh].vertex_count * 3u, sizeof(float));
        random_mix(&m->meshes[mesh], &state, out->poses[i]);
    }
    if (node != MODEL_NONE) {
        add_frames(m, node, frames, &state, out);
    }
}

void shapes_free(shapes *s)
{
    for (uint32_t i = 0; i < s->mix_count + s->frame_count; i++) {
        free(s->poses[i]);
    }
    free(s->poses);
}

static int set_weights(const model_mesh *mesh, const char *const *names, uint32_t count, float *weights)
{
    int found = 0;
    memset(weights, 0, mesh->target_count * sizeof *weights);
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        for (uint32_t i = 0; i < count; i++) {
            if (!strcmp(mesh->targets[t].name, names[i])) {
                weights[t] = 1.0f;
                found = 1;
            }
        }
    }
    return found;
}

int shapes_eyes_shut(const model_mesh *mesh, float *weights)
{
    static const char *const names[] = { "eye-left-closure", "eye-right-closure", "eyeBlinkLeft", "eyeBlinkRight" };
    return set_weights(mesh, names, 4, weights);
}

int shapes_mouth_open(const model_mesh *mesh, float *weights)
{
    static const char *const names[] = { "mouth-open", "jawOpen" };
    return set_weights(mesh, names, 2, weights);
}
