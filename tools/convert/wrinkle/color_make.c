#include "color_make.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/image_file.h"
#include "convert/model/model_build.h"
#include "noh/base.h"
#include "noh/format.h"
#include "wrinkle_make.h"

/* ---- the map ---- */

/* The alpha of a file without one covers nothing; where no row uses it, it is 255, which takes no bytes. */
static int read_map(const color_settings *settings, image_file *image, model_error *error)
{
    const uint32_t alpha = NOH_WRINKLE_FOLDS + 3u;
    if (image_read(settings->map, image, error)) {
        (void)snprintf(error->where, sizeof error->where, "%s", settings->map);
        return 1;
    }
    if (wrinkle_has_rows(settings->recipe, alpha, 1)) {
        if (image->channels % 2 == 0) return 0; /* grey and alpha, colour and alpha */
        return model_fail(error, settings->map, "it has no alpha channel, but a row `color` uses channel a");
    }
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) image->rgba[4 * i + 3] = 255;
    return 0;
}

/* ---- rows ---- */

static const wrinkle_row *color_row(const color_settings *settings, uint32_t i)
{
    const wrinkle_row *row = &settings->recipe->wrinkles[i];
    return row->region >= NOH_WRINKLE_FOLDS ? row : NULL;
}

static double linear_of(uint32_t byte)
{
    const double s = byte / 255.0;
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

static int check_tints(const color_settings *settings, model_error *error)
{
    for (uint32_t c = 0; c < NOH_WRINKLE_COLORS; c++) {
        if (!settings->recipe->tints[c] && wrinkle_has_rows(settings->recipe, NOH_WRINKLE_FOLDS + c, 1)) {
            return model_fail(error, "", "channel %c of the colour map has no colour: add a row `tint %c RRGGBB`",
                              "rgba"[c], "rgba"[c]);
        }
    }
    return 0;
}

/* What noh_wrinkles_header.colors_offset is of. *rows: how many rows are of targets of the mesh. NULL: out of memory */
static uint8_t *colors_of(const color_settings *settings, const model_mesh *mesh, uint32_t *rows)
{
    uint8_t *colors = calloc(NOH_WRINKLE_COLORS + (size_t)mesh->target_count, 4);
    *rows = 0;
    for (uint32_t i = 0; colors && i < 3 * NOH_WRINKLE_COLORS; i++) {
        const uint32_t byte = settings->recipe->tints[i / 3] >> 8 * (2 - i % 3) & 255u;
        colors[4 * (i / 3) + i % 3] = (uint8_t)(255.0 * sqrt(linear_of(byte)) + 0.5);
    }
    for (uint32_t i = 0; colors && i < settings->recipe->wrinkle_count; i++) {
        const wrinkle_row *row = color_row(settings, i);
        for (uint32_t t = 0; row && t < mesh->target_count; t++) {
            if (strcmp(row->target, mesh->targets[t].name) != 0) continue;
            colors[4 * (NOH_WRINKLE_COLORS + t) + row->region - NOH_WRINKLE_FOLDS] = (uint8_t)(row->weight * 255.0f +
                                                                                               0.5f);
            ++*rows;
        }
    }
    return colors;
}

/* ---- materials ---- */

static uint32_t indices_of(const model_mesh *mesh, uint32_t material)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        if (mesh->submeshes[s].material == material) count += mesh->submeshes[s].index_count;
    }
    return count;
}

/* The asked one, or the one of the most triangles; MODEL_NONE: none */
static uint32_t material_of(const model *m, const model_mesh *mesh, const char *name)
{
    uint32_t best = MODEL_NONE, most = 0;
    for (uint32_t i = 0; i < m->material_count; i++) {
        const uint32_t count = indices_of(mesh, i);
        const char *own = m->materials[i].name ? m->materials[i].name : "";
        if (count <= most || (name && strcmp(own, name) != 0)) continue;
        best = i;
        most = count;
    }
    return best;
}

