/* One contract for every function of the library that is given a block of memory: NULL and misaligned memory are ARG,
 * one byte too few is MEMORY, `need` is the exact bytes each time, nothing is touched on an error, and the exact bytes
 * suffice, with nothing written past them. The table below has every such function in the headers; a test compares the
 * two. All are called for one pack: a skinned tube with morph targets and a clip. */
#include "support/gl_fixture.h"
#include "support/graph_fixture.h"
#include "support/lod_fixture.h"
#include "life/physics/terrain_lod_internal.h"
#include "motion/anim/controller_internal.h"
#include "motion/clip/clip_cache_internal.h"
#include "motion/graph/graph_internal.h"
#include "noh/base.h"
#include "noh/modules.h"
#include "gl/morph/gl_morph_internal.h"
#include "stage/character/joint_lod_internal.h"
#include "stage/character/lod_pools_internal.h"
#include "stage/character/scheduler_internal.h"
#include "stage/character/time_lod_internal.h"
#include "motion/graph/graph_pack_internal.h"
#include "motion/clip/clip_view_internal.h"
#include "stage/character/character_internal.h"
#include "life/hair/hair_internal.h"
#include "stage/modules/springs_internal.h"
#include "noh/low_stage.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "noh/crowd.h"
#include "noh/low_core.h"
#include "noh/low_life.h"

#define CANARY 64u
#define FILL 0xa5
#define JOINTS 4u

/* What the functions are called with. */
typedef struct subject {
    model *m;
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    noh_skeleton skeleton;
    noh_skin skin;
    noh_clip_desc clip;
    noh_clip_bank_desc bank_desc;
    noh_clip_bank *bank;
    noh_controller_desc controller;
    noh_character_desc character;
    noh_graph graph;
    noh_graph_node node;
    noh_track_desc track;
    set_fixture moves; /* a pack with a graph */
    noh_clip_bank *moves_bank;
    noh_graph_pack_desc graph_pack;
    noh_lod_pools_desc pools;
    uint32_t level, slots;
    noh_lod_pack_desc lod;
    noh_time_probe probe;
    float radii[JOINTS], matrices[JOINTS * 12];
    gpu gl;
} subject;

static subject s;

static void open_pack(void)
{
    const skin_cylinder tube = { 8, 9, JOINTS, 2, 2, 1, 1.0f, 0.2f };
    noh_pack_clip clip;
    size_t count;
    s.m = lod_tube_model(&tube);
    s.bytes = skin_pack_with_clips(s.m, 1.0f, &count);
    s.pack = test_open(s.bytes, count);
    s.mesh = test_mesh(&s.pack, 0);
    assert_int_equal(noh_pack_skin_at(&s.pack, s.mesh.header->skin, &s.skin, NULL), NOH_OK);
    assert_int_equal(noh_pack_skeleton_at(&s.pack, s.skin.header->skeleton, &s.skeleton, NULL, NULL), NOH_OK);
    assert_int_equal(s.skeleton.joint_count, JOINTS);
    assert_int_equal(noh_pack_clip_at(&s.pack, 0, &clip, NULL), NOH_OK);
    s.clip.bytes = clip.bytes;
    s.clip.byte_count = clip.header->clip_bytes;
    s.clip.bind = s.skeleton.bind_pose;
    s.clip.joint_count = JOINTS;
    s.bank_desc.clips = &s.pack;
    s.bank_desc.skeleton = s.skin.header->skeleton;
    s.bank = test_clip_bank(&s.bank_desc);
}

static void open_graph_pack(void)
{
    noh_clip_bank_desc desc;
    memset(&desc, 0, sizeof desc);
    s.moves = graph_fixture_pack(GRAPH_FIXTURE_TEXT);
    desc.clips = &s.moves.pack;
    s.moves_bank = test_clip_bank(&desc);
    s.graph_pack.pack = &s.moves.pack;
    s.graph_pack.set = &s.moves_bank->clips;
}

