/* test_inits.c: every function that builds an object in the caller's memory refuses the same memory in the same way:
 * NULL and misaligned are ARG, too little is MEMORY, `need` is what its _size function says, and nothing is written.
 * With exactly `need` bytes it succeeds and stays inside them. */
#include "support/set_fixture.h"

#include "draw/load.h"

/* What the inits below build from; filled in order, each from the ones above. */
typedef struct subject {
    set_fixture clips;
    noh_clip_bank_desc bank_desc;
    noh_clip_bank *bank;
    noh_skeleton skeleton;
    noh_clip_desc clip_desc;
    noh_clip *clip;
    noh_clip_cache_desc cache_desc;
    const noh_clip *cache_clips[1];
    noh_clip_cache *cache;
    noh_graph graph;
    noh_graph_node node;
    noh_track_desc graph_clip;
    noh_controller_desc controller_desc;
    noh_character_desc character_desc;
    noh_lod_pools_desc pools_desc;
    uint32_t pool_levels[1], pool_slots[1];
    noh_lod_pack_desc lod_desc;
    noh_time_probe probe;
    float radius[8];
    noh_time_hold hold;
    noh_time_lod_points points;
    uint8_t *mesh_bytes;
    noh_pack mesh_pack;
    noh_mesh mesh;
    gpu gl;
    noh_gl_ledger ledger;
    noh_gl_device device;
    noh_gl_morph_desc morph_desc;
    noh_gl_skin_desc skin_desc;
    float error_m[NOH_LOD_LEVELS_MAX + 8u];
} subject;

static subject s;

/* One function: its size, and the call with an output that it must leave alone. */
typedef struct maker {
    const char *name;
    size_t (*size)(void);
    noh_result (*make)(void *memory, size_t bytes, noh_error *error);
    void (*drop)(void);
} maker;

/* The output of the call under test; a failure leaves its bytes. */
static union {
    uint8_t bytes[1024];
    uint64_t align;
} out;
#define OUT(type) ((type *)(void *)&out)

#define MAKER(name, size_of, call)                                     \
    static size_t name##_bytes(void)                                   \
    {                                                                  \
        return size_of;                                                \
    }                                                                  \
    static noh_result name##_make(void *m, size_t bytes, noh_error *e) \
    {                                                                  \
        return call;                                                   \
    }

static size_t morph_bytes(void)
{
    noh_gl_morph_plan plan;
    assert_int_equal(noh_gl_morph_plan_make(&s.morph_desc, &s.gl.caps, &plan, NULL), NOH_OK);
    return (size_t)plan.cpu_bytes;
}
static size_t skin_bytes(void)
{
    noh_gl_skin_plan plan;
    assert_int_equal(noh_gl_skin_plan_make(&s.skin_desc, &s.gl.caps, &plan, NULL), NOH_OK);
    return (size_t)plan.cpu_bytes;
}

MAKER(clip, noh_clip_size(&s.clip_desc, NULL), noh_clip_init(m, bytes, &s.clip_desc, OUT(noh_clip *), e))
MAKER(cache, noh_clip_cache_size(&s.cache_desc, NULL),
      noh_clip_cache_init(m, bytes, &s.cache_desc, OUT(noh_clip_cache *), e))
MAKER(view, noh_clip_view_size(s.cache), noh_clip_view_init(m, bytes, s.cache, OUT(noh_clip_view *), e))
MAKER(bank, noh_clip_bank_size(&s.bank_desc, NULL), noh_clip_bank_init(m, bytes, &s.bank_desc, OUT(noh_clip_bank *), e))
MAKER(bank_view, noh_clip_bank_view_size(s.bank),
      noh_clip_bank_view_init(m, bytes, s.bank, OUT(noh_clip_bank_view *), e))
MAKER(controller, noh_controller_size(&s.controller_desc),
      noh_controller_init(m, bytes, &s.controller_desc, OUT(noh_controller *), e))
MAKER(pose_scratch, noh_pose_scratch_size(&s.bank->clips, 1),
      noh_pose_scratch_init(m, bytes, &s.bank->clips, 1, OUT(noh_pose_scratch), e))
MAKER(queue, noh_event_queue_size(5), noh_event_queue_init(m, bytes, 5, OUT(noh_event_queue), e))
MAKER(character, noh_character_size(&s.character_desc),
      noh_character_init(m, bytes, &s.character_desc, OUT(noh_character *), e))
MAKER(character_scratch, noh_character_scratch_size(&s.character_desc),
      noh_character_scratch_init(m, bytes, &s.character_desc, OUT(noh_character_scratch), e))
