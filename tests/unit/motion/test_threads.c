/* Controllers of one clip set posed by four threads at once, each through its own view: the same bits
 * as one thread, and (tests/tsan.sh) no race.
 * cross: long, poses a crowd four times */
#define _POSIX_C_SOURCE 200112L
#include "support/set_fixture.h"
#include "motion/anim/controller_internal.h"
#include "motion/anim/controller_pose_internal.h"
#include "motion/anim/tracks_internal.h"
#include "motion/clip/clip_view_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"

#include <pthread.h>

#define THREADS 4u
#define INSTANCES 240u
#define FRAMES 40u
#define JOINTS 12u
#define CLIPS 5u
#define STEP 800u /* 60 Hz */
#define AHEAD 9600u
#define HALF_ENOUGH 400u /* track-frames in a frame: some segments are decoded ahead, some late */

typedef struct instance {
    noh_controller *c;
    void *memory;
} instance;

/* The result of posing one instance in one frame. */
typedef struct result {
    noh_transform pose[JOINTS];
    float floats[CLIPS + 1u];
    noh_root_pose root;
} result;

typedef struct crowd {
    noh_clip_bank *set;
    instance instances[INSTANCES];
    result *results; /* [FRAMES][INSTANCES] */
    uint32_t keys[INSTANCES];
    pthread_barrier_t barrier;
} crowd;

typedef struct worker {
    crowd *crowd;
    uint32_t index, thread_count;
    noh_clip_bank_view *view; /* NULL: poses through the set itself */
    noh_pose_scratch scratch;
    void *view_memory, *scratch_memory;
} worker;

static set_fixture fixture;

static int set_up(void **state)
{
    static const uint32_t frames[CLIPS] = { 240, 61, 130, 20, 97 };
    (void)state;
    fixture = set_fixture_make(JOINTS, CLIPS, frames);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(fixture.bytes);
    return 0;
}

static noh_clip_bank *open_set(uint32_t slot_count)
{
    noh_clip_bank_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.clips = &fixture.pack;
    desc.root_axes = NOH_ROOT_X | NOH_ROOT_Z;
    desc.root_up = 1;
    desc.cached_segment_count = slot_count;
    desc.instance_count = INSTANCES;
    return test_clip_bank(&desc);
}

/* ---- a crowd ---- */

/* Two tracks each: one in each group, at every speed and place. */
static void start_tracks(instance *in, const noh_clip_set *set, uint32_t number, test_random *r)
{
    for (uint32_t t = 0; t < 2u; t++) {
        noh_track_desc desc;
        memset(&desc, 0, sizeof desc);
        desc.clip = test_random_below(r, CLIPS);
        desc.position_ticks = test_random_below(r, 300000);
        desc.speed = (int32_t)(NOH_SPEED_ONE / 2 + (int32_t)test_random_below(r, 2 * NOH_SPEED_ONE)) *
                     (number % 3u ? 1 : -1);
        desc.weight = t ? 0.6f : 0.0f;
        desc.loop = number % 2u ? NOH_LOOP_REPEAT : NOH_LOOP_PING_PONG;
        desc.group = t ? NOH_GROUP_HIGH : NOH_GROUP_LOW;
        desc.flags = t && number % 5u == 0u ? NOH_TRACK_ADDITIVE : 0u;
        assert_int_equal(noh_controller_start(in->c, set, t, &desc, NULL), NOH_OK);
    }
}

static crowd *crowd_open(uint32_t slot_count)
{
    crowd *x = test_zeros(sizeof *x);
    test_random r = test_random_from(7);
    noh_controller_desc desc;
    x->set = open_set(slot_count);
    x->results = test_zeros(FRAMES * INSTANCES * sizeof *x->results);
    memset(&desc, 0, sizeof desc);
    desc.set = &x->set->clips;
    desc.flags = NOH_CONTROLLER_INERTIAL;
    for (uint32_t i = 0; i < INSTANCES; i++) {
        const size_t bytes = noh_controller_size(&desc);
        x->instances[i].memory = test_aligned(NULL, bytes);
        assert_int_equal(noh_controller_init(x->instances[i].memory, bytes, &desc, &x->instances[i].c, NULL), NOH_OK);
        start_tracks(&x->instances[i], &x->set->clips, i, &r);
    }
    return x;
}

static void crowd_close(crowd *x)
{
    for (uint32_t i = 0; i < INSTANCES; i++) {
        free(x->instances[i].memory);
    }
    free(x->results);
    free(x->set);
    free(x);
}