static int set_up(void **state)
{
    (void)state;
    memset(&s, 0, sizeof s);
    open_pack();
    open_graph_pack();
    s.controller.set = &s.bank->clips;
    s.controller.flags = NOH_CONTROLLER_INERTIAL;
    s.character.controller = s.controller;
    s.node.param = NOH_GRAPH_NONE;
    s.graph.node_count = s.graph.clip_count = 1;
    s.graph.nodes = &s.node;
    s.graph.clips = &s.track;
    s.slots = 7;
    s.pools.instance_count = 5;
    s.pools.pool_count = 1;
    s.pools.levels = &s.level;
    s.pools.slot_counts = &s.slots;
    s.lod.set = s.bank;
    s.lod.set_desc = &s.bank_desc;
    s.lod.mesh = &s.mesh;
    s.probe.set = &s.bank->clips;
    s.probe.skeleton = &s.bank->skeleton;
    s.probe.joint_radius_m = s.radii;
    noh_local_to_model(&s.skeleton, s.skeleton.bind_pose, JOINTS, s.matrices);
    return gpu_open(&s.gl, "null");
}

static int tear_down(void **state)
{
    (void)state;
    gpu_close(&s.gl);
    free(s.moves_bank);
    free(s.moves.bytes);
    free(s.bank);
    free(s.bytes);
    model_free(s.m);
    return 0;
}

static noh_gl_device device(void)
{
    return (noh_gl_device){ &s.gl.gl, &s.gl.caps, &s.gl.ledger, NULL, 0 };
}

/* ---- the functions ---- */

typedef noh_result (*init_fn)(void *memory, size_t bytes, noh_error *error);

#define INIT(name) static noh_result name(void *memory, size_t bytes, noh_error *error)

INIT(clip_init)
{
    noh_clip *clip;
    return noh_clip_init(memory, bytes, &s.clip, &clip, error);
}

INIT(clip_cache_init)
{
    const noh_clip *clip = noh_clip_cache_clip(s.bank->cache, 0);
    const noh_clip_cache_desc desc = { &clip, 1, 0 };
    noh_clip_cache *cache;
    return noh_clip_cache_init(memory, bytes, &desc, &cache, error);
}

INIT(clip_view_init)
{
    noh_clip_view *view;
    return noh_clip_view_init(memory, bytes, s.bank->cache, &view, error);
}

INIT(clip_bank_init)
{
    noh_clip_bank *bank;
    return noh_clip_bank_init(memory, bytes, &s.bank_desc, &bank, error);
}

INIT(clip_bank_view_init)
{
    noh_clip_bank_view *view;
    return noh_clip_bank_view_init(memory, bytes, s.bank, &view, error);
}

INIT(controller_init)
{
    noh_controller *controller;
    return noh_controller_init(memory, bytes, &s.controller, &controller, error);
}

INIT(pose_scratch_init)
{
    noh_pose_scratch scratch;
    return noh_pose_scratch_init(memory, bytes, s.controller.set, 1, &scratch, error);
}

INIT(graph_init)
{
    static const noh_graph_node_desc node = { .name = "walk" };
    const noh_graph_desc desc = { .name = "one", .nodes = &node, .node_count = 1 };
    noh_pack pack;
    return noh_graph_init(memory, bytes, &desc, &pack, error);
}

INIT(graph_state_init)
{
    noh_graph_state *graph;
    return noh_graph_state_init(memory, bytes, &s.graph, s.controller.set, &graph, error);
}

INIT(graph_scratch_init)
{
    noh_graph_scratch scratch;
    return noh_graph_scratch_init(memory, bytes, &s.graph, s.controller.set, &scratch, error);
}

INIT(graph_pack_init)
{
    noh_graph_pack *graph;
    return noh_graph_pack_init(memory, bytes, &s.graph_pack, &graph, error);
}

INIT(character_init)
{
    noh_character *character;
    return noh_character_init(memory, bytes, &s.character, &character, error);
}

INIT(character_scratch_init)
{
    noh_character_scratch scratch;
    return noh_character_scratch_init(memory, bytes, &s.character, &scratch, error);
}

INIT(lod_pack_init)
{
    noh_lod_pack made;
    return noh_lod_pack_init(memory, bytes, &s.lod, &made, error);
}

INIT(lod_pools_init)
{
    noh_lod_pools *pools;
    return noh_lod_pools_init(memory, bytes, &s.pools, &pools, error);
}

INIT(schedule_init)
{
    noh_schedule schedule;
    return noh_schedule_init(memory, bytes, 11, &schedule, error);
}

