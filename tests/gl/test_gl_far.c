/* Pictures of a crowd with hair, in the light of a room with its shadow on a floor, of blobs and of a game's own
 * shader: 100 km from the origin as at the origin. */
#include "support/gl_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file/pack_file.h"
#include "gpu/canvas.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/gl_device.h"
#include "noh/light.h"
#include "noh/low_gl.h"
#include "noh/low_life.h"
#include "noh/marks.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#define SIDE 256u
#define ACTORS 3u
#define TICKS 800u
#define SHADOW_PX 256u
#define FRAMES 24

enum { PUPPETS, HEADS, KINDS };

typedef struct scene {
    gpu *g;
    pack_file files[KINDS];
    void *texels;
    noh_reflection reflection;
    noh_gl_light_desc light;
    noh_lighting lighting;
    noh_haircut cut;
    noh_modifier part;
    noh_kind_desc kinds[KINDS];
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    noh_actor_hair_desc hair_desc;
    noh_actor_hair *hair;
    noh_stage_hair drawn_hair;
    noh_stage_floor level;
    noh_stage_blob blob;
    noh_stage_shader *shader;
    void *memory, *hair_memory, *drawn_memory, *shader_memory;
    canvas c;
} scene;

static void open_pack(pack_file *file, const char *name)
{
    static char path[1024];
    const char *build = getenv("NOH_BUILD");
    snprintf(path, sizeof path, "%s/%s", build ? build : "build", name);
    assert_int_equal(pack_file_open(file, path), 0);
}

static void open_light(scene *s)
{
    const noh_environment *room = noh_environment_at(noh_environment_find("room"));
    const noh_reflection_desc desc = { 0, noh_reflection_of_environment, room };
    const size_t bytes = noh_reflection_size(0), scratch_bytes = noh_reflection_scratch_size(0);
    void *scratch = malloc(scratch_bytes);
    noh_light all;
    s->texels = malloc(bytes);
    assert_int_equal(noh_reflection_init(s->texels, bytes, scratch, scratch_bytes, &desc, &s->reflection, NULL),
                     NOH_OK);
    free(scratch);
    noh_light_from_environment(room, NOH_SH_ORDER_MAX, &all);
    noh_lighting_make(&all, NULL, 1, &s->lighting);
    s->light.reflection = &s->reflection;
    s->light.shadow_px = SHADOW_PX;
}

static void open_stage(scene *s)
{
    const noh_gl_device device = { &s->g->gl, &s->g->caps, &s->g->ledger, NULL, 0 };
    for (uint32_t k = 0; k < KINDS; k++) {
        s->kinds[k].mesh = &s->files[k].pack;
        s->kinds[k].actor_count = s->kinds[k].near_count = ACTORS;
    }
    s->kinds[HEADS].skeleton = NOH_NONE;
    s->desc.kinds = s->kinds;
    s->desc.kind_count = KINDS;
    s->desc.height_px = SIDE;
    s->desc.full_detail = 1;
    s->desc.gpu = &noh_stage_on_gl;
    s->desc.light = &s->light;
    assert_int_equal(noh_stage_plan_make(&s->desc, &s->g->caps, &s->plan, NULL), NOH_OK);
    s->memory = test_aligned(NULL, (size_t)s->plan.cpu_bytes);
    assert_int_equal(noh_stage_init(s->memory, (size_t)s->plan.cpu_bytes, &device, &s->desc, &s->plan, &s->stage, NULL),
                     NOH_OK);
    noh_stage_set_lighting(s->stage, &s->lighting);
}

static void open_hair(scene *s)
{
    const noh_gl_device device = { &s->g->gl, &s->g->caps, &s->g->ledger, NULL, 0 };
    s->hair_desc.kind = HEADS;
    s->hair_desc.head_max = s->hair_desc.near_max = ACTORS;
    const size_t bytes = noh_actor_hair_size(&s->hair_desc), drawn = noh_stage_hair_size(&s->hair_desc);
    s->hair_memory = test_aligned(NULL, bytes);
    s->drawn_memory = test_aligned(NULL, drawn);
    assert_int_equal(noh_actor_hair_init(s->hair_memory, bytes, &s->hair_desc, &s->hair, NULL), NOH_OK);
    assert_int_equal(noh_stage_hair_create(&device, s->hair, s->drawn_memory, drawn, 1, 0, &s->drawn_hair, NULL),
                     NOH_OK);
}

