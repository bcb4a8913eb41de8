/* stage_fixture.h: a cast for the tests of stage/ and stage_gl/: puppets that walk, masks that speak, and tubes that
 * have joints and no clips. All have LOD levels. */
#ifndef NOH_TESTS_SUPPORT_STAGE_FIXTURE_H
#define NOH_TESTS_SUPPORT_STAGE_FIXTURE_H

#include "lod_fixture.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/gl_device.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "platform.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CAST_KINDS 3u
enum { PUPPETS, MASKS, TUBES };
static const uint32_t cast_counts[CAST_KINDS] = { 5, 7, 9 };
#define CAST_ACTORS 21u
#define CAST_STEP (NOH_TICKS_PER_SECOND / 60)

typedef struct cast {
    noh_file files[2];
    noh_pack packs[CAST_KINDS];
    model *tube;
    lod_pack tube_pack;
    noh_kind_desc kinds[CAST_KINDS];
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    void *memory;
} cast;

static inline void cast_map(cast *c, uint32_t which, const char *name)
{
    const char *build = getenv("NOH_BUILD");
    char path[1024];
    noh_error error;
    snprintf(path, sizeof path, "%s/%s", build ? build : "build", name);
    if (noh_file_map(path, &c->files[which], &error) != NOH_OK) fail_msg("%s: %s", path, error.what);
    c->packs[which] = test_open(c->files[which].data, c->files[which].bytes);
}

/* The packs, and a desc of three kinds; nothing is planned. */
static inline void cast_open(cast *c)
{
    const skin_cylinder tube = { 16, 33, 8, 2, 3, 1, 1.5f, 0.2f };
    lod_settings levels;
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    cast_map(c, MASKS, "mask_levels.noh");
    memset(&levels, 0, sizeof levels);
    levels.level_count = 3;
    levels.mode = LOD_FAST;
    c->tube = lod_tube_model(&tube);
    lod_pack_make(c->tube, &levels, 0, &c->tube_pack);
    c->packs[TUBES] = c->tube_pack.pack;
    for (uint32_t i = 0; i < CAST_KINDS; i++) {
        c->kinds[i].mesh = &c->packs[i];
        c->kinds[i].actor_count = cast_counts[i];
    }
    c->kinds[PUPPETS].root_axes = NOH_ROOT_GROUND;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = CAST_KINDS;
}

static inline void cast_close_stage(cast *c)
{
    if (c->stage) noh_stage_delete(c->stage);
    free(c->memory);
    c->stage = NULL;
    c->memory = NULL;
}

static inline void cast_close(cast *c)
{
    cast_close_stage(c);
    lod_pack_free(&c->tube_pack);
    model_free(c->tube);
    noh_file_unmap(&c->files[0]);
    noh_file_unmap(&c->files[1]);
}

/* Plan and make the stage in memory of the exact size. */
static inline void cast_make(cast *c, const noh_gl_device *device)
{
    noh_error error;
    if (noh_stage_plan_make(&c->desc, device ? device->caps : NULL, &c->plan, &error) != NOH_OK) {
        fail_msg("plan: %s", error.what);
    }
    c->memory = test_aligned(NULL, (size_t)c->plan.cpu_bytes);
    if (noh_stage_init(c->memory, (size_t)c->plan.cpu_bytes, device, &c->desc, &c->plan, &c->stage, &error) != NOH_OK) {
        fail_msg("stage: %s", error.what);
    }
}

/* Everybody comes in, in rows, and does what the kind can do. */
static inline void cast_enter(cast *c, noh_actor actors[CAST_ACTORS])
{
    static const char *const clips[CAST_KINDS] = { "walk", "speak", NULL };
    uint32_t count = 0;
    for (uint32_t k = 0; k < c->desc.kind_count; k++) {
        for (uint32_t i = 0; i < c->kinds[k].actor_count; i++) {
            const noh_place place = { { 1.2f * (float)i - 4.0f, 0.0f, -2.5f * (float)k }, { 0, 0, 0, 0 }, 0.0f };
            const noh_play play = { .speed = 60000 + 1500 * (int32_t)i, .start_ticks = 5000 * (int64_t)i };
            noh_error error;
            if (noh_stage_spawn(c->stage, k, &place, &actors[count], &error) != NOH_OK ||
                (clips[k] &&
                 noh_actor_play(c->stage, actors[count], k == MASKS ? 1 : 0, clips[k], &play, &error) != NOH_OK)) {
                fail_msg("actor %u of kind %u: %s", (unsigned)i, (unsigned)k, error.what);
            }
            count++;
        }
    }
}

/* A camera that walks round the cast. */
static inline noh_stage_view cast_view(uint32_t frame, float distance)
{
    static const float middle[3] = { 0.0f, 0.8f, -2.0f };
    noh_stage_view view;
    noh_view_orbit(&view, middle, 0.02f * (float)frame, 0.2f, distance, 640, 360);
    return view;
}

#endif
