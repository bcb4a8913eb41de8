#include "surface_shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/islands.h"
#include "convert/model/mesh_place.h"
#include "convert/model/model_build.h"
#include "convert/model/mouth_shape.h"
#include "convert/skin/eye_split.h"
#include "noh/format.h"

#define RINGS 40 /* of directions about an axis, by the sine of their angle to it */
#define RING_WIDTH 0.02
#define GRID 8      /* points along a triangle's edge at which its colour is taken */
#define IRIS_MIN 10 /* rings: the narrowest iris, and the widest */
#define IRIS_MAX 36
#define IRIS_STEP 6      /* rings on either side of the rim that are compared */
#define GLINT_WHITE 0.55 /* luminance of a painted highlight, at least, and GLINT_DARK of the iris around it, at most */
#define GLINT_DARK 0.3
#define GLINT_LEAST 0.006 /* shares of the iris, within GLINT_RIM of its radius */
#define GLINT_MOST 0.25
#define GLINT_RIM 0.85
#define LID_COLUMNS 11 /* about where the eye looks, from one corner to the other */
#define LID_REACH 0.75 /* radii to the outermost */
#define LID_ROWS 128   /* from one radius below to one above */
#define BULGE 0.985    /* of the cosine between a normal and the ball's: less is a cornea */

typedef struct eye_ball {
    const model *m;
    const model_mesh *mesh;
    const uint32_t *island;
    uint32_t material, first; /* its island */
    eye_sphere sphere;
    double ahead[3], above[3];     /* unit: the world's z and y */
    double scale;                  /* by joints, whose stretches shaders do not know; 1 without joints */
    double gaze[3], out[3], up[3]; /* unit, at right angles; out: from the nose */
    double iris;                   /* sine of the angle from gaze to the rim */
    double lids[6];                /* as in noh_material; zeros: not found */
} eye_ball;

/* ---- colours on a ball ---- */

static double texel_luma(const model_texture *t, double u, double v)
{
    const double wide = u - floor(u), high = v - floor(v);
    uint32_t x = (uint32_t)(wide * t->width), y = (uint32_t)(high * t->height);
    const uint8_t *p;
    x = x < t->width ? x : t->width - 1u;
    y = y < t->height ? y : t->height - 1u;
    p = t->rgba + 4 * ((size_t)y * t->width + x);
    return (0.2126 * p[0] * p[0] + 0.7152 * p[1] * p[1] + 0.0722 * p[2] * p[2]) / 65025.0; /* about linear */
}

static void mixed(const float *values, const uint32_t corner[3], const double weight[3], int width, double *out)
{
    for (int c = 0; c < width; c++) {
        out[c] = 0.0;
        for (int k = 0; k < 3; k++) out[c] += weight[k] * (double)values[(size_t)width * corner[k] + (size_t)c];
    }
}

/* About the linear luminance of the surface at a point of a triangle. */
static double luma_at(const eye_ball *b, const uint32_t corner[3], const double weight[3])
{
    const uint32_t texture = b->m->materials[b->material].base_color_texture;
    double luma = 1.0, color[4], uv[2];
    if (b->mesh->color) {
        mixed(b->mesh->color, corner, weight, 4, color);
        luma = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
    }
    if (b->mesh->uv && texture != MODEL_NONE) {
        mixed(b->mesh->uv, corner, weight, 2, uv);
        luma *= texel_luma(&b->m->textures[texture], uv[0], uv[1]);
    }
    return luma;
}

typedef void visit_point(const double direction[3], double luma, double area, void *user);

static double area_of(const model_mesh *mesh, const uint32_t corner[3])
{
    double a[3], b[3], normal[3];
    for (int c = 0; c < 3; c++) {
        const double at = (double)mesh->position[3 * (size_t)corner[0] + (size_t)c];
        a[c] = (double)mesh->position[3 * (size_t)corner[1] + (size_t)c] - at;
        b[c] = (double)mesh->position[3 * (size_t)corner[2] + (size_t)c] - at;
    }
    vec_cross(a, b, normal);
    return sqrt(vec_dot(normal, normal));
}

