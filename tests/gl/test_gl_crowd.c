/* A crowd on a stage (tools/noh/crowd/crowd_bodies.h), with and without LOD: sixty tubes that bend, bulge and fire callback
 * keys while the camera moves in among them and back. */
#include "support/gl_fixture.h"
#include "support/level_fixture.h"
#include "support/skin_asset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "crowd/crowd_bodies.h"
#include "stage/cast/stage_internal.h"
#include "stage/character/character_internal.h"
#include "stage/character/scheduler_internal.h"

#define BODIES 60u
#define FRAMES 300u
#define FRAME 800u
#define SIDE 192u
#define LEVELS 3u
#define JOINTS 9u
#define TARGETS 3u
#define KEYS 9u

static uint8_t *tube_bytes;
static fixture_levels levels;
static pack_file file;

/* ---- a tube with clips ---- */

static void fill_channel(model_channel *c, uint32_t node, model_path path, uint32_t width, float duration_s)
{
    memset(c, 0, sizeof *c);
    c->node = node;
    c->path = path;
    c->key_count = KEYS;
    c->width = width;
    c->times = test_zeros(KEYS * sizeof(float));
    c->values = test_zeros(KEYS * width * sizeof(float));
    for (uint32_t k = 0; k < KEYS; k++) {
        c->times[k] = duration_s * (float)k / (float)(KEYS - 1u);
    }
}

/* Every joint swings by at most `turn` radians. */
static void fill_swing(model_clip *clip, float duration_s, float turn, uint32_t seed)
{
    clip->duration_s = duration_s;
    clip->channel_count = JOINTS;
    clip->channels = test_zeros(JOINTS * sizeof *clip->channels);
    for (uint32_t j = 0; j < JOINTS; j++) {
        fill_channel(&clip->channels[j], j, MODEL_PATH_ROTATION, 4, duration_s);
        for (uint32_t k = 0; k < KEYS; k++) {
            float half = 0.5f * turn * sinf(6.2831853f * (float)k / (float)(KEYS - 1u) + (float)(j + seed));
            float *q = clip->channels[j].values + 4u * k;
            q[(j + seed) % 3u] = sinf(half);
            q[3] = cosf(half);
        }
    }
}

static void fill_face(model_clip *clip, float duration_s)
{
    clip->duration_s = duration_s;
    clip->channel_count = 1;
    clip->channels = test_zeros(sizeof *clip->channels);
    fill_channel(clip->channels, JOINTS, MODEL_PATH_WEIGHTS, TARGETS, duration_s);
    for (uint32_t k = 0; k < KEYS * TARGETS; k++) {
        clip->channels->values[k] = 0.5f + 0.5f * sinf((float)k * 1.7f);
    }
}

/* Two keys, at a quarter and three quarters. */
static void add_keys(model_clip *clip)
{
    clip->event_count = 2;
    clip->events = test_zeros(2 * sizeof *clip->events);
    for (uint32_t k = 0; k < 2; k++) {
        clip->events[k].time_s = clip->duration_s * (0.25f + 0.5f * (float)k);
        clip->events[k].name = model_string("step");
    }
}

/* A vertex moved by the `count` heaviest of its joints. */
static void capped_vertex(const noh_mesh *mesh, const float *matrices, uint32_t vertex, uint32_t count, float out[3])
{
    const float *p = mesh->positions + 3u * (size_t)vertex;
    uint32_t joints[NOH_INFLUENCES_MAX];
    float weights[NOH_INFLUENCES_MAX], total = 0.0f, sum[3] = { 0.0f, 0.0f, 0.0f };
    const uint32_t all = noh_mesh_influences(mesh, vertex, joints, weights);
    for (uint32_t k = 0; k < count && k < all; k++) {
        const float *m = matrices + 12u * (size_t)joints[k];
        total += weights[k];
        for (int r = 0; r < 3; r++) {
            sum[r] += weights[k] * (m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3]);
        }
    }
    for (int r = 0; r < 3; r++) {
        out[r] = sum[r] / total;
    }
}

