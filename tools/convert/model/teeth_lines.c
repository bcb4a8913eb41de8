#include "teeth_lines.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "noh/format.h"

#define COLUMNS 512u
#define ROWS 64u          /* the upper half for upper teeth */
#define TEETH 8           /* of a side of a jaw */
#define JAW_MM 60.0f      /* between the outer faces of the last molars */
#define BAND_VERTICES 96u /* divided teeth have six each or more */
#define STEPS 64          /* of an arch's side */
#define LINE_MM 0.4f
#define QUARTER 1.57079633f

/* Millimetres from the middle outwards: lower, upper. */
static const float widths[2][TEETH] = { { 5.5f, 6.0f, 7.0f, 7.0f, 7.0f, 11.0f, 10.5f, 10.0f },
                                        { 8.5f, 6.5f, 7.5f, 7.0f, 7.0f, 10.0f, 10.0f, 9.0f } };

/* Seen from above a jaw is half an ellipse. */
typedef struct arch {
    float middle;            /* x: a file's figure may stand anywhere */
    float back, depth, half; /* signed where its front is at low z */
    float along[STEPS + 1];  /* millimetres from the middle to an angle */
} arch;

static int is_upper(const teeth_rows *r, uint32_t v)
{
    return r->middle[r->island[v]] > r->split;
}

/* ---- what is left alone ---- */

/* Whether a band has no room for divisions: one island each. */
static int are_bands(const teeth_rows *r)
{
    uint32_t first[2] = { MODEL_NONE, MODEL_NONE }, count[2] = { 0, 0 };
    for (uint32_t v = 0; v < r->mesh->vertex_count; v++) {
        if (!r->used[v]) continue;
        const int upper = is_upper(r, v);
        if (first[upper] == MODEL_NONE) first[upper] = r->island[v];
        if (first[upper] != r->island[v]) return 0;
        count[upper]++;
    }
    return count[0] && count[1] && count[0] <= BAND_VERTICES && count[1] <= BAND_VERTICES;
}

static int is_real(const model *m)
{
    for (uint32_t i = 0; i < m->material_count; i++) {
        if (m->materials[i].surface == NOH_SURFACE_SKIN && m->materials[i].normal_texture != MODEL_NONE) return 1;
    }
    return 0;
}

static int has_other_users(const model *m, const teeth_rows *r)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        for (uint32_t s = 0; s < mesh->submesh_count; s++) {
            const model_submesh *part = &mesh->submeshes[s];
            if (part == r->part) continue;
            if (part->material == r->part->material) return 1;
            for (uint32_t k = 0; mesh == r->mesh && k < part->index_count; k++) {
                if (r->used[mesh->indices[part->first_index + k]]) return 1;
            }
        }
    }
    return 0;
}

static int has_maps(model_material *of)
{
    uint32_t *maps[MODEL_MAPS];
    model_maps(of, maps);
    for (uint32_t k = 0; k < MODEL_MAPS; k++) {
        if (*maps[k] != MODEL_NONE) return 1;
    }
    return 0;
}

/* ---- the arch ---- */

/* Its front is where it is narrow. */
static int arch_of(const teeth_rows *r, arch *a)
{
    float low = INFINITY, high = -INFINITY, left = INFINITY, right = -INFINITY, wide[2] = { 0.0f, 0.0f };
    for (uint32_t v = 0; v < r->mesh->vertex_count; v++) {
        if (!r->used[v]) continue;
        left = fminf(left, r->mesh->position[3 * (size_t)v]);
        right = fmaxf(right, r->mesh->position[3 * (size_t)v]);
        low = fminf(low, r->mesh->position[3 * (size_t)v + 2]);
        high = fmaxf(high, r->mesh->position[3 * (size_t)v + 2]);
    }
    a->middle = 0.5f * (left + right);
    for (uint32_t v = 0; v < r->mesh->vertex_count; v++) {
        if (!r->used[v]) continue;
        const float *p = r->mesh->position + 3 * (size_t)v, at = (p[2] - low) / (high - low);
        if (at < 0.2f) wide[0] = fmaxf(wide[0], fabsf(p[0] - a->middle));
        if (at > 0.8f) wide[1] = fmaxf(wide[1], fabsf(p[0] - a->middle));
    }
    a->half = 0.5f * r->width;
    a->back = wide[1] < wide[0] ? low : high;
    a->depth = wide[1] < wide[0] ? high - low : low - high;
    a->along[0] = 0.0f;
    for (int i = 0; i < STEPS; i++) {
        const float t = ((float)i + 0.5f) / STEPS * QUARTER, x = a->half * cosf(t), z = a->depth * sinf(t);
        a->along[i + 1] = a->along[i] + sqrtf(x * x + z * z) * QUARTER / STEPS * JAW_MM / r->width;
    }
    return high > low;
}

