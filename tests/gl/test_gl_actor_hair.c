/* Hair of actors, one head and crowds: strips of the vertex shader equal the CPU's; which hair moves; exact bytes
 * and draw calls; a lost context; fewer strips cover as much; far away hair fades into the texture of the head. */
#include "support/gl_fixture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file/pack_file.h"
#include "life/hair/haircut_internal.h"
#include "stage/actors/actor_hair_internal.h"
#include "life/hair/hair_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "gpu/canvas.h"
#include "shaders.gen.h"

#define SIDE 192u
#define ACTORS_MAX 12u
#define TICKS 800u
#define RADIANS(degrees) (0.01745329f * (degrees))

typedef struct scene {
    gpu *g;
    pack_file file;
    noh_haircut cut;
    noh_actor_hair_desc hair_desc;
    noh_modifier part;
    noh_kind_desc kind;
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    noh_actor actors[ACTORS_MAX];
    noh_actor_hair *hair;
    noh_stage_hair drawn;
    void *memory, *hair_memory, *drawn_memory;
    canvas c;
} scene;

enum { OUTSIDE, IN_STATE };

static void open_stage(scene *s, uint32_t actors, uint32_t near_max, int in_state)
{
    static char path[1024];
    const char *build = getenv("NOH_BUILD");
    const noh_gl_device device = { &s->g->gl, &s->g->caps, &s->g->ledger, NULL, 0 };
    snprintf(path, sizeof path, "%s/wig.noh", build ? build : "build");
    assert_int_equal(pack_file_open(&s->file, path), 0);
    assert_int_equal(noh_haircut_open(&s->file.pack, &s->cut, NULL), NOH_OK);
    assert_int_equal(noh_actor_hair_desc_make(&s->cut, &s->file.pack, NOH_NONE, &s->hair_desc, NULL), NOH_OK);
    s->hair_desc.head_max = actors;
    s->hair_desc.near_max = near_max;
    s->hair_desc.in_state = in_state;
    s->part = noh_actor_hair_modifier(&s->hair_desc);
    s->kind.mesh = &s->file.pack;
    s->kind.skeleton = NOH_NONE;
    s->kind.actor_count = s->kind.near_count = actors;
    s->kind.modifiers = &s->part;
    s->kind.modifier_count = in_state ? 1 : 0;
    s->desc.kinds = &s->kind;
    s->desc.kind_count = 1;
    s->desc.height_px = SIDE;
    s->desc.gpu = &noh_stage_on_gl;
    assert_int_equal(noh_stage_plan_make(&s->desc, &s->g->caps, &s->plan, NULL), NOH_OK);
    s->memory = test_aligned(NULL, (size_t)s->plan.cpu_bytes);
    assert_int_equal(noh_stage_init(s->memory, (size_t)s->plan.cpu_bytes, &device, &s->desc, &s->plan, &s->stage, NULL),
                     NOH_OK);
}

static void open_hair(scene *s)
{
    const noh_gl_device device = { &s->g->gl, &s->g->caps, &s->g->ledger, NULL, 0 };
    const size_t bytes = noh_actor_hair_size(&s->hair_desc), drawn = noh_stage_hair_size(&s->hair_desc);
    s->hair_memory = test_aligned(NULL, bytes);
    s->drawn_memory = test_aligned(NULL, drawn);
    assert_int_equal(noh_actor_hair_init(s->hair_memory, bytes, &s->hair_desc, &s->hair, NULL), NOH_OK);
    assert_int_equal(noh_stage_hair_create(&device, s->hair, s->drawn_memory, drawn, 0, 0, &s->drawn, NULL), NOH_OK);
}

/* Side by side, each further from the camera than the one before by `apart` metres. */
static void open_scene(scene *s, uint32_t actors, uint32_t near_max, float apart, int in_state)
{
    memset(s, 0, sizeof *s);
    s->g = fixture_gpu();
    open_stage(s, actors, near_max, in_state);
    open_hair(s);
    for (uint32_t i = 0; i < actors; i++) {
        const noh_place place = { { 0.3f * ((float)i - 0.5f * (float)(actors - 1u)), 0.0f, -apart * (float)i },
                                  { 0, 0, 0, 0 },
                                  0.0f };
        assert_int_equal(noh_stage_spawn(s->stage, 0, &place, &s->actors[i], NULL), NOH_OK);
    }
    assert_int_equal(canvas_open(&s->c, s->g, SIDE, SIDE), 0);
}

