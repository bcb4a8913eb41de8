/* Clips of another skeleton on actors of a kind, through a map: the pose is the map's, near what `noh build --retarget`
 * makes; planned to the byte; they mix with the kind's own clips, and are saved, restored and forked for any number of
 * jobs, in place and from a reserve. */
#include <math.h>

#include "support/stage_fixture.h"

#include "convert/clips/raw_set.h"
#include "convert/clips/rcl.h"
#include "convert/convert.h"
#include "convert/retarget/bones.h"
#include "convert/retarget/feet.h"
#include "convert/retarget/retarget_set.h"
#include "convert/sources.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/low_motion.h"
#include "noh/modules.h"

#define LENDER 1u /* the second pack of the cast */
#define ACTORS 3u
#define JOINTS 128u

static noh_error said;

typedef struct show {
    cast c;
    byte_buffer bytes;
    const noh_pack *packs[2];
    noh_skeleton skeletons[2]; /* source, target */
    noh_retarget_rig rigs[2];
    noh_retarget map;
    noh_retarget_joint joints[JOINTS];
    noh_stage_view view;
    noh_actor actors[ACTORS];
    const char *clip;
} show;

/* A recording as a pack of its own. */
static void lend(show *w, const char *name)
{
    char path[64];
    const char *input;
    convert_options options;
    convert_failure failure;
    (void)snprintf(path, sizeof path, "clips/%s.rcl", name);
    input = test_asset(path);
    memset(&options, 0, sizeof options);
    if (convert_files(&input, 1, &options, &w->bytes, &failure)) fail_msg("%s", failure.error.what);
    w->c.packs[LENDER] = test_open(w->bytes.bytes, w->bytes.count);
    w->clip = noh_pack_chunk_name(&w->c.packs[LENDER], w->c.packs[LENDER].runs[NOH_CHUNK_CLIP].first);
}

static void make_rig(show *w, int which, const noh_pack *pack)
{
    noh_ragdoll_source from = { .pack = pack };
    if (noh_pack_skeleton_at(pack, 0, &from.joints, NULL, &said) ||
        noh_retarget_rig_make(&from, &w->rigs[which], &said))
        fail_msg("%s", said.what);
    w->skeletons[which] = from.joints;
    w->rigs[which].skeleton = &w->skeletons[which];
    assert_in_range(from.joints.joint_count, 1, JOINTS);
}

static void make_map(show *w)
{
    if (noh_retarget_init(&w->map, &w->rigs[0], &w->rigs[1], NOH_RETARGET_FEET | NOH_RETARGET_HANDS, w->joints, &said))
        fail_msg("%s", said.what);
}

static void open_show(show *w, const char *recording, uint32_t jobs)
{
    memset(w, 0, sizeof *w);
    cast_map(&w->c, PUPPETS, "demo/puppet_levels.noh");
    lend(w, recording);
    w->packs[0] = &w->c.packs[PUPPETS];
    w->packs[1] = &w->c.packs[LENDER];
    make_rig(w, 0, w->packs[1]);
    make_rig(w, 1, w->packs[0]);
    w->map.clips = (noh_clip_map){ &w->skeletons[0], &w->skeletons[1], 1.0f, NULL, 0 };
    w->c.kinds[0].mesh = &w->c.packs[PUPPETS];
    w->c.kinds[0].clip_packs = w->packs;
    w->c.kinds[0].clip_pack_count = 2;
    w->c.kinds[0].actor_count = ACTORS;
    w->c.kinds[0].inertia = 1;
    w->c.kinds[0].map = &w->map.clips;
    w->c.desc.kinds = w->c.kinds;
    w->c.desc.kind_count = 1;
    w->c.desc.job_count = jobs;
    noh_view_orbit(&w->view, (const float[3]){ 0.0f, 1.0f, 0.0f }, 0.3f, 0.1f, 4.0f, 640, 360);
}

static void enter(show *w)
{
    const noh_appearance look = { .posed = 1 };
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_place place = { .position = { 0.8f * (float)i, 0.0f, 0.0f } };
        assert_int_equal(noh_stage_spawn(w->c.stage, 0, i ? &place : NULL, &w->actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(w->c.stage, w->actors[i], &look, NULL), NOH_OK);
    }
}

