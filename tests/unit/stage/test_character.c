/* Tests of character.c: one block that steps, chooses, poses and shows; and a crowd of them.
 * cross: long, minutes of a crowd */
#include "motion/anim/controller_internal.h"
#include "motion/anim/tracks_internal.h"
#include "stage/character/character_internal.h"
#include "stage/character/scheduler_internal.h"
#include "stage/character/time_lod_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/clip_set_fixture.h"

#define FRAME 800u
#define COPIES 64u

/* A scene with a skeleton that has inverse bind matrices, its clips' errors, one character and its scratch. */
typedef struct stage {
    scene s;
    float inverse_bind[JOINTS * 12];
    float radius[JOINTS];
    noh_lod_joints joints[2];
    noh_lod_table table;
    noh_lod_settings settings;
    noh_character_desc desc;
    size_t size;
    uint8_t *memory;
    noh_character *ch;
    void *scratch_memory;
    noh_character_scratch scratch;
} stage;

static float errors[CLIPS][NOH_UPDATE_RATE_COUNT]; /* of the scene's clips; the first stage measures them */

/* Of a matrix of a rotation and a translation. */
static void invert_rigid(const float *m, float *out)
{
    for (uint32_t r = 0; r < 3; r++) {
        for (uint32_t c = 0; c < 3; c++) out[4 * r + c] = m[4 * c + r];
        out[4 * r + 3] = -(m[r] * m[3] + m[4 + r] * m[7] + m[8 + r] * m[11]);
    }
}

static void measure_errors(stage *g)
{
    noh_time_probe probe = { NULL, NULL, NULL, NULL, 0 };
    void *memory;
    probe.set = &g->s.set;
    probe.skeleton = &g->s.skeleton;
    probe.joint_radius_m = g->radius;
    memory = test_aligned(NULL, noh_time_lod_measure_size(&probe));
    for (uint32_t m = 0; m < CLIPS; m++) {
        assert_int_equal(noh_time_lod_measure(memory, noh_time_lod_measure_size(&probe), &probe, m, errors[m], NULL),
                         NOH_OK);
    }
    free(memory);
}

static void stage_open(stage *g)
{
    float bind[JOINTS * 12];
    memset(g, 0, sizeof *g);
    scene_open(&g->s);
    noh_local_to_model(&g->s.skeleton, g->s.bind, JOINTS, bind);
    for (uint32_t j = 0; j < JOINTS; j++) {
        invert_rigid(bind + 12 * j, g->inverse_bind + 12 * j);
        g->radius[j] = 0.1f;
    }
    g->s.skeleton.inverse_bind = g->inverse_bind;
    if (errors[WALK][NOH_UPDATE_RATE_8] == 0.0f) measure_errors(g);
    g->table.update_error_m = errors[0];
    g->settings.shares[NOH_LOD_UPDATES] = 1.0f;
    g->settings.hysteresis = 0.01f;
    g->desc.controller.set = &g->s.set;
    g->desc.start_clock = 777;
    g->size = noh_character_size(&g->desc);
    g->memory = test_aligned(NULL, g->size);
    assert_int_equal(noh_character_init(g->memory, g->size, &g->desc, &g->ch, NULL), NOH_OK);
    g->scratch_memory = test_aligned(NULL, noh_character_scratch_size(&g->desc));
    assert_int_equal(noh_character_scratch_init(g->scratch_memory, noh_character_scratch_size(&g->desc), &g->desc,
                                                &g->scratch, NULL),
                     NOH_OK);
}

static void stage_close(stage *g)
{
    free(g->memory);
    free(g->scratch_memory);
}

static void play(stage *g, noh_character *ch, uint32_t track, noh_track_desc d)
{
    assert_int_equal(noh_controller_start(noh_character_controller(ch), &g->s.set, track, &d, NULL), NOH_OK);
    noh_character_wake(ch);
}

static void update(stage *g, noh_character *ch)
{
    noh_character_update(ch, &g->s.set, &g->s.skeleton, g->radius, &g->scratch);
}

/* The scale at which a rate is allowed, as long as `off` metres are a pixel. */
static float scale_for(float off)
{
    return 0.98f / off;
}

/* The pose of the controller itself. */
static void true_palette(stage *g, noh_character *ch, float *palette, float *floats)
{
    noh_transform pose[JOINTS];
    float matrices[JOINTS * 12];
    noh_controller_pose(noh_character_controller(ch), &g->s.set, &g->scratch.pose, pose, floats);
    noh_local_to_model(&g->s.skeleton, pose, JOINTS, matrices);
    noh_model_to_palette(&g->s.skeleton, matrices, JOINTS, palette);
}

static void take_palette(const noh_character *ch, float *palette)
{
    const float *shown = noh_character_palette(ch, palette, JOINTS);
    if (shown != palette) memcpy(palette, shown, JOINTS * 48u);
}