/* 0 to 1 from one end of the arch to the other. */
static float place_on(const arch *a, const float *p)
{
    const float x = p[0] - a->middle;
    const float t = atan2f(fabsf(x) / a->half, fmaxf((p[2] - a->back) / a->depth, 0.0f)) / QUARTER * STEPS;
    const int step = t < STEPS ? (int)t : STEPS - 1;
    const float mm = a->along[step] + (t - (float)step) * (a->along[step + 1] - a->along[step]);
    return 0.5f + copysignf(0.5f * mm / a->along[STEPS], x);
}

static void place_rows(const teeth_rows *r, const arch *a)
{
    for (uint32_t v = 0; v < r->mesh->vertex_count; v++) {
        if (!r->used[v]) continue;
        const float *p = r->mesh->position + 3 * (size_t)v;
        const int upper = is_upper(r, v);
        const float away = fminf(fabsf(p[1] - r->edge[upper]) / (TEETH_CROWN * r->width), 1.0f);
        r->mesh->uv[2 * (size_t)v] = place_on(a, p);
        r->mesh->uv[2 * (size_t)v + 1] = (upper ? 0.03f : 0.53f) + 0.44f * away;
    }
}

/* ---- the texture ---- */

float teeth_smooth(float from, float to, float x)
{
    const float t = fminf(fmaxf((x - from) / (to - from), 0.0f), 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* Shares of the teeth's colour, in sRGB. mm: from the middle of the jaw; away: from the bite, 1 at the gum. Lines are
 * wider at the bite, where corners are round, and teeth darker towards them. */
static void tooth_color(int upper, float mm, float away, uint8_t out[4])
{
    static const float line[3] = { 0.52f, 0.42f, 0.36f };
    float nearest = mm, at = 0.0f;
    for (int i = 0; i < TEETH; i++) {
        at += widths[upper][i];
        nearest = fminf(nearest, fabsf(mm - at));
    }
    const float share = 1.0f - teeth_smooth(0.0f, LINE_MM * (1.0f + 1.5f * teeth_smooth(0.25f, 0.0f, away)), nearest);
    const float round = 0.88f + 0.12f * teeth_smooth(0.0f, 3.0f, nearest);
    for (int c = 0; c < 3; c++) out[c] = (uint8_t)(255.0f * round * (1.0f + share * (line[c] - 1.0f)) + 0.5f);
    out[3] = 255;
}

static uint32_t add_texture(model *m, const arch *a)
{
    model_texture *grown = realloc(m->textures, (m->texture_count + 1u) * sizeof *grown), *t;
    if (!grown) return MODEL_NONE;
    m->textures = grown;
    t = &grown[m->texture_count];
    memset(t, 0, sizeof *t);
    t->name = model_string("painted teeth");
    t->rgba = model_zeros((size_t)COLUMNS * ROWS, 4);
    t->width = COLUMNS;
    t->height = ROWS;
    t->wrap_s = t->wrap_t = 33071;
    t->use = MODEL_TEXTURE_COLOR;
    for (uint32_t i = 0; t->rgba && i < COLUMNS * ROWS; i++) {
        const uint32_t column = i % COLUMNS, row = i / COLUMNS;
        const float x = ((float)column + 0.5f) / COLUMNS, y = ((float)row + 0.5f) / ROWS;
        tooth_color(y < 0.5f, fabsf(2.0f * x - 1.0f) * a->along[STEPS], fminf(fmodf(y, 0.5f) / 0.5f, 1.0f),
                    t->rgba + 4 * i);
    }
    if (t->name && t->rgba) return m->texture_count++;
    free(t->name);
    free(t->rgba);
    return MODEL_NONE;
}

int teeth_lines_paint(model *m, const teeth_rows *r)
{
    model_material *of = &m->materials[r->part->material];
    arch a;
    if (of->surface_given || has_maps(of) || model_moves_uv(r->mesh) || !is_real(m) || !are_bands(r) ||
        has_other_users(m, r) || !arch_of(r, &a)) {
        return 0;
    }
    if (!r->mesh->uv) r->mesh->uv = model_zeros(2 * (size_t)r->mesh->vertex_count, sizeof *r->mesh->uv);
    if (!r->mesh->uv) return 1;
    const uint32_t texture = add_texture(m, &a);
    if (texture == MODEL_NONE) return 1;
    of->base_color_texture = texture;
    place_rows(r, &a);
    return model_warn(
        m,
        "material '%s': each jaw is one band without divisions, so it got a texture with lines between teeth "
        "(--surface '%s=teeth' keeps the band)",
        of->name, of->name);
}