static void close_show(show *w)
{
    cast_close_stage(&w->c);
    noh_file_unmap(&w->c.files[0]);
    buffer_free(&w->bytes);
}

static void play(show *w, uint32_t actor, const char *clip, uint32_t fade)
{
    const noh_play how = { .fade_ticks = fade };
    if (noh_actor_play(w->c.stage, w->actors[actor], 0, clip, &how, &said)) fail_msg("%s", said.what);
}

static void frame(show *w, uint32_t ticks)
{
    assert_int_equal(noh_stage_frame(w->c.stage, ticks, &w->view, NULL, NULL, &said), NOH_OK);
}

/* ---- poses ---- */

/* A bank of the recording's own skeleton, sampled by hand. */
typedef struct lender {
    void *memory;
    noh_clip_bank *bank;
} lender;

static lender open_lender(const show *w)
{
    const noh_clip_bank_desc desc = { .clips = w->packs[1] };
    lender l;
    const size_t bytes = noh_clip_bank_size(&desc, &said);
    l.memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_clip_bank_init(l.memory, bytes, &desc, &l.bank, &said), NOH_OK);
    return l;
}

/* Joints in the world, less `from`. */
static void expect_shown(const show *w, const noh_transform *pose, const float from[3], float error)
{
    static float matrices[12 * JOINTS];
    noh_local_to_model(&w->skeletons[1], pose, w->skeletons[1].joint_count, matrices);
    for (uint32_t j = 0; j < w->skeletons[1].joint_count; j++) {
        float m[12];
        assert_int_equal(noh_actor_joint(w->c.stage, w->actors[0], j, m, &said), NOH_OK);
        for (uint32_t i = 0; i < 12; i++) {
            const float wanted = matrices[12u * j + i] - (i % 4u == 3u ? from[i / 4u] : 0.0f);
            if (fabsf(m[i] - wanted) > error) fail_msg("joint %u, %u: %g, not %g", j, i, (double)m[i], (double)wanted);
        }
    }
}

static void the_pose_is_the_maps(void **state)
{
    static const char *const recordings[] = { "Knight__Walking_A", "Knight__Jump_Full_Long" };
    (void)state;
    for (uint32_t r = 0; r < TEST_COUNT(recordings); r++) {
        static const float nowhere[3];
        noh_transform from[JOINTS], to[JOINTS];
        show w;
        open_show(&w, recordings[r], 1);
        make_map(&w);
        w.c.desc.full_detail = 1;
        cast_make(&w.c, NULL);
        enter(&w);
        play(&w, 0, w.clip, 1);
        const lender l = open_lender(&w);
        for (uint32_t f = 1; f < 40; f++) {
            frame(&w, 700);
            const noh_track *track = noh_actor_track(w.c.stage, w.actors[0], 0);
            const uint32_t tick = (uint32_t)(track->position / 65536);
            l.bank->clips.sample(l.bank->clips.user, 0, tick, w.skeletons[0].joint_count, from, 0, NULL);
            noh_retarget_pose(&w.map, from, NULL, w.skeletons[1].joint_count, to);
            expect_shown(&w, to, nowhere, 2e-5f);
        }
        free(l.memory);
        close_show(&w);
    }
}

/* Hips that are joint 0 go down for legs with a wide stance. What root motion takes from the pose, the place gets, so
 * joints are in the world where the whole pose has them. */
