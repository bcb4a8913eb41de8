#include "teeth_paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/islands.h"
#include "convert/model/model_build.h"
#include "convert/model/surface_kind.h"
#include "convert/model/teeth_lines.h"
#include "noh/format.h"

#define SOFT 0.35f   /* the share of it over which enamel turns to gum */
#define ENAMEL 0.60f /* the largest channel of the brightest place */
#define HUES 0.02f   /* shares of red in one colour differ by less */
#define ALIKE 1.6f
#define OVERBITE 0.15f /* at most, of the lower of two jaws' heights */
#define DEEP_BITE 0.4f /* of jaws that targets part */
#define PARTED 0.05f   /* in widths of the jaw: by at least as much a target parts jaws */
#define PALE_MIN 0.4f  /* of blue to red: less is a tongue or a gum */
#define FLESH_MAX 0.6f /* of green and blue to red: a tongue or gum of more has no colour of its own */

static const float gum[3] = { 0.42f, 0.15f, 0.13f }, neck[3] = { 1.0f, 0.87f, 0.76f };

/* The teeth of one part of a mesh: from the lowest and the highest middle of an island the jaw of each is known. */
typedef struct jaws {
    const model_mesh *mesh;
    const float *factor;
    const uint8_t *used;                     /* of islands_part */
    float width, middle, edge[2], brightest; /* edge: of the lower teeth, of the upper */
} jaws;

static const float *place_of(const jaws *j, uint32_t v)
{
    return j->mesh->position + 3 * (size_t)v;
}

static float channel(const jaws *j, uint32_t v, int c)
{
    return j->factor[c] * (j->mesh->color ? j->mesh->color[4 * (size_t)v + (size_t)c] : 1.0f);
}

/* Whether all of it has one pale hue. */
static int is_plain(jaws *j)
{
    float least = 1.0f, most = 0.0f;
    for (uint32_t v = 0; v < j->mesh->vertex_count; v++) {
        if (!j->used[v]) continue;
        const float r = channel(j, v, 0), g = channel(j, v, 1), b = channel(j, v, 2), sum = r + g + b;
        if (sum < 0.03f) continue; /* black has any hue */
        if (b < PALE_MIN * r) return 0;
        least = fminf(least, r / sum);
        most = fmaxf(most, r / sum);
        j->brightest = fmaxf(j->brightest, fmaxf(r, fmaxf(g, b)));
    }
    return j->brightest > 0.0f && most - least < HUES;
}

/* The height of the middle of each island, at its first vertex. room: [vertex_count], as is middle */
static void find_middles(const jaws *j, const uint32_t *island, float *room, float *middle)
{
    const uint32_t end = j->mesh->vertex_count;
    for (uint32_t v = 0; v < end; v++) room[v] = middle[v] = place_of(j, v)[1];
    for (uint32_t v = 0; v < end; v++) {
        const uint32_t at = island[v];
        if (!j->used[v]) continue;
        room[at] = fminf(room[at], place_of(j, v)[1]);
        middle[at] = fmaxf(middle[at], place_of(j, v)[1]);
    }
    for (uint32_t v = 0; v < end; v++) middle[v] = 0.5f * (room[v] + middle[v]);
}

/* Two jaws have one height and one width, by a factor of ALIKE, and lie over one another except for an overbite; teeth
 * and a gum of one jaw, as islands of their own, do not, and no target parts them.
 * box  of the lower islands, of the upper: least and greatest x, least and greatest y */
static int are_jaws(float box[2][4], int are_parted)
{
    for (int axis = 0; axis < 4; axis += 2) {
        const float lower = box[0][axis + 1] - box[0][axis], upper = box[1][axis + 1] - box[1][axis];
        if (!(lower > 0.0f && upper > 0.0f && lower < ALIKE * upper && upper < ALIKE * lower)) return 0;
    }
    return box[0][3] - box[1][2] <
           (are_parted ? DEEP_BITE : OVERBITE) * fminf(box[0][3] - box[0][2], box[1][3] - box[1][2]);
}

/* Whether a target moves the upper islands from the lower ones. */
static int targets_part(const jaws *j, const uint32_t *island, const float *middle)
{
    for (uint32_t t = 0; t < j->mesh->target_count; t++) {
        const float *moved = j->mesh->targets[t].position;
        double sum[2] = { 0.0, 0.0 }, count[2] = { 0.0, 0.0 };
        for (uint32_t v = 0; moved && v < j->mesh->vertex_count; v++) {
            if (!j->used[v]) continue;
            const int upper = middle[island[v]] > j->middle;
            sum[upper] += (double)moved[3 * (size_t)v + 1];
            count[upper] += 1.0;
        }
        if (count[0] > 0.0 && count[1] > 0.0 && sum[1] / count[1] - sum[0] / count[0] > (double)(PARTED * j->width)) {
            return 1;
        }
    }
    return 0;
}

/* Whether there are two jaws. */
static int find_jaws(jaws *j, const uint32_t *island, const float *middle)
{
    float low = INFINITY, high = -INFINITY, left = INFINITY, right = -INFINITY;
    float box[2][4] = { { INFINITY, -INFINITY, INFINITY, -INFINITY }, { INFINITY, -INFINITY, INFINITY, -INFINITY } };
    for (uint32_t v = 0; v < j->mesh->vertex_count; v++) {
        if (!j->used[v]) continue;
        if (!j->used[island[v]]) return 0; /* joined to something else */
        low = fminf(low, middle[island[v]]);
        high = fmaxf(high, middle[island[v]]);
        left = fminf(left, place_of(j, v)[0]);
        right = fmaxf(right, place_of(j, v)[0]);
    }
    j->middle = 0.5f * (low + high);
    j->width = right - left;
    for (uint32_t v = 0; v < j->mesh->vertex_count; v++) {
        if (!j->used[v]) continue;
        float *of = box[middle[island[v]] > j->middle];
        for (int axis = 0; axis < 2; axis++) {
            of[2 * axis] = fminf(of[2 * axis], place_of(j, v)[axis]);
            of[2 * axis + 1] = fmaxf(of[2 * axis + 1], place_of(j, v)[axis]);
        }
    }
    j->edge[0] = box[0][3];
    j->edge[1] = box[1][2];
    return j->width > 0.0f && high - low > 0.1f * j->width && are_jaws(box, targets_part(j, island, middle));
}

