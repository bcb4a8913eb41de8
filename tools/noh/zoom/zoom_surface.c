/* zoom_surface.c: how far the shown level's surface is from the full one, in the pose shown. Both are computed from the
 * pack as the vertex shader does. */
#include <stdlib.h>
#include <string.h>

#include "convert/lod/lod.h"
#include "zoom.h"
#include "cli/message.h"

typedef struct zoom_surface_entry {
    uint32_t item, level;
    float *weights;
    double metres;
} zoom_surface_entry;

/* Both surfaces as one mesh: the vertices of the full one, then those of the level. */
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

/* An item's vertices in the scene's pose. */
static int take_positions(const scene *s, uint32_t item, float *position)
{
    const uint32_t count = s->meshes[s->items[item].mesh].header->vertex_count;
    noh_vertex *vertices = malloc(sizeof *vertices * (count + 1u));
    int status = vertices ? scene_deform(s, item, count, vertices) : tool_fail("zoom", "out of memory");
    for (uint32_t v = 0; v < count && !status; v++) {
        memcpy(position + 3 * (size_t)v, vertices[v].position, 3 * sizeof(float));
    }
    free(vertices);
    return status;
}

/* `shown` has the item's mesh at that level. */
static int measure(const scene *full, const scene *shown, uint32_t item, double *metres)
{
    const noh_mesh *fine = &full->meshes[full->items[item].mesh], *coarse = &shown->meshes[shown->items[item].mesh];
    model_error error;
    pair p;
    int status = pair_open(&p, fine, coarse) ? tool_fail("zoom", "out of memory") : 0;
    if (!status) {
        take_triangles(&p, fine, coarse);
        status = take_positions(full, item, p.mesh.position);
    }
    if (!status) status = take_positions(shown, item, p.mesh.position + 3 * (size_t)fine->header->vertex_count);
    if (!status && lod_certify(&p.mesh, &p.level, NULL, 0, p.distances, &error)) {
        status = tool_fail("zoom", "%s", error.what);
    }
    *metres = 0.0;
    for (uint32_t s = 0; s < p.mesh.submesh_count && !status; s++) {
        const double distance = (double)p.distances[s].max * (double)fine->header->world_scale;
        *metres = distance > *metres ? distance : *metres;
    }
    pair_close(&p);
    return status;
}

static int measure_at(const pack_file *file, const scene *full, const scene *kept, uint32_t item, uint32_t level,
                      double *metres)
{
    scene shown = *kept;
    int status;
    shown.meshes = malloc(sizeof *shown.meshes * (file->pack.mesh_count + 1u));
    if (!shown.meshes) {
        return tool_fail(file->path, "out of memory");
    }
    for (uint32_t m = 0; m < file->pack.mesh_count; m++) {
        shown.meshes[m] = noh_mesh_at_lod(&kept->meshes[m], level);
    }
    status = measure(full, &shown, item, metres);
    free(shown.meshes);
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

int zoom_surface_distance(zoom_surface *z, const pack_file *file, const scene *full, const scene *kept, uint32_t item,
                          uint32_t level, double *metres)
{
    const float *weights = kept->items[item].weights;
    const size_t bytes = sizeof *weights * kept->meshes[kept->items[item].mesh].header->target_count;
    zoom_surface_entry e = { item, level, NULL, 0.0 };
    int status;
    for (uint32_t i = 0; i < z->count; i++) {
        const zoom_surface_entry *known = &z->entries[i];
        if (known->item == item && known->level == level && !memcmp(known->weights, weights, bytes)) {
            *metres = known->metres;
            return 0;
        }
    }
    status = measure_at(file, full, kept, item, level, &e.metres);
    *metres = e.metres;
    return status ? status : remember(z, &e, weights, bytes);
}

void zoom_surface_close(zoom_surface *z)
{
    for (uint32_t i = 0; i < z->count; i++) {
        free(z->entries[i].weights);
    }
    free(z->entries);
    memset(z, 0, sizeof *z);
}
