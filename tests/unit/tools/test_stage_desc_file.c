/* Stages written as text (tools/noh/budget/stage_desc_file.h): each setting arrives in its field, a plan by the text is
 * the plan of the same desc in C, and an error names its line. Packs are the demo's, in $NOH_BUILD. */
#include "support/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "budget/stage_desc_file.h"
#include "cli/message.h"
#include "gpu/gpu.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/gl_device.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"

static noh_file files[2];
static noh_pack packs[2];

/* The packs in the folder of the texts, as puppet.noh and "a mask.noh". */
static int set_up(void **state)
{
    static const char *const from[] = { "demo/puppet_levels.noh", "mask_levels.noh" };
    static const char *const to[] = { "puppet.noh", "a mask.noh" };
    const char *build = getenv("NOH_BUILD");
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", build ? build : "build", from[i]);
        if (noh_file_map(path, &files[i], NULL) != NOH_OK) return 1;
        packs[i] = test_open(files[i].data, files[i].bytes);
        test_write_file(test_path(to[i]), files[i].data, files[i].bytes);
    }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    noh_file_unmap(&files[0]);
    noh_file_unmap(&files[1]);
    return 0;
}

static stage_desc_file *read_text(const char *text)
{
    stage_desc_file *f = NULL;
    const char *path = test_path("cast.txt");
    test_write_file(path, text, strlen(text));
    if (stage_desc_file_read(path, &f)) fail_msg("refused: %s: %s", tool_last_error()->subject, tool_last_failure());
    return f;
}

static void settings_arrive_in_their_fields(void **state)
{
    stage_desc_file *f = read_text(
        "\xef\xbb\xbf# of the whole stage\r\nbytes_max 18446744073709551615\r\n\tcpu_bytes_max 3 # three\n"
        "gpu_bytes_max 4\npixels 0.5\nheight_px 720\njobs 64\nhalves 1\n\n"
        "kind \"the hero\"\n  mesh puppet.noh\n  clips puppet.noh\n  clips \"a mask.noh\"\n"
        "  actor_count 20\n  visible_max 15\n  near_count 4\n  middle_count 8\n  finest_level 7\n"
        "  held_float_count 0\n  root_axes x,z,heading\n"
        "  layer body floats=\n"
        "  layer \"right arm\" over joints=\"spine_02 -clavicle_l\" tracks=8 floats=jaw*\n"
        "  layer more add\n"
        "kind \"k=v\"\nmesh \"a mask.noh\"\nactor_count 1\nheld_float_count 9");
    const noh_kind_desc *k = f->kinds;
    (void)state;
    assert_true(f->desc.bytes_max == UINT64_MAX && f->desc.cpu_bytes_max == 3 && f->desc.gpu_bytes_max == 4);
    assert_true(f->desc.lod.pixels == 0.5f && f->desc.height_px == 720 && f->desc.job_count == 64);
    assert_true(f->desc.halves == 1 && f->desc.kinds == f->kinds && f->desc.kind_count == 2);
    assert_string_equal(k[0].name, "the hero");
    assert_true(k[0].actor_count == 20 && k[0].near_count == 4 && k[0].middle_count == 8 && k[0].finest_level == 7);
    assert_true(k[0].visible_max == 15 && k[1].visible_max == 0);
    assert_true(k[0].held_float_count == NOH_NONE && k[1].held_float_count == 9);
    assert_true(k[0].root_axes == NOH_ROOT_GROUND && k[1].root_axes == 0);
    assert_true(k[0].clip_pack_count == 2 && k[0].clip_packs[0] == k[0].mesh && k[0].clip_packs[1] == k[1].mesh);
    assert_true(!k[0].clips && !k[1].clips && !k[1].clip_packs && !k[1].layers && k[0].layer_count == 3);
    assert_true(k[0].layers[0].mode == NOH_LAYER_BASE && !k[0].layers[0].joints && !k[0].layers[0].track_count);
    assert_string_equal(k[0].layers[0].floats, "");
    assert_string_equal(k[0].layers[1].name, "right arm");
    assert_string_equal(k[0].layers[1].joints, "spine_02 -clavicle_l");
    assert_string_equal(k[0].layers[1].floats, "jaw*");
    assert_true(k[0].layers[1].mode == NOH_LAYER_OVER && k[0].layers[1].track_count == 8);
    assert_true(k[0].layers[2].mode == NOH_LAYER_ADD);
    stage_desc_file_free(f);
}

