#include "light_surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/affine.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/pack.h"

static int blends(const noh_pack *pack, const noh_submesh *s)
{
    return s->material != NOH_NONE && (pack->materials[s->material].flags & NOH_MATERIAL_BLEND) != 0;
}

/* Visit the triangles of a mesh that shade, with the place of each; corners NULL: only count them. */
static uint32_t shading_triangles(const noh_mesh *mesh, uint32_t *corners)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < mesh->header->submesh_count; i++) {
        const noh_submesh *s = &mesh->submeshes[i];
        for (uint32_t k = 0; k + 2u < s->index_count && !blends(mesh->pack, s); k += 3u, count++) {
            for (uint32_t c = 0; corners && c < 3u; c++) {
                corners[3u * count + c] = noh_mesh_index(mesh, s->first_index + k + c);
            }
        }
    }
    return count;
}

/* A node's world matrix, column-major. */
static void world_of(const noh_node *node, double out[16])
{
    for (uint32_t i = 0; i < 16u; i++) {
        out[i] = i % 4u < 3u ? (double)node->world[4u * (i % 4u) + i / 4u] : i == 15u ? 1.0 : 0.0;
    }
}

static const noh_node *first_node_of(const noh_pack *pack, uint32_t mesh)
{
    for (uint32_t i = 0; i < pack->node_count; i++) {
        if (pack->nodes[i].mesh == mesh) return &pack->nodes[i];
    }
    return NULL;
}

/* From another node's mesh space to this one's. */
static void between(const double to_mesh[16], const noh_node *node, double out[16])
{
    double world[16];
    world_of(node, world);
    affine_multiply(to_mesh, world, out);
}

/* The triangles of another mesh, moved by `m`. Returns how many. */
static uint32_t place_triangles(const noh_mesh *mesh, const double m[16], uint32_t *corners, float *out)
{
    const uint32_t count = shading_triangles(mesh, corners);
    for (uint32_t i = 0; i < 3u * count; i++) {
        const float *p = mesh->positions + 3u * (size_t)corners[i];
        for (uint32_t k = 0; k < 3u; k++) {
            out[3u * (size_t)i + k] = (float)(m[k] * (double)p[0] + m[4u + k] * (double)p[1] +
                                              m[8u + k] * (double)p[2] + m[12u + k]);
        }
    }
    return count;
}

/* Whether a node other than `self` draws a mesh; the mesh. */
static int draws_another(const noh_pack *pack, uint32_t index, const noh_node *self, noh_mesh *mesh)
{
    const noh_node *node = &pack->nodes[index];
    return self && node != self && node->mesh != NOH_NONE && !noh_pack_mesh_at(pack, node->mesh, mesh, NULL);
}

static int place_others(light_surface *s, const noh_pack *pack, const noh_node *self, model_error *error)
{
    float *out = s->triangles + 9u * (size_t)s->own_count;
    uint32_t *corners = malloc((3u * (size_t)s->other_count + 1u) * sizeof *corners);
    double world[16], to_mesh[16], m[16];
    int failed = !corners && model_fail(error, s->mesh.name, "out of memory");
    if (self && !failed) {
        world_of(self, world);
        failed = affine_invert(world, to_mesh) &&
                 model_fail(error, s->mesh.name,
                            "the matrix of its node has no inverse: give the node a scale other than 0");
    }
    for (uint32_t i = 0; i < pack->node_count && !failed; i++) {
        noh_mesh mesh;
        if (draws_another(pack, i, self, &mesh)) {
            between(to_mesh, &pack->nodes[i], m);
            out += 9u * (size_t)place_triangles(&mesh, m, corners, out);
        }
    }
    free(corners);
    return failed;
}

float light_least(const float *positions, const uint32_t *corners, uint32_t count)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < 3u * count; i++) {
        const float *a = positions + 3u * (size_t)corners[i];
        const float *b = positions + 3u * (size_t)corners[i % 3u == 2u ? i - 2u : i + 1u];
        const double x = (double)(a[0] - b[0]), y = (double)(a[1] - b[1]), z = (double)(a[2] - b[2]);
        sum += sqrt(x * x + y * y + z * z);
    }
    return count ? (float)(sum / (3.0 * count)) / 12.0f : 0.0f;
}

