#include "convert.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "choices.h"
#include "convert/base/input_file.h"
#include "convert/base/names.h"
#include "convert/base/text_scan.h"
#include "convert/clips/events_read.h"
#include "convert/chunks/chunk_maker.h"
#include "convert/clips/joint_order.h"
#include "convert/light/hollow_paint.h"
#include "convert/light/pack_transfer.h"
#include "convert/mocap/clean.h"
#include "convert/model/eye_paint.h"
#include "convert/model/model_build.h"
#include "convert/model/size_guess.h"
#include "convert/model/strands.h"
#include "convert/model/surface_kind.h"
#include "convert/model/surface_shape.h"
#include "convert/model/teeth_paint.h"
#include "convert/model/texture_cut.h"
#include "convert/model/priority.h"
#include "convert/model/tint.h"
#include "convert/pack/size_warn.h"
#include "convert/pack/stage_warn.h"
#include "convert/skin/skin_mirror.h"
#include "convert/texture/texture_astc.h"
#include "convert/texture/texture_solid.h"
#include "convert/texture/texture_trim.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/pack.h"
#include "sources.h"

#define ERROR_UM 10.0 /* of targets, usually */
/* How far targets that a level leaves out may move the surface, as a share of that level's error: both add up to the
 * largest error in pixels (low_stage.h). */
#define SKIP_SHARE (1.0f / 3.0f)

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
    return failed ? input_fail_at(options->events, error) : 0;
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

/* Given in world units, held in the mesh's own. On a figure of less than a centimetre the usual error would show. */
static float target_error_um(const model *m, float asked_um, float scale)
{
    const double size_cm = asked_um > 0.0f ? 0.0 : meshes_cm(m);
    const double usual_um = size_cm > 0.0 ? fmin(ERROR_UM, ERROR_UM * size_cm) : ERROR_UM;
    return (asked_um > 0.0f ? asked_um : (float)usual_um) / scale;
}

static int encode_mesh(const model *m, uint32_t index, const convert_options *options, encoded *e, model_error *error)
{
    const model_mesh *mesh = &m->meshes[index];
    const float scale = model_mesh_scale(m, index);
    float skip_radius[NOH_LOD_LEVELS_MAX];
    morph_options morph = options->morph;
    morph.error_um = target_error_um(m, morph.error_um, scale);
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

static void warn_hurried(FILE *warnings, const model *m, const mesh_levels *levels)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const lod *l = levels[i].built;
        if (l && l->measured < l->collapse_count) {
            fprintf(warnings,
                    "warning: LOD levels of mesh '%s' take too long to measure: %u of %u collapses were chosen as by "
                    "--lod-fast, with larger errors; fewer targets, or fewer triangles, are measured to the end\n",
                    m->meshes[i].name, l->collapse_count - l->measured, l->collapse_count);
        }
    }
}

static int encode_meshes(const source *s, model *m, const convert_options *options, encoded *e, model_error *error)
{
    lod_settings levels = options->lod;
    int failed;
    if (options->choose_levels) choices_levels(m, s->sets, s->set_count, &levels, options->report);
    levels.progress = options->progress;
    failed = model_levels_make(m, &levels, e->levels, error);
    if (!failed && convert_warnings(options)) warn_hurried(convert_warnings(options), m, e->levels);
    for (uint32_t i = 0; i < m->mesh_count && !failed; i++) {
        failed = encode_mesh(m, i, options, e, error);
    }
    if (options->progress) {
        fputs("\r\033[K", options->progress); /* clear the terminal's line */
    }
    return failed;
}

static int check_chunks(const noh_pack *pack, model_error *error)
{
    int failed = 0;
    for (int type = 0; type < NOH_CHUNK_TYPES && !failed; type++) {
        const chunk_maker *maker = chunk_maker_of((noh_chunk_type)type);
        failed = maker->check && maker->check(pack, error);
    }
    return failed;
}

FILE *convert_warnings(const convert_options *options)
{
    return options->warnings ? options->warnings : options->report;
}

