/* Tests of graph_pack.c and check_graph.c: a graph out of a pack, bound and played by names;
 * damaged and forged ones. */
#include "support/graph_fixture.h"

#include "support/pack_walk.h"

#include <math.h>
#include "motion/anim/tracks_internal.h"
#include "motion/graph/graph_internal.h"
#include "motion/graph/graph_pack_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

static set_fixture fixture;
static noh_clip_bank *bank;

static int set_up(void **state)
{
    noh_clip_bank_desc desc;
    (void)state;
    fixture = graph_fixture_pack(GRAPH_FIXTURE_TEXT);
    memset(&desc, 0, sizeof desc);
    desc.clips = &fixture.pack;
    bank = test_clip_bank(&desc);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(bank);
    free(fixture.bytes);
    return 0;
}

static noh_graph_pack_desc desc_of(const noh_pack *pack)
{
    const noh_graph_pack_desc desc = { pack, 0, &bank->clips, NULL, 0 };
    return desc;
}

static noh_graph_pack *make(const noh_graph_pack_desc *desc)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    const size_t bytes = noh_graph_pack_size(desc, &error);
    noh_graph_pack *made = NULL;
    if (noh_graph_pack_init(test_aligned(NULL, bytes), bytes, desc, &made, &error)) {
        fail_msg("%s (%u)", error.what, (unsigned)error.where);
    }
    return made;
}

/* A state of a machine by the name of its child node, and the track that plays a clip node: NOH_NONE if there is
 * none. */
static uint32_t find_state(const noh_graph_pack *made, uint32_t machine, const char *name)
{
    for (uint32_t i = 0; noh_graph_pack_state_name(made, machine, i)[0]; i++)
        if (strcmp(noh_graph_pack_state_name(made, machine, i), name) == 0) return i;
    return NOH_NONE;
}

static uint32_t find_track(const noh_graph_pack *made, const char *name)
{
    const noh_pack_graph *g = &made->source;
    for (uint32_t i = 0; i < g->header->node_count; i++)
        if (g->nodes[i].kind == NOH_PACK_NODE_CLIP && strcmp(noh_pack_string(g->pack, g->nodes[i].name), name) == 0)
            return g->nodes[i].index;
    return NOH_NONE;
}

typedef struct player {
    noh_graph_pack *made;
    noh_graph_state *state;
    noh_graph_scratch scratch;
    void *scratch_memory;
    noh_transform pose[5];
    float floats[8];
} player;

static player play(void)
{
    const noh_graph_pack_desc desc = desc_of(&fixture.pack);
    player p;
    size_t bytes, scratch_bytes;
    memset(&p, 0, sizeof p);
    p.made = make(&desc);
    assert_true(p.made->clips.float_count <= 8);
    bytes = noh_graph_state_size(&p.made->graph, &p.made->clips);
    scratch_bytes = noh_graph_scratch_size(&p.made->graph, &p.made->clips);
    p.scratch_memory = test_aligned(NULL, scratch_bytes);
    assert_int_equal(
        noh_graph_state_init(test_aligned(NULL, bytes), bytes, &p.made->graph, &p.made->clips, &p.state, NULL), NOH_OK);
    assert_int_equal(
        noh_graph_scratch_init(p.scratch_memory, scratch_bytes, &p.made->graph, &p.made->clips, &p.scratch, NULL),
        NOH_OK);
    return p;
}

static void stop(player *p)
{
    free(p->state);
    free(p->made);
    free(p->scratch_memory);
}

static void step(player *p, uint32_t ticks)
{
    (void)noh_graph_step(p->state, &p->made->graph, &p->made->clips, ticks, NULL, NULL);
    noh_graph_pose(p->state, &p->made->graph, &p->made->clips, &p->scratch, p->pose, p->floats);
}

static void set(player *p, const char *name, float value)
{
    assert_int_equal(noh_graph_pack_set_param(p->made, p->state, noh_graph_pack_find_param(p->made, name), value),
                     NOH_OK);
}

static const char *state_of(const player *p, const char *machine)
{
    const uint32_t m = noh_graph_pack_find_machine(p->made, machine);
    assert_int_not_equal(m, NOH_NONE);
    return noh_graph_pack_state_name(p->made, m, noh_graph_machine_state(p->state, m));
}

/* ---- names ---- */

static void graphs_are_found_by_name(void **state)
{
    noh_pack_graph g;
    noh_error error;
    (void)state;
    assert_int_equal(fixture.pack.runs[NOH_CHUNK_GRAPH].count, 1);
    assert_int_equal(noh_pack_graph_find(&fixture.pack, "all"), 0);
    assert_int_equal(noh_pack_graph_find(&fixture.pack, "al"), NOH_NONE);
    assert_int_equal(noh_pack_graph_at(&fixture.pack, 0, &g, NULL), NOH_OK);
    assert_string_equal(g.name, "all");
    assert_int_equal(noh_pack_graph_at(&fixture.pack, 1, &g, &error), NOH_ERR_NOT_FOUND);
    assert_true(error.where == 1 && error.need == 1);
    assert_string_equal(noh_graph_pack_clip_name(&g, 1), "clip1");
    assert_string_equal(noh_graph_pack_clip_name(&g, g.header->clip_count), "");
}

