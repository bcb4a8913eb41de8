#include "level_costs.h"

#include <string.h>

static void count_work(const scene *s, level_cost *out)
{
    for (uint32_t i = 0; i < s->item_count; i++) {
        const noh_mesh_header *h = s->meshes[s->items[i].mesh].header;
        out->vertices += h->vertex_count;
        out->triangles += h->index_count / 3;
        out->texels += h->touched_count;
        out->pairs += h->pair_count;
    }
}

int level_costs_find(level_costs *out, const pack_file *file, scene *s, const noh_gl_caps *caps, const load_options *o)
{
    int status = 0;
    memset(out, 0, sizeof *out);
    out->first = scene_level_first(s, file);
    for (out->count = out->first; out->count < scene_level_count(s, file) && !status; out->count++) {
        level_cost *cost = &out->levels[out->count];
        load_budget b;
        status = scene_set_level(s, file, out->count);
        if (!status) status = load_budget_make(&b, file, s, caps, o);
        if (!status) {
            count_work(s, cost);
            cost->cpu_bytes = b.cpu_bytes;
            cost->gpu_bytes = b.gpu_bytes;
            load_budget_free(&b);
        }
    }
    (void)scene_set_level(s, file, 0);
    return status;
}
