#include "convert.h"

#include <stdlib.h>
#include <string.h>

#include "convert/clips/events_read.h"
#include "convert/clips/joint_order.h"
#include "convert/light/pack_transfer.h"
#include "convert/mocap/clean.h"
#include "convert/model/model_build.h"
#include "convert/model/recipe_make.h"
#include "convert/model/surface_kind.h"
#include "convert/model/surface_shape.h"
#include "convert/model/texture_cut.h"
#include "convert/model/priority.h"
#include "convert/model/tint.h"
#include "convert/pack/pack_graph.h"
#include "convert/pack/size_warn.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_life.h"
#include "noh/pack.h"
#include "convert/springs/springs_bind.h"
#include "convert/texture/texture_trim.h"
#include "sources.h"

/* How far targets that a level leaves out may move the surface, as a share of that level's error: both add up to the
 * largest error in pixels (low_stage.h). */
#define SKIP_SHARE (1.0f / 3.0f)

static int out_of_memory(model_error *error)
{
    snprintf(error->what, sizeof error->what, "out of memory");
    error->where[0] = 0;
    return 1;
}

static int has_moves(const source *s)
{
    for (uint32_t i = 0; i < s->set_count; i++) {
        for (uint32_t c = 0; c < s->sets[i]->clip_count; c++) {
            if (s->sets[i]->clips[c].joint_count) return 1;
        }
    }
    return 0;
}

static int apply_events(const convert_options *options, source *s, model_error *error)
{
    event_list *list = NULL;
    int failed;
    if ((options->source.clean & CLEAN_KEYS) && !has_moves(s)) {
        return model_fail(error, "", "--clean contact-keys needs a clip that moves joints, and there is none");
    }
    if (!options->events) {
        return 0;
    }
    failed = events_read(options->events, &list, error) || events_apply(list, s->sets, s->set_count, error);
    events_free(list);
    return failed;
}

/* The graphs, checked against the inputs; *out NULL: there are none. */
static int read_graphs(const convert_options *options, const source *s, graph_file **out, convert_failure *failure)
{
    const char *model_file = failure->file;
    *out = NULL;
    if (!options->graph) {
        return 0;
    }
    failure->file = options->graph;
    if (graph_text_read(options->graph, out, &failure->line, &failure->error) ||
        graph_text_bind(*out, s->sets, s->set_count, &failure->line, &failure->error)) {
        return 1;
    }
    if (graph_text_warn(*out, s->sets, s->set_count, options->clip.check_loops, options->graph, s->m)) {
        return out_of_memory(&failure->error);
    }
    failure->file = model_file;
    return 0;
}

static int has_target(const model *m, const char *name)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t t = 0; t < m->meshes[i].target_count; t++) {
            if (strcmp(m->meshes[i].targets[t].name, name) == 0) return 1;
        }
    }
    return 0;
}

/* The text of a recipe. A target that no mesh has is a warning: a recipe may serve several faces, and missing
 * targets fall back. */
static int read_recipe_text(const convert_options *options, const source *s, recipe_text **out,
                            convert_failure *failure)
{
    const char *model_file = failure->file;
    failure->file = options->recipe;
    if (recipe_read(options->recipe, out, &failure->line, &failure->error)) {
        return 1;
    }
    for (uint32_t i = 0; i < (*out)->count; i++) {
        const recipe_row *row = &(*out)->rows[i];
        if (!has_target(s->m, row->target) &&
            model_warn(s->m, "%s:%u: no mesh has the target '%s'", options->recipe, row->line, row->target)) {
            return out_of_memory(&failure->error);
        }
        if (row->channel[0] == '+' && !has_target(s->m, row->channel + 1) &&
            model_warn(s->m, "%s:%u: no mesh has the target '%s'", options->recipe, row->line, row->channel + 1)) {
            return out_of_memory(&failure->error);
        }
    }
    for (uint32_t i = 0; i < (*out)->wrinkle_count; i++) {
        const wrinkle_row *row = &(*out)->wrinkles[i];
        if (!has_target(s->m, row->target) &&
            model_warn(s->m, "%s:%u: no mesh has the target '%s'", options->recipe, row->line, row->target)) {
            return out_of_memory(&failure->error);
        }
    }
    failure->line = 0;
    failure->file = model_file;
    return 0;
}

