/* figure_hair.c: the hair of a figure. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "figure.h"
#include "noh/low_life.h"

int figure_add_hair(figure *f)
{
    const noh_pack *pack = &f->desc.file->pack;
    noh_error error = { NOH_OK, "", 0, 0 };
    f->hair_kind = NOH_NONE;
    if (!f->desc.hair || noh_haircut_open(pack, &f->cut, NULL)) {
        return 0;
    }
    for (uint32_t k = 0; k < f->stage_desc.kind_count && f->hair_kind == NOH_NONE; k++) {
        if (noh_wig_make(&f->cut, pack, f->kinds[k].skeleton, &f->wig, &error) == NOH_OK) f->hair_kind = k;
    }
    if (f->hair_kind == NOH_NONE) {
        return tool_fail_error(f->desc.file->path, &error);
    }
    memcpy(f->wig.wind, f->desc.wind, sizeof f->wig.wind);
    noh_kind_desc *kind = &f->kinds[f->hair_kind];
    f->hair_part = kind->part_count;
    if (f->hair_part) memcpy(f->hair_parts, kind->parts, f->hair_part * sizeof *kind->parts);
    f->hair_parts[f->hair_part] = noh_wig_part(&f->wig);
    kind->parts = f->hair_parts;
    kind->part_count = f->hair_part + 1u;
    return 0;
}

void figure_hair_bytes(const figure *f, uint64_t *cpu_bytes, uint64_t *gpu_bytes)
{
    const int drawn = f->hair_kind != NOH_NONE && f->stage_desc.gpu;
    *cpu_bytes = drawn ? noh_stage_hair_size(&f->cut) : 0;
    *gpu_bytes = drawn ? noh_stage_hair_bytes(&f->cut) : 0;
}

int figure_open_hair(figure *f)
{
    char log[4096] = "";
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_device device;
    if (!f->g || f->hair_kind == NOH_NONE) {
        return 0;
    }
    const size_t bytes = noh_stage_hair_size(&f->cut);
    f->hair_memory = malloc(bytes);
    if (!f->hair_memory) {
        return tool_fail("hair", "out of memory");
    }
    device = (noh_gl_device){ &f->g->gl, &f->g->caps, &f->g->ledger, log, sizeof log };
    if (noh_stage_hair_create(&device, &f->wig, f->hair_memory, bytes, f->desc.light != NULL, 0, &f->hair, &error)) {
        fputs(log, stderr);
        memset(&f->hair, 0, sizeof f->hair);
        return tool_fail_error("hair", &error);
    }
    return 0;
}

int figure_update_hair(figure *f)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    if (!f->hair.gl) {
        return 0;
    }
    return noh_stage_hair_update(&f->hair, f->stage, f->actors[f->hair_kind], f->hair_part, &error)
               ? tool_fail_error(f->desc.file->path, &error)
               : 0;
}