static void close_scene(scene *s)
{
    canvas_close(&s->c);
    noh_stage_hair_delete(&s->drawn);
    noh_stage_delete(s->stage);
    pack_file_close(&s->file);
    free(s->memory);
    free(s->hair_memory);
    free(s->drawn_memory);
    assert_int_equal(noh_gl_ledger_bytes(&s->g->ledger), 0);
    fixture_expect_no_errors();
}

static void frame_from(scene *s, float azimuth, float elevation, float distance)
{
    const float target[3] = { 0.0f, 0.0f, 0.0f };
    noh_stage_view view;
    noh_view_orbit(&view, target, azimuth, elevation, distance, SIDE, SIDE);
    assert_int_equal(noh_stage_frame(s->stage, TICKS, &view, NULL, NULL, NULL), NOH_OK);
    noh_actor_hair_frame(s->hair, s->stage, TICKS);
}

static void frame(scene *s, float distance)
{
    frame_from(s, 0.0f, 0.0f, distance);
}

static uint8_t *picture(scene *s, int with_hair)
{
    uint8_t *rgba = test_zeros(SIDE * SIDE * 4u);
    const unsigned lookups = fixture_uniform_lookups();
    noh_stage_hair_update(&s->drawn);
    canvas_begin(&s->c);
    assert_int_equal(noh_stage_draw(s->stage, NOH_PASS_COLOR, 0, NULL, NULL), NOH_OK);
    if (with_hair) noh_stage_hair_draw(&s->drawn, s->stage, 0, NOH_PASS_COLOR);
    canvas_resolve(&s->c);
    assert_int_equal(fixture_uniform_lookups(), lookups);
    assert_int_equal(canvas_read(&s->c, rgba), 0);
    return rgba;
}

static uint32_t differing(const uint8_t *a, const uint8_t *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) count += memcmp(a + 4u * i, b + 4u * i, 4) != 0;
    return count;
}

/* ---- whose hair moves ---- */

static uint32_t moving(const scene *s, float *least, float *most_at_rest)
{
    uint32_t count, found = 0;
    const noh_hair_head *heads = noh_actor_hair_heads(s->hair, &count);
    *least = 1e9f;
    *most_at_rest = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        if (heads[i].slot == NOH_NONE) {
            *most_at_rest = fmaxf(*most_at_rest, heads[i].pixels_per_metre);
        } else {
            *least = fminf(*least, heads[i].pixels_per_metre);
            found++;
        }
    }
    return found;
}

/* How far the hair of a head is from its rest. */
static float swing(const scene *s, uint32_t head)
{
    const size_t count = (size_t)s->cut.desc.hair_count * s->cut.desc.point_count * 3u;
    float *points = test_zeros(count * sizeof *points), most = 0.0f;
    noh_actor_hair_points(s->hair, head, points);
    for (size_t i = 0; i < count; i++) most = fmaxf(most, fabsf(points[i] - s->cut.desc.rest[i]));
    free(points);
    return most;
}

static void shake(scene *s, uint32_t frames)
{
    for (uint32_t f = 0; f < frames; f++) {
        for (uint32_t i = 0; i < s->kind.actor_count; i++) {
            noh_place place;
            assert_int_equal(noh_actor_place(s->stage, s->actors[i], &place, NULL), NOH_OK);
            place.position[0] += 0.02f * cosf(0.3f * (float)f);
            assert_int_equal(noh_actor_set_place(s->stage, s->actors[i], &place, NULL), NOH_OK);
        }
        frame(s, 3.0f);
    }
}

