#include "model_extra.h"

#include <math.h>
#include <string.h>

/* ---- the list ---- */

static int is_name(const char *name)
{
    const char *digits = name + 9;
    if (name[0] == '_') return name[1] != 0;
    return strncmp(name, "TEXCOORD_", 9) == 0 && digits[0] && strspn(digits, "0123456789") == strlen(digits);
}

static int parse_one(const char *item, size_t bytes, extra_list *out, model_error *error)
{
    char *name, *colon;
    if (out->count == NOH_EXTRAS_MAX || bytes >= NOH_NAME_BYTES_MAX) {
        return model_fail(error, "", "--attributes takes up to %u names of up to %u bytes", NOH_EXTRAS_MAX,
                          NOH_NAME_BYTES_MAX - 1u);
    }
    name = out->names[out->count];
    memcpy(name, item, bytes);
    name[bytes] = 0;
    colon = strchr(name, ':');
    if (colon) {
        out->bits[out->count] = strcmp(colon, ":8") == 0 ? 8u : strcmp(colon, ":16") == 0 ? 16u : 0u;
        if (!out->bits[out->count]) {
            return model_fail(error, "", "--attributes: '%.60s' is stored in 8 or 16 bits, as NAME:8 or NAME:16", name);
        }
        *colon = 0;
    }
    if (!is_name(name)) {
        return model_fail(error, "", "--attributes: '%.60s' is neither TEXCOORD_n nor a name that begins with _", name);
    }
    for (uint32_t i = 0; i < out->count; i++) {
        if (strcmp(out->names[i], name) == 0) return model_fail(error, "", "--attributes has '%.60s' twice", name);
    }
    out->count++;
    return 0;
}

int extras_parse(const char *text, extra_list *out, model_error *error)
{
    memset(out, 0, sizeof *out);
    while (text) {
        const char *comma = strchr(text, ',');
        const size_t bytes = comma ? (size_t)(comma - text) : strlen(text);
        if (parse_one(text, bytes, out, error)) return 1;
        text = comma ? comma + 1 : NULL;
    }
    return 0;
}

int extras_check(const model *m, model_error *error)
{
    for (uint32_t k = 0; k < m->extras.count; k++) {
        uint32_t i = 0;
        while (i < m->mesh_count && !m->meshes[i].extras[k].width) i++;
        if (i == m->mesh_count) {
            return model_fail(error, "",
                              "--attributes: no mesh has '%.60s'; without the option, warnings name what is left out",
                              m->extras.names[k]);
        }
    }
    return 0;
}

/* ---- how numbers are stored ---- */

static const float *values_of(const model_mesh *mesh, size_t vertex, uint32_t k)
{
    return mesh->extra + 4u * (vertex * NOH_EXTRAS_MAX + k);
}

/* The box of a component. Whole numbers in a small range have a step of 1, so that identities stay exact. */
static void plan_box(const model_mesh *mesh, uint32_t k, uint32_t c, noh_extra_row *row)
{
    const float most = row->bits == 8.0f ? 255.0f : 65535.0f;
    float low = values_of(mesh, 0, k)[c], high = low;
    int whole = 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float value = values_of(mesh, v, k)[c];
        low = value < low ? value : low;
        high = value > high ? value : high;
        whole &= value == floorf(value) && fabsf(value) < 16777216.0f;
    }
    row->offset[c] = low;
    row->step[c] = whole && high - low <= most ? (high > low ? 1.0f : 0.0f)
                                               : (float)(((double)high - (double)low) / (double)most);
}

static void plan_row(const model *m, const model_mesh *mesh, uint32_t k, noh_extra_row *row)
{
    const model_extra *e = &mesh->extras[k];
    const uint32_t asked = m->extras.bits[k];
    const int as_file = e->bits && (!asked || asked >= e->bits);
    row->bits = as_file ? (float)e->bits : asked == 8u ? 8.0f : 16.0f;
    row->component_count = (float)e->width;
    for (uint32_t c = 0; c < e->width; c++) {
        row->offset[c] = e->least;
        row->step[c] = e->step;
        if (!as_file) plan_box(mesh, k, c, row);
    }
}

static uint32_t number_of(const noh_extra_row *row, uint32_t c, float value)
{
    const double most = row->bits == 8.0f ? 255.0 : 65535.0;
    const double n = row->step[c] > 0.0f ? floor(((double)value - (double)row->offset[c]) / (double)row->step[c] + 0.5)
                                         : 0.0;
    return (uint32_t)(n < 0.0 ? 0.0 : n > most ? most : n);
}

static float error_of(const model_mesh *mesh, uint32_t k, const noh_extra_row *row)
{
    float worst = 0.0f;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (uint32_t c = 0; (float)c < row->component_count; c++) {
            const float value = values_of(mesh, v, k)[c];
            const float read = row->offset[c] + row->step[c] * (float)number_of(row, c, value);
            worst = fabsf(read - value) > worst ? fabsf(read - value) : worst;
        }
    }
    return worst;
}

void extras_plan(const model *m, const model_mesh *mesh, extra_plan *out)
{
    uint32_t bit = 0;
    memset(out, 0, sizeof *out);
    if (!mesh->extra) return;
    for (uint32_t k = 0; k < m->extras.count; k++) {
        if (mesh->extras[k].width) plan_row(m, mesh, k, &out->rows[k]);
    }
    for (int bits = 16; bits >= 8; bits -= 8) {
        for (uint32_t k = 0; k < m->extras.count; k++) {
            noh_extra_row *row = &out->rows[k];
            if (row->bits != (float)bits) continue;
            row->first_bit = (float)bit;
            bit += (uint32_t)bits * mesh->extras[k].width;
            out->errors[k] = error_of(mesh, k, row);
        }
    }
    out->word_count = (bit + 31u) / 32u;
}

void extras_pack(const extra_plan *plan, const model_mesh *mesh, size_t vertex, uint32_t *words)
{
    memset(words, 0, plan->word_count * sizeof *words);
    for (uint32_t k = 0; k < NOH_EXTRAS_MAX && plan->word_count; k++) {
        const noh_extra_row *row = &plan->rows[k];
        for (uint32_t c = 0; (float)c < row->component_count; c++) {
            const uint32_t bit = (uint32_t)row->first_bit + c * (uint32_t)row->bits;
            words[bit / 32u] |= number_of(row, c, values_of(mesh, vertex, k)[c]) << bit % 32u;
        }
    }
}
