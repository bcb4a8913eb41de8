/* scene_deform.c: a scene's vertices on the CPU: morphed, then skinned. */
#include <stdlib.h>
#include <string.h>

#include "deform/dual_quaternion.h"
#include "deform/skin.h"
#include "cli/message.h"
#include "scene.h"

/* What one item needs to be deformed. */
typedef struct work {
    const noh_mesh *mesh;
    noh_skin skin;
    noh_morph_layers layers;
    void *layer_memory;
    float *matrices;
    noh_dual_quaternion *dual;
} work;

static void work_close(work *w)
{
    free(w->layer_memory);
    free(w->matrices);
    free(w->dual);
}

void scene_skin_matrices(const scene *s, const noh_skin *skin, float *matrices)
{
    noh_skin_matrices(skin, s->players[skin->header->skeleton].joint_matrices, matrices);
}

static int prepare_joints(work *w, const scene *s)
{
    uint32_t count;
    if (noh_pack_skin_at(w->mesh->pack, w->mesh->header->skin, &w->skin, NULL)) {
        return 0; /* rigid */
    }
    count = w->skin.header->joint_count;
    w->matrices = malloc(sizeof(float) * 12u * count);
    w->dual = w->mesh->header->flags & NOH_MESH_DUAL_QUATERNION ? malloc(sizeof *w->dual * count) : NULL;
    if (!w->matrices || (w->mesh->header->flags & NOH_MESH_DUAL_QUATERNION && !w->dual)) {
        return 1;
    }
    scene_skin_matrices(s, &w->skin, w->matrices);
    if (w->dual) {
        noh_skin_dual_quaternions(w->matrices, count, w->dual);
    }
    return 0;
}

static int prepare(work *w, const scene *s, uint32_t item)
{
    size_t bytes;
    memset(w, 0, sizeof *w);
    w->mesh = &s->meshes[s->items[item].mesh];
    bytes = noh_morph_layers_size(w->mesh);
    w->layer_memory = malloc(bytes + 16);
    if (!w->layer_memory || prepare_joints(w, s)) {
        return 1;
    }
    noh_morph_layers_init(w->layer_memory, bytes + 16, w->mesh, &w->layers, NULL);
    noh_morph_accumulate(w->mesh, s->items[item].weights, &w->layers);
    return 0;
}

int scene_deform(const scene *s, uint32_t item, uint32_t count, noh_vertex *vertices)
{
    work w;
    int failed = prepare(&w, s, item);
    for (uint32_t v = 0; v < count && !failed; v++) {
        if (w.dual) {
            noh_skin_vertex_dual(w.mesh, w.dual, &w.layers, v, &vertices[v]);
        } else if (w.matrices) {
            noh_skin_vertex(w.mesh, w.matrices, &w.layers, v, &vertices[v]);
        } else {
            noh_morph_vertex(w.mesh, &w.layers, v, &vertices[v]);
        }
    }
    work_close(&w);
    return failed ? tool_fail("deform", "out of memory") : 0;
}
