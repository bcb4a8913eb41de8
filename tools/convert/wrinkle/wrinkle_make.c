#include "wrinkle_make.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/format.h"
#include "convert/base/image_file.h"
#include "convert/model/model_build.h"
#include "wrinkle_creases.h"
#include "wrinkle_folds.h"
#include "wrinkle_regions.h"
#include "wrinkle_uv.h"

#define MAP_SIZE_LEAST 256u /* of a generated normal map, */
#define MAP_SIZE_MOST 512u  /* by how many texels lie from crease to crease; --wrinkle-size goes beyond it */
#define WAVE_TEXELS 5.0     /* fewer widen them: WAVE_LEAST of wrinkle_creases.c */
#define WEIGHTS_SHARE 4u /* of the side of a normal map is the side of weight maps that are filtered: they are smooth */
#define ZONES_SHARE 8u   /* zones of a face are larger than what creases need */
#define OVERLAP_MOST 0.25 /* of the texels: folds of a projected texture overlap, mirrored halves do so altogether */
#define SHRINKING_LEAST 0.002 /* mean compression of a material's area by all of a mesh's targets together */

/* The textures and the matrix of one mesh, before the model has them. */
typedef struct wrinkles {
    uint8_t *map, *matrix;
    uint32_t map_width, map_height;
    region_mask mask;
    region_maps weights; /* of the mask */
} wrinkles;

static void wrinkles_free(wrinkles *w)
{
    free(w->map);
    free(w->matrix);
    region_mask_free(&w->mask);
    for (uint32_t k = 0; k < REGION_MAP_COUNT; k++) {
        free(w->weights.map[k]);
    }
    memset(w, 0, sizeof *w);
}

/* ---- which surface ---- */

/* Cards of hair and lashes, unlit materials, toons, eyes and teeth have no creases. */
static int can_wrinkle(const model *m, uint32_t material)
{
    const model_material *of = material != MODEL_NONE ? &m->materials[material] : NULL;
    return of && of->alpha == MODEL_ALPHA_OPAQUE && !of->unlit &&
           (of->surface == NOH_SURFACE_PLAIN || of->surface == NOH_SURFACE_SKIN);
}

static double area_of(const wrinkle_field *f)
{
    double area = 0.0;
    for (uint32_t i = 0; i < f->triangle_count; i++) {
        area += f->area[i];
    }
    return area;
}

static int is_better(wrinkle_field *f, int any, const wrinkle_field *best, double *largest)
{
    const double area = area_of(f);
    if (f->shrinking < SHRINKING_LEAST * area) f->shrinking = 0.0; /* next to nothing is nothing */
    if (f->shrinking > 0.0 || best->shrinking > 0.0) return f->shrinking > best->shrinking;
    if (!any || area <= *largest) return 0;
    *largest = area;
    return 1;
}

/* The material of a mesh on which most surface is compressed; *best is freed by the caller in all cases.
 * any  1: the largest one where none is, for expressions that an artist tied to painted regions */
static int choose_surface(const model *m, const model_mesh *mesh, int any, wrinkle_field *best)
{
    double largest = 0.0;
    memset(best, 0, sizeof *best);
    for (uint32_t i = 0; i < m->material_count && mesh->target_count; i++) {
        wrinkle_field f;
        int failed;
        if (!can_wrinkle(m, i)) continue;
        failed = wrinkle_field_make(mesh, i, &f);
        if (!failed && is_better(&f, any, best, &largest)) {
            const wrinkle_field swap = *best;
            *best = f;
            f = swap;
        }
        wrinkle_field_free(&f);
        if (failed) return 1;
    }
    return 0;
}

/* Why a surface cannot have wrinkles, as a sentence; NULL where it can. */
static const char *objection(const model_mesh *mesh, const wrinkle_field *f)
{
    if (!mesh->target_count) return "it has no morph targets";
    if (!mesh->tangent) return "it has no texture coordinates: unwrap it first"; /* painted eyes lack tangents */
    if (!f->triangle_count) return "no target compresses an opaque, lit material that is no eye, teeth or toon";
    return NULL;
}

