#include "lip_target.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "noh/face.h"
#include "convert/model/islands.h"
#include "convert/model/model_build.h"
#include "convert/model/target_append.h"

#define LINKS_MAX 512u
#define RIM_MAX 512u
#define RIM_MIN 6u

/* Shares of the size of the mouth: about 35 mm for a person. */
#define TOUCH 0.07      /* lips that touch are no further apart */
#define WIDENED_MAX 6   /* times one and a half: lips of a mouth that is modelled open are no further apart */
#define REACH 0.6       /* teeth are no further from the lips */
#define STILL 0.02      /* of how far the chin moves: teeth that stay move no more */
#define CLEARANCE 0.008 /* left between lip and teeth */
#define AROUND 0.28     /* how far the skin around the rim goes along */

typedef struct triangle {
    double at[3][3];
} triangle;

typedef struct mouth {
    const model_mesh *mesh;
    uint32_t *island; /* [vertex_count] */
    uint32_t *work;   /* [vertex_count] */
    float *moved;     /* [vertex_count] how far the open mouth moves it */
    float *bite;      /* [vertex_count][3] rest, and the deltas of the recipe's FF */
    double most;      /* the farthest of `moved` */
    double size;      /* of the mouth: `most`, or half its width and two fifths, whichever is more */
    uint32_t skin;    /* island */
    uint32_t rim[RIM_MAX], rim_count;
    double ways[RIM_MAX][3]; /* from a point of the rim towards the teeth */
    double centre[3], along[3], half;
    triangle *teeth;
    uint32_t tooth_count;
    double before; /* from the middle of the rim to the teeth, at the least; HUGE_VAL: it has no middle */
} mouth;

static double distance(const double a[3], const double b[3])
{
    double square = 0.0;
    for (int i = 0; i < 3; i++) square += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(square);
}

static void point(const float *positions, uint32_t vertex, double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = (double)positions[3 * (size_t)vertex + (size_t)i];
}

static double between(const mouth *h, uint32_t a, uint32_t b)
{
    double x[3], y[3];
    point(h->mesh->position, a, x);
    point(h->mesh->position, b, y);
    return distance(x, y);
}

static double smooth(double from, double to, double x)
{
    const double t = x <= from ? 0.0 : x >= to ? 1.0 : (x - from) / (to - from);
    return t * t * (3.0 - 2.0 * t);
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

/* The targets that open the mouth, and the FF of existing targets. 0: nothing opens it. */
static int pose(mouth *h)
{
    const model_mesh *mesh = h->mesh;
    const size_t bytes = (size_t)mesh->vertex_count * 3 * sizeof(float);
    const char *names[NOH_TARGETS_MAX];
    noh_face_link links[LINKS_MAX];
    const uint32_t targets = mesh->target_count < NOH_TARGETS_MAX ? mesh->target_count : NOH_TARGETS_MAX;
    uint32_t count;
    for (uint32_t t = 0; t < targets; t++) names[t] = mesh->targets[t].name;
    count = noh_face_recipe_bind(NULL, 0, names, targets, links, LINKS_MAX);
    count = count < LINKS_MAX ? count : LINKS_MAX;
    memcpy(h->bite, mesh->position, bytes);
    if (!add_channel(mesh, links, count, NOH_CHANNEL_VISEMES + NOH_VISEME_AA, h->bite)) return 0;
    h->most = 0.0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        double rest[3], open[3];
        point(mesh->position, v, rest);
        point(h->bite, v, open);
        h->moved[v] = (float)distance(rest, open);
        if ((double)h->moved[v] > h->most) h->most = (double)h->moved[v], h->skin = v;
    }
    islands_find(mesh, h->island, h->work);
    h->skin = h->island[h->skin];
    memcpy(h->bite, mesh->position, bytes);
    (void)add_channel(mesh, links, count, NOH_CHANNEL_VISEMES + NOH_VISEME_FF, h->bite);
    return h->most > 0.0;
}

/* ---- lips ---- */

static int goes_along(const mouth *h, uint32_t v)
{
    return h->island[v] == h->skin && (double)h->moved[v] > 0.5 * h->most;
}

static int stays(const mouth *h, uint32_t v)
{
    return h->island[v] == h->skin && (double)h->moved[v] < 0.25 * h->most;
}

