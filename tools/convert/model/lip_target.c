#include "lip_target.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noh/base.h"
#include "convert/model/lip_rim.h"
#include "convert/model/model_build.h"
#include "convert/model/target_append.h"

/* Shares of the size of the mouth: about 35 mm for a person. */
#define REACH 0.6       /* teeth are no further from the lips */
#define STILL 0.02      /* of how far the chin moves: teeth that stay move no more */
#define CLEARANCE 0.008 /* left between lip and teeth */
#define AROUND 0.28     /* how far the skin around the rim goes along */

typedef struct triangle {
    double at[3][3];
} triangle;

typedef struct mouth {
    lip_rim lips;
    double ways[LIP_RIM_MAX][3]; /* from a point of the rim towards the teeth */
    triangle *teeth;
    uint32_t tooth_count;
    double before; /* from the middle of the rim to the teeth, at the least; HUGE_VAL: it has no middle */
} mouth;

static double smooth(double from, double to, double x)
{
    const double t = x <= from ? 0.0 : x >= to ? 1.0 : (x - from) / (to - from);
    return t * t * (3.0 - 2.0 * t);
}

/* ---- teeth ---- */

static int is_tooth(const mouth *h, uint32_t v)
{
    double at[3];
    if (h->lips.island[v] == h->lips.skin || (double)h->lips.moved[v] > STILL * h->lips.most) return 0;
    vec_posed(h->lips.mesh->position, NULL, v, at);
    return vec_distance(at, h->lips.centre) < h->lips.half + REACH * h->lips.size;
}

static int find_teeth(mouth *h)
{
    const model_mesh *mesh = h->lips.mesh;
    h->teeth = malloc((mesh->index_count / 3u + 1u) * sizeof *h->teeth);
    h->tooth_count = 0;
    if (!h->teeth) return 1;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        const uint32_t *corner = &mesh->indices[i];
        if (!is_tooth(h, corner[0]) || !is_tooth(h, corner[1]) || !is_tooth(h, corner[2])) continue;
        for (int k = 0; k < 3; k++) vec_posed(mesh->position, NULL, corner[k], h->teeth[h->tooth_count].at[k]);
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
            const double d = vec_distance(at[k], p);
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
    double far[LIP_RIM_MAX], at[LIP_RIM_MAX][3];
    uint32_t count = 0;
    h->before = HUGE_VAL;
    for (uint32_t r = 0; r < h->lips.rim_count; r++) {
        double q[3], rest[3];
        vec_posed(h->lips.mesh->position, NULL, h->lips.rim[r], rest);
        vec_posed(h->lips.bite, NULL, h->lips.rim[r], at[r]);
        far[r] = nearest_tooth(h, at[r], q);
        for (int i = 0; i < 3; i++) h->ways[r][i] = q[i] - at[r][i];
        if (lip_aside(&h->lips, rest) < 0.3 && far[r] < h->before) h->before = far[r];
    }
    for (uint32_t r = 0; r < h->lips.rim_count; r++) {
        double rest[3], clear, by;
        int leads = 1;
        for (uint32_t o = 0; o < h->lips.rim_count && leads; o++) {
            leads = !(lip_between(&h->lips, h->lips.rim[r], h->lips.rim[o]) < 2.0 * LIP_TOUCH * h->lips.size &&
                      far[o] < far[r] - 0.01 * h->lips.size);
        }
        if (!leads) continue;
        vec_posed(h->lips.mesh->position, NULL, h->lips.rim[r], rest);
        clear = CLEARANCE * h->lips.size;
        by = far[r] > clear ? (1.0 - clear / far[r]) * (1.0 - smooth(0.3, 0.9, lip_aside(&h->lips, rest))) : 0.0;
        h->lips.rim[count] = h->lips.rim[r];
        for (int i = 0; i < 3; i++) h->ways[count][i] = h->ways[r][i] * by;
        count++;
    }
    h->lips.rim_count = count;
}

/* The rim's displacement of a point of the skin. */
static void follow(const mouth *h, uint32_t v, float out[3])
{
    const double blur = 0.003 * h->lips.size;
    double way[3] = { 0.0 }, sum = 0.0, least = HUGE_VAL, share;
    for (uint32_t r = 0; r < h->lips.rim_count; r++) {
        const double d = lip_between(&h->lips, v, h->lips.rim[r]), k = 1.0 / (d * d + blur * blur);
        least = d < least ? d : least;
        sum += k * k;
        for (int i = 0; i < 3; i++) way[i] += k * k * h->ways[r][i];
    }
    share = exp(-pow(least / (AROUND * h->lips.size), 2.0)) * smooth(0.2, 0.6, (double)h->lips.moved[v] / h->lips.most);
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
        if (h->lips.island[v] == h->lips.skin) follow(h, v, target.position + 3 * (size_t)v);
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
static const char *has_no_room(const model_mesh *mesh)
{
    if (model_find_target(mesh, LIP_TARGET) != MODEL_NONE) return "it already has this target";
    return mesh->target_count < NOH_TARGETS_MAX ? NULL : "it already has the largest number of targets";
}

static int find_mouth(const model_mesh *mesh, mouth *h, const char **why)
{
    if ((*why = has_no_room(mesh))) return 0;
    if (lip_rim_find(mesh, &h->lips, why)) return 1;
    if (*why) return 0;
    if (find_teeth(h)) return 1;
    if (!h->tooth_count) *why = "it has no teeth behind the lips that stay in place while the mouth opens";
    return 0;
}

static int try_mesh(model *m, uint32_t index, FILE *report, const char **why, model_error *error)
{
    mouth *h = calloc(1, sizeof *h);
    int failed = !h || find_mouth(&m->meshes[index], h, why);
    if (failed) {
        (void)model_fail(error, m->meshes[index].name, "out of memory");
    } else if (!*why) {
        lead(h);
        if (report) {
            fprintf(report, "mesh '%s': %s brings the lower lip to %u triangles of teeth, %.4f off at f and v before\n",
                    m->meshes[index].name, LIP_TARGET, h->tooth_count, h->before);
        }
        failed = append(m, index, h, error);
    }
    if (h) {
        lip_rim_free(&h->lips);
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
