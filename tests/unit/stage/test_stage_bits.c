/* A stage has the same bits on every processor: the states of a show, saved and put back in the middle, are hashed
 * frame by frame. The build for this machine writes the hashes next to its packs; builds for other processors (make
 * cross) read the same packs, and compare. */
#include "support/look_part.h"
#include "support/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "platform.h"

#define FRAMES 160u
#define PUPPETS 3u
#define MASKS 3u
#define FRAME_TICKS (NOH_TICKS_PER_SECOND / 60)

#if defined(__x86_64__)
#define WRITES 1
#else
#define WRITES 0
#endif

typedef struct show {
    noh_file files[2];
    noh_pack packs[2];
    noh_kind_desc kinds[2];
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    void *memory;
    look_joint joint;
    noh_modifier gaze;
} show;

static void path_of(const char *name, char path[1024])
{
    const char *build = getenv("NOH_BUILD");
    snprintf(path, 1024, "%s/%s", build ? build : "build", name);
}

static void open_show(show *s)
{
    static const char *const names[2] = { "demo/puppet_levels.noh", "mask_levels.noh" };
    noh_error error;
    memset(s, 0, sizeof *s);
    for (int i = 0; i < 2; i++) {
        char path[1024];
        path_of(names[i], path);
        if (noh_file_map(path, &s->files[i], NULL) != NOH_OK) test_skip("no %s: `make check` makes it", path);
        s->packs[i] = test_open(s->files[i].data, s->files[i].bytes);
        s->kinds[i].mesh = &s->packs[i];
    }
    s->kinds[0].actor_count = PUPPETS;
    s->kinds[0].root_axes = NOH_ROOT_GROUND;
    s->kinds[0].inertia = 1;
    s->kinds[0].graphs = noh_graph_module("moves");
    s->joint = look_joint_of(&s->packs[0], "head");
    s->gaze.modify = look_modify;
    s->gaze.check = look_check;
    s->gaze.user = &s->joint;
    s->gaze.state_bytes = sizeof(look_state);
    s->kinds[0].modifiers = &s->gaze;
    s->kinds[0].modifier_count = 1;
    s->kinds[1].actor_count = MASKS;
    s->desc.kinds = s->kinds;
    s->desc.kind_count = 2;
    s->desc.job_count = 2;
    if (noh_stage_plan_make(&s->desc, NULL, &s->plan, &error) != NOH_OK) fail_msg("%s", error.what);
    s->memory = test_aligned(NULL, (size_t)s->plan.cpu_bytes);
    if (noh_stage_init(s->memory, (size_t)s->plan.cpu_bytes, NULL, &s->desc, &s->plan, &s->stage, &error) != NOH_OK) {
        fail_msg("%s", error.what);
    }
}

static void close_show(show *s)
{
    free(s->memory);
    noh_file_unmap(&s->files[0]);
    noh_file_unmap(&s->files[1]);
}

static void enter(show *s)
{
    for (uint32_t i = 0; i < PUPPETS + MASKS; i++) {
        const uint32_t kind = i >= PUPPETS;
        const noh_place place = { { 1.3f * (float)i - 3.0f, 0.0f, -0.7f * (float)i }, { 0, 0.3f, 0, 0.9f }, 1.1f };
        const noh_play play = { .speed = 50000 + 7000 * (int32_t)i, .start_ticks = 9001 * (int64_t)i };
        noh_actor actor;
        assert_int_equal(noh_stage_spawn(s->stage, kind, &place, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(s->stage, actor, kind, kind ? "speak" : "walk", &play, NULL), NOH_OK);
    }
}

static void frames(show *s, uint32_t first, uint32_t end, uint64_t *hashes)
{
    static const float middle[3] = { 0.0f, 0.8f, -1.0f };
    const noh_play leap = { .fade_ticks = 9000, .flags = NOH_PLAY_INERTIA };
    for (uint32_t f = first; f < end; f++) {
        noh_stage_view view;
        const noh_actor actor = noh_stage_actor_at(s->stage, f / 16u % PUPPETS);
        if (f % 16u == 7u)
            (void)noh_actor_play(s->stage, actor, 0, f % 32u == 7u ? "dance" : "bow", f % 48u == 7u ? NULL : &leap,
                                 NULL);
        if (f % 40u == 10u)
            (void)noh_actor_play_graph(s->stage, actor, 0, "moves", f % 80u == 10u ? NULL : &leap, NULL);
        if (f % 8u == 2u) (void)noh_actor_set_parameter(s->stage, actor, f / 8u % 4u, 0.01f * (float)f, NULL);
        if (f % 16u == 5u) {
            look_state *gaze = noh_actor_modifier(s->stage, actor, 0);
            gaze->target[0] = 0.1f * (float)(f % 50u);
            gaze->target[1] = 1.5f;
            gaze->wanted = 1.0f;
        }
        if (f % 16u == 3u) (void)noh_actor_hold_float(s->stage, actor, f % 20u, 0.01f * (float)f, 0.5f, NULL);
        noh_view_orbit(&view, middle, 0.05f * (float)f, 0.3f, 3.0f + 0.2f * (float)(f % 80u), 640, 360);
        assert_int_equal(noh_stage_step(s->stage, FRAME_TICKS + f % 7u, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame_between(s->stage, &view, 1, f % 2u ? 1.0f : 0.01f * (float)(f % 100u), NULL),
                         NOH_OK);
        assert_int_equal(noh_stage_frame_end(s->stage, NULL), NOH_OK);
        hashes[f] = noh_stage_hash(s->stage);
    }
}

static void every_processor_has_the_same_bits(void **state)
{
    static uint64_t hashes[FRAMES], again[FRAMES], others[FRAMES];
    char path[1024];
    uint8_t *saved;
    size_t bytes, count;
    FILE *file;
    show s;
    (void)state;
    open_show(&s);
    enter(&s);
    frames(&s, 0, FRAMES / 2u, hashes);
    saved = test_aligned(noh_stage_state(s.stage, &bytes), (size_t)s.plan.state_bytes);
    frames(&s, FRAMES / 2u, FRAMES, hashes);
    assert_int_equal(noh_stage_set_state(s.stage, saved, bytes, NULL), NOH_OK);
    frames(&s, FRAMES / 2u, FRAMES, again);
    assert_memory_equal(hashes + FRAMES / 2u, again + FRAMES / 2u, sizeof hashes / 2u);
    free(saved);
    close_show(&s);
    path_of("stage_bits", path);
    file = fopen(path, WRITES ? "wb" : "rb");
    if (!file) test_skip("no %s: `make check` on x86-64 writes it", path);
    count = WRITES ? fwrite(hashes, sizeof *hashes, FRAMES, file) : fread(others, sizeof *others, FRAMES, file);
    fclose(file);
    assert_int_equal(count, FRAMES);
    for (uint32_t f = 0; f < FRAMES && !WRITES; f++) {
        if (hashes[f] != others[f]) fail_msg("the state differs from x86-64 from frame %u on", (unsigned)f);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(every_processor_has_the_same_bits) };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
