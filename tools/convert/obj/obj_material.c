#include "obj_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/image_file.h"
#include "convert/base/input_file.h"
#include "convert/model/model_build.h"
#include "convert/model/surface_kind.h"

/* A material file while the model's materials are filled in. */
typedef struct library {
    const char *obj_path;
    text_scan scan;
    model *m;
    model_material *at;    /* the one that the lines are about; NULL: none that is used */
    uint64_t pixels_left;  /* of textures (image_read_next) */
    char *color, *opacity; /* names of pictures in its map_Kd and map_d; NULL: none */
    uint32_t left_out;     /* bits of the pictures that have had their warning (leave_out_texture) */
} library;

/* ---- materials by name ---- */

/* Dielectric, and rough until its lines say otherwise. */
static model_material material_plain(void)
{
    model_material plain = model_material_default();
    plain.metallic = 0.0f;
    plain.roughness = 0.8f;
    return plain;
}

static int make_materials(const obj_text *o, model *m)
{
    m->materials = model_zeros(obj_part_count(o), sizeof *m->materials);
    m->textures = model_zeros(obj_part_count(o), sizeof *m->textures);
    if (!m->materials || !m->textures) return 1;
    for (uint32_t i = 0; i < obj_part_count(o); i++) {
        const char *name = obj_part_at(o, i)->material;
        if (!name) continue;
        m->materials[m->material_count] = material_plain();
        m->materials[m->material_count].name = model_string(name);
        surface_kind_set(&m->materials[m->material_count], surface_kind_by_name(name, MODEL_ALPHA_OPAQUE));
        if (!m->materials[m->material_count++].name) return 1;
    }
    return 0;
}

static model_material *material_of(model *m, text_word name)
{
    for (uint32_t i = 0; i < m->material_count; i++) {
        if (strlen(m->materials[i].name) == name.size && memcmp(m->materials[i].name, name.text, name.size) == 0) {
            return &m->materials[i];
        }
    }
    return NULL;
}

/* ---- files ---- */

#define PATH_BYTES 4096

/* The path of a file in the OBJ's folder; slashes: with a slash for each backslash of its name. 0: it is too long. */
static int join_path(const char *obj_path, const char *name, int slashes, char path[PATH_BYTES])
{
    const char *slash = strrchr(obj_path, '/');
    const size_t folder = slash ? (size_t)(slash - obj_path) + 1u : 0u, length = strlen(name);
    if (folder >= PATH_BYTES || length >= PATH_BYTES - folder) return 0;
    memcpy(path, obj_path, folder);
    memcpy(path + folder, name, length + 1u);
    for (char *c = path + folder; slashes && *c; c++) {
        if (*c == '\\') *c = '/';
    }
    return 1;
}

/* Exporters may write a path from another machine: then the file of that name in the model's folder is used. found: a
 * path to read, whether it is there or not. */
static int find_file(const char *obj_path, const char *name, char found[PATH_BYTES], model_error *error)
{
    char path[PATH_BYTES];
    const char *last = name;
    const int is_local = name[0] != '/' && name[0] != '\\' && !strchr(name, ':');
    for (const char *c = name; *c; c++) {
        if (*c == '/' || *c == '\\') last = c + 1;
    }
    /* a name as it is may have backslashes: some programs unpack the archives of Windows so */
    for (int slashes = !strchr(name, '\\'); is_local && slashes < 2; slashes++) {
        if (!join_path(obj_path, name, slashes, path)) break;
        if (input_find_any_case(path, found, PATH_BYTES)) return 0;
        inputs_note(path, 0);
    }
    if (!join_path(obj_path, last, 0, path)) {
        return model_fail(error, "", "its name is longer than the %d bytes of a path: give it a shorter one",
                          PATH_BYTES - 1);
    }
    if (!input_find_any_case(path, found, PATH_BYTES)) memcpy(found, path, strlen(path) + 1u);
    return 0;
}

/* ---- textures ---- */

static uint32_t find_texture(const model *m, const char *name)
{
    for (uint32_t i = 0; i < m->texture_count; i++) {
        if (strcmp(m->textures[i].name, name) == 0) return i;
    }
    return MODEL_NONE;
}

static int add_texture(library *l, const char *name)
{
    char path[PATH_BYTES];
    image_file image;
    model_error error = { "", "" };
    model_texture *t = &l->m->textures[l->m->texture_count];
    if (find_file(l->obj_path, name, path, &error) || image_read_next(path, &l->pixels_left, &image, &error)) {
        return model_warn(l->m, "material '%.60s': the texture %.80s was left out: %s", l->at->name, name, error.what);
    }
    if (image.has_no_end && model_warn(l->m, "material '%.60s': %.80s: %s", l->at->name, name, error.what)) {
        free(image.rgba);
        return 1;
    }
    t->name = model_string(name);
    t->width = image.width;
    t->height = image.height;
    t->rgba = image.rgba;
    t->wrap_s = t->wrap_t = 10497;
    t->use = MODEL_TEXTURE_COLOR;
    l->at->base_color_texture = l->m->texture_count++;
    return !t->name;
}

/* [-option value ...] FILE: the file is the last word, or the whole rest where there are no options. *name is to be
 * freed; NULL: there is none. */
static int read_name(library *l, char **name)
{
    text_word rest = text_rest_of_line(&l->scan);
    *name = NULL;
    if (rest.size > 0 && rest.text[0] == '-') {
        const char *end = rest.text + rest.size, *at = end;
        while (at > rest.text && at[-1] != ' ' && at[-1] != '\t') at--;
        rest.text = at;
        rest.size = (size_t)(end - at);
    }
    if (rest.size == 0) return 0;
    *name = text_copy(rest);
    return !*name;
}