static const float *sorted_by;

static int by_x(const void *a, const void *b)
{
    const float x = sorted_by[3 * (size_t) * (const uint32_t *)a], y = sorted_by[3 * (size_t) * (const uint32_t *)b];
    return (x > y) - (x < y);
}

/* The first of a sorted list at x or beyond. */
static uint32_t first_at(const mouth *h, uint32_t count, double x)
{
    uint32_t low = 0, high = count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2u;
        if ((double)h->mesh->position[3 * (size_t)h->work[middle]] < x) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

static void find_rim(mouth *h, double touch)
{
    uint32_t uppers = 0;
    h->rim_count = 0;
    for (uint32_t v = 0; v < h->mesh->vertex_count; v++) {
        if (stays(h, v)) h->work[uppers++] = v;
    }
    sorted_by = h->mesh->position;
    qsort(h->work, uppers, sizeof *h->work, by_x);
    for (uint32_t v = 0; v < h->mesh->vertex_count && h->rim_count < RIM_MAX; v++) {
        const double x = (double)h->mesh->position[3 * (size_t)v];
        if (!goes_along(h, v)) continue;
        for (uint32_t u = first_at(h, uppers, x - touch); u < uppers; u++) {
            if ((double)h->mesh->position[3 * (size_t)h->work[u]] > x + touch) break;
            if (between(h, v, h->work[u]) > touch) continue;
            h->rim[h->rim_count++] = v;
            break;
        }
    }
}

/* The line from corner to corner. */
static void measure_rim(mouth *h)
{
    uint32_t ends[2] = { 0, 0 };
    for (uint32_t a = 0; a < h->rim_count; a++) {
        for (uint32_t b = a + 1; b < h->rim_count; b++) {
            if (between(h, h->rim[a], h->rim[b]) > between(h, h->rim[ends[0]], h->rim[ends[1]]))
                ends[0] = a, ends[1] = b;
        }
    }
    h->half = 0.5 * between(h, h->rim[ends[0]], h->rim[ends[1]]);
    for (int i = 0; i < 3; i++) {
        const double a = (double)h->mesh->position[3 * (size_t)h->rim[ends[0]] + (size_t)i],
                     b = (double)h->mesh->position[3 * (size_t)h->rim[ends[1]] + (size_t)i];
        h->centre[i] = 0.5 * (a + b);
        h->along[i] = h->half > 0.0 ? 0.5 * (b - a) / h->half : 0.0;
    }
}

/* 0 at the middle, 1 at a corner. */
static double aside(const mouth *h, const double at[3])
{
    double along = 0.0;
    for (int i = 0; i < 3; i++) along += (at[i] - h->centre[i]) * h->along[i];
    return fabs(along) / h->half;
}

/* Lips that touch in the middle, or lips of a mouth that is modelled a little open. 1: found. */
static int find_lips(mouth *h)
{
    h->size = h->most;
    double touch = TOUCH;
    for (int widened = 0; widened < WIDENED_MAX; widened++, touch *= 1.5) {
        find_rim(h, touch * h->size);
        if (h->rim_count < RIM_MIN) continue;
        measure_rim(h);
        if (1.4 * h->half > h->size) h->size = 1.4 * h->half;
        for (uint32_t r = 0; r < h->rim_count && h->half > TOUCH * h->size; r++) {
            double at[3];
            point(h->mesh->position, h->rim[r], at);
            if (aside(h, at) < 0.2) return 1;
        }
    }
    return 0;
}

/* ---- teeth ---- */

static int is_tooth(const mouth *h, uint32_t v)
{
    double at[3];
    if (h->island[v] == h->skin || (double)h->moved[v] > STILL * h->most) return 0;
    point(h->mesh->position, v, at);
    return distance(at, h->centre) < h->half + REACH * h->size;
}

static int find_teeth(mouth *h)
{
    const model_mesh *mesh = h->mesh;
    h->teeth = malloc((mesh->index_count / 3u + 1u) * sizeof *h->teeth);
    h->tooth_count = 0;
    if (!h->teeth) return 1;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        const uint32_t *corner = &mesh->indices[i];
        if (!is_tooth(h, corner[0]) || !is_tooth(h, corner[1]) || !is_tooth(h, corner[2])) continue;
        for (int k = 0; k < 3; k++) point(mesh->position, corner[k], h->teeth[h->tooth_count].at[k]);
        h->tooth_count++;
    }
    return 0;
}