static void parameters_have_names_ranges_and_values(void **state)
{
    player p = play();
    const uint32_t speed = noh_graph_pack_find_param(p.made, "speed"), mood = noh_graph_pack_find_param(p.made, "mood"),
                   gear = noh_graph_pack_find_param(p.made, "gear");
    (void)state;
    assert_int_equal(noh_graph_pack_find_param(p.made, "spee"), NOH_NONE);
    assert_true(noh_graph_param(p.state, speed) == 0.5f && noh_graph_param(p.state, mood) == 1.0f);
    set(&p, "speed", 7.0f);
    assert_true(noh_graph_param(p.state, speed) == 2.0f);
    set(&p, "speed", -7.0f);
    assert_true(noh_graph_param(p.state, speed) == 0.0f);
    set(&p, "gear", 0.6f);
    assert_true(noh_graph_param(p.state, gear) == 1.0f);
    set(&p, "x", -0.3f);
    assert_true(noh_graph_param(p.state, noh_graph_pack_find_param(p.made, "x")) == -0.3f);
    assert_int_equal(noh_graph_pack_find_value(p.made, mood, "calm"), 0);
    assert_int_equal(noh_graph_pack_find_value(p.made, mood, "glad"), 1);
    assert_int_equal(noh_graph_pack_find_value(p.made, mood, "sad"), NOH_NONE);
    assert_int_equal(noh_graph_pack_find_value(p.made, speed, "calm"), NOH_NONE);
    assert_int_equal(noh_graph_pack_find_value(p.made, NOH_NONE, "calm"), NOH_NONE);
    assert_int_equal(noh_graph_pack_set_param(p.made, p.state, NOH_NONE, 1.0f), NOH_ERR_ARG);
    assert_int_equal(noh_graph_pack_set_param(p.made, p.state, speed, NAN), NOH_ERR_ARG);
    stop(&p);
}

static void states_are_played_by_name(void **state)
{
    player p = play();
    const uint32_t states = noh_graph_pack_find_machine(p.made, "states");
    (void)state;
    assert_int_equal(noh_graph_pack_find_machine(p.made, "walk"), NOH_NONE); /* a node, but no machine */
    assert_int_equal(find_state(p.made, states, "aim"), 1);
    assert_int_equal(find_state(p.made, states, "walk"), NOH_NONE);
    assert_int_equal(find_state(p.made, NOH_NONE, "aim"), NOH_NONE);
    assert_string_equal(noh_graph_pack_state_name(p.made, states, 3), "");
    assert_int_equal(find_track(p.made, "run"), 1);
    assert_int_equal(find_track(p.made, "states"), NOH_NONE);
    step(&p, 100);
    assert_string_equal(state_of(&p, "choice"), "added"); /* glad */
    set(&p, "mood", 0.0f);
    step(&p, 1000);
    assert_string_equal(state_of(&p, "choice"), "states");
    assert_string_equal(state_of(&p, "states"), "go");
    set(&p, "x", 0.75f);
    step(&p, 1000);
    assert_string_equal(state_of(&p, "states"), "aim");
    step(&p, 9600);
    set(&p, "leap", 1.0f);
    step(&p, 1000);
    assert_string_equal(state_of(&p, "states"), "mixed");
    set(&p, "wave", 1.0f);
    step(&p, 1000);
    assert_string_equal(state_of(&p, "root"), "waving");
    stop(&p);
}

/* What the text says is what the graph has. */
static void clips_and_nodes_are_those_of_the_text(void **state)
{
    player p = play();
    const noh_graph *g = &p.made->graph;
    const uint32_t b = find_track(p.made, "b"), c = find_track(p.made, "c"), d = find_track(p.made, "d"),
                   e = find_track(p.made, "e");
    const noh_graph_node *root = &g->nodes[g->node_count - 1];
    (void)state;
    assert_int_equal(g->clips[0].sync_group, 1);
    assert_int_equal(g->clips[1].sync_group, 1);
    assert_int_equal(g->clips[1].speed, 98304);
    assert_int_equal(g->clips[1].clip, noh_clip_bank_find(bank, "clip1"));
    assert_int_equal(g->clips[b].position_ticks, 4800);
    assert_int_equal(g->clips[c].loop, NOH_LOOP_PING_PONG);
    assert_int_equal(g->clips[d].speed, -65536);
    assert_int_equal(g->clips[e].flags, NOH_TRACK_PAUSED);
    assert_int_equal(root->kind, NOH_NODE_ONE_SHOT);
    assert_int_equal(root->fade_ticks, 4800);
    assert_int_equal(root->fade_out_ticks, 9600);
    assert_int_equal(g->clips[find_track(p.made, "waving")].loop, NOH_LOOP_ONCE);
    assert_int_equal(g->transition_count, 4);
    assert_int_equal(g->transitions[0].curve, NOH_CURVE_SMOOTHSTEP);
    assert_int_equal(g->transitions[1].flags, NOH_TRANSITION_INERTIAL | NOH_TRANSITION_KEEP);
    assert_int_equal(g->transitions[2].from, NOH_GRAPH_NONE);
    assert_int_equal(g->transitions[3].condition, NOH_WHEN_ENDING);
    assert_int_equal(g->spaces[0].triangle_count, 1);
    stop(&p);
}

