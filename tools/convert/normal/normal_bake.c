#include "normal_bake.h"

#include "convert/light/ray_tree.h"
#include "convert/model/affine.h"
#include "convert/model/model_build.h"
#include "convert/wrinkle/wrinkle_raster.h"
#include "normal_height.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BEHIND 1e-3 /* of the reach: rays begin so far behind the surface, which may lie on the fine one */
#define PADDING 8u  /* texels around a chart that filters and mip levels reach into */
#define REACH 0.02

/* ---- surfaces in the world ---- */

typedef struct surface {
    uint32_t vertex_count, triangle_count;
    float *position, *normal, *tangent, *uv; /* [vertex_count][3], [3], [4], [2] */
    uint32_t *indices;                       /* [triangle_count][3] */
} surface;

/* The parts of a model that the bake needs. */
typedef struct choice {
    const model *m;
    int with_uv;          /* only what has tangents and texture coordinates */
    const char *material; /* only that; NULL: all */
} choice;

static int is_wanted(const choice *c, const model_mesh *mesh, const model_submesh *s)
{
    if (c->with_uv && (!mesh->uv || !mesh->tangent)) return 0;
    return !c->material || (s->material != MODEL_NONE && strcmp(c->m->materials[s->material].name, c->material) == 0);
}

/* How many nodes draw a mesh. */
static uint32_t drawings_of(const model *m, uint32_t mesh)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < m->node_count; n++) count += m->nodes[n].mesh == mesh;
    return count;
}

static int surface_room(const choice *c, surface *s)
{
    size_t vertices = 0, indices = 0;
    for (uint32_t i = 0; i < c->m->mesh_count; i++) {
        const uint32_t drawings = drawings_of(c->m, i), copies = drawings ? drawings : 1;
        vertices += (size_t)c->m->meshes[i].vertex_count * copies;
        indices += (size_t)c->m->meshes[i].index_count * copies;
    }
    memset(s, 0, sizeof *s);
    if (vertices > UINT32_MAX / 16u || indices > UINT32_MAX / 16u) return 1;
    s->position = model_zeros(3u * vertices + 1u, sizeof *s->position);
    s->normal = model_zeros(3u * vertices + 1u, sizeof *s->normal);
    s->tangent = model_zeros(4u * vertices + 1u, sizeof *s->tangent);
    s->uv = model_zeros(2u * vertices + 1u, sizeof *s->uv);
    s->indices = model_zeros(indices + 1u, sizeof *s->indices);
    return !s->position || !s->normal || !s->tangent || !s->uv || !s->indices;
}

static void surface_free(surface *s)
{
    free(s->position);
    free(s->normal);
    free(s->tangent);
    free(s->uv);
    free(s->indices);
}

static void unit(double v[3])
{
    const double length = sqrt(vec_dot(v, v));
    for (int k = 0; k < 3 && length > 0.0; k++) v[k] /= length;
}

static void add_vertex(surface *s, const model_mesh *mesh, uint32_t v, const double m[16], const double turn[9],
                       double side)
{
    const size_t at = s->vertex_count++;
    double normal[3], tangent[3];
    for (size_t k = 0; k < 3; k++) {
        const float *p = mesh->position + 3u * (size_t)v, *n = mesh->normal + 3u * (size_t)v;
        const float *t = mesh->tangent ? mesh->tangent + 4u * (size_t)v : n;
        s->position[3u * at + k] = (float)(m[k] * (double)p[0] + m[4u + k] * (double)p[1] + m[8u + k] * (double)p[2] +
                                           m[12u + k]);
        normal[k] = side * (turn[k] * (double)n[0] + turn[3u + k] * (double)n[1] + turn[6u + k] * (double)n[2]);
        tangent[k] = m[k] * (double)t[0] + m[4u + k] * (double)t[1] + m[8u + k] * (double)t[2];
    }
    unit(normal);
    unit(tangent);
    for (size_t k = 0; k < 3; k++) {
        s->normal[3u * at + k] = (float)normal[k];
        s->tangent[4u * at + k] = (float)tangent[k];
    }
    s->tangent[4u * at + 3u] = mesh->tangent ? (float)side * mesh->tangent[4u * (size_t)v + 3u] : 1.0f;
    if (mesh->uv) memcpy(s->uv + 2u * at, mesh->uv + 2u * (size_t)v, 2u * sizeof(float));
}

