/* The head that demo_assets --nell writes, read back through the converter: its targets are all there and move what
 * they should, its mouth is closed at rest, its lids meet in a blink.
 *
 * The file is $NOH_BUILD/demo/nell.glb, which `make check` makes. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model.h"

static model *nell;
static const model_mesh *head;

static int set_up(void **state)
{
    char path[4096];
    const char *build = getenv("NOH_BUILD");
    model_error error;
    (void)state;
    snprintf(path, sizeof path, "%s/demo/nell.glb", build ? build : "build");
    if (model_read_gltf(path, &nell, &error)) {
        print_message("%s: %s (%s)\n", path, error.what, error.where);
        return 1;
    }
    head = nell->mesh_count == 1 ? &nell->meshes[0] : NULL;
    return head ? 0 : 1;
}

static int tear_down(void **state)
{
    (void)state;
    model_free(nell);
    return 0;
}

static const model_target *target_named(const char *name)
{
    for (uint32_t i = 0; i < head->target_count; i++) {
        if (!strcmp(head->targets[i].name, name)) {
            return &head->targets[i];
        }
    }
    fail_msg("there is no target '%s'", name);
    return NULL;
}

/* ---- targets ---- */

/* Lowest and highest y that a target of this kind may move, metres. */
typedef struct {
    const char *name;
    float low, high;
} one;

static const one middles[] = {
    { "browInnerUp", 0.0f, 0.08f },      { "cheekPuff", -0.09f, 0.01f },      { "jawForward", -0.13f, 0.0f },
    { "jawOpen", -0.13f, 0.0f },         { "mouthClose", -0.10f, 0.0f },      { "mouthFunnel", -0.13f, 0.0f },
    { "mouthPucker", -0.09f, 0.0f },     { "mouthRollLower", -0.09f, 0.0f },  { "mouthRollUpper", -0.09f, 0.0f },
    { "mouthShrugLower", -0.10f, 0.0f }, { "mouthShrugUpper", -0.09f, 0.0f }, { "tongueOut", -0.13f, 0.0f },
    { "jawLeft", -0.13f, 0.0f },         { "jawRight", -0.13f, 0.0f },        { "mouthLeft", -0.09f, 0.0f },
    { "mouthRight", -0.09f, 0.0f },      { "viseme_PP", -0.13f, 0.03f },      { "viseme_FF", -0.13f, 0.03f },
    { "viseme_TH", -0.13f, 0.03f },      { "viseme_DD", -0.13f, 0.03f },      { "viseme_kk", -0.13f, 0.03f },
    { "viseme_CH", -0.13f, 0.03f },      { "viseme_SS", -0.13f, 0.03f },      { "viseme_nn", -0.13f, 0.03f },
    { "viseme_RR", -0.13f, 0.03f },      { "viseme_aa", -0.13f, 0.03f },      { "viseme_E", -0.13f, 0.03f },
    { "viseme_I", -0.13f, 0.03f },       { "viseme_O", -0.13f, 0.03f },       { "viseme_U", -0.13f, 0.03f },
};

static const one pairs[] = {
    { "browDown", 0.0f, 0.08f },        { "browOuterUp", 0.0f, 0.08f },   { "cheekSquint", -0.06f, 0.03f },
    { "eyeBlink", -0.05f, 0.05f },      { "eyeLookDown", -0.05f, 0.05f }, { "eyeLookIn", -0.05f, 0.05f },
    { "eyeLookOut", -0.05f, 0.05f },    { "eyeLookUp", -0.05f, 0.05f },   { "eyeSquint", -0.06f, 0.05f },
    { "eyeWide", -0.05f, 0.05f },       { "mouthDimple", -0.08f, 0.0f },  { "mouthFrown", -0.10f, 0.0f },
    { "mouthLowerDown", -0.10f, 0.0f }, { "mouthPress", -0.08f, 0.0f },   { "mouthSmile", -0.09f, 0.03f },
    { "mouthStretch", -0.09f, 0.0f },   { "mouthUpperUp", -0.08f, 0.0f }, { "noseSneer", -0.08f, 0.01f },
};