static int has_joint(const source *s, const char *name)
{
    for (uint32_t i = 0; i < s->set_count; i++) {
        const raw_skeleton *k = &s->sets[i]->skeleton;
        for (uint32_t j = 0; j < k->joint_count; j++) {
            if (strcmp(k->joints[j].name, name) == 0) return 1;
        }
    }
    return 0;
}

/* The ragdoll of a text; *out NULL: there is none. A joint that is not there is an error: the body would lack it. */
static int read_ragdoll(const convert_options *options, const source *s, ragdoll_text **out, convert_failure *failure)
{
    const char *model_file = failure->file;
    *out = NULL;
    if (!options->ragdoll || options->only == CONVERT_CLIPS) return 0;
    failure->file = options->ragdoll;
    if (ragdoll_read(options->ragdoll, out, &failure->line, &failure->error)) return 1;
    for (uint32_t i = 0; i < (*out)->count; i++) {
        if (has_joint(s, (*out)->rows[i].joint)) continue;
        failure->line = (*out)->rows[i].line;
        (void)snprintf(failure->error.what, sizeof failure->error.what, "no skeleton has the joint '%s'",
                       (*out)->rows[i].joint);
        failure->error.where[0] = 0;
        return 1;
    }
    failure->line = 0;
    failure->file = model_file;
    return 0;
}

/* The haircut of a text, grown; *out NULL: there is none. */
static int read_hair(const convert_options *options, const source *s, hair_text **out, hair_grown *grown,
                     convert_failure *failure)
{
    const char *model_file = failure->file;
    *out = NULL;
    memset(grown, 0, sizeof *grown);
    if (!options->hair || options->only == CONVERT_CLIPS) return 0;
    failure->file = options->hair;
    if (hair_read(options->hair, out, &failure->line, &failure->error)) return 1;
    if ((*out)->joint && !has_joint(s, (*out)->joint)) {
        (void)snprintf(failure->error.what, sizeof failure->error.what, "no skeleton has the joint '%s'",
                       (*out)->joint);
        failure->error.where[0] = 0;
        return 1;
    }
    failure->line = 0;
    failure->file = model_file;
    return hair_grow(*out, grown) ? out_of_memory(&failure->error) : 0;
}

/* The ground; *out NULL: there is none. */
static int read_terrain(const convert_options *options, terrain *read, const terrain **out, convert_failure *failure)
{
    const char *model_file = failure->file;
    memset(read, 0, sizeof *read);
    *out = NULL;
    if (!options->terrain) return 0;
    failure->file = options->terrain;
    if (terrain_read(options->terrain, &options->ground, read, &failure->error)) return 1;
    if (options->report) {
        fprintf(options->report, "terrain: %u x %u heights, %g x %g m, %.3f to %.3f m, steps of %.3g mm", read->width,
                read->depth, (double)read->spacing * (read->width - 1u), (double)read->spacing * (read->depth - 1u),
                (double)read->low, (double)read->high, 1000.0 * (double)read->scale);
        if (read->hole_count) fprintf(options->report, "; %u without ground, set to the lowest", read->hole_count);
        fprintf(options->report, "\n");
    }
    failure->file = model_file;
    *out = read;
    return 0;
}

/* The recipe: of a text, of extras, of names; *out NULL: there is none. */
static int read_recipe(const convert_options *options, const source *s, recipe_text **out, convert_failure *failure)
{
    uint32_t named = 0;
    *out = NULL;
    if (options->only == CONVERT_CLIPS) {
        return 0;
    }
    if (options->recipe && read_recipe_text(options, s, out, failure)) {
        return 1;
    }
    if (!*out) *out = recipe_new();
    if (!*out || recipe_add_extras(*out, s->m) || recipe_add_lips(*out, s->m) ||
        (!options->no_correctives && recipe_add_named(*out, s->m, &named))) {
        (void)snprintf(failure->error.what, sizeof failure->error.what,
                       "out of memory for the recipe, or it has more than %u rows", NOH_FACE_ROWS_MAX);
        return 1;
    }
    if (named && options->report) {
        fprintf(options->report, "%u correctives by target names (--no-correctives turns them off)\n", named);
    }
    if (!(*out)->count && !(*out)->wrinkle_count) {
        recipe_free(*out);
        *out = NULL;
    }
    return 0;
}