/* The mean edge of a texel where the surface is compressed. */
static double texel_edge(const wrinkle_field *f, const wrinkle_raster *r)
{
    double area = 0.0, texels = 0.0;
    for (uint32_t i = 0; i < f->triangle_count; i++) {
        area += f->largest[i] >= 0.03f ? f->area[i] : 0.0;
    }
    for (size_t at = 0; at < (size_t)r->width * r->height; at++) {
        texels += r->triangle[at] != MODEL_NONE && f->largest[r->triangle[at]] >= 0.03f;
    }
    return texels > 0.0 ? sqrt(area / texels) : 0.0;
}

/* asked: 0: the smallest size whose texels show waves of this length */
static int choose_size(const wrinkle_field *f, double spacing, uint32_t asked, wrinkle_raster *out)
{
    for (uint32_t size = asked ? asked : MAP_SIZE_LEAST;; size *= 2) {
        if (wrinkle_raster_make(f, size, size, out)) return 1;
        if (asked || size == MAP_SIZE_MOST || spacing >= WAVE_TEXELS * texel_edge(f, out)) return 0;
        wrinkle_raster_free(out);
    }
}

static int overlaps(const wrinkle_raster *r)
{
    return (double)r->overlapped > OVERLAP_MOST * (double)r->covered;
}

/* ---- painted ---- */

/* A picture's file, not the model's, is at fault. */
static int blame(const char *path, model_error *error)
{
    (void)snprintf(error->where, sizeof error->where, "%s", path);
    return 1;
}

static int read_map(const char *path, wrinkles *w, model_error *error)
{
    image_file image;
    if (image_read(path, &image, error)) {
        return blame(path, error);
    }
    w->map = image.rgba;
    w->map_width = image.width;
    w->map_height = image.height;
    return 0;
}

/* ---- generated ---- */

/* folds: NULL: it is not a face */
static int generate_map(const wrinkle_field *f, const wrinkle_folds *folds, const wrinkle_raster *r, wrinkles *w)
{
    w->map = folds ? wrinkle_folds_map(f, r, folds) : wrinkle_creases_make(f, r, wrinkle_spacing(f));
    w->map_width = r->width;
    w->map_height = r->height;
    return !w->map;
}

/* As a mask that could have been painted. */
static int generate_mask(const wrinkle_field *f, const wrinkle_folds *folds, uint32_t size, region_mask *mask)
{
    region_weights *regions = folds ? wrinkle_folds_regions(f, folds) : wrinkle_regions_make(f);
    uint8_t *maps[REGION_MAP_COUNT] = { NULL };
    wrinkle_raster r;
    const int failed = wrinkle_raster_make(f, size, size, &r) || !regions || wrinkle_maps_make(f, regions, &r, maps) ||
                       region_mask_make(maps, size, size, mask);
    for (uint32_t k = 0; k < REGION_MAP_COUNT; k++) free(maps[k]);
    wrinkle_raster_free(&r);
    free(regions);
    return failed;
}

static uint32_t mask_size(const wrinkle_settings *settings, int is_face, uint32_t map_size)
{
    if (settings->mask_size) return settings->mask_size;
    return settings->by_pixel ? map_size : map_size / (is_face ? ZONES_SHARE : WEIGHTS_SHARE);
}

static int decode_mask(const wrinkle_field *f, wrinkles *w)
{
    w->weights.width = w->mask.width;
    w->weights.height = w->mask.height;
    if (region_maps_make(&w->mask, w->weights.map)) return 1;
    w->matrix = wrinkle_matrix_make(f, &w->weights);
    return !w->matrix;
}

/* Paint the regions that have a file, generate the rest. */
static int fill(const wrinkle_field *f, const wrinkle_folds *folds, const wrinkle_raster *r,
                const wrinkle_settings *settings, wrinkles *w, model_error *error)
{
    if (settings->map ? read_map(settings->map, w, error) : generate_map(f, folds, r, w) && model_fail_memory(error)) {
        return 1;
    }
    if (settings->mask) {
        if (region_mask_read(settings->mask, &w->mask, error)) return blame(settings->mask, error);
    } else if (generate_mask(f, folds, mask_size(settings, folds != NULL, r->width), &w->mask)) {
        return model_fail_memory(error);
    }
    return decode_mask(f, w) && model_fail_memory(error);
}

