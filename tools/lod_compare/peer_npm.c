#define _POSIX_C_SOURCE 200809L /* posix_spawnp, strdup */
/* peer_npm.c: the levels that meshoptimizer's npm package makes of positions and targets; meshopt.mjs calls it.
 *
 * The mesh goes there and the levels come back in files of 32-bit words:
 *
 *   mesh    vertex, index, attribute, submesh, level and weight counts; weights; first index and index count of each
 *           submesh; [level][submesh] index counts wanted; positions; attributes, vertex by vertex; indices
 *   levels  [weight][level][submesh] index count, indices */
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "compare.h"

#define ATTRIBUTES_MAX 32u /* the package's limit */
#define PATH_MAX_BYTES 4096u

extern char **environ;

static const float weights_tried[PEER_WEIGHTS] = {
    0.0f, 1.0f, 4.0f, 8.0f, 16.0f, 32.0f, 64.0f, 128.0f, 256.0f, 512.0f
};

static int put(FILE *f, const void *words, size_t count)
{
    return fwrite(words, 4, count, f) == count;
}

static int put_mesh(FILE *f, const model_mesh *mesh, const lod *ours, const float *attributes, uint32_t attribute_count)
{
    uint32_t counts[6] = { mesh->vertex_count,  mesh->index_count, attribute_count,
                           mesh->submesh_count, ours->level_count, PEER_WEIGHTS };
    int good = put(f, counts, 6) && put(f, weights_tried, PEER_WEIGHTS);
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        good = good && put(f, &mesh->submeshes[s].first_index, 1) && put(f, &mesh->submeshes[s].index_count, 1);
    }
    for (uint32_t i = 0; i < ours->level_count; i++) {
        good = good && put(f, ours->levels[i].submesh_count, mesh->submesh_count);
    }
    return good && put(f, mesh->position, (size_t)mesh->vertex_count * 3u) &&
           put(f, attributes, (size_t)mesh->vertex_count * attribute_count) && put(f, mesh->indices, mesh->index_count);
}

static int write_mesh(const model_mesh *mesh, const lod *ours, const char *path, float *kept)
{
    uint32_t numbers = mesh->target_count * 3u, count = numbers < ATTRIBUTES_MAX ? numbers : ATTRIBUTES_MAX;
    float *attributes = principal_of(mesh, count, kept);
    FILE *f = fopen(path, "wb");
    int good = f && put_mesh(f, mesh, ours, attributes, count);
    if (f && fclose(f)) {
        good = 0;
    }
    free(attributes);
    return good;
}

static int run_node(const char *script, const char *mesh, const char *levels)
{
    char node[] = "node", *arguments[] = { node, strdup(script), strdup(mesh), strdup(levels), NULL };
    pid_t child;
    int status = 1;
    fflush(stdout);
    if (posix_spawnp(&child, node, NULL, NULL, arguments, environ) || waitpid(child, &status, 0) != child) {
        status = 1;
    }
    for (uint32_t i = 1; i < 4u; i++) {
        free(arguments[i]);
    }
    return status == 0;
}

static int take_submesh(FILE *f, const model_mesh *mesh, uint32_t s, lod_level *out)
{
    uint32_t count;
    if (fread(&count, 4, 1, f) != 1u || count > mesh->submeshes[s].index_count || count % 3u ||
        fread(out->indices + out->index_count, 4, count, f) != count) {
        return 0;
    }
    out->submesh_first[s] = out->index_count;
    out->submesh_count[s] = count;
    out->index_count += count;
    for (uint32_t i = out->submesh_first[s]; i < out->index_count; i++) {
        if (out->indices[i] >= mesh->vertex_count) {
            return 0;
        }
    }
    return 1;
}

static lod *take_levels(FILE *f, const model_mesh *mesh, const lod *ours)
{
    lod *l = compare_zeros(1, sizeof *l);
    int good = 1;
    l->submesh_count = mesh->submesh_count;
    l->level_count = ours->level_count;
    for (uint32_t i = 0; good && i < l->level_count; i++) {
        lod_level *level = &l->levels[i];
        peer_level_new(mesh, level);
        for (uint32_t s = 0; good && s < mesh->submesh_count; s++) {
            good = take_submesh(f, mesh, s, level);
        }
    }
    if (!good) {
        lod_free(l);
        return NULL;
    }
    return l;
}

int peer_npm_levels(const model_mesh *mesh, const lod *ours, const char *script, const char *folder, peer_npm *out)
{
    char mesh_path[PATH_MAX_BYTES], levels_path[PATH_MAX_BYTES];
    FILE *f;
    int good = 1;
    memset(out, 0, sizeof *out);
    snprintf(mesh_path, sizeof mesh_path, "%s/mesh", folder);
    snprintf(levels_path, sizeof levels_path, "%s/levels", folder);
    if (!write_mesh(mesh, ours, mesh_path, &out->kept) || !run_node(script, mesh_path, levels_path)) {
        return 1;
    }
    f = fopen(levels_path, "rb");
    for (uint32_t w = 0; f && good && w < PEER_WEIGHTS; w++) {
        out->weights[w] = weights_tried[w];
        out->levels[w] = take_levels(f, mesh, ours);
        good = out->levels[w] != NULL;
    }
    good = f && good && fgetc(f) == EOF;
    if (f) {
        fclose(f);
    }
    if (!good) {
        peer_npm_free(out);
    }
    return !good;
}

void peer_npm_free(peer_npm *p)
{
    for (uint32_t w = 0; w < PEER_WEIGHTS; w++) {
        if (p->levels[w]) {
            lod_free(p->levels[w]);
        }
    }
    memset(p, 0, sizeof *p);
}