static void take_floats(const noh_character *ch, float *floats)
{
    const float *shown = noh_character_floats(ch, floats);
    if (shown != floats) memcpy(floats, shown, FLOATS * sizeof *floats);
}

/* The largest error of a vertex on the six axes of any joint, at its radius. */
static double palettes_apart(const stage *g, const float *a, const float *b)
{
    double worst = 0.0;
    float bind[JOINTS * 12];
    noh_local_to_model(&g->s.skeleton, g->s.bind, JOINTS, bind);
    for (uint32_t j = 0; j < JOINTS; j++) {
        for (int axis = 0; axis < 6; axis++) {
            double p[3], off = 0.0;
            for (uint32_t i = 0; i < 3; i++) p[i] = (double)bind[12 * j + 4 * i + 3];
            p[axis % 3] += (axis < 3 ? 1.0 : -1.0) * (double)g->radius[j];
            for (uint32_t r = 0; r < 3; r++) {
                const float *x = a + 12 * j + 4 * r, *y = b + 12 * j + 4 * r;
                double d = (double)x[3] - (double)y[3];
                for (int i = 0; i < 3; i++) d += ((double)x[i] - (double)y[i]) * p[i];
                off += d * d;
            }
            worst = fmax(worst, sqrt(off));
        }
    }
    return worst;
}

/* ---- memory ---- */