/* Open the pack with the library's own reader: a pack that it refuses is never written. */
static int check_own_pack(byte_buffer *out, const convert_options *options, model_error *error)
{
    FILE *report = options ? options->report : NULL, *warnings = options ? convert_warnings(options) : NULL;
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
    if (check_chunks(&pack, error)) {
        buffer_free(out);
        return 1;
    }
    if (warnings && stage_warn(&pack, warnings)) {
        buffer_free(out);
        return model_fail_memory(error);
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
    first = calloc(pack.runs[NOH_CHUNK_MESH].count + 1u, sizeof *first);
    failed = first ? strip_levels_of(levels, &pack, first, error) || pack_strip(&pack, first, &stripped, error)
                   : model_fail_memory(error);
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
    color_settings colors = options->colors;
    settings.report = colors.report = options->report;
    settings.recipe = colors.recipe = recipe;
    return options->only != CONVERT_CLIPS &&
           (wrinkles_make(s->m, &settings, error) || colors_make(s->m, &colors, error));
}

static int set_textures(const source *s, const convert_options *options, model_error *error)
{
    for (uint32_t i = 0; i < s->m->texture_count; i++) {
        s->m->textures[i].blocks = options->blocks;
        s->m->textures[i].size_max = options->texture_max;
    }
    return options->blocks == MODEL_BLOCKS_ASTC && s->m->texture_count && texture_astc_find(error);
}

/* Once the levels are known, since a level's triangles read the textures too. */
static int trim_textures(model *m, const mesh_levels *levels, const convert_options *options, model_error *error)
{
    texture_trimmed done = { 0, 0, 0 };
    uint32_t solid = 0;
    const int keeps = options->whole_textures || options->only == CONVERT_CLIPS;
    if (!keeps && (texture_solid(m, levels, &solid) || texture_trim(m, levels, &done))) return model_fail_memory(error);
    texture_cut_mark(m);
    if (options->report && solid) {
        fprintf(options->report,
                "%u of %u materials became opaque: their triangles read no texel below their cutoff (--whole-textures "
                "keeps cutoffs)\n",
                solid, m->material_count);
    }
    if (options->report && done.count) {
        fprintf(options->report,
                "%u of %u textures trimmed to what triangles read: %.0f%% of their texels are left "
                "(--whole-textures keeps all)\n",
                done.count, m->texture_count, 100.0 * (double)done.texels / (double)done.whole);
    }
    return 0;
}

static int convert_source(const source *s, void *const *chunks, const convert_options *options, byte_buffer *out,
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
        return model_fail_memory(error);
    }
    settings.report = options->report;
    settings.warnings = convert_warnings(options);
    settings.progress = options->progress;
    settings.skeletons_only = options->only == CONVERT_MESH;
    settings.m = s->m;
    failed = make_wrinkles(s, chunks[NOH_CHUNK_RECIPE], options, error);
    failed = failed || set_textures(s, options, error);
    if (!failed && options->only != CONVERT_CLIPS && extent_warn(s->m)) failed = model_fail_memory(error);
    if (!failed && options->only != CONVERT_MESH &&
        (weights_warn(s->m, s->sets, s->set_count) || size_warn(s->m, s->sets, s->set_count, settings.clip.error_cm) ||
         clips_mirror_warn(s->m, s->sets, s->set_count))) {
        failed = model_fail_memory(error);
    }
    if (settings.warnings) report_warnings(settings.warnings, s);
    failed = failed || pack_check_model(m, error) || encode_meshes(s, m, options, &meshes, error) ||
             trim_textures(s->m, meshes.levels, options, error);
    if (!failed) {
        failed = clips_encode(s->sets, s->set_count, &settings, &made, error);
        made.chunks = chunks;
        failed = failed || pack_write(m, meshes.levels, meshes.morphs, &made, out, error) ||
                 check_own_pack(out, options, error) || add_transfers(out, options, error) ||
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
    reading.warnings = convert_warnings(options);
    for (int i = 0; i < count; i++) {
        failure->file = inputs[i];
        if (source_read(inputs[i], &reading, &all[i], &failure->error)) {
            return 1;
        }
        if (all[i].m->mesh_count) { /* people and eyes are made of the first model */
            reading.identity = NULL;
            reading.split_eyes = 0;
            reading.lips = 0;
            reading.choices = 0;
            reading.targets = NULL;
            reading.attached_count = 0;
            reading.extras.count = 0;
        }
    }
    return 0;
}

/* The kinds of materials, the size, and shapes that follow from meshes. */
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
    if (options->only == CONVERT_CLIPS) return 0;
    if (pack_check_model(s->m, error)) return 1; /* before work that grows with a power of what is counted */
    if (surface_shells_set(s->m) || size_guess(s->m, options->report)) return model_fail_memory(error);
    if (teeth_paint(s->m)) return model_fail_memory(error);
    if (!options->keep_looks && (eye_paint(s->m) || eye_shade_clear(s->m) || lash_strips_hide(s->m)))
        return model_fail_memory(error);
    if (!options->keep_looks && !options->transfer.order && hollow_paint(s->m)) return model_fail_memory(error);
    strands_find(s->m, options->report);
    return surface_shapes_find(s->m, options->keep_looks, options->report, error);
}