static void masks_are_made_of_joint_names(void **state)
{
    static const uint8_t want[] = { 0, 0, 255, 64, 255 }; /* below joint2, then joint3 alone */
    player p = play();
    (void)state;
    assert_int_equal(p.made->clips.mask_count, 1);
    for (uint32_t j = 0; j < 5; j++) {
        uint32_t number = (uint32_t)(noh_pack_joint_name(&fixture.pack, 0, j)[5] - '0');
        assert_int_equal(p.made->clips.masks[j], want[number]);
    }
    for (uint32_t i = 0; i < p.made->clips.float_count; i++) assert_int_equal(p.made->clips.masks[5 + i], 128);
    assert_int_equal(bank->clips.mask_count, 0); /* the bank's own set is as it was */
    stop(&p);
}

/* ---- what is missing ---- */

static void a_missing_clip_is_named(void **state)
{
    noh_clip_entry entries[3];
    noh_clip_set less = bank->clips;
    noh_graph_pack_desc desc = desc_of(&fixture.pack);
    noh_graph_pack *made = NULL;
    noh_pack_graph g;
    noh_error error;
    size_t bytes = noh_graph_pack_size(&desc, NULL);
    void *memory = test_aligned(NULL, bytes);
    (void)state;
    memcpy(entries, bank->clips.clips, sizeof entries);
    entries[1].name_hash ^= 1u;
    less.clips = entries;
    desc.set = &less;
    assert_int_equal(noh_graph_pack_init(memory, bytes, &desc, &made, &error), NOH_ERR_NOT_FOUND);
    assert_null(made);
    assert_int_equal(noh_pack_graph_at(&fixture.pack, 0, &g, NULL), NOH_OK);
    assert_string_equal(noh_graph_pack_clip_name(&g, (uint32_t)error.where), "clip1");
    assert_non_null(strstr(error.what, "clip"));
    free(memory);
}

/* A pose added relative to the pose that it is added to is itself, whatever the bind pose; without a reference it is
 * not. A text of both comes back from its pack as it was. */
static void poses_are_added_relative_to_a_clip(void **state)
{
    static const char *const texts[] = {
        "clip b clip1 paused=yes start=0.1\n",
        "clip a clip0 paused=yes\nclip b clip1 paused=yes start=0.1\nadd c a b by=1 reference=clip0\n",
        "clip a clip0 paused=yes\nclip b clip1 paused=yes start=0.1\nadd c a b by=1\n"
    };
    const set_fixture kept = fixture;
    noh_transform poses[3][5];
    float floats[3][8], off[3] = { 0.0f, 0.0f, 0.0f };
    (void)state;
    memset(poses, 0, sizeof poses);
    memset(floats, 0, sizeof floats);
    for (int i = 0; i < 3; i++) {
        char text[256];
        player p;
        snprintf(text, sizeof text, "graph all\n%s", texts[i]);
        fixture = graph_fixture_pack(text);
        p = play();
        step(&p, 0);
        memcpy(poses[i], p.pose, sizeof poses[i]);
        memcpy(floats[i], p.floats, p.made->clips.float_count * sizeof(float));
        for (uint32_t j = 0; j < p.made->clips.joint_count; j++) {
            off[i] += 1.0f - fabsf(noh_quat_dot(poses[0][j].rotation, poses[i][j].rotation));
            for (int k = 0; k < 3; k++) off[i] += fabsf(poses[0][j].translation[k] - poses[i][j].translation[k]);
        }
        for (uint32_t f = 0; f < p.made->clips.float_count; f++) off[i] += fabsf(floats[0][f] - floats[i][f]);
        stop(&p);
        free(fixture.bytes);
    }
    fixture = kept;
    assert_true(off[1] < 1e-4f);
    assert_true(off[2] > 1e-2f);
}

static void a_missing_joint_is_named(void **state)
{
    static const uint32_t frames[] = { 31, 25, 40 };
    set_fixture other = set_fixture_make(5, 3, frames);
    noh_graph_pack_desc desc = desc_of(&fixture.pack);
    noh_graph_pack *made = NULL;
    noh_error error;
    size_t bytes;
    void *memory;
    char *name;
    (void)state;
    for (uint32_t i = 0; i < other.pack.string_bytes; i++) {
        name = (char *)(uintptr_t)(other.pack.strings + i);
        if (strcmp(name, "joint2") == 0) name[5] = '7';
    }
    desc.mesh = &other.pack;
    bytes = noh_graph_pack_size(&desc, NULL);
    memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_graph_pack_init(memory, bytes, &desc, &made, &error), NOH_ERR_NOT_FOUND);
    assert_non_null(strstr(error.what, "joint"));
    free(memory);
    free(other.bytes);
}

