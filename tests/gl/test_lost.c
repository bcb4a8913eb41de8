/* A lost context: it is destroyed, a new one is made, and everything is made again from
 * the pack. The picture is the same, the ledger is as before to the byte, and other objects that have
 * the old names in the new context are left alone. */
#include "support/gl_fixture.h"
#include "support/level_fixture.h"

#include "gpu/canvas.h"
#include "null.h"
#include "support/parts_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 96u
#define STRANGERS 64

typedef struct stage {
    gpu g;
    pack_file file;
    uint8_t *bytes;
    parts parts;
    fixture_levels levels; /* bytes NULL: without LOD levels */
} stage;

static int finished; /* 1: the next stage has finished vertices, by the path cpu in f32 */
static const fixture_way by_cpu = { NOH_MORPH_CPU, NOH_ACCUMULATE_F32 };

static void open_stage_of(stage *st, const char *driver, fixture_way way, int uint_layers, uint32_t level_count)
{
    const test_model_desc desc = { 2, 9, 6, TEST_TANGENTS | TEST_UVS | TEST_COLORS | TEST_SCENE, 23 };
    test_random r = test_random_from(7);
    size_t count;
    memset(st, 0, sizeof *st);
    if (gpu_open(&st->g, driver)) test_skip("no context of the driver %s here", driver);
    if (uint_layers) st->g.caps.render_f32 = st->g.caps.blend_f32 = 0;
    st->bytes = test_pack(&desc, &count);
    st->file.path = "a pack in memory";
    st->file.pack = test_open(st->bytes, count);
    if (level_count > 1) {
        fixture_levels_open(&st->levels, &st->file.pack, level_count, 2.0f);
        st->file.pack = st->levels.pack;
    }
    parts_open_as(&st->parts, &st->g, &st->file, way.path, way.accumulate, finished, 1);
    for (uint32_t i = 0; i < st->parts.item_count; i++) {
        part_item *item = &st->parts.items[i];
        test_random_weights(&r, item->weights, st->parts.meshes[item->mesh].header->target_count);
    }
}

static void open_stage(stage *st, const char *driver, fixture_way way, int uint_layers)
{
    open_stage_of(st, driver, way, uint_layers, 1);
}

static void close_stage(stage *st)
{
    noh_gl_ledger nothing;
    memset(&nothing, 0, sizeof nothing);
    parts_close(&st->parts);
    assert_int_equal(st->g.gl.GetError(), GL_NO_ERROR);
    assert_memory_equal(&st->g.ledger, &nothing, sizeof nothing);
    if (st->levels.bytes) fixture_levels_close(&st->levels);
    free(st->bytes);
    gpu_close(&st->g);
}

static uint8_t *picture_of_level(stage *st, uint32_t level)
{
    const noh_gl_lod drawn = { level, 0.0f, 1.0f };
    noh_gl_camera camera;
    canvas c;
    uint8_t *rgba = test_zeros(SIDE * SIDE * 4);
    parts_camera(&st->parts, NULL, SIDE, &camera);
    parts_update(&st->parts, NULL);
    assert_int_equal(canvas_open(&c, &st->g, SIDE, SIDE), 0);
    canvas_begin(&c);
    parts_draw(&st->parts, &camera, &drawn);
    assert_int_equal(canvas_read(&c, rgba), 0);
    canvas_close(&c);
    return rgba;
}

static uint8_t *picture(stage *st)
{
    return picture_of_level(st, 0);
}

static uint32_t colours_in(const uint8_t *rgba)
{
    uint32_t different = 0;
    for (size_t i = 4; i < SIDE * SIDE * 4; i += 4) different += memcmp(rgba, rgba + i, 4) != 0;
    return different;
}

/* Destroy the context, make another, and fill the same table. */
static void lose(stage *st)
{
    char message[1024];
    st->g.platform->destroy(st->g.context);
    assert_int_equal(st->g.platform->create(NULL, &st->g.context, message, sizeof message), NOH_OK);
    assert_int_equal(noh_gl_api_load(&st->g.gl, st->g.platform->get_proc, st->g.context, NULL), NOH_OK);
}

/* Buffers that are not noh's, in the new context, each with a content of its own. */
static void make_strangers(const noh_gl_api *gl, GLuint names[STRANGERS])
{
    gl->GenBuffers(STRANGERS, names);
    for (int32_t i = 0; i < STRANGERS; i++) {
        gl->BindBuffer(GL_ARRAY_BUFFER, names[i]);
        gl->BufferData(GL_ARRAY_BUFFER, sizeof i, &i, GL_STATIC_DRAW);
    }
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
}

static void expect_strangers(const noh_gl_api *gl, const GLuint names[STRANGERS])
{
    for (int32_t i = 0; i < STRANGERS; i++) {
        gl->BindBuffer(GL_ARRAY_BUFFER, names[i]);
        const int32_t *content = gl->MapBufferRange(GL_ARRAY_BUFFER, 0, sizeof i, GL_MAP_READ_BIT);
        assert_non_null(content);
        assert_int_equal(*content, i);
        gl->UnmapBuffer(GL_ARRAY_BUFFER);
    }
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
    gl->DeleteBuffers(STRANGERS, names);
}