/* How far 2 joints per vertex, and 1, are off in a pose. */
static void add_cap_errors(const noh_mesh *mesh, const float *matrices, float errors[3])
{
    for (uint32_t v = 0; v < mesh->header->vertex_count; v++) {
        float right[3], capped[3];
        capped_vertex(mesh, matrices, v, NOH_INFLUENCES_MAX, right);
        for (uint32_t i = 1; i < 3; i++) {
            capped_vertex(mesh, matrices, v, 4u >> i, capped);
            for (int r = 0; r < 3; r++) {
                capped[r] -= right[r];
            }
            errors[i] = fmaxf(errors[i], sqrtf(capped[0] * capped[0] + capped[1] * capped[1] + capped[2] * capped[2]));
        }
    }
}

/* The levels do not come out of the converter, which would have measured this. */
static void measure_caps(void)
{
    const noh_clip_bank_desc desc = { .clips = &levels.pack };
    const size_t bytes = noh_clip_bank_size(&desc, NULL);
    float errors[3] = { 0.0f, 0.0f, 0.0f }, placed[12u * JOINTS], matrices[12u * JOINTS], floats[8];
    void *memory = test_aligned(NULL, bytes);
    noh_transform pose[JOINTS];
    noh_mesh_header *headers;
    noh_clip_bank *set;
    noh_mesh mesh;
    noh_skin skin;
    assert_int_equal(noh_clip_bank_init(memory, bytes, &desc, &set, NULL), NOH_OK);
    assert_int_equal(noh_pack_mesh_at(&levels.pack, 0, &mesh, NULL), NOH_OK);
    assert_int_equal(noh_pack_skin_at(&levels.pack, mesh.header->skin, &skin, NULL), NOH_OK);
    assert_true(set->clips.joint_count == JOINTS && skin.header->joint_count <= JOINTS && set->clips.float_count <= 8);
    for (uint32_t m = 0; m < set->clips.clip_count; m++) {
        for (uint32_t tick = 0; tick <= set->clips.clips[m].duration_ticks; tick += 1600) {
            set->clips.sample(set->clips.user, m, tick, JOINTS, pose, set->clips.float_count, floats);
            noh_local_to_model(&set->skeleton, pose, JOINTS, placed);
            noh_skin_matrices(&skin, placed, matrices);
            add_cap_errors(&mesh, matrices, errors);
        }
    }
    headers = (noh_mesh_header *)(void *)(levels.bytes +
                                          levels.pack.chunks[levels.pack.runs[NOH_CHUNK_MESH].first].offset);
    for (uint32_t k = 0; k < LEVELS; k++) {
        memcpy(headers[k].influence_errors, errors, sizeof errors);
    }
    free(memory);
}

static void open_tube(void)
{
    const skin_cylinder c = { 24, 33, JOINTS, 4, TARGETS, 1, 2.0f, 0.35f };
    static const char *const names[3] = { "swing", "shake", "face" };
    model *m;
    size_t count;
    noh_pack plain;
    if (tube_bytes) {
        return;
    }
    m = skin_cylinder_model(&c);
    m->clip_count = 3;
    m->clips = test_zeros(3 * sizeof *m->clips);
    for (uint32_t i = 0; i < 3; i++) {
        m->clips[i].name = model_string(names[i]);
    }
    fill_swing(&m->clips[0], 1.5f, 0.12f, 0);
    fill_swing(&m->clips[1], 0.8f, 0.2f, 1);
    fill_face(&m->clips[2], 1.1f);
    for (uint32_t i = 0; i < 3; i++) add_keys(&m->clips[i]);
    tube_bytes = skin_pack_with_clips(m, 1.0f, &count);
    model_free(m);
    plain = test_open(tube_bytes, count);
    fixture_levels_open(&levels, &plain, LEVELS, 0.12f);
    measure_caps();
    file.path = "tubes";
    file.pack = levels.pack;
}

static int tear_down(void **state)
{
    if (tube_bytes) {
        fixture_levels_close(&levels);
        free(tube_bytes);
    }
    return fixture_tear_down(state);
}

/* ---- crowds ---- */

static void open_crowd(crowd *c, const crowd_options *options)
{
    open_tube();
    assert_int_equal(crowd_open(c, fixture_gpu(), &file, options), 0);
}

static void expect_kept(const crowd *c)
{
    assert_true(noh_gl_ledger_bytes(&c->ledger) == c->plan.gpu_bytes);
}

static crowd_options options_of(float pixels)
{
    crowd_options o;
    memset(&o, 0, sizeof o);
    o.count = BODIES;
    o.plain = pixels == 0.0f;
    o.pixels = pixels;
    o.width = o.height = SIDE;
    return o;
}

