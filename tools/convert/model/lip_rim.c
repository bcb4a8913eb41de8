#include "lip_rim.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/face.h"
#include "convert/model/islands.h"
#include "convert/model/model_build.h"

#define LINKS_MAX 512u
#define RIM_MIN 6u
#define WIDENED_MAX 6 /* times one and a half: lips of a mouth that is modelled open are no further apart */
#define CLOSED 0.012f /* half the least gap, in depths of the mouth: seen between closed lips, teeth are dark red */

double lip_between(const lip_rim *h, uint32_t a, uint32_t b)
{
    double x[3], y[3];
    vec_posed(h->mesh->position, NULL, a, x);
    vec_posed(h->mesh->position, NULL, b, y);
    return vec_distance(x, y);
}

/* ---- poses ---- */

/* Add a channel's targets to positions. 0: it has none. */
static int add_channel(const model_mesh *mesh, const noh_face_link *links, uint32_t count, uint32_t channel, float *at)
{
    int any = 0;
    for (uint32_t l = 0; l < count; l++) {
        const model_target *t = &mesh->targets[links[l].target];
        if (links[l].channel != channel || !t->position) continue;
        any = 1;
        for (size_t i = 0; i < (size_t)mesh->vertex_count * 3; i++) at[i] += links[l].weight * t->position[i];
    }
    return any;
}

/* The targets of the recipe's channels. Returns their count. */
static uint32_t links_of(const model_mesh *mesh, noh_face_link links[LINKS_MAX])
{
    const char *names[NOH_TARGETS_MAX];
    const uint32_t targets = mesh->target_count < NOH_TARGETS_MAX ? mesh->target_count : NOH_TARGETS_MAX;
    for (uint32_t t = 0; t < targets; t++) names[t] = mesh->targets[t].name;
    const uint32_t count = noh_face_recipe_bind(NULL, 0, names, targets, links, LINKS_MAX);
    return count < LINKS_MAX ? count : LINKS_MAX;
}

/* The targets that open the mouth, and the FF of existing targets. 0: nothing opens it. */
static int pose(lip_rim *h)
{
    const model_mesh *mesh = h->mesh;
    const size_t bytes = (size_t)mesh->vertex_count * 3 * sizeof(float);
    noh_face_link links[LINKS_MAX];
    const uint32_t count = links_of(mesh, links);
    memcpy(h->bite, mesh->position, bytes);
    if (!add_channel(mesh, links, count, NOH_CHANNEL_VISEMES + NOH_VISEME_AA, h->bite)) return 0;
    h->most = 0.0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        double rest[3], open[3];
        vec_posed(mesh->position, NULL, v, rest);
        vec_posed(h->bite, NULL, v, open);
        h->moved[v] = (float)vec_distance(rest, open);
        if ((double)h->moved[v] > h->most) h->most = (double)h->moved[v], h->skin = v;
    }
    islands_find(mesh, h->island, h->work);
    h->skin = h->island[h->skin];
    memcpy(h->bite, mesh->position, bytes);
    (void)add_channel(mesh, links, count, NOH_CHANNEL_VISEMES + NOH_VISEME_FF, h->bite);
    return h->most > 0.0;
}

/* ---- lips ---- */

static int goes_along(const lip_rim *h, uint32_t v)
{
    return h->island[v] == h->skin && (double)h->moved[v] > 0.5 * h->most;
}

static int stays(const lip_rim *h, uint32_t v)
{
    return h->island[v] == h->skin && (double)h->moved[v] < 0.25 * h->most;
}

/* The place of a cell in h->work, which holds the first vertex of each. Cells may share one. */
static uint32_t place_of_cell(const lip_rim *h, const double cell[3])
{
    uint64_t hash = 0;
    for (int i = 0; i < 3; i++) hash = hash * 0x9E3779B97F4A7C15u + (uint64_t)(int64_t)cell[i];
    return (uint32_t)((hash ^ hash >> 32) % h->mesh->vertex_count);
}

static void cell_of(const lip_rim *h, uint32_t v, double side, double out[3])
{
    vec_posed(h->mesh->position, NULL, v, out);
    for (int i = 0; i < 3; i++) out[i] = fmin(fmax(floor(out[i] / side), -1e15), 1e15);
}

/* List what stays by cells. */
static void fill_cells(lip_rim *h, double side)
{
    double cell[3];
    for (uint32_t v = 0; v < h->mesh->vertex_count; v++) h->work[v] = h->next[v] = MODEL_NONE;
    for (uint32_t v = 0; v < h->mesh->vertex_count; v++) {
        if (!stays(h, v)) continue;
        cell_of(h, v, side, cell);
        const uint32_t place = place_of_cell(h, cell);
        h->next[v] = h->work[place];
        h->work[place] = v;
    }
}

