/* Tests of recipe.c: channels find their targets by name, and speech owns the mouth. */
#include "life/face/recipe_internal.h"
#include "noh/base.h"
#include "noh/face.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "support/support.h"

#define LINKS 512u

static noh_face_pose at_rest(void)
{
    noh_face_pose pose;
    memset(&pose, 0, sizeof pose);
    pose.head[3] = 1.0f;
    return pose;
}

static uint32_t links_of(const noh_face_link *links, uint32_t count, uint32_t channel)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < count; i++) n += links[i].channel == channel;
    return n;
}

/* The names of a recipe's targets, each once. */
static uint32_t names_of(const noh_face_recipe *recipe, const char **names)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < recipe->row_count; i++) {
        uint32_t k = 0;
        while (k < count && strcmp(names[k], recipe->rows[i].target) != 0) k++;
        if (k == count) names[count++] = recipe->rows[i].target;
    }
    return count;
}

static void tables_are_in_range(void **state)
{
    const noh_face_recipe *recipes[] = { &noh_face_recipe_arkit, &noh_face_recipe_vrm, &noh_face_recipe_units };
    (void)state;
    for (int r = 0; r < 3; r++) {
        for (uint32_t i = 0; i < recipes[r]->row_count; i++) {
            const noh_face_row *row = &recipes[r]->rows[i];
            assert_true(row->channel < NOH_CHANNEL_COUNT && row->weight > 0.0f && row->weight <= 1.0f);
            for (uint32_t k = 0; k < i; k++) {
                assert_false(recipes[r]->rows[k].channel == row->channel &&
                             strcmp(recipes[r]->rows[k].target, row->target) == 0);
            }
        }
    }
}

static void channels_have_names(void **state)
{
    (void)state;
    for (uint32_t c = 0; c < NOH_CHANNEL_COUNT; c++) {
        assert_true(noh_face_channel_name(c)[0] != 0);
        assert_int_equal(noh_face_channel_find(noh_face_channel_name(c)), c);
    }
    assert_string_equal(noh_face_channel_name(NOH_CHANNEL_COUNT), "");
    assert_int_equal(noh_face_channel_find("wink"), NOH_NONE);
    assert_int_equal(noh_face_channel_find("eye-right-out"), NOH_CHANNEL_EYES + 6);
    assert_int_equal(noh_face_channel_find("joy-mouth"), NOH_CHANNEL_MOUTH + NOH_EMOTION_JOY);
    assert_int_equal(noh_face_channel_find("contempt-upper"), NOH_CHANNEL_UPPER + NOH_EMOTION_CONTEMPT);
    assert_int_equal(noh_face_channel_find("kk"), NOH_CHANNEL_VISEMES + NOH_VISEME_KK);
}

static void sources_tell_what_falls_back(void **state)
{
    static const noh_face_row rows[] = { { "jaw", NOH_CHANNEL_VISEMES + NOH_VISEME_AA, 0.5f },
                                         { "gone", NOH_CHANNEL_VISEMES + NOH_VISEME_AA, 0.5f } };
    static const noh_face_recipe mine = { "mine", rows, 2, NULL };
    const noh_face_recipe *const recipes[1] = { &mine };
    const char *const names[1] = { "jaw" };
    noh_face_source source;
    (void)state;
    noh_face_recipe_source(recipes, 1, names, 1, NOH_CHANNEL_VISEMES + NOH_VISEME_AA, &source);
    assert_ptr_equal(source.recipe, &mine);
    assert_true(source.channel == NOH_CHANNEL_VISEMES + NOH_VISEME_AA && source.row_count == 2 &&
                source.found_count == 1);
    noh_face_recipe_source(recipes, 1, names, 1, NOH_CHANNEL_VISEMES + NOH_VISEME_E, &source);
    assert_ptr_equal(source.recipe, &mine); /* E falls back to ih, and that to aa */
    assert_int_equal(source.channel, NOH_CHANNEL_VISEMES + NOH_VISEME_AA);
    noh_face_recipe_source(recipes, 1, names, 1, NOH_CHANNEL_BREATH, &source);
    assert_null(source.recipe);
}