static void root_motion_is_of_the_pose_that_is_shown(void **state)
{
    noh_transform from[JOINTS], to[JOINTS];
    float start[3], low = 0.0f;
    show w;
    (void)state;
    open_show(&w, "Knight__Jump_Full_Long", 1);
    w.rigs[1].bones[NOH_BONE_HIPS] = 0;
    w.rigs[1].bones[NOH_BONE_ROOT] = NOH_JOINT_ROOT;
    make_map(&w);
    for (int i = 0; i < 2; i++) w.map.limbs[i].stance[0] += (i ? -0.5f : 0.5f) * w.map.limbs[i].length;
    w.c.kinds[0].root_axes = NOH_ROOT_X | NOH_ROOT_Y | NOH_ROOT_Z;
    w.c.desc.full_detail = 1;
    cast_make(&w.c, NULL);
    enter(&w);
    play(&w, 0, w.clip, 1);
    const lender l = open_lender(&w);
    for (uint32_t f = 0; f < 40; f++) {
        uint32_t tick = 0;
        if (f) {
            frame(&w, 1400);
            tick = (uint32_t)(noh_actor_track(w.c.stage, w.actors[0], 0)->position / 65536);
        }
        l.bank->clips.sample(l.bank->clips.user, 0, tick, w.skeletons[0].joint_count, from, 0, NULL);
        noh_retarget_pose(&w.map, from, NULL, 1, to);
        const float alone = to[0].translation[1];
        noh_retarget_pose(&w.map, from, NULL, w.skeletons[1].joint_count, to);
        low = fmaxf(low, alone - to[0].translation[1]);
        if (!f) memcpy(start, to[0].translation, sizeof start);
        if (f) expect_shown(&w, to, start, 1e-3f);
    }
    assert_true(low > 0.02f);
    free(l.memory);
    close_show(&w);
}

/* The bind pose of a clip's own skeleton is what its difference is taken from. */
static void bind_poses_are_those_of_the_source(void **state)
{
    const noh_play how = { .fade_ticks = 1, .flags = NOH_PLAY_FROM_BIND };
    const float nothing[3] = { 0.0f, 0.0f, 0.0f };
    noh_transform from[JOINTS], bind[JOINTS], to[JOINTS], pose[JOINTS];
    show w;
    (void)state;
    open_show(&w, "Knight__Walking_A", 1);
    make_map(&w);
    w.c.desc.full_detail = 1;
    cast_make(&w.c, NULL);
    enter(&w);
    if (noh_actor_play(w.c.stage, w.actors[0], 2, w.clip, &how, &said)) fail_msg("%s", said.what);
    const lender l = open_lender(&w);
    const uint32_t count = w.skeletons[1].joint_count;
    noh_retarget_pose(&w.map, w.skeletons[0].bind_pose, NULL, count, bind);
    for (uint32_t f = 0; f < 5; f++) {
        frame(&w, 3000);
        const uint32_t tick = (uint32_t)(noh_actor_track(w.c.stage, w.actors[0], 2)->position / 65536);
        l.bank->clips.sample(l.bank->clips.user, 0, tick, w.skeletons[0].joint_count, from, 0, NULL);
        noh_retarget_pose(&w.map, from, NULL, count, to);
        noh_pose_difference(count, bind, to, to);
        memcpy(pose, w.skeletons[1].bind_pose, count * sizeof *pose);
        noh_pose_add(count, to, 1.0f, NULL, pose);
        expect_shown(&w, pose, nothing, 1e-4f);
    }
    free(l.memory);
    close_show(&w);
}

/* ---- what the converter makes ---- */

static uint32_t joint_named(const noh_pack *pack, const char *name, uint32_t count)
{
    uint32_t j = 0;
    while (j < count && strcmp(noh_pack_joint_name(pack, 0, j), name) != 0) j++;
    return j;
}

/* The bones that the converter finds, so that both maps are of the same joints. */
static void take_bones(const show *w, int which, const raw_skeleton *raw, noh_retarget_rig *rig)
{
    uint16_t bones[NOH_BONES];
    bones_find(raw, bones);
    for (uint32_t b = 0; b < NOH_BONES; b++) {
        rig->bones[b] = NOH_JOINT_ROOT;
        if (bones[b] == NOH_JOINT_ROOT) continue;
        const uint32_t j = joint_named(w->packs[1 - which], raw->joints[bones[b]].name, rig->skeleton->joint_count);
        if (j < rig->skeleton->joint_count) rig->bones[b] = (uint16_t)j;
    }
}