/* What stays nearest to a vertex, no further away than a cell's side; MODEL_NONE: nothing. Equal ones: the last. */
static uint32_t nearest_of(const lip_rim *h, uint32_t v, double side)
{
    uint32_t found = MODEL_NONE;
    double nearest = side, middle[3];
    cell_of(h, v, side, middle);
    for (int i = 0; i < 27; i++) {
        const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
        const double cell[3] = { middle[0] + x, middle[1] + y, middle[2] + z };
        for (uint32_t u = h->work[place_of_cell(h, cell)]; u != MODEL_NONE; u = h->next[u]) {
            const double apart = lip_between(h, v, u);
            if (!(apart < nearest || (apart <= nearest && (found == MODEL_NONE || u > found)))) continue;
            nearest = apart;
            found = u;
        }
    }
    return found;
}

/* If there are too many, they are taken at equal steps, so that both corners are among them in whatever order. */
static void find_rim(lip_rim *h, double touch)
{
    uint32_t count = 0, at = 0;
    fill_cells(h, touch);
    for (uint32_t v = 0; v < h->mesh->vertex_count; v++) {
        if (goes_along(h, v)) count += (h->next[v] = nearest_of(h, v, touch)) != MODEL_NONE;
    }
    h->rim_count = count < LIP_RIM_MAX ? count : LIP_RIM_MAX;
    for (uint32_t v = 0, taken = 0; taken < h->rim_count; v++) {
        if (!goes_along(h, v) || h->next[v] == MODEL_NONE) continue;
        if (at++ < (uint64_t)taken * count / h->rim_count) continue;
        h->upper[taken] = h->next[v];
        h->rim[taken++] = v;
    }
}

/* The line from corner to corner. */
static void measure_rim(lip_rim *h)
{
    uint32_t ends[2] = { 0, 0 };
    for (uint32_t a = 0; a < h->rim_count; a++) {
        for (uint32_t b = a + 1; b < h->rim_count; b++) {
            if (lip_between(h, h->rim[a], h->rim[b]) > lip_between(h, h->rim[ends[0]], h->rim[ends[1]]))
                ends[0] = a, ends[1] = b;
        }
    }
    h->half = 0.5 * lip_between(h, h->rim[ends[0]], h->rim[ends[1]]);
    for (int i = 0; i < 3; i++) {
        const double a = (double)h->mesh->position[3 * (size_t)h->rim[ends[0]] + (size_t)i],
                     b = (double)h->mesh->position[3 * (size_t)h->rim[ends[1]] + (size_t)i];
        h->centre[i] = 0.5 * (a + b);
        h->along[i] = h->half > 0.0 ? 0.5 * (b - a) / h->half : 0.0;
    }
}

/* 0 at the middle, 1 at a corner. */
double lip_aside(const lip_rim *h, const double at[3])
{
    double along = 0.0;
    for (int i = 0; i < 3; i++) along += (at[i] - h->centre[i]) * h->along[i];
    return fabs(along) / h->half;
}

/* Lips that touch in the middle, or lips of a mouth that is modelled a little open. 1: found. */
static int find_lips(lip_rim *h)
{
    h->size = h->most;
    double touch = LIP_TOUCH;
    for (int widened = 0; widened < WIDENED_MAX; widened++, touch *= 1.5) {
        find_rim(h, touch * h->size);
        if (h->rim_count < RIM_MIN) continue;
        measure_rim(h);
        if (1.4 * h->half > h->size) h->size = 1.4 * h->half;
        for (uint32_t r = 0; r < h->rim_count && h->half > LIP_TOUCH * h->size; r++) {
            double at[3];
            vec_posed(h->mesh->position, NULL, h->rim[r], at);
            if (lip_aside(h, at) < 0.2) return 1;
        }
    }
    return 0;
}

/* ---- all of it ---- */

static const char *look(lip_rim *h)
{
    if (!pose(h)) return "it has no target that opens the mouth";
    return find_lips(h) ? NULL : "its lips were not found, or are too far apart at rest";
}

int lip_rim_find(const model_mesh *mesh, lip_rim *h, const char **why)
{
    const size_t count = mesh->vertex_count;
    memset(h, 0, sizeof *h);
    h->mesh = mesh;
    h->island = model_zeros(count, sizeof *h->island);
    h->work = model_zeros(count, sizeof *h->work);
    h->next = model_zeros(count, sizeof *h->next);
    h->moved = model_zeros(count, sizeof *h->moved);
    h->bite = model_zeros(count, 3 * sizeof *h->bite);
    if (!h->island || !h->work || !h->next || !h->moved || !h->bite) return 1;
    *why = look(h);
    return 0;
}

void lip_rim_free(lip_rim *h)
{
    free(h->island);
    free(h->work);
    free(h->next);
    free(h->moved);
    free(h->bite);
}

/* ---- gaps ---- */