static void each_naming_is_bound_by_its_own_recipe(void **state)
{
    const noh_face_recipe *recipes[] = { &noh_face_recipe_arkit, &noh_face_recipe_vrm, &noh_face_recipe_units };
    const char *names[256];
    noh_face_link links[LINKS];
    (void)state;
    for (int r = 0; r < 3; r++) {
        const uint32_t name_count = names_of(recipes[r], names);
        const uint32_t count = noh_face_recipe_bind(NULL, 0, names, name_count, links, LINKS);
        assert_true(count >= recipes[r]->row_count && count <= LINKS);
        for (uint32_t v = NOH_VISEME_PP + (r == 1); v < NOH_VISEME_COUNT; v++) {
            /* VRM has five mouth shapes and none that shuts the lips */
            if (r == 1 && v == NOH_VISEME_FF) continue;
            assert_true(links_of(links, count, NOH_CHANNEL_VISEMES + v) > 0);
        }
        for (uint32_t i = 0; i < count; i++) assert_true(links[i].target < name_count);
        /* the count is the same where there is room for none */
        assert_int_equal(noh_face_recipe_bind(NULL, 0, names, name_count, NULL, 0), count);
    }
}

static void missing_shapes_take_the_nearest(void **state)
{
    const char *names[] = { "head", "aa", "ou" };
    noh_face_link links[LINKS];
    const uint32_t count = noh_face_recipe_bind(NULL, 0, names, 3, links, LINKS);
    (void)state;
    for (uint32_t i = 0; i < count; i++) {
        if (links[i].channel == NOH_CHANNEL_VISEMES + NOH_VISEME_E) assert_int_equal(links[i].target, 1);
        if (links[i].channel == NOH_CHANNEL_VISEMES + NOH_VISEME_CH) assert_int_equal(links[i].target, 2);
        if (links[i].channel == NOH_CHANNEL_VISEMES + NOH_VISEME_TH) assert_int_equal(links[i].target, 1);
    }
    assert_int_equal(links_of(links, count, NOH_CHANNEL_VISEMES + NOH_VISEME_TH), 1);
    assert_int_equal(links_of(links, count, NOH_CHANNEL_VISEMES + NOH_VISEME_PP), 0);
    assert_int_equal(links_of(links, count, NOH_CHANNEL_BLINK_LEFT), 0);
    assert_int_equal(noh_face_recipe_bind(NULL, 0, NULL, 0, links, LINKS), 0);
}

/* VRM's faces have no fear and no disgust: they show some surprise and anger. One of fear's own targets is enough. */
static void missing_emotions_take_a_like_one(void **state)
{
    const char *names[] = { "surprised", "angry", "mouthStretchLeft" };
    noh_face_link links[LINKS];
    (void)state;
    for (uint32_t own = 0; own < 2; own++) {
        const uint32_t count = noh_face_recipe_bind(NULL, 0, names, 2 + own, links, LINKS);
        assert_int_equal(links_of(links, count, NOH_CHANNEL_UPPER + NOH_EMOTION_FEAR), own ? 0 : 1);
        assert_int_equal(links_of(links, count, NOH_CHANNEL_UPPER + NOH_EMOTION_DISGUST), 1);
        assert_int_equal(links_of(links, count, NOH_CHANNEL_UPPER + NOH_EMOTION_CONTEMPT), 0);
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t emotion = links[i].channel - NOH_CHANNEL_UPPER;
            if (emotion != NOH_EMOTION_FEAR && emotion != NOH_EMOTION_DISGUST) continue;
            assert_int_equal(links[i].target, emotion == NOH_EMOTION_FEAR ? 0 : 1);
            assert_true(links[i].weight > 0.3f && links[i].weight < 0.9f);
        }
    }
}