static uint32_t maps_of(const model_material *of)
{
    return (uint32_t)((of->normal_texture != MODEL_NONE) + (of->surface_texture != MODEL_NONE) +
                      (of->specular_texture != MODEL_NONE) + (of->wrinkle_texture != MODEL_NONE) + of->wrinkle_codes +
                      (of->emissive[0] > 0.0f || of->emissive[1] > 0.0f || of->emissive[2] > 0.0f) +
                      (of->surface == NOH_SURFACE_TOON && of->toon_shade) +
                      (of->surface == NOH_SURFACE_TOON && of->toon_masks) +
                      (of->surface == NOH_SURFACE_TOON && of->more_textures[NOH_TOON_MATCAP] != MODEL_NONE));
}

/* NULL: the mesh can have colours */
static const char *objection(const model *m, const model_mesh *mesh, uint32_t material)
{
    if (!mesh->tangent) return "it has no texture coordinates"; /* painted eyes lack tangents */
    if (material == MODEL_NONE) return "it has no such material";
    if (m->materials[material].unlit) return "its material is unlit";
    return maps_of(&m->materials[material]) < NOH_MATERIAL_MAPS_MAX
               ? NULL
               : "its material has as many maps as a pixel reads: leave one out (--wrinkle-lookup vertex needs one less)";
}

/* ---- meshes ---- */

/* Every material has the same texture. */
static int add_map(model *m, const char *name, uint32_t material, image_file *image, uint32_t *texture)
{
    const uint32_t base = m->materials[material].base_color_texture;
    uint8_t clamped[2] = { 0, 0 };
    if (base != MODEL_NONE) {
        clamped[0] = m->textures[base].wrap_s == 33071;
        clamped[1] = m->textures[base].wrap_t == 33071;
    }
    if (*texture == MODEL_NONE) {
        if (wrinkle_add_texture(m, name, "colours", &image->rgba, image->width, image->height, clamped,
                                MODEL_TEXTURE_DATA))
            return 1;
        *texture = m->texture_count - 1u;
    }
    m->materials[material].color_texture = *texture;
    return 0;
}

static int make_mesh(model *m, model_mesh *mesh, const color_settings *settings, image_file *image, uint32_t *texture)
{
    uint32_t rows, material = material_of(m, mesh, settings->material);
    const char *why = objection(m, mesh, material), *name = mesh->name ? mesh->name : "";
    uint8_t *colors = colors_of(settings, mesh, &rows);
    if (!colors) return 1;
    if (!rows || why) {
        free(colors);
        return rows && model_warn(m, "mesh '%s' gets no colours: %s", name, why);
    }
    mesh->colors = colors;
    mesh->color_material = material;
    if (add_map(m, name, material, image, texture)) return 1;
    if (settings->report) {
        fprintf(settings->report, "colours of mesh '%s', material '%s': %u x %u, %u row%s of the recipe\n", name,
                m->materials[material].name, image->width, image->height, rows, rows == 1 ? "" : "s");
    }
    return 0;
}

int colors_make(model *m, const color_settings *settings, model_error *error)
{
    const int has_rows = wrinkle_has_rows(settings->recipe, NOH_WRINKLE_FOLDS, NOH_WRINKLE_COLORS);
    image_file image = { 0 };
    uint32_t texture = MODEL_NONE;
    int failed;
    if (!settings->map) {
        return has_rows && model_warn(m, "the recipe's color rows have no effect without --color-map") &&
               model_fail_memory(error);
    }
    if (!has_rows) {
        return model_fail(error, settings->map,
                          "no target shows its colours: add rows `color TARGET CHANNEL` to a "
                          "recipe (--recipe)");
    }
    failed = check_tints(settings, error) || read_map(settings, &image, error);
    for (uint32_t i = 0; i < m->mesh_count && !failed; i++) {
        failed = make_mesh(m, &m->meshes[i], settings, &image, &texture) && model_fail_memory(error);
    }
    if (!failed && texture == MODEL_NONE) {
        failed = model_fail(error, settings->map, "no mesh can have its colours: %s",
                            m->warning_count ? m->warnings[m->warning_count - 1u]
                                             : "no mesh has the targets of the `color` rows");
    }
    free(image.rgba);
    return failed;
}
