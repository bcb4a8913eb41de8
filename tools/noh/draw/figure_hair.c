/* figure_hair.c: the hair of a figure, simulated in its stage. */
#include <string.h>

#include "cli/message.h"
#include "figure.h"

/* The first kind with the joint that carries the hair has it. */
int figure_add_hair(figure *f)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_result result = NOH_OK;
    for (uint32_t k = 0; k < f->stage_desc.kind_count && f->desc.hair && !f->hair.is_there; k++) {
        result = drawn_hair_plan(&f->hair, &f->desc.file->pack, k, f->kinds[k].skeleton, 1, &error);
    }
    if (!f->hair.is_there) {
        return result ? tool_fail_error(f->desc.file->path, &error) : 0;
    }
    noh_kind_desc *kind = &f->kinds[f->hair.desc.kind];
    const uint32_t part = kind->modifier_count;
    f->hair.desc.in_state = 1;
    memcpy(f->hair.desc.wind, f->desc.wind, sizeof f->hair.desc.wind);
    if (part) memcpy(f->hair_parts, kind->modifiers, part * sizeof *kind->modifiers);
    f->hair_parts[part] = noh_actor_hair_modifier(&f->hair.desc);
    kind->modifiers = f->hair_parts;
    kind->modifier_count = part + 1u;
    return 0;
}

void figure_hair_bytes(const figure *f, uint64_t *cpu_bytes, uint64_t *gpu_bytes)
{
    *cpu_bytes = *gpu_bytes = 0;
    if (f->stage_desc.gpu) drawn_hair_bytes(&f->hair, cpu_bytes, gpu_bytes);
}

int figure_open_hair(figure *f)
{
    return f->g ? drawn_hair_open(&f->hair, f->g, &f->g->ledger, f->desc.light != NULL) : 0;
}

void figure_update_hair(figure *f)
{
    drawn_hair_frame(&f->hair, f->stage, 0);
    drawn_hair_update(&f->hair);
}