static const noh_stage_kind *kind_of(const crowd *c)
{
    return &c->stage->kinds[0];
}

static const noh_lod *lod_of(const crowd *c, uint32_t i)
{
    return &noh_stage_character(kind_of(c), i)->lod;
}

/* The camera in a frame: in among them, and back. */
static noh_stage_view camera_at(const crowd *c, uint32_t frame)
{
    const float part = (float)(frame < FRAMES / 2u ? frame : FRAMES - frame) / (float)(FRAMES / 2u);
    const float eye[3] = { 0.0f, 3.0f, 10.0f - 50.0f * part };
    return crowd_camera_at(c, eye, 0.2f * part, 0.05f);
}

static void run_frame(crowd *c, uint32_t frame)
{
    const noh_stage_view camera = camera_at(c, frame);
    crowd_frame(c, FRAME, &camera);
}

static uint8_t *picture(crowd *c)
{
    fixture_frame f;
    uint8_t *rgba;
    fixture_frame_open(&f, SIDE);
    crowd_draw(c);
    rgba = fixture_frame_read(&f);
    fixture_frame_close(&f);
    fixture_expect_no_errors();
    return rgba;
}

/* ---- what holds in every frame ---- */

typedef struct watch {
    uint32_t waits[BODIES]; /* frames in which a body has wanted a finer level than it shows, for want of its frame of
                               notice */
    uint32_t coarser, finer, fades, visible_max, seen_min, by_level[LEVELS];
    uint64_t aside; /* the most that a frame after the first had to pose whatever the budget */
} watch;

/* How many pools a kind has, and which level each is for. */
static uint32_t pools_of(const noh_stage_kind *k, uint32_t of_pools[NOH_LOD_LEVELS_MAX])
{
    uint32_t slots[NOH_LOD_LEVELS_MAX];
    return noh_stage_pools(k->plan, of_pools, slots);
}

/* No two bodies hold one slot, and no pool gives out more slots than it has. */
static void expect_slots(const crowd *c)
{
    const noh_stage_kind *k = kind_of(c);
    uint8_t taken[NOH_LOD_LEVELS_MAX][BODIES];
    uint32_t of_pools[NOH_LOD_LEVELS_MAX];
    const uint32_t pools = pools_of(k, of_pools);
    memset(taken, 0, sizeof taken);
    for (uint32_t i = 0; i < BODIES; i++) {
        const noh_stage_shown *b = &c->stage->shown[i];
        if (b->views) {
            assert_true(b->slot.pool < pools);
            assert_true(b->slot.slot < k->plan->levels[of_pools[b->slot.pool]].slot_count);
            assert_true(!taken[b->slot.pool][b->slot.slot]);
            assert_true(b->level >= of_pools[b->slot.pool] && b->level_before >= of_pools[b->slot.pool]);
            taken[b->slot.pool][b->slot.slot] = 1;
        }
    }
}

/* Each body is within its share of the error setting; or it fades, or no finer slot is free, or it has just asked for
 * one. */
static void expect_level(const crowd *c, uint32_t i, watch *w)
{
    const noh_stage_shown *b = &c->stage->shown[i];
    const float share = 0.3f * c->options.pixels;
    const int over = kind_of(c)->table.meshes[b->level].error_m * b->scale > share * 1.0001f;
    const int crowded = noh_stage_stats_of(c->stage)->coarser > 0;
    w->fades += b->level != b->level_before;
    w->by_level[b->level]++;
    w->waits[i] = over && !crowded && b->level == b->level_before ? w->waits[i] + 1u : 0;
    assert_in_range(w->waits[i], 0, 1);
    if (over && b->level == b->level_before) {
        assert_true(lod_of(c, i)->mesh_wanted < b->level);
        w->coarser += crowded != 0;
    }
    w->finer += !over;
}

static void expect_order(const crowd *c)
{
    const noh_stage_kind *k = kind_of(c);
    const uint32_t caps = noh_stage_influence_levels(k);
    uint32_t before = 0;
    for (uint32_t p = 0; p < noh_stage_seen(k); p++) {
        const noh_stage_shown *b = &c->stage->shown[k->order[p]];
        const uint32_t run = b->level == b->level_before ? b->level * caps + lod_of(c, k->order[p])->influences
                                                         : noh_stage_run_count(k);
        assert_true(b->views && b->place == p && run >= before && p >= k->runs[run]);
        before = run;
    }
}