/* How far the target moves all vertices together on the left (x above 0) and on the right. */
static void moved(const one *o, const char *name, double sum[2])
{
    const model_target *target = target_named(name);
    sum[0] = sum[1] = 0;
    for (uint32_t i = 0; i < head->vertex_count; i++) {
        const float *d = target->position + (size_t)i * 3, *at = head->position + (size_t)i * 3;
        double length = sqrt((double)(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
        if (length > 1e-5 && (at[1] < o->low || at[1] > o->high)) {
            fail_msg("%s moves a vertex at height %g", name, (double)at[1]);
        }
        sum[at[0] < 0.0f] += length;
    }
}

static void targets_move_what_they_name(void **state)
{
    double left[2], right[2];
    (void)state;
    target_named("viseme_sil");
    for (size_t i = 0; i < TEST_COUNT(middles); i++) {
        moved(&middles[i], middles[i].name, left);
        assert_true(left[0] + left[1] > 0.05);
    }
    for (size_t i = 0; i < TEST_COUNT(pairs); i++) {
        char name[64];
        snprintf(name, sizeof name, "%sLeft", pairs[i].name);
        moved(&pairs[i], name, left);
        snprintf(name, sizeof name, "%sRight", pairs[i].name);
        moved(&pairs[i], name, right);
        if (left[0] < 4 * left[1] || right[1] < 4 * right[0] || left[0] < 0.01) {
            fail_msg("%s moves the left by %g and %g, the right by %g and %g", name, left[0], left[1], right[0],
                     right[1]);
        }
    }
}

/* ---- slits ---- */

static void posed(uint32_t vertex, const model_target *a, const model_target *b, double at[3])
{
    for (int i = 0; i < 3; i++) {
        size_t place = (size_t)vertex * 3 + (size_t)i;
        at[i] = (double)head->position[place] + (a ? (double)a->position[place] : 0) +
                (b ? (double)b->position[place] : 0);
    }
}

static double apart(uint32_t i, uint32_t j, const model_target *a, const model_target *b)
{
    double p[3], q[3];
    posed(i, a, b, p);
    posed(j, a, b, q);
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
}

/* Counts pairs of the skin's vertices that lie together in one pose and at least `gap` apart in another. If `also` is
 * given, each pair must lie together with both targets as well. */
static int pairs_that_part(const model_target *together, const model_target *parted, double gap,
                           const model_target *also)
{
    int count = 0;
    const uint32_t first = head->submeshes[0].first_vertex, end = first + head->submeshes[0].vertex_count;
    for (uint32_t i = first; i < end; i++) {
        for (uint32_t j = i + 1; j < end; j++) {
            if (apart(i, j, together, NULL) > 2e-6 || apart(i, j, parted, NULL) < gap) {
                continue;
            }
            count++;
            if (also && apart(i, j, parted, also) > 1e-5) {
                fail_msg("vertices %u and %u stay %g apart", i, j, apart(i, j, parted, also));
            }
        }
    }
    return count;
}

static void lips_meet_at_rest(void **state)
{
    (void)state;
    assert_true(pairs_that_part(NULL, target_named("jawOpen"), 0.004, target_named("mouthClose")) >= 13);
}

/* A smile parts the lips widely enough that the row of teeth behind them is lit, and its corrective shuts them for a P;
 * mouthSmile leaves them shut. */
static void a_smile_parts_the_lips(void **state)
{
    (void)state;
    assert_true(pairs_that_part(NULL, target_named("smile"), 0.006, target_named("smile_viseme_PP")) >= 7);
    assert_true(pairs_that_part(target_named("mouthSmileLeft"), target_named("jawOpen"), 0.004, NULL) >= 13);
    assert_true(pairs_that_part(target_named("mouthSmileRight"), target_named("jawOpen"), 0.004, NULL) >= 13);
}

static int is_middle_of_mouth(const float *at)
{
    return fabsf(at[0]) < 0.006f && fabsf(at[1] + 0.0435f) < 0.005f && at[2] > 0.070f;
}

/* A slight smile is not a slit of grey teeth: the lower lip, which a smile lowers, still reaches up to the upper
 * one. */
static void a_slight_smile_keeps_the_lips_shut(void **state)
{
    const model_target *smile = target_named("smile");
    const uint32_t first = head->submeshes[0].first_vertex, end = first + head->submeshes[0].vertex_count;
    float lower = -1.0f, upper = 1.0f;
    (void)state;
    for (uint32_t i = first; i < end; i++) {
        const float *at = head->position + (size_t)i * 3;
        const float up = smile->position[(size_t)i * 3 + 1], y = at[1] + 0.2f * up;
        if (!is_middle_of_mouth(at)) continue;
        if (up < -0.002f) lower = fmaxf(lower, y);
        if (up > 0.002f) upper = fminf(upper, y);
    }
    assert_true(lower > upper);
}

static void lids_meet_in_a_blink(void **state)
{
    (void)state;
    assert_true(pairs_that_part(target_named("eyeBlinkLeft"), NULL, 0.005, NULL) >= 9);
    assert_true(pairs_that_part(target_named("eyeBlinkRight"), NULL, 0.005, NULL) >= 9);
}

/* Lashes taper: their outermost two millimetres are at most five high; a blunt end was nine. They end near the
 * lids: at 51.9 mm they stood out past the far side of the face. */
static void lashes_taper(void **state)
{
    float outermost = 0.0f, low = 1.0f, high = -1.0f;
    (void)state;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t v = 0; v < head->vertex_count; v++) {
            const float *p = head->position + 3 * (size_t)v, *c = head->color + 4 * (size_t)v;
            if (fabsf(c[0] - 0.022f) > 0.002f || fabsf(c[2] - 0.006f) > 0.002f || p[0] < 0.02f) continue;
            if (pass == 0) outermost = fmaxf(outermost, p[0]);
            if (pass == 0 || p[0] < outermost - 0.002f) continue;
            low = fminf(low, p[1]), high = fmaxf(high, p[1]);
        }
    }
    print_message("from %.4f to %.4f at %.4f\n", (double)low, (double)high, (double)outermost);
    assert_true(high > low && high - low < 0.005f);
    assert_true(outermost < 0.0505f);
}

/* Its triangles are few enough for a phone's hero, and it has a dozen clips. */
static void it_is_small_and_has_clips(void **state)
{
    (void)state;
    assert_true(head->index_count <= 3 * 25000);
    assert_int_equal(nell->clip_count, 12);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(targets_move_what_they_name),
    cmocka_unit_test(lips_meet_at_rest),
    cmocka_unit_test(a_smile_parts_the_lips),
    cmocka_unit_test(a_slight_smile_keeps_the_lips_shut),
    cmocka_unit_test(lids_meet_in_a_blink),
    cmocka_unit_test(it_is_small_and_has_clips),
    cmocka_unit_test(lashes_taper),
};

TEST_MAIN(tests, set_up, tear_down)