static void a_file_named_in_two_ways_is_opened_once(void **state)
{
    char text[4096];
    stage_desc_file *f;
    (void)state;
    snprintf(text, sizeof text,
             "kind a\nmesh puppet.noh\nactor_count 1\nkind b\nmesh ./puppet.noh\nactor_count 1\nclips %s\n",
             test_path("puppet.noh"));
    f = read_text(text);
    assert_true(f->pack_count == 1 && f->kinds[0].mesh == f->kinds[1].mesh);
    assert_true(f->kinds[1].clip_packs[0] == f->kinds[0].mesh);
    stage_desc_file_free(f);
}

/* The same cast in C. */
static noh_stage_plan plan_in_c(uint64_t bytes_max, const noh_stage_gpu *drawn, const noh_gl_caps *caps)
{
    const noh_layer_desc layers[] = { { .name = "body", .floats = "" },
                                      { .name = "face", .mode = NOH_LAYER_OVER, .joints = "", .track_count = 1 } };
    noh_kind_desc kinds[2];
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    memset(kinds, 0, sizeof kinds);
    memset(&desc, 0, sizeof desc);
    kinds[0].name = "hero";
    kinds[0].mesh = &packs[0];
    kinds[0].actor_count = 20;
    kinds[0].near_count = 4;
    kinds[0].root_axes = NOH_ROOT_GROUND;
    kinds[0].layers = layers;
    kinds[0].layer_count = 2;
    kinds[1].name = "mask";
    kinds[1].mesh = &packs[1];
    kinds[1].actor_count = 3;
    desc.kinds = kinds;
    desc.kind_count = 2;
    desc.bytes_max = bytes_max;
    desc.lod.pixels = 2.0f;
    desc.height_px = 720;
    desc.job_count = 2;
    desc.gpu = drawn;
    if (noh_stage_plan_make(&desc, caps, &plan, &error) != NOH_OK) fail_msg("in C: %s", error.what);
    return plan;
}

static noh_stage_plan plan_of_text(uint64_t bytes_max, const noh_stage_gpu *drawn, const noh_gl_caps *caps)
{
    char text[1024], bound[64] = "";
    stage_desc_file *f;
    noh_stage_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    if (bytes_max) snprintf(bound, sizeof bound, "bytes_max %llu\n", (unsigned long long)bytes_max);
    snprintf(text, sizeof text,
             "%spixels 2\nheight_px 720\njobs 2\nkind hero\nmesh puppet.noh\nactor_count 20\nnear_count 4\n"
             "root_axes ground\nlayer body floats=\nlayer face over joints= tracks=1\n"
             "kind mask\nmesh \"a mask.noh\"\nactor_count 3\n",
             bound);
    f = read_text(text);
    f->desc.gpu = drawn;
    if (noh_stage_plan_make(&f->desc, caps, &plan, &error) != NOH_OK) fail_msg("by text: %s", error.what);
    stage_desc_file_free(f);
    return plan;
}