static void hair_of_the_largest_moves(void **state)
{
    scene s;
    float least, most;
    uint32_t count;
    (void)state;
    open_scene(&s, ACTORS_MAX, 4, 0.05f, OUTSIDE);
    shake(&s, 12);
    assert_int_equal(moving(&s, &least, &most), 4);
    assert_true(least >= most);
    const noh_hair_head *heads = noh_actor_hair_heads(s.hair, &count);
    for (uint32_t i = 0; i < count; i++) {
        if (heads[i].slot == NOH_NONE) assert_true(swing(&s, i) == 0.0f);
        if (heads[i].slot != NOH_NONE) assert_true(swing(&s, i) > 0.002f);
    }
    const noh_place near = { { 0.0f, 0.0f, 1.5f }, { 0, 0, 0, 0 }, 0.0f }, away = { { 0.0f, 0.0f, 9e3f }, { 0 }, 0.0f };
    assert_int_equal(noh_actor_set_place(s.stage, s.actors[ACTORS_MAX - 1u], &near, NULL), NOH_OK);
    frame(&s, 3.0f);
    assert_int_equal(moving(&s, &least, &most), 4);
    heads = noh_actor_hair_heads(s.hair, &count);
    assert_true(count > 4 && heads[count - 1u].slot != NOH_NONE);
    for (uint32_t i = 0; i < ACTORS_MAX - 1u; i++) {
        assert_int_equal(noh_actor_set_place(s.stage, s.actors[i], &away, NULL), NOH_OK);
    }
    frame(&s, 3.0f);
    assert_int_equal(moving(&s, &least, &most), 1); /* only one is seen */
    close_scene(&s);
}

/* Hair of a small head hangs at rest though a slot is free, and swings more and more as the head comes nearer. */
static void hair_moves_more_as_it_comes_nearer(void **state)
{
    scene s;
    float before = 0.0f, least, most;
    uint32_t count;
    (void)state;
    open_scene(&s, 1, 1, 0.0f, OUTSIDE);
    for (float distance = 16.0f; distance > 1.0f; distance *= 0.7f) {
        frame(&s, distance);
        const noh_hair_head *b = noh_actor_hair_heads(s.hair, &count);
        assert_int_equal(count, b->pixels_per_metre > 25.0f);
        if (!count) continue;
        assert_int_equal(moving(&s, &least, &most), b->pixels_per_metre > NOH_HAIR_MOVING_PIXELS);
        assert_true(b->moves >= before && b->moves <= 1.0f);
        before = b->moves;
    }
    assert_true(before == 1.0f);
    close_scene(&s);
}

/* The stage simulates it: it moves at any size. Beyond near_max heads it is shown at rest. */
static void hair_in_the_state_moves(void **state)
{
    scene s;
    float least, most;
    uint32_t count;
    (void)state;
    open_scene(&s, 3, 2, 0.05f, IN_STATE);
    assert_true(noh_actor_hair_size(&s.hair_desc) < noh_hair_size(&s.cut.desc));
    shake(&s, 12);
    assert_int_equal(moving(&s, &least, &most), 2);
    const noh_hair_head *heads = noh_actor_hair_heads(s.hair, &count);
    assert_int_equal(count, 3);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(heads[i].slot == NOH_NONE ? swing(&s, i) == 0.0f : swing(&s, i) > 0.002f);
    }
    frame(&s, 9.0f);
    heads = noh_actor_hair_heads(s.hair, &count);
    assert_true(count == 3 && heads[0].pixels_per_metre < NOH_HAIR_MOVING_PIXELS && heads[0].moves == 1.0f);
    close_scene(&s);
}

/* A head leaps in a frame whose wind is no number: hair does not follow it there, and begins at rest in the next one. */
static void a_leap_in_a_bad_frame_is_a_leap(void **state)
{
    (void)state;
    for (int where = OUTSIDE; where <= IN_STATE; where++) {
        noh_place place;
        scene s;
        open_scene(&s, 1, 1, 0.0f, where);
        shake(&s, 12);
        assert_true(swing(&s, 0) > 0.002f);
        assert_int_equal(noh_actor_place(s.stage, s.actors[0], &place, NULL), NOH_OK);
        place.position[0] += 1.0f;
        assert_int_equal(noh_actor_set_place(s.stage, s.actors[0], &place, NULL), NOH_OK);
        assert_int_equal(noh_actor_cut(s.stage, s.actors[0], NULL), NOH_OK);
        s.hair_desc.wind[0] = NAN;
        frame(&s, 3.0f);
        s.hair_desc.wind[0] = 0.0f;
        frame(&s, 3.0f);
        assert_true(swing(&s, 0) < 0.002f);
        close_scene(&s);
    }
}

/* ---- vertices ---- */

