#include "shape_match.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/names.h"
#include "convert/base/recipe_read.h"
#include "convert/model/model_build.h"
#include "convert/model/recipe_whole.h"
#include "raw_set.h"

/* The scalar that means the same as a name with a side behind it. */
static uint32_t find_scalar(const raw_clip *clip, uint32_t count, const char *name, const char *side)
{
    char full[2 * NOH_NAME_BYTES_MAX], means[NOH_NAME_BYTES_MAX];
    (void)snprintf(full, sizeof full, "%s%s", name, side);
    if (!names_find(NAME_TARGET, full, means, NULL)) return MODEL_NONE;
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(clip->floats[i].name, means) == 0) return i;
    }
    return MODEL_NONE;
}

/* The scalars that give a target its weight: two, which may be the same, or none. */
static void sources_of(const raw_clip *clip, uint32_t count, const char *target, uint32_t from[2])
{
    from[0] = from[1] = find_scalar(clip, count, target, "");
    if (from[0] != MODEL_NONE) return;
    from[0] = find_scalar(clip, count, target, "_Left");
    from[1] = find_scalar(clip, count, target, "_Right");
    if (from[0] == MODEL_NONE || from[1] == MODEL_NONE) from[0] = from[1] = MODEL_NONE;
}

/* Centimetres by which a weight of 1 moves the surface. */
static float reach_cm(const model *m, uint32_t mesh, uint32_t target)
{
    const model_mesh *x = &m->meshes[mesh];
    const float *p = x->targets[target].position;
    double most = 0.0;
    for (size_t v = 0; v < x->vertex_count; v++) {
        most = fmax(most, hypot(hypot((double)p[3 * v], (double)p[3 * v + 1]), (double)p[3 * v + 2]));
    }
    return (float)(100.0 * most * (double)model_mesh_scale(m, mesh));
}

/* How much of a target a scalar is, by the rows of its mesh's recipe: expressions of VRM. */
static float share_of(const recipe_text *recipe, const char *scalar, const char *target)
{
    const int blinks = strcmp(scalar, "blink") == 0;
    float sum = 0.0f;
    for (uint32_t i = 0; recipe && i < recipe->count; i++) {
        const recipe_row *row = &recipe->rows[i];
        const char *channel = row->channel + (row->channel[0] == ':');
        const int is_it = strcmp(channel, scalar) == 0 || (blinks && strcmp(channel, "blink-left") == 0);
        if (is_it && strcmp(row->target, target) == 0) sum += row->weight;
    }
    return sum;
}

/* A target's weight by its mesh's recipe. Returns 0 where no scalar moves it. */
static int fill_by_recipe(const recipe_text *recipe, const raw_clip *clip, uint32_t count, const char *name,
                          raw_floats *out, uint32_t target, uint8_t *taken)
{
    int any = 0;
    for (uint32_t i = 0; i < count; i++) {
        const float share = share_of(recipe, clip->floats[i].name, name);
        if (share == 0.0f) continue;
        for (size_t k = 0; k < clip->frame_count; k++) {
            float *to = &out->values[k * out->width + target];
            *to = (any ? *to : 0.0f) + share * clip->floats[i].values[k];
        }
        taken[i] = 1;
        any = 1;
    }
    return any;
}

static void fill(const raw_clip *clip, const uint32_t from[2], float standing, raw_floats *out, uint32_t target)
{
    for (size_t k = 0; k < clip->frame_count; k++) {
        float *to = &out->values[k * out->width + target];
        *to = from[0] == MODEL_NONE ? standing
                                    : 0.5f * (clip->floats[from[0]].values[k] + clip->floats[from[1]].values[k]);
    }
}

/* A target that has the same sources as another which is used has none. */
static int leave_held(const model *m, const model_mesh *mesh, uint32_t (*from)[2])
{
    const uint32_t count = mesh->target_count;
    const char **names = model_zeros(count, sizeof *names);
    uint32_t *meaning = model_zeros(count, sizeof *meaning);
    uint8_t *held = model_zeros(count, 1);
    int failed = !names || !meaning || !held;
    for (uint32_t t = 0; t < count && !failed; t++) {
        names[t] = mesh->targets[t].name;
        meaning[t] = from[t][0] == MODEL_NONE ? MODEL_NONE : 0;
        while (meaning[t] < t && memcmp(from[meaning[t]], from[t], sizeof from[t]) != 0) meaning[t]++;
    }
    failed = failed || targets_find_held(m, names, meaning, count, held);
    for (uint32_t t = 0; t < count && !failed; t++) {
        if (held[t]) from[t][0] = from[t][1] = MODEL_NONE;
    }
    free(names);
    free(meaning);
    free(held);
    return failed;
}