static float ground_of(const raw_set *set, const raw_skeleton *to)
{
    uint16_t bones[2][NOH_BONES];
    double ground = 0.0;
    int failed = 0;
    bones_find(&set->skeleton, bones[0]);
    bones_find(to, bones[1]);
    contacts *stands = contacts_find(&set->skeleton, &set->clips[0], &failed);
    const retarget_pair pair = { { &set->skeleton, to }, { &set->clips[0], NULL }, { bones[0], bones[1] }, stands };
    assert_false(failed || feet_ground(&pair, &ground));
    contacts_free(stands);
    return (float)ground;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

#define SAMPLES_MAX 40000u

/* On the same ground, the converter also holds feet where they stand, over the whole clip: legs differ by that, all by
 * the error of the recording's own pack. */
static void it_is_near_what_the_converter_makes(void **state)
{
    static const char *const recordings[] = { "Knight__Walking_A", "RobotExpressive__Walking" };
    static double off[SAMPLES_MAX], object[12 * JOINTS];
    const char *build = getenv("NOH_BUILD");
    const source_options options = { .unit_cm = 0.0 };
    char path[1024];
    model_error error;
    source figure;
    (void)state;
    for (uint32_t r = 0; r < TEST_COUNT(recordings); r++) { /* skip before anything is allocated */
        (void)snprintf(path, sizeof path, "clips/%s.rcl", recordings[r]);
        (void)test_asset(path);
    }
    (void)snprintf(path, sizeof path, "%s/demo/puppet.glb", build ? build : "build");
    if (source_read(path, &options, &figure, &error)) fail_msg("%s", error.what);
    const raw_skeleton *puppet = &figure.sets[0]->skeleton;
    for (uint32_t r = 0; r < TEST_COUNT(recordings); r++) {
        show w;
        raw_set *set;
        uint32_t count = 0;
        (void)snprintf(path, sizeof path, "clips/%s.rcl", recordings[r]);
        open_show(&w, recordings[r], 1);
        if (rcl_read(test_asset(path), &set, &error)) fail_msg("%s", error.what);
        take_bones(&w, 0, &set->skeleton, &w.rigs[0]);
        take_bones(&w, 1, puppet, &w.rigs[1]);
        make_map(&w);
        w.map.ground = ground_of(set, puppet);
        if (retarget_set(set, puppet, NULL, NULL, &error)) fail_msg("%s", error.what);
        w.c.desc.full_detail = 1;
        cast_make(&w.c, NULL);
        enter(&w);
        play(&w, 0, w.clip, 1);
        const raw_clip *clip = &set->clips[0];
        const uint32_t step = (uint32_t)(NOH_TICKS_PER_SECOND / clip->sample_rate_hz + 0.5);
        for (uint32_t f = 1; f + 1u < clip->frame_count && f < 200u; f++) {
            frame(&w, step);
            if (f % 4u) continue;
            raw_pose_object(puppet, clip, f, object);
            for (uint32_t j = 0; j < puppet->joint_count; j++) {
                const uint32_t own = joint_named(w.packs[0], puppet->joints[j].name, w.skeletons[1].joint_count);
                float m[12];
                double square = 0.0;
                if (own == w.skeletons[1].joint_count) continue;
                assert_int_equal(noh_actor_joint(w.c.stage, w.actors[0], own, m, &said), NOH_OK);
                for (uint32_t i = 0; i < 3; i++) {
                    const double by = (double)m[4u * i + 3u] - object[12u * j + 9u + i] * puppet->unit_cm / 100.0;
                    square += by * by;
                }
                assert_true(count < SAMPLES_MAX);
                off[count++] = 100.0 * sqrt(square);
            }
        }
        qsort(off, count, sizeof *off, by_size);
        print_message("# %s: joints off by %.2f cm in the median, %.2f in 95 %%, at most %.2f\n", recordings[r],
                      off[count / 2u], off[count * 95u / 100u], off[count - 1u]);
        assert_true(count > 200u && off[count / 2u] < 0.02 && off[count * 95u / 100u] < 0.05 && off[count - 1u] < 5.0);
        raw_set_free(set);
        close_show(&w);
    }
    source_free(&figure);
}

/* ---- bytes ---- */

static void the_plan_has_its_bytes(void **state)
{
    for (uint32_t jobs = 1; jobs < 4; jobs += 2) {
        noh_stage_plan with, whole, without;
        show w;
        (void)state;
        open_show(&w, "Knight__Walking_A", jobs);
        make_map(&w);
        assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &with, &said), NOH_OK);
        w.c.kinds[0].map = NULL;
        assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &without, &said), NOH_OK);
        assert_int_equal(with.kinds[0].clips.clip_count, without.kinds[0].clips.clip_count + 1u);
        /* of the recording's own skeleton the same clip needs no pose of another */
        const noh_clip_bank_desc own = { .clips = w.packs[1] },
                                 mapped = { .clips = w.packs[1], .mesh = w.packs[0], .map = &w.map.clips };
        noh_clip_bank_needs a, b;
        assert_int_equal(noh_clip_bank_measure(&own, &a, &said), NOH_OK);
        assert_int_equal(noh_clip_bank_measure(&mapped, &b, &said), NOH_OK);
        const size_t pose = w.skeletons[0].joint_count * sizeof(noh_transform);
        assert_in_range(b.view_bytes - a.view_bytes, pose - 16u, pose + 16u);
        w.c.kinds[0].map = &w.map.clips;
        cast_make(&w.c, NULL); /* in exactly these bytes, and written past nowhere */
        whole = w.c.plan;
        assert_int_equal(whole.cpu_bytes, with.cpu_bytes);
        assert_int_equal(whole.state_bytes, with.state_bytes);
        close_show(&w);
    }
}

