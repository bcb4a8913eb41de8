#include "eye_paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/affine.h"
#include "convert/model/islands.h"
#include "convert/model/mesh_place.h"
#include "convert/model/model_build.h"
#include "convert/model/surface_kind.h"
#include "convert/skin/eye_split.h"
#include "noh/format.h"

#define BALLS_MAX MESH_PLACES_MAX
#define TRIED_MAX 64u /* each is compared with all other eyes of the file */
#define PALE_MIN 0.3f /* the darkest channel of eyes that are painted, linear */
#define HUES 0.05f
#define SIDE 256u   /* texels */
#define REACH 1.5f  /* 1 - cosine of the angle to the gaze at the picture's border: 120 degrees */
#define IRIS 0.42f  /* radius, in radii of the ball: 5.2 mm of 12.4 */
#define PUPIL 0.36f /* of the iris */
#define WET 0.1f
#define GREY_HUE 0.02f
#define FLESH_MIN 0.2f /* of blue to red: less is orange */
#define SKIN_ROUGHNESS 0.5f
#define SAME_WAY 0.9   /* cosine of the angle between gazes of one mesh that several nodes draw */
#define IRIS_REACH 1.3 /* an iris of its own is within this reach of the ball's centre, in radii */
#define COVERED 0.97   /* a ball whose front is here, in radii, has no hole that shows what is inside */

/* Balls in the world's space. */
typedef struct balls {
    eye_sphere spheres[BALLS_MAX];
    uint32_t materials[BALLS_MAX];
    uint32_t count, tried; /* tried: also what has an iris */
} balls;

/* A ball of a plain eye's material, in the mesh's space. */
typedef struct ball {
    uint32_t mesh, material, count;
    uint32_t *vertices; /* [count] */
    eye_sphere sphere;
    double right[3], up[3], gaze[3]; /* unit; where the world's x, y and z are */
    double front;                    /* how far it reaches along the gaze, in radii */
} ball;

typedef void ball_visit(model *m, const ball *eye, balls *b);

/* 0: nodes turn the mesh differently, or make it flat. */
static int find_gaze(const model *m, ball *eye)
{
    double places[BALLS_MAX][16];
    const uint32_t count = mesh_places(m, eye->mesh, eye->vertices[0], places);
    for (uint32_t i = count; i-- > 0;) {
        double before[3];
        memcpy(before, eye->gaze, sizeof before);
        for (int c = 0; c < 3; c++) {
            eye->right[c] = places[i][4 * c];
            eye->gaze[c] = places[i][4 * c + 2];
        }
        if (!vec_normalize(eye->gaze) || (i + 1u < count && vec_dot(before, eye->gaze) < SAME_WAY)) return 0;
    }
    vec_reject(eye->right, eye->gaze);
    vec_cross(eye->gaze, eye->right, eye->up);
    return vec_normalize(eye->right) && vec_normalize(eye->up);
}

/* ---- which eyes ---- */

static int is_plain_material(const model_material *m)
{
    const float *c = m->base_color;
    return m->surface == NOH_SURFACE_EYE && m->alpha == MODEL_ALPHA_OPAQUE && m->base_color_texture == MODEL_NONE &&
           m->emissive_texture == MODEL_NONE && m->emissive[0] + m->emissive[1] + m->emissive[2] <= 0.0f &&
           fminf(c[0], fminf(c[1], c[2])) > PALE_MIN &&
           fmaxf(c[0], fmaxf(c[1], c[2])) - fminf(c[0], fminf(c[1], c[2])) < HUES;
}

/* Whether the part is of a plain eye's material, and its vertex colours are white. */
static int is_plain(const model *m, const model_mesh *mesh, const model_submesh *part)
{
    return part->material != MODEL_NONE && is_plain_material(&m->materials[part->material]) &&
           surface_is_white(mesh, part);
}

/* The vertices lie on a sphere, and on its front, too. */
static int is_ball(const model *m, ball *eye)
{
    const float *position = m->meshes[eye->mesh].position;
    if (eye_ball_fit(position, eye->vertices, eye->count, &eye->sphere) || !find_gaze(m, eye)) return 0;
    for (uint32_t i = 0; i < eye->count; i++) {
        double way[3];
        for (size_t c = 0; c < 3; c++) {
            way[c] = (double)position[3 * (size_t)eye->vertices[i] + c] - eye->sphere.centre[c];
        }
        eye->front = fmax(eye->front, vec_dot(way, eye->gaze) / eye->sphere.radius);
    }
    return eye->front > 0.8;
}