/* The weights of one node, behind the clip's `count` scalars; left out where none of its targets is named. */
static int add_node(const model *m, uint32_t node, uint32_t count, const recipe_text *recipe, raw_clip *clip,
                    uint8_t *taken)
{
    const uint32_t at = m->nodes[node].mesh;
    const model_mesh *mesh = at == MODEL_NONE ? NULL : &m->meshes[at];
    const uint32_t targets = mesh ? mesh->target_count : 0;
    const float *own = m->nodes[node].weights;
    raw_floats *out = &clip->floats[clip->float_count];
    uint32_t(*from)[2] = targets ? model_zeros(targets, sizeof *from) : NULL;
    int any = 0, failed = targets && !from;
    if (!from) return failed;
    memset(out, 0, sizeof *out);
    failed = raw_floats_alloc(out, clip->frame_count, targets);
    if (!failed) {
        out->node = node;
        out->name = model_string(m->nodes[node].name);
        out->radius = model_zeros(targets, sizeof *out->radius);
        clip->float_count++;
        failed = !out->name || !out->radius;
    }
    for (uint32_t t = 0; !failed && t < targets; t++) sources_of(clip, count, mesh->targets[t].name, from[t]);
    failed = failed || leave_held(m, mesh, from);
    for (uint32_t t = 0; !failed && t < targets; t++) {
        out->radius[t] = reach_cm(m, at, t);
        if (fill_by_recipe(recipe, clip, count, mesh->targets[t].name, out, t, taken)) {
            any = 1;
            continue;
        }
        fill(clip, from[t], own ? own[t] : mesh->weights[t], out, t);
        if (from[t][0] == MODEL_NONE) continue;
        taken[from[t][0]] = taken[from[t][1]] = 1;
        any = 1;
    }
    if (!failed && !any) raw_floats_clear(&clip->floats[--clip->float_count]);
    free(from);
    return failed;
}

static int warn(model *m, const char *path, const raw_clip *clip, uint32_t count, const uint8_t *taken)
{
    uint32_t lost = 0, first = 0;
    for (uint32_t i = count; i-- > 0;) {
        if (!taken[i]) lost++, first = i;
    }
    if (lost == count) {
        return model_warn(m, "clip '%.60s': %.100s has no target for its %u shape%s, such as '%s'", clip->name, path,
                          count, count == 1u ? "" : "s", clip->floats[0].name);
    }
    return lost && model_warn(m, "clip '%.60s': %.100s has no target '%s'%s: %u of %u shapes were left out", clip->name,
                              path, clip->floats[first].name, lost > 1 ? " and others" : "", lost, count);
}

int shapes_match(model *m, const char *path, raw_clip *clip)
{
    const uint32_t count = clip->float_count;
    raw_floats *grown = realloc(clip->floats, ((size_t)count + m->node_count + 1u) * sizeof *grown);
    uint8_t *taken = model_zeros(count, 1);
    int failed = !grown || !taken;
    if (grown) clip->floats = grown;
    for (uint32_t n = 0; n < m->node_count && !failed; n++) {
        const char *text = m->nodes[n].mesh == MODEL_NONE ? NULL : m->meshes[m->nodes[n].mesh].recipe;
        recipe_text *recipe = text ? recipe_new() : NULL;
        model_error ignored; /* a recipe with a bad line is reported where it is kept */
        uint32_t line;
        failed = text && !recipe;
        if (recipe) (void)recipe_add_text(recipe, text, strlen(text), &line, &ignored);
        failed = failed || add_node(m, n, count, recipe, clip, taken);
        recipe_free(recipe);
    }
    failed = failed || warn(m, path, clip, count, taken);
    if (!failed && clip->float_count > count) {
        for (uint32_t i = 0; i < count; i++) raw_floats_clear(&clip->floats[i]);
        memmove(clip->floats, clip->floats + count, (clip->float_count - count) * sizeof *clip->floats);
        clip->float_count -= count;
    }
    free(taken);
    return failed;
}