/* The shader of strips with an empty fragment shader, what it makes of vertices fed back. */
static GLuint feedback_program(gpu *g)
{
    static const char *const text[] = { "precision mediump float;\nout vec4 o;\nvoid main()\n{\n o = vec4(1.0);\n}\n" };
    static const noh_gl_source fragment = { "#version 300 es\n", text, 1 };
    static const char *const samplers[] = { "u_points" }, *const varyings[] = { "v_position", "v_tangent" };
    char log[2048] = "";
    GLuint program = 0;
    noh_gl_program_desc d;
    memset(&d, 0, sizeof d);
    d.vertex = &noh_shader_hair_vert, d.fragment = &fragment;
    d.samplers = samplers, d.sampler_count = 1;
    d.varyings = varyings, d.varying_count = 2;
    d.ledger = &g->ledger;
    if (noh_gl_program_create(&g->gl, &d, &program, log, sizeof log, NULL)) fail_msg("%s", log);
    return program;
}

static void set(gpu *g, GLuint program, const char *name, float x, float y, float z, float w)
{
    g->gl.Uniform4f(g->gl.GetUniformLocation(program, name), x, y, z, w);
}

/* Strips of one head without width, curled and strayed: [strips][segments + 1][2] of position and tangent. */
static float *vertices_of_gpu(scene *s, const noh_pack_hair_header *h, uint32_t strips)
{
    const GLuint program = feedback_program(s->g);
    const noh_gl_api *gl = &s->g->gl;
    const uint32_t vertices = 2u * (h->segment_count + 1u);
    const uint32_t patch_rows = (2u * h->patch_count + h->point_count - 1u) / h->point_count; /* a hair in each row */
    float *strip_list = test_zeros((size_t)strips * vertices * 6u * sizeof(float));
    GLuint vertex_array;
    noh_gl_buffer buffer;
    const void *mapped;
    assert_int_equal(noh_gl_buffer_create(gl, &s->g->ledger, GL_TRANSFORM_FEEDBACK_BUFFER,
                                          (uint64_t)strips * vertices * 24u, NULL, GL_STREAM_READ, &buffer, NULL),
                     NOH_OK);
    gl->GenVertexArrays(1, &vertex_array);
    gl->BindVertexArray(vertex_array);
    gl->UseProgram(program);
    set(s->g, program, "u_counts", (float)h->point_count, (float)h->hair_count, (float)h->patch_count,
        (float)h->segment_count);
    set(s->g, program, "u_widths", 0.0f, 0.0f, h->scatter, 0.0f);
    set(s->g, program, "u_curl", h->curl_radius, h->curl_turns, 0.0f, 1.0f);
    set(s->g, program, "u_crowd", (float)strips, 0.0f, (float)(h->hair_count + patch_rows), (float)strips);
    set(s->g, program, "u_eye", 0.0f, 0.0f, 5.0f, 1.0f);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, s->drawn.drawable.texture.name);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer.name);
    gl->Enable(GL_RASTERIZER_DISCARD);
    gl->BeginTransformFeedback(GL_POINTS);
    gl->DrawArraysInstanced(GL_POINTS, 0, (GLsizei)vertices, (GLsizei)strips);
    gl->EndTransformFeedback();
    gl->Disable(GL_RASTERIZER_DISCARD);
    mapped = gl->MapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, (GLsizeiptr)((size_t)strips * vertices * 24u),
                                GL_MAP_READ_BIT);
    assert_non_null(mapped);
    memcpy(strip_list, mapped, (size_t)strips * vertices * 24u);
    (void)gl->UnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
    gl->BindVertexArray(0);
    gl->UseProgram(0);
    gl->BindTexture(GL_TEXTURE_2D, 0);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    gl->DeleteVertexArrays(1, &vertex_array);
    noh_gl_buffer_delete(gl, &s->g->ledger, &buffer);
    {
        GLuint p = program;
        noh_gl_program_delete(gl, &s->g->ledger, &p);
    }
    return strip_list;
}