/* It shows where the stage's space is, made coarse: stripes every 25 cm of height. */
static const char own_vertex[] = "out vec3 v_at;\n"
                                 "void main()\n"
                                 "{\n"
                                 "    noh_vertex v = noh_fetch();\n"
                                 "    v_at = v.position;\n"
                                 "    gl_Position = noh_view_projection * vec4(v.position, 1.0);\n"
                                 "}\n";
static const char own_fragment[] = "in vec3 v_at;\n"
                                   "layout(location = 0) out vec4 o_color;\n"
                                   "void main()\n"
                                   "{\n"
                                   "    o_color = vec4(vec3(step(0.5, fract(4.0 * v_at.y))), 1.0);\n"
                                   "}\n";

static void open_shader(scene *s)
{
    const noh_gl_shader_desc desc = { .name = "stripes", .vertex = own_vertex, .fragment = own_fragment };
    const size_t bytes = noh_stage_shader_size(s->stage);
    s->shader_memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_stage_shader_create(s->stage, s->shader_memory, bytes, &desc, NULL, 0, &s->shader, NULL),
                     NOH_OK);
}

static void open_scene(scene *s)
{
    memset(s, 0, sizeof *s);
    s->g = fixture_gpu();
    const noh_gl_device device = { &s->g->gl, &s->g->caps, &s->g->ledger, NULL, 0 };
    open_pack(&s->files[PUPPETS], "demo/puppet.noh");
    open_pack(&s->files[HEADS], "wig.noh");
    assert_int_equal(noh_haircut_open(&s->files[HEADS].pack, &s->cut, NULL), NOH_OK);
    assert_int_equal(noh_actor_hair_desc_make(&s->cut, &s->files[HEADS].pack, NOH_NONE, &s->hair_desc, NULL), NOH_OK);
    open_light(s);
    open_stage(s);
    open_hair(s);
    open_shader(s);
    assert_int_equal(noh_stage_floor_create(&device, 0, &s->level, NULL), NOH_OK);
    assert_int_equal(noh_stage_blob_create(&device, &s->blob, NULL), NOH_OK);
    assert_int_equal(canvas_open(&s->c, s->g, SIDE, SIDE), 0);
}

static void close_scene(scene *s)
{
    canvas_close(&s->c);
    noh_stage_blob_delete(&s->blob);
    noh_stage_floor_delete(&s->level);
    noh_stage_shader_delete(s->shader);
    noh_stage_hair_delete(&s->drawn_hair);
    noh_stage_delete(s->stage);
    for (uint32_t k = 0; k < KINDS; k++) pack_file_close(&s->files[k]);
    free(s->memory);
    free(s->hair_memory);
    free(s->drawn_memory);
    free(s->shader_memory);
    free(s->texels);
    assert_int_equal(noh_gl_ledger_bytes(&s->g->ledger), 0);
    fixture_expect_no_errors();
}

static void enter(scene *s, float x, float z)
{
    const noh_play play = { .fade_ticks = 1 };
    noh_actor actor;
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_place at = { .position = { x + 0.75f * (float)i - 0.75f, 0.0f, z - 0.5f * (float)i } };
        const noh_place over = { .position = { x + 0.5f * (float)i - 0.5f, 1.75f, z + 0.25f } };
        assert_int_equal(noh_stage_spawn(s->stage, PUPPETS, &at, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(s->stage, actor, 0, "dance", &play, NULL), NOH_OK);
        assert_int_equal(noh_stage_spawn(s->stage, HEADS, &over, &actor, NULL), NOH_OK);
    }
}

static void leave(scene *s)
{
    for (uint32_t i = 0; i < KINDS * ACTORS; i++) {
        const noh_actor actor = noh_stage_actor_at(s->stage, i);
        if (actor.id) assert_int_equal(noh_stage_despawn(s->stage, actor, NULL), NOH_OK);
    }
}

