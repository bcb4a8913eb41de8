#include "recipe_whole.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "noh/face.h"
#include "noh/format.h"

#define SAME 0.5   /* of the smaller target's motion: the targets move the same way from here on */
#define SMALL 0.25 /* of the larger target's motion: a smaller one cannot stand for it */
#define EXACT 0.1  /* of the whole's motion may be missing in its parts */
#define PARTS 3u
#define LANES 8u /* sums at once, so that a sum does not wait for the one before it */

/* ---- motion ---- */

/* The product of two targets' deltas over all meshes that have both. */
static double product(const model *m, const char *a, const char *b)
{
    double sum[LANES] = { 0.0 }, all = 0.0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        const uint32_t at = model_find_target(mesh, a), bt = model_find_target(mesh, b);
        const float *x = at == MODEL_NONE ? NULL : mesh->targets[at].position;
        const float *y = bt == MODEL_NONE ? NULL : mesh->targets[bt].position;
        const size_t count = x && y ? 3u * (size_t)mesh->vertex_count : 0;
        size_t n = 0;
        for (; n + LANES <= count; n += LANES) {
            for (size_t k = 0; k < LANES; k++) sum[k] += (double)x[n + k] * (double)y[n + k];
        }
        for (; n < count; n++) sum[0] += (double)x[n] * (double)y[n];
    }
    for (size_t k = 0; k < LANES; k++) all += sum[k];
    return all;
}

typedef struct held_job {
    const model *m;
    const char *const *names;
    const double *motion; /* each target's product with itself */
    uint8_t *is_same;     /* scratch */
    uint8_t *held;
} held_job;

static int is_larger(const held_job *job, uint32_t i, uint32_t j)
{
    const double a = job->motion[i], b = job->motion[j];
    return a > b || (a == b && i > j);
}

/* Compare a target with the larger ones of its meaning: it is held by one that is much larger, or holds all. */
static void compare(const held_job *job, const uint32_t *meaning, uint32_t count, uint32_t j)
{
    const double own = job->motion[j];
    memset(job->is_same, 0, count);
    for (uint32_t i = 0; i < count && own > 0.0; i++) {
        const int is_small = own < SMALL * job->motion[i];
        if (i == j || meaning[i] != meaning[j] || !is_larger(job, i, j) || (job->held[i] && !is_small)) continue;
        job->is_same[i] = product(job->m, job->names[i], job->names[j]) > SAME * own;
        if (!job->is_same[i] || !is_small) continue;
        job->held[j] = 1;
        return;
    }
    for (uint32_t i = 0; i < count; i++) job->held[i] |= job->is_same[i];
}

int targets_find_held(const model *m, const char *const *names, const uint32_t *meaning, uint32_t count, uint8_t *held)
{
    double *motion = model_zeros(count + 1u, sizeof *motion);
    uint8_t *is_same = model_zeros(count + 1u, 1);
    const held_job job = { m, names, motion, is_same, held };
    const int failed = !motion || !is_same;
    memset(held, 0, count);
    for (uint32_t i = 0; i < count && !failed; i++) motion[i] = product(m, names[i], names[i]);
    for (uint32_t j = 0; j < count && !failed; j++) {
        if (meaning[j] != MODEL_NONE) compare(&job, meaning, count, j);
    }
    free(motion);
    free(is_same);
    return failed;
}

/* ---- whole faces ---- */

static const char whole_word[] = "_ALL_";
static const char *const part_words[PARTS] = { "_BRW_", "_EYE_", "_MTH_" };
#define EYES 1u
#define MOUTH 2u

/* Another target of the same set: name with its word replaced, and with another end (NULL: its own). */
static int sibling(const model *m, const char *name, const char *word, const char *end, char out[NOH_NAME_BYTES_MAX])
{
    const char *at = strstr(name, whole_word);
    const int bytes = at ? snprintf(out, NOH_NAME_BYTES_MAX, "%.*s%s%s", (int)(at - name), name, word,
                                    end ? end : at + sizeof whole_word - 1u)
                         : -1;
    return bytes > 0 && bytes < (int)NOH_NAME_BYTES_MAX && model_has_target(m, out);
}

/* The share of a whole's motion that its parts lack. */
static double lacks(const model *m, const char *whole, char parts[PARTS][NOH_NAME_BYTES_MAX])
{
    const double ww = product(m, whole, whole);
    double left = ww;
    for (uint32_t p = 0; p < PARTS; p++) {
        left -= 2.0 * product(m, whole, parts[p]);
        for (uint32_t q = 0; q < PARTS; q++) left += product(m, parts[p], parts[q]);
    }
    return ww > 0.0 ? left / ww : 1.0;
}

static int has_channel(const recipe_text *recipe, const char *channel, const char *target)
{
    for (uint32_t i = 0; i < recipe->count; i++) {
        if (strcmp(recipe->rows[i].channel, channel) == 0 && (!target || strcmp(recipe->rows[i].target, target) == 0))
            return 1;
    }
    return 0;
}

/* How much of a blink the eyes' part is, at the emotion's whole weight. */
static double shuts(const model *m, const char *whole, const char *eyes)
{
    char close[NOH_NAME_BYTES_MAX];
    if (!sibling(m, whole, part_words[EYES], "Close", close)) return 0.0;
    return product(m, eyes, close) / (product(m, close, close) + 1e-30);
}

static int split_row(recipe_text *recipe, const model *m, uint32_t at, uint32_t emotion)
{
    const char *upper = noh_face_channel_name(NOH_CHANNEL_UPPER + emotion);
    const char *mouth = noh_face_channel_name(NOH_CHANNEL_MOUTH + emotion);
    const char *whole = recipe->rows[at].target;
    const float weight = recipe->rows[at].weight;
    char parts[PARTS][NOH_NAME_BYTES_MAX], *first;
    int failed;
    for (uint32_t p = 0; p < PARTS; p++) {
        if (!sibling(m, whole, part_words[p], NULL, parts[p])) return 0;
    }
    if (has_channel(recipe, mouth, NULL) || lacks(m, whole, parts) > EXACT * EXACT) return 0;
    failed = shuts(m, whole, parts[EYES]) > SAME && !has_channel(recipe, "override-lids", upper) &&
             recipe_add_row(recipe, upper, "override-lids", (float)NOH_OVERRIDE_BLEND, 0);
    first = model_string(parts[0]);
    if (!first) return 1;
    free(recipe->rows[at].target);
    recipe->rows[at].target = first;
    return failed || recipe_add_row(recipe, parts[EYES], upper, weight, 0) ||
           recipe_add_row(recipe, parts[MOUTH], mouth, weight, 0);
}

int recipe_split_whole(recipe_text *recipe, const model *m)
{
    const uint32_t count = recipe->count;
    int failed = 0;
    for (uint32_t i = 0; i < count && !failed; i++) {
        const uint32_t emotion = noh_face_channel_find(recipe->rows[i].channel) - NOH_CHANNEL_UPPER;
        if (!recipe->rows[i].line && emotion < NOH_EMOTION_COUNT) failed = split_row(recipe, m, i, emotion);
    }
    return failed;
}