static void strips_are_those_of_the_cpu(void **state)
{
    scene s;
    double worst = 0.0, turned = 1.0;
    uint32_t count;
    (void)state;
    open_scene(&s, 1, 1, 0.0f, IN_STATE);
    shake(&s, 12);
    noh_stage_hair_update(&s.drawn);
    const noh_pack_hair_header *h = s.cut.header;
    const uint32_t strips = h->strip_count, vertices = 2u * (h->segment_count + 1u);
    const float *world = noh_actor_hair_heads(s.hair, &count)->world;
    float *gpu_made = vertices_of_gpu(&s, h, strips);
    assert_int_equal(count, 1);
    noh_actor_hair_points(s.hair, 0, s.drawn.points);
    for (uint32_t i = 0; i < strips * vertices; i++) {
        const float along = (float)(i % vertices / 2u) / (float)h->segment_count, *v = gpu_made + 6u * (size_t)i;
        float p[3], t[3];
        double dot = 0.0, length = 0.0;
        noh_haircut_vertex(&s.cut, s.drawn.points, i / vertices, along, p, t);
        for (int c = 0; c < 3; c++) {
            const float *row = world + 4 * c;
            const float at = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
            const float to = row[0] * t[0] + row[1] * t[1] + row[2] * t[2];
            worst = fmax(worst, fabs((double)(at - v[c])));
            dot += (double)to * (double)v[3 + c];
            length += (double)to * (double)to;
        }
        turned = fmin(turned, dot / sqrt(length));
    }
    printf("# %u strips: off by at most %.1f um, %.5f degrees\n", strips, 1e6 * worst, acos(fmin(turned, 1.0)) * 57.3);
    assert_true(worst < 20e-6);
    assert_true(turned > 0.99999);
    free(gpu_made);
    close_scene(&s);
}

/* Millimetres from a point to the strips' roots. */
static double to_roots(const noh_haircut *cut, const float *rest, const float at[3])
{
    double least = 1e9;
    for (uint32_t i = 0; i < cut->header->strip_count; i++) {
        float p[3], t[3];
        noh_haircut_vertex(cut, rest, i, 0.0f, p, t);
        const double x = p[0] - at[0], y = p[1] - at[1], z = p[2] - at[2];
        least = fmin(least, 1e3 * sqrt(x * x + y * y + z * z));
    }
    return least;
}

/* The mask's wig: its roots are on the edge of the painted hair, and its strips pass behind the ears, whose rims they
 * do not cross. */
static void the_wig_fits_the_mask(void **state)
{
    static const float line[][3] = {
        { 0.006f, 0.089f, 0.011f }, { 0.023f, 0.081f, 0.011f }, { 0.042f, 0.062f, 0.008f }, { 0.053f, 0.041f, 0.003f }
    };
    static const double ear[3] = { 0.0696, 0.0, -0.0084 }, half[3] = { 0.007, 0.022, 0.007 };
    scene s;
    double worst = 0.0;
    int across = 0;
    (void)state;
    open_scene(&s, 1, 1, 0.0f, IN_STATE);
    const float *rest = s.cut.desc.rest;
    for (size_t i = 0; i < TEST_COUNT(line); i++) worst = fmax(worst, to_roots(&s.cut, rest, line[i]));
    for (uint32_t i = 0; i < s.cut.header->strip_count; i++) {
        int inside = 0;
        for (int k = 0; k <= 48; k++) {
            float p[3], t[3];
            noh_haircut_vertex(&s.cut, rest, i, (float)k / 48.0f, p, t);
            inside |= fabs(fabs((double)p[0]) - ear[0]) < half[0] && fabs((double)p[1] - ear[1]) < half[1] &&
                      fabs((double)p[2] - ear[2]) < half[2];
        }
        across += inside;
    }
    printf("# roots at most %.1f mm from the painted line; %d strips in the ears\n", worst, across);
    assert_true(worst < 5.0);
    assert_int_equal(across, 0);
    close_scene(&s);
}

/* ---- bytes and draws ---- */

