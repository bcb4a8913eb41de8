#include "drawn_hair.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "noh/low_life.h"

noh_result drawn_hair_plan(drawn_hair *h, const noh_pack *pack, uint32_t kind, uint32_t skeleton, uint32_t actors,
                           noh_error *error)
{
    memset(h, 0, sizeof *h);
    if (noh_haircut_open(pack, &h->cut, NULL)) {
        return NOH_OK;
    }
    const noh_result result = noh_actor_hair_desc_make(&h->cut, pack, skeleton, &h->desc, error);
    h->desc.kind = kind;
    h->desc.head_max = actors;
    h->desc.near_max = actors < DRAWN_HAIR_NEAR ? actors : DRAWN_HAIR_NEAR;
    h->is_there = !result;
    return result;
}

void drawn_hair_bytes(const drawn_hair *h, uint64_t *cpu_bytes, uint64_t *gpu_bytes)
{
    *cpu_bytes = h->is_there ? noh_actor_hair_size(&h->desc) + noh_stage_hair_size(&h->desc) : 0;
    *gpu_bytes = h->is_there ? noh_stage_hair_bytes(&h->desc) : 0;
}

int drawn_hair_open(drawn_hair *h, gpu *g, noh_gl_ledger *ledger, int lit)
{
    char log[4096] = "";
    const noh_gl_device device = { &g->gl, &g->caps, ledger, log, sizeof log };
    noh_error error = { NOH_OK, "", 0, 0 };
    if (!h->is_there) {
        return 0;
    }
    const size_t bytes = noh_actor_hair_size(&h->desc), drawn_bytes = noh_stage_hair_size(&h->desc);
    h->memory = malloc(bytes);
    h->drawn_memory = malloc(drawn_bytes);
    if (!h->memory || !h->drawn_memory) {
        drawn_hair_close(h);
        return tool_fail("hair", "out of memory");
    }
    if (noh_actor_hair_init(h->memory, bytes, &h->desc, &h->heads, &error) ||
        noh_stage_hair_create(&device, h->heads, h->drawn_memory, drawn_bytes, lit, 0, &h->drawn, &error)) {
        fputs(log, stderr);
        drawn_hair_close(h);
        return tool_fail_error("hair", &error);
    }
    return 0;
}

noh_result drawn_hair_restore(drawn_hair *h, char *log, size_t log_bytes, noh_error *error)
{
    return h->heads ? noh_stage_hair_restore(&h->drawn, log, log_bytes, error) : NOH_OK;
}

void drawn_hair_close(drawn_hair *h)
{
    noh_stage_hair_delete(&h->drawn);
    free(h->memory);
    free(h->drawn_memory);
    memset(h, 0, sizeof *h);
}

void drawn_hair_frame(drawn_hair *h, noh_stage *stage, uint32_t ticks)
{
    if (h->heads) noh_actor_hair_frame(h->heads, stage, ticks);
}

void drawn_hair_update(drawn_hair *h)
{
    if (h->heads) noh_stage_hair_update(&h->drawn);
}

void drawn_hair_draw(drawn_hair *h, const noh_stage *stage, uint32_t view, noh_pass pass)
{
    if (h->heads) noh_stage_hair_draw(&h->drawn, stage, view, pass);
}

void drawn_hair_draw_shadow(drawn_hair *h, const noh_stage *stage, uint32_t view)
{
    if (h->heads) noh_stage_hair_draw_shadow(&h->drawn, stage, view);
}
