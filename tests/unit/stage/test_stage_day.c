/* A day of every clip of the demo's packs: callback keys come exactly as often as whole numbers say, and poses are as
 * sound at its end as at its beginning. */
#include "support/stage_fixture.h"

#include <math.h>
#include "noh/low_motion.h"

#define DAY_TICKS (24LL * 3600 * NOH_TICKS_PER_SECOND)
#define KEYS_MAX 64u
#define POSE_STEPS 997u /* steps between poses that are looked at */

/* Steps of about a second that no clip divides. */
static uint32_t step_ticks(uint32_t step, int64_t left)
{
    const uint32_t ticks = 47000u + step * 7919u % 2003u;
    return left < (int64_t)ticks ? (uint32_t)left : ticks;
}

static void joints_turn(const noh_stage *stage, noh_actor actor, const char *clip)
{
    float m[12];
    for (uint32_t j = 0; noh_actor_joint(stage, actor, j, m, NULL) == NOH_OK; j++) {
        double most = 0.0;
        for (int a = 0; a < 3; a++) {
            for (int b = a; b < 3; b++) {
                double dot = 0.0;
                for (int row = 0; row < 3; row++) dot += (double)m[4 * row + a] * (double)m[4 * row + b];
                most = fmax(most, fabs(dot - (a == b)));
            }
        }
        if (!(most < 1e-5)) fail_msg("%s: joint %u is no rotation any more, by %g", clip, (unsigned)j, most);
    }
}

static void play_a_day(cast *c, uint32_t kind, const noh_pack_clip *clip, uint32_t duration)
{
    const noh_play play = { .fade_ticks = 1, .loop = NOH_LOOP_REPEAT };
    const noh_appearance posed = { .posed = 1 };
    uint64_t passed[KEYS_MAX] = { 0 };
    int64_t left = DAY_TICKS;
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, kind, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &posed, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c->stage, actor, 0, clip->name, &play, NULL), NOH_OK);
    for (uint32_t step = 0; left > 0; step++) {
        const uint32_t ticks = step_ticks(step, left);
        const noh_stage_event *events;
        uint32_t count;
        if (step % POSE_STEPS) {
            assert_int_equal(noh_stage_step(c->stage, ticks, NULL, NULL, NULL), NOH_OK);
        } else {
            assert_int_equal(noh_stage_frame(c->stage, ticks, NULL, NULL, NULL, NULL), NOH_OK);
            joints_turn(c->stage, actor, clip->name);
        }
        events = noh_stage_events(c->stage, &count);
        for (uint32_t i = 0; i < count; i++) passed[events[i].index]++;
        left -= ticks;
    }
    for (uint32_t k = 0; k < clip->header->event_count; k++) {
        const uint64_t wanted = (uint64_t)((DAY_TICKS - clip->events[k].tick) / duration) + 1u;
        if (passed[k] != wanted) {
            fail_msg("%s: key %u came %llu times, not %llu", clip->name, (unsigned)k, (unsigned long long)passed[k],
                     (unsigned long long)wanted);
        }
    }
    assert_int_equal(noh_stage_stats_of(c->stage)->events_lost, 0);
    assert_int_equal(noh_stage_despawn(c->stage, actor, NULL), NOH_OK);
}

static void a_day_of_every_clip(void **state)
{
    uint32_t clips = 0, keys = 0;
    cast c;
    (void)state;
    cast_open(&c);
    c.kinds[PUPPETS].root_axes = 0; /* places of a day of walking have no digits left */
    c.desc.event_count = 4096;
    cast_make(&c, NULL);
    for (uint32_t kind = PUPPETS; kind <= MASKS; kind++) {
        noh_pack_clip clip;
        for (uint32_t i = 0; noh_pack_clip_at(&c.packs[kind], i, &clip, NULL) == NOH_OK; i++) {
            noh_clip_desc desc = { .bytes = clip.bytes,
                                   .byte_count = clip.header->clip_bytes,
                                   .joint_count = clip.header->joint_count };
            noh_skeleton skeleton;
            noh_clip_info info;
            size_t bytes;
            if (noh_pack_skeleton_at(&c.packs[kind], clip.header->skeleton, &skeleton, NULL, NULL) == NOH_OK)
                desc.bind = skeleton.bind_pose;
            assert_int_equal(noh_clip_measure(&desc, &info, &bytes, NULL), NOH_OK);
            assert_true(clip.header->event_count <= KEYS_MAX);
            play_a_day(&c, kind, &clip, (uint32_t)info.duration_ticks);
            keys += clip.header->event_count;
            clips++;
        }
    }
    print_message("%u clips with %u keys, a day of each\n", (unsigned)clips, (unsigned)keys);
    assert_true(clips > 8 && keys > 4);
    cast_close_stage(&c);
    cast_close(&c);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(a_day_of_every_clip) };
    (void)argc, (void)argv;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