static void memory_is_exact(void **state)
{
    stage g;
    uint8_t *memory;
    noh_character *ch = NULL;
    noh_character_scratch scratch;
    noh_error error;
    size_t need;
    (void)state;
    stage_open(&g);
    memory = test_aligned(NULL, g.size + 512);
    memset(memory, 0xa5, g.size + 512);
    assert_int_equal(noh_character_init(memory + 256, g.size - 1, &g.desc, &ch, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, g.size);
    assert_int_equal(noh_character_init(memory + 256 + NOH_MEMORY_ALIGN / 2, g.size, &g.desc, &ch, &error),
                     NOH_ERR_ARG);
    assert_null(ch);
    for (size_t i = 0; i < g.size + 512; i++) assert_int_equal(memory[i], 0xa5);
    assert_int_equal(noh_character_init(memory + 256, g.size, &g.desc, &ch, &error), NOH_OK);
    assert_int_equal(ch->bytes, g.size);
    assert_int_equal(g.size % 16, 0);
    play(&g, ch, 0, track_of(WALK, 1.0f));
    for (int frame = 0; frame < 40; frame++) {
        noh_character_step(ch, &g.s.set, FRAME, NULL, NULL);
        if (noh_character_select_lod(ch, &g.table, &g.settings, 0.001f) != NOH_DUE_NOT) update(&g, ch);
    }
    for (size_t i = 0; i < 256; i++) assert_true(memory[i] == 0xa5 && memory[256 + g.size + i] == 0xa5);
    free(memory);
    need = noh_character_scratch_size(&g.desc);
    memory = test_aligned(NULL, need + 16);
    memset(memory, 0xa5, need + 16);
    assert_int_equal(noh_character_scratch_init(memory, need - 1, &g.desc, &scratch, &error), NOH_ERR_MEMORY);
    assert_int_equal(error.need, need);
    assert_int_equal(noh_character_scratch_init(memory + NOH_MEMORY_ALIGN / 2, need, &g.desc, &scratch, &error),
                     NOH_ERR_ARG);
    assert_int_equal(memory[0], 0xa5);
    assert_int_equal(noh_character_scratch_init(memory, need, &g.desc, &scratch, &error), NOH_OK);
    noh_character_update(g.ch, &g.s.set, &g.s.skeleton, g.radius, &scratch);
    for (size_t i = need; i < need + 16; i++) assert_int_equal(memory[i], 0xa5);
    free(memory);
    stage_close(&g);
}

static void impossible_descs_are_refused(void **state)
{
    stage g;
    noh_character_desc d;
    noh_character *ch;
    noh_character_scratch scratch;
    noh_error error;
    (void)state;
    stage_open(&g);
    d = g.desc, d.controller.track_count = NOH_TRACKS_MAX + 1u;
    assert_int_equal(noh_character_size(&d), 0);
    assert_int_equal(noh_character_scratch_size(&d), 0);
    assert_int_equal(noh_character_init(g.memory, g.size, &d, &ch, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "track_count", strlen("track_count")), 0);
    assert_int_equal(noh_character_scratch_init(g.memory, g.size, &d, &scratch, &error), NOH_ERR_ARG);
    assert_int_equal(strncmp(error.what, "track_count", strlen("track_count")), 0);
    stage_close(&g);
}

/* The header's own figures. */
static void a_body_takes_less_than_8_kib(void **state)
{
    scene s;
    noh_character_desc d;
    (void)state;
    scene_open(&s);
    s.set.joint_count = 31;
    s.set.float_count = 34;
    memset(&d, 0, sizeof d);
    d.controller.set = &s.set;
    assert_int_equal(noh_character_size(&d), 3888);
    d.controller.flags = NOH_CONTROLLER_INERTIAL;
    assert_int_equal(noh_character_size(&d), 5648);
    d.controller.track_count = 8;
    assert_true(noh_character_size(&d) <= 8192);
}

/* ---- what is shown ---- */

static void at_the_full_update_rate_it_is_the_exact_pose(void **state)
{
    stage g;
    float shown[JOINTS * 12], truth[JOINTS * 12], floats[FLOATS], true_floats[FLOATS];
    (void)state;
    stage_open(&g);
    play(&g, g.ch, 0, track_of(WALK, 1.0f));
    play(&g, g.ch, 1, track_of(WAVE, 0.5f));
    for (int frame = 0; frame < 50; frame++) {
        noh_character_step(g.ch, &g.s.set, FRAME, NULL, NULL);
        assert_true(noh_character_select_lod(g.ch, &g.table, &g.settings, 1e9f) != NOH_DUE_NOT);
        update(&g, g.ch);
        take_palette(g.ch, shown);
        take_floats(g.ch, floats);
        true_palette(&g, g.ch, truth, true_floats);
        assert_memory_equal(shown, truth, sizeof shown);
        assert_memory_equal(floats, true_floats, sizeof floats);
    }
    assert_int_equal(g.ch->updates, 50);
    stage_close(&g);
}

/* One clip at each update rate: as many updates as the rate says, errors as measured, and the sphere around it all. */
static void at_low_update_rates_the_error_is_as_measured(void **state)
{
    (void)state;
    for (uint32_t clip = WALK; clip <= JUMP; clip++) {
        for (int rate = NOH_UPDATE_RATE_30; rate < NOH_UPDATE_RATE_COUNT; rate++) {
            stage g;
            double worst = 0.0;
            float shown[JOINTS * 12], truth[JOINTS * 12], floats[FLOATS];
            int64_t clock;
            stage_open(&g);
            play(&g, g.ch, 0, track_of(clip, 1.0f));
            for (int frame = 0; frame < 1200; frame++) {
                noh_character_step(g.ch, &g.s.set, FRAME, NULL, NULL);
                if (noh_character_select_lod(g.ch, &g.table, &g.settings, scale_for(errors[clip][rate])) != NOH_DUE_NOT)
                    update(&g, g.ch);
                assert_int_equal(g.ch->lod.update_rate, rate);
                take_palette(g.ch, shown);
                true_palette(&g, g.ch, truth, floats);
                worst = fmax(worst, palettes_apart(&g, shown, truth));
            }
            clock = noh_character_clock(g.ch);
            assert_int_equal(clock, 777 + 1200 * FRAME);
            assert_true(worst <= (double)errors[clip][rate] * 1.02 && worst > 0.3 * (double)errors[clip][rate]);
            assert_true(fabs((double)g.ch->updates - 1200.0 * FRAME / noh_update_period((noh_update_rate)rate)) <= 3.0);
            stage_close(&g);
        }
    }
}

/* An update in the middle of a mix, to another clip: what is shown at that tick does not change. */
static void a_change_begins_with_what_is_shown(void **state)
{
    stage g;
    float before[JOINTS * 12], shown[JOINTS * 12], floats[2][FLOATS], spheres[2][4];
    (void)state;
    stage_open(&g);
    play(&g, g.ch, 0, track_of(WAVE, 1.0f));
    for (int frame = 0; frame < 200; frame++) {
        noh_character_step(g.ch, &g.s.set, FRAME, NULL, NULL);
        if (noh_character_select_lod(g.ch, &g.table, &g.settings, 1e-3f) != NOH_DUE_NOT) update(&g, g.ch);
        if (frame < 2 || frame % 11) continue;
        take_palette(g.ch, before);
        take_floats(g.ch, floats[0]);
        noh_character_sphere(g.ch, spheres[0]);
        play(&g, g.ch, 0, track_of(frame % 2 ? WAVE : LEAN, 1.0f));
        assert_int_equal(noh_character_select_lod(g.ch, &g.table, &g.settings, 1e-3f), NOH_DUE);
        update(&g, g.ch);
        take_palette(g.ch, shown);
        take_floats(g.ch, floats[1]);
        noh_character_sphere(g.ch, spheres[1]);
        assert_true(palettes_apart(&g, before, shown) < 1e-5);
        for (uint32_t i = 0; i < FLOATS; i++) assert_true(fabsf(floats[0][i] - floats[1][i]) < 1e-6f);
        for (uint32_t i = 0; i < 4; i++) assert_true(fabsf(spheres[0][i] - spheres[1][i]) < 1e-5f);
    }
    stage_close(&g);
}

/* No error was measured of cross-fades. Once what is shown has reached the new state (a period after the wake), its
 * error is at most 1.5 times the larger error of the two clips. */
static void cross_fades_stay_near_the_measured_error(void **state)
{
    test_random r = test_random_from(44);
    stage g;
    float shown[JOINTS * 12], truth[JOINTS * 12], floats[FLOATS];
    double worst = 0.0, measured;
    int64_t woken = 0;
    (void)state;
    stage_open(&g);
    play(&g, g.ch, 0, track_of(WALK, 1.0f));
    measured = (double)fmaxf(errors[WALK][NOH_UPDATE_RATE_15], errors[RUN][NOH_UPDATE_RATE_15]);
    for (int frame = 0; frame < 20000; frame++) {
        if (frame % 100 == 99) {
            uint32_t to = (uint32_t)frame / 100u % 2u ? 0u : 1u;
            noh_track_desc d = track_of(to ? RUN : WALK, 1.0f);
            d.position_ticks = (int64_t)test_random_below(&r, 30000);
            d.flags = NOH_TRACK_SILENT;
            play(&g, g.ch, to, d);
            assert_int_equal(noh_controller_cross_fade(noh_character_controller(g.ch), &g.s.set, 1u - to, to, 1.0f,
                                                       12000 + test_random_below(&r, 48000), NOH_CURVE_SMOOTHSTEP,
                                                       NULL),
                             NOH_OK);
            woken = noh_character_clock(g.ch);
        }
        noh_character_step(g.ch, &g.s.set, FRAME, NULL, NULL);
        if (noh_character_select_lod(g.ch, &g.table, &g.settings, scale_for((float)measured)) != NOH_DUE_NOT)
            update(&g, g.ch);
        take_palette(g.ch, shown);
        true_palette(&g, g.ch, truth, floats);
        if (noh_character_clock(g.ch) - woken > 3200 + FRAME) worst = fmax(worst, palettes_apart(&g, shown, truth));
    }
    print_message("during cross-fades: %.2f of what was measured\n", worst / measured);
    assert_true(worst <= 1.5 * measured);
    stage_close(&g);
}

static void the_sphere_holds_what_is_shown(void **state)
{
    test_random r = test_random_from(41);
    stage g;
    float shown[JOINTS * 12], bind[JOINTS * 12], sphere[4];
    (void)state;
    stage_open(&g);
    noh_local_to_model(&g.s.skeleton, g.s.bind, JOINTS, bind);
    play(&g, g.ch, 0, track_of(LEAN, 1.0f));
    for (int frame = 0; frame < 600; frame++) {
        noh_character_step(g.ch, &g.s.set, FRAME, NULL, NULL);
        if (noh_character_select_lod(g.ch, &g.table, &g.settings, 1e-3f) != NOH_DUE_NOT) update(&g, g.ch);
        take_palette(g.ch, shown);
        noh_character_sphere(g.ch, sphere);
        for (uint32_t j = 0; j < JOINTS; j++) {
            float p[3] = { test_random_float(&r, -1, 1), test_random_float(&r, -1, 1), test_random_float(&r, -1, 1) };
            float far2 = 0.0f, length = sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / 0.1f;
            for (uint32_t i = 0; i < 3; i++) p[i] = p[i] / length + bind[12 * j + 4 * i + 3];
            for (uint32_t i = 0; i < 3; i++) {
                const float *m = shown + 12 * j + 4 * i;
                float off = m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3] - sphere[i];
                far2 += off * off;
            }
            assert_true(sqrtf(far2) <= sphere[3] * 1.0001f);
        }
    }
    stage_close(&g);
}