MAKER(schedule, noh_schedule_size(5), noh_schedule_init(m, bytes, 5, OUT(noh_schedule), e))
MAKER(pools, noh_lod_pools_size(&s.pools_desc), noh_lod_pools_init(m, bytes, &s.pools_desc, OUT(noh_lod_pools *), e))
MAKER(lod_pack, noh_lod_pack_size(&s.lod_desc), noh_lod_pack_init(m, bytes, &s.lod_desc, OUT(noh_lod_pack), e))
MAKER(graph_state, noh_graph_state_size(&s.graph, &s.bank->clips),
      noh_graph_state_init(m, bytes, &s.graph, &s.bank->clips, OUT(noh_graph_state *), e))
MAKER(graph_scratch, noh_graph_scratch_size(&s.graph, &s.bank->clips),
      noh_graph_scratch_init(m, bytes, &s.graph, &s.bank->clips, OUT(noh_graph_scratch), e))
MAKER(layers, noh_morph_layers_size(&s.mesh), noh_morph_layers_init(m, bytes, &s.mesh, OUT(noh_morph_layers), e))
MAKER(time_lod, noh_time_lod_measure_size(&s.probe), noh_time_lod_measure(m, bytes, &s.probe, 0, OUT(float), e))
MAKER(time_points, noh_time_lod_points_size(&s.probe),
      noh_time_lod_points_measure(m, bytes, &s.probe, &s.points, 0, OUT(float), e))
static const uint32_t joint_counts[2] = { 3, 1 };
MAKER(joint_lod, noh_joint_lod_measure_size(&s.probe),
      noh_joint_lod_measure(m, bytes, &s.probe, 0, joint_counts, 2, OUT(float), e))
static noh_result morph_make(void *m, size_t bytes, noh_error *e)
{
    return noh_gl_morph_init(m, bytes, &s.device, &s.morph_desc, OUT(noh_gl_morph *), e);
}
static noh_result skin_make(void *m, size_t bytes, noh_error *e)
{
    return noh_gl_skin_init(m, bytes, &s.device, &s.skin_desc, OUT(noh_gl_skin *), e);
}
static void morph_drop(void)
{
    noh_gl_morph_delete(*OUT(noh_gl_morph *));
}
static void skin_drop(void)
{
    noh_gl_skin_delete(*OUT(noh_gl_skin *));
}

#define ROW(name)                              \
    {                                          \
#name, name##_bytes, name##_make, NULL \
    }
static const maker makers[] = {
    ROW(clip),
    ROW(cache),
    ROW(view),
    ROW(bank),
    ROW(bank_view),
    ROW(controller),
    ROW(pose_scratch),
    ROW(queue),
    ROW(character),
    ROW(character_scratch),
    ROW(schedule),
    ROW(pools),
    ROW(lod_pack),
    ROW(graph_state),
    ROW(graph_scratch),
    ROW(layers),
    ROW(time_lod),
    ROW(time_points),
    ROW(joint_lod),
    { "gl_morph", morph_bytes, morph_make, morph_drop },
    { "gl_skin", skin_bytes, skin_make, skin_drop },
};

/* ---- set up ---- */

static void make_clips(void)
{
    const uint32_t frames[2] = { 40, 25 };
    noh_pack_clip clip;
    s.clips = set_fixture_make(3, 2, frames);
    s.bank_desc.clips = &s.clips.pack;
    s.bank = test_clip_bank(&s.bank_desc);
    assert_int_equal(noh_pack_skeleton_at(&s.clips.pack, 0, &s.skeleton, NULL, NULL), NOH_OK);
    assert_int_equal(noh_pack_clip_at(&s.clips.pack, 0, &clip, NULL), NOH_OK);
    s.clip_desc.bytes = clip.bytes;
    s.clip_desc.byte_count = clip.header->clip_bytes;
    s.clip_desc.bind = s.skeleton.bind_pose;
    s.clip_desc.joint_count = s.skeleton.joint_count;
    s.clip = test_zeros(noh_clip_size(&s.clip_desc, NULL) + 64u);
    s.cache_clips[0] = noh_clip_cache_clip(s.bank->cache, 0);
    s.cache_desc.clips = s.cache_clips;
    s.cache_desc.clip_count = 1;
    s.cache = s.bank->cache;
}