static void worker_open(worker *w, crowd *x, uint32_t index, uint32_t thread_count, int through_view)
{
    const size_t view_bytes = noh_clip_bank_view_size(x->set), bytes = noh_pose_scratch_size(&x->set->clips, 1);
    memset(w, 0, sizeof *w);
    w->crowd = x;
    w->index = index;
    w->thread_count = thread_count;
    w->scratch_memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_pose_scratch_init(w->scratch_memory, bytes, &x->set->clips, 1, &w->scratch, NULL), NOH_OK);
    if (through_view) {
        w->view_memory = test_aligned(NULL, view_bytes);
        assert_int_equal(noh_clip_bank_view_init(w->view_memory, view_bytes, x->set, &w->view, NULL), NOH_OK);
    }
}

static void worker_close(worker *w)
{
    free(w->view_memory);
    free(w->scratch_memory);
}

/* ---- a frame ---- */

/* Instances move from thread to thread. */
static int is_mine(const worker *w, uint32_t i, uint32_t frame)
{
    return (i + frame) % w->thread_count == w->index;
}

static void count_key(void *user, const noh_event *event)
{
    (void)event;
    ++*(uint32_t *)user;
}

static void step_mine(worker *w, uint32_t frame)
{
    const noh_clip_set *set = w->view ? &w->view->clips : &w->crowd->set->clips;
    for (uint32_t i = 0; i < INSTANCES; i++) {
        if (is_mine(w, i, frame)) {
            (void)noh_controller_step(w->crowd->instances[i].c, set, STEP, count_key, &w->crowd->keys[i]);
        }
    }
}

/* Every seventh instance changes its clip by inertia now and then. */
static void change_clip(worker *w, const noh_clip_set *set, uint32_t i, uint32_t frame)
{
    noh_controller *c = w->crowd->instances[i].c;
    noh_track_desc desc;
    if (i % 7u || frame % 10u != 5u) return;
    memset(&desc, 0, sizeof desc);
    desc.clip = (i + frame) % CLIPS;
    desc.position_ticks = 100 * frame;
    (void)noh_controller_inertia_capture(c, set, &w->scratch, NULL);
    (void)noh_controller_start(c, set, 0, &desc, NULL);
    (void)noh_controller_inertia_begin(c, set, &w->scratch, 9600, NULL);
}

static void pose_mine(worker *w, uint32_t frame)
{
    const noh_clip_set *set = w->view ? &w->view->clips : &w->crowd->set->clips;
    for (uint32_t i = 0; i < INSTANCES; i++) {
        result *r = &w->crowd->results[frame * INSTANCES + i];
        if (is_mine(w, i, frame)) {
            change_clip(w, set, i, frame);
            r->root = noh_controller_root_motion(w->crowd->instances[i].c, set);
            noh_controller_pose(w->crowd->instances[i].c, set, &w->scratch, r->pose, r->floats);
        }
    }
}

static void decode_ahead(crowd *x)
{
    noh_clip_cache_begin_frame(x->set->cache);
    for (uint32_t i = 0; i < INSTANCES; i++) {
        (void)noh_clip_bank_prefetch(x->set, x->instances[i].c, AHEAD);
    }
    (void)noh_clip_cache_work(x->set->cache, HALF_ENOUGH);
}

static void *work(void *user)
{
    worker *w = user;
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        step_mine(w, frame);
        (void)pthread_barrier_wait(&w->crowd->barrier);
        if (w->index == 0u) decode_ahead(w->crowd);
        (void)pthread_barrier_wait(&w->crowd->barrier);
        pose_mine(w, frame);
        (void)pthread_barrier_wait(&w->crowd->barrier);
    }
    return NULL;
}

/* Returns how many segments views decoded for themselves. */
static uint64_t run(crowd *x, uint32_t thread_count, int through_views)
{
    pthread_t threads[THREADS];
    worker workers[THREADS];
    uint64_t misses = 0;
    assert_int_equal(pthread_barrier_init(&x->barrier, NULL, thread_count), 0);
    for (uint32_t i = 0; i < thread_count; i++) {
        worker_open(&workers[i], x, i, thread_count, through_views);
    }
    for (uint32_t i = 1; i < thread_count; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, work, &workers[i]), 0);
    }
    (void)work(&workers[0]);
    for (uint32_t i = 1; i < thread_count; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    }
    for (uint32_t i = 0; i < thread_count; i++) {
        if (through_views) {
            const noh_clip_cache_stats stats = noh_clip_view_stats_of(workers[i].view->samples);
            misses += stats.misses;
        }
        worker_close(&workers[i]);
    }
    (void)pthread_barrier_destroy(&x->barrier);
    return misses;
}

/* ---- tests ---- */

static void expect_same(const crowd *a, const crowd *b)
{
    for (uint32_t i = 0; i < FRAMES * INSTANCES; i++) {
        const result *x = &a->results[i], *y = &b->results[i];
        if (memcmp(x->pose, y->pose, sizeof x->pose) ||
            memcmp(x->floats, y->floats, a->set->clips.float_count * sizeof *x->floats) ||
            memcmp(&x->root, &y->root, sizeof x->root)) {
            fail_msg("instance %u differs in frame %u", (unsigned)(i % INSTANCES), (unsigned)(i / INSTANCES));
        }
    }
    assert_memory_equal(a->keys, b->keys, sizeof a->keys);
}