/* Joints that are not posed move with their parents. */
static void dropped_joints_follow_their_parents(void **state)
{
    stage g;
    float shown[JOINTS * 12];
    (void)state;
    stage_open(&g);
    g.joints[0].joint_count = JOINTS;
    g.joints[1].joint_count = 9;
    g.table.joints = g.joints;
    g.table.joint_level_count = 2;
    g.settings.shares[NOH_LOD_UPDATES] = 0.9f;
    g.settings.shares[NOH_LOD_JOINTS] = 0.1f;
    g.table.update_error_m = NULL;
    play(&g, g.ch, 0, track_of(RUN, 1.0f));
    noh_character_step(g.ch, &g.s.set, 5000, NULL, NULL);
    assert_int_equal(noh_character_select_lod(g.ch, &g.table, &g.settings, 10.0f), NOH_DUE_AT_ONCE);
    assert_int_equal(noh_character_joint_work(g.ch), 9);
    g.s.samples = 0;
    update(&g, g.ch);
    take_palette(g.ch, shown);
    for (uint32_t j = 0; j < JOINTS; j++) {
        uint32_t parent = (j - 1u) / 2u;
        if (j >= 9) assert_memory_equal(shown + 12 * j, shown + 12 * parent, 48);
        if (j > 0 && j < 9) assert_memory_not_equal(shown + 12 * j, shown + 12 * parent, 48);
    }
    assert_int_equal(g.s.samples, 1);
    g.joints[1].error_m = 1.0f;
    noh_character_cut(g.ch);
    assert_int_equal(noh_character_select_lod(g.ch, &g.table, &g.settings, 10.0f), NOH_DUE_AT_ONCE);
    assert_int_equal(noh_character_joint_work(g.ch), JOINTS);
    stage_close(&g);
}