/* ---- state ---- */

static void act(show *w, int from, int to)
{
    for (int i = from; i < to; i++) {
        if (i % 30 == 0) play(w, (uint32_t)(i / 30) % ACTORS, i % 60 ? "walk" : w->clip, 12000);
        frame(w, CAST_STEP);
    }
}

/* Of the matrices that are shown. */
static uint64_t shown(const show *w)
{
    uint64_t sum = 14695981039346656037u;
    for (uint32_t i = 0; i < ACTORS; i++) {
        for (uint32_t j = 0; j < w->skeletons[1].joint_count; j++) {
            float m[12];
            assert_int_equal(noh_actor_joint(w->c.stage, w->actors[i], j, m, NULL), NOH_OK);
            for (uint32_t k = 0; k < 12; k++) {
                uint32_t bits;
                memcpy(&bits, &m[k], sizeof bits);
                sum = (sum ^ bits) * 1099511628211u;
            }
        }
    }
    return sum;
}

static void it_is_saved_and_forked(void **state)
{
    show a, b;
    size_t bytes;
    (void)state;
    open_show(&a, "Knight__Walking_A", 1);
    open_show(&b, "Knight__Walking_A", 3);
    for (int i = 0; i < 2; i++) {
        show *w = i ? &b : &a;
        make_map(w);
        w->c.kinds[0].root_axes = NOH_ROOT_GROUND;
        w->c.desc.cpu_bytes_max = 1; /* as few decoded segments as there can be */
        assert_int_equal(noh_stage_plan_make(&w->c.desc, NULL, &w->c.plan, &said), NOH_ERR_MEMORY);
        w->c.desc.cpu_bytes_max = said.need;
        cast_make(&w->c, NULL);
        enter(w);
    }
    act(&a, 0, 100);
    const void *now = noh_stage_state(a.c.stage, &bytes);
    void *kept = test_aligned(now, bytes);
    act(&a, 100, 220);
    const uint64_t end = shown(&a), hash = noh_stage_hash(a.c.stage);
    assert_int_equal(noh_stage_set_state(a.c.stage, kept, bytes, NULL), NOH_OK);
    act(&a, 100, 220);
    assert_true(shown(&a) == end && noh_stage_hash(a.c.stage) == hash);
    assert_int_equal(noh_stage_set_state(b.c.stage, kept, bytes, NULL), NOH_OK);
    act(&b, 100, 220);
    assert_true(shown(&b) == end && noh_stage_hash(b.c.stage) == hash);
    free(kept);
    close_show(&a);
    close_show(&b);
}