static void bytes_are_exact(void **state)
{
    (void)state;
    for (int in_state = OUTSIDE; in_state <= IN_STATE; in_state++) {
        scene s;
        noh_actor_hair *hair = NULL;
        noh_stage_hair drawn;
        open_scene(&s, ACTORS_MAX, 4, 0.05f, in_state);
        const noh_gl_device device = { &s.g->gl, &s.g->caps, &s.g->ledger, NULL, 0 };
        const size_t bytes = noh_actor_hair_size(&s.hair_desc), drawn_bytes = noh_stage_hair_size(&s.hair_desc);
        uint8_t *memory = test_aligned(NULL, bytes + drawn_bytes);
        memset(memory, 0x5a, bytes + drawn_bytes);
        assert_int_equal(noh_actor_hair_init(memory, bytes - 1u, &s.hair_desc, &hair, NULL), NOH_ERR_MEMORY);
        assert_int_equal(noh_stage_hair_create(&device, s.hair, memory, drawn_bytes - 1u, 0, 0, &drawn, NULL),
                         NOH_ERR_MEMORY);
        for (size_t i = 0; i < bytes + drawn_bytes; i++) assert_int_equal(memory[i], 0x5a);
        noh_actor_hair_desc bad = s.hair_desc;
        bad.near_max = NOH_HAIR_NEAR_MAX + 1u;
        assert_int_equal(noh_actor_hair_size(&bad), 0);
        assert_int_equal(noh_actor_hair_init(memory, bytes, &bad, &hair, NULL), NOH_ERR_ARG);
        free(memory);
        const uint64_t used = noh_gl_ledger_bytes(&s.g->ledger);
        noh_stage_hair_delete(&s.drawn);
        assert_int_equal(used - noh_gl_ledger_bytes(&s.g->ledger), noh_stage_hair_bytes(&s.hair_desc));
        assert_int_equal(noh_stage_hair_restore(&s.drawn, NULL, 0, NULL), NOH_OK);
        assert_int_equal(noh_gl_ledger_bytes(&s.g->ledger), used);
        shake(&s, 4);
        uint8_t *before = picture(&s, 1);
        noh_stage_hair_delete(&s.drawn);
        assert_int_equal(noh_stage_hair_restore(&s.drawn, NULL, 0, NULL), NOH_OK);
        uint8_t *after = picture(&s, 1);
        assert_int_equal(differing(before, after), 0);
        free(before);
        free(after);
        close_scene(&s);
    }
}

static void all_strips_are_one_draw(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, 1, 0.0f, IN_STATE);
    frame(&s, 0.8f);
    free(picture(&s, 1));
    assert_int_equal(s.drawn.draws, 2); /* the core, and the fringe */
    noh_stage_hair_draw(&s.drawn, s.stage, 0, NOH_PASS_OPAQUE);
    assert_int_equal(s.drawn.draws, 3);
    frame(&s, 30.0f);
    free(picture(&s, 1));
    assert_int_equal(s.drawn.draws, 3);
    close_scene(&s);
}

/* From heads that fill the picture to some that are a few pixels. */
static void all_heads_are_some_draws(void **state)
{
    scene s;
    uint32_t count, strips = 0;
    (void)state;
    open_scene(&s, ACTORS_MAX, 4, 0.8f, OUTSIDE);
    frame(&s, 1.5f);
    const uint32_t draws = s.drawn.draws;
    free(picture(&s, 1));
    const noh_hair_head *heads = noh_actor_hair_heads(s.hair, &count);
    for (uint32_t i = 0; i < count; i++) strips += noh_haircut_strips(&s.cut, heads[i].pixels_per_metre);
    printf("# %u heads, %u strips, %u draws\n", count, strips, s.drawn.draws - draws);
    assert_true(count > 6);
    assert_int_equal(s.drawn.strips, strips);
    assert_true(s.drawn.draws - draws <= 2u * NOH_HAIR_GROUPS);
    close_scene(&s);
}

/* ---- what is seen ---- */

/* The share of the picture that hair with this many strips changes. */
static double coverage(scene *s, const uint8_t *bald, uint32_t strips)
{
    const noh_pack_hair_header *all = s->cut.header;
    const float widen = (float)all->strip_count / (float)strips;
    noh_pack_hair_header fewer = *all;
    fewer.strip_count = strips;
    fewer.width_root *= widen, fewer.width_tip *= widen;
    s->cut.header = &fewer;
    uint8_t *rgba = picture(s, 1);
    s->cut.header = all;
    const double share = differing(rgba, bald) / (double)(SIDE * SIDE);
    free(rgba);
    return share;
}

