/* test_root_loops.c: root motion of compressed clips goes where the source goes, whatever the clip's bound: loops that
 * close do not drift, others move by the source's displacement, and no position is off by more than the bound. */
#include "support/set_fixture.h"

#include "motion/anim/root_motion_internal.h"
#include "noh/clip.h"
#include "noh/low_motion.h"
#include "noh/pack.h"

#define TWO_PI 6.283185307179586
#define FRAMES 37u
#define CLIPS 3u
#define SECONDS_PER_DAY 86400

enum { IN_PLACE, WALK, TURN };

/* The root at frame f, in centimetres: hips that sway, and begin turned aside. */
typedef struct root_source {
    double x, y, z, heading;
} root_source;

static root_source source_at(uint32_t clip, double f)
{
    const double s = f / (FRAMES - 1u), sway = clip == TURN ? 0.0 : 1.0;
    root_source r;
    r.heading = clip == TURN ? TWO_PI * s / 4.0 : 0.3 * cos(TWO_PI * s);
    r.x = clip == TURN ? 100.0 * (1.0 - cos(r.heading)) : 3.0 * sin(TWO_PI * s);
    r.y = 90.0 + 2.0 * sway * cos(2.0 * TWO_PI * s);
    r.z = clip == TURN ? 100.0 * sin(r.heading) : clip == WALK ? 140.0 * s : 2.0 * sin(2.0 * TWO_PI * s);
    return r;
}

static void fill_frame(raw_clip *c, uint32_t clip, uint32_t frame, const raw_skeleton *s)
{
    const root_source r = source_at(clip, clip != TURN && frame == FRAMES - 1u ? 0.0 : frame);
    for (uint32_t j = 0; j < s->joint_count; j++) {
        const size_t at = (size_t)frame * s->joint_count + j;
        const double angle = j ? 0.5 * sin(TWO_PI * frame / (FRAMES - 1u) + j) : r.heading;
        c->rotations[4u * at + (j ? 0u : 1u)] = (float)sin(0.5 * angle);
        c->rotations[4u * at + 3u] = (float)cos(0.5 * angle);
        memcpy(c->translations + 3u * at, s->joints[j].translation, 3u * sizeof(float));
        c->scales[3u * at] = c->scales[3u * at + 1u] = c->scales[3u * at + 2u] = 1.0f;
    }
    c->translations[3u * (size_t)frame * s->joint_count] = (float)r.x;
    c->translations[3u * (size_t)frame * s->joint_count + 1u] = (float)r.y;
    c->translations[3u * (size_t)frame * s->joint_count + 2u] = (float)(clip == WALK ? 140.0 * frame / (FRAMES - 1u)
                                                                                     : r.z);
}

/* A pack of the three clips, encoded to a bound. */
static set_fixture pack_of(double error_cm)
{
    static const char *const names[CLIPS] = { "in place", "walk", "turn" };
    raw_set *raw = raw_set_new(4, CLIPS);
    clips_settings settings;
    encoded_clips made;
    model *empty = model_new();
    model_error error;
    byte_buffer out = { NULL, 0, 0, 0 };
    set_fixture x;
    set_fixture_joints(&raw->skeleton);
    for (uint32_t c = 0; c < CLIPS; c++) {
        raw->clips[c].name = model_string(names[c]);
        raw->clips[c].sample_rate_hz = 30.0;
        raw->clips[c].loop = 1;
        assert_int_equal(raw_clip_alloc(&raw->clips[c], FRAMES, raw->skeleton.joint_count), 0);
        for (uint32_t f = 0; f < FRAMES; f++) fill_frame(&raw->clips[c], c, f, &raw->skeleton);
    }
    memset(&settings, 0, sizeof settings);
    settings.clip.error_cm = error_cm;
    assert_int_equal(clips_encode(&raw, 1, &settings, &made, &error), 0);
    assert_int_equal(pack_write(empty, NULL, NULL, &made, &out, &error), 0);
    x.bytes = test_aligned(out.bytes, out.count);
    x.pack = test_open(x.bytes, out.count);
    buffer_free(&out);
    clips_free(&made);
    model_free(empty);
    raw_set_free(raw);
    return x;
}

static noh_clip_bank *bank_of(const noh_pack *pack, uint32_t axes)
{
    noh_clip_bank_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.clips = pack;
    desc.root_axes = axes;
    desc.root_up = 1;
    return test_clip_bank(&desc);
}

static const double bounds[] = { 0.001, 0.01, 0.1, 1.0, 5.0 };