/* What moves a vertex of a skin's k-th entry is the same in every frame, mixed or not, whatever skeleton the character
 * was updated with. Both characters of `pair` play the same: one has the skeleton of the pack, one the skin's own. */
static void skins_of_all_packs_are_posed(stage *g, const noh_skin *skin, int has_matrices)
{
    stage own;
    float inverse_bind[JOINTS * 12], joints_model[JOINTS * 12], a[JOINTS * 12], b[JOINTS * 12], palette[JOINTS * 12];
    uint32_t mixes = 0;
    stage_open(&own);
    g->s.skeleton.inverse_bind = NULL;
    assert_int_equal(noh_skin_skeleton(skin, &g->s.skeleton, inverse_bind, &own.s.skeleton), has_matrices);
    assert_ptr_equal(own.s.skeleton.inverse_bind, has_matrices ? inverse_bind : NULL);
    play(g, g->ch, 0, track_of(RUN, 1.0f));
    play(&own, own.ch, 0, track_of(RUN, 1.0f));
    for (int frame = 0; frame < 60; frame++) {
        const float scale = frame < 5 ? 1e6f : scale_for(errors[RUN][NOH_UPDATE_RATE_15]);
        noh_character_step(g->ch, &g->s.set, FRAME, NULL, NULL);
        noh_character_step(own.ch, &own.s.set, FRAME, NULL, NULL);
        if (noh_character_select_lod(g->ch, &g->table, &g->settings, scale)) update(g, g->ch);
        if (noh_character_select_lod(own.ch, &own.table, &own.settings, scale)) update(&own, own.ch);
        noh_character_skin(g->ch, skin, a);
        noh_character_skin(own.ch, skin, b);
        take_palette(g->ch, palette);
        noh_skin_matrices(skin, palette, joints_model);
        assert_memory_equal(a, joints_model, skin->header->joint_count * 48u);
        for (uint32_t i = 0; i < skin->header->joint_count * 12u; i++) assert_true(fabsf(a[i] - b[i]) < 4e-6f);
        mixes += noh_time_lod_fraction(&g->ch->time) < 1.0f;
        if (frame < 5) {
            noh_controller_pose(noh_character_controller(g->ch), &g->s.set, &g->scratch.pose, g->scratch.local,
                                g->scratch.floats);
            noh_pose_skin(&g->s.skeleton, skin, g->scratch.local, joints_model, b);
            assert_memory_equal(a, b, skin->header->joint_count * 48u);
        }
    }
    assert_true(mixes > 20);
    stage_close(&own);
}

static void a_skin_is_posed_with_and_without_inverse_bind_matrices(void **state)
{
    static const uint16_t once[5] = { 9, 3, 0, 22, 4 }, twice[5] = { 9, 3, 9, 22, 4 };
    (void)state;
    for (int k = 0; k < 2; k++) {
        stage g;
        float inverse_bind[5 * 12];
        noh_skin_header header;
        noh_skin skin;
        stage_open(&g);
        memset(&header, 0, sizeof header);
        memset(&skin, 0, sizeof skin);
        header.joint_count = 5;
        skin.header = &header;
        skin.joints = k ? twice : once;
        skin.inverse_bind = inverse_bind;
        for (uint32_t i = 0; i < 5; i++) {
            memcpy(inverse_bind + 12 * i, g.inverse_bind + 12 * skin.joints[i], 48);
            inverse_bind[12 * i + 7] += 0.1f * (float)i; /* each bound in its own way */
        }
        skins_of_all_packs_are_posed(&g, &skin, !k);
        stage_close(&g);
    }
}

