/* bench_weights.c: weights that change every frame, the same on every machine. */
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "deform/morph/morph_internal.h"

/* Target t is active in a frame when it is one of `active` evenly spread ones; the pattern
 * shifts by one each frame, so that large and small targets are all used. */
static void activate(const bench_weights *w, uint32_t frame)
{
    float *weights = w->frames + (size_t)frame * w->target_count;
    for (uint32_t k = 0; k < w->active; k++) {
        uint32_t t = (frame + (uint32_t)((uint64_t)k * w->target_count / w->active)) % w->target_count;
        weights[t] = 0.1f + 0.8f * (float)((t * 7u + frame * 5u) % 31u) / 30.0f;
    }
}

int bench_weights_open(bench_weights *w, const noh_mesh *mesh, uint32_t active)
{
    memset(w, 0, sizeof *w);
    w->target_count = mesh->header->target_count;
    w->active = active < w->target_count ? active : w->target_count;
    w->frames = calloc((size_t)BENCH_FRAMES * w->target_count + 1u, sizeof *w->frames);
    if (!w->frames) {
        return tool_fail("bench", "out of memory");
    }
    for (uint32_t f = 0; f < BENCH_FRAMES; f++) {
        noh_morph_cost cost;
        activate(w, f);
        cost = noh_morph_cost_of(mesh, bench_weights_of(w, f));
        w->pairs += (double)cost.pairs / BENCH_FRAMES;
        w->texels += (double)cost.texels / BENCH_FRAMES;
    }
    return 0;
}

void bench_weights_close(bench_weights *w)
{
    free(w->frames);
    memset(w, 0, sizeof *w);
}

const float *bench_weights_of(const bench_weights *w, uint32_t frame)
{
    return w->frames + (size_t)(frame % BENCH_FRAMES) * w->target_count;
}

void bench_target_deltas(const noh_mesh *mesh, uint32_t target, float *weights, const noh_morph_layers *layers)
{
    memset(layers->position, 0, noh_morph_layers_size(mesh));
    memset(weights, 0, sizeof *weights * mesh->header->target_count);
    weights[target] = 1.0f;
    noh_morph_accumulate_scalar(mesh, weights, layers);
}