static float squared_between(const float *a, const float *b)
{
    const float d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

static void use_vertices(const noh_mesh *mesh, uint8_t *used)
{
    for (uint32_t i = 0; i < mesh->header->submesh_count; i++) {
        const noh_submesh *s = &mesh->submeshes[i];
        for (uint32_t k = s->first_index; k < s->first_index + s->index_count; k++) {
            used[noh_mesh_index(mesh, k)] = 1;
        }
    }
}

/* The nearest vertex in use that faces the same way. */
static uint32_t find_stand_in(const noh_mesh *mesh, const uint8_t *used, uint32_t vertex)
{
    noh_vertex loose, other;
    uint32_t best = vertex;
    float least = INFINITY;
    noh_mesh_vertex(mesh, vertex, &loose);
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        const float squared = used[v] ? squared_between(loose.position, mesh->positions + 3u * (size_t)v) : INFINITY;
        if (squared >= least) continue;
        noh_mesh_vertex(mesh, v, &other);
        if (loose.normal[0] * other.normal[0] + loose.normal[1] * other.normal[1] + loose.normal[2] * other.normal[2] >
            0.0f) {
            best = v;
            least = squared;
        }
    }
    return best;
}

static int find_stand_ins(light_surface *s)
{
    const uint32_t count = s->mesh.header->vertex_count;
    uint8_t *used = calloc((size_t)count + 1u, 1);
    s->stand_in = malloc(((size_t)count + 1u) * sizeof *s->stand_in);
    if (!used || !s->stand_in) {
        free(used);
        return 1;
    }
    use_vertices(&s->mesh, used);
    for (uint32_t v = 0; v < count; v++) {
        s->stand_in[v] = used[v] ? v : find_stand_in(&s->mesh, used, v);
    }
    free(used);
    return 0;
}

int light_surface_open(const noh_pack *pack, uint32_t mesh, light_surface *out, model_error *error)
{
    const noh_node *self = first_node_of(pack, mesh);
    size_t vertices;
    memset(out, 0, sizeof *out);
    (void)noh_pack_mesh_at(pack, mesh, &out->mesh, NULL);
    vertices = out->mesh.header->vertex_count + 1u;
    out->own_count = shading_triangles(&out->mesh, NULL);
    for (uint32_t i = 0; i < pack->node_count; i++) {
        noh_mesh other;
        out->other_count += draws_another(pack, i, self, &other) ? shading_triangles(&other, NULL) : 0u;
    }
    out->position = malloc(12u * vertices);
    out->normal = malloc(12u * vertices);
    out->corners = malloc(12u * (size_t)(out->own_count + 1u));
    out->triangles = malloc(36u * ((size_t)out->own_count + out->other_count + 1u));
    out->layer_memory = malloc(noh_morph_layers_size(&out->mesh) + 16u);
    if (!out->position || !out->normal || !out->corners || !out->triangles || !out->layer_memory ||
        find_stand_ins(out)) {
        return model_fail(error, out->mesh.name, "out of memory");
    }
    (void)shading_triangles(&out->mesh, out->corners);
    out->least = light_least(out->mesh.positions, out->corners, out->own_count);
    if (place_others(out, pack, self, error)) return 1;
    return light_surface_pose(out, NULL, error);
}

int light_surface_pose(light_surface *s, const float *weights, model_error *error)
{
    const size_t bytes = noh_morph_layers_size(&s->mesh);
    noh_morph_layers layers;
    (void)noh_morph_layers_init(s->layer_memory, bytes, &s->mesh, &layers, NULL);
    if (weights && bytes) {
        noh_morph_accumulate(&s->mesh, weights, &layers);
    }
    for (uint32_t v = 0; v < s->mesh.header->vertex_count; v++) {
        noh_vertex vertex;
        noh_morph_vertex(&s->mesh, &layers, s->stand_in[v], &vertex);
        memcpy(s->position + 3u * (size_t)v, vertex.position, sizeof vertex.position);
        memcpy(s->normal + 3u * (size_t)v, vertex.normal, sizeof vertex.normal);
    }
    for (uint32_t i = 0; i < 3u * s->own_count; i++) {
        memcpy(s->triangles + 3u * (size_t)i, s->position + 3u * (size_t)s->corners[i], 12u);
    }
    if (s->tree.nodes) {
        ray_tree_fit(&s->tree, s->triangles);
        return 0;
    }
    return ray_tree_make(s->triangles, s->own_count + s->other_count, &s->tree)
               ? model_fail(error, s->mesh.name, "out of memory")
               : 0;
}

void light_surface_close(light_surface *s)
{
    ray_tree_free(&s->tree);
    free(s->position);
    free(s->normal);
    free(s->corners);
    free(s->triangles);
    free(s->layer_memory);
    free(s->stand_in);
    memset(s, 0, sizeof *s);
}