/* The pose may be changed between the two halves of an update: a look-at. */
static void the_pose_may_be_changed_between_the_halves(void **state)
{
    stage g;
    float plain[JOINTS * 12], changed[JOINTS * 12], floats[FLOATS];
    (void)state;
    stage_open(&g);
    play(&g, g.ch, 0, track_of(WALK, 1.0f));
    noh_character_step(g.ch, &g.s.set, 100, NULL, NULL);
    noh_character_select_lod(g.ch, &g.table, &g.settings, 1e9f);
    update(&g, g.ch);
    take_palette(g.ch, plain);
    noh_character_update_begin(g.ch, &g.s.set, &g.scratch);
    g.scratch.local[0].translation[1] += 1.0f;
    g.scratch.floats[2] = 7.0f;
    noh_character_update_end(g.ch, &g.s.skeleton, NULL, &g.scratch);
    take_palette(g.ch, changed);
    take_floats(g.ch, floats);
    for (uint32_t j = 0; j < JOINTS; j++) assert_true(fabsf(changed[12 * j + 7] - plain[12 * j + 7] - 1.0f) < 1e-5f);
    assert_true(floats[2] == 7.0f);
    stage_close(&g);
}

/* ---- events ---- */

typedef struct fired {
    int64_t clock, position;
    uint32_t track, index;
    float weight;
    int backward;
} fired; /* no padding: compared as bytes */

#define FIRED_MAX 100000u

typedef struct record {
    uint32_t count;
    fired *events;
} record;

static void note(void *user, const noh_event *e)
{
    record *r = user;
    fired f = { e->clock, e->position_tick, e->track, e->index, e->weight, e->backward };
    assert_true(r->count < FIRED_MAX);
    r->events[r->count++] = f;
}

static void put_keys(scene *s)
{
    static const uint32_t ticks[8] = { 0, 11000, 47999, 48000, 1, 2500, 12000, 24000 };
    for (uint32_t i = 0; i < 8; i++) {
        s->events[i].tick = ticks[i];
        s->events[i].name_hash = 500u + i;
        s->events[i].weight_min = i == 1 ? 0.4f : 0.0f;
    }
    s->clips[WALK].event_count = 4;
    s->clips[WAVE].first_event = 4;
    s->clips[WAVE].event_count = 4;
    assert_int_equal(noh_clip_set_check(&s->set, NULL), NOH_OK);
}

/* The same change of tracks for both. */
static void change_tracks(noh_controller *c, const noh_clip_set *set, uint32_t kind, uint32_t number)
{
    noh_track_desc d = track_of(number % 2 ? WALK : WAVE, 1.0f);
    switch (kind % 4) {
    case 0: (void)noh_controller_set_speed(c, number % 3, (int32_t)(number % 200000) - 60000); break;
    case 1: (void)noh_controller_start(c, set, number % 3, &d, NULL); break;
    case 2:
        (void)noh_controller_cross_fade(c, set, number % 3, (number + 1) % 3, 1.0f, 1 + number % 30000,
                                        NOH_CURVE_LINEAR, NULL);
        break;
    default: (void)noh_controller_seek(c, set, number % 3, (int64_t)(number % 48000), NOH_SEEK_SKIP, NULL); break;
    }
}

/* A long random run: one character is stepped each frame, seen and unseen, posed at all rates, late and on time;
 * a controller alone is stepped from change to change. The same keys at the same ticks. */
static void keys_fire_the_same_with_and_without_lod(void **state)
{
    test_random r = test_random_from(42);
    record with = { 0, test_zeros(FIRED_MAX * sizeof(fired)) }, without = { 0, test_zeros(FIRED_MAX * sizeof(fired)) };
    uint8_t *plain_memory;
    noh_controller *plain;
    stage g;
    uint32_t waiting = 0, rates = 0;
    (void)state;
    stage_open(&g);
    put_keys(&g.s);
    plain_memory = test_aligned(NULL, noh_controller_size(&g.desc.controller));
    assert_int_equal(
        noh_controller_init(plain_memory, noh_controller_size(&g.desc.controller), &g.desc.controller, &plain, NULL),
        NOH_OK);
    for (int frame = 0; frame < 60000; frame++) {
        uint32_t ticks = 300 + test_random_below(&r, 1200);
        if (test_random_below(&r, 40) == 0) {
            uint32_t kind = test_random_u32(&r), number = test_random_u32(&r) >> 1;
            noh_controller_step(plain, &g.s.set, waiting, note, &without);
            waiting = 0;
            change_tracks(plain, &g.s.set, kind, number);
            change_tracks(noh_character_controller(g.ch), &g.s.set, kind, number);
            if (number % 2) noh_character_wake(g.ch);
        }
        noh_character_step(g.ch, &g.s.set, ticks, note, &with);
        waiting += ticks;
        if (frame / 100 % 4) { /* seen */
            noh_due due = noh_character_select_lod(g.ch, &g.table, &g.settings,
                                                   powf(10.0f, test_random_float(&r, -2.0f, 4.0f)));
            rates |= 1u << g.ch->lod.update_rate;
            if (due == NOH_DUE_AT_ONCE || (due == NOH_DUE && test_random_below(&r, 3))) update(&g, g.ch);
        }
    }
    noh_controller_step(plain, &g.s.set, waiting, note, &without);
    print_message("%u keys\n", with.count);
    assert_int_equal(with.count, without.count);
    assert_true(with.count > 5000 && rates == 15u);
    for (uint32_t i = 0; i < with.count; i++) assert_memory_equal(&with.events[i], &without.events[i], sizeof(fired));
    free(with.events), free(without.events), free(plain_memory);
    stage_close(&g);
}