/* ---- springs ---- */

/* A line of the command line; it has no number. */
static int read_spring_line(const char *given, springs_text *text, convert_failure *failure)
{
    const uint32_t chains = text->chain_count, colliders = text->collider_count;
    uint32_t line;
    if (springs_text_add(text, given, strlen(given), &line, &failure->error)) {
        failure->file = given;
        failure->error.where[0] = 0;
        return 1;
    }
    for (uint32_t i = chains; i < text->chain_count; i++) text->chains[i].line = 0;
    for (uint32_t i = colliders; i < text->collider_count; i++) text->colliders[i].line = 0;
    return 0;
}

/* The springs of the file's extras and of its extension. */
static int bind_own_springs(const source *s, set_springs *out, convert_failure *failure)
{
    springs_text *text = springs_text_new();
    const char *lines = s->m->spring_lines;
    uint32_t line = 0;
    int failed = !text;
    for (; !failed && lines && *lines; lines += strcspn(lines, "\n") + 1u) {
        const size_t size = strcspn(lines, "\n");
        if (springs_text_add(text, lines, size, &line, &failure->error)) {
            failed = model_warn(s->m, "springs in extras: '%.*s' was left out: %s", (int)(size < 60u ? size : 60u),
                                lines, failure->error.what);
        }
    }
    memset(&failure->error, 0, sizeof failure->error);
    if (failed || springs_bind_nodes(s->m, s->sets, s->set_count, out)) {
        springs_text_free(text);
        return out_of_memory(&failure->error);
    }
    failed = springs_bind_text(text, s->m, s->sets, s->set_count, 1, out, &line, &failure->error);
    springs_text_free(text);
    return failed;
}

static int read_given_springs(const convert_options *options, springs_text *text, convert_failure *failure)
{
    if (options->springs && springs_text_read(text, options->springs, &failure->line, &failure->error)) {
        failure->file = options->springs;
        return 1;
    }
    for (uint32_t i = 0; i < options->spring_line_count; i++) {
        if (read_spring_line(options->spring_lines[i], text, failure)) return 1;
    }
    return 0;
}

static int bind_given_springs(const convert_options *options, const source *s, set_springs *out,
                              convert_failure *failure)
{
    springs_text *text = springs_text_new();
    int failed = text ? read_given_springs(options, text, failure) : out_of_memory(&failure->error);
    if (!failed && springs_bind_text(text, s->m, s->sets, s->set_count, 0, out, &failure->line, &failure->error)) {
        failure->file = failure->line ? options->springs : "--spring";
        failed = 1;
    }
    springs_text_free(text);
    return failed;
}

/* *out [set_count]: what swings, in all skeletons; joints are in their last order. */
static int read_springs(const convert_options *options, const source *s, set_springs **out, convert_failure *failure)
{
    int failed;
    *out = calloc(s->set_count + 1u, sizeof **out);
    if (!*out) return out_of_memory(&failure->error);
    if (options->only == CONVERT_CLIPS) return 0;
    failed = options->springs || options->spring_line_count ? bind_given_springs(options, s, *out, failure)
                                                            : bind_own_springs(s, *out, failure);
    return failed || (springs_sort(*out, s->set_count) && out_of_memory(&failure->error));
}

/* ---- encoding ---- */

/* The meshes of a model, encoded. */
typedef struct encoded {
    uint32_t count;
    mesh_levels *levels;     /* [count] */
    morph_encoding **morphs; /* [count] */
} encoded;

static int encoded_make(uint32_t count, encoded *e)
{
    e->count = count;
    e->levels = calloc(count + 1u, sizeof *e->levels);
    e->morphs = calloc(count + 1u, sizeof *e->morphs);
    return !e->levels || !e->morphs;
}

static void encoded_free(encoded *e)
{
    for (uint32_t i = 0; i < e->count && e->levels && e->morphs; i++) {
        mesh_levels_free(&e->levels[i]);
        morph_encoding_free(e->morphs[i]);
    }
    free(e->levels);
    free(e->morphs);
}

static void say(const convert_options *options, const char *what, const model *m, uint32_t index)
{
    if (options->progress) {
        fprintf(options->progress, "\r\033[K%s of mesh %u of %u ", what, index + 1, m->mesh_count);
        fflush(options->progress);
    }
}