static void a_recipe_that_is_whole_goes_before_one_in_part(void **state)
{
    /* jawOpen alone is a part of ARKit's aa; VRM's is whole */
    const char *names[] = { "jawOpen", "aa" };
    noh_face_link links[LINKS];
    const uint32_t count = noh_face_recipe_bind(NULL, 0, names, 2, links, LINKS);
    (void)state;
    for (uint32_t i = 0; i < count; i++) {
        if (links[i].channel == NOH_CHANNEL_VISEMES + NOH_VISEME_AA) assert_int_equal(links[i].target, 1);
    }
}

static void an_artists_rows_come_first(void **state)
{
    static const noh_face_row rows[] = { { "grin", NOH_CHANNEL_MOUTH + NOH_EMOTION_JOY, 0.5f } };
    static const noh_face_recipe own = { "own", rows, 1, NULL };
    const noh_face_recipe *recipes[] = { &own, &noh_face_recipe_arkit };
    const char *names[] = { "mouthSmileLeft", "mouthSmileRight", "mouthDimpleLeft", "mouthDimpleRight", "grin" };
    noh_face_link links[LINKS];
    const uint32_t count = noh_face_recipe_bind(recipes, 2, names, 5, links, LINKS);
    (void)state;
    assert_int_equal(links_of(links, count, NOH_CHANNEL_MOUTH + NOH_EMOTION_JOY), 1);
    for (uint32_t i = 0; i < count; i++) {
        if (links[i].channel == NOH_CHANNEL_MOUTH + NOH_EMOTION_JOY) {
            assert_int_equal(links[i].target, 4);
            assert_true(links[i].weight == 0.5f);
        }
    }
}

static void eyes_move_their_four_channels(void **state)
{
    noh_face_pose pose = at_rest();
    float channels[NOH_CHANNEL_COUNT];
    const float degree = 0.0174532925f;
    (void)state;
    pose.eyes[0][0] = 17.5f * degree; /* to the face's left: out for its left eye, in for the right one */
    pose.eyes[1][0] = 17.5f * degree;
    pose.eyes[0][1] = -15.0f * degree;
    pose.eyes[1][1] = 25.0f * degree;
    noh_face_channels(&pose, NULL, NOH_MOUTH_BLEND, channels);
    assert_true(fabsf(channels[NOH_CHANNEL_EYES + 1] - 0.5f) < 1e-5f && channels[NOH_CHANNEL_EYES] == 0.0f);
    assert_true(fabsf(channels[NOH_CHANNEL_EYES + 2] - 0.5f) < 1e-5f && channels[NOH_CHANNEL_EYES + 3] == 0.0f);
    assert_true(fabsf(channels[NOH_CHANNEL_EYES + 4] - 1.0f) < 1e-5f && channels[NOH_CHANNEL_EYES + 5] == 0.0f);
    assert_true(fabsf(channels[NOH_CHANNEL_EYES + 7] - 0.5f) < 1e-5f && channels[NOH_CHANNEL_EYES + 6] == 0.0f);
}

static void shut_lips_win(void **state)
{
    noh_face_pose pose = at_rest();
    float channels[NOH_CHANNEL_COUNT], visemes[NOH_VISEME_COUNT] = { 0 };
    (void)state;
    pose.emotions[NOH_EMOTION_SURPRISE] = 1.0f; /* which opens the jaw */
    visemes[NOH_VISEME_PP] = 1.0f;
    visemes[NOH_VISEME_AA] = 0.8f;
    for (int rule = NOH_MOUTH_BLEND; rule <= NOH_MOUTH_NONE; rule++) {
        noh_face_channels(&pose, visemes, (noh_mouth_rule)rule, channels);
        assert_true(channels[NOH_CHANNEL_VISEMES + NOH_VISEME_PP] == 1.0f);
        assert_true(channels[NOH_CHANNEL_VISEMES + NOH_VISEME_AA] == 0.0f);
        assert_true(channels[NOH_CHANNEL_MOUTH + NOH_EMOTION_SURPRISE] == 0.0f);
        assert_true(channels[NOH_CHANNEL_UPPER + NOH_EMOTION_SURPRISE] == 1.0f);
    }
}