static void mix(const double a[3], const double b[3], double t, double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = a[i] + (b[i] - a[i]) * t;
}

/* The nearest point of a segment. */
static void on_edge(const double a[3], const double b[3], const double p[3], double out[3])
{
    double dot = 0.0, square = 0.0;
    for (int i = 0; i < 3; i++) {
        dot += (p[i] - a[i]) * (b[i] - a[i]);
        square += (b[i] - a[i]) * (b[i] - a[i]);
    }
    dot = square > 0.0 ? dot / square : 0.0;
    mix(a, b, dot < 0.0 ? 0.0 : dot > 1.0 ? 1.0 : dot, out);
}

/* The foot of the perpendicular in barycentric coordinates. 0: it is outside. */
static int on_face(const triangle *t, const double p[3], double out[3])
{
    double u[3], v[3], w[3], uu = 0.0, uv = 0.0, vv = 0.0, wu = 0.0, wv = 0.0, det, a, b;
    for (int i = 0; i < 3; i++) {
        u[i] = t->at[1][i] - t->at[0][i];
        v[i] = t->at[2][i] - t->at[0][i];
        w[i] = p[i] - t->at[0][i];
        uu += u[i] * u[i];
        uv += u[i] * v[i];
        vv += v[i] * v[i];
        wu += w[i] * u[i];
        wv += w[i] * v[i];
    }
    det = uu * vv - uv * uv;
    if (!(det > 1e-12 * uu * vv)) return 0;
    a = (wu * vv - wv * uv) / det;
    b = (wv * uu - wu * uv) / det;
    for (int i = 0; i < 3; i++) out[i] = t->at[0][i] + a * u[i] + b * v[i];
    return a >= 0.0 && b >= 0.0 && a + b <= 1.0;
}

static double nearest_tooth(const mouth *h, const double p[3], double out[3])
{
    double best = HUGE_VAL;
    memcpy(out, p, 3 * sizeof *out);
    for (uint32_t t = 0; t < h->tooth_count; t++) {
        double at[4][3];
        const int inside = on_face(&h->teeth[t], p, at[3]);
        for (int e = 0; e < 3; e++) on_edge(h->teeth[t].at[e], h->teeth[t].at[(e + 1) % 3], p, at[e]);
        for (int k = 0; k < 3 + inside; k++) {
            const double d = distance(at[k], p);
            if (d < best) best = d, memcpy(out, at[k], 3 * sizeof *out);
        }
    }
    return best;
}

/* ---- the way ---- */

/* The rim as the inner line of the lip: of what lies one behind the other only that which is nearest to the teeth leads
 * the skin. */
static void lead(mouth *h)
{
    double far[RIM_MAX], at[RIM_MAX][3];
    uint32_t count = 0;
    h->before = HUGE_VAL;
    for (uint32_t r = 0; r < h->rim_count; r++) {
        double q[3], rest[3];
        point(h->mesh->position, h->rim[r], rest);
        point(h->bite, h->rim[r], at[r]);
        far[r] = nearest_tooth(h, at[r], q);
        for (int i = 0; i < 3; i++) h->ways[r][i] = q[i] - at[r][i];
        if (aside(h, rest) < 0.3 && far[r] < h->before) h->before = far[r];
    }
    for (uint32_t r = 0; r < h->rim_count; r++) {
        double rest[3], clear, by;
        int leads = 1;
        for (uint32_t o = 0; o < h->rim_count && leads; o++) {
            leads = !(between(h, h->rim[r], h->rim[o]) < 2.0 * TOUCH * h->size && far[o] < far[r] - 0.01 * h->size);
        }
        if (!leads) continue;
        point(h->mesh->position, h->rim[r], rest);
        clear = CLEARANCE * h->size;
        by = far[r] > clear ? (1.0 - clear / far[r]) * (1.0 - smooth(0.3, 0.9, aside(h, rest))) : 0.0;
        h->rim[count] = h->rim[r];
        for (int i = 0; i < 3; i++) h->ways[count][i] = h->ways[r][i] * by;
        count++;
    }
    h->rim_count = count;
}