static int encode_mesh(const model *m, uint32_t index, const convert_options *options, encoded *e, model_error *error)
{
    const model_mesh *mesh = &m->meshes[index];
    const float scale = model_mesh_scale(m, index);
    float skip_radius[NOH_LOD_LEVELS_MAX];
    morph_options morph = options->morph;
    morph.error_um = (morph.error_um > 0.0f ? morph.error_um : 10.0f) /
                     scale; /* given in world units, held in the mesh's own */
    morph.rank = e->levels[index].rank;
    morph.level_count = e->levels[index].count;
    morph.skip_radius = skip_radius;
    for (uint32_t k = 0; k < morph.level_count; k++) {
        skip_radius[k] = lod_worst(&e->levels[index].errors[k]) * SKIP_SHARE;
    }
    say(options, "targets", m, index);
    if (morph_encode(mesh, &morph, &e->morphs[index], error)) {
        return 1;
    }
    if (options->report) {
        convert_report_mesh(options->report, mesh, e->morphs[index], scale, morph.error_um * scale);
        convert_report_lods(options->report, mesh, &e->levels[index], scale);
    }
    return 0;
}

static int encode_meshes(model *m, const convert_options *options, encoded *e, model_error *error)
{
    lod_settings levels = options->lod;
    int failed;
    levels.progress = options->progress;
    failed = model_levels_make(m, &levels, e->levels, error);
    for (uint32_t i = 0; i < m->mesh_count && !failed; i++) {
        failed = encode_mesh(m, i, options, e, error);
    }
    if (options->progress) {
        fputs("\r\033[K", options->progress); /* clear the terminal's line */
    }
    return failed;
}

/* Whether the rows of its table hang together. */
static int check_ragdoll(const noh_pack *pack, model_error *error)
{
    for (uint32_t i = 0; pack->ragdoll_row_count && i < pack->skeleton_count; i++) {
        noh_ragdoll_source s = { .pack = pack, .skeleton = i };
        const noh_skeleton_header *header;
        noh_ragdoll_row rows[NOH_RAGDOLL_BODIES_MAX];
        noh_ragdoll_rig rig;
        noh_error refusal = { NOH_OK, "", 0, 0 };
        uint32_t count;
        if (noh_pack_skeleton_at(pack, i, &s.joints, &header, NULL)) continue;
        s.metres = header->unit_cm / 100.0f;
        if (noh_ragdoll_find_rows(&s, rows, &count, NULL) || count != pack->ragdoll_row_count) continue;
        if (!noh_ragdoll_rig_make(&s, rows, count, &rig, &refusal)) continue;
        (void)snprintf(error->what, sizeof error->what, "--ragdoll: %s ('%s')", refusal.what,
                       noh_pack_joint_name(pack, i, rows[refusal.where < count ? refusal.where : 0].joint));
        error->where[0] = 0;
        return 1;
    }
    return 0;
}

/* Open the pack with the library's own reader: a pack that it refuses is never written. */
static int check_own_pack(byte_buffer *out, FILE *report, model_error *error)
{
    noh_pack pack;
    noh_error refusal = { NOH_OK, "", 0, 0 };
    if (noh_pack_open(out->bytes, out->count, &pack, &refusal)) {
        snprintf(error->what, sizeof error->what,
                 "the built pack does not open: %s (byte %llu); this is a bug in noh: please report it", refusal.what,
                 (unsigned long long)refusal.where);
        error->where[0] = 0;
        buffer_free(out);
        return 1;
    }
    if (pack_check_graphs(&pack, error) || check_ragdoll(&pack, error)) {
        buffer_free(out);
        return 1;
    }
    if (report) {
        convert_report_textures(report, &pack);
        convert_report_skins(report, &pack);
    }
    return 0;
}

/* Add transfers, from the finished pack: so they fit the vertices as they are stored. */
static int add_transfers(byte_buffer *out, const convert_options *options, model_error *error)
{
    transfer_settings settings = options->transfer;
    byte_buffer with = { NULL, 0, 0, 0 };
    noh_pack pack;
    int failed;
    if (!settings.order) {
        return 0;
    }
    settings.progress = options->progress;
    (void)noh_pack_open(out->bytes, out->count, &pack, NULL); /* check_own_pack opened it */
    failed = pack_transfer(&pack, &settings, &with, error);
    if (options->progress) {
        fputs("\r\033[K", options->progress);
    }
    buffer_free(out);
    *out = with;
    return failed || check_own_pack(out, NULL, error);
}