static void impossible_descs_are_refused(void **state)
{
    noh_graph_pack_desc desc = desc_of(&fixture.pack);
    noh_clip_set fewer = bank->clips;
    noh_error error;
    (void)state;
    desc.pack = NULL;
    assert_int_equal(noh_graph_pack_size(&desc, &error), 0);
    assert_int_equal(error.result, NOH_ERR_ARG);
    desc = desc_of(&fixture.pack);
    desc.set = NULL;
    assert_int_equal(noh_graph_pack_size(&desc, &error), 0);
    assert_int_equal(error.result, NOH_ERR_ARG);
    desc = desc_of(&fixture.pack);
    desc.graph = 1;
    assert_int_equal(noh_graph_pack_size(&desc, &error), 0);
    assert_int_equal(error.result, NOH_ERR_NOT_FOUND);
    desc = desc_of(&fixture.pack);
    desc.skeleton = 1; /* masks need it */
    assert_int_equal(noh_graph_pack_size(&desc, &error), 0);
    assert_int_equal(error.result, NOH_ERR_ARG);
    desc = desc_of(&fixture.pack);
    fewer.float_count = NOH_FLOATS_MAX + 1u;
    desc.set = &fewer;
    assert_int_equal(noh_graph_pack_size(&desc, &error), 0);
    assert_int_equal(error.result, NOH_ERR_ARG);
    fewer.float_count = bank->clips.float_count;
    fewer.joint_count = 4;
    assert_int_equal(noh_graph_pack_size(&desc, &error), 0);
    assert_int_equal(error.result, NOH_ERR_ARG);
}

static void a_graph_without_masks_needs_no_skeleton(void **state)
{
    set_fixture x = graph_fixture_pack("graph one\nclip clip1\n");
    noh_graph_pack_desc desc = desc_of(&x.pack);
    noh_graph_pack *made;
    (void)state;
    desc.skeleton = 99;
    made = make(&desc);
    assert_int_equal(made->graph.node_count, 1);
    assert_ptr_equal(made->clips.masks, bank->clips.masks);
    free(made);
    free(x.bytes);
}

/* ---- equal bits ---- */

static void a_saved_instance_plays_the_same_bits(void **state)
{
    player p = play();
    uint8_t *saved = test_aligned(NULL, p.state->bytes);
    noh_transform first[60][5];
    (void)state;
    step(&p, 700);
    memcpy(saved, p.state, p.state->bytes);
    for (int run = 0; run < 2; run++) {
        if (run) memcpy(p.state, saved, p.state->bytes);
        for (int i = 0; i < 60; i++) {
            if (i == 5) set(&p, "mood", 0.0f);
            if (i == 9) set(&p, "wave", 1.0f);
            if (i == 20) set(&p, "x", 0.9f);
            if (i == 35) set(&p, "gear", 1.0f);
            if (i == 50) set(&p, "gear", 0.0f);
            step(&p, 800);
            if (!run)
                memcpy(first[i], p.pose, sizeof p.pose);
            else
                assert_memory_equal(first[i], p.pose, sizeof p.pose);
        }
    }
    free(saved);
    stop(&p);
}

/* ---- damage ---- */

