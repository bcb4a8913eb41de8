/* The puppet's animation graph, played by names for ten seconds through the reader: states, callback keys, finite
 * poses, equal bits after a save and restore.
 *
 * The pack is $NOH_BUILD/demo/puppet.noh, which `make check` makes. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file/pack_file.h"
#include "motion/graph/graph_internal.h"
#include "motion/graph/graph_pack_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"

#define FRAME 800u /* ticks: 60 Hz */
#define FRAMES 600u

static pack_file file;
static noh_clip_bank *bank;
static noh_graph_pack *made;

static int set_up(void **state)
{
    char path[4096];
    const char *build = getenv("NOH_BUILD");
    noh_clip_bank_desc desc;
    noh_graph_pack_desc graph;
    size_t bytes;
    (void)state;
    snprintf(path, sizeof path, "%s/demo/puppet.noh", build ? build : "build");
    if (pack_file_open(&file, path)) return 1;
    memset(&desc, 0, sizeof desc);
    memset(&graph, 0, sizeof graph);
    desc.clips = &file.pack;
    desc.track_count = 7;
    bank = test_clip_bank(&desc);
    graph.pack = &file.pack;
    graph.graph = noh_pack_graph_find(&file.pack, "puppet");
    graph.set = &bank->clips;
    bytes = noh_graph_pack_size(&graph, NULL);
    if (noh_graph_pack_init(test_aligned(NULL, bytes), bytes, &graph, &made, NULL)) return 1;
    print_message("# %u nodes: the graph %zu bytes, an instance %zu\n", made->graph.node_count, bytes,
                  noh_graph_state_size(&made->graph, &made->clips));
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(made);
    free(bank);
    pack_file_close(&file);
    return 0;
}

typedef struct play {
    noh_graph_state *state;
    noh_graph_scratch scratch;
    void *scratch_memory;
    noh_transform *pose;
    float *floats;
    uint32_t steps, bows, stamps; /* keys passed */
} play;

static play open_play(void)
{
    const size_t bytes = noh_graph_state_size(&made->graph, &made->clips),
                 scratch_bytes = noh_graph_scratch_size(&made->graph, &made->clips);
    play p;
    memset(&p, 0, sizeof p);
    p.scratch_memory = test_aligned(NULL, scratch_bytes);
    p.pose = test_zeros(made->clips.joint_count * sizeof *p.pose);
    p.floats = test_zeros(made->clips.float_count * sizeof *p.floats);
    assert_int_equal(noh_graph_state_init(test_aligned(NULL, bytes), bytes, &made->graph, &made->clips, &p.state, NULL),
                     NOH_OK);
    assert_int_equal(
        noh_graph_scratch_init(p.scratch_memory, scratch_bytes, &made->graph, &made->clips, &p.scratch, NULL), NOH_OK);
    return p;
}

static void close_play(play *p)
{
    free(p->state);
    free(p->scratch_memory);
    free(p->pose);
    free(p->floats);
}

static void on_event(void *user, const noh_event *e)
{
    play *p = user;
    /* both walks keep time, also at weight 0; the one that is seen is heard */
    if (e->weight > 0.5f &&
        (e->key->name_hash == noh_hash_name("foot_left") || e->key->name_hash == noh_hash_name("foot_right"))) {
        p->steps++;
    }
    p->bows += e->key->name_hash == noh_hash_name("bow");
    p->stamps += e->key->name_hash == noh_hash_name("stamp");
}

static void set(play *p, const char *name, float value)
{
    assert_int_equal(noh_graph_pack_set_param(made, p->state, noh_graph_pack_find_param(made, name), value), NOH_OK);
}

static void act(play *p, const char *value)
{
    const uint32_t param = noh_graph_pack_find_param(made, "act");
    set(p, "act", (float)noh_graph_pack_find_value(made, param, value));
}

static const char *state_of(const play *p, const char *machine)
{
    const uint32_t m = noh_graph_pack_find_machine(made, machine);
    return noh_graph_pack_state_name(made, m, noh_graph_machine_state(p->state, m));
}

/* What happens in the ten seconds, by frame. */
static void direct(play *p, uint32_t frame)
{
    if (frame == 60) set(p, "speed", 0.5f);
    if (frame == 150) set(p, "speed", 0.8f);
    if (frame == 210) act(p, "dance");
    if (frame == 260) act(p, "look_round");
    if (frame == 270) set(p, "nod", 1.0f);
    if (frame == 300) act(p, "calm");
    if (frame == 310) set(p, "speed", 0.0f);
    if (frame == 320) set(p, "bow", 1.0f);
}

static void frame_of(play *p, uint32_t frame)
{
    direct(p, frame);
    noh_clip_cache_begin_frame(bank->cache);
    (void)noh_graph_step(p->state, &made->graph, &made->clips, FRAME, on_event, p);
    (void)noh_clip_bank_prefetch(bank, noh_graph_controller(p->state), 4000);
    noh_clip_cache_work(bank->cache, 10000);
    noh_graph_pose(p->state, &made->graph, &made->clips, &p->scratch, p->pose, p->floats);
}

