#include "seam.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/affine.h"
#include "convert/model/model_build.h"
#include "seam_internal.h"

#define DEGREES 57.29577951308232
#define SAME_PLACE 1e-5
#define SAME_DEGREES 1.0
#define SAME_WEIGHT (1.0 / 255.0)

/* ---- a vertex at rest ---- */

static const model_skin *skin_of(const model *m, const border *b)
{
    return &m->skins[m->nodes[b->node].skin];
}

uint32_t node_weights_of(const model *m, const border *b, uint32_t vertex, node_weight out[MODEL_INFLUENCES_MAX])
{
    const model_mesh *mesh = &m->meshes[b->mesh];
    const size_t at = (size_t)vertex * MODEL_INFLUENCES_MAX;
    uint32_t count = 0;
    for (uint32_t i = 0; i < MODEL_INFLUENCES_MAX && mesh->joint_weights[at + i] > 0.0f; i++) {
        out[count].node = skin_of(m, b)->joints[mesh->joints[at + i]];
        out[count++].weight = (double)mesh->joint_weights[at + i];
    }
    return count;
}

void seam_matrix(const model *m, const border *b, uint32_t vertex, double out[16])
{
    const model_mesh *mesh = &m->meshes[b->mesh];
    const size_t at = (size_t)vertex * MODEL_INFLUENCES_MAX;
    skin_rest_matrix(m, skin_of(m, b), mesh->joints + at, mesh->joint_weights + at, out);
}

void seam_normal(const model *m, const border *b, uint32_t vertex, const float *delta, double out[3])
{
    double matrix[16], turn[9], n[3];
    seam_matrix(m, b, vertex, matrix);
    affine_cofactors(matrix, turn);
    vec_posed(m->meshes[b->mesh].normal, delta, vertex, n);
    for (int i = 0; i < 3; i++) out[i] = turn[i] * n[0] + turn[3 + i] * n[1] + turn[6 + i] * n[2];
    (void)vec_normalize(out);
}

void seam_delta(const model *m, const border *b, uint32_t vertex, const float *delta, double out[3])
{
    const float *d = delta + 3 * (size_t)vertex;
    double matrix[16];
    seam_matrix(m, b, vertex, matrix);
    for (int i = 0; i < 3; i++) {
        out[i] = matrix[i] * (double)d[0] + matrix[4 + i] * (double)d[1] + matrix[8 + i] * (double)d[2];
    }
}

/* ---- measuring ---- */

static double length_of(const double v[3])
{
    return sqrt(vec_dot(v, v));
}

static double apart(const double a[3], const double b[3])
{
    const double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
    return length_of(d);
}

static double weight_of(const node_weight *list, uint32_t count, uint32_t node)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) sum += list[i].node == node ? list[i].weight : 0.0;
    return sum;
}

/* Where a joint alone would take a vertex. Returns 0 if the skin has it not. */
static int place_by(const model *m, const border *b, uint32_t vertex, uint32_t node, double out[3])
{
    const model_skin *skin = skin_of(m, b);
    double position[3];
    vec_posed(m->meshes[b->mesh].position, NULL, vertex, position);
    for (uint32_t j = 0; j < skin->joint_count; j++) {
        double inverse[16], matrix[16];
        if (skin->joints[j] != node) continue;
        affine_of_floats(skin->inverse_bind + 16 * (size_t)j, inverse);
        affine_multiply(m->nodes[node].world, inverse, matrix);
        for (int i = 0; i < 3; i++) {
            out[i] = matrix[i] * position[0] + matrix[4 + i] * position[1] + matrix[8 + i] * position[2] +
                     matrix[12 + i];
        }
        return 1;
    }
    return 0;
}

static void measure_weights(const model *m, const border *const side[2], const uint32_t vertex[2], double gap,
                            seam_findings *f)
{
    node_weight list[2][MODEL_INFLUENCES_MAX];
    uint32_t count[2];
    for (int k = 0; k < 2; k++) count[k] = node_weights_of(m, side[k], vertex[k], list[k]);
    for (int k = 0; k < 2; k++) {
        for (uint32_t i = 0; i < count[k]; i++) {
            const uint32_t node = list[k][i].node;
            const double other = fabs(weight_of(list[0], count[0], node) - weight_of(list[1], count[1], node));
            double a[3], b[3];
            if (other > f->weight) f->weight = other, f->weight_node = node;
            if (!place_by(m, side[0], vertex[0], node, a) || !place_by(m, side[1], vertex[1], node, b)) continue;
            const double bound = apart(a, b) - gap;
            if (bound > f->bind_gap) f->bind_gap = bound, f->bind_node = node;
        }
    }
}