static void add_mesh(surface *s, const choice *c, const model_mesh *mesh, const double m[16])
{
    const uint32_t first = s->vertex_count;
    const double side = affine_determinant(m) < 0.0 ? -1.0 : 1.0;
    double turn[9];
    affine_cofactors(m, turn);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) add_vertex(s, mesh, v, m, turn, side);
    for (uint32_t i = 0; i < mesh->submesh_count; i++) {
        const model_submesh *sub = &mesh->submeshes[i];
        for (uint32_t k = 0; k + 2u < sub->index_count && is_wanted(c, mesh, sub); k += 3u) {
            for (uint32_t j = 0; j < 3u; j++) {
                s->indices[3u * (size_t)s->triangle_count + j] = first + mesh->indices[sub->first_index + k + j];
            }
            s->triangle_count++;
        }
    }
}

/* Each mesh by each node that draws it; one that a skin moves, and one that no node draws, as it is. */
static int surface_of(const choice *c, surface *s)
{
    if (surface_room(c, s)) return 1;
    for (uint32_t i = 0; i < c->m->mesh_count; i++) {
        double identity[16];
        affine_identity(identity);
        for (uint32_t n = 0; n < c->m->node_count; n++) {
            const model_node *node = &c->m->nodes[n];
            if (node->mesh != i) continue;
            add_mesh(s, c, &c->m->meshes[i], node->skin == MODEL_NONE ? node->world : identity);
        }
        if (!drawings_of(c->m, i)) add_mesh(s, c, &c->m->meshes[i], identity);
    }
    return 0;
}

static double diagonal_of(const surface *s)
{
    double low[3] = { 1e30, 1e30, 1e30 }, high[3] = { -1e30, -1e30, -1e30 }, sum = 0.0;
    for (uint32_t i = 0; i < 3u * s->triangle_count; i++) {
        for (uint32_t k = 0; k < 3u; k++) {
            const double p = (double)s->position[3u * (size_t)s->indices[i] + k];
            low[k] = fmin(low[k], p);
            high[k] = fmax(high[k], p);
        }
    }
    for (int k = 0; k < 3; k++) sum += (high[k] - low[k]) * (high[k] - low[k]);
    return sqrt(sum);
}

/* ---- rays ---- */

typedef struct baking {
    const surface *coarse, *fine;
    ray_tree tree;
    wrinkle_raster raster;
    double reach;
} baking;

/* A place of a triangle, out of values [vertex][width]. */
static void mixed(const float *values, uint32_t width, const uint32_t corners[3], const double share[3], double out[3])
{
    for (uint32_t k = 0; k < 3; k++) {
        out[k] = 0.0;
        for (uint32_t c = 0; c < 3; c++) out[k] += share[c] * (double)values[(size_t)width * corners[c] + k];
    }
}

/* The fine surface's normal along a direction from p. Returns how far it is, or a negative number: none that faces as
 * n does within reach. */
static double look_along(const baking *b, const double p[3], const double n[3], double side, double normal[3])
{
    float origin[3], direction[3];
    ray_meeting met;
    double at[3], share[3], distance = 0.0;
    for (int k = 0; k < 3; k++) {
        direction[k] = (float)(side * n[k]);
        origin[k] = (float)(p[k] - side * BEHIND * b->reach * n[k]);
    }
    if (!ray_tree_nearest(&b->tree, origin, direction, 0.0f, &met)) return -1.0;
    share[1] = (double)met.u;
    share[2] = (double)met.v;
    share[0] = 1.0 - share[1] - share[2];
    mixed(b->fine->position, 3, b->fine->indices + 3u * (size_t)met.triangle, share, at);
    mixed(b->fine->normal, 3, b->fine->indices + 3u * (size_t)met.triangle, share, normal);
    unit(normal);
    for (int k = 0; k < 3; k++) distance += side * n[k] * (at[k] - p[k]);
    return distance <= b->reach && vec_dot(normal, n) > 0.0 ? fmax(distance, 0.0) : -1.0;
}

/* The coarse surface's frame at a texel: tangent, bitangent, normal. */
static void frame_at(const surface *s, const uint32_t corners[3], const double share[3], double frame[3][3])
{
    double along;
    mixed(s->normal, 3, corners, share, frame[2]);
    unit(frame[2]);
    mixed(s->tangent, 4, corners, share, frame[0]);
    along = vec_dot(frame[0], frame[2]);
    for (int k = 0; k < 3; k++) frame[0][k] -= along * frame[2][k];
    unit(frame[0]);
    vec_cross(frame[2], frame[0], frame[1]);
    for (int k = 0; k < 3; k++) frame[1][k] *= (double)s->tangent[4u * (size_t)corners[0] + 3u];
}