static void every_flip_is_refused(void **state)
{
    const size_t count = fixture.pack.byte_count;
    uint8_t *bytes = test_aligned(fixture.bytes, count);
    (void)state;
    for (size_t bit = 0; bit < 8 * count; bit++) {
        noh_pack pack;
        noh_error error = { NOH_OK, NULL, 0, 0 };
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        if (noh_pack_open(bytes, count, &pack, &error) == NOH_OK || !error.what || error.where > count) {
            fail_msg("bit %zu of byte %zu", bit % 8, bit / 8);
        }
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    free(bytes);
}

static noh_result open_graph(const uint8_t *bytes, noh_pack *pack, noh_error *error)
{
    noh_pack_graph g;
    noh_result result = noh_pack_open(bytes, fixture.pack.byte_count, pack, error);
    return result ? result : noh_pack_graph_at(pack, 0, &g, error);
}

/* With repaired checksums: refused with a place, or played in full. */
static void repaired_flips_of_a_graph_stay_in_bounds(void **state)
{
    const noh_pack_chunk *c = &fixture.pack.chunks[fixture.pack.runs[NOH_CHUNK_GRAPH].first];
    const size_t count = fixture.pack.byte_count, first = 8u * (size_t)c->offset, last = first + 8u * (size_t)c->bytes;
    uint8_t *bytes = test_aligned(NULL, count);
    size_t opened = 0, refused = 0;
    (void)state;
    for (size_t bit = first; bit < last; bit++) {
        noh_pack pack;
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_result result;
        memcpy(bytes, fixture.bytes, count);
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        pack_repair(bytes, count);
        result = open_graph(bytes, &pack, &error);
        if (result == NOH_OK) {
            if (opened++ % 7 == 0) pack_walk(&pack, (uint32_t)bit);
        } else {
            assert_int_equal(result, NOH_ERR_DATA);
            assert_true(error.where >= c->offset && error.where < (uint64_t)c->offset + c->bytes);
            refused++;
        }
    }
    print_message("# graph of %u bytes: %zu flips open, %zu are refused\n", c->bytes, opened, refused);
    assert_true(opened > 1000 && refused > 2 * opened / 3);
    free(bytes);
}

typedef struct forged {
    uint8_t *bytes;
    noh_pack_graph_header *h;
    noh_pack_graph_node *nodes;
    uint16_t *children;
    noh_pack_graph_clip *clips;
    noh_pack_graph_transition *transitions;
    float *points;
    noh_pack_graph_space *spaces;
    uint8_t *triangles;
    noh_pack_graph_param *params;
    noh_pack_graph_mask *masks;
    noh_pack_graph_name *names;
} forged;

static forged forge(void)
{
    forged f;
    uint8_t *chunk;
    f.bytes = test_aligned(fixture.bytes, fixture.pack.byte_count);
    chunk = f.bytes + fixture.pack.chunks[fixture.pack.runs[NOH_CHUNK_GRAPH].first].offset;
    f.h = (noh_pack_graph_header *)(void *)chunk;
    f.nodes = (noh_pack_graph_node *)(void *)(chunk + f.h->nodes_offset);
    f.children = (uint16_t *)(void *)(chunk + f.h->children_offset);
    f.clips = (noh_pack_graph_clip *)(void *)(chunk + f.h->clips_offset);
    f.transitions = (noh_pack_graph_transition *)(void *)(chunk + f.h->transitions_offset);
    f.points = (float *)(void *)(chunk + f.h->points_offset);
    f.spaces = (noh_pack_graph_space *)(void *)(chunk + f.h->spaces_offset);
    f.triangles = chunk + f.h->triangles_offset;
    f.params = (noh_pack_graph_param *)(void *)(chunk + f.h->params_offset);
    f.masks = (noh_pack_graph_mask *)(void *)(chunk + f.h->masks_offset);
    f.names = (noh_pack_graph_name *)(void *)(chunk + f.h->names_offset);
    return f;
}

static noh_pack_graph_node *kind(forged *f, uint32_t which)
{
    for (uint32_t i = 0; i < f->h->node_count; i++) {
        if (f->nodes[i].kind == which) return &f->nodes[i];
    }
    fail_msg("no node of kind %u", which);
    return NULL;
}

#define LIES                                                                                    \
    X(f.h->node_count = 0, "count of a graph is")                                               \
    X(f.h->node_count = 257, "count of a graph is")                                             \
    X(f.h->child_count++, "count of a graph is")                                                \
    X(f.h->clip_count = 65, "count of a graph is")                                              \
    X(f.h->clip_count--, "array does not begin")                                                \
    X(f.h->param_count = 257, "count of a graph is")                                            \
    X(f.h->name_count = 5000, "count of a graph is")                                            \
    X(f.h->reserved[1] = 1, "count of a graph is")                                              \
    X(f.h->machine_count++, "count of clips or machines")                                       \
    X(f.nodes[0].name = 0x7fffffff, "name lies outside the strings")                            \
    X(f.nodes[1].name_hash ^= 4, "name and its hash differ")                                    \
    X(f.nodes[0].kind = 9, "unknown kind")                                                      \
    X(f.nodes[0].mask = 1, "field that its kind does not have")                                 \
    X(f.nodes[0].param = 0, "field that its kind does not have")                                \
    X(f.nodes[0].child_count = 1, "children that do not suit")                                  \
    X(f.nodes[0].index = 1, "not numbered in their order")                                      \
    X(kind(&f, NOH_PACK_NODE_BLEND)->value = NAN, "value that is not finite")                   \
    X(kind(&f, NOH_PACK_NODE_ADD)->param = 90, "missing parameter or mask")                     \
    X(kind(&f, NOH_PACK_NODE_ADD)->first_item = 90, "adds relative to a clip")                  \
    X(kind(&f, NOH_PACK_NODE_ADD)->item_count = 2, "adds relative to a clip")                   \
    X(kind(&f, NOH_PACK_NODE_ADD)->item_count = 0, "adds relative to a clip")                   \
    X(kind(&f, NOH_PACK_NODE_SPACE_2D)->param_y = 90, "missing parameter or mask")              \
    X(kind(&f, NOH_PACK_NODE_SELECT)->param = NOH_PACK_GRAPH_NONE, "missing parameter or mask") \
    X(kind(&f, NOH_PACK_NODE_MASK)->mask = 0, "missing parameter or mask")                      \
    X(kind(&f, NOH_PACK_NODE_ONE_SHOT)->mask = 2, "missing parameter or mask")                  \
    X(kind(&f, NOH_PACK_NODE_SELECT)->curve = 2, "unknown curve or flags")                      \
    X(kind(&f, NOH_PACK_NODE_SELECT)->flags = 4, "unknown curve or flags")                      \
    X(kind(&f, NOH_PACK_NODE_ONE_SHOT)->child_count = 1, "children that do not suit")           \
    X(kind(&f, NOH_PACK_NODE_MACHINE)->first_child = 400, "children are not in the chunk")      \
    X(kind(&f, NOH_PACK_NODE_MACHINE)->item_count = 9, "transitions of a machine")              \
    X(kind(&f, NOH_PACK_NODE_SPACE_1D)->item_count = 1, "differs from its children")            \
    X(kind(&f, NOH_PACK_NODE_SPACE_2D)->first_item = 1, "missing blend space")                  \
    X(f.points[1] = -1.0f, "do not rise")                                                       \
    X(f.points[3] = INFINITY, "point of a blend space is not finite")                           \
    X(f.spaces[0].point_count = 2, "not have one point for each child")                         \
    X(f.spaces[0].triangle_count = 2, "points or triangles")                                    \
    X(f.triangles[2] = 3, "triangle of a blend space names a missing")                          \
    X(f.transitions[0].to = 3, "not between two states")                                        \
    X(f.transitions[0].to = 0, "not between two states")                                        \
    X(f.transitions[1].condition = 4, "unknown condition")                                      \
    X(f.transitions[3].param = 0, "unknown condition")                                          \
    X(f.transitions[0].threshold = NAN, "unknown condition")                                    \
    X(f.transitions[1].duration_ticks = 0, "inertial without a time")                           \
    X(f.children[0] = 1, "does not follow its children")                                        \
    X(f.clips[0].speed = 0, "clip of a graph has no speed")                                     \
    X(f.clips[0].loop = 4, "clip of a graph has no speed")                                      \
    X(f.clips[0].sync_group = 16, "clip of a graph has no speed")                               \
    X(f.params[0].kind = 4, "parameter of an unknown kind")                                     \
    X(f.params[0].initial = 3.0f, "range of a parameter")                                       \
    X(f.params[0].maximum = INFINITY, "range of a parameter")                                   \
    X(f.params[4].value_count = 9, "values that are not in the chunk")                          \
    X(f.params[4].maximum = 5.0f, "range of a parameter")                                       \
    X(f.params[5].maximum = 2.0f, "range of a parameter")                                       \
    X(f.masks[0].joint_count = 9, "mask has joints that are not in the chunk")                  \
    X(f.masks[0].reserved[0] = 1, "mask has joints that are not in the chunk")                  \
    X(f.names[0].subtree = 2, "name of a graph has unknown flags")

/* Whether a byte is before the graph's chunk: of the header and table, where the checksums are. */
static int is_checksum(uint64_t byte)
{
    return byte < fixture.pack.chunks[fixture.pack.runs[NOH_CHUNK_GRAPH].first].offset;
}

/* The byte that the error names is in the field with the lie; where an array ends elsewhere, in the next one's offset.
 */
static int names_the_field(const forged *f, const noh_error *error)
{
    uint64_t first = 0;
    const int ends_elsewhere = strstr(error->what, "array") != NULL;
    while (f->bytes[first] == fixture.bytes[first] || is_checksum(first)) first++;
    return ends_elsewhere || (error->where <= first && first < error->where + 4u);
}

static void forged_graphs_are_refused(void **state)
{
    const noh_pack_chunk *c = &fixture.pack.chunks[fixture.pack.runs[NOH_CHUNK_GRAPH].first];
    noh_pack pack;
    noh_error error;
    (void)state;
#define X(lie, message)                                                                                       \
    {                                                                                                         \
        forged f = forge();                                                                                   \
        lie;                                                                                                  \
        pack_repair(f.bytes, fixture.pack.byte_count);                                                        \
        error.what = "it opened";                                                                             \
        error.where = 0;                                                                                      \
        if (open_graph(f.bytes, &pack, &error) != NOH_ERR_DATA || !strstr(error.what, message) ||             \
            error.where < c->offset || !names_the_field(&f, &error))                                          \
            fail_msg("%s: %s (byte %u of the chunk)", #lie, error.what, (unsigned)(error.where - c->offset)); \
        free(f.bytes);                                                                                        \
    }
    LIES
#undef X
}

/* ---- made in code ---- */

/* A graph that is right, and what each lie changes of it. */
typedef struct draft {
    noh_graph_node_desc nodes[6];
    noh_graph_transition_desc ways[2];
    noh_graph_param_desc params[3];
    noh_graph_joint_desc joints[2];
    noh_graph_mask_desc mask;
    noh_graph_desc desc;
    const char *states[3], *shot[2], *values[2];
    float points[6];
} draft;

static void start(draft *d)
{
    memset(d, 0, sizeof *d);
    d->states[0] = "walk", d->states[1] = "run", d->states[2] = "wave";
    d->shot[0] = "moves", d->shot[1] = "jump";
    d->values[0] = "low", d->values[1] = "high";
    d->points[2] = 1.0f;
    d->params[0] = (noh_graph_param_desc){ .name = "speed", .maximum = 2.0f };
    d->params[1] = (noh_graph_param_desc){ .name = "mood", .kind = NOH_PARAM_ENUM };
    d->params[1].values = d->values, d->params[1].value_count = 2;
    d->params[2] = (noh_graph_param_desc){ .name = "leap", .kind = NOH_PARAM_TRIGGER };
    d->ways[0] = (noh_graph_transition_desc){ "walk", "run", NOH_WHEN_ABOVE, "speed", 1.0f, 4800, NOH_CURVE_LINEAR, 0 };
    d->ways[1] = (noh_graph_transition_desc){ .to = "walk", .condition = NOH_WHEN_TRIGGERED, .param = "leap" };
    d->joints[0] = (noh_graph_joint_desc){ "joint2", 255, 1 };
    d->joints[1] = (noh_graph_joint_desc){ "joint3", 64, 0 };
    d->mask = (noh_graph_mask_desc){ "upper", d->joints, 2, 128 };
    d->nodes[0] = (noh_graph_node_desc){ .name = "leaps", .kind = NOH_NODE_ONE_SHOT, .param = "leap", .mask = "upper" };
    d->nodes[0].children = d->shot, d->nodes[0].child_count = 2;
    d->nodes[1] = (noh_graph_node_desc){ .name = "jump", .clip = "clip1", .loop = NOH_LOOP_ONCE };
    d->nodes[2] = (noh_graph_node_desc){ .name = "moves", .kind = NOH_NODE_MACHINE };
    d->nodes[2].children = d->states, d->nodes[2].child_count = 3;
    d->nodes[2].transitions = d->ways, d->nodes[2].transition_count = 2;
    for (uint32_t i = 0; i < 3; i++) d->nodes[3 + i] = (noh_graph_node_desc){ .name = d->states[i], .clip = "clip0" };
    d->desc = (noh_graph_desc){ "draft", d->nodes, d->params, &d->mask, 6, 3, 1 };
}

/* The machine as a node that chooses by a parameter. */
static void start_choice(draft *d, noh_node_kind kind, const char *param)
{
    start(d);
    d->nodes[2].transition_count = 0;
    d->nodes[2].kind = kind;
    d->nodes[2].param = param;
    d->nodes[2].points = d->points;
}

static noh_result draw_up(const draft *d, noh_pack *pack, noh_error *error)
{
    static uint64_t memory[512];
    const size_t bytes = noh_graph_size(&d->desc);
    uint8_t *at = (uint8_t *)memory + (64u - (uintptr_t)memory % 64u) % 64u;
    noh_result result;
    assert_true(bytes + 128u < sizeof memory);
    memset(memory, 0xa5, sizeof memory);
    result = noh_graph_init(at, bytes, &d->desc, pack, error);
    for (size_t i = bytes; i < bytes + 32u; i++) assert_int_equal(at[i], 0xa5);
    return result;
}

static void a_graph_made_in_code_is_a_pack(void **state)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_graph_pack_desc desc;
    noh_graph_pack *made;
    noh_pack pack;
    draft d;
    (void)state;
    start(&d);
    if (draw_up(&d, &pack, &error)) fail_msg("%s", error.what);
    desc = desc_of(&pack);
    desc.mesh = &fixture.pack;
    made = make(&desc);
    assert_string_equal(made->source.name, "draft");
    assert_int_equal(find_state(made, noh_graph_pack_find_machine(made, "moves"), "wave"), 2);
    assert_int_equal(noh_graph_pack_find_value(made, noh_graph_pack_find_param(made, "mood"), "high"), 1);
    free(made);
}

static void refused_by_name(const draft *d, const char *what)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_pack pack;
    assert_int_equal(draw_up(d, &pack, &error), NOH_ERR_ARG);
    if (!strstr(error.what, what)) fail_msg("'%s' instead of '%s'", error.what, what);
}