/* With scratch of its own, which is good here. The tube's targets are no expressions, so they make people. */
INIT(identity_init)
{
    static uint8_t scratch[1u << 18] __attribute__((aligned(16)));
    noh_identity identity;
    return noh_identity_init(memory, bytes, scratch, sizeof scratch, &s.mesh, NULL, &identity, error);
}

INIT(ragdolls_init)
{
    static noh_ragdoll_rig rig;
    const noh_ragdolls_desc desc = { &rig, 3, 10, 0 };
    noh_ragdolls *set;
    rig.body_count = 1;
    rig.bodies[0] = (noh_ragdoll_body){
        NOH_NONE, 0, 0.1f, 0.05f, 1.0f, 0.01f, 0.01f, { 0.0f, 1.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }
    };
    return noh_ragdolls_init(memory, bytes, &desc, &set, error);
}

INIT(triangles_init)
{
    static const float positions[4][3] = { { 0, 0, 0 }, { 0, 0, 1 }, { 1, 0, 0 }, { 1, 1, 1 } };
    static const uint32_t indices[6][3] = {
        { 0, 1, 2 }, { 2, 1, 3 }, { 0, 2, 3 }, { 0, 3, 1 }, { 0, 1, 2 }, { 2, 1, 3 }
    };
    const noh_triangles_desc desc = { positions[0], 4, indices[0], 6 };
    noh_world_physics physics;
    return noh_triangles_init(memory, bytes, &desc, &physics, error);
}

INIT(spring_init)
{
    static const noh_spring_joint joints[2] = {
        { { 0.0f, 1.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }, 1.0f, 0.4f, 0.1f, { 0.0f, -0.5f, 0.0f } },
        { { 0.0f, 1.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }, 1.0f, 0.4f, 0.1f, { 0.0f, -0.5f, 0.0f } }
    };
    const noh_spring_desc desc = { joints, 2, 3, 0.0f };
    const noh_spring_carrier carrier = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f } };
    noh_spring *spring;
    return noh_spring_init(memory, bytes, &desc, &carrier, &spring, error);
}

INIT(hair_init)
{
    static const float rest[2][3][3] = { { { 0, 1, 0 }, { 0, 2, 0 }, { 0, 3, 0 } },
                                         { { 1, 1, 0 }, { 1, 2, 0 }, { 1, 3, 0 } } };
    const noh_hair_desc desc = { rest[0][0], 2, 3, NULL, 0, 1, 0.02f, 0.01f, 2.0f, 0.0f };
    const noh_hair_carrier carrier = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }, { 0.0f, 0.0f, 0.0f } };
    noh_hair *hair;
    return noh_hair_init(memory, bytes, &desc, &carrier, &hair, error);
}

INIT(actor_hair_init)
{
    static const float rest[2][2][3] = { { { 0, 1, 0 }, { 0, 2, 0 } }, { { 1, 1, 0 }, { 1, 2, 0 } } };
    static noh_haircut cut;
    static const noh_actor_hair_desc desc = { .cut = &cut, .head_max = 5, .near_max = 3 };
    noh_actor_hair *hair;
    cut.desc = (noh_hair_desc){ rest[0][0], 2, 2, NULL, 0, 1, 0.02f, 0.01f, 2.0f, 0.0f };
    return noh_actor_hair_init(memory, bytes, &desc, &hair, error);
}

INIT(springs_init)
{
    static const noh_spring_row row = { 1, 1.0f, 0.4f, 0.1f, { 0.0f, -0.5f, 0.0f } };
    static const noh_spring_chain chain = { 0, 1, 1, { 0.0f, 1.0f, 0.0f } };
    static const noh_spring_capsule capsule = { 0, { 0.0f, 0.0f, 0.0f }, { 0.0f, 1.0f, 0.0f }, 0.1f };
    const noh_springs_desc desc = { s.skeleton, 1.0f, &row, 1, 1, &chain, &capsule, 1, 0.0f, NULL };
    noh_springs *springs;
    return noh_springs_init(memory, bytes, &desc, &springs, error);
}