static void visit_triangle(const eye_ball *b, const uint32_t corner[3], visit_point *visit, void *user)
{
    const double area = area_of(b->mesh, corner);
    for (int i = 0; i < GRID; i++) {
        for (int j = 0; i + j < GRID; j++) {
            const double u = (i + 1.0 / 3.0) / GRID, v = (j + 1.0 / 3.0) / GRID, weight[3] = { 1.0 - u - v, u, v };
            double at[3];
            mixed(b->mesh->position, corner, weight, 3, at);
            for (int c = 0; c < 3; c++) at[c] -= b->sphere.centre[c];
            if (vec_normalize(at)) visit(at, luma_at(b, corner, weight), area, user);
        }
    }
}

static void visit_ball(const eye_ball *b, visit_point *visit, void *user)
{
    for (uint32_t s = 0; s < b->mesh->submesh_count; s++) {
        const model_submesh *part = &b->mesh->submeshes[s];
        for (uint32_t i = 0; part->material == b->material && i + 2 < part->index_count; i += 3) {
            const uint32_t *corner = b->mesh->indices + part->first_index + i;
            if (b->island[corner[0]] == b->first) visit_triangle(b, corner, visit, user);
        }
    }
}

/* ---- the iris ---- */

/* The dark texels near an axis. */
typedef struct dark_spot {
    double axis[3], within;      /* cosine */
    double luma, area;           /* sums */
    double limit, sum[3], found; /* of the texels below the limit */
} dark_spot;

static void add_luma(const double direction[3], double luma, double area, void *user)
{
    dark_spot *s = user;
    if (vec_dot(direction, s->axis) < s->within) return;
    s->luma += area * luma;
    s->area += area;
}

static void add_dark(const double direction[3], double luma, double area, void *user)
{
    dark_spot *s = user;
    if (vec_dot(direction, s->axis) < s->within || luma >= s->limit) return;
    for (int c = 0; c < 3; c++) s->sum[c] += area * (s->limit - luma) * direction[c];
    s->found += area * (s->limit - luma);
}

/* The middle of the dark area, from where the face looks; 0: all has one brightness. */
static int find_axis(eye_ball *b)
{
    dark_spot s = { .within = 0.5 };
    memcpy(s.axis, b->ahead, sizeof s.axis);
    for (int pass = 0; pass < 4; pass++) {
        s.luma = s.area = s.found = s.sum[0] = s.sum[1] = s.sum[2] = 0.0;
        visit_ball(b, add_luma, &s);
        if (!(s.area > 0.0)) return 0;
        s.limit = 0.7 * s.luma / s.area;
        visit_ball(b, add_dark, &s);
        if (!(s.found > 0.0) || !vec_normalize(s.sum)) return 0;
        memcpy(s.axis, s.sum, sizeof s.axis);
        s.within = 0.7;
    }
    memcpy(b->gaze, s.axis, sizeof b->gaze);
    return vec_dot(s.axis, b->ahead) > 0.8;
}

typedef struct rings {
    const double *axis;
    double luma[RINGS], area[RINGS];
} rings;

static void add_ring(const double direction[3], double luma, double area, void *user)
{
    rings *r = user;
    const double along = vec_dot(direction, r->axis), square = 1.0 - along * along;
    const int ring = (int)(sqrt(square > 0.0 ? square : 0.0) / RING_WIDTH);
    if (along <= 0.0 || ring >= RINGS) return;
    r->luma[ring] += area * luma;
    r->area[ring] += area;
}

static double mean_of(const rings *r, int from, int to)
{
    double luma = 0.0, area = 0.0;
    for (int i = from; i < to; i++) {
        luma += r->luma[i];
        area += r->area[i];
    }
    return area > 0.0 ? luma / area : 0.0;
}

/* Where brightness rises the most; 0: nowhere by as much as an iris differs from the white. */
static int find_rim(eye_ball *b)
{
    rings r = { .axis = b->gaze };
    double most = 0.0;
    visit_ball(b, add_ring, &r);
    for (int i = IRIS_MIN; i < IRIS_MAX; i++) {
        const int end = i + IRIS_STEP < RINGS ? i + IRIS_STEP : RINGS;
        const double inside = mean_of(&r, i - IRIS_STEP, i), outside = mean_of(&r, i, end), rise = outside - inside;
        if (rise > most && rise > 0.25 * outside) {
            most = rise;
            b->iris = i * RING_WIDTH;
        }
    }
    return most > 0.0;
}

