#include "identity_join.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/base/input_file.h"
#include "target_append.h"

/* ---- which mesh ---- */

static float size_of(const model_mesh *mesh)
{
    float low[3] = { 0 }, high[3] = { 0 }, square = 0.0f;
    for (size_t i = 0; i < (size_t)mesh->vertex_count * 3; i++) {
        const float x = mesh->position[i];
        if (i < 3 || x < low[i % 3]) low[i % 3] = x;
        if (i < 3 || x > high[i % 3]) high[i % 3] = x;
    }
    for (int c = 0; c < 3; c++) square += (high[c] - low[c]) * (high[c] - low[c]);
    return sqrtf(square);
}

/* Files are rounded each for itself: positions may differ by a thousandth of the mesh. */
static int same_surface(const model_mesh *a, const model_mesh *b)
{
    const float within = 1e-3f * size_of(a);
    if (a->vertex_count != b->vertex_count || a->index_count != b->index_count ||
        memcmp(a->indices, b->indices, a->index_count * sizeof *a->indices) != 0) {
        return 0;
    }
    for (size_t i = 0; i < (size_t)a->vertex_count * 3; i++) {
        if (!(fabsf(a->position[i] - b->position[i]) <= within)) return 0;
    }
    return 1;
}

static int names_clash(const model_mesh *a, const model_mesh *b, const char *path, model_error *error)
{
    for (uint32_t i = 0; i < a->target_count; i++) {
        for (uint32_t k = 0; k < b->target_count; k++) {
            if (strcmp(a->targets[i].name, b->targets[k].name) == 0) {
                return model_fail(error, path, "both files have a target '%s'", b->targets[k].name);
            }
        }
    }
    return 0;
}

static int join(model *m, model *other, const char *path, model_error *error)
{
    uint32_t joined = 0;
    for (uint32_t b = 0; b < other->mesh_count; b++) {
        model_mesh *from = &other->meshes[b];
        for (uint32_t a = 0; a < m->mesh_count && from->target_count; a++) {
            if (!same_surface(&m->meshes[a], from)) continue;
            if (names_clash(&m->meshes[a], from, path, error)) return 1;
            for (uint32_t t = 0; t < from->target_count; t++) from->targets[t].identity = 1;
            if (model_append_targets(m, a, from)) return model_fail(error, path, "out of memory");
            joined++;
            break;
        }
    }
    return joined ? 0
                  : model_fail(error, path,
                               "no mesh with targets has the triangles and rest positions of "
                               "a mesh of the model: export both with the same vertex order");
}

int identity_join(model *m, const char *path, model_error *error)
{
    model *other = NULL;
    int failed;
    if (model_read_gltf(path, &other, error)) return input_fail_at(path, error);
    failed = join(m, other, path, error);
    model_free(other);
    return failed;
}