INIT(crowd_init)
{
    static const uint16_t heights[6] = { 0, 100, 0, 30, 200, 60 };
    static const noh_field hill = { heights, 3, 2, { -10.0f, 0.0f, -5.0f }, 10.0f, 0.01f };
    static const noh_crowd_obstacle wall = { { -3.0f, 0.0f }, { 5.0f, 1.0f }, 0.1f };
    const noh_crowd_desc desc = { 33,   2,  { -10.0f, -5.0f }, { 20.0f, 10.0f }, 2.0f, 1, &wall, 3, 0.7f, 0.4f, &hill,
                                  0.5f, 100 };
    noh_crowd *crowd;
    return noh_crowd_init(memory, bytes, &desc, &crowd, error);
}

INIT(smart_init)
{
    static const noh_smart_object bench = { 0, 0.5f, 48000, 0, 1 };
    static const noh_smart_slot seat = { { 0.0f, 0.0f }, { 1.0f, 0.0f }, 0, 0, 0, 0, 0, 48000 };
    const noh_smart_desc desc = { 5, 1, 1, 1, &bench, &seat, { 0.1f } };
    noh_smart *smart;
    return noh_smart_init(memory, bytes, &desc, &smart, error);
}

INIT(terrain_lod_init)
{
    static const uint16_t heights[6] = { 0, 100, 0, 30, 200, 60 };
    static const noh_field hill = { heights, 3, 2, { -10.0f, 0.0f, -5.0f }, 10.0f, 0.01f };
    noh_terrain_lod levels;
    return noh_terrain_lod_init(memory, bytes, &hill, &levels, error);
}

/* A stage that draws nothing, made once. */
static noh_stage *walkers_stage(noh_error *error)
{
    static noh_stage_plan plan;
    static noh_kind_desc kind;
    static noh_stage_desc desc;
    static noh_stage *stage;
    if (stage) return stage;
    kind.mesh = &s.pack;
    kind.actor_count = 2;
    desc.kinds = &kind;
    desc.kind_count = 1;
    if (noh_stage_plan_make(&desc, NULL, &plan, error) != NOH_OK) fail_msg("plan: %s", error->what);
    void *memory = test_aligned(NULL, (size_t)plan.cpu_bytes);
    if (noh_stage_init(memory, (size_t)plan.cpu_bytes, NULL, &desc, &plan, &stage, error)) fail_msg("%s", error->what);
    return stage;
}

INIT(walkers_init)
{
    noh_walkers_desc desc;
    noh_walkers *walkers;
    noh_stage *stage = walkers_stage(error);
    memset(&desc, 0, sizeof desc);
    desc.walker_max = 3;
    desc.walk = noh_stage_name(stage, 0, NOH_NAME_CLIP, 0);
    desc.walk_speed = 1.0f;
    return noh_walkers_init(memory, bytes, &desc, stage, &walkers, error);
}

INIT(wire_init)
{
    static uint8_t block[64] __attribute__((aligned(16)));
    const noh_wire_desc desc = { block, sizeof block };
    noh_wire *wire;
    return noh_wire_init(memory, bytes, &desc, &wire, error);
}

INIT(joint_lod_measure)
{
    const uint32_t counts[1] = { JOINTS };
    float errors[1];
    return noh_joint_lod_measure(memory, bytes, &s.probe, 0, counts, 1, errors, error);
}

INIT(time_lod_measure)
{
    float errors[NOH_UPDATE_RATE_COUNT];
    return noh_time_lod_measure(memory, bytes, &s.probe, 0, errors, error);
}

INIT(time_lod_points_measure)
{
    const noh_time_hold hold = { 1, 1.0f, { 0, 0, 0 } };
    const noh_time_lod_points points = { &hold, 1, 1 };
    float errors[NOH_UPDATE_RATE_COUNT];
    return noh_time_lod_points_measure(memory, bytes, &s.probe, &points, 0, errors, error);
}

INIT(morph_layers_init)
{
    noh_morph_layers layers;
    return noh_morph_layers_init(memory, bytes, &s.mesh, &layers, error);
}

INIT(reflection_init)
{
    static __attribute__((aligned(16))) float scratch[3 * 6 * (16 * 16 + 8 * 8 + 4 * 4)];
    const noh_reflection_desc desc = { 16, noh_reflection_of_environment, noh_environment_at(0) };
    noh_reflection reflection;
    assert_int_equal(noh_reflection_scratch_size(16), sizeof scratch);
    return noh_reflection_init(memory, bytes, scratch, sizeof scratch, &desc, &reflection, error);
}