static void four_threads_give_the_bits_of_one(void **state)
{
    static const uint32_t slots[] = { 0, 12, 2 }; /* for all that plays, for some of it, for hardly any */
    (void)state;
    for (size_t k = 0; k < TEST_COUNT(slots); k++) {
        crowd *alone = crowd_open(slots[k]), *one = crowd_open(slots[k]), *four = crowd_open(slots[k]);
        assert_int_equal(alone->set->clips.float_count, CLIPS + 1u);
        (void)run(alone, 1, 0);
        (void)run(one, 1, 1);
        assert_true(run(four, THREADS, 1) > 0u); /* some late, else the views' own segments show nothing */
        expect_same(alone, one);
        expect_same(alone, four);
        crowd_close(alone);
        crowd_close(one);
        crowd_close(four);
    }
}

/* Whether segments are cached in full, in part or not at all, a view gives the cache's bits and writes only to itself.
 */
static void a_view_only_reads(void **state)
{
    test_random r = test_random_from(5);
    noh_clip_bank_desc desc;
    noh_clip_bank *set, *other = open_set(0);
    noh_clip_bank_view *view;
    noh_transform expected[JOINTS], pose[JOINTS];
    float expected_floats[CLIPS + 1u], floats[CLIPS + 1u];
    uint8_t *memory, *copy, *view_memory;
    size_t bytes;
    (void)state;
    memset(&desc, 0, sizeof desc);
    desc.clips = &fixture.pack;
    desc.cached_segment_count = 4;
    bytes = noh_clip_bank_size(&desc, NULL);
    memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_clip_bank_init(memory, bytes, &desc, &set, NULL), NOH_OK);
    view_memory = test_aligned(NULL, noh_clip_bank_view_size(set));
    assert_int_equal(noh_clip_bank_view_init(view_memory, noh_clip_bank_view_size(set), set, &view, NULL), NOH_OK);
    for (int i = 0; i < 2000; i++) {
        const uint32_t clip = test_random_below(&r, CLIPS),
                       tick = test_random_below(&r, set->clips.clips[clip].duration_ticks + 1u);
        const uint32_t joints = test_random_below(&r, JOINTS + 1u);
        noh_clip_cache_begin_frame(set->cache);
        (void)noh_clip_cache_want(set->cache, clip, (int64_t)tick - (int64_t)test_random_below(&r, 20000),
                                  test_random_below(&r, JOINTS + 1u));
        (void)noh_clip_cache_work(set->cache, test_random_below(&r, 300));
        copy = test_aligned(memory, bytes);
        memset(pose, 0x55, sizeof pose);
        memset(expected, 0x55, sizeof expected);
        view->clips.sample(view->clips.user, clip, tick, joints, pose, set->clips.float_count, floats);
        assert_memory_equal(copy, memory, bytes);
        free(copy);
        other->clips.sample(other->clips.user, clip, tick, joints, expected, set->clips.float_count, expected_floats);
        assert_memory_equal(pose, expected, sizeof pose);
        assert_memory_equal(floats, expected_floats, set->clips.float_count * sizeof *floats);
    }
    assert_true(noh_clip_view_stats_of(view->samples).decoded_late > 0u);
    assert_true(noh_clip_view_stats_of(view->samples).samples == 2000u);
    free(view_memory);
    free(memory);
    free(other);
}

/* A clip that plays without having been asked for is decoded once a segment, not once a sample. */
static void a_view_keeps_what_it_decoded(void **state)
{
    noh_clip_bank *set = open_set(2);
    uint8_t *memory = test_aligned(NULL, noh_clip_bank_view_size(set));
    noh_clip_bank_view *view;
    noh_transform pose[JOINTS];
    float floats[CLIPS + 1u];
    (void)state;
    assert_int_equal(noh_clip_bank_view_init(memory, noh_clip_bank_view_size(set), set, &view, NULL), NOH_OK);
    for (uint32_t tick = 0; tick < set->clips.clips[0].duration_ticks; tick += 100) {
        view->clips.sample(view->clips.user, 0, tick, JOINTS, pose, set->clips.float_count, floats);
    }
    assert_in_range(noh_clip_view_stats_of(view->samples).misses, 5, 20); /* 240 frames, up to 64 in a segment */
    free(memory);
    free(set);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(four_threads_give_the_bits_of_one),
    cmocka_unit_test(a_view_only_reads),
    cmocka_unit_test(a_view_keeps_what_it_decoded),
};

TEST_MAIN(tests, set_up, tear_down)
