#include "pack_budget.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

/* The parts of the stage, followed by the hair, if any. */
static int list_parts(pack_budget *b, const noh_gl_caps *caps)
{
    const figure *f = &b->planned;
    noh_stage_bytes hair = { .what = "hair", .kind = f->hair.desc.kind };
    b->part_count = noh_stage_plan_parts(&f->stage_desc, caps, &f->plan, NULL, 0);
    b->parts = calloc(b->part_count + 1u, sizeof *b->parts);
    if (!b->parts) {
        return tool_fail(f->desc.file->path, "out of memory");
    }
    (void)noh_stage_plan_parts(&f->stage_desc, caps, &f->plan, b->parts, b->part_count);
    figure_hair_bytes(f, &hair.cpu_bytes, &hair.gpu_bytes);
    if (hair.cpu_bytes) b->parts[b->part_count++] = hair;
    return 0;
}

/* Kinds of one skeleton share its clips. */
static void count_segments(pack_budget *b)
{
    const figure *f = &b->planned;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        if (k && f->kinds[k].skeleton == f->kinds[k - 1u].skeleton) continue;
        b->cached_segment_count += f->plan.kinds[k].cached_segment_count;
        b->segment_count += f->plan.kinds[k].segment_count;
    }
}

static void count_work(const figure *f, uint32_t level, level_cost *out)
{
    const noh_pack *pack = &f->desc.file->pack;
    for (uint32_t k = 0; k < f->stage_desc.kind_count; k++) {
        for (uint32_t i = 0; i < f->kinds[k].node_count; i++) {
            const uint32_t node = f->kinds[k].nodes[i];
            noh_mesh full, mesh;
            (void)noh_pack_mesh_at(pack, pack->node_count ? pack->nodes[node].mesh : node, &full, NULL);
            mesh = noh_mesh_at_lod(&full, level);
            out->vertices += mesh.header->vertex_count;
            out->triangles += mesh.header->index_count / 3u;
            out->texels += mesh.header->touched_count;
            out->pairs += mesh.header->pair_count;
        }
    }
}

static int find_levels(pack_budget *b, const noh_gl_caps *caps)
{
    const noh_pack *pack = &b->planned.desc.file->pack;
    int status = 0;
    b->level_first = figure_level_first(pack);
    for (b->level_count = b->level_first; b->level_count < figure_level_count(pack) && !status; b->level_count++) {
        level_cost *cost = &b->levels[b->level_count];
        figure_desc desc = b->planned.desc;
        figure f;
        desc.level = b->level_count;
        status = figure_plan(&f, &desc, caps);
        if (status) break;
        count_work(&f, desc.level, cost);
        figure_bytes(&f, &cost->cpu_bytes, &cost->gpu_bytes);
        figure_plan_free(&f);
    }
    return status;
}

int pack_budget_make(pack_budget *b, const figure_desc *desc, const noh_gl_caps *caps)
{
    const figure *f = &b->planned;
    noh_error error = { NOH_OK, "", 0, 0 };
    int status;
    memset(b, 0, sizeof *b);
    status = figure_plan(&b->planned, desc, caps);
    if (status) {
        return status;
    }
    b->morph.reason = "only clips: for the total, give this pack as --anim of the pack with the mesh";
    if (caps && noh_stage_morph_plan(&f->stage_desc, caps, &f->plan, &b->morph, &error)) {
        status = tool_fail_error(desc->file->path, &error);
    }
    count_segments(b);
    figure_bytes(f, &b->cpu_bytes, &b->gpu_bytes);
    if (!status) status = list_parts(b, caps);
    if (!status) status = find_levels(b, caps);
    if (status) pack_budget_free(b);
    return status;
}

void pack_budget_free(pack_budget *b)
{
    free(b->parts);
    b->parts = NULL;
    figure_plan_free(&b->planned);
}

void pack_budget_name(const pack_budget *b, uint32_t part, char *text, size_t bytes)
{
    const noh_stage_bytes *p = &b->parts[part];
    if (p->kind == NOH_NONE || b->planned.stage_desc.kind_count == 1u) {
        snprintf(text, bytes, "%s", p->what);
    } else {
        snprintf(text, bytes, "%s %u", p->what, p->kind);
    }
}