/* A ray at the tube's middle: its scratch is a block too. */
INIT(pick)
{
    const noh_pick_surface surface = { &s.mesh, NULL, s.matrices, NULL, NULL, NULL, NULL };
    const float origin[3] = { 0.01f, 0.5f, 5.0f }, direction[3] = { 0, 0, -1 };
    noh_pick_hit hit;
    return noh_pick(&surface, origin, direction, 100.0f, memory, bytes, &hit, error);
}

static noh_result morph_init(void *memory, size_t bytes, int empty, noh_error *error)
{
    const noh_gl_device on = device();
    noh_gl_morph_desc desc;
    noh_gl_morph *morph;
    noh_result result;
    memset(&desc, 0, sizeof desc);
    desc.meshes = &s.mesh;
    desc.mesh_count = 1;
    desc.path = NOH_MORPH_CPU;
    result = empty ? noh_gl_morph_init_empty(memory, bytes, &on, &desc, NULL, NULL, &morph, error)
                   : noh_gl_morph_init(memory, bytes, &on, &desc, &morph, error);
    if (result == NOH_OK) noh_gl_morph_delete(morph);
    return result;
}

INIT(gl_morph_init)
{
    return morph_init(memory, bytes, 0, error);
}

INIT(gl_morph_init_empty)
{
    return morph_init(memory, bytes, 1, error);
}

INIT(gl_skin_init)
{
    const noh_gl_device on = device();
    noh_gl_skin_desc desc;
    noh_gl_skin *skin;
    noh_result result;
    memset(&desc, 0, sizeof desc);
    desc.meshes = &s.mesh;
    desc.mesh_count = 1;
    result = noh_gl_skin_init(memory, bytes, &on, &desc, &skin, error);
    if (result == NOH_OK) noh_gl_skin_delete(skin);
    return result;
}

INIT(stage_init)
{
    static noh_stage_plan plan;
    const noh_gl_device on = device();
    noh_kind_desc kind;
    noh_stage_desc desc;
    noh_stage *stage;
    noh_result result;
    memset(&kind, 0, sizeof kind);
    memset(&desc, 0, sizeof desc);
    kind.mesh = &s.pack;
    kind.actor_count = 2;
    desc.kinds = &kind;
    desc.kind_count = 1;
    desc.gpu = &noh_stage_on_gl;
    if (noh_stage_plan_make(&desc, &s.gl.caps, &plan, error) != NOH_OK) fail_msg("plan: %s", error->what);
    result = noh_stage_init(memory, bytes, &on, &desc, &plan, &stage, error);
    if (result == NOH_OK) noh_stage_delete(stage);
    return result;
}

#define ROW(name)          \
    {                      \
        "noh_" #name, name \
    }

static const struct {
    const char *name;
    init_fn init;
} inits[] = {
    ROW(clip_init),
    ROW(clip_cache_init),
    ROW(clip_view_init),
    ROW(clip_bank_init),
    ROW(clip_bank_view_init),
    ROW(controller_init),
    ROW(pose_scratch_init),
    ROW(graph_init),
    ROW(graph_state_init),
    ROW(graph_scratch_init),
    ROW(graph_pack_init),
    ROW(character_init),
    ROW(character_scratch_init),
    ROW(lod_pack_init),
    ROW(lod_pools_init),
    ROW(identity_init),
    ROW(ragdolls_init),
    ROW(triangles_init),
    ROW(spring_init),
    ROW(springs_init),
    ROW(hair_init),
    ROW(actor_hair_init),
    ROW(crowd_init),
    ROW(wire_init),
    ROW(smart_init),
    ROW(terrain_lod_init),
    ROW(walkers_init),
    ROW(schedule_init),
    ROW(joint_lod_measure),
    ROW(time_lod_measure),
    ROW(time_lod_points_measure),
    ROW(morph_layers_init),
    ROW(reflection_init),
    ROW(pick),
    ROW(gl_morph_init),
    ROW(gl_morph_init_empty),
    ROW(gl_skin_init),
    ROW(stage_init),
};

/* ---- the contract ---- */