/* The rim's displacement of a point of the skin. */
static void follow(const mouth *h, uint32_t v, float out[3])
{
    const double blur = 0.003 * h->size;
    double way[3] = { 0.0 }, sum = 0.0, least = HUGE_VAL, share;
    for (uint32_t r = 0; r < h->rim_count; r++) {
        const double d = between(h, v, h->rim[r]), k = 1.0 / (d * d + blur * blur);
        least = d < least ? d : least;
        sum += k * k;
        for (int i = 0; i < 3; i++) way[i] += k * k * h->ways[r][i];
    }
    share = exp(-pow(least / (AROUND * h->size), 2.0)) * smooth(0.2, 0.6, (double)h->moved[v] / h->most);
    for (int i = 0; i < 3; i++) out[i] = share > 0.01 ? (float)(share * way[i] / sum) : 0.0f;
}

static int append(model *m, uint32_t index, const mouth *h, model_error *error)
{
    model_mesh *mesh = &m->meshes[index], from;
    model_target target;
    memset(&target, 0, sizeof target);
    memset(&from, 0, sizeof from);
    target.name = model_string(LIP_TARGET);
    target.position = model_zeros(mesh->vertex_count, 3 * sizeof *target.position);
    target.has_position = 1;
    from.targets = &target;
    from.target_count = 1;
    for (uint32_t v = 0; target.position && v < mesh->vertex_count; v++) {
        if (h->island[v] == h->skin) follow(h, v, target.position + 3 * (size_t)v);
    }
    if (!target.name || !target.position || model_append_targets(m, index, &from)) {
        if (from.target_count) { /* the model does not own it yet */
            free(target.name);
            free(target.position);
        }
        return model_fail(error, mesh->name, "out of memory");
    }
    return model_complete(m, error);
}

/* ---- all of it ---- */

/* The reason why a mesh gets no such target; NULL: it has lips and teeth. */
static const char *look(mouth *h)
{
    for (uint32_t t = 0; t < h->mesh->target_count; t++) {
        if (strcmp(h->mesh->targets[t].name, LIP_TARGET) == 0) return "it already has this target";
    }
    if (h->mesh->target_count >= NOH_TARGETS_MAX) return "it already has the largest number of targets";
    if (!pose(h)) return "it has no target that opens the mouth";
    if (!find_lips(h)) return "its lips were not found, or are too far apart at rest";
    if (find_teeth(h)) return "there is not enough memory";
    return h->tooth_count ? NULL : "it has no teeth behind the lips that stay in place while the mouth opens";
}

static int try_mesh(model *m, uint32_t index, FILE *report, const char **why, model_error *error)
{
    mouth *h = calloc(1, sizeof *h);
    const size_t count = m->meshes[index].vertex_count;
    int failed = !h;
    if (h) {
        h->mesh = &m->meshes[index];
        h->island = model_zeros(count, sizeof *h->island);
        h->work = model_zeros(count, sizeof *h->work);
        h->moved = model_zeros(count, sizeof *h->moved);
        h->bite = model_zeros(count, 3 * sizeof *h->bite);
        failed = !h->island || !h->work || !h->moved || !h->bite;
    }
    if (failed) {
        (void)model_fail(error, m->meshes[index].name, "out of memory");
    } else if (!(*why = look(h))) {
        lead(h);
        if (report) {
            fprintf(report, "mesh '%s': %s brings the lower lip to %u triangles of teeth, %.4f off at f and v before\n",
                    m->meshes[index].name, LIP_TARGET, h->tooth_count, h->before);
        }
        failed = append(m, index, h, error);
    }
    if (h) {
        free(h->island);
        free(h->work);
        free(h->moved);
        free(h->bite);
        free(h->teeth);
    }
    free(h);
    return failed;
}

int lip_target_add(model *m, FILE *report, char why[LIP_WHY_BYTES], model_error *error)
{
    const char *reason = "no mesh has targets";
    const char *name = "";
    for (uint32_t i = 0; i < m->mesh_count && reason; i++) {
        if (!m->meshes[i].target_count) continue;
        name = m->meshes[i].name;
        if (try_mesh(m, i, report, &reason, error)) return 1;
    }
    why[0] = '\0';
    if (reason) (void)snprintf(why, LIP_WHY_BYTES, "mesh '%.120s': %s", name, reason);
    return 0;
}