#define MIDDLE 0.35 /* of the way to a corner */
#define JOINTS_SHARED 0.75
#define PARTED 0.1f /* half a gap that joints open: more makes a white slit of teeth at rest, less a black open mouth */

/* By how much a target moves the upper lip from the lower one in the middle of the mouth. */
static double opens_by(const lip_rim *h, const model_target *t, const double up[3])
{
    double sum = 0.0, at[3];
    uint32_t count = 0;
    for (uint32_t r = 0; r < h->rim_count && t->position; r++) {
        double upper[3], lower[3];
        vec_posed(h->mesh->position, NULL, h->rim[r], at);
        if (lip_aside(h, at) > MIDDLE) continue;
        vec_posed(t->position, NULL, h->upper[r], upper);
        vec_posed(t->position, NULL, h->rim[r], lower);
        for (int i = 0; i < 3; i++) sum += (upper[i] - lower[i]) * up[i];
        count++;
    }
    return count ? sum / count : 0.0;
}

/* The way of the lower lip when the mouth opens, inverted, and the least distance between the lips at rest. */
static int find_up(lip_rim *h, const noh_face_link *links, uint32_t count, double up[3], double *apart)
{
    double at[3];
    memcpy(h->bite, h->mesh->position, (size_t)h->mesh->vertex_count * 3 * sizeof(float));
    (void)add_channel(h->mesh, links, count, NOH_CHANNEL_VISEMES + NOH_VISEME_AA, h->bite);
    *apart = HUGE_VAL;
    up[0] = up[1] = up[2] = 0.0;
    for (uint32_t r = 0; r < h->rim_count; r++) {
        double upper[3], lower[3];
        const double gap = lip_between(h, h->rim[r], h->upper[r]);
        vec_posed(h->mesh->position, NULL, h->rim[r], at);
        if (lip_aside(h, at) > MIDDLE) continue;
        if (gap < *apart) *apart = gap;
        vec_posed(h->bite, NULL, h->upper[r], upper);
        vec_posed(h->bite, NULL, h->rim[r], lower);
        for (int i = 0; i < 3; i++) up[i] += upper[i] - lower[i];
    }
    return vec_normalize(up);
}

/* The share of a vertex's joints that another one has, too. */
static double shared_joints(const model_mesh *mesh, uint32_t a, uint32_t b)
{
    const size_t at[2] = { (size_t)a * MODEL_INFLUENCES_MAX, (size_t)b * MODEL_INFLUENCES_MAX };
    double sum = 0.0;
    for (size_t i = 0; i < MODEL_INFLUENCES_MAX; i++) {
        for (size_t k = 0; k < MODEL_INFLUENCES_MAX; k++) {
            if (mesh->joints[at[0] + i] != mesh->joints[at[1] + k]) continue;
            sum += (double)fminf(mesh->joint_weights[at[0] + i], mesh->joint_weights[at[1] + k]);
        }
    }
    return sum;
}

/* Whether joints, such as a jaw, move one lip without the other. */
static int joints_part(const lip_rim *h)
{
    double shared = 0.0, at[3];
    uint32_t count = 0;
    for (uint32_t r = 0; r < h->rim_count && h->mesh->joints; r++) {
        vec_posed(h->mesh->position, NULL, h->rim[r], at);
        if (lip_aside(h, at) > MIDDLE) continue;
        shared += shared_joints(h->mesh, h->rim[r], h->upper[r]);
        count++;
    }
    return count && shared < JOINTS_SHARED * count;
}

static void measure_gaps(model *m, lip_rim *h, float slope, float *rest)
{
    noh_face_link links[LINKS_MAX];
    const uint32_t count = links_of(h->mesh, links);
    double up[3], apart;
    if (!find_up(h, links, count, up, &apart)) return;
    *rest = fmaxf((float)(0.5 * apart) * slope, joints_part(h) ? PARTED : CLOSED);
    for (uint32_t t = 0; t < h->mesh->target_count; t++) {
        const float by = (float)(0.5 * opens_by(h, &h->mesh->targets[t], up)) * slope;
        for (uint32_t i = 0; i < m->mesh_count; i++) {
            const uint32_t same = model_find_target(&m->meshes[i], h->mesh->targets[t].name);
            if (same != MODEL_NONE) m->meshes[i].targets[same].lips = fminf(fmaxf(by, -7.9f), 7.9f);
        }
    }
}

int lip_gaps_find(model *m, float slope, float *rest)
{
    const char *why = "";
    for (uint32_t i = 0; i < m->mesh_count && why; i++) {
        lip_rim *h = malloc(sizeof *h);
        const int failed = !h || lip_rim_find(&m->meshes[i], h, &why);
        if (!failed && !why) measure_gaps(m, h, slope, rest);
        if (h) lip_rim_free(h);
        free(h);
        if (failed) return 1;
    }
    return 0;
}