/* How far targets of one side move its vertex from the other side's. */
static void measure_targets(const model *m, const border *const side[2], const uint32_t vertex[2], int k,
                            seam_findings *f)
{
    const model_mesh *mesh = &m->meshes[side[k]->mesh], *across = &m->meshes[side[1 - k]->mesh];
    for (uint32_t t = 0; t < mesh->target_count; t++) {
        const uint32_t same = model_find_target(across, mesh->targets[t].name);
        double own[3], other[3] = { 0.0, 0.0, 0.0 };
        if (same != MODEL_NONE && k) continue; /* measured from the other side */
        seam_delta(m, side[k], vertex[k], mesh->targets[t].position, own);
        if (same != MODEL_NONE) {
            seam_delta(m, side[1 - k], vertex[1 - k], across->targets[same].position, other);
        }
        if (apart(own, other) > f->delta) f->delta = apart(own, other), f->target = mesh->targets[t].name;
    }
}

static void measure_gap(double gap, const double where[3], seam_findings *f)
{
    if (gap <= f->gap) return;
    f->gap = gap;
    memcpy(f->where, where, sizeof f->where);
}

static void measure_lone(const seam_pair *s, int k, seam_findings *f)
{
    const border *b = s->side[k];
    for (uint32_t p = 0; p < b->point_count; p++) {
        uint32_t edge;
        double along;
        if (s->mate[k][p] != MODEL_NONE) continue;
        f->lone_count++;
        measure_gap(sqrt(border_nearest(s->side[1 - k], b->points[p].position, &edge, &along)), b->points[p].position,
                    f);
    }
}

static void measure(const model *m, const seam_pair *s, seam_findings *f)
{
    memset(f, 0, sizeof *f);
    f->mesh_a = s->side[0]->mesh;
    f->mesh_b = s->side[1]->mesh;
    f->size = s->side[0]->size > s->side[1]->size ? s->side[0]->size : s->side[1]->size;
    for (uint32_t p = 0; p < s->side[0]->point_count; p++) {
        const border_point *a = &s->side[0]->points[p], *b;
        if (s->mate[0][p] == MODEL_NONE) continue;
        b = &s->side[1]->points[s->mate[0][p]];
        const uint32_t vertex[2] = { a->vertex, b->vertex };
        double normals[2][3], degrees;
        f->pair_count++;
        measure_gap(apart(a->position, b->position), a->position, f);
        for (int k = 0; k < 2; k++) seam_normal(m, s->side[k], vertex[k], NULL, normals[k]);
        degrees = DEGREES * vec_angle(normals[0], normals[1]);
        if (degrees > f->normal_degrees && !seam_is_crease(a, b)) f->normal_degrees = degrees;
        measure_weights(m, s->side, vertex, apart(a->position, b->position), f);
        for (int k = 0; k < 2; k++) measure_targets(m, s->side, vertex, k, f);
    }
    for (int k = 0; k < 2; k++) measure_lone(s, k, f);
}

int seams_measure(const model *m, seam_findings **out, uint32_t *count)
{
    border_list borders;
    seam_list seams = { 0, NULL, 0 };
    int failed = borders_find(m, &borders) || seams_find(&borders, &seams);
    *out = NULL;
    *count = 0;
    if (!failed && seams.count) {
        *out = model_zeros(seams.count, sizeof **out);
        failed = !*out;
        for (; !failed && *count < seams.count; *count += 1) measure(m, &seams.all[*count], &(*out)[*count]);
    }
    seams_free(&seams);
    borders_free(&borders);
    return failed;
}

int seam_is_closed(const seam_findings *seam)
{
    return seam->gap <= SAME_PLACE * seam->size && seam->normal_degrees <= SAME_DEGREES &&
           seam->weight <= SAME_WEIGHT && seam->delta <= SAME_PLACE * seam->size &&
           seam->bind_gap <= SAME_PLACE * seam->size;
}

/* ---- telling ---- */