/* what, then what changes */
#define LIE(what, ...)             \
    do {                           \
        start(&d);                 \
        __VA_ARGS__;               \
        refused_by_name(&d, what); \
    } while (0)

/* Names that are not there, and links that make no tree. */
static void names_in_code_are_checked(void **state)
{
    draft d;
    (void)state;
    LIE("'moves': it has no child 'rum': add it, or correct the name", d.ways[0].to = "rum");
    LIE("'moves': there is no parameter 'sped'", d.ways[0].param = "sped");
    LIE("'moves': there is no node 'wawe'", d.states[2] = "wawe");
    LIE("'leaps': there is no mask 'lower'", d.nodes[0].mask = "lower");
    LIE("'walk': its name is given twice", d.nodes[4].name = "walk");
    LIE("'moves': there is a second parent for the child 'run'", d.states[2] = "run");
    LIE("'run': it is the child of no node, and neither is 'leaps'", d.states[1] = "walk", d.states[0] = "wave",
        d.nodes[2].child_count = 2, d.nodes[2].transition_count = 0);
    LIE("'moves': it is its own descendant: remove the circle", d.states[2] = "moves", d.shot[0] = "wave",
        d.nodes[2].transition_count = 0);
}

/* What the checker of packs says, with the name of the node. */
static void values_in_code_are_checked(void **state)
{
    draft d;
    (void)state;
    LIE("'moves': a transition's condition does not suit the parameter 'speed'",
        d.ways[0].condition = NOH_WHEN_TRIGGERED);
    LIE("'leaps': it needs a trigger, and has the parameter 'speed'", d.nodes[0].param = "speed");
    LIE("'moves': it needs a value for each child, of an enum or an integer, and has 'mood'",
        start_choice(&d, NOH_NODE_SELECT, "mood"));
    LIE("'moves': two points are equal: wave", start_choice(&d, NOH_NODE_SPACE_2D, "speed"));
    LIE("'moves': points of a blend space do not rise", start_choice(&d, NOH_NODE_SPACE_1D, "speed"));
    LIE("'moves': transition has an unknown condition", d.ways[1].threshold = NAN);
    LIE("'moves': transition is not between two states", d.ways[0].to = "walk");
    LIE("'run': clip of a graph has no speed, or an unknown loop", d.nodes[4].loop = (noh_loop)7);
    LIE("'jump': graph node has a field that its kind does not have", d.nodes[1].value = 1.0f);
    LIE("'speed': range of a parameter does not fit", d.params[0].initial = 3.0f);
    LIE("'leaps': graph node of an unknown kind", d.nodes[0].kind = (noh_node_kind)300);
}

