/* recipe_chunk.c: what a face's targets are for: of a text, of extras and of names. */
#include "chunk_maker.h"

#include <string.h>

#include "convert/model/recipe_make.h"
#include "convert/model/recipe_whole.h"
#include "convert/model/model_build.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/low_core.h"

/* The text of a recipe. A target that no mesh has is a warning: a recipe may serve several faces, and missing
 * targets fall back. */
static int read_recipe_text(const convert_options *options, const source *s, recipe_text **out,
                            convert_failure *failure)
{
    const char *model_file = failure->file;
    failure->file = options->texts[NOH_CHUNK_RECIPE];
    if (recipe_read(options->texts[NOH_CHUNK_RECIPE], out, &failure->line, &failure->error)) {
        return 1;
    }
    for (uint32_t i = 0; i < (*out)->count; i++) {
        const recipe_row *row = &(*out)->rows[i];
        if (strncmp(row->channel, "override-", 9) == 0 || strcmp(row->channel, "binary") == 0 ||
            strncmp(row->channel, "phone-", 6) == 0) {
            continue;
        }
        const int is_joint = strncmp(row->channel, "joint-", 6) == 0;
        const int is_there = is_joint ? source_has_joint(s, row->target) : model_has_target(s->m, row->target);
        if (!is_there && model_warn(s->m, "%s:%u: no %s '%s'", options->texts[NOH_CHUNK_RECIPE], row->line,
                                    is_joint ? "skeleton has the joint" : "mesh has the target", row->target)) {
            return model_fail_memory(&failure->error);
        }
        if ((row->channel[0] == '+' || row->channel[0] == ':') && !model_has_target(s->m, row->channel + 1) &&
            model_warn(s->m, "%s:%u: no mesh has the target '%s'", options->texts[NOH_CHUNK_RECIPE], row->line,
                       row->channel + 1)) {
            return model_fail_memory(&failure->error);
        }
    }
    for (uint32_t i = 0; i < (*out)->wrinkle_count; i++) {
        const wrinkle_row *row = &(*out)->wrinkles[i];
        if (!model_has_target(s->m, row->target) &&
            model_warn(s->m, "%s:%u: no mesh has the target '%s'", options->texts[NOH_CHUNK_RECIPE], row->line,
                       row->target)) {
            return model_fail_memory(&failure->error);
        }
    }
    failure->line = 0;
    failure->file = model_file;
    return 0;
}

static int add_joints(recipe_text *recipe, const source *s)
{
    int failed = 0;
    for (uint32_t i = 0; i < s->set_count && !failed; i++) {
        const raw_skeleton *k = &s->sets[i]->skeleton;
        const char *names[NOH_JOINTS_MAX];
        uint32_t count = 0;
        for (; count < k->joint_count && count < NOH_JOINTS_MAX; count++) {
            names[count] = k->joints[count].name ? k->joints[count].name : "";
        }
        failed = recipe_add_joints(recipe, names, count);
    }
    return failed;
}

/* Of a text, of extras, of names. */
static int read_recipe(const convert_options *options, const source *s, void **made, convert_failure *failure)
{
    recipe_text *recipe = NULL;
    uint32_t named = 0, known = 0;
    if (options->only == CONVERT_CLIPS) {
        return 0;
    }
    const int failed = options->texts[NOH_CHUNK_RECIPE] && read_recipe_text(options, s, &recipe, failure);
    if (!recipe) recipe = recipe_new();
    *made = recipe;
    if (failed) return 1;
    if (!recipe || recipe_add_extras(recipe, s->m) || recipe_add_lips(recipe, s->m) ||
        recipe_add_known(recipe, s->m, &known) || recipe_split_whole(recipe, s->m) ||
        (s->m->mesh_count && add_joints(recipe, s)) ||
        (!options->no_correctives && recipe_add_named(recipe, s->m, &named))) {
        return recipe_fail(recipe, &failure->error);
    }
    if (named && options->report) {
        fprintf(options->report, "%u correctives by target names (--no-correctives turns them off)\n", named);
    }
    if (known && options->report) {
        fprintf(options->report, "%u rows of the face's recipe by the names of its targets (noh face shows them)\n",
                known);
    }
    if (!recipe->count && !recipe->wrinkle_count) {
        recipe_free(recipe);
        *made = NULL;
    }
    return 0;
}

static void write_recipe(pack_writer *w, const void *made)
{
    const recipe_text *recipe = made;
    noh_recipe_header h;
    if (!recipe || !recipe->count) return;
    memset(&h, 0, sizeof h);
    h.row_count = recipe->count;
    h.rows_offset = sizeof h;
    chunk_begin(w, NOH_CHUNK_RECIPE, "");
    buffer_append(&w->out, &h, sizeof h);
    for (uint32_t i = 0; i < recipe->count; i++) {
        noh_recipe_row row;
        memset(&row, 0, sizeof row);
        row.target = string_offset(&w->strings, recipe->rows[i].target);
        row.target_hash = noh_hash_name(recipe->rows[i].target);
        row.channel = string_offset(&w->strings, recipe->rows[i].channel);
        row.channel_hash = noh_hash_name(recipe->rows[i].channel);
        row.weight = recipe->rows[i].weight;
        buffer_append(&w->out, &row, sizeof row);
    }
    chunk_end(w);
}

static void free_recipe(void *made)
{
    recipe_free(made);
}

const chunk_maker chunk_recipe = { read_recipe, 0, free_recipe, write_recipe, NULL };