/* ---- copies ---- */

static void a_copy_plays_the_same_on_its_own(void **state)
{
    stage g;
    uint8_t *array;
    float first[JOINTS * 12], other[JOINTS * 12];
    (void)state;
    stage_open(&g);
    play(&g, g.ch, 0, track_of(WALK, 1.0f));
    for (int frame = 0; frame < 13; frame++) {
        noh_character_step(g.ch, &g.s.set, FRAME, NULL, NULL);
        if (noh_character_select_lod(g.ch, &g.table, &g.settings, 0.5f) != NOH_DUE_NOT) update(&g, g.ch);
    }
    array = test_aligned(NULL, COPIES * g.size);
    for (uint32_t i = 0; i < COPIES; i++) memcpy(array + i * g.size, g.ch, g.ch->bytes);
    for (int frame = 0; frame < 100; frame++) {
        for (uint32_t i = 0; i < COPIES; i++) {
            noh_character *ch = (noh_character *)(void *)(array + i * g.size);
            if (frame == 10 && i % 2) noh_controller_set_speed(noh_character_controller(ch), 0, 3 * NOH_SPEED_ONE);
            noh_character_step(ch, &g.s.set, FRAME, NULL, NULL);
            if (noh_character_select_lod(ch, &g.table, &g.settings, 0.5f) != NOH_DUE_NOT) update(&g, ch);
            take_palette(ch, i == 0 ? first : other);
            if (i && i % 2 == 0) assert_memory_equal(first, other, sizeof first);
        }
        if (frame == 99) assert_memory_not_equal(first, other, sizeof first);
    }
    free(array);
    stage_close(&g);
}

/* A saved character with any one bit of its head turned is either refused or harmless. */
static void damaged_characters_do_no_harm(void **state)
{
    stage g;
    uint8_t *good;
    uint32_t refused = 0, accepted = 0;
    float shown[JOINTS * 12];
    (void)state;
    stage_open(&g);
    play(&g, g.ch, 0, track_of(WALK, 1.0f));
    for (int frame = 0; frame < 13; frame++) {
        noh_character_step(g.ch, &g.s.set, FRAME, NULL, NULL);
        if (noh_character_select_lod(g.ch, &g.table, &g.settings, 0.5f) != NOH_DUE_NOT) update(&g, g.ch);
    }
    good = test_aligned(g.ch, g.size);
    assert_int_equal(noh_character_check(g.ch, g.size, &g.s.set, &g.table, NULL), NOH_OK);
    assert_int_equal(noh_character_check(g.ch, g.size - 1u, &g.s.set, &g.table, NULL), NOH_ERR_DATA);
    assert_int_equal(noh_character_check(NULL, g.size, &g.s.set, &g.table, NULL), NOH_ERR_ARG);
    for (uint32_t bit = 0; bit < 8u * (uint32_t)sizeof *g.ch; bit++) {
        memcpy(g.ch, good, g.size);
        ((uint8_t *)g.ch)[bit / 8u] ^= (uint8_t)(1u << bit % 8u);
        if (noh_character_check(g.ch, g.size, &g.s.set, &g.table, NULL) != NOH_OK) {
            refused++;
            continue;
        }
        accepted++;
        noh_character_step(g.ch, &g.s.set, FRAME, NULL, NULL);
        if (noh_character_select_lod(g.ch, &g.table, &g.settings, 0.5f) != NOH_DUE_NOT) update(&g, g.ch);
        if (g.ch->time.posed) take_palette(g.ch, shown);
    }
    assert_true(refused > 8u * 32u && accepted > 0);
    free(good);
    stage_close(&g);
}

/* A crowd with a budget a little above the mean: no character in view goes without a pose, each frame keeps its budget
 * except for updates that cannot wait, and the lateness is within the stated bound. */