typedef struct words {
    char text[320];
    size_t used;
} words;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
add_words(words *w, const char *format, ...)
{
    va_list arguments;
    int bytes = snprintf(w->text + w->used, sizeof w->text - w->used, "%s", w->used ? ", " : "");
    w->used += (size_t)bytes;
    if (w->used >= sizeof w->text) w->used = sizeof w->text - 1u;
    va_start(arguments, format);
    bytes = vsnprintf(w->text + w->used, sizeof w->text - w->used, format, arguments);
    va_end(arguments);
    w->used += (size_t)bytes;
    if (w->used >= sizeof w->text) w->used = sizeof w->text - 1u;
}

/* The faults of a seam, in words: "text, text". */
static words describe(const model *m, const seam_findings *f)
{
    const double same = SAME_PLACE * f->size;
    words w = { "", 0 };
    if (f->gap > same) {
        add_words(&w, "positions are up to %.3g mm apart (at %.3f %.3f %.3f)", 1000.0 * f->gap, f->where[0],
                  f->where[1], f->where[2]);
    }
    if (f->normal_degrees > SAME_DEGREES) add_words(&w, "normals differ by up to %.0f degrees", f->normal_degrees);
    if (f->weight > SAME_WEIGHT) {
        add_words(&w, "weights differ by up to %.2f ('%.32s')", f->weight, m->nodes[f->weight_node].name);
    }
    if (f->delta > same) {
        add_words(&w, "target '%.32s' moves one side by up to %.3g mm", f->target, 1000.0 * f->delta);
    }
    if (f->bind_gap > same) {
        add_words(&w, "'%.32s' was bound in different poses, %.3g mm apart", m->nodes[f->bind_node].name,
                  1000.0 * f->bind_gap);
    }
    return w;
}

static int warn_open(model *m, const seam_findings *f, int mended)
{
    const words w = describe(m, f);
    return model_warn(m, "the seam of '%.40s' and '%.40s' is open: %s%s", m->meshes[f->mesh_a].name,
                      m->meshes[f->mesh_b].name, w.text,
                      mended          ? "; --seam mend could not close it"
                      : f->lone_count ? "; not all of its vertices have a partner; --seam mend closes it at rest"
                                      : "; --seam mend closes it");
}

static void report_mended(FILE *report, const model *m, const seam_findings *f)
{
    const words w = describe(m, f);
    fprintf(report, "seam of '%s' and '%s' closed: %u pairs of vertices", m->meshes[f->mesh_a].name,
            m->meshes[f->mesh_b].name, f->pair_count);
    if (f->lone_count) fprintf(report, ", %u vertices moved onto edges", f->lone_count);
    fprintf(report, "; before, %s\n", w.text);
}

static int mend_all(model *m, FILE *report, int *gave_up, uint32_t *found)
{
    border_list borders;
    seam_list seams = { 0, NULL, 0 };
    int failed = borders_find(m, &borders) || seams_find(&borders, &seams);
    for (uint32_t i = 0; !failed && i < seams.count; i++) {
        const seam_pair *s = &seams.all[i];
        uint32_t *const weld[2] = { borders.weld[s->side[0]->mesh], borders.weld[s->side[1]->mesh] };
        seam_findings before;
        measure(m, s, &before);
        if (report && !seam_is_closed(&before)) report_mended(report, m, &before);
        failed = seam_mend(m, s, weld);
    }
    *gave_up = seams.gave_up;
    *found = seams.count;
    seams_free(&seams);
    borders_free(&borders);
    return failed;
}

int seams_close(model *m, seam_mode mode, FILE *report, model_error *error)
{
    seam_findings *all = NULL;
    uint32_t count = 0, found = 0;
    int failed = 0, gave_up = 0;
    if (mode == SEAM_OFF || (mode == SEAM_CHECK && m->mesh_count < 2)) return 0;
    if (mode == SEAM_MEND) failed = mend_all(m, report, &gave_up, &found);
    failed = failed || seams_measure(m, &all, &count);
    for (uint32_t i = 0; !failed && i < count; i++) {
        if (!seam_is_closed(&all[i])) failed = warn_open(m, &all[i], mode == SEAM_MEND);
    }
    if (!failed && mode == SEAM_MEND && !found) {
        failed = model_warn(m,
                            "--seam mend: no two skinned meshes have borders that lie along each other within a "
                            "tenth of their size: no seam was closed%s",
                            gave_up ? "; there are too many borders to compare all of them" : "");
    }
    free(all);
    return failed ? model_fail_memory(error) : 0;
}