static int join_all(const char *const *inputs, int count, int base, const convert_options *options, source *all,
                    convert_failure *failure)
{
    joint_match_options joints = options->joints;
    joints.report = options->report;
    for (int i = 0; i < count; i++) {
        failure->file = inputs[i];
        if (i != base && source_join(&all[base], inputs[base], &all[i], inputs[i], &joints, &failure->error)) {
            return 1;
        }
    }
    if (count) failure->file = inputs[base];
    return 0;
}

static int has_rows(const char *text, size_t bytes)
{
    model_error unused;
    text_scan scan;
    text_word word = { 0 };
    text_start(&scan, text, bytes, &unused);
    do {
        if (text_take_on_line(&scan, &word)) return 1;
    } while (!word.size && text_next_line(&scan));
    return word.size != 0;
}

/* A file of an option that changes nothing is read all the same, so that a wrong path is an error; and warned of. */
static int check_rows(const char *option, const char *path, int is_used, model *m, convert_failure *failure)
{
    const int is_file = path && strcmp(path, "auto") != 0;
    int rows = 1;
    if (is_file) {
        size_t bytes;
        char *text = input_read_text(path, &bytes, &failure->error);
        if (!text) return input_fail_at(path, &failure->error);
        rows = has_rows(text, bytes);
        free(text);
    }
    if (!path || (is_used && rows)) return 0;
    return model_warn(m, "%s %.200s changes nothing: %s", option, path,
                      is_used ? "the file has no rows"
                              : "it is for clips of other files; name such a file after the model")
               ? model_fail_memory(&failure->error)
               : 0;
}

static int check_all_rows(const convert_options *o, int input_count, model *m, convert_failure *failure)
{
    return check_rows("--names", o->names, 1, m, failure) || check_rows("--events", o->events, 1, m, failure) ||
           check_rows("--rename", o->joints.names, input_count > 1, m, failure) ||
           check_rows("--retarget", o->joints.retarget, input_count > 1, m, failure);
}

/* Of the makers that read once joints are in their last order, or of the others. */
static int read_chunks(const convert_options *options, const source *s, int in_joint_order, void **made,
                       convert_failure *failure)
{
    const char *model_file = failure->file;
    for (int type = 0; type < NOH_CHUNK_TYPES; type++) {
        const chunk_maker *maker = chunk_maker_of((noh_chunk_type)type);
        if (!maker->read || maker->in_joint_order != in_joint_order) continue;
        if (maker->read(options, s, &made[type], failure)) return 1;
        failure->file = model_file;
        failure->line = 0;
    }
    return 0;
}

static int use_names(const convert_options *options, convert_failure *failure)
{
    const char *model_file = failure->file;
    if (options->names) failure->file = options->names;
    if (names_use(options->names, &failure->error)) return 1;
    failure->file = model_file;
    return 0;
}

int convert_files(const char *const *inputs, int input_count, const convert_options *options, byte_buffer *out,
                  convert_failure *failure)
{
    source *all = calloc((size_t)input_count + 1u, sizeof *all);
    void *chunks[NOH_CHUNK_TYPES] = { NULL };
    int failed, base = 0;
    memset(failure, 0, sizeof *failure);
    failure->file = input_count ? inputs[0] : options->texts[NOH_CHUNK_TERRAIN];
    if (!all || (!input_count && !(all[0].m = model_new()))) {
        free(all);
        return model_fail_memory(&failure->error);
    }
    inputs_record(options->inputs);
    failed = use_names(options, failure) || read_all(inputs, input_count, options, all, failure);
    if (!failed) {
        base = base_of(all, input_count);
        failed = check_all_rows(options, input_count, all[base].m, failure) ||
                 join_all(inputs, input_count, base, options, all, failure) ||
                 make_surfaces(options, &all[base], &failure->error) ||
                 apply_events(options, &all[base], &failure->error) ||
                 read_chunks(options, &all[base], 0, chunks, failure) ||
                 (joint_order_sets(all[base].sets, all[base].set_count, all[base].m) &&
                  model_fail_memory(&failure->error)) ||
                 read_chunks(options, &all[base], 1, chunks, failure) ||
                 convert_source(&all[base], chunks, options, out, &failure->error);
    }
    inputs_record(NULL);
    names_free();
    for (int i = 0; i < input_count || !i; i++) {
        source_free(&all[i]);
    }
    for (int type = 0; type < NOH_CHUNK_TYPES; type++) {
        const chunk_maker *maker = chunk_maker_of((noh_chunk_type)type);
        if (maker->free) maker->free(chunks[type]);
    }
    free(all);
    return failed;
}