static void a_state_of_other_proportions_is_refused(void **state)
{
    const void *kept = NULL;
    size_t bytes = 0;
    show shows[3];
    (void)state;
    for (uint32_t i = 0; i < 3; i++) {
        show *w = &shows[i];
        open_show(w, "Knight__Walking_A", 1);
        make_map(w);
        if (i == 2) w->map.clips.ratio *= 1.25f;
        cast_make(&w->c, NULL);
        enter(w);
        play(w, 0, w->clip, 1);
        frame(w, CAST_STEP);
        if (!i) kept = noh_stage_state(w->c.stage, &bytes);
        assert_int_equal(noh_stage_set_state(w->c.stage, kept, bytes, NULL) == NOH_OK, i < 2);
    }
    for (uint32_t i = 0; i < 3; i++) close_show(&shows[i]);
}

/* ---- slots and reserves ---- */

static void bring_all(show *w)
{
    const noh_stage_stats *stats = noh_stage_stats_of(w->c.stage);
    const char *const names[] = { "walk", w->clip };
    for (uint32_t i = 0; i < TEST_COUNT(names); i++) {
        const uint32_t clip = noh_stage_find(w->c.stage, 0, NOH_NAME_CLIP, names[i]);
        assert_int_equal(noh_stage_load_clip(w->c.stage, 0, clip, NULL, &said), NOH_OK);
    }
    for (uint32_t i = stats->wanted_count; i-- > 0;) {
        const noh_wanted_clip at = stats->wanted[i];
        if (noh_stage_load_clip(w->c.stage, 0, at.clip, w->packs[at.pack]->bytes + at.offset, &said))
            fail_msg("%s", said.what);
    }
}

/* From a reserve, and of a kind that came into a slot, the same bits are shown. */
static void it_comes_by_need_and_into_slots(void **state)
{
    uint64_t sums[3];
    (void)state;
    for (uint32_t way = 0; way < 3; way++) {
        show w;
        open_show(&w, "Knight__Walking_A", 2);
        make_map(&w);
        w.c.kinds[0].clip_reserve = way == 1 ? 1u << 15 : 0;
        w.c.kinds[0].changes = way == 2;
        cast_make(&w.c, NULL);
        if (way == 2) {
            assert_int_equal(noh_stage_set_kind(w.c.stage, 0, NULL, &said), NOH_OK);
            if (noh_stage_set_kind(w.c.stage, 0, &w.c.kinds[0], &said)) fail_msg("%s", said.what);
        }
        enter(&w);
        if (way == 1) bring_all(&w);
        act(&w, 0, 100);
        sums[way] = shown(&w);
        close_show(&w);
    }
    assert_true(sums[1] == sums[0] && sums[2] == sums[0]);
}

/* ---- what is refused, and what stays as it was ---- */

static void maps_of_other_skeletons_are_refused(void **state)
{
    show w;
    (void)state;
    open_show(&w, "Knight__Walking_A", 1);
    assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &w.c.plan, &said), NOH_ERR_ARG); /* not made yet */
    make_map(&w);
    w.map.clips.target = w.map.clips.source;
    assert_int_equal(noh_stage_plan_make(&w.c.desc, NULL, &w.c.plan, &said), NOH_ERR_ARG);
    assert_non_null(strstr(said.what, "map of a kind"));
    w.c.kinds[0].map = NULL;
    cast_make(&w.c, NULL);
    assert_int_equal(noh_stage_find(w.c.stage, 0, NOH_NAME_CLIP, w.clip), NOH_NONE);
    assert_int_not_equal(noh_stage_find(w.c.stage, 0, NOH_NAME_CLIP, "walk"), NOH_NONE);
    close_show(&w);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_pose_is_the_maps),
    cmocka_unit_test(root_motion_is_of_the_pose_that_is_shown),
    cmocka_unit_test(bind_poses_are_those_of_the_source),
    cmocka_unit_test(it_is_near_what_the_converter_makes),
    cmocka_unit_test(the_plan_has_its_bytes),
    cmocka_unit_test(it_is_saved_and_forked),
    cmocka_unit_test(a_state_of_other_proportions_is_refused),
    cmocka_unit_test(it_comes_by_need_and_into_slots),
    cmocka_unit_test(maps_of_other_skeletons_are_refused),
};

TEST_MAIN(tests, NULL, NULL)