/* ---- the table ---- */

/* A target that the recipe has rows of is tied to the regions of these and to no others. */
static void take_rows(const recipe_text *recipe, const model_mesh *mesh, uint8_t *matrix)
{
    for (uint32_t t = 0; t < mesh->target_count && recipe; t++) {
        uint8_t *regions = matrix + (size_t)t * REGION_COUNT;
        int seen = 0;
        for (uint32_t i = 0; i < recipe->wrinkle_count; i++) {
            const wrinkle_row *row = &recipe->wrinkles[i];
            if (row->region >= REGION_COUNT || strcmp(row->target, mesh->targets[t].name) != 0) continue;
            if (!seen) memset(regions, 0, REGION_COUNT);
            regions[row->region] = (uint8_t)(row->weight * 255.0f + 0.5f);
            seen = 1;
        }
    }
}

static int has_rows(const recipe_text *recipe, const model_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->target_count && recipe; t++) {
        for (uint32_t i = 0; i < recipe->wrinkle_count; i++) {
            const wrinkle_row *row = &recipe->wrinkles[i];
            if (row->region < REGION_COUNT && strcmp(row->target, mesh->targets[t].name) == 0) return 1;
        }
    }
    return 0;
}

static int is_tied(const model_mesh *mesh, const uint8_t *matrix, uint32_t region)
{
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        if (matrix[(size_t)t * REGION_COUNT + region]) return 1;
    }
    return 0;
}

/* Painted regions that no expression shows. */
static int warn_of_idle(model *m, const model_mesh *mesh, const wrinkles *w)
{
    const size_t texels = (size_t)w->weights.width * w->weights.height;
    char list[4 * REGION_COUNT] = "";
    size_t at = 0;
    uint32_t count = 0;
    for (uint32_t r = 0; r < REGION_COUNT; r++) {
        const uint8_t *weight = w->weights.map[r % REGION_MAP_COUNT] + r / REGION_MAP_COUNT;
        size_t i = 0;
        while (i < texels && !weight[4 * i]) i++;
        if (i == texels || is_tied(mesh, w->matrix, r)) continue;
        at += (size_t)snprintf(list + at, sizeof list - at, count++ ? ", %u" : "%u", r);
    }
    return count &&
           model_warn(
               m,
               "mesh '%s': no target compresses the skin by 1 %% in region%s %s of the mask, which never show%s: "
               "paint it where targets compress the skin, or add rows `wrinkle TARGET REGION` to a recipe (--recipe)",
               mesh->name, count == 1 ? "" : "s", list, count == 1 ? "s" : "");
}

/* ---- into the model ---- */

int wrinkle_add_texture(model *m, const char *mesh, const char *what, uint8_t **rgba, uint32_t width, uint32_t height,
                        const uint8_t clamped[2], model_texture_use use)
{
    model_texture *grown = realloc(m->textures, (m->texture_count + 1u) * sizeof *grown);
    const size_t bytes = strlen(mesh) + strlen(what) + 2;
    model_texture *t;
    if (!grown) return 1;
    m->textures = grown;
    t = &grown[m->texture_count];
    memset(t, 0, sizeof *t);
    t->name = malloc(bytes);
    if (!t->name) return 1;
    (void)snprintf(t->name, bytes, "%s %s", mesh, what);
    t->width = width;
    t->height = height;
    t->rgba = *rgba;
    t->wrap_s = clamped[0] ? 33071 : 10497;
    t->wrap_t = clamped[1] ? 33071 : 10497;
    t->use = use;
    if (use == MODEL_TEXTURE_CODES) t->mag_filter = t->min_filter = 9728;
    *rgba = NULL;
    m->texture_count++;
    return 0;
}

/* Whether a pixel may read the wrinkle map and a mask as well. */
static int has_room(const model_material *of)
{
    const int maps = (of->normal_texture != MODEL_NONE) + (of->surface_texture != MODEL_NONE) +
                     (of->specular_texture != MODEL_NONE) +
                     (of->emissive[0] > 0.0f || of->emissive[1] > 0.0f || of->emissive[2] > 0.0f);
    return maps + 2 <= (int)NOH_MATERIAL_MAPS_MAX;
}

