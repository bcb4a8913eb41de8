#include "convert.h"

#include <stdlib.h>
#include <string.h>

#include "bvh_read.h"
#include "events_read.h"
#include "gltf_motion.h"
#include "pack/pack.h"
#include "raw_set.h"
#include "rcl.h"
#include "resample.h"

/* What one input gives: a model, and the motion of its skeletons. */
typedef struct source {
    model *m;          /* of a glTF file; an empty one otherwise */
    motion *made;      /* of a glTF file */
    raw_set *single;   /* of a .bvh or .rcl */
    raw_set **sets;
    uint32_t set_count;
} source;

static int out_of_memory(model_error *error)
{
    snprintf(error->what, sizeof error->what, "out of memory");
    error->where[0] = 0;
    return 1;
}

/* ---- reading ---- */

static int has_ending(const char *path, const char *ending)
{
    size_t length = strlen(path), tail = strlen(ending);
    if (length < tail) {
        return 0;
    }
    for (size_t i = 0; i < tail; i++) {
        char c = path[length - tail + i];
        if ((c >= 'A' && c <= 'Z' ? c + 32 : c) != ending[i]) {
            return 0;
        }
    }
    return 1;
}

static int resample_set(raw_set *set, double rate_hz, model_error *error)
{
    for (uint32_t i = 0; i < set->clip_count; i++) {
        raw_clip resampled;
        if (raw_clip_resample(&set->clips[i], rate_hz, &resampled, error)) {
            return 1;
        }
        raw_clip_clear(&set->clips[i]);
        set->clips[i] = resampled;
    }
    return 0;
}

static int read_motion_file(const char *path, const convert_options *options, source *s, model_error *error)
{
    bvh_options bvh = { options->motion.unit_cm, 0 };
    int failed = has_ending(path, ".rcl") ? rcl_read(path, &s->single, error) : bvh_read(path, &bvh, &s->single, error);
    if (failed) {
        return 1;
    }
    s->m = calloc(1, sizeof *s->m);
    s->sets = &s->single;
    s->set_count = 1;
    return s->m ? (options->motion.rate_hz > 0.0 ? resample_set(s->single, options->motion.rate_hz, error) : 0)
                : out_of_memory(error);
}

static int read_gltf_file(const char *path, const convert_options *options, source *s, model_error *error)
{
    motion_options rate = { options->motion.rate_hz };
    if (model_read_gltf(path, &s->m, error)) {
        return 1;
    }
    if (options->only == CONVERT_MESH) {
        return 0;
    }
    if (motion_from_model(s->m, &rate, &s->made, error)) {
        return 1;
    }
    s->sets = s->made->sets;
    s->set_count = s->made->set_count;
    return 0;
}

static int read_source(const char *path, const convert_options *options, source *s, model_error *error)
{
    if (has_ending(path, ".rcl") || has_ending(path, ".bvh")) {
        return read_motion_file(path, options, s, error);
    }
    return read_gltf_file(path, options, s, error);
}

static int apply_events(const convert_options *options, source *s, model_error *error)
{
    event_list *list = NULL;
    int failed;
    if (!options->events) {
        return 0;
    }
    failed = events_read(options->events, &list, error) || events_apply(list, s->sets, s->set_count, error);
    events_free(list);
    return failed;
}

static void free_source(source *s)
{
    motion_free(s->made);
    raw_set_free(s->single);
    model_free(s->m);
}

/* ---- encoding ---- */

static void free_encodings(morph_encoding **encodings, uint32_t count)
{
    for (uint32_t i = 0; encodings && i < count; i++) {
        if (encodings[i]) {
            morph_encoding_free(encodings[i]);
        }
    }
    free(encodings);
}

static int encode_mesh(const model *m, uint32_t index, const convert_options *options, morph_encoding **encoding, model_error *error)
{
    float scale = model_mesh_scale(m, index);
    morph_options morph = options->morph;
    morph.error_um = (morph.error_um > 0.0f ? morph.error_um : 10.0f) / scale; /* asked for in the world, kept in the mesh */
    if (options->progress && m->meshes[index].target_count) {
        fprintf(options->progress, "\rencoding %u targets of mesh %u of %u ", m->meshes[index].target_count, index + 1, m->mesh_count);
        fflush(options->progress);
    }
    if (morph_encode(&m->meshes[index], &morph, encoding, error)) {
        return 1;
    }
    if (options->report) {
        convert_report_mesh(options->report, &m->meshes[index], *encoding, scale, morph.error_um * scale);
    }
    return 0;
}

static int encode_meshes(const model *m, const convert_options *options, morph_encoding **encodings, model_error *error)
{
    int failed = 0;
    for (uint32_t i = 0; i < m->mesh_count && !failed; i++) {
        failed = encode_mesh(m, i, options, &encodings[i], error);
    }
    if (options->progress) {
        fputs("\r\033[K", options->progress); /* leave the terminal's line as it was */
    }
    return failed;
}

/* A pack that its own reader refuses must not leave the converter. */
static int check_own_pack(byte_buffer *out, model_error *error)
{
    noh_pack pack;
    noh_error refusal = { NOH_OK, "", 0, 0 };
    if (noh_pack_open(out->bytes, out->count, &pack, &refusal)) {
        snprintf(error->what, sizeof error->what, "the pack that was built does not open: %s (byte %llu); this is a bug of noh",
                 refusal.what, (unsigned long long)refusal.where);
        error->where[0] = 0;
        buffer_free(out);
        return 1;
    }
    return 0;
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

static int convert_source(const source *s, const convert_options *options, byte_buffer *out, model_error *error)
{
    model empty;
    const model *m = options->only == CONVERT_MOTION ? memset(&empty, 0, sizeof empty) : s->m;
    morph_encoding **encodings = calloc(m->mesh_count + 1u, sizeof *encodings);
    motion_settings settings = options->motion;
    motions made;
    int failed;
    if (!encodings) {
        return out_of_memory(error);
    }
    settings.report = options->report;
    settings.progress = options->progress;
    if (options->report) {
        report_warnings(options->report, s);
    }
    failed = pack_check_model(m, error) || encode_meshes(m, options, encodings, error);
    if (!failed) {
        failed = motions_encode(s->sets, s->set_count, &settings, &made, error) || pack_write(m, encodings, &made, out, error) ||
                 check_own_pack(out, error);
        motions_free(&made);
    }
    free_encodings(encodings, m->mesh_count);
    return failed;
}

int convert_files(const char *const *inputs, int input_count, const convert_options *options, byte_buffer *out,
                  convert_failure *failure)
{
    source s;
    int failed;
    memset(&s, 0, sizeof s);
    memset(failure, 0, sizeof *failure);
    failure->file = inputs[0];
    if (input_count != 1) {
        failure->file = inputs[1];
        snprintf(failure->error.what, sizeof failure->error.what, "a pack is built from one file: build the others apart");
        return 1;
    }
    failed = read_source(inputs[0], options, &s, &failure->error) || apply_events(options, &s, &failure->error) ||
             convert_source(&s, options, out, &failure->error);
    free_source(&s);
    return failed;
}