static void lose_and_restore(fixture_way way, int uint_layers)
{
    GLuint strangers[STRANGERS];
    stage st;
    open_stage(&st, "egl", way, uint_layers);
    uint8_t *before = picture(&st);
    noh_gl_ledger ledger = st.g.ledger;
    assert_true(colours_in(before) > SIDE * SIDE / 20);
    for (int round = 0; round < 2; round++) {
        lose(&st);
        make_strangers(&st.g.gl, strangers);
        assert_int_equal(parts_restore(&st.parts), NOH_OK);
        assert_memory_equal(&st.g.ledger, &ledger, sizeof ledger);
        uint8_t *after = picture(&st);
        assert_memory_equal(before, after, SIDE * SIDE * 4);
        free(after);
        expect_strangers(&st.g.gl, strangers);
    }
    free(before);
    close_stage(&st);
}

static void every_path_comes_back(void **state)
{
    (void)state;
    for (int i = 0; i < FIXTURE_WAYS; i++) {
        print_message("# %s\n", fixture_way_name(fixture_ways[i]));
        lose_and_restore(fixture_ways[i], 0);
    }
    lose_and_restore((fixture_way){ NOH_MORPH_GATHER, NOH_ACCUMULATE_F32 }, 1);
    print_message("# finished vertices\n");
    finished = 1;
    lose_and_restore(by_cpu, 0);
    finished = 0;
}

/* LOD levels, and what each instance accumulates of them. */
static void levels_come_back(void **state)
{
    stage st;
    (void)state;
    for (int i = 0; i < FIXTURE_WAYS + 2; i += 2) { /* those with f32 */
        finished = i > FIXTURE_WAYS;
        open_stage_of(&st, "egl", finished ? by_cpu : fixture_ways[i], 0, 3);
        for (uint32_t k = 0; k < st.parts.item_count; k++)
            noh_gl_morph_set_lod(st.parts.morph.morph, st.parts.items[k].instance, 1);
        uint8_t *before = picture_of_level(&st, 1), *coarser = picture_of_level(&st, 2);
        noh_gl_ledger ledger = st.g.ledger;
        noh_gl_morph_stats stats;
        assert_memory_not_equal(before, coarser, SIDE * SIDE * 4);
        lose(&st);
        assert_int_equal(parts_restore(&st.parts), NOH_OK);
        assert_memory_equal(&st.g.ledger, &ledger, sizeof ledger);
        parts_update(&st.parts, &stats);
        assert_in_range(stats.pairs, 1,
                        st.parts.meshes[0].header[1].pair_count + st.parts.meshes[1].header[1].pair_count);
        uint8_t *after = picture_of_level(&st, 1);
        assert_memory_equal(before, after, SIDE * SIDE * 4);
        free(after);
        after = picture_of_level(&st, 2);
        assert_memory_equal(coarser, after, SIDE * SIDE * 4);
        free(after);
        free(before);
        free(coarser);
        close_stage(&st);
    }
    finished = 0;
}

/* The same on the null platform, which knows which names exist: no object of the old context is touched. */
static void nothing_old_is_called_by(fixture_way way)
{
    noh_null_report before, after;
    stage st;
    open_stage(&st, "null", way, 0);
    for (int i = 0; i < 4; i++) { /* all buffers of a ring, and their fences */
        for (uint32_t k = 0; k < st.parts.item_count; k++) st.parts.items[k].weights[0] = 0.125f * (float)i;
        parts_update(&st.parts, NULL);
    }
    noh_null_report_of(st.g.context, &before);
    lose(&st);
    assert_int_equal(parts_restore(&st.parts), NOH_OK);
    parts_update(&st.parts, NULL);
    noh_null_report_of(st.g.context, &after);
    assert_string_equal(after.first, "");
    assert_true(after.bytes == before.bytes);
    assert_memory_equal(after.live, before.live, sizeof after.live);
    assert_int_equal(noh_null_calls_of(st.g.context, "glDeleteTextures"), 0);
    assert_int_equal(noh_null_calls_of(st.g.context, "glDeleteBuffers"), 0);
    assert_int_equal(noh_null_calls_of(st.g.context, "glDeleteSync"), 0);
    close_stage(&st);
}

static void nothing_old_is_called(void **state)
{
    (void)state;
    for (finished = 1; finished >= 0; finished--) nothing_old_is_called_by(by_cpu);
    finished = 0;
}

/* In a context that refuses the accumulator, the object has no GL objects and may be restored again. */
static PFNGLTEXSTORAGE3DPROC real_storage;

static void GL_APIENTRY no_storage(GLenum target, GLsizei levels, GLenum format, GLsizei width, GLsizei height,
                                   GLsizei depth)
{
    (void)depth;
    real_storage(target, levels, format, width, height, -1);
}

static void a_refusal_leaves_nothing(void **state)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    stage st;
    (void)state;
    open_stage(&st, "egl", (fixture_way){ NOH_MORPH_GATHER, NOH_ACCUMULATE_F32 }, 0);
    uint64_t whole = noh_gl_ledger_bytes(&st.g.ledger);
    const noh_gl_morph_plan plan = *noh_gl_morph_plan_of(st.parts.morph.morph);
    lose(&st);
    real_storage = st.g.gl.TexStorage3D;
    st.g.gl.TexStorage3D = no_storage;
    assert_int_equal(noh_gl_morph_restore(st.parts.morph.morph, NULL, 0, &error), NOH_ERR_GL);
    assert_true(noh_gl_ledger_bytes(&st.g.ledger) == whole - plan.gpu_bytes);
    st.g.gl.TexStorage3D = real_storage;
    assert_int_equal(parts_restore(&st.parts), NOH_OK);
    assert_true(noh_gl_ledger_bytes(&st.g.ledger) == whole);
    close_stage(&st);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_path_comes_back),
        cmocka_unit_test(levels_come_back),
        cmocka_unit_test(nothing_old_is_called),
        cmocka_unit_test(a_refusal_leaves_nothing),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