static void speech_and_emotion_share_the_mouth_by_rule(void **state)
{
    noh_face_pose pose = at_rest();
    float channels[NOH_CHANNEL_COUNT], visemes[NOH_VISEME_COUNT] = { 0 };
    const uint32_t joy = NOH_CHANNEL_MOUTH + NOH_EMOTION_JOY;
    (void)state;
    pose.emotions[NOH_EMOTION_JOY] = 0.8f;
    visemes[NOH_VISEME_IH] = 0.25f;
    noh_face_channels(&pose, visemes, NOH_MOUTH_BLEND, channels);
    assert_true(fabsf(channels[joy] - 0.7f) < 1e-6f);
    noh_face_channels(&pose, visemes, NOH_MOUTH_BLOCK, channels);
    assert_true(channels[joy] == 0.0f);
    noh_face_channels(&pose, visemes, NOH_MOUTH_NONE, channels);
    assert_true(channels[joy] == 0.8f);
    noh_face_channels(&pose, NULL, NOH_MOUTH_BLOCK, channels);
    assert_true(channels[joy] == 0.8f);
}

/* ---- who owns what ---- */

/* Channels with all that an emotion shares a face with, and the emotion at `amount`. */
static void share(noh_emotion emotion, float amount, const noh_face_rules *rules, float moves, float shut,
                  float *channels)
{
    noh_face_pose pose = at_rest();
    float visemes[NOH_VISEME_COUNT] = { 0 };
    pose.emotions[emotion] = amount;
    pose.blink = 1.0f;
    pose.lids_down = 0.5f;
    pose.eyes[0][0] = pose.eyes[1][0] = 0.3f;
    visemes[NOH_VISEME_AA] = 0.5f;
    noh_face_channels(&pose, visemes, NOH_MOUTH_NONE, channels);
    noh_face_share(rules, moves, shut, channels);
}

/* Of one group of channels what is left at an emotion of 0, 0.25 and 1, by each rule. */
static void check_override(size_t group, uint32_t channel)
{
    static const float amounts[3] = { 0.0f, 0.25f, 1.0f };
    static const float left[3][3] = { { 1.0f, 1.0f, 1.0f }, { 1.0f, 0.0f, 0.0f }, { 1.0f, 0.75f, 0.0f } };
    for (uint32_t rule = NOH_OVERRIDE_NONE; rule <= NOH_OVERRIDE_BLEND; rule++) {
        for (uint32_t e = 0; e < NOH_EMOTION_COUNT; e++) {
            for (int i = 0; i < 3; i++) {
                noh_face_rules rules, none;
                float channels[NOH_CHANNEL_COUNT], free_channels[NOH_CHANNEL_COUNT];
                memset(&rules, 0, sizeof rules);
                memset(&none, 0, sizeof none);
                ((uint8_t *)&rules)[group + e] = (uint8_t)rule;
                share((noh_emotion)e, amounts[i], &none, 0.0f, 0.0f, free_channels);
                share((noh_emotion)e, amounts[i], &rules, 0.0f, 0.0f, channels);
                assert_true(free_channels[channel] > 0.0f);
                assert_true(fabsf(channels[channel] - left[rule][i] * free_channels[channel]) < 1e-6f);
                for (uint32_t c = 0; c < NOH_CHANNEL_COUNT; c++) { /* all else is left alone */
                    if (free_channels[c] == channels[c]) continue;
                    assert_true(group != offsetof(noh_face_rules, lids) || c <= NOH_CHANNEL_BLINK_RIGHT ||
                                c == NOH_CHANNEL_LIDS_UP || c == NOH_CHANNEL_LIDS_DOWN);
                    assert_true(group != offsetof(noh_face_rules, eyes) ||
                                (c >= NOH_CHANNEL_EYES && c < NOH_CHANNEL_EYES + 8u));
                }
            }
        }
    }
}

