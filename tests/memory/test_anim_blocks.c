/* Every object of anim/ and character/ opens its block in the same way: NULL and misaligned memory are ARG, one byte
 * too few is MEMORY, `need` is the exact bytes each time, nothing is touched on an error, and nothing past the end
 * ever. */
#include "support/support.h"

#include <stdlib.h>
#include <string.h>

#include "support/clip_set_fixture.h"

#define CANARY 64u

/* What the inits are called with. */
typedef struct blocks {
    scene s;
    noh_character_desc character;
    noh_graph graph;
    noh_graph_node node;
    noh_track_desc clip;
    noh_lod_pools_desc pools;
    uint32_t level, slots;
} blocks;

static void blocks_open(blocks *b)
{
    memset(b, 0, sizeof *b);
    scene_open(&b->s);
    b->character.controller.set = &b->s.set;
    b->character.controller.flags = NOH_CONTROLLER_INERTIAL;
    b->node.param = NOH_GRAPH_NONE;
    b->graph.node_count = b->graph.clip_count = 1;
    b->graph.nodes = &b->node;
    b->graph.clips = &b->clip;
    b->slots = 7;
    b->pools.instance_count = 5;
    b->pools.pool_count = 1;
    b->pools.levels = &b->level;
    b->pools.slot_counts = &b->slots;
}

typedef noh_result (*init_fn)(const blocks *b, void *memory, size_t bytes, noh_error *error);

static noh_result controller(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    noh_controller *c;
    return noh_controller_init(memory, bytes, &b->character.controller, &c, error);
}

static noh_result pose_scratch(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    noh_pose_scratch scratch;
    return noh_pose_scratch_init(memory, bytes, &b->s.set, 1, &scratch, error);
}

static noh_result event_queue(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    noh_event_queue queue;
    (void)b;
    return noh_event_queue_init(memory, bytes, 9, &queue, error);
}

static noh_result graph_state(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    noh_graph_state *state;
    return noh_graph_state_init(memory, bytes, &b->graph, &b->s.set, &state, error);
}

static noh_result graph_scratch(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    noh_graph_scratch scratch;
    return noh_graph_scratch_init(memory, bytes, &b->graph, &b->s.set, &scratch, error);
}

static noh_result character(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    noh_character *ch;
    return noh_character_init(memory, bytes, &b->character, &ch, error);
}

static noh_result character_scratch(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    noh_character_scratch scratch;
    return noh_character_scratch_init(memory, bytes, &b->character, &scratch, error);
}

static noh_result lod_pools(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    noh_lod_pools *pools;
    return noh_lod_pools_init(memory, bytes, &b->pools, &pools, error);
}

static noh_result schedule(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    noh_schedule s;
    (void)b;
    return noh_schedule_init(memory, bytes, 11, &s, error);
}

static noh_result joint_measure(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    static float radius[JOINTS];
    const uint32_t counts[1] = { JOINTS };
    const noh_time_probe probe = { &b->s.set, &b->s.skeleton, radius, NULL, 0 };
    float errors[1];
    return noh_joint_lod_measure(memory, bytes, &probe, POSE, counts, 1, errors, error);
}

static noh_result time_measure(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    static float radius[JOINTS];
    const noh_time_probe probe = { &b->s.set, &b->s.skeleton, radius, NULL, 0 };
    float errors[NOH_UPDATE_RATE_COUNT];
    return noh_time_lod_measure(memory, bytes, &probe, POSE, errors, error);
}

static noh_result points_measure(const blocks *b, void *memory, size_t bytes, noh_error *error)
{
    const noh_time_hold hold = { 1, 1.0f, { 0, 0, 0 } };
    const noh_time_lod_points points = { &hold, 1, 1 };
    const noh_time_probe probe = { &b->s.set, &b->s.skeleton, NULL, NULL, 0 };
    float errors[NOH_UPDATE_RATE_COUNT];
    return noh_time_lod_points_measure(memory, bytes, &probe, &points, POSE, errors, error);
}

static int untouched(const uint8_t *bytes, size_t count)
{
    size_t i = 0;
    while (i < count && bytes[i] == 0xa5) i++;
    return i == count;
}

static void refuse(const blocks *b, init_fn init, void *memory, size_t bytes, noh_result result, size_t need)
{
    noh_error error = { NOH_OK, NULL, 99, 99 };
    assert_int_equal(init(b, memory, bytes, &error), result);
    assert_int_equal(error.result, result);
    assert_non_null(error.what);
    assert_int_equal(error.need, need);
}

static void every_block_opens_in_the_same_way(void **state)
{
    static const init_fn inits[] = { controller,    pose_scratch,  event_queue,       graph_state,
                                     graph_scratch, character,     character_scratch, lod_pools,
                                     schedule,      joint_measure, time_measure,      points_measure };
    (void)state;
    for (size_t i = 0; i < sizeof inits / sizeof *inits; i++) {
        blocks b;
        noh_error error;
        size_t need;
        uint8_t *memory;
        blocks_open(&b);
        assert_int_equal(inits[i](&b, NULL, 0, &error), NOH_ERR_ARG);
        need = (size_t)error.need;
        assert_true(need > 0);
        memory = test_aligned(NULL, need + CANARY);
        memset(memory, 0xa5, need + CANARY);
        refuse(&b, inits[i], NULL, need, NOH_ERR_ARG, need);
        refuse(&b, inits[i], memory, need - 1u, NOH_ERR_MEMORY, need);
        refuse(&b, inits[i], memory, 0, NOH_ERR_MEMORY, need);
        for (size_t shift = 1; shift < NOH_MEMORY_ALIGN; shift++)
            refuse(&b, inits[i], memory + shift, need, NOH_ERR_ARG, need);
        assert_true(untouched(memory, need + CANARY));
        assert_int_equal(inits[i](&b, memory, need, NULL), NOH_OK);
        assert_true(untouched(memory + need, CANARY));
        free(memory);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(every_block_opens_in_the_same_way) };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