static int read_texture(library *l)
{
    const char *name;
    free(l->color);
    if (read_name(l, &l->color)) return 1;
    name = l->color;
    if (!name) return 0;
    l->at->base_color_texture = find_texture(l->m, name);
    return l->at->base_color_texture == MODEL_NONE && add_texture(l, name);
}

/* Exporters name the colours' own picture in map_d, in a line before or after it: its alpha cuts. */
static int end_material(library *l)
{
    const int lost = l->opacity && !(l->color && strcmp(l->color, l->opacity) == 0);
    if (l->opacity && !lost && l->at->base_color_texture != MODEL_NONE && l->at->alpha == MODEL_ALPHA_OPAQUE) {
        l->at->alpha = MODEL_ALPHA_MASK;
        surface_kind_set(l->at, surface_kind_by_name(l->at->name, l->at->alpha));
    }
    free(l->opacity);
    free(l->color);
    l->opacity = l->color = NULL;
    return lost && model_warn(l->m,
                              "material '%.60s': its picture of opacity (map_d) was left out: put it into the alpha of "
                              "its colours (map_Kd), and name this picture in map_d",
                              l->at->name);
}

static int leave_out_texture(library *l, text_word keyword)
{
    static const char *const maps[] = { "map_Bump", "map_bump", "bump",   "norm",   "map_Ks", "map_Ns",
                                        "map_Ke",   "map_Pr",   "map_Pm", "map_Ps", "disp",   "decal" };
    for (uint32_t i = 0; i < sizeof maps / sizeof maps[0]; i++) {
        if (!text_is(keyword, maps[i]) || (l->left_out >> i & 1u)) continue;
        l->left_out |= 1u << i;
        return model_warn(l->m,
                          "material '%.60s': its %s was left out, and in all materials after it: of the pictures in an "
                          "OBJ file's materials, only map_Kd is read; glTF has the others",
                          l->at->name, maps[i]);
    }
    return 0;
}

/* ---- lines ---- */

/* Up to three numbers; 0 for a malformed line, which is skipped. */
static uint32_t read_numbers(library *l, double out[3])
{
    uint32_t count = 0;
    for (; count < 3; count++) {
        const text_word word = text_next_on_line(&l->scan);
        if (word.size == 0) break;
        if (text_number(&l->scan, word, &out[count])) return 0;
    }
    return count;
}

static void set_color(library *l)
{
    double c[3];
    if (read_numbers(l, c) != 3) return;
    for (int k = 0; k < 3; k++) l->at->base_color[k] = (float)fmin(fmax(c[k], 0.0), 1.0);
}

/* Some exporters write the opacity as Tr, which makes what is opaque invisible: nobody exports that on purpose. */
static int set_opacity(library *l, int transparency)
{
    double d[3], opacity;
    if (read_numbers(l, d) == 0) return 0;
    opacity = fmin(fmax(transparency ? 1.0 - d[0] : d[0], 0.0), 1.0);
    if (!(opacity > 0.0)) {
        return model_warn(l->m, "material '%.60s': its opacity is 0 (d 0 or Tr 1), and it was taken as opaque",
                          l->at->name);
    }
    l->at->base_color[3] = (float)opacity;
    if (l->at->base_color[3] < 1.0f) {
        l->at->alpha = MODEL_ALPHA_BLEND;
        surface_kind_set(l->at, surface_kind_by_name(l->at->name, l->at->alpha));
    }
    return 0;
}

/* Blinn-Phong's exponent as a roughness of the same width (Walter et al. 2007). */
static void set_exponent(library *l)
{
    double n[3];
    if (read_numbers(l, n) == 0) return;
    l->at->roughness = (float)sqrt(sqrt(2.0 / (fmax(n[0], 0.0) + 2.0)));
}

static int read_line(library *l)
{
    const text_word keyword = text_next_on_line(&l->scan);
    if (text_is(keyword, "newmtl")) {
        if (end_material(l)) return 1;
        l->at = material_of(l->m, text_rest_of_line(&l->scan));
        return 0;
    }
    if (!l->at) return 0;
    if (text_is(keyword, "map_Kd")) return read_texture(l);
    if (text_is(keyword, "map_d")) {
        free(l->opacity);
        return read_name(l, &l->opacity);
    }
    if (text_is(keyword, "d")) return set_opacity(l, 0);
    if (text_is(keyword, "Tr")) return set_opacity(l, 1);
    if (text_is(keyword, "Kd")) set_color(l);
    if (text_is(keyword, "Ns")) set_exponent(l);
    return leave_out_texture(l, keyword);
}

static int read_library(library *l, const char *text, size_t bytes)
{
    model_error ignored;
    int failed = 0;
    text_start(&l->scan, text, bytes, &ignored);
    while (!failed && text_next_line(&l->scan)) {
        failed = read_line(l);
        (void)text_rest_of_line(&l->scan);
    }
    return end_material(l) || failed;
}

int obj_materials_read(const char *obj_path, const obj_text *o, model *m)
{
    char path[PATH_BYTES];
    library l = { .obj_path = obj_path, .m = m, .pixels_left = IMAGE_PIXELS };
    model_error error = { "", "" };
    size_t bytes = 0;
    char *text;
    int failed;
    if (make_materials(o, m)) return 1;
    if (!o->library || m->material_count == 0) return 0;
    text = find_file(obj_path, o->library, path, &error) ? NULL : input_read_text(path, &bytes, &error);
    if (!text) return model_warn(m, "the materials of %.80s were left out: %s", o->library, error.what);
    failed = read_library(&l, text, bytes);
    free(text);
    return failed;
}
