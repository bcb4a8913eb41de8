/* zoom_surface.c: how far the shown level's surface is from the full one, in the pose shown. Both are computed from the
 * pack as the vertex shader does. */
#include <stdlib.h>
#include <string.h>

#include "convert/lod/lod.h"
#include "zoom.h"
#include "cli/message.h"

typedef struct zoom_surface_entry {
    zoom_mesh at;
    float *weights;
    double metres;
} zoom_surface_entry;

/* Both surfaces as one mesh: the vertices of the full mesh, then the vertices of the level. */
typedef struct pair {
    model_mesh mesh; /* with the triangles of the full one */
    lod_level level;
    lod_distance *distances;
} pair;

static void pair_close(pair *p)
{
    free(p->mesh.position);
    free(p->mesh.indices);
    free(p->mesh.submeshes);
    free(p->level.indices);
    free(p->level.submesh_first);
    free(p->level.submesh_count);
    free(p->distances);
}

static int pair_open(pair *p, const noh_mesh *full, const noh_mesh *level)
{
    const uint32_t submeshes = full->header->submesh_count;
    memset(p, 0, sizeof *p);
    p->mesh.vertex_count = full->header->vertex_count + level->header->vertex_count;
    p->mesh.index_count = full->header->index_count;
    p->mesh.submesh_count = submeshes;
    p->mesh.position = calloc(p->mesh.vertex_count, 3 * sizeof(float));
    p->mesh.indices = calloc(full->header->index_count + 1u, sizeof(uint32_t));
    p->mesh.submeshes = calloc(submeshes, sizeof *p->mesh.submeshes);
    p->level.indices = calloc(level->header->index_count + 1u, sizeof(uint32_t));
    p->level.submesh_first = calloc(submeshes, sizeof(uint32_t));
    p->level.submesh_count = calloc(submeshes, sizeof(uint32_t));
    p->distances = calloc(submeshes, sizeof *p->distances);
    return !p->mesh.position || !p->mesh.indices || !p->mesh.submeshes || !p->level.indices ||
           !p->level.submesh_first || !p->level.submesh_count || !p->distances;
}

static void take_triangles(pair *p, const noh_mesh *full, const noh_mesh *level)
{
    for (uint32_t i = 0; i < full->header->index_count; i++) {
        p->mesh.indices[i] = noh_mesh_index(full, i);
    }
    for (uint32_t i = 0; i < level->header->index_count; i++) {
        p->level.indices[i] = full->header->vertex_count + noh_mesh_index(level, i);
    }
    for (uint32_t s = 0; s < full->header->submesh_count; s++) {
        p->mesh.submeshes[s].first_index = full->submeshes[s].first_index;
        p->mesh.submeshes[s].index_count = full->submeshes[s].index_count;
        p->level.submesh_first[s] = level->submeshes[s].first_index;
        p->level.submesh_count[s] = level->submeshes[s].index_count;
    }
}

static void take_positions(const noh_vertex *vertices, uint32_t count, float *position)
{
    for (uint32_t v = 0; v < count; v++) {
        memcpy(position + 3 * (size_t)v, vertices[v].position, 3 * sizeof(float));
    }
}

static int measure_pair(const noh_mesh *fine, const noh_vertex *fine_at, const noh_mesh *coarse,
                        const noh_vertex *coarse_at, double *metres)
{
    model_error error;
    pair p;
    int status = pair_open(&p, fine, coarse) ? tool_fail("zoom", "out of memory") : 0;
    if (!status) {
        take_triangles(&p, fine, coarse);
        take_positions(fine_at, fine->header->vertex_count, p.mesh.position);
        take_positions(coarse_at, coarse->header->vertex_count,
                       p.mesh.position + 3 * (size_t)fine->header->vertex_count);
        if (lod_certify(&p.mesh, &p.level, NULL, 0, p.distances, &error)) {
            status = tool_fail("zoom", "%s", error.what);
        }
    }
    for (uint32_t s = 0; s < p.mesh.submesh_count && !status; s++) {
        const double distance = (double)p.distances[s].max * (double)fine->header->world_scale;
        *metres = distance > *metres ? distance : *metres;
    }
    pair_close(&p);
    return status;
}

/* The level of a mesh in a level of its figure. */
static uint32_t mesh_level(const figure *f, const zoom_mesh *at, uint32_t level)
{
    return f->plan.kinds[at->kind].levels[level].mesh_levels[at->index];
}

static int measure(const figure *full, const figure *kept, const zoom_mesh *at, double *metres)
{
    const uint32_t finest = full->plan.kinds[at->kind].finest_level;
    noh_mesh fine, coarse;
    noh_actor_mesh shown;
    noh_vertex *fine_at = figure_deform(full, at->kind, at->index, mesh_level(full, at, finest), &fine, &shown);
    noh_vertex *coarse_at = figure_deform(kept, at->kind, at->index, mesh_level(kept, at, at->level), &coarse, &shown);
    const int status = fine_at && coarse_at ? measure_pair(&fine, fine_at, &coarse, coarse_at, metres) : EXIT_FAILED;
    free(fine_at);
    free(coarse_at);
    return status;
}

static int remember(zoom_surface *z, const zoom_surface_entry *e, const float *weights, size_t bytes)
{
    zoom_surface_entry *more = realloc(z->entries, sizeof *more * (z->count + 1u));
    if (!more) {
        return tool_fail("zoom", "out of memory");
    }
    z->entries = more;
    more[z->count] = *e;
    more[z->count].weights = malloc(bytes + 1u);
    if (!more[z->count].weights) {
        return tool_fail("zoom", "out of memory");
    }
    memcpy(more[z->count++].weights, weights, bytes);
    return 0;
}

int zoom_surface_distance(zoom_surface *z, const figure *full, const figure *kept, const zoom_mesh *at, double *metres)
{
    zoom_surface_entry e = { *at, NULL, 0.0 };
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_actor_mesh shown;
    noh_mesh mesh;
    size_t bytes;
    int status;
    if (noh_actor_mesh_at(kept->stage, kept->actors[at->kind], at->index, &shown, NULL, &error)) {
        return tool_fail_error(kept->desc.file->path, &error);
    }
    (void)noh_pack_mesh_at(kept->kinds[at->kind].mesh, shown.mesh, &mesh, NULL);
    bytes = sizeof *shown.weights * mesh.header->target_count;
    for (uint32_t i = 0; i < z->count; i++) {
        const zoom_surface_entry *known = &z->entries[i];
        if (!memcmp(&known->at, at, sizeof *at) && !memcmp(known->weights, shown.weights, bytes)) {
            *metres = known->metres;
            return 0;
        }
    }
    status = measure(full, kept, at, &e.metres);
    *metres = e.metres;
    return status ? status : remember(z, &e, shown.weights, bytes);
}

void zoom_surface_close(zoom_surface *z)
{
    for (uint32_t i = 0; i < z->count; i++) {
        free(z->entries[i].weights);
    }
    free(z->entries);
    memset(z, 0, sizeof *z);
}