/* Leave out the finest levels, from the finished pack, which gives the same bytes as `noh strip`. */
static int strip(byte_buffer *out, const strip_levels *levels, model_error *error)
{
    byte_buffer stripped = { NULL, 0, 0, 0 };
    uint32_t *first;
    noh_pack pack;
    int failed;
    if (!levels->count) {
        return 0;
    }
    (void)noh_pack_open(out->bytes, out->count, &pack, NULL); /* check_own_pack opened it */
    first = calloc(pack.mesh_count + 1u, sizeof *first);
    failed = first ? strip_levels_of(levels, &pack, first, error) || pack_strip(&pack, first, &stripped, error)
                   : out_of_memory(error);
    free(first);
    buffer_free(out);
    *out = stripped;
    return failed || check_own_pack(out, NULL, error);
}

static void report_warnings(FILE *report, const source *s)
{
    for (uint32_t i = 0; i < s->m->warning_count; i++) {
        fprintf(report, "warning: %s\n", s->m->warnings[i]);
    }
    for (uint32_t i = 0; i < s->set_count; i++) {
        if (s->sets[i]->warning) {
            fprintf(report, "warning: %s\n", s->sets[i]->warning);
        }
    }
}

static int make_wrinkles(const source *s, const recipe_text *recipe, const convert_options *options, model_error *error)
{
    wrinkle_settings settings = options->wrinkles;
    settings.report = options->report;
    settings.recipe = recipe;
    return options->only != CONVERT_CLIPS && wrinkles_make(s->m, &settings, error);
}

static void set_textures(const source *s, const convert_options *options)
{
    texture_cut_mark(s->m);
    for (uint32_t i = 0; i < s->m->texture_count; i++) {
        s->m->textures[i].etc2 = options->etc2 != 0;
        s->m->textures[i].size_max = options->texture_max;
    }
}

/* Once the levels are known, since a level's triangles read the textures too. */
static int trim_textures(model *m, const mesh_levels *levels, const convert_options *options, model_error *error)
{
    texture_trimmed done;
    if (options->whole_textures || options->only == CONVERT_CLIPS) return 0;
    if (texture_trim(m, levels, &done)) return out_of_memory(error);
    if (options->report && done.count) {
        fprintf(options->report,
                "%u of %u textures trimmed to what triangles read: %.0f%% of their texels are left "
                "(--whole-textures keeps all)\n",
                done.count, m->texture_count, 100.0 * (double)done.texels / (double)done.whole);
    }
    return 0;
}

static int convert_source(const source *s, const pack_extras *extras, const convert_options *options, byte_buffer *out,
                          model_error *error)
{
    model empty;
    model *m = options->only == CONVERT_CLIPS ? memset(&empty, 0, sizeof empty) : s->m;
    clips_settings settings = options->clip;
    encoded meshes;
    encoded_clips made;
    int failed;
    if (encoded_make(m->mesh_count, &meshes)) {
        encoded_free(&meshes);
        return out_of_memory(error);
    }
    settings.report = options->report;
    settings.progress = options->progress;
    settings.skeletons_only = options->only == CONVERT_MESH;
    settings.m = s->m;
    failed = make_wrinkles(s, extras->recipe, options, error);
    set_textures(s, options);
    if (!failed && options->only != CONVERT_MESH && size_warn(s->m, s->sets, s->set_count, settings.clip.error_cm)) {
        failed = out_of_memory(error);
    }
    if (options->report) {
        report_warnings(options->report, s);
    }
    failed = failed || pack_check_model(m, error) || encode_meshes(m, options, &meshes, error) ||
             trim_textures(s->m, meshes.levels, options, error);
    if (!failed) {
        failed = clips_encode(s->sets, s->set_count, &settings, &made, error);
        made.extras = *extras;
        failed = failed || pack_write(m, meshes.levels, meshes.morphs, &made, out, error) ||
                 check_own_pack(out, options->report, error) || add_transfers(out, options, error) ||
                 strip(out, &options->lod_from, error);
        clips_free(&made);
    }
    encoded_free(&meshes);
    return failed;
}