static int find_iris(eye_ball *b)
{
    if (!find_axis(b) || !find_rim(b)) return 0;
    memcpy(b->up, b->above, sizeof b->up);
    vec_reject(b->up, b->gaze);
    if (!vec_normalize(b->up)) return 0;
    vec_cross(b->up, b->gaze, b->out);
    for (int c = 0; c < 3; c++) b->out[c] = b->sphere.centre[0] < 0.0 ? -b->out[c] : b->out[c];
    return 1;
}

/* ---- painted highlights ---- */

typedef struct glint {
    const double *axis;
    double within;            /* cosine */
    double white, rest, luma; /* areas; of the rest, a sum */
} glint;

static void add_glint(const double direction[3], double luma, double area, void *user)
{
    glint *g = user;
    if (vec_dot(direction, g->axis) < g->within) return;
    g->white += luma > GLINT_WHITE ? area : 0.0;
    g->rest += luma > GLINT_WHITE ? 0.0 : area;
    g->luma += luma > GLINT_WHITE ? 0.0 : area * luma;
}

/* A small white spot on a dark iris. */
static int has_glint(const eye_ball *b)
{
    const double edge = GLINT_RIM * b->iris;
    glint g = { .axis = b->gaze, .within = sqrt(1.0 - edge * edge) };
    visit_ball(b, add_glint, &g);
    const double area = g.white + g.rest;
    return g.white > GLINT_LEAST * area && g.white < GLINT_MOST * area && g.luma < GLINT_DARK * g.rest;
}

/* ---- the lids ---- */

typedef struct lid_edges {
    float low[LID_COLUMNS][LID_ROWS], high[LID_COLUMNS][LID_ROWS]; /* the range in a row; low above high: empty */
} lid_edges;

static void add_lid(const eye_ball *b, const double at[3], lid_edges *lids)
{
    double d[3], length, a, e;
    int column, row;
    for (int c = 0; c < 3; c++) d[c] = at[c] - b->sphere.centre[c];
    for (int c = 0; c < 3; c++) d[c] /= b->sphere.radius;
    length = sqrt(vec_dot(d, d));
    a = vec_dot(d, b->out);
    e = vec_dot(d, b->up);
    if (length < 0.95 || length > 1.35 || vec_dot(d, b->gaze) < 0.2 || fabs(a) >= LID_REACH) return;
    column = (int)((a / LID_REACH + 1.0) * 0.5 * LID_COLUMNS);
    row = (int)((e + 1.0) * 0.5 * LID_ROWS);
    if (row < 0 || row >= LID_ROWS) return;
    if ((float)e < lids->low[column][row]) lids->low[column][row] = (float)e;
    if ((float)e > lids->high[column][row]) lids->high[column][row] = (float)e;
}

/* The widest gap of a column is where the eye is open; 0: nothing is above it, or below. */
static int find_gap(const lid_edges *lids, int column, double *lower, double *upper)
{
    float below = -2.0f, widest = 0.0f;
    for (int row = 0; row < LID_ROWS; row++) {
        const float low = lids->low[column][row], high = lids->high[column][row];
        if (low > high) continue;
        if (below > -2.0f && low - below > widest) {
            widest = low - below;
            *lower = (double)below;
            *upper = (double)low;
        }
        below = high;
    }
    return widest > 0.1f;
}

static void add_lid_edge(const eye_ball *b, uint32_t from, uint32_t to, lid_edges *lids)
{
    for (int i = 0; i < GRID; i++) {
        const double t = (double)i / GRID;
        double at[3];
        for (size_t c = 0; c < 3; c++) {
            at[c] = (1.0 - t) * (double)b->mesh->position[3 * (size_t)from + c] +
                    t * (double)b->mesh->position[3 * (size_t)to + c];
        }
        add_lid(b, at, lids);
    }
}

static int is_opaque_lid(const model *m, const model_submesh *part)
{
    const model_material *material = part->material == MODEL_NONE ? NULL : &m->materials[part->material];
    return !material || (material->alpha == MODEL_ALPHA_OPAQUE && material->surface != NOH_SURFACE_EYE &&
                         material->surface != NOH_SURFACE_TEETH);
}