/* 0, or 1 when out of memory. */
static int visit_part(model *m, uint32_t mesh, const model_submesh *part, const mesh_islands *islands,
                      ball_visit *visit, balls *b)
{
    const uint32_t vertex_count = m->meshes[mesh].vertex_count;
    uint8_t *used = islands_part(&m->meshes[mesh], part);
    for (uint32_t v = 0; used && v < vertex_count; v++) {
        ball eye = { .mesh = mesh, .material = part->material, .vertices = islands->room };
        if (!used[v] || islands->first[v] != v) continue;
        for (uint32_t i = v; i < vertex_count; i = islands->next[i]) {
            if (used[i]) eye.vertices[eye.count++] = i;
        }
        if (is_ball(m, &eye)) visit(m, &eye, b);
    }
    free(used);
    return !used;
}

static int visit_balls(model *m, ball_visit *visit, balls *b)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        const model_mesh *mesh = &m->meshes[i];
        mesh_islands islands = { NULL, NULL, NULL };
        int failed = 0;
        for (uint32_t s = 0; s < mesh->submesh_count && !failed; s++) {
            if (!is_plain(m, mesh, &mesh->submeshes[s])) continue;
            failed = (!islands.first && islands_open(mesh, &islands)) ||
                     visit_part(m, i, &mesh->submeshes[s], &islands, visit, b);
        }
        islands_close(&islands);
        if (failed) return 1;
    }
    return 0;
}

/* Whether the mesh has a vertex of the part that is seen at the ball. */
static int is_seen(const model *m, uint32_t mesh, const model_submesh *part, const eye_sphere *sphere, double front)
{
    double places[BALLS_MAX][16];
    const uint32_t *corners = m->meshes[mesh].indices + part->first_index;
    const uint32_t count = part->index_count ? mesh_places(m, mesh, corners[0], places) : 0u;
    for (uint32_t i = 0; i < count * part->index_count; i++) {
        const float *p = m->meshes[mesh].position + 3 * (size_t)corners[i / count];
        const double at[3] = { (double)p[0], (double)p[1], (double)p[2] };
        double way[3];
        affine_point(places[i % count], at, way);
        for (int c = 0; c < 3; c++) way[c] -= sphere->centre[c];
        const double from = sqrt(vec_dot(way, way)) / sphere->radius;
        if (from < IRIS_REACH && (front < COVERED || from > fmax(front, 1.0))) return 1;
    }
    return 0;
}

/* Whether an opaque iris, pupil or cornea of another material is at the ball. */
static int has_iris(const model *m, uint32_t material, const eye_sphere *sphere, double front)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t s = 0; s < m->meshes[i].submesh_count; s++) {
            const model_submesh *part = &m->meshes[i].submeshes[s];
            const model_material *other = part->material == MODEL_NONE ? NULL : &m->materials[part->material];
            if (other && part->material != material && other->surface == NOH_SURFACE_EYE &&
                other->alpha == MODEL_ALPHA_OPAQUE && is_seen(m, i, part, sphere, front)) {
                return 1;
            }
        }
    }
    return 0;
}

static void collect(model *m, const ball *eye, balls *b)
{
    double places[BALLS_MAX][16];
    const uint32_t count = mesh_places(m, eye->mesh, eye->vertices[0], places);
    for (uint32_t i = 0; i < count && b->count < BALLS_MAX && b->tried++ < TRIED_MAX; i++) {
        eye_sphere at = eye->sphere;
        const double *w = places[i];
        affine_point(w, eye->sphere.centre, at.centre);
        at.radius *= sqrt(w[2] * w[2] + w[6] * w[6] + w[10] * w[10]);
        if (has_iris(m, eye->material, &at, eye->front)) continue;
        b->materials[b->count] = eye->material;
        b->spheres[b->count++] = at;
    }
}

/* ---- the picture ---- */