/* What all passes of a day move by is what one pass of the source does, so often. */
static void loops_that_close_do_not_drift(void **state)
{
    (void)state;
    for (size_t b = 0; b < TEST_COUNT(bounds); b++) {
        set_fixture x = pack_of(bounds[b]);
        noh_clip_bank *bank = bank_of(&x.pack, NOH_ROOT_GROUND | NOH_ROOT_Y);
        for (uint32_t c = 0; c < CLIPS; c++) {
            const noh_root_track *t = &bank->clips.roots[c];
            const int64_t pass = noh_position_of(bank->clips.clips[c].duration_ticks), day = pass * SECONDS_PER_DAY;
            const noh_root_pose m = noh_root_between(&bank->clips, t, c, NOH_LOOP_REPEAT, pass / 3, pass / 3 + day),
                                back = noh_root_between(&bank->clips, t, c, NOH_LOOP_REPEAT, pass / 3, pass / 3 - day),
                                to_fro = noh_root_between(&bank->clips, t, c, NOH_LOOP_PING_PONG, pass / 3,
                                                          pass / 3 + 2 * day);
            assert_int_equal(to_fro.turn, 0);
            if (c == TURN) { /* a quarter turn a pass: four close */
                assert_in_range((uint32_t)(t->loop.turn - 0x3fffff80u), 0, 0x100);
                assert_true(fabs(t->loop.translation[0] - 100.0) < 2e-5);
                assert_true(fabs(t->loop.translation[2] - 100.0) < 2e-5);
                continue;
            }
            assert_int_equal(t->loop.turn, 0);
            assert_int_equal(m.turn, 0);
            assert_int_equal(back.turn, 0);
            assert_true(t->loop.translation[0] == 0.0 && t->loop.translation[1] == 0.0);
            assert_true(t->loop.translation[2] == (c == WALK ? 140.0 : 0.0));
            /* from within a pass, along the figure's own heading there: the way is as long */
            assert_true(fabs(hypot(m.translation[0], m.translation[2]) / SECONDS_PER_DAY - (c == WALK ? 140.0 : 0.0)) <
                        1e-9);
            assert_true(fabs(hypot(m.translation[0] + back.translation[0], m.translation[2] + back.translation[2])) <
                        1e-3);
        }
        free(bank);
        free(x.bytes);
    }
}

/* From the first frame on, in the clip's own axes, in the thousandth pass: no farther from the source than the bound. */
static void positions_keep_the_bound(void **state)
{
    (void)state;
    for (size_t b = 0; b < TEST_COUNT(bounds); b++) {
        set_fixture x = pack_of(bounds[b]);
        noh_clip_bank *bank = bank_of(&x.pack, NOH_ROOT_GROUND | NOH_ROOT_Y);
        double worst = 0.0, aside = 0.0;
        for (uint32_t c = 0; c < TURN; c++) {
            const root_source from = source_at(c, 0.0);
            const uint32_t duration = bank->clips.clips[c].duration_ticks;
            for (uint32_t f = 0; f < FRAMES; f++) {
                const root_source want = source_at(c, f);
                const uint32_t tick = (uint32_t)((uint64_t)duration * f / (FRAMES - 1u));
                const noh_root_pose e = noh_root_between(&bank->clips, &bank->clips.roots[c], c, NOH_LOOP_REPEAT, 0,
                                                         noh_position_of(duration) * 1000 + noh_position_of(tick));
                const double dx = e.translation[0] - (want.x - from.x), dy = e.translation[1] - (want.y - from.y),
                             dz = e.translation[2] - (want.z - from.z) - (c == WALK ? 140.0e3 : 0.0),
                             turn = (double)(int32_t)e.turn * TWO_PI / 4294967296.0 - (want.heading - from.heading);
                worst = fmax(worst, sqrt(dx * dx + dy * dy + dz * dz));
                aside = fmax(aside, fabs(remainder(turn, TWO_PI)));
            }
        }
        print_message("bound %g cm: %.4f cm, %.4f degrees off\n", bounds[b], worst, aside * 360.0 / TWO_PI);
        assert_true(worst < bounds[b] * 1.01 + 1e-4);
        assert_true(aside < bounds[b] / 3.0 * 1.5 + 1e-5); /* the bound holds 3 cm from the joint */
        free(bank);
        free(x.bytes);
    }
}

/* A clip that walks along z moves along z, whichever way its first frame faces, and the figure faces that way too. */
static void headings_count_from_the_clips_own_axes(void **state)
{
    set_fixture x = pack_of(0.01);
    noh_clip_bank *bank = bank_of(&x.pack, NOH_ROOT_GROUND);
    noh_transform pose[4];
    (void)state;
    for (uint32_t c = 0; c < CLIPS; c++) {
        const uint32_t duration = bank->clips.clips[c].duration_ticks;
        for (uint32_t f = 0; f < FRAMES; f++) {
            const uint32_t tick = (uint32_t)((uint64_t)duration * f / (FRAMES - 1u));
            const noh_root_pose e = noh_root_between(&bank->clips, &bank->clips.roots[c], c, NOH_LOOP_REPEAT, 0,
                                                     noh_position_of(tick == duration ? tick - 1u : tick));
            double facing;
            noh_root_sample_rest(&bank->clips, c, tick, 4, pose, NULL);
            facing = 2.0 * atan2((double)pose[0].rotation[1], (double)pose[0].rotation[3]) +
                     (double)(int32_t)e.turn * TWO_PI / 4294967296.0;
            assert_true(fabs(remainder(facing - source_at(c, f).heading, TWO_PI)) < 0.01);
        }
    }
    free(bank);
    free(x.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loops_that_close_do_not_drift),
        cmocka_unit_test(positions_keep_the_bound),
        cmocka_unit_test(headings_count_from_the_clips_own_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