/* Returns whether there is a fine surface in reach; *lean: degrees. */
static int bake_texel(const baking *b, size_t at, uint8_t rgba[4], double *lean)
{
    const uint32_t *corners = b->coarse->indices + 3u * (size_t)b->raster.triangle[at];
    const double share[3] = { (double)b->raster.share[at][0], (double)b->raster.share[at][1],
                              (double)b->raster.share[at][2] };
    double p[3], frame[3][3], normals[2][3], v[3] = { 0.0, 0.0, 1.0 }, distance[2];
    mixed(b->coarse->position, 3, corners, share, p);
    frame_at(b->coarse, corners, share, frame);
    for (int side = 0; side < 2; side++) {
        distance[side] = look_along(b, p, frame[2], side ? -1.0 : 1.0, normals[side]);
    }
    if (distance[0] >= 0.0 || distance[1] >= 0.0) {
        const int nearer = distance[0] < 0.0 || (distance[1] >= 0.0 && distance[1] < distance[0]);
        for (int k = 0; k < 3; k++) v[k] = vec_dot(normals[nearer], frame[k]);
        *lean = acos(fmin(v[2], 1.0)) * 57.29577951308232;
    }
    normal_texel(v, rgba);
    return distance[0] >= 0.0 || distance[1] >= 0.0;
}

static void bake_all(const baking *b, normal_map *out)
{
    const size_t count = (size_t)out->size * out->size;
    uint32_t found = 0;
    for (size_t at = 0; at < count; at++) {
        double lean = 0.0;
        if (b->raster.triangle[at] == MODEL_NONE) {
            normal_texel((const double[3]){ 0.0, 0.0, 1.0 }, out->rgba + 4u * at);
        } else if (bake_texel(b, at, out->rgba + 4u * at, &lean)) {
            out->lean += lean;
            found++;
        }
    }
    out->covered = b->raster.covered;
    out->overlapped = b->raster.overlapped;
    out->missed = out->covered - found;
    if (found) out->lean /= found;
}

static int make_raster(const surface *coarse, uint32_t size, wrinkle_raster *raster)
{
    model_mesh mesh;
    wrinkle_field field;
    uint32_t *triangles = model_zeros(coarse->triangle_count + 1u, sizeof *triangles);
    int failed = !triangles;
    memset(&mesh, 0, sizeof mesh);
    memset(&field, 0, sizeof field);
    mesh.uv = coarse->uv;
    mesh.indices = coarse->indices;
    field.mesh = &mesh;
    field.triangle_count = coarse->triangle_count;
    field.triangles = triangles;
    for (uint32_t i = 0; i < coarse->triangle_count && triangles; i++) triangles[i] = 3u * i;
    failed = failed || wrinkle_raster_make(&field, size, size, raster);
    free(triangles);
    return failed;
}

static int make_tree(const surface *fine, ray_tree *tree)
{
    float *corners = model_zeros(9u * (size_t)fine->triangle_count + 1u, sizeof *corners);
    int failed = !corners;
    for (uint32_t i = 0; i < 3u * fine->triangle_count && corners; i++) {
        memcpy(corners + 3u * (size_t)i, fine->position + 3u * (size_t)fine->indices[i], 3u * sizeof *corners);
    }
    failed = failed || ray_tree_make(corners, fine->triangle_count, tree);
    free(corners);
    return failed;
}

static int bake(baking *b, normal_map *out)
{
    out->rgba = model_zeros((size_t)out->size * out->size, 4);
    if (!out->rgba || make_raster(b->coarse, out->size, &b->raster) || make_tree(b->fine, &b->tree)) return 1;
    bake_all(b, out);
    return wrinkle_raster_dilate(&b->raster, out->rgba, PADDING);
}

int normal_map_bake(const model *coarse, const model *fine, const normal_bake_settings *settings, normal_map *out,
                    model_error *error)
{
    const choice wanted = { coarse, 1, settings->material }, other = { fine, 0, NULL };
    surface low, high;
    baking b;
    const char *what = NULL;
    memset(&b, 0, sizeof b);
    memset(&high, 0, sizeof high);
    memset(out, 0, sizeof *out);
    out->size = settings->size;
    if (surface_of(&wanted, &low) || surface_of(&other, &high)) {
        what = "out of memory";
    } else if (!low.triangle_count) {
        what = settings->material ? "no triangle of that material has texture coordinates"
                                  : "it has no texture coordinates, which a normal map needs";
    } else if (!high.triangle_count) {
        what = "the fine model has no triangles";
    } else {
        b.coarse = &low;
        b.fine = &high;
        b.reach = out->reach = settings->reach > 0.0 ? settings->reach : REACH * diagonal_of(&low);
        if (bake(&b, out)) what = "out of memory";
    }
    ray_tree_free(&b.tree);
    wrinkle_raster_free(&b.raster);
    surface_free(&low);
    surface_free(&high);
    if (!what) return 0;
    free(out->rgba);
    out->rgba = NULL;
    return model_fail(error, "", "%s", what);
}
