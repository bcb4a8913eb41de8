#include "recipe_whole.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "noh/face.h"
#include "noh/format.h"

#define SAME 0.5  /* of the smaller target's motion: the targets move the same way from here on */
#define EXACT 0.1 /* of the whole's motion may be missing in its parts */
#define PARTS 3u

/* ---- motion ---- */

/* The product of two targets' deltas over all meshes that have both. */
static double product(const model *m, const char *a, const char *b)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        const uint32_t at = model_find_target(mesh, a), bt = model_find_target(mesh, b);
        const float *x = at == MODEL_NONE ? NULL : mesh->targets[at].position;
        const float *y = bt == MODEL_NONE ? NULL : mesh->targets[bt].position;
        for (size_t n = 0; x && y && n < 3u * (size_t)mesh->vertex_count; n++) sum += (double)x[n] * (double)y[n];
    }
    return sum;
}

int target_is_held(const model *m, const char *a, const char *b, int b_is_first)
{
    const double aa = product(m, a, a), bb = product(m, b, b), ab = product(m, a, b);
    return bb > 0.0 && (bb < aa || (bb == aa && b_is_first)) && ab > SAME * bb;
}

/* ---- whole faces ---- */

static const char whole_word[] = "_ALL_";
static const char *const part_words[PARTS] = { "_BRW_", "_EYE_", "_MTH_" };
#define EYES 1u
#define MOUTH 2u

static int model_has(const model *m, const char *name)
{
    int has = 0;
    for (uint32_t i = 0; i < m->mesh_count; i++) has |= model_find_target(&m->meshes[i], name) != MODEL_NONE;
    return has;
}

/* Another target of the same set: name with its word replaced, and with another end (NULL: its own). */
static int sibling(const model *m, const char *name, const char *word, const char *end, char out[NOH_NAME_BYTES_MAX])
{
    const char *at = strstr(name, whole_word);
    const int bytes = at ? snprintf(out, NOH_NAME_BYTES_MAX, "%.*s%s%s", (int)(at - name), name, word,
                                    end ? end : at + sizeof whole_word - 1u)
                         : -1;
    return bytes > 0 && bytes < (int)NOH_NAME_BYTES_MAX && model_has(m, out);
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

int recipe_split_whole(recipe_text *recipe, const model *m, uint32_t from)
{
    const uint32_t count = recipe->count;
    int failed = 0;
    for (uint32_t i = from; i < count && !failed; i++) {
        const uint32_t emotion = noh_face_channel_find(recipe->rows[i].channel) - NOH_CHANNEL_UPPER;
        if (emotion < NOH_EMOTION_COUNT) failed = split_row(recipe, m, i, emotion);
    }
    return failed;
}