/* own  1: by the game's shader */
static uint8_t *picture(scene *s, const noh_stage_view *view, float x, float z, int own)
{
    const float disc[4] = { x, 0.0f, z, 4.0f };
    const noh_blob spot = { { x - 1.0f, 0.0f, z + 0.5f }, 0.8f, { 0.5f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.25f } };
    uint8_t *rgba = test_zeros(SIDE * SIDE * 4u);
    assert_int_equal(noh_stage_draw_shadow(s->stage, 1, NULL), NOH_OK);
    canvas_begin(&s->c);
    noh_stage_floor_draw(&s->level, noh_stage_light_of(s->stage), &s->lighting, view, disc);
    noh_stage_blob_draw(&s->blob, view, &spot, 1);
    if (own) {
        assert_int_equal(noh_stage_draw(s->stage, NOH_PASS_OPAQUE, 0, s->shader, NULL), NOH_OK);
    } else {
        assert_int_equal(noh_stage_draw(s->stage, NOH_PASS_DEPTH, 0, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_draw(s->stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
        noh_stage_hair_draw(&s->drawn_hair, s->stage, 0, NOH_PASS_COLOR);
    }
    canvas_resolve(&s->c);
    assert_int_equal(canvas_read(&s->c, rgba), 0);
    return rgba;
}

/* Both pictures; the camera goes round meanwhile, so that a frame's origin is another now and then. */
static void take(scene *s, float x, float z, uint8_t *out[2])
{
    const float target[3] = { x, 1.0f, z }, sphere[4] = { x, 1.0f, z, 3.0f };
    noh_stage_view views[2];
    enter(s, x, z);
    for (int i = 0; i < FRAMES; i++) {
        noh_view_orbit(&views[0], target, 0.04f * (float)i, 0.25f, 5.0f, SIDE, SIDE);
        noh_view_shadow(&views[1], sphere, s->lighting.key_direction);
        noh_lighting_shadow(&s->lighting, views[1].view_projection, sphere[3], SHADOW_PX);
        s->lighting.has_floor = 1; /* at 0 */
        assert_int_equal(noh_stage_step(s->stage, TICKS, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame_begin(s->stage, views, 2, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame_end(s->stage, NULL), NOH_OK);
        noh_actor_hair_frame(s->hair, s->stage, TICKS);
    }
    noh_stage_hair_update(&s->drawn_hair);
    out[0] = picture(s, &views[0], x, z, 0);
    out[1] = picture(s, &views[0], x, z, 1);
    leave(s);
}

static uint32_t differing(const uint8_t *a, const uint8_t *b, int by)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        int worst = 0;
        for (uint32_t k = 0; k < 3; k++) {
            const int off = abs((int)a[4u * i + k] - (int)b[4u * i + k]);
            worst = off > worst ? off : worst;
        }
        count += worst > by;
    }
    return count;
}

static void pictures_are_the_same_far_away(void **state)
{
    static const float places[][2] = { { 100000.0f, -100000.0f }, { 65536.0f, 4096.0f }, { 1000000.0f, 250000.0f } };
    uint8_t *here[2], *there[2];
    scene s;
    (void)state;
    open_scene(&s);
    take(&s, 0.0f, 0.0f, here);
    for (size_t p = 0; p < TEST_COUNT(places); p++) {
        take(&s, places[p][0], places[p][1], there);
        for (int own = 0; own < 2; own++) {
            const uint32_t seen = differing(here[own], there[own], 2), far_off = differing(here[own], there[own], 24);
            print_message("%g, %g, %s: %u of %u pixels differ by more than 2, %u by more than 24\n",
                          (double)places[p][0], (double)places[p][1], own ? "own shader" : "lit", seen, SIDE * SIDE,
                          far_off);
            assert_true(seen < SIDE * SIDE / 100u); /* edges of shadows: its matrix is in floats of the world */
            assert_true(far_off < SIDE * SIDE / 5000u);
            free(there[own]);
        }
    }
    free(here[0]);
    free(here[1]);
    close_scene(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(pictures_are_the_same_far_away) };
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