static void paint(const jaws *j, const uint32_t *island, const float *middle)
{
    for (uint32_t v = 0; v < j->mesh->vertex_count; v++) {
        if (!j->used[v]) continue;
        const int upper = middle[island[v]] > j->middle;
        const float away = fabsf(place_of(j, v)[1] - j->edge[upper]) / (TEETH_CROWN * j->width);
        const float root = teeth_smooth(0.3f, 1.0f, away), share = teeth_smooth(1.0f - SOFT, 1.0f + SOFT, away);
        const float r = channel(j, v, 0), g = channel(j, v, 1), b = channel(j, v, 2);
        const float bright = fmaxf(r, fmaxf(g, b)) / j->brightest, own[3] = { r, g, b };
        for (int c = 0; c < 3; c++) {
            const float enamel = own[c] * (ENAMEL / j->brightest) * (1.0f + root * (neck[c] - 1.0f));
            const float color = enamel + share * (gum[c] * bright - enamel);
            j->mesh->color[4 * (size_t)v + (size_t)c] = fminf(color / fmaxf(j->factor[c], 1e-3f), 1.0f);
        }
    }
}

static int paint_part(model *m, model_mesh *mesh, const model_submesh *part, const uint8_t *used,
                      const uint32_t *island, float *room, float *middle)
{
    jaws j = { .mesh = mesh, .factor = m->materials[part->material].base_color, .used = used };
    if (!is_plain(&j)) return 0;
    find_middles(&j, island, room, middle);
    if (!find_jaws(&j, island, middle)) return 0;
    if (!mesh->color) {
        mesh->color = model_zeros(4 * (size_t)mesh->vertex_count, sizeof *mesh->color);
        for (size_t i = 0; mesh->color && i < 4 * (size_t)mesh->vertex_count; i++) mesh->color[i] = 1.0f;
    }
    if (!mesh->color) return 1;
    paint(&j, island, middle);
    const teeth_rows rows = { mesh, part, used, island, middle, j.middle, j.width, { j.edge[0], j.edge[1] } };
    return teeth_lines_paint(m, &rows);
}

/* Whether no vertex of the material has a colour of flesh. */
static int is_pale(const model *m, uint32_t material)
{
    const float *factor = m->materials[material].base_color;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        for (uint32_t s = 0; s < mesh->submesh_count; s++) {
            const model_submesh *part = &mesh->submeshes[s];
            for (uint32_t k = 0; part->material == material && k < part->index_count; k++) {
                const jaws j = { .mesh = mesh, .factor = factor };
                const uint32_t v = mesh->indices[part->first_index + k];
                if (fminf(channel(&j, v, 1), channel(&j, v, 2)) < FLESH_MAX * channel(&j, v, 0)) return 0;
            }
        }
    }
    return 1;
}

/* Gums and tongues that are as pale as teeth, or skin, look like plaster. A mouth of one material may be teeth. */
static int paint_gums(model *m)
{
    uint32_t mouths = 0;
    int failed = 0;
    for (uint32_t i = 0; i < m->material_count; i++) mouths += m->materials[i].surface == NOH_SURFACE_TEETH;
    for (uint32_t i = 0; i < m->material_count && mouths > 1u && !failed; i++) {
        model_material *by = &m->materials[i];
        if (by->surface != NOH_SURFACE_TEETH || by->surface_given || by->base_color_texture != MODEL_NONE ||
            !surface_is_gums(by->name) || !is_pale(m, i)) {
            continue;
        }
        memcpy(by->base_color, gum, sizeof gum);
        failed = model_warn(m,
                            "material '%s': gums and tongues as pale as skin look like plaster, so they became red "
                            "(--surface '%s=plain' keeps them)",
                            by->name, by->name);
    }
    return failed;
}

int teeth_paint(model *m)
{
    int failed = paint_gums(m);
    for (uint32_t i = 0; i < m->mesh_count && !failed; i++) {
        model_mesh *mesh = &m->meshes[i];
        uint32_t *island = NULL, *room = NULL;
        float *middle = NULL, *lowest = NULL;
        for (uint32_t s = 0; s < mesh->submesh_count && !failed; s++) {
            const model_submesh *part = &mesh->submeshes[s];
            const model_material *by = part->material == MODEL_NONE ? NULL : &m->materials[part->material];
            uint8_t *used;
            if (!by || by->surface != NOH_SURFACE_TEETH || by->base_color_texture != MODEL_NONE) continue;
            if (!island) {
                island = model_zeros(mesh->vertex_count, sizeof *island);
                room = model_zeros(mesh->vertex_count, sizeof *room);
                middle = model_zeros(mesh->vertex_count, sizeof *middle);
                lowest = model_zeros(mesh->vertex_count, sizeof *lowest);
                failed = !island || !room || !middle || !lowest;
                if (!failed) islands_find(mesh, island, room);
            }
            used = failed ? NULL : islands_part(mesh, part);
            failed = !used || paint_part(m, mesh, part, used, island, lowest, middle);
            free(used);
        }
        free(lowest);
        free(island);
        free(room);
        free(middle);
    }
    return failed;
}
