/* gl_morph_calibrate.c: measures paths on the driver with the caller's clock. Each path is created, updated with
 * changing weights, and deleted. The shortest update counts, because disturbances only make an update longer. */
#include <string.h>

#include "gl/morph/gl_morph_internal.h"
#include "core/base/assert_internal.h"
#include "noh/base.h"
#include "noh/low_core.h"
#include "noh/gl_device.h"
#include "noh/noh_gl.h"
#include "noh/low_gl.h"

static const noh_morph_path tried[] = { NOH_MORPH_GATHER, NOH_MORPH_MRT, NOH_MORPH_CPU };
#define TRIED (sizeof tried / sizeof tried[0])

static noh_result plan_of(const noh_gl_morph_desc *desc, noh_morph_path path, const noh_gl_caps *caps,
                          noh_gl_morph_plan *plan, noh_error *error)
{
    noh_gl_morph_desc d = *desc;
    d.path = path;
    return noh_gl_morph_plan_make(&d, caps, plan, error);
}

noh_result noh_gl_morph_calibrate_size(const noh_gl_morph_desc *desc, const noh_gl_caps *caps, uint64_t *bytes,
                                       noh_error *error)
{
    noh_gl_morph_plan plan;
    noh_result result;
    NOH_ASSERT(desc && caps && bytes);
    result = plan_of(desc, NOH_MORPH_CPU, caps, &plan, error); /* it runs everywhere */
    *bytes = 0;
    for (size_t i = 0; i < TRIED && !result; i++) {
        if (!plan_of(desc, tried[i], caps, &plan, NULL) && plan.cpu_bytes > *bytes) *bytes = plan.cpu_bytes;
    }
    return result;
}

/* Set the accumulator's weights for a round: targets at regular intervals are active, different ones in each round. */
static void change_weights(noh_gl_morph *m, float share, uint32_t round)
{
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        const uint32_t count = m->meshes[m->instance_mesh[i]].mesh.header->target_count;
        const uint32_t active = (uint32_t)(share * (float)count + 0.5f);
        float *weights = m->weights + noh_gl_morph_first_weight(m, i);
        memset(weights, 0, sizeof *weights * count);
        for (uint32_t k = 0; k < active; k++) {
            weights[(round + (uint32_t)((uint64_t)k * count / active)) % count] = 0.25f + 0.0625f * (float)(round % 8u);
        }
    }
    memset(m->dirty, 1, m->plan.instance_count);
    m->dirty_count = m->plan.instance_count;
}

static void measure(noh_gl_morph *m, float share, noh_gl_clock clock, void *user, uint64_t budget_ns,
                    noh_gl_morph_times *times)
{
    uint64_t from, to, start, least = UINT64_MAX;
    uint32_t rounds = 0;
    change_weights(m, share, 0);
    noh_gl_morph_update(m, NULL); /* clears all tiles, and drivers finish compiling at the first draw */
    start = from = clock(user);
    do {
        change_weights(m, share, ++rounds);
        noh_gl_morph_update(m, NULL);
        to = clock(user);
        least = to - from < least ? to - from : least;
        from = to;
    } while (to - start < budget_ns && rounds < 1000u);
    times->ns[m->plan.path] = least ? least : 1u; /* 0 means not tried */
    times->rounds[m->plan.path] = rounds;
}

noh_result noh_gl_morph_calibrate(void *memory, size_t bytes, const noh_gl_device *device,
                                  const noh_gl_morph_desc *desc, noh_gl_clock clock, void *user, uint64_t budget_ns,
                                  noh_gl_morph_times *times, noh_error *error)
{
    NOH_ASSERT(device && desc && clock && times);
    const float share = desc->expected_active > 0.0f ? desc->expected_active : 0.5f;
    uint64_t need;
    noh_arena arena;
    noh_result result;
    result = noh_gl_morph_calibrate_size(desc, device->caps, &need, error);
    if (!result) result = noh_arena_open(&arena, memory, bytes, (size_t)need, error);
    memset(times, 0, sizeof *times);
    for (size_t i = 0; i < TRIED && !result; i++) {
        noh_gl_morph_desc d = *desc;
        noh_gl_morph_plan plan;
        noh_gl_morph *m;
        d.path = tried[i];
        if (noh_gl_morph_plan_make(&d, device->caps, &plan, NULL)) continue;
        result = noh_gl_morph_init(memory, bytes, device, &d, &m, error);
        if (result) break;
        measure(m, share, clock, user, budget_ns / TRIED, times);
        noh_gl_morph_delete(m);
        if (!times->path || times->ns[d.path] < times->ns[times->path]) times->path = d.path;
    }
    return result;
}