static void plans_by_text_and_in_c_are_equal_byte_by_byte(void **state)
{
    noh_gl_caps caps;
    noh_gl_caps_nominal(&caps);
    const noh_stage_plan whole = plan_in_c(0, &noh_stage_on_gl, &caps);
    const uint64_t all = whole.cpu_bytes + whole.gpu_bytes, bounds[] = { 0, all - 1u, all / 2u };
    (void)state;
    for (uint32_t i = 0; i < TEST_COUNT(bounds); i++) {
        const noh_stage_plan in_c = plan_in_c(bounds[i], &noh_stage_on_gl, &caps);
        const noh_stage_plan by_text = plan_of_text(bounds[i], &noh_stage_on_gl, &caps);
        assert_memory_equal(&in_c, &by_text, sizeof in_c);
        assert_true(in_c.gpu_bytes > 0 && (in_c.concession_count > 0) == (bounds[i] > 0));
    }
    for (uint32_t i = 0; i < 2; i++) {
        const noh_stage_plan in_c = plan_in_c(i ? whole.cpu_bytes / 2u : 0, NULL, NULL);
        const noh_stage_plan by_text = plan_of_text(i ? whole.cpu_bytes / 2u : 0, NULL, NULL);
        assert_memory_equal(&in_c, &by_text, sizeof in_c);
        assert_int_equal(in_c.gpu_bytes, 0);
    }
}

/* Kinds for slots: their order in the text is free, and they take no index. */
static void others_size_the_slots_of_their_kinds(void **state)
{
    stage_desc_file *f = read_text("kind a\nmesh puppet.noh\nactor_count 2\nchanges 2\n"
                                   "kind b\nmesh \"a mask.noh\"\nactor_count 5\nchanges 1\n"
                                   "kind c\nmesh \"a mask.noh\"\nactor_count 3\nother_of a\nlayer x\n"
                                   "kind d\nmesh puppet.noh\nactor_count 1\n"
                                   "kind e\nmesh puppet.noh\nactor_count 9\nother_of a\n");
    const noh_kind_desc *k = f->kinds;
    noh_stage_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    (void)state;
    assert_int_equal(f->desc.kind_count, 3);
    assert_string_equal(k[2].name, "d");
    assert_true(k[0].changes == 2 && k[1].changes == 1 && !k[2].changes);
    assert_true(k[0].other_count == 2 && k[1].other_count == 0 && k[2].other_count == 0);
    assert_string_equal(k[0].others[0].name, "c");
    assert_string_equal(k[0].others[0].layers[0].name, "x");
    assert_string_equal(k[0].others[1].name, "e");
    if (noh_stage_plan_make(&f->desc, NULL, &plan, &error) != NOH_OK) fail_msg("%s", error.what);
    assert_int_equal(plan.kinds[0].room.actor_count, 9);
    assert_true(plan.kinds[0].room.kind_bytes > plan.kinds[1].room.kind_bytes);
    stage_desc_file_free(f);
}

/* ---- what is wrong ---- */

static void refused(const char *text, size_t size, const char *line, const char *what)
{
    stage_desc_file *f = (stage_desc_file *)1;
    const char *path = test_path("bad.txt");
    char subject[512];
    test_write_file(path, text, size);
    assert_int_equal(stage_desc_file_read(path, &f), EXIT_FAILED);
    assert_null(f);
    snprintf(subject, sizeof subject, "%s%s", path, line);
    if (!strstr(tool_last_failure(), what) || strcmp(tool_last_error()->subject, subject) != 0)
        fail_msg("\"%s\": wanted '%s' at %s, got '%s' at %s", text, what, subject, tool_last_failure(),
                 tool_last_error()->subject);
}

#define HERO "kind hero\nmesh puppet.noh\n" /* the next is line 3 */