static uint32_t update_cost(const crowd *c, uint32_t i)
{
    static const noh_cost_weights costs = { 500.0f, 40.0f, 0.0f, 0.0f };
    return noh_cost_ns(&costs, noh_character_joint_work(noh_stage_character(kind_of(c), i)), 0, 0);
}

static void watch_frame(const crowd *c, uint32_t frame, watch *w)
{
    const uint32_t seen = noh_stage_stats_of(c->stage)->seen;
    uint64_t aside = 0;
    expect_slots(c);
    expect_order(c);
    for (uint32_t i = 0; i < BODIES; i++) {
        if (c->stage->shown[i].views)
            expect_level(c, i, w);
        else
            w->waits[i] = 0;
        aside += c->stage->shown[i].due == NOH_DUE_AT_ONCE ? update_cost(c, i) : 0;
    }
    w->aside = frame && aside > w->aside ? aside : w->aside;
    w->visible_max = seen > w->visible_max ? seen : w->visible_max;
    w->seen_min = frame && seen >= w->seen_min ? w->seen_min : seen;
}

/* ---- pictures ---- */

/* The mean difference, in 1/255, of the pixels that either covers; 0 if there are none. */
static double compare_pictures(uint8_t *a, uint8_t *b)
{
    double sum = 0.0;
    uint32_t covered = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        if (a[4u * i + 3u] || b[4u * i + 3u]) {
            for (uint32_t k = 0; k < 3; k++) {
                sum += fabs((double)a[4u * i + k] - (double)b[4u * i + k]);
            }
            covered++;
        }
    }
    free(a);
    free(b);
    assert_true(covered > 200u);
    return sum / 3.0 / covered;
}

/* ---- tests ---- */

static void a_crowd_with_lod_keeps_its_word(void **state)
{
    crowd_options o = options_of(1.0f);
    const crowd_options none = options_of(0.0f);
    const noh_schedule *schedule;
    uint32_t cost_max = 0;
    uint64_t wait;
    double worst = 0.0;
    static crowd with, without;
    watch w;
    (void)state;
    memset(&w, 0, sizeof w);
    o.near_count = 3; /* fewer than the bodies that want the full level, so that some get a coarser one */
    o.middle_count = 17;
    o.budget_ns = 30000;
    open_crowd(&with, &o);
    open_crowd(&without, &none);
    schedule = &with.stage->schedule;
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        run_frame(&with, frame);
        run_frame(&without, frame);
        watch_frame(&with, frame, &w);
        for (uint32_t i = 0; i < BODIES; i++) {
            const uint32_t cost = update_cost(&with, i);
            cost_max = cost > cost_max ? cost : cost_max;
        }
        assert_true(with.events.count == without.events.count && with.events.sum == without.events.sum);
        if (frame % 50u == 49u) {
            worst = fmax(worst, compare_pictures(picture(&with), picture(&without)));
            expect_kept(&with);
        }
    }
    assert_true(o.budget_ns > w.aside + cost_max);
    wait = noh_schedule_wait_max(BODIES, o.budget_ns - w.aside, cost_max);
    print_message(
        "%u to %u seen; levels %u %u %u, %u fading, %u times none finer was left; %llu events; at most %u ticks late of %llu; "
        "pictures differ by %.2f\n",
        w.seen_min, w.visible_max, w.by_level[0], w.by_level[1], w.by_level[2], w.fades, w.coarser,
        (unsigned long long)with.events.count, schedule->late_high_water, (unsigned long long)wait * FRAME, worst);
    assert_true(wait < FRAMES && schedule->late_high_water > 0 && schedule->late_high_water <= wait * FRAME);
    assert_int_equal(schedule->lost, 0);
    assert_true(with.events.count > 100 && w.seen_min < w.visible_max);
    assert_true(w.by_level[0] && w.by_level[1] && w.by_level[2] && w.fades && w.coarser);
    assert_true(worst < 12.0);
    crowd_close(&with);
    crowd_close(&without);
}