static float smooth(float from, float to, float x)
{
    const float t = fminf(fmaxf((x - from) / (to - from), 0.0f), 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* The cosine of n times the angle whose cosine is x, without libm, whose last bits differ between machines. */
static float cosine_of(uint32_t n, float x)
{
    float before = 1.0f, at = x;
    for (uint32_t i = 1; i < n; i++) {
        const float next = 2.0f * x * at - before;
        before = at;
        at = next;
    }
    return at;
}

static float fibres(float x, float y)
{
    return 0.4f * cosine_of(17, x) + 0.35f * cosine_of(29, 0.6f * x + 0.8f * y) +
           0.25f * cosine_of(53, 0.8f * x - 0.6f * y);
}

/* sRGB, at a place of the front as the gaze sees it, in radii of the iris; x, y: unit */
static void eye_color(float from_gaze, float x, float y, float out[3])
{
    static const float white[3] = { 236.0f, 231.0f, 227.0f }, edge[3] = { 38.0f, 30.0f, 26.0f };
    static const float outer[3] = { 92.0f, 66.0f, 43.0f }, inner[3] = { 138.0f, 97.0f, 55.0f };
    const float t = from_gaze, bright = 1.0f + 0.16f * fibres(x, y) * smooth(PUPIL, 0.6f, t);
    const float in_white = smooth(0.97f, 1.08f, t), in_edge = smooth(0.72f, 0.98f, t),
                in_outer = smooth(0.45f, 0.8f, t);
    const float lit = smooth(PUPIL - 0.03f, PUPIL + 0.04f, t) * (0.55f + 0.45f * smooth(PUPIL, 0.55f, t));
    for (int c = 0; c < 3; c++) {
        float value = (inner[c] + in_outer * (outer[c] - inner[c])) * bright;
        value += in_edge * (edge[c] - value);
        value = 8.0f + lit * (value - 8.0f);
        out[c] = value + in_white * (white[c] - value);
    }
}

static uint32_t add_picture(model *m)
{
    model_texture *grown = realloc(m->textures, (m->texture_count + 1u) * sizeof *grown), *t;
    if (!grown) return MODEL_NONE;
    m->textures = grown;
    t = &grown[m->texture_count];
    memset(t, 0, sizeof *t);
    t->name = model_string("painted eye");
    t->rgba = model_zeros((size_t)SIDE * SIDE, 4);
    t->width = t->height = SIDE;
    t->wrap_s = t->wrap_t = 33071;
    t->use = MODEL_TEXTURE_COLOR;
    for (uint32_t i = 0; t->rgba && i < SIDE * SIDE; i++) {
        const uint32_t column = i % SIDE, row = i / SIDE;
        const float x = ((float)column + 0.5f) * 2.0f / (float)SIDE - 1.0f;
        const float y = ((float)row + 0.5f) * 2.0f / (float)SIDE - 1.0f;
        const float square = x * x + y * y, radius = sqrtf(square), along = 1.0f - REACH * square;
        float color[3];
        eye_color(along > 0.0f ? sqrtf(1.0f - along * along) / IRIS : 1.0f / IRIS, x / radius, y / radius, color);
        for (size_t c = 0; c < 3; c++) t->rgba[4u * i + c] = (uint8_t)(color[c] + 0.5f);
        t->rgba[4u * i + 3u] = 255;
    }
    if (t->name && t->rgba) return m->texture_count++;
    free(t->name);
    free(t->rgba);
    return MODEL_NONE;
}

/* ---- on the ball ---- */

/* Leave the balls that have a partner. */
static void keep_pairs(balls *b)
{
    balls kept = { .count = 0 };
    for (uint32_t i = 0; i < b->count; i++) {
        int paired = 0;
        for (uint32_t k = 0; k < b->count; k++) paired |= eye_spheres_pair(&b->spheres[i], &b->spheres[k]);
        if (!paired) continue;
        kept.materials[kept.count] = b->materials[i];
        kept.spheres[kept.count++] = b->spheres[i];
    }
    *b = kept;
}

static int is_painted(const balls *b, uint32_t material)
{
    for (uint32_t i = 0; i < b->count; i++) {
        if (b->materials[i] == material) return 1;
    }
    return 0;
}

/* Areas of the ball are areas of the picture (Lambert's azimuthal projection about the gaze). */
static void project(model *m, const ball *eye, balls *b)
{
    for (uint32_t i = 0; is_painted(b, eye->material) && i < eye->count; i++) {
        const float *p = m->meshes[eye->mesh].position + 3 * (size_t)eye->vertices[i];
        float *uv = m->meshes[eye->mesh].uv + 2 * (size_t)eye->vertices[i];
        double way[3], x, y, beside, radius;
        for (int c = 0; c < 3; c++) way[c] = (double)p[c] - eye->sphere.centre[c];
        if (!vec_normalize(way)) continue;
        x = vec_dot(way, eye->right);
        y = vec_dot(way, eye->up);
        beside = sqrt(x * x + y * y);
        radius = sqrt(fmax(1.0 - vec_dot(way, eye->gaze), 0.0) / (double)REACH);
        radius = 0.5 * (radius < 1.0 ? radius : 1.0);
        uv[0] = (float)(0.5 + (beside > 0.0 ? radius * x / beside : 0.0));
        uv[1] = (float)(0.5 - (beside > 0.0 ? radius * y / beside : 0.0));
    }
}

/* Of a material that was painted, what is no ball is white. 1: out of memory */
static int whiten(model *m, const balls *b)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        model_mesh *mesh = &m->meshes[i];
        for (uint32_t s = 0; s < mesh->submesh_count; s++) {
            const model_submesh *part = &mesh->submeshes[s];
            if (!is_plain(m, mesh, part) || !is_painted(b, part->material)) continue;
            if (!mesh->uv) mesh->uv = model_zeros((size_t)mesh->vertex_count * 2, sizeof *mesh->uv);
            if (!mesh->uv) return 1;
            for (uint32_t k = 0; k < part->index_count; k++) {
                memset(mesh->uv + 2 * (size_t)mesh->indices[part->first_index + k], 0, 2 * sizeof *mesh->uv);
            }
        }
    }
    return 0;
}