static void bad_lines_are_told_by_number(void **state)
{
    static const struct {
        const char *text, *line, *what;
    } rows[] = {
        { "", "", "no kind" },
        { "# nothing\n", "", "no kind" },
        { "\nbyte_max 3\n", ":2", "no setting 'byte_max'; did you mean 'bytes_max'?" },
        { "zzzzzzzzzzzz 3\n", ":1", "no setting 'zzzzzzzzzzzz'" },
        { "bytes_max\n", ":1", "bytes_max needs a value" },
        { "bytes_max \"\"\n", ":1", "bytes_max needs a value" },
        { "bytes_max=3\n", ":1", "write 'bytes_max VALUE' without an equals sign" },
        { "kind=b\n", ":1", "write 'kind VALUE' without an equals sign" },
        { "light 32 64=3\n", ":1", "light takes no '64='" },
        { "bytes_max x=3\n", ":1", "without an equals sign" },
        { "bytes_max 3 4\n", ":1", "'4' is one word too many after bytes_max" },
        { "bytes_max 3k\n", ":1", "bytes_max must be a whole number, not '3k'" },
        { "bytes_max -3\n", ":1", "must be a whole number, not '-3'" },
        { "bytes_max 18446744073709551616\n", ":1", "bytes_max is 18446744073709551616: it must be 1 to" },
        { "bytes_max 0\n", ":1", "bytes_max is 0" },
        { "jobs 65\n", ":1", "jobs is 65: it must be 1 to 64" },
        { "halves 2\n", ":1", "halves has no value '2'" },
        { "pixels 0\n", ":1", "pixels must be a number above 0" },
        { "pixels nan\n", ":1", "pixels must be a number" },
        { "jobs 1\njobs 2\n", ":2", "'jobs' is given twice; the first is in line 1" },
        { "mesh puppet.noh\n", ":1", "'mesh' belongs to a kind" },
        { HERO "pixels 1\n", ":3", "'pixels' belongs to the whole stage" },
        { HERO, ":1", "kind 'hero' has no actor_count" },
        { "kind a\nactor_count 1\nkind b\n", ":1", "kind 'a' has no mesh" },
        { HERO "actor_count 1\nkind hero\n", ":4", "the kind 'hero' is given twice" },
        { HERO "actor_count 1\nactor_count 1\n", ":4", "'actor_count' is given twice; the first is in line 3" },
        { HERO "actor_count 0\n", ":3", "actor_count is 0: it must be 1 to 65535" },
        { HERO "actr_count 1\n", ":3", "did you mean 'actor_count'?" },
        { HERO "finest_level 8\n", ":3", "finest_level is 8: it must be 0 to 7" },
        { HERO "root_axes x,heding\n", ":3", "root_axes has no value 'heding'; did you mean 'heading'?" },
        { HERO "root_axes x,\n", ":3", "root_axes has no value ''" },
        { HERO "layer\n", ":3", "layer needs a value" },
        { HERO "layer a ovr\n", ":3", "a layer has no value 'ovr'; did you mean 'over'?" },
        { HERO "layer a over add\n", ":3", "a layer takes no further word 'add'" },
        { HERO "layer a joint=x\n", ":3", "a layer has no option 'joint'; did you mean 'joints'?" },
        { HERO "layer a tracks=9\n", ":3", "tracks is 9: it must be 1 to 8" },
        { HERO "layer a tracks=1 tracks=1\n", ":3", "tracks= is given twice for this layer" },
        { HERO "layer a joints= joints=\n", ":3", "joints= is given twice for this layer" },
        { HERO "nodes 0 1=2\n", ":3", "nodes takes no '1='" },
        { HERO "face 0.03 1.5=9 0.1 -0.03 1.5 0.1\n", ":3", "face takes no '1.5='" },
        { HERO "modifier hair state=5 state=6\n", ":3", "state= is given twice for this modifier" },
        { HERO "texture_set a suffix=_x suffix=_y\n", ":3", "suffix= is given twice for this texture_set" },
        { HERO "actor_count 1\nragdoll_world physics\n", ":1", "add a line 'ragdolls N'" },
        { HERO "layer a\nlayer a\n", ":4", "the layer 'a' is given twice" },
        { "kind \"a\nmesh b\"\n", ":1", "a quote is not closed" },
        { HERO "changes 1\nactor_count 1\nkind b\nother_of her\n", ":6", "did you mean 'hero'?" },
        { HERO "actor_count 1\nkind b\nother_of hero\n", ":5", "add a line 'changes 1'" },
    };
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(rows); i++) {
        refused(rows[i].text, strlen(rows[i].text), rows[i].line, rows[i].what);
    }
    refused("kind a\0b\n", 9, "", "not a text");
}