static void counts_and_names_in_code_have_limits(void **state)
{
    static char name[300];
    noh_error error;
    noh_pack pack;
    (void)state;
    memset(name, 'x', sizeof name - 1u);
    for (uint32_t lie = 0; lie < 8; lie++) {
        draft d;
        start(&d);
        switch (lie) {
        case 0: d.desc.node_count = 0; break;
        case 1: d.desc.node_count = NOH_GRAPH_NODES_MAX + 1u; break;
        case 2: d.desc.param_count = NOH_GRAPH_PARAMS_MAX + 1u; break;
        case 3: d.nodes[2].child_count = NOH_GRAPH_CHILDREN_MAX + 1u; break;
        case 4: d.nodes[2].transition_count = NOH_GRAPH_TRANSITIONS_MAX + 1u; break;
        case 5: d.nodes[3].name = name; break;
        case 6: d.desc.name = NULL; break;
        default: d.mask.joint_count = NOH_GRAPH_NAMES_MAX + 1u; break;
        }
        assert_int_equal(noh_graph_size(&d.desc), 0);
        assert_int_equal(draw_up(&d, &pack, &error), NOH_ERR_LIMIT);
        assert_int_equal(error.where, lie == 3 || lie == 4 ? 2 : lie == 5 ? 3 : 0);
    }
}