static void make_players(void)
{
    s.controller_desc.set = &s.bank->clips;
    s.controller_desc.flags = NOH_CONTROLLER_INERTIAL;
    s.character_desc.controller = s.controller_desc;
    s.node.kind = NOH_NODE_CLIP;
    s.graph.node_count = s.graph.clip_count = 1;
    s.graph.nodes = &s.node;
    s.graph.clips = &s.graph_clip;
    s.pool_slots[0] = 4;
    s.pools_desc.instance_count = 4;
    s.pools_desc.pool_count = 1;
    s.pools_desc.levels = s.pool_levels;
    s.pools_desc.slot_counts = s.pool_slots;
    s.lod_desc.set = s.bank;
    s.lod_desc.set_desc = &s.bank_desc;
    s.probe.set = &s.bank->clips;
    s.probe.skeleton = &s.skeleton;
    s.probe.joint_radius_m = s.radius;
    s.hold.weight = 1.0f;
    s.points.holds = &s.hold;
    s.points.point_count = s.points.holds_per_point = 1;
}

static int set_up(void **state)
{
    const test_model_desc desc = { 1, 5, 3, 0, 4 };
    size_t count;
    (void)state;
    make_clips();
    make_players();
    s.mesh_bytes = test_pack(&desc, &count);
    s.mesh_pack = test_open(s.mesh_bytes, count);
    s.mesh = test_mesh(&s.mesh_pack, 0);
    if (gpu_open(&s.gl, "null")) return 1;
    s.device.api = &s.gl.gl;
    s.device.caps = &s.gl.caps;
    s.device.ledger = &s.ledger;
    s.morph_desc.meshes = s.skin_desc.meshes = &s.mesh;
    s.morph_desc.mesh_count = s.skin_desc.mesh_count = 1;
    s.morph_desc.path = NOH_MORPH_CPU;
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    gpu_close(&s.gl);
    free(s.mesh_bytes);
    free(s.clip);
    free(s.bank);
    free(s.clips.bytes);
    return 0;
}

/* ---- the cases ---- */

static void refused(const maker *x, const char *why, void *memory, size_t bytes, noh_result expected, size_t need)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_result result;
    memset(&out, 0x5a, sizeof out);
    result = x->make(memory, bytes, &error);
    if (result != expected || error.result != expected || !error.what || !error.what[0] || error.need != need) {
        fail_msg("%s, %s: %s (error %s, '%s', need %lu), expected %s, need %lu", x->name, why, noh_result_text(result),
                 noh_result_text(error.result), error.what ? error.what : "(null)", (unsigned long)error.need,
                 noh_result_text(expected), (unsigned long)need);
    }
    for (size_t i = 0; i < sizeof out; i++) {
        if (out.bytes[i] != 0x5a) fail_msg("%s, %s: the output was written", x->name, why);
    }
    assert_int_equal(x->make(memory, bytes, NULL), expected);
}

static void untouched(const maker *x, const uint8_t *bytes, size_t count, const char *which)
{
    for (size_t i = 0; i < count; i++) {
        if (bytes[i] != 0xa5) fail_msg("%s wrote %s", x->name, which);
    }
}

static void memory_is_checked_alike(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(makers); i++) {
        const maker *x = &makers[i];
        const size_t need = x->size();
        uint8_t *block = test_zeros(need + 192u);
        uint8_t *memory = block + (64u - ((uintptr_t)block & 63u));
        noh_error error = { NOH_OK, NULL, 0, 0 };
        if (!need) fail_msg("%s: size 0", x->name);
        memset(block, 0xa5, need + 192u);
        refused(x, "NULL", NULL, need, NOH_ERR_ARG, need);
        refused(x, "NULL and no bytes", NULL, 0, NOH_ERR_ARG, need);
        for (size_t off = 1; off < NOH_MEMORY_ALIGN; off++) {
            refused(x, "misaligned", memory + off, need, NOH_ERR_ARG, need);
        }
        refused(x, "misaligned and short", memory + 4, 1, NOH_ERR_ARG, need);
        refused(x, "a byte short", memory, need - 1u, NOH_ERR_MEMORY, need);
        refused(x, "no bytes", memory, 0, NOH_ERR_MEMORY, need);
        untouched(x, block, need + 192u, "into memory that it refused");
        if (x->make(memory, need, &error) != NOH_OK) fail_msg("%s: %s", x->name, error.what);
        untouched(x, block, (size_t)(memory - block), "before its memory");
        untouched(x, memory + need, (size_t)(block + need + 192u - (memory + need)), "past its bytes");
        if (x->drop) x->drop();
        free(block);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(memory_is_checked_alike),
};

TEST_MAIN(tests, set_up, tear_down)
