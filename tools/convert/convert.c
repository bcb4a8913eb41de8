#include "convert.h"

#include <stdlib.h>
#include <string.h>

#include "pack/pack.h"

static void free_encodings(morph_encoding **encodings, uint32_t count)
{
    for (uint32_t i = 0; encodings && i < count; i++) {
        if (encodings[i]) {
            morph_encoding_free(encodings[i]);
        }
    }
    free(encodings);
}

static int encode_meshes(const model *m, const convert_options *options, morph_encoding **encodings, model_error *error)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        float scale = model_mesh_scale(m, i);
        morph_options morph = options->morph;
        morph.error_um = (morph.error_um > 0.0f ? morph.error_um : 10.0f) / scale; /* asked for in the world, kept in the mesh */
        if (options->progress && m->meshes[i].target_count) {
            fprintf(options->progress, "\rencoding %u targets of mesh %u of %u ", m->meshes[i].target_count, i + 1, m->mesh_count);
            fflush(options->progress);
        }
        if (morph_encode(&m->meshes[i], &morph, &encodings[i], error)) {
            return 1;
        }
        if (options->report) {
            convert_report_mesh(options->report, &m->meshes[i], encodings[i], scale, morph.error_um * scale);
        }
    }
    return 0;
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

static int convert_model(const model *m, const convert_options *options, byte_buffer *out, model_error *error)
{
    morph_encoding **encodings = calloc(m->mesh_count + 1u, sizeof *encodings);
    int failed;
    if (!encodings) {
        snprintf(error->what, sizeof error->what, "out of memory");
        return 1;
    }
    for (uint32_t i = 0; options->report && i < m->warning_count; i++) {
        fprintf(options->report, "warning: %s\n", m->warnings[i]);
    }
    failed = pack_check_model(m, error) || encode_meshes(m, options, encodings, error);
    if (options->progress) {
        fputs("\r\033[K", options->progress); /* leave the terminal's line as it was */
    }
    failed = failed || pack_write(m, encodings, out, error) || check_own_pack(out, error);
    free_encodings(encodings, m->mesh_count);
    return failed;
}

int convert_files(const char *const *inputs, int input_count, const convert_options *options, byte_buffer *out,
                  convert_failure *failure)
{
    model *m = NULL;
    int failed;
    memset(failure, 0, sizeof *failure);
    failure->file = inputs[0];
    if (input_count != 1) {
        failure->file = inputs[1];
        snprintf(failure->error.what, sizeof failure->error.what, "a pack is built from one file: build the others apart");
        return 1;
    }
    failed = model_read_gltf(inputs[0], &m, &failure->error) || convert_model(m, options, out, &failure->error);
    model_free(m);
    return failed;
}