static int add_weights(model *m, const char *mesh, const wrinkle_field *f, int by_pixel, uint32_t own, wrinkles *w)
{
    static const char *const names[REGION_MAP_COUNT] = { "wrinkle weights 0", "wrinkle weights 1",
                                                         "wrinkle weights 2" };
    for (uint32_t k = 0; k < REGION_MAP_COUNT && !by_pixel; k++) {
        if (wrinkle_add_texture(m, mesh, names[k], &w->weights.map[k], w->weights.width, w->weights.height, f->clamped,
                                MODEL_TEXTURE_DATA))
            return 1;
        m->materials[own].more_textures[k] = m->texture_count - 1u;
    }
    if (!by_pixel) return 0;
    if (wrinkle_add_texture(m, mesh, "wrinkle regions", &w->mask.rgba, w->mask.width, w->mask.height, f->clamped,
                            MODEL_TEXTURE_CODES))
        return 1;
    m->materials[own].more_textures[0] = m->texture_count - 1u;
    m->materials[own].wrinkle_codes = 1;
    return 0;
}

/* Of folds a change of area does not say which of them shows: regions do. */
static uint32_t models_of(const wrinkle_settings *settings, int is_face)
{
    if (settings->models) return settings->models;
    return is_face ? NOH_WRINKLE_BY_REGION : NOH_WRINKLE_BY_AREA | NOH_WRINKLE_BY_REGION;
}

static int add_to_model(model *m, model_mesh *mesh, const wrinkle_field *f, const wrinkle_settings *settings,
                        int is_face, wrinkles *w)
{
    const char *name = mesh->name ? mesh->name : "";
    uint32_t own = f->material;
    int by_pixel = settings->by_pixel;
    if (model_own_material(m, mesh, &own)) return 1;
    if (wrinkle_add_texture(m, name, "wrinkle normals", &w->map, w->map_width, w->map_height, f->clamped,
                            MODEL_TEXTURE_NORMAL))
        return 1;
    m->materials[own].wrinkle_texture = m->texture_count - 1u;
    m->materials[own].wrinkle_models = models_of(settings, is_face);
    if (by_pixel && !has_room(&m->materials[own])) {
        by_pixel = 0;
        if (model_warn(m, "material '%s': its wrinkle regions are read per vertex, as a pixel reads at most %u maps",
                       m->materials[own].name, NOH_MATERIAL_MAPS_MAX))
            return 1;
    }
    if (add_weights(m, name, f, by_pixel, own, w)) return 1;
    mesh->wrinkles = w->matrix;
    w->matrix = NULL;
    return 0;
}

static void report(const wrinkle_settings *settings, const model *m, const model_mesh *mesh, uint32_t material,
                   const wrinkles *w)
{
    uint32_t used = 0;
    for (uint32_t r = 0; r < REGION_COUNT; r++) {
        used += (uint32_t)is_tied(mesh, w->matrix, r);
    }
    if (settings->report) {
        fprintf(settings->report,
                "wrinkles of mesh '%s', material '%s': normals %u x %u%s, weights %u x %u%s, %u region%s\n", mesh->name,
                m->materials[material].name, w->map_width, w->map_height, settings->map ? " painted" : "",
                w->weights.width, w->weights.height, settings->mask ? " painted" : "", used, used == 1 ? "" : "s");
    }
}

/* The mask of the first mesh that has one goes to the caller. */
static int keep_mask(const wrinkle_settings *settings, const wrinkles *w)
{
    const size_t bytes = (size_t)w->mask.width * w->mask.height * 4u;
    if (!settings->kept || settings->kept->rgba) return 0;
    *settings->kept = (region_mask){ w->mask.width, w->mask.height, malloc(bytes) };
    if (settings->kept->rgba) memcpy(settings->kept->rgba, w->mask.rgba, bytes);
    return !settings->kept->rgba;
}

