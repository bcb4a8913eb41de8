#include "wrinkle_face.h"

#include <math.h>
#include <string.h>

#include "noh/base.h"
#include "noh/face.h"
#include "convert/model/model_build.h"

#define LINKS_MAX 4096u
#define BROW_USUAL 0.35 /* where nothing raises the brows */

/* What moves each channel. */
typedef struct movers {
    const wrinkle_field *field;
    noh_face_row rows[NOH_FACE_ROWS_MAX];
    noh_face_link links[LINKS_MAX];
    uint32_t count;
} movers;

static void bind(const wrinkle_field *f, const recipe_text *recipe, movers *m)
{
    const char *names[NOH_TARGETS_MAX];
    noh_face_recipe own = { "own", m->rows, 0, NULL };
    const noh_face_recipe *recipes[] = { &own, &noh_face_recipe_arkit, &noh_face_recipe_vrm, &noh_face_recipe_units };
    const uint32_t targets = f->mesh->target_count < NOH_TARGETS_MAX ? f->mesh->target_count : NOH_TARGETS_MAX;
    for (uint32_t i = 0; recipe && i < recipe->count && own.row_count < NOH_FACE_ROWS_MAX; i++) {
        const recipe_row *row = &recipe->rows[i];
        const uint32_t channel = noh_face_channel_find(row->channel);
        if (channel == NOH_NONE) continue;
        m->rows[own.row_count++] = (noh_face_row){ row->target, (uint16_t)channel, row->weight };
    }
    for (uint32_t t = 0; t < targets; t++) names[t] = f->mesh->targets[t].name;
    m->field = f;
    m->count = noh_face_recipe_bind(recipes, 4, names, targets, m->links, LINKS_MAX);
    m->count = m->count < LINKS_MAX ? m->count : LINKS_MAX;
}

/* The square of how far a channel moves a vertex. */
static double moved(const movers *m, uint32_t channel, uint32_t vertex)
{
    double sum[3] = { 0 };
    for (uint32_t i = 0; i < m->count; i++) {
        const noh_face_link *link = &m->links[i];
        const float *delta = m->field->mesh->targets[link->target].position + 3 * (size_t)vertex;
        for (int k = 0; k < 3 && link->channel == channel; k++) sum[k] += (double)link->weight * (double)delta[k];
    }
    return vec_dot(sum, sum);
}

/* The area of a point where a channel moves it, 0 at other vertices. power: of the square of how far */
static double weight(const movers *m, uint32_t channel, int power, uint32_t vertex)
{
    const double square = m->field->point[vertex] == vertex ? moved(m, channel, vertex) : 0.0;
    double w = m->field->point_area[vertex];
    for (int i = 0; i < power; i++) w *= square;
    return w;
}

static double lids(const movers *m, uint32_t vertex)
{
    return weight(m, NOH_CHANNEL_BLINK_LEFT, 1, vertex) + weight(m, NOH_CHANNEL_BLINK_RIGHT, 1, vertex);
}

/* The mean of what blinks on each side of a plane through the middle. side: its normal */
static int part_eyes(const movers *m, const double middle[3], const double side[3], double eyes[2][3])
{
    double sums[2] = { 0.0 };
    memset(eyes, 0, 2 * sizeof *eyes);
    for (uint32_t v = 0; v < m->field->mesh->vertex_count; v++) {
        const double w = lids(m, v);
        double p[3], from[3];
        int is;
        if (!(w > 0.0)) continue;
        vec_posed(m->field->mesh->position, NULL, v, p);
        for (int k = 0; k < 3; k++) from[k] = p[k] - middle[k];
        is = vec_dot(from, side) > 0.0;
        sums[is] += w;
        for (int k = 0; k < 3; k++) eyes[is][k] += w * p[k];
    }
    if (!(sums[0] > 0.0 && sums[1] > 0.0)) return 0;
    for (int i = 0; i < 6; i++) eyes[i / 3][i % 3] /= sums[i / 3];
    return 1;
}

/* The mean place and normal of what blinks, and the direction to where it blinks most, far from there. */
static int find_lids(const movers *m, double middle[3], double normal[3], double side[3])
{
    const model_mesh *mesh = m->field->mesh;
    double sum = 0.0, most = 0.0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const double w = lids(m, v);
        sum += w;
        for (size_t k = 0; k < 3; k++) {
            middle[k] += w * (double)mesh->position[3 * (size_t)v + k];
            normal[k] += w * (double)mesh->normal[3 * (size_t)v + k];
        }
    }
    for (int k = 0; k < 3 && sum > 0.0; k++) middle[k] /= sum;
    for (uint32_t v = 0; v < mesh->vertex_count && sum > 0.0; v++) {
        double p[3], far;
        vec_posed(mesh->position, NULL, v, p);
        for (int k = 0; k < 3; k++) p[k] -= middle[k];
        far = lids(m, v) * vec_dot(p, p);
        if (!(far > most)) continue;
        most = far;
        memcpy(side, p, sizeof p);
    }
    return most > 0.0;
}