static void assert_finite(const play *p)
{
    const float *values = (const float *)(const void *)p->pose;
    for (uint32_t j = 0; j < made->clips.joint_count; j++) {
        const float *q = p->pose[j].rotation;
        const float square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        assert_true(fabsf(square - 1.0f) < 1e-3f);
    }
    for (size_t i = 0; i < made->clips.joint_count * sizeof *p->pose / sizeof *values; i++) {
        assert_true(isfinite(values[i]) && fabsf(values[i]) < 100.0f);
    }
    for (uint32_t i = 0; i < made->clips.float_count; i++) assert_true(isfinite(p->floats[i]));
}

static void the_puppet_acts_by_names(void **state)
{
    play p = open_play();
    (void)state;
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        frame_of(&p, frame);
        assert_finite(&p);
        if (frame < 60) assert_int_equal(p.steps, 0);
        if (frame == 205) assert_true(p.steps >= 4);
        if (frame == 255) assert_string_equal(state_of(&p, "acts"), "dance");
        if (frame == 290) assert_string_equal(state_of(&p, "acts"), "look_round");
        if (frame == 290) assert_string_equal(state_of(&p, "nods"), "nodding");
        if (frame == 300) assert_int_equal(p.bows, 0);
        if (frame == 319) assert_int_equal(p.bows, 1); /* of the nod */
        if (frame == 420) assert_string_equal(state_of(&p, "bows"), "bowing");
        if (frame == 599) assert_string_equal(state_of(&p, "acts"), "paces");
    }
    print_message("# in 10 s: %u steps, %u bows\n", p.steps, p.bows);
    assert_string_equal(state_of(&p, "bows"), "nods"); /* what lies below: the bow is over */
    assert_string_equal(state_of(&p, "nods"), "acts");
    assert_int_equal(p.bows, 2); /* and of the bow: the same clip */
    close_play(&p);
}

/* A nod moves neck and head, and nothing else. */
static void a_nod_moves_the_head_alone(void **state)
{
    play nods = open_play(), still = open_play();
    uint32_t moved = 0;
    (void)state;
    set(&nods, "nod", 1.0f);
    for (uint32_t i = 0; i < 50; i++) {
        noh_graph_step(nods.state, &made->graph, &made->clips, FRAME, NULL, NULL);
        noh_graph_step(still.state, &made->graph, &made->clips, FRAME, NULL, NULL);
    }
    noh_graph_pose(nods.state, &made->graph, &made->clips, &nods.scratch, nods.pose, nods.floats);
    noh_graph_pose(still.state, &made->graph, &made->clips, &still.scratch, still.pose, still.floats);
    for (uint32_t j = 0; j < made->clips.joint_count; j++) {
        const char *name = noh_pack_joint_name(&file.pack, 0, j);
        const int above = !strcmp(name, "neck") || !strcmp(name, "head") || !strcmp(name, "jaw");
        const float *a = nods.pose[j].rotation, *b = still.pose[j].rotation;
        const float dot = fabsf(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
        if (!above) assert_true(dot > 1.0f - 1e-6f);
        moved += above && dot < 1.0f - 1e-4f;
    }
    assert_true(moved > 0);
    close_play(&nods);
    close_play(&still);
}

static void a_saved_puppet_goes_on_with_the_same_bits(void **state)
{
    play p = open_play();
    const size_t pose_bytes = made->clips.joint_count * sizeof *p.pose,
                 float_bytes = made->clips.float_count * sizeof *p.floats;
    uint8_t *saved = test_aligned(NULL, p.state->bytes);
    uint8_t *poses = test_zeros(FRAMES * (pose_bytes + float_bytes));
    (void)state;
    for (uint32_t run = 0; run < 2; run++) {
        for (uint32_t frame = run ? 215 : 0; frame < FRAMES; frame++) {
            uint8_t *kept = poses + frame * (pose_bytes + float_bytes);
            if (frame == 215 && !run) memcpy(saved, p.state, p.state->bytes); /* in a fade */
            if (frame == 215 && run) memcpy(p.state, saved, p.state->bytes);
            frame_of(&p, frame);
            if (!run) memcpy(kept, p.pose, pose_bytes);
            if (!run) memcpy(kept + pose_bytes, p.floats, float_bytes);
            if (run) assert_memory_equal(kept, p.pose, pose_bytes);
            if (run) assert_memory_equal(kept + pose_bytes, p.floats, float_bytes);
        }
    }
    free(poses);
    free(saved);
    close_play(&p);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_puppet_acts_by_names),
    cmocka_unit_test(a_nod_moves_the_head_alone),
    cmocka_unit_test(a_saved_puppet_goes_on_with_the_same_bits),
};

TEST_MAIN(tests, set_up, tear_down)