/* edge(a) = out[0] + out[1] a + out[2] a^2, by least squares over the columns where there is one. */
static int fit_edge(const double edge[LID_COLUMNS], const int open[LID_COLUMNS], double out[3])
{
    double sums[5] = { 0.0 }, right[3] = { 0.0 }, row[3][3], det;
    for (int i = 0; i < LID_COLUMNS; i++) {
        const double a = ((i + 0.5) / LID_COLUMNS * 2.0 - 1.0) * LID_REACH;
        double power = 1.0;
        if (!open[i]) continue;
        for (int k = 0; k < 5; k++) {
            sums[k] += power;
            if (k < 3) right[k] += power * edge[i];
            power *= a;
        }
    }
    vec_cross((double[3]){ sums[1], sums[2], sums[3] }, (double[3]){ sums[2], sums[3], sums[4] }, row[0]);
    vec_cross((double[3]){ sums[2], sums[3], sums[4] }, sums, row[1]);
    vec_cross(sums, (double[3]){ sums[1], sums[2], sums[3] }, row[2]);
    det = vec_dot(sums, row[0]);
    if (sums[0] < 6.0 || fabs(det) < 1e-9) return 0;
    for (int k = 0; k < 3; k++) {
        out[k] = (row[0][k] * right[0] + row[1][k] * right[1] + row[2][k] * right[2]) / det;
    }
    return fabs(out[0]) < 0.95;
}

static void find_lids(eye_ball *b)
{
    lid_edges lids;
    double fit[6], lower[LID_COLUMNS], upper[LID_COLUMNS];
    int open[LID_COLUMNS];
    for (int i = 0; i < LID_COLUMNS * LID_ROWS; i++) {
        lids.low[i / LID_ROWS][i % LID_ROWS] = 2.0f;
        lids.high[i / LID_ROWS][i % LID_ROWS] = -2.0f;
    }
    for (uint32_t s = 0; s < b->mesh->submesh_count; s++) {
        const model_submesh *part = &b->mesh->submeshes[s];
        for (uint32_t i = 0; is_opaque_lid(b->m, part) && i + 2 < part->index_count; i += 3) {
            const uint32_t *corner = b->mesh->indices + part->first_index + i;
            for (int k = 0; k < 3; k++) add_lid_edge(b, corner[k], corner[(k + 1) % 3], &lids);
        }
    }
    for (int i = 0; i < LID_COLUMNS; i++) open[i] = find_gap(&lids, i, &lower[i], &upper[i]);
    if (fit_edge(upper, open, fit) && fit_edge(lower, open, fit + 3) && fit[0] > fit[3]) {
        memcpy(b->lids, fit, sizeof b->lids);
    }
}

/* ---- eyes ---- */

/* Sums over the eyes of a material. */
typedef struct eye_mean {
    uint32_t count, with_lids, with_glint;
    double gaze[3], iris, radius, lids[6];
} eye_mean;

static void add_eye(const eye_ball *b, eye_mean *mean)
{
    mean->count++;
    mean->with_glint += has_glint(b) != 0;
    mean->iris += b->iris;
    mean->radius += b->iris * b->sphere.radius * b->scale;
    for (int c = 0; c < 3; c++) mean->gaze[c] += b->gaze[c];
    if (b->lids[0] == 0.0) return;
    mean->with_lids++;
    for (int c = 0; c < 6; c++) mean->lids[c] += b->lids[c];
}

/* Nodes may turn the mesh: the first that draws it counts. 0: it is flat. */
static int find_ways(eye_ball *b)
{
    double places[MESH_PLACES_MAX][16];
    (void)mesh_places(b->m, (uint32_t)(b->mesh - b->m->meshes), b->first, places);
    for (int c = 0; c < 3; c++) {
        b->above[c] = places[0][4 * c + 1];
        b->ahead[c] = places[0][4 * c + 2];
    }
    b->scale = b->mesh->joints ? sqrt(vec_dot(b->ahead, b->ahead)) : 1.0;
    return vec_normalize(b->above) && vec_normalize(b->ahead);
}

/* The direction of a vertex from the ball's centre. 0: it is not in front. */
static int in_front(const eye_ball *b, uint32_t v, double way[3])
{
    for (size_t c = 0; c < 3; c++) way[c] = (double)b->mesh->position[3 * (size_t)v + c] - b->sphere.centre[c];
    return vec_normalize(way) && vec_dot(way, b->gaze) > 0.5;
}

/* Shaders bend a ball's normals into a cornea's: over a bulge of the mesh's own they would mirror a lamp twice. */
static void level_bulge(const eye_ball *b, float *normal, const uint32_t *vertices, uint32_t count)
{
    double way[3], least = 1.0;
    for (uint32_t i = 0; i < count; i++) {
        const float *n = normal + 3 * (size_t)vertices[i];
        if (!in_front(b, vertices[i], way)) continue;
        least = fmin(least, way[0] * (double)n[0] + way[1] * (double)n[1] + way[2] * (double)n[2]);
    }
    for (uint32_t i = 0; i < count && least > 0.0 && least < BULGE; i++) {
        if (!in_front(b, vertices[i], way)) continue;
        for (size_t c = 0; c < 3; c++) normal[3 * (size_t)vertices[i] + c] = (float)way[c];
    }
}