/* Without detail every body that is seen has, in every frame, the exact pose of its tracks, and all weights. */
static void without_lod_nothing_is_left_out(void **state)
{
    const crowd_options none = options_of(0.0f);
    static crowd c;
    const noh_stage_kind *k;
    noh_character_scratch scratch;
    noh_character_desc desc;
    float *matrices, *floats;
    void *memory;
    size_t bytes;
    uint32_t compared = 0;
    (void)state;
    open_crowd(&c, &none);
    k = kind_of(&c);
    desc = noh_stage_character_desc(k, 0);
    bytes = noh_character_scratch_size(&desc);
    memory = test_aligned(NULL, bytes);
    matrices = test_zeros(12u * k->skeleton.joint_count * sizeof *matrices);
    floats = test_zeros((k->set.float_count + 1u) * sizeof *floats);
    assert_int_equal(noh_character_scratch_init(memory, bytes, &desc, &scratch, NULL), NOH_OK);
    for (uint32_t frame = 0; frame < 60; frame++) {
        run_frame(&c, frame);
        for (uint32_t i = 0; i < BODIES && frame % 6u == 5u; i++) {
            noh_character *ch = noh_stage_character(k, i);
            if (!c.stage->shown[i].views) continue;
            noh_controller_pose(noh_character_controller(ch), &k->set, &scratch.pose, scratch.local, floats);
            noh_local_to_model(&k->skeleton, scratch.local, k->skeleton.joint_count, scratch.model);
            assert_memory_equal(noh_character_palette(ch, matrices, k->skeleton.joint_count), scratch.model,
                                12u * k->skeleton.joint_count * sizeof *matrices);
            assert_memory_equal(noh_actor_floats(c.stage, noh_stage_actor_at(c.stage, i)), floats,
                                k->set.float_count * sizeof *floats);
            assert_int_equal(c.stage->shown[i].level, 0);
            compared++;
        }
    }
    assert_true(compared > 5u * BODIES && k->set.float_count >= TARGETS);
    free(floats);
    free(matrices);
    free(memory);
    crowd_close(&c);
}

/* With an allowed error of half the view, distant bodies are posed with fewer joints and drawn with fewer joints per
 * vertex, and still seen. */
static void far_bodies_hang_on_fewer_joints(void **state)
{
    const crowd_options o = options_of(96.0f), none = options_of(0.0f);
    uint32_t fewer_joints = 0, fewer_influences = 0;
    static crowd with, without;
    const noh_lod_table *t;
    (void)state;
    open_crowd(&with, &o);
    open_crowd(&without, &none);
    t = &kind_of(&with)->table;
    assert_true(t->joint_level_count > 1 && t->influence_level_count == 3);
    for (uint32_t frame = 0; frame < 12; frame++) {
        run_frame(&with, frame);
        run_frame(&without, frame);
        expect_order(&with);
        for (uint32_t i = 0; i < BODIES; i++) {
            const noh_stage_shown *b = &with.stage->shown[i];
            const noh_lod *d = lod_of(&with, i);
            if (!b->views) continue;
            fewer_joints += d->joints > 0;
            fewer_influences += d->influences > 0;
            assert_true(t->joints[d->joints].error_m * b->scale <= 9.6f * 1.0001f);
            assert_true(t->influences[d->influences].error_m * b->scale <= 4.8f * 1.0001f);
        }
        assert_true(with.events.sum == without.events.sum);
    }
    print_message("%u times fewer joints, %u times fewer a vertex; pictures differ by %.2f\n", fewer_joints,
                  fewer_influences, compare_pictures(picture(&with), picture(&without)));
    assert_true(fewer_joints && fewer_influences);
    expect_kept(&with);
    crowd_close(&with);
    crowd_close(&without);
}

/* Pools save memory, because fewer accumulators are full-sized. */
static void pools_by_level_take_less(void **state)
{
    const crowd_options o = options_of(4.0f), none = options_of(0.0f);
    static crowd with, without;
    uint32_t of_pools[NOH_LOD_LEVELS_MAX];
    (void)state;
    open_crowd(&with, &o);
    open_crowd(&without, &none);
    assert_true(pools_of(kind_of(&with), of_pools) > 1 && pools_of(kind_of(&without), of_pools) == 1);
    assert_true(with.plan.gpu_bytes < without.plan.gpu_bytes);
    expect_kept(&with);
    expect_kept(&without);
    crowd_close(&with);
    crowd_close(&without);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_crowd_with_lod_keeps_its_word),
    cmocka_unit_test(without_lod_nothing_is_left_out),
    cmocka_unit_test(far_bodies_hang_on_fewer_joints),
    cmocka_unit_test(pools_by_level_take_less),
};

TEST_MAIN(tests, NULL, tear_down)