static void fewer_strips_cover_as_much(void **state)
{
    scene s;
    (void)state;
    open_scene(&s, 1, 1, 0.0f, IN_STATE);
    frame_from(&s, RADIANS(120.0f), RADIANS(10.0f), 0.6f);
    uint8_t *bald = picture(&s, 0);
    const double all = coverage(&s, bald, s.cut.header->strip_count);
    const double quarter = coverage(&s, bald, s.cut.header->strip_count / 4u);
    printf("# coverage %.4f, of a quarter of the strips %.4f\n", all, quarter);
    assert_true(all > 0.1);
    assert_true(fabs(quarter / all - 1.0) <= 0.06);
    free(bald);
    close_scene(&s);
}

/* Where hair begins on bright paint, it fades in, within more than a pixel. */
static void the_hairline_is_soft(void **state)
{
    uint32_t hard = 0, all = 0;
    scene s;
    (void)state;
    fixture_gpu()->caps.samples_max = 4;
    open_scene(&s, 1, 1, 0.0f, IN_STATE);
    s.g->caps.samples_max = 1;
    for (int view = -2; view <= 2; view++) {
        frame_from(&s, RADIANS(20.0f * (float)view), RADIANS(35.0f), 0.3f);
        uint8_t *bald = picture(&s, 0), *hair = picture(&s, 1);
        for (uint32_t i = 0; i + 1u < SIDE * SIDE; i++) {
            if (bald[4u * i] < 100 || bald[4u * i + 4u] < 100) continue;
            const double step = (double)hair[4u * i] / bald[4u * i] - (double)hair[4u * i + 4u] / bald[4u * i + 4u];
            all += fabs(step) > 0.1;
            hard += fabs(step) > 0.5;
        }
        free(bald);
        free(hair);
    }
    printf("# %u of %u edges of hair on paint are hard\n", hard, all);
    close_scene(&s);
    assert_true(all > 30u && 10u * hard < all); /* the paint begins where the strips do: few edges are left */
}

static double difference(const uint8_t *a, const uint8_t *b)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < 4u * SIDE * SIDE; i++) sum += abs((int)a[i] - (int)b[i]);
    return sum / 255.0;
}

/* How much of it still shows, of the area that it would take, by how far it has faded. */
static void hair_fades_into_paint(void **state)
{
    scene s;
    double share[3];
    uint32_t count;
    float distance = 8.0f;
    (void)state;
    open_scene(&s, ACTORS_MAX, 0, 0.0f, OUTSIDE);
    for (int i = 0; i < 3; i++) { /* at 51, 37.5 and 24 pixels a metre */
        const float wanted = i == 0 ? 51.0f : i == 1 ? 37.5f : 24.0f;
        frame(&s, distance);
        const noh_hair_head *b = noh_actor_hair_heads(s.hair, &count);
        if (count) distance *= b->pixels_per_metre / wanted;
        frame(&s, distance);
        b = noh_actor_hair_heads(s.hair, &count);
        uint8_t *bald = picture(&s, 0), *hair = picture(&s, 1);
        const double area = (double)(wanted * wanted) * 0.04 * ACTORS_MAX;
        share[i] = difference(hair, bald) / area;
        printf("# %.1f pixels a metre, fade %.2f: %.3f\n", (double)(count ? b->pixels_per_metre : 0.0f),
               (double)noh_haircut_fade(count ? b->pixels_per_metre : 0.0f), share[i]);
        free(bald);
        free(hair);
    }
    assert_true(share[0] > 0.05);
    assert_true(share[1] > 0.4 * share[0] && share[1] < 0.6 * share[0]);
    assert_true(share[2] == 0.0);
    close_scene(&s);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(strips_are_those_of_the_cpu),
    cmocka_unit_test(the_wig_fits_the_mask),
    cmocka_unit_test(hair_of_the_largest_moves),
    cmocka_unit_test(hair_moves_more_as_it_comes_nearer),
    cmocka_unit_test(hair_in_the_state_moves),
    cmocka_unit_test(a_leap_in_a_bad_frame_is_a_leap),
    cmocka_unit_test(bytes_are_exact),
    cmocka_unit_test(all_strips_are_one_draw),
    cmocka_unit_test(all_heads_are_some_draws),
    cmocka_unit_test(fewer_strips_cover_as_much),
    cmocka_unit_test(the_hairline_is_soft),
    cmocka_unit_test(hair_fades_into_paint),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