/* The islands that a part of the mesh is made of, each once. 0, or 1 when out of memory. */
static int add_eyes(const model *m, model_mesh *mesh, const model_submesh *part, const mesh_islands *islands,
                    eye_mean *mean)
{
    const uint32_t *island = islands->first;
    uint8_t *used = islands_part(mesh, part);
    for (uint32_t v = 0; used && v < mesh->vertex_count; v++) {
        eye_ball b = { .m = m, .mesh = mesh, .island = island, .material = part->material, .first = island[v] };
        uint32_t count;
        if (!used[v] || island[v] != v) continue;
        count = islands_list(islands->next, v, mesh->vertex_count, islands->room);
        if (eye_ball_fit(mesh->position, islands->room, count, &b.sphere) || !find_ways(&b) || !find_iris(&b)) continue;
        /* for shaders y is up, or z if the gaze is along y, and the sign of a vertex's x is its side of the nose */
        if (b.above[fabs(b.gaze[1]) > 0.7 ? 2 : 1] > 0.8 && fabs(b.sphere.centre[0]) > b.sphere.radius) find_lids(&b);
        level_bulge(&b, mesh->normal, islands->room, count);
        add_eye(&b, mean);
    }
    free(used);
    return !used;
}

static float rounded(double x)
{
    return (float)(floor(x * 4096.0 + 0.5) / 4096.0);
}

static void set_eye(model_material *material, eye_mean *mean, FILE *report)
{
    /* the radius may be of any unit: it is rounded as a share of itself, by the gaze's own rounding */
    if (!mean->count || !vec_normalize(mean->gaze)) return;
    for (int c = 0; c < 3; c++) {
        material->surface_values[c] = rounded(mean->gaze[c]) * (float)(mean->radius / mean->count);
    }
    material->surface_values[3] = rounded(mean->iris / mean->count);
    for (int c = 0; c < 6 && mean->with_lids; c++) material->surface_more[c] = rounded(mean->lids[c] / mean->with_lids);
    if (report) {
        fprintf(report, "material '%s': %u eye%s, an iris of radius %.4f%s\n", material->name, mean->count,
                mean->count == 1 ? "" : "s", mean->radius / mean->count, mean->with_lids ? ", lids" : "");
    }
}

/* With a highlight of their own eyes have no second one, of a lamp or a window: they mirror nothing. 0, or 1 when out of
 * memory. */
static int dull_eye(model *m, model_material *material, const eye_mean *mean)
{
    if (2u * mean->with_glint <= mean->count || material->surface_given) return 0;
    for (int c = 0; c < 3; c++) material->f0[c] = 0.0f;
    material->f90_loss = 1.0f;
    return model_warn(m,
                      "material '%s': a highlight is painted on its eyes, so they mirror no light; to keep that, use "
                      "--surface '%s=eye'",
                      material->name, material->name);
}

static int find_eyes(model *m, uint32_t material, int keep_looks, FILE *report)
{
    eye_mean mean = { 0 };
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        model_mesh *mesh = &m->meshes[i];
        mesh_islands islands;
        int failed = islands_open(mesh, &islands);
        for (uint32_t s = 0; s < mesh->submesh_count && !failed; s++) {
            failed = mesh->submeshes[s].material == material && add_eyes(m, mesh, &mesh->submeshes[s], &islands, &mean);
        }
        islands_close(&islands);
        if (failed) return 1;
    }
    set_eye(&m->materials[material], &mean, report);
    return keep_looks ? 0 : dull_eye(m, &m->materials[material], &mean);
}

int surface_shapes_find(model *m, int keep_looks, FILE *report, model_error *error)
{
    for (uint32_t i = 0; i < m->material_count; i++) {
        model_material *material = &m->materials[i];
        if (material->surface == NOH_SURFACE_EYE && find_eyes(m, i, keep_looks, report)) {
            return model_fail(error, material->name, "out of memory");
        }
    }
    return mouth_shape_find(m) ? model_fail_memory(error) : 0;
}