static void too_many_of_a_thing_are_refused(void **state)
{
    static char text[1u << 16];
    size_t at = 0;
    (void)state;
    for (uint32_t i = 0; i <= NOH_STAGE_KINDS_MAX; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, "kind %u\nmesh puppet.noh\nactor_count 1\n", i);
    }
    refused(text, at, ":49", "more than 16 kinds");
    at = (size_t)snprintf(text, sizeof text, HERO);
    for (uint32_t i = 0; i <= NOH_LAYERS_MAX; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, "layer %u\n", i);
    }
    refused(text, at, ":19", "more than 16 layers");
    at = (size_t)snprintf(text, sizeof text, HERO);
    for (uint32_t i = 0; i <= STAGE_DESC_CLIPS_MAX; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, "clips puppet.noh\n");
    }
    refused(text, at, ":35", "more than 32 packs of clips");
    memset(text, 'x', 200);
    for (uint32_t i = 1; i < 200; i += 2) text[i] = ' ';
    refused(text, 200, ":1", "a line has more than 64 words");
}

static void packs_that_do_not_open_are_named_with_their_line(void **state)
{
    stage_desc_file *f;
    const char *path = test_path("bad.txt"), *text = "kind a\nmesh broken.noh\n",
               *missing = "kind a\n\nmesh none.noh\n";
    (void)state;
    test_write_file(test_path("broken.noh"), files[0].data, 1000);
    test_write_file(path, text, strlen(text));
    assert_int_equal(stage_desc_file_read(path, &f), EXIT_FAILED);
    assert_non_null(strstr(tool_last_error()->subject, "bad.txt:2: "));
    assert_non_null(strstr(tool_last_error()->subject, "broken.noh"));
    assert_int_equal(tool_last_error()->result, NOH_ERR_DATA);
    test_write_file(path, missing, strlen(missing));
    assert_int_equal(stage_desc_file_read(path, &f), EXIT_FAILED);
    assert_non_null(strstr(tool_last_error()->subject, "bad.txt:3: "));
    assert_non_null(strstr(tool_last_error()->subject, "none.noh"));
    assert_int_equal(stage_desc_file_read(test_path("no.txt"), &f), EXIT_FAILED);
    assert_non_null(strstr(tool_last_error()->subject, "no.txt"));
}

static void mutations_never_crash(void **state)
{
    static const char text[] = "pixels 2\njobs 2\nkind hero\nmesh puppet.noh\nactor_count 20\nclips puppet.noh\n"
                               "root_axes ground\nlayer body floats=\nlayer face over joints=\"a b\" tracks=1\n";
    static const char bytes[] = " \n\t\"=#,-0129xkmj\r";
    test_random r = test_random_from(7);
    uint32_t accepted = 0;
    (void)state;
    for (uint32_t i = 0; i < 400; i++) {
        char changed[sizeof text];
        stage_desc_file *f;
        memcpy(changed, text, sizeof text);
        for (uint32_t n = 1 + test_random_below(&r, 3); n; n--) {
            changed[test_random_below(&r, sizeof text - 1u)] = bytes[test_random_below(&r, sizeof bytes - 1u)];
        }
        test_write_file(test_path("mutated.txt"), changed, sizeof text - 1u);
        if (stage_desc_file_read(test_path("mutated.txt"), &f) == 0) {
            accepted++;
            assert_true(f->desc.kind_count > 0 && f->kinds[0].mesh && f->kinds[0].actor_count > 0);
            stage_desc_file_free(f);
        }
    }
    assert_true(accepted > 0 && accepted < 400);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(settings_arrive_in_their_fields),
    cmocka_unit_test(a_file_named_in_two_ways_is_opened_once),
    cmocka_unit_test(plans_by_text_and_in_c_are_equal_byte_by_byte),
    cmocka_unit_test(others_size_the_slots_of_their_kinds),
    cmocka_unit_test(bad_lines_are_told_by_number),
    cmocka_unit_test(too_many_of_a_thing_are_refused),
    cmocka_unit_test(packs_that_do_not_open_are_named_with_their_line),
    cmocka_unit_test(mutations_never_crash),
};

TEST_MAIN(tests, set_up, tear_down)