static int finish(model *m, const balls *b)
{
    const uint32_t picture = add_picture(m);
    int failed = picture == MODEL_NONE;
    for (uint32_t i = 0; i < m->material_count && !failed; i++) {
        model_material *eye = &m->materials[i];
        if (!is_painted(b, i)) continue;
        eye->base_color_texture = picture;
        for (int c = 0; c < 3; c++) eye->base_color[c] = 1.0f;
        eye->metallic = 0.0f; /* a glTF file without it says 1 */
        if (eye->roughness > WET) eye->roughness = WET;
        failed = model_warn(m,
                            "material '%s': eyes of one colour look blind, so an iris was painted (--surface "
                            "'%s=plain': none)",
                            eye->name, eye->name);
    }
    return failed;
}

/* ---- skin around them ---- */

static int is_bare(const model_material *m)
{
    return (m->surface == NOH_SURFACE_SKIN || m->surface == NOH_SURFACE_PLAIN) && surface_is_bare(m->name) &&
           !m->surface_given && !m->unlit && m->alpha == MODEL_ALPHA_OPAQUE && m->metallic < 0.5f;
}

static int is_grey(const float c[3])
{
    const float least = fminf(c[0], fminf(c[1], c[2])), most = fmaxf(c[0], fmaxf(c[1], c[2]));
    return most - least < GREY_HUE && least > PALE_MIN;
}

/* Colours of people, from pale to dark. */
static int is_flesh(const float c[3])
{
    return c[0] > 1.1f * c[1] && c[1] > 1.05f * c[2] && c[2] > FLESH_MIN * c[0];
}

static int has_white_parts(const model *m, uint32_t material)
{
    for (uint32_t i = 0; i < m->mesh_count; i++) {
        for (uint32_t s = 0; s < m->meshes[i].submesh_count; s++) {
            const model_submesh *part = &m->meshes[i].submeshes[s];
            if (part->material == material && !surface_is_white(&m->meshes[i], part)) return 0;
        }
    }
    return 1;
}

static int make_skin(model *m)
{
    static const float skin[3] = { 0.62f, 0.37f, 0.27f };
    int failed = 0;
    for (uint32_t i = 0; i < m->material_count && !failed; i++) {
        model_material *bare = &m->materials[i];
        const int grey = is_grey(bare->base_color);
        if (!is_bare(bare) || !has_white_parts(m, i) || (!grey && !is_flesh(bare->base_color))) continue;
        if (grey) memcpy(bare->base_color, skin, sizeof skin);
        surface_kind_set(bare, NOH_SURFACE_SKIN);
        bare->roughness = SKIN_ROUGHNESS;
        failed = model_warn(m,
                            "material '%s': a %s face with living eyes looks like plaster, so it became skin "
                            "(--surface '%s=plain' keeps it)",
                            bare->name, grey ? "grey" : "plain", bare->name);
    }
    return failed;
}

int eye_paint(model *m)
{
    const int is_blank = m->texture_count == 0;
    balls b = { .count = 0 };
    if (visit_balls(m, collect, &b)) return 1;
    keep_pairs(&b);
    if (b.count == 0) return 0;
    return whiten(m, &b) || visit_balls(m, project, &b) || finish(m, &b) || (is_blank && make_skin(m));
}