/* Any mixture of names, kinds and numbers is refused with a message, or opens, within the bytes of its size. */
static void wild_descs_stay_in_bounds(void **state)
{
    static const char *const names[] = { "walk",  "run",   "wave", "moves", "jump",
                                         "leaps", "speed", "mood", "leap",  "upper" };
    test_random r = test_random_from(11);
    uint32_t opened = 0;
    (void)state;
    for (uint32_t i = 0; i < 20000; i++) {
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_pack pack;
        draft d;
        start(&d);
        for (uint32_t changes = 1u + test_random_below(&r, 4); changes; changes--) {
            noh_graph_node_desc *n = &d.nodes[test_random_below(&r, 6)];
            const char *name = names[test_random_below(&r, TEST_COUNT(names))];
            switch (test_random_below(&r, 12)) {
            case 0: n->name = name; break;
            case 1: n->kind = (noh_node_kind)test_random_below(&r, 10); break;
            case 2: d.states[test_random_below(&r, 3)] = name; break;
            case 3: d.shot[test_random_below(&r, 2)] = name; break;
            case 4: n->param = name; break;
            case 5: n->mask = name; break;
            case 6: n->child_count = n->children == d.states ? test_random_below(&r, 4) : 0; break;
            case 7: d.ways[test_random_below(&r, 2)].to = name; break;
            case 8: d.ways[0].condition = (noh_condition)test_random_below(&r, 5); break;
            case 9: n->points = d.points; break;
            case 10: d.params[test_random_below(&r, 3)].kind = test_random_below(&r, 5); break;
            default: d.ways[1].param = name; break;
            }
        }
        if (draw_up(&d, &pack, &error) == NOH_OK) {
            opened++;
        } else {
            assert_true(error.what && error.what[0] && error.where < 6u);
        }
    }
    assert_true(opened > 500 && opened < 19000);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(graphs_are_found_by_name),
    cmocka_unit_test(parameters_have_names_ranges_and_values),
    cmocka_unit_test(states_are_played_by_name),
    cmocka_unit_test(clips_and_nodes_are_those_of_the_text),
    cmocka_unit_test(masks_are_made_of_joint_names),
    cmocka_unit_test(a_missing_clip_is_named),
    cmocka_unit_test(poses_are_added_relative_to_a_clip),
    cmocka_unit_test(a_missing_joint_is_named),
    cmocka_unit_test(impossible_descs_are_refused),
    cmocka_unit_test(a_graph_without_masks_needs_no_skeleton),
    cmocka_unit_test(a_saved_instance_plays_the_same_bits),
    cmocka_unit_test(every_flip_is_refused),
    cmocka_unit_test(repaired_flips_of_a_graph_stay_in_bounds),
    cmocka_unit_test(forged_graphs_are_refused),
    cmocka_unit_test(a_graph_made_in_code_is_a_pack),
    cmocka_unit_test(names_in_code_are_checked),
    cmocka_unit_test(values_in_code_are_checked),
    cmocka_unit_test(counts_and_names_in_code_have_limits),
    cmocka_unit_test(wild_descs_stay_in_bounds),
};

TEST_MAIN(tests, set_up, tear_down)
