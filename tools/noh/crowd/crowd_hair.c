#include "crowd_hair.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/low_life.h"

int crowd_hair_plan(crowd_hair *h, const pack_file *file, uint32_t kind, uint32_t skeleton, uint32_t actors)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    memset(h, 0, sizeof *h);
    if (noh_haircut_open(&file->pack, &h->cut, NULL)) {
        return 0;
    }
    if (noh_wig_make(&h->cut, &file->pack, skeleton, &h->wig, &error)) {
        return tool_fail_error(file->path, &error);
    }
    h->desc.wig = &h->wig;
    h->desc.kind = kind;
    h->desc.actor_max = actors;
    h->desc.near_max = actors < CROWD_HAIR_NEAR ? actors : CROWD_HAIR_NEAR;
    h->is_there = 1;
    return 0;
}

void crowd_hair_bytes(const crowd_hair *h, uint64_t *cpu_bytes, uint64_t *gpu_bytes)
{
    *cpu_bytes = h->is_there ? noh_wigs_size(&h->desc) + noh_stage_hairs_size(&h->desc) : 0;
    *gpu_bytes = h->is_there ? noh_stage_hairs_bytes(&h->desc) : 0;
}

int crowd_hair_open(crowd_hair *h, gpu *g, noh_gl_ledger *ledger, int lit)
{
    char log[4096] = "";
    const noh_gl_device device = { &g->gl, &g->caps, ledger, log, sizeof log };
    noh_error error = { NOH_OK, "", 0, 0 };
    if (!h->is_there) {
        return 0;
    }
    const size_t bytes = noh_wigs_size(&h->desc), drawn_bytes = noh_stage_hairs_size(&h->desc);
    h->memory = malloc(bytes);
    h->drawn_memory = malloc(drawn_bytes);
    if (!h->memory || !h->drawn_memory) {
        crowd_hair_close(h);
        return tool_fail("hair", "out of memory");
    }
    if (noh_wigs_init(h->memory, bytes, &h->desc, &h->wigs, &error) ||
        noh_stage_hairs_create(&device, h->wigs, h->drawn_memory, drawn_bytes, lit, 0, &h->drawn, &error)) {
        fputs(log, stderr);
        memset(&h->drawn, 0, sizeof h->drawn);
        crowd_hair_close(h);
        return tool_fail_error("hair", &error);
    }
    return 0;
}

void crowd_hair_close(crowd_hair *h)
{
    if (h->drawn.hair.gl) noh_stage_hairs_delete(&h->drawn);
    free(h->memory);
    free(h->drawn_memory);
    memset(h, 0, sizeof *h);
}

void crowd_hair_frame(crowd_hair *h, noh_stage *stage, uint32_t ticks)
{
    if (h->is_there) noh_wigs_frame(h->wigs, stage, ticks);
}

void crowd_hair_update(crowd_hair *h)
{
    if (h->is_there) noh_stage_hairs_update(&h->drawn);
}

void crowd_hair_draw(crowd_hair *h, const noh_stage *stage, uint32_t view)
{
    if (h->is_there) noh_stage_hairs_draw(&h->drawn, stage, view, NOH_PASS_COLOR);
}

void crowd_hair_draw_shadow(crowd_hair *h, const noh_stage *stage, uint32_t view)
{
    if (h->is_there) noh_stage_hairs_draw_shadow(&h->drawn, stage, view);
}