static void emotions_take_lids_by_rule(void **state)
{
    (void)state;
    check_override(offsetof(noh_face_rules, lids), NOH_CHANNEL_BLINK_LEFT);
    check_override(offsetof(noh_face_rules, lids), NOH_CHANNEL_BLINK_RIGHT);
    check_override(offsetof(noh_face_rules, lids), NOH_CHANNEL_LIDS_DOWN);
}

static void emotions_take_eyes_by_rule(void **state)
{
    (void)state;
    check_override(offsetof(noh_face_rules, eyes), NOH_CHANNEL_EYES + 2);
    check_override(offsetof(noh_face_rules, eyes), NOH_CHANNEL_EYES + 7);
}

static void emotions_take_speech_by_rule(void **state)
{
    (void)state;
    check_override(offsetof(noh_face_rules, speech), NOH_CHANNEL_VISEMES + NOH_VISEME_AA);
}

static uint32_t find_in_list(const void *user, const char *name, uint32_t nth)
{
    const char *const *list = user;
    for (uint32_t i = 0; list[i] && !nth; i++) {
        if (strcmp(list[i], name) == 0) return i;
    }
    return NOH_NONE;
}

/* Fear shows surprise's targets where no recipe has its own, and then by surprise's rules, unless it has one. */
static void an_emotion_with_anothers_targets_has_its_rules(void **state)
{
    static const char strings[] =
        "surprise-upper\0Surprised\0override-lids\0override-speech\0binary\0fear-mouth\0fear-upper\0override-eyes";
    enum { SURPRISE = 0, TARGET = 15, LIDS = 25, SPEECH = 39, BINARY = 55, FEAR_MOUTH = 62, FEAR = 73, EYES = 84 };
    static const char *const plain[] = { "Surprised", NULL };
    static const char *const arkit[] = { "Surprised",        "browInnerUp",       "eyeWideLeft",     "eyeWideRight",
                                         "mouthStretchLeft", "mouthStretchRight", "browOuterUpLeft", "browOuterUpRight",
                                         "browDownLeft",     "browDownRight",     "jawOpen",         NULL };
    noh_recipe_row rows[] = { { .channel = SURPRISE, .target = TARGET, .weight = 1.0f },
                              { .channel = LIDS, .target = SURPRISE, .weight = 1.0f },
                              { .channel = SPEECH, .target = SURPRISE, .weight = 2.0f },
                              { .channel = BINARY, .target = SURPRISE, .weight = 1.0f },
                              { .channel = FEAR_MOUTH, .target = TARGET, .weight = 0.5f } };
    const uint32_t fear = 1u << NOH_EMOTION_FEAR, surprise = 1u << NOH_EMOTION_SURPRISE;
    noh_pack pack = { .strings = strings, .string_bytes = sizeof strings, .recipe_rows = rows, .recipe_row_count = 4 };
    (void)state;
    assert_string_equal(strings + EYES, "override-eyes");
    for (int kind = 0; kind < 5; kind++) { /* 0: shares; targets of 1: the pack's, 2: a built-in recipe; rules: 3, 4 */
        noh_face_rules rules;
        pack.recipe_row_count = kind == 0 || kind == 2 ? 4 : 5;
        if (kind == 3) rows[4] = (noh_recipe_row){ .channel = EYES, .target = FEAR, .weight = 1.0f };
        if (kind == 4) rows[4] = (noh_recipe_row){ .channel = BINARY, .target = FEAR, .weight = 1.0f };
        const noh_face_recipe own = noh_face_recipe_in_pack(&pack);
        const noh_face_recipe *const recipes[] = { &own, &noh_face_recipe_arkit };
        const uint32_t taken = noh_face_taken(recipes, 2, find_in_list, kind == 2 ? arkit : plain);
        noh_face_rules_of_pack(&pack, &rules);
        assert_int_equal(rules.lids[NOH_EMOTION_FEAR], NOH_OVERRIDE_NONE);
        noh_face_share_rules(&pack, taken, &rules);
        assert_int_equal(taken & fear, kind == 1 || kind == 2 ? 0 : fear);
        assert_int_equal(rules.lids[NOH_EMOTION_FEAR], kind ? NOH_OVERRIDE_NONE : NOH_OVERRIDE_BLOCK);
        assert_int_equal(rules.speech[NOH_EMOTION_FEAR], kind ? NOH_OVERRIDE_NONE : NOH_OVERRIDE_BLEND);
        assert_int_equal(rules.eyes[NOH_EMOTION_FEAR], kind == 3 ? NOH_OVERRIDE_BLOCK : NOH_OVERRIDE_NONE);
        assert_int_equal(rules.binary, surprise | (kind == 0 || kind == 4 ? fear : 0u));
        assert_int_equal(rules.lids[NOH_EMOTION_DISGUST], NOH_OVERRIDE_NONE);
    }
}