static int find_mouth(const movers *m, double mouth[3])
{
    double sum = 0.0;
    for (uint32_t v = 0; v < m->field->mesh->vertex_count; v++) {
        const double w = weight(m, NOH_CHANNEL_MOUTH + NOH_EMOTION_JOY, 2, v);
        sum += w;
        for (size_t k = 0; k < 3; k++) mouth[k] += w * (double)m->field->mesh->position[3 * (size_t)v + k];
    }
    for (int k = 0; k < 3 && sum > 0.0; k++) mouth[k] /= sum;
    return sum > 0.0;
}

/* Its axes, from what blinks and what smiles. */
static int find_axes(const movers *m, wrinkle_face *out)
{
    double normal[3] = { 0 }, mouth[3] = { 0 }, side[3] = { 0 }, eyes[2][3], *x = out->axis[0], *y = out->axis[1];
    if (!find_lids(m, out->middle, normal, side) || !find_mouth(m, mouth)) return 0;
    for (int round = 0; round < 4; round++) { /* two means */
        if (!part_eyes(m, out->middle, side, eyes)) return 0;
        for (int k = 0; k < 3; k++) {
            out->middle[k] = 0.5 * (eyes[0][k] + eyes[1][k]);
            side[k] = eyes[1][k] - eyes[0][k];
        }
    }
    out->unit = sqrt(vec_dot(side, side));
    memcpy(x, side, sizeof side);
    for (int k = 0; k < 3; k++) y[k] = out->middle[k] - mouth[k];
    if (!vec_normalize(x)) return 0;
    vec_reject(y, x);
    if (!vec_normalize(y)) return 0;
    vec_cross(x, y, out->axis[2]);
    for (int k = 0; k < 3 && vec_dot(out->axis[2], normal) < 0.0; k++) x[k] = -x[k];
    vec_cross(x, y, out->axis[2]);
    return 1;
}

void wrinkle_face_direction(const wrinkle_face *face, const double direction[3], double out[3])
{
    for (int k = 0; k < 3; k++) out[k] = vec_dot(direction, face->axis[k]);
}

void wrinkle_face_point(const wrinkle_face *face, const double point[3], double out[3])
{
    double from[3];
    for (int k = 0; k < 3; k++) from[k] = (point[k] - face->middle[k]) / face->unit;
    wrinkle_face_direction(face, from, out);
}

/* The brows, by what surprise raises above the eyes, and the corners of the mouth, by what a smile moves most. */
static void find_marks(const movers *m, wrinkle_face *out)
{
    double brows = 0.0, corners = 0.0;
    for (uint32_t v = 0; v < m->field->mesh->vertex_count; v++) {
        double p[3], at[3], w;
        vec_posed(m->field->mesh->position, NULL, v, p);
        wrinkle_face_point(out, p, at);
        w = at[1] > 0.1 ? weight(m, NOH_CHANNEL_UPPER + NOH_EMOTION_SURPRISE, 2, v) : 0.0;
        brows += w;
        out->brow += w * at[1];
        w = at[1] < -0.4 ? weight(m, NOH_CHANNEL_MOUTH + NOH_EMOTION_JOY, 4, v) : 0.0;
        corners += w;
        out->mouth[0] += w * fabs(at[0]);
        out->mouth[1] += w * at[1];
    }
    out->brow = brows > 0.0 ? out->brow / brows : BROW_USUAL;
    for (int k = 0; k < 2 && corners > 0.0; k++) out->mouth[k] /= corners;
}

int wrinkle_face_find(const wrinkle_field *field, const recipe_text *recipe, wrinkle_face *out)
{
    movers m;
    memset(out, 0, sizeof *out);
    bind(field, recipe, &m);
    if (!find_axes(&m, out)) return 0;
    find_marks(&m, out);
    return out->brow > 0.1 && out->brow < 1.0 && out->mouth[0] > 0.15 && out->mouth[0] < 0.9 && out->mouth[1] > -2.0 &&
           out->mouth[1] < -0.5;
}
