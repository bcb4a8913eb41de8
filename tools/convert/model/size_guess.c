#include "size_guess.h"

#include <math.h>
#include <string.h>

#include "convert/base/names.h"
#include "convert/model/affine.h"
#include "convert/model/mesh_place.h"
#include "convert/model/model_build.h"
#include "noh/format.h"

#define EYES_M 0.063    /* between the centres of an adult's eyes; drawn figures have up to twice that */
#define HEIGHT_M 1.7    /* of an adult */
#define LOWEST_M 0.1    /* of a head alone, with those eyes */
#define HIGHEST_M 4.0   /* of a figure with those eyes */
#define OFF_BY_EYES 4.0 /* a size that is further off than this factor has another unit */
#define OFF_BY_HEIGHT 8.0
#define HUMAN_EYES_MIN_M 0.04
#define HUMAN_EYES_MAX_M 0.13
#define HUMAN_HEIGHT_MAX_M 2.5
#define HEAD_ABOVE_FEET 1.2 /* height over the distance from head joint to foot joint */

typedef struct sizes {
    double eyes, height; /* metres, as read; 0: not known */
} sizes;

static const model_node *find_joint(const model *m, const char *meant)
{
    char means[NOH_NAME_BYTES_MAX];
    for (uint32_t n = 0; n < m->node_count; n++) {
        if (m->nodes[n].mesh == MODEL_NONE && names_find(NAME_JOINT, m->nodes[n].name, means, NULL) &&
            strcmp(means, meant) == 0)
            return &m->nodes[n];
    }
    return NULL;
}

static double between(const model_node *a, const model_node *b)
{
    double square = 0.0;
    for (int i = 12; i < 15 && a && b; i++) square += (a->world[i] - b->world[i]) * (a->world[i] - b->world[i]);
    return sqrt(square);
}

static void place_vertex(const model_mesh *mesh, uint32_t vertex, const double place[16], double out[3])
{
    const float *p = mesh->position + 3 * (size_t)vertex;
    const double at[3] = { (double)p[0], (double)p[1], (double)p[2] };
    affine_point(place, at, out);
}

/* Sums of the x, y and z of the triangles' corners of eyes on either side of `middle`, and their numbers. */
static void sum_eyes(const model *m, double middle, double sums[2][3], double counts[2])
{
    memset(sums, 0, 2 * sizeof sums[0]);
    counts[0] = counts[1] = 0.0;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t s = 0; s < m->meshes[i].submesh_count; s++) {
            const model_submesh *part = &m->meshes[i].submeshes[s];
            double places[MESH_PLACES_MAX][16];
            if (part->material == MODEL_NONE || m->materials[part->material].surface != NOH_SURFACE_EYE) continue;
            const uint32_t *corners = m->meshes[i].indices + part->first_index;
            const uint32_t count = part->index_count ? mesh_places(m, i, corners[0], places) : 0u;
            for (uint32_t k = 0; k < count * part->index_count; k++) {
                double at[3];
                place_vertex(&m->meshes[i], corners[k / count], places[k % count], at);
                const int side = at[0] > middle;
                for (int c = 0; c < 3; c++) sums[side][c] += at[c];
                counts[side] += 1.0;
            }
        }
    }
}

static double eyes_by_material(const model *m)
{
    double sums[2][3], counts[2], square = 0.0;
    sum_eyes(m, INFINITY, sums, counts);
    if (counts[0] == 0.0) return 0.0;
    sum_eyes(m, sums[0][0] / counts[0], sums, counts);
    for (int c = 0; c < 3 && counts[0] > 0.0 && counts[1] > 0.0; c++) {
        const double apart = sums[1][c] / counts[1] - sums[0][c] / counts[0];
        square += apart * apart;
    }
    return sqrt(square);
}

static double height_of_meshes(const model *m)
{
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        double places[MESH_PLACES_MAX][16];
        const uint32_t count = mesh->vertex_count ? mesh_places(m, i, 0, places) : 0u;
        for (uint32_t k = 0; k < count * mesh->vertex_count; k++) {
            double at[3];
            place_vertex(mesh, k / count, places[k % count], at);
            low = at[1] < low ? at[1] : low;
            high = at[1] > high ? at[1] : high;
        }
    }
    return high > low ? high - low : 0.0;
}

static sizes measure(const model *m)
{
    const model_node *head = find_joint(m, "head"), *foot = find_joint(m, "leftFoot");
    sizes s = { between(find_joint(m, "leftEye"), find_joint(m, "rightEye")), HEAD_ABOVE_FEET * between(head, foot) };
    if (s.eyes == 0.0) s.eyes = eyes_by_material(m);
    if (s.height == 0.0 && s.eyes > 0.0) s.height = height_of_meshes(m);
    if (s.eyes > 0.0 && !(s.height * EYES_M > LOWEST_M * s.eyes && s.height * EYES_M < HIGHEST_M * s.eyes)) {
        memset(&s, 0, sizeof s); /* these are no eyes, or it is no figure */
    }
    return s;
}

typedef struct unit {
    double metres;
    const char *name;
} unit;

/* The unit that fits better than a metre; NULL: none does. */
static const unit *better_unit(const sizes *s)
{
    static const unit units[] = { { 0.1, "a decimetre" },
                                  { 0.0254, "an inch" },
                                  { 0.01, "a centimetre" },
                                  { 0.001, "a millimetre" },
                                  { 100.0, "a hectometre" } };
    const double scale = s->eyes > 0.0 ? s->eyes / EYES_M : s->height / HEIGHT_M;
    const double off = s->eyes > 0.0 ? OFF_BY_EYES : OFF_BY_HEIGHT;
    const unit *best = NULL;
    if (!(scale > 0.0) || (scale < off && scale > 1.0 / off)) return NULL;
    for (const unit *u = units; u < units + sizeof units / sizeof units[0]; u++) {
        if (fabs(log(scale * u->metres)) < fabs(log(scale * (best ? best->metres : 1.0)))) best = u;
    }
    return best;
}

double size_unit(const model *m)
{
    const sizes s = measure(m);
    const unit *best = better_unit(&s);
    const double eyes = best ? s.eyes * best->metres : 0.0;
    const int is_certain = best && best->metres <= 0.1 && eyes >= HUMAN_EYES_MIN_M && eyes <= HUMAN_EYES_MAX_M &&
                           s.height * best->metres < HUMAN_HEIGHT_MAX_M;
    return is_certain ? best->metres : 1.0; /* a doll or a giant keeps its size */
}

int size_guess(model *m, FILE *report)
{
    char eyes[48] = "";
    const sizes s = measure(m);
    const unit *best = better_unit(&s);
    if (!(s.eyes > 0.0) && !(s.height > 0.0)) { /* no person */
        const double height = height_of_meshes(m);
        if (report && height > 0.0) fprintf(report, "the model is %.3g m high\n", height);
        return 0;
    }
    if (s.eyes > 0.0) (void)snprintf(eyes, sizeof eyes, ", its eyes %.3g cm apart", 100.0 * s.eyes);
    if (report) fprintf(report, "the figure is %.3g m high%s\n", s.height, eyes);
    if (!best) return 0;
    return model_warn(
        m,
        "the figure is %.3g m high%s: a unit is more likely %s than a metre (--unit-cm for .obj and .fbx; "
        "scale others by %g in the program that made them)",
        s.height, eyes, best->name, best->metres);
}