static int untouched(const uint8_t *bytes, size_t count)
{
    size_t i = 0;
    while (i < count && bytes[i] == FILL) i++;
    return i == count;
}

static void refuse(size_t row, void *memory, size_t bytes, noh_result expected, size_t need)
{
    noh_error error = { NOH_OK, NULL, 99, 99 };
    const noh_result result = inits[row].init(memory, bytes, &error);
    if (result != expected || error.result != expected || error.need != need || !error.what) {
        fail_msg("%s: %s, need %lu; expected %s, need %lu", inits[row].name, noh_result_text(result),
                 (unsigned long)error.need, noh_result_text(expected), (unsigned long)need);
    }
}

static void every_block_opens_in_the_same_way(void **state)
{
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(inits); i++) {
        noh_error error = { NOH_OK, NULL, 0, 0 };
        const noh_gl_ledger ledger = s.gl.ledger;
        uint8_t *memory;
        size_t need;
        (void)inits[i].init(NULL, 0, &error);
        need = (size_t)error.need;
        if (!need) fail_msg("%s: no need for NULL memory", inits[i].name);
        memory = test_aligned(NULL, need + CANARY);
        memset(memory, FILL, need + CANARY);
        refuse(i, NULL, need, NOH_ERR_ARG, need);
        refuse(i, memory, need - 1u, NOH_ERR_MEMORY, need);
        refuse(i, memory, 0, NOH_ERR_MEMORY, need);
        for (size_t shift = 1; shift < NOH_MEMORY_ALIGN; shift++) refuse(i, memory + shift, need, NOH_ERR_ARG, need);
        if (!untouched(memory, need + CANARY)) fail_msg("%s writes before it refuses", inits[i].name);
        assert_memory_equal(&ledger, &s.gl.ledger, sizeof ledger);
        if (inits[i].init(memory, need, &error) != NOH_OK) fail_msg("%s: %s", inits[i].name, error.what);
        if (!untouched(memory + need, CANARY)) fail_msg("%s writes past its block", inits[i].name);
        free(memory);
    }
}

/* ---- the table is whole ---- */

static int has_row(const char *name)
{
    for (size_t i = 0; i < TEST_COUNT(inits); i++) {
        if (strcmp(inits[i].name, name) == 0) return 1;
    }
    return 0;
}

/* Every function of a header that begins `(void *memory, size_t bytes` has a row. Returns how many there are. */
static uint32_t check_header(const char *path)
{
    static const char start[] = "noh_result ", block[] = "(void *memory, size_t bytes";
    static char text[1 << 18];
    uint32_t found = 0;
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    text[fread(text, 1, sizeof text - 1u, in)] = 0;
    fclose(in);
    for (char *at = strstr(text, start); at; at = strstr(at, start)) {
        char *name = at + strlen(start), *end = name + strcspn(name, "( \n");
        at = name;
        if (strncmp(end, block, strlen(block)) != 0) continue;
        *end = 0;
        if (!has_row(name)) fail_msg("%s: %s has no row in the table", path, name);
        found++;
        at = end + 1;
    }
    return found;
}

/* The public functions of the headers in a folder, DEPTH folders down, that the table has to have. */
static uint32_t check_folder(const char *path, int depth)
{
    DIR *folder = opendir(path);
    uint32_t found = 0;
    assert_non_null(folder);
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        const char *dot = strrchr(entry->d_name, '.');
        char inner[600];
        snprintf(inner, sizeof inner, "%.250s/%.250s", path, entry->d_name);
        if (depth && !dot) found += check_folder(inner, depth - 1);
        if (!depth && dot && strcmp(dot, ".h") == 0) found += check_header(inner);
    }
    closedir(folder);
    return found;
}

static void the_table_has_every_init_of_the_headers(void **state)
{
    DIR *folder = opendir("runtime");
    (void)state;
    if (!folder) test_skip("run it in the root of the sources");
    closedir(folder);
    /* public headers, then private ones; noh_pick has its block among other arguments */
    assert_int_equal(check_folder("runtime/noh", 0) + check_folder("runtime", 2) + 1u, TEST_COUNT(inits));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_block_opens_in_the_same_way),
    cmocka_unit_test(the_table_has_every_init_of_the_headers),
};

TEST_MAIN(tests, set_up, tear_down)