static void a_crowd_keeps_its_budget(void **state)
{
    enum { CROWD = 300, FRAMES = 600 };
    test_random r = test_random_from(43);
    noh_schedule schedule;
    uint8_t *array, *schedule_memory;
    uint32_t updates = 0, worst_late = 0;
    stage g;
    (void)state;
    stage_open(&g);
    play(&g, g.ch, 0, track_of(WALK, 1.0f));
    array = test_aligned(NULL, CROWD * g.size);
    schedule_memory = test_aligned(NULL, noh_schedule_size(CROWD));
    assert_int_equal(noh_schedule_init(schedule_memory, noh_schedule_size(CROWD), CROWD, &schedule, NULL), NOH_OK);
    for (uint32_t i = 0; i < CROWD; i++) {
        noh_character *ch = (noh_character *)(void *)(array + i * g.size);
        memcpy(ch, g.ch, g.size);
        ch->time.instance = i;
    }
    for (int frame = 0; frame < FRAMES; frame++) {
        uint32_t instance;
        noh_schedule_begin(&schedule, FRAME, 120);
        for (uint32_t i = 0; i < CROWD; i++) {
            noh_character *ch = (noh_character *)(void *)(array + i * g.size);
            float scale = scale_for(errors[WALK][i % 4 ? i % 4 : 1]);
            noh_due due;
            noh_character_step(ch, &g.s.set, FRAME, NULL, NULL);
            due = noh_character_select_lod(ch, &g.table, &g.settings, scale);
            if (due == NOH_DUE_AT_ONCE) {
                update(&g, ch);
                noh_schedule_spend(&schedule, 1);
            } else if (due == NOH_DUE) {
                noh_schedule_offer(&schedule, i, noh_character_late(ch),
                                   i % 4 ? 1.0f : test_random_float(&r, 1.0f, 4.0f), 1);
            }
        }
        assert_true(frame > 0 || schedule.spent == CROWD);
        while (noh_schedule_next(&schedule, &instance))
            update(&g, (noh_character *)(void *)(array + instance * g.size));
        assert_true(frame == 0 || schedule.spent <= 120);
        if (frame > 30) worst_late = schedule.late_ticks > worst_late ? schedule.late_ticks : worst_late;
        updates += schedule.served;
    }
    print_message("%.1f updates a frame of at most 120, at worst %u ticks late\n", (double)updates / FRAMES,
                  worst_late);
    assert_true(worst_late < FRAME); /* what is due is served in the same frame */
    assert_int_equal(schedule.lost, 0);
    free(array), free(schedule_memory);
    stage_close(&g);
}

/* After a cut the level for the new view is shown at once, without a fade from the old one. The controller is given the
 * level too, so that tracks that only near instances play are not sampled far away. */
static void a_cut_shows_the_new_level_at_once(void **state)
{
    static const noh_lod_mesh levels[2] = { { 100, 100, 4, 0.0f }, { 10, 10, 4, 0.1f } };
    stage g;
    (void)state;
    for (int cut = 0; cut < 2; cut++) {
        stage_open(&g);
        g.table.meshes = levels;
        g.table.mesh_level_count = 2;
        g.table.update_error_m = NULL;
        g.settings.shares[NOH_LOD_MESH] = 0.5f;
        g.settings.shares[NOH_LOD_UPDATES] = 0.5f;
        (void)noh_character_select_lod(g.ch, &g.table, &g.settings, 1e-3f);
        assert_int_equal(g.ch->lod.mesh, 1);
        assert_int_equal(noh_character_controller(g.ch)->lod, 1);
        (void)noh_character_step(g.ch, &g.s.set, FRAME, NULL, NULL);
        if (cut) noh_character_cut(g.ch);
        (void)noh_character_select_lod(g.ch, &g.table, &g.settings, 1e3f);
        assert_int_equal(g.ch->lod.mesh, 0);
        assert_int_equal(noh_character_controller(g.ch)->lod, 0);
        assert_true((noh_lod_fade(&g.ch->lod, noh_character_clock(g.ch)) < 1.0f) == !cut);
        stage_close(&g);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_is_exact),
        cmocka_unit_test(impossible_descs_are_refused),
        cmocka_unit_test(a_body_takes_less_than_8_kib),
        cmocka_unit_test(at_the_full_update_rate_it_is_the_exact_pose),
        cmocka_unit_test(at_low_update_rates_the_error_is_as_measured),
        cmocka_unit_test(a_change_begins_with_what_is_shown),
        cmocka_unit_test(cross_fades_stay_near_the_measured_error),
        cmocka_unit_test(the_sphere_holds_what_is_shown),
        cmocka_unit_test(dropped_joints_follow_their_parents),
        cmocka_unit_test(a_skin_is_posed_with_and_without_inverse_bind_matrices),
        cmocka_unit_test(the_pose_may_be_changed_between_the_halves),
        cmocka_unit_test(keys_fire_the_same_with_and_without_lod),
        cmocka_unit_test(a_copy_plays_the_same_on_its_own),
        cmocka_unit_test(a_cut_shows_the_new_level_at_once),
        cmocka_unit_test(damaged_characters_do_no_harm),
        cmocka_unit_test(a_crowd_keeps_its_budget),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