/* No rule and no emotion opens lips that p, b, m, f or v shut. */
static void no_rule_opens_shut_lips(void **state)
{
    (void)state;
    for (uint32_t rule = 0; rule < 27; rule++) {
        for (uint32_t v = NOH_VISEME_PP; v <= NOH_VISEME_FF; v++) {
            noh_face_pose pose = at_rest();
            noh_face_rules rules;
            float channels[NOH_CHANNEL_COUNT], visemes[NOH_VISEME_COUNT] = { 0 };
            memset(&rules, 0, sizeof rules);
            for (int e = 0; e < NOH_EMOTION_COUNT; e++) {
                rules.mouth[e] = (uint8_t)(rule % 3u);
                rules.speech[e] = (uint8_t)(rule / 3u % 3u);
                rules.lids[e] = (uint8_t)(rule / 9u);
            }
            pose.emotions[NOH_EMOTION_SURPRISE] = 1.0f;
            visemes[v] = 1.0f;
            noh_face_channels(&pose, visemes, NOH_MOUTH_NONE, channels);
            noh_face_share(&rules, 0.0f, 0.0f, channels);
            assert_true(channels[NOH_CHANNEL_VISEMES + v] == 1.0f);
            assert_true(channels[NOH_CHANNEL_MOUTH + NOH_EMOTION_SURPRISE] == 0.0f);
        }
    }
}

/* Speech over an emotion's mouth: blend takes as much as it moves, block all, none nothing; whether its own shapes move
 * the mouth or a clip says so; and what a clip shuts stays shut by any rule. */
static void speech_takes_the_mouth_by_rule(void **state)
{
    static const float left[3] = { 0.7f, 0.0f, 1.0f };
    (void)state;
    for (uint32_t e = 0; e < NOH_EMOTION_COUNT; e++) {
        for (uint32_t rule = NOH_MOUTH_BLEND; rule <= NOH_MOUTH_NONE; rule++) {
            noh_face_rules rules;
            float channels[NOH_CHANNEL_COUNT];
            memset(&rules, 0, sizeof rules);
            rules.mouth[e] = (uint8_t)rule;
            share((noh_emotion)e, 0.8f, &rules, 0.6f, 0.0f, channels); /* a clip moves more than the aa of 0.5 */
            assert_true(fabsf(channels[NOH_CHANNEL_MOUTH + e] - 0.8f * left[rule]) < 1e-6f);
            assert_true(channels[NOH_CHANNEL_UPPER + e] == 0.8f);
            share((noh_emotion)e, 0.8f, &rules, 0.6f, 1.0f, channels);
            assert_true(channels[NOH_CHANNEL_MOUTH + e] == 0.0f);
        }
    }
}