/* Only what is sure to be a face gets wrinkles that nobody asked for. */
static int faces_alone(const wrinkle_settings *settings)
{
    return settings->automatic == WRINKLES_OF_FACES && !settings->map && !settings->mask;
}

/* Lay out what is generated. folds->zones: none where it is not a face. Why the mesh cannot have wrinkles goes to *why,
 * which is NULL where it can. */
static int lay_out(model *m, model_mesh *mesh, const wrinkle_settings *settings, wrinkle_field *f, wrinkle_raster *r,
                   wrinkle_folds *folds, int *is_face, const char **why)
{
    *is_face = !settings->map && wrinkle_folds_find(f, settings->recipe, folds);
    if (!*is_face && faces_alone(settings)) {
        *why = "it is no face";
        return 0;
    }
    if (wrinkle_uv_settle(m, mesh, f) ||
        choose_size(f, *is_face ? wrinkle_folds_finest(folds) : wrinkle_spacing(f), settings->size, r)) {
        return 1;
    }
    if (overlaps(r) && !(settings->map && settings->mask)) { /* painted ones are meant for it */
        *why = "its texture coordinates overlap (mirrored or tiled): unwrap it so that each texel belongs to one place";
    } else if (*is_face && !wrinkle_folds_place(f, r, WAVE_TEXELS * texel_edge(f, r), folds)) {
        *why = "its targets compress no fold of a face by 1 %";
    }
    return 0;
}

/* One mesh; *made counts those that have wrinkles now. */
static int make_mesh(model *m, model_mesh *mesh, const wrinkle_settings *settings, uint32_t *made, model_error *error)
{
    wrinkle_field f;
    wrinkle_raster r = { 0 };
    wrinkles w = { 0 };
    wrinkle_folds folds;
    const char *why;
    int is_face = 0, failed = choose_surface(m, mesh, settings->mask && has_rows(settings->recipe, mesh), &f) &&
                              model_fail_memory(error);
    why = failed ? NULL : objection(mesh, &f);
    if (!failed && !why) {
        failed = lay_out(m, mesh, settings, &f, &r, &folds, &is_face, &why) && model_fail_memory(error);
    }
    if (!failed && why) {
        failed = !faces_alone(settings) && model_warn(m, "mesh '%s' gets no wrinkles: %s", mesh->name, why) &&
                 model_fail_memory(error);
    } else if (!failed) {
        failed = fill(&f, is_face ? &folds : NULL, &r, settings, &w, error);
        failed = failed || (keep_mask(settings, &w) && model_fail_memory(error));
        if (!failed) take_rows(settings->recipe, mesh, w.matrix);
        failed = failed || (settings->mask && warn_of_idle(m, mesh, &w) && model_fail_memory(error));
        if (!failed) report(settings, m, mesh, f.material, &w);
        failed = failed || (add_to_model(m, mesh, &f, settings, is_face, &w) && model_fail_memory(error));
        *made += !failed;
    }
    wrinkles_free(&w);
    wrinkle_raster_free(&r);
    wrinkle_field_free(&f);
    return failed;
}

int wrinkle_has_rows(const recipe_text *recipe, uint32_t first, uint32_t count)
{
    for (uint32_t i = 0; recipe && i < recipe->wrinkle_count; i++) {
        if (recipe->wrinkles[i].region - first < count) return 1;
    }
    return 0;
}

int wrinkles_make(model *m, const wrinkle_settings *settings, model_error *error)
{
    uint32_t made = 0;
    const int wanted = settings->automatic || settings->map || settings->mask;
    for (uint32_t i = 0; wanted && i < m->mesh_count; i++) {
        if (make_mesh(m, &m->meshes[i], settings, &made, error)) return 1;
    }
    if (!made && (!wanted || faces_alone(settings))) {
        return wrinkle_has_rows(settings->recipe, 0, REGION_COUNT) &&
               model_warn(
                   m,
                   "the recipe's wrinkle rows have no effect without --wrinkles auto, --wrinkle-map or --region-mask") &&
               model_fail_memory(error);
    }
    if (!made) {
        return model_fail(error, "", "no mesh can have wrinkles: %s",
                          m->warning_count ? m->warnings[m->warning_count - 1u] : "there is none");
    }
    return 0;
}