/* The input that gives the model: the first with meshes, else the first. */
static int base_of(const source *all, int count)
{
    for (int i = 0; i < count; i++) {
        if (all[i].m->mesh_count) {
            return i;
        }
    }
    return 0;
}

static int read_all(const char *const *inputs, int count, const convert_options *options, source *all,
                    convert_failure *failure)
{
    source_options reading = options->source;
    reading.skin.report = options->report;
    for (int i = 0; i < count; i++) {
        failure->file = inputs[i];
        if (source_read(inputs[i], &reading, &all[i], &failure->error)) {
            return 1;
        }
        if (all[i].m->mesh_count) { /* people and eyes are made of the first model */
            reading.identity = NULL;
            reading.split_eyes = 0;
            reading.lips = 0;
            reading.targets = NULL;
            reading.attached_count = 0;
        }
    }
    return 0;
}

/* The kinds of materials, and shapes that follow from meshes. */
static int make_surfaces(const convert_options *options, source *s, model_error *error)
{
    for (uint32_t i = 0; i < options->surface_count; i++) {
        if (surface_kind_assign(s->m, options->surfaces[i], error)) return 1;
    }
    for (uint32_t i = 0; i < options->tint_count; i++) {
        if (tint_assign(s->m, options->tints[i], error)) return 1;
    }
    for (uint32_t i = 0; i < options->priority_count; i++) {
        if (priority_assign(s->m, options->priorities[i], error)) return 1;
    }
    return options->only != CONVERT_CLIPS && surface_shapes_find(s->m, options->report, error);
}

static int join_all(const char *const *inputs, int count, int base, const convert_options *options, source *all,
                    convert_failure *failure)
{
    for (int i = 0; i < count; i++) {
        failure->file = inputs[i];
        if (i != base && source_join(&all[base], inputs[base], &all[i], inputs[i], &options->joints, &failure->error)) {
            return 1;
        }
    }
    if (count) failure->file = inputs[base];
    return 0;
}

int convert_files(const char *const *inputs, int input_count, const convert_options *options, byte_buffer *out,
                  convert_failure *failure)
{
    source *all = calloc((size_t)input_count + 1u, sizeof *all);
    graph_file *graphs = NULL;
    recipe_text *recipe = NULL;
    ragdoll_text *ragdoll = NULL;
    set_springs *springs = NULL;
    hair_text *hair = NULL;
    hair_grown grown = { .hair_count = 0 };
    const terrain *ground = NULL;
    terrain read_ground = { .heights = NULL };
    int failed, base = 0;
    memset(failure, 0, sizeof *failure);
    failure->file = input_count ? inputs[0] : options->terrain;
    if (!all || (!input_count && !(all[0].m = model_new()))) {
        free(all);
        return out_of_memory(&failure->error);
    }
    failed = read_all(inputs, input_count, options, all, failure);
    if (!failed) {
        base = base_of(all, input_count);
        failed = join_all(inputs, input_count, base, options, all, failure) ||
                 make_surfaces(options, &all[base], &failure->error) ||
                 apply_events(options, &all[base], &failure->error) ||
                 read_graphs(options, &all[base], &graphs, failure) ||
                 read_recipe(options, &all[base], &recipe, failure) ||
                 read_ragdoll(options, &all[base], &ragdoll, failure) ||
                 read_hair(options, &all[base], &hair, &grown, failure) ||
                 read_terrain(options, &read_ground, &ground, failure);
        failed = failed ||
                 (joint_order_sets(all[base].sets, all[base].set_count, all[base].m) && out_of_memory(&failure->error));
        failed = failed || read_springs(options, &all[base], &springs, failure);
        if (!failed) {
            const pack_extras extras = { graphs, recipe, ragdoll, springs, hair, &grown, ground };
            failed = convert_source(&all[base], &extras, options, out, &failure->error);
        }
    }
    springs_free(springs, all[base].set_count);
    for (int i = 0; i < input_count || !i; i++) {
        source_free(&all[i]);
    }
    graph_text_free(graphs);
    recipe_free(recipe);
    ragdoll_free(ragdoll);
    hair_grown_free(&grown);
    hair_free(hair);
    terrain_free(&read_ground);
    free(all);
    return failed;
}