static void no_pose_is_a_face_at_rest(void **state)
{
    const noh_face_pose pose = at_rest();
    float channels[NOH_CHANNEL_COUNT], same[NOH_CHANNEL_COUNT], visemes[NOH_VISEME_COUNT] = { 0 };
    (void)state;
    visemes[NOH_VISEME_AA] = 0.5f;
    noh_face_channels(&pose, visemes, NOH_MOUTH_BLEND, channels);
    noh_face_channels(NULL, visemes, NOH_MOUTH_BLEND, same);
    for (uint32_t i = 0; i < NOH_CHANNEL_COUNT; i++) assert_true(channels[i] == same[i]);
}

/* Granberg's controller adds its four channels as they come (Character Animation with Direct3D, chapter 9); mouth
 * shapes above 1 together would tear the lips apart. */
static void mouth_shapes_are_at_most_one_together(void **state)
{
    const noh_face_pose pose = at_rest();
    test_random r = test_random_from(7);
    (void)state;
    for (int i = 0; i < 1000; i++) {
        float channels[NOH_CHANNEL_COUNT], visemes[NOH_VISEME_COUNT], sum = 0.0f;
        for (int v = 0; v < NOH_VISEME_COUNT; v++) visemes[v] = test_random_float(&r, -0.2f, 1.3f);
        noh_face_channels(&pose, visemes, NOH_MOUTH_BLEND, channels);
        for (int v = NOH_VISEME_TH; v < NOH_VISEME_COUNT; v++) {
            assert_true(channels[NOH_CHANNEL_VISEMES + v] >= 0.0f);
            sum += channels[NOH_CHANNEL_VISEMES + v];
        }
        assert_true(
            sum + fmaxf(channels[NOH_CHANNEL_VISEMES + NOH_VISEME_PP], channels[NOH_CHANNEL_VISEMES + NOH_VISEME_FF]) <=
            1.00001f);
    }
}

static void weights_stay_within_bounds_and_others_are_left_alone(void **state)
{
    const noh_face_link links[] = { { NOH_CHANNEL_BREATH, 0, 0.7f },
                                    { NOH_CHANNEL_LIDS_UP, 0, 0.7f },
                                    { NOH_CHANNEL_BREATH, 2, 0.5f } };
    float channels[NOH_CHANNEL_COUNT] = { 0 }, weights[] = { 0.1f, 7.0f, 0.25f };
    (void)state;
    channels[NOH_CHANNEL_BREATH] = channels[NOH_CHANNEL_LIDS_UP] = 1.0f;
    noh_face_apply(links, 3, channels, weights);
    assert_true(weights[0] == 1.0f && weights[1] == 7.0f && weights[2] == 0.75f);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_are_in_range),
        cmocka_unit_test(channels_have_names),
        cmocka_unit_test(sources_tell_what_falls_back),
        cmocka_unit_test(each_naming_is_bound_by_its_own_recipe),
        cmocka_unit_test(missing_shapes_take_the_nearest),
        cmocka_unit_test(missing_emotions_take_a_like_one),
        cmocka_unit_test(a_recipe_that_is_whole_goes_before_one_in_part),
        cmocka_unit_test(an_artists_rows_come_first),
        cmocka_unit_test(eyes_move_their_four_channels),
        cmocka_unit_test(shut_lips_win),
        cmocka_unit_test(speech_and_emotion_share_the_mouth_by_rule),
        cmocka_unit_test(emotions_take_lids_by_rule),
        cmocka_unit_test(emotions_take_eyes_by_rule),
        cmocka_unit_test(emotions_take_speech_by_rule),
        cmocka_unit_test(an_emotion_with_anothers_targets_has_its_rules),
        cmocka_unit_test(no_rule_opens_shut_lips),
        cmocka_unit_test(speech_takes_the_mouth_by_rule),
        cmocka_unit_test(no_pose_is_a_face_at_rest),
        cmocka_unit_test(mouth_shapes_are_at_most_one_together),
        cmocka_unit_test(weights_stay_within_bounds_and_others_are_left_alone),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
