#include "gl_fixture.h"
#include "deform/morph/morph_internal.h"
#include "gl/device/gl_api_internal.h"
#include "gl/device/gl_memory_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const fixture_way fixture_ways[FIXTURE_WAYS] = {
    { NOH_MORPH_LAYERED, NOH_ACCUMULATE_F32 },   { NOH_MORPH_LAYERED, NOH_ACCUMULATE_F16 },
    { NOH_MORPH_MRT, NOH_ACCUMULATE_F32 },       { NOH_MORPH_MRT, NOH_ACCUMULATE_F16 },
    { NOH_MORPH_PER_LAYER, NOH_ACCUMULATE_F32 }, { NOH_MORPH_PER_LAYER, NOH_ACCUMULATE_F16 },
    { NOH_MORPH_GATHER, NOH_ACCUMULATE_F32 },    { NOH_MORPH_GATHER, NOH_ACCUMULATE_F16 },
    { NOH_MORPH_CPU, NOH_ACCUMULATE_F32 },       { NOH_MORPH_CPU, NOH_ACCUMULATE_F16 },
    { NOH_MORPH_DIRECT, NOH_ACCUMULATE_F32 }
};

const char *fixture_way_name(fixture_way way)
{
    static char name[32];
    snprintf(name, sizeof name, "%s %s", noh_morph_path_name(way.path), noh_accumulate_name(way.accumulate));
    return name;
}

/* ---- the context ---- */

static gpu shared;
static enum { UNTRIED, WORKS, FAILED } shared_state;
static unsigned debug_errors;

/* ---- lookups of uniforms ---- */

static GLint(GL_APIENTRY *find_uniform)(GLuint program, const GLchar *name);
static unsigned uniform_lookups;

static GLint GL_APIENTRY count_lookup(GLuint program, const GLchar *name)
{
    uniform_lookups++;
    return find_uniform(program, name);
}

unsigned fixture_uniform_lookups(void)
{
    return uniform_lookups;
}

static void GL_APIENTRY count_debug(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                    const GLchar *message, const void *user)
{
    (void)id;
    (void)severity;
    (void)length;
    (void)user;
    if (type == GL_DEBUG_TYPE_ERROR && source == GL_DEBUG_SOURCE_API) {
        print_message("# GL: %s\n", message);
        debug_errors++;
    }
}

gpu *fixture_gpu(void)
{
    const char *driver = getenv("NOH_TEST_DRIVER");
    if (shared_state == UNTRIED) {
        shared_state = gpu_open(&shared, driver ? driver : "egl") == 0 ? WORKS : FAILED;
        if (shared_state == WORKS) {
            find_uniform = shared.gl.GetUniformLocation;
            shared.gl.GetUniformLocation = count_lookup;
            shared.caps.samples_max = 1;
        }
        if (shared_state == WORKS && shared.gl.DebugMessageCallback) {
            shared.gl.Enable(GL_DEBUG_OUTPUT);
            shared.gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
            shared.gl.DebugMessageCallback(count_debug, NULL);
        }
    }
    if (shared_state != WORKS) {
        test_skip("no %s context here", driver ? driver : "EGL");
    }
    noh_gl_error_take(&shared.gl);
    debug_errors = 0;
    return &shared;
}

int fixture_tear_down(void **state)
{
    (void)state;
    if (shared_state == WORKS) {
        gpu_close(&shared);
        shared_state = UNTRIED;
    }
    return 0;
}

void fixture_expect_no_errors(void)
{
    assert_int_equal(shared.gl.GetError(), GL_NO_ERROR);
    assert_int_equal(debug_errors, 0);
}

/* ---- meshes ---- */

void fixture_meshes_open(fixture_meshes *f)
{
    const test_model_desc desc = { FIXTURE_MESHES, 6, 7, TEST_TANGENTS, 51 };
    model *m = test_model(&desc);
    size_t count;
    m->meshes[FIXTURE_BARE].target_count = 0;
    f->bytes = test_pack_of(m, &count, NULL);
    m->meshes[FIXTURE_BARE].target_count = desc.targets;
    model_free(m);
    f->pack = test_open(f->bytes, count);
    for (uint32_t i = 0; i < FIXTURE_MESHES; i++) {
        f->meshes[i] = test_mesh(&f->pack, i);
    }
    /* what these meshes are for */
    assert_int_not_equal(f->meshes[0].header->morph_width_log2, f->meshes[2].header->morph_width_log2);
    assert_int_equal(f->meshes[FIXTURE_BARE].header->touched_count, 0);
}

void fixture_meshes_close(fixture_meshes *f)
{
    free(f->bytes);
}

/* ---- one noh_gl_morph ---- */

void fixture_morph_open(fixture_morph *m, const noh_gl_morph_desc *desc, const noh_gl_caps *caps)
{
    gpu *g = fixture_gpu();
    noh_error error = { NOH_OK, "", 0, 0 };
    char log[4096] = "";
    memset(m, 0, sizeof *m);
    m->caps = caps ? *caps : g->caps;
    m->desc = desc;
    if (noh_gl_morph_plan_make(desc, &m->caps, &m->plan, &error)) {
        fail_msg("plan: %s", error.what);
    }
    m->memory = test_aligned(NULL, (size_t)m->plan.cpu_bytes);
    if (noh_gl_morph_init(m->memory, (size_t)m->plan.cpu_bytes,
                          &(noh_gl_device){ &g->gl, &m->caps, &m->ledger, log, sizeof log }, desc, &m->morph, &error)) {
        fail_msg("init: %s\n%s", error.what, log);
    }
    m->weights = test_zeros(sizeof *m->weights * m->plan.instance_count);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        m->weights[i] = test_zeros(4u * (size_t)fixture_mesh_of(m, i)->header->target_count);
    }
    m->levels = test_zeros(sizeof *m->levels * m->plan.instance_count);
}

void fixture_morph_close(fixture_morph *m)
{
    noh_gl_morph_delete(m->morph);
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        free(m->weights[i]);
    }
    free(m->weights);
    free(m->levels);
    free(m->memory);
    /* everything was deleted, and nothing twice */
    assert_true(noh_gl_ledger_bytes(&m->ledger) == 0);
    assert_int_equal(m->ledger.buffers + m->ledger.textures + m->ledger.framebuffers + m->ledger.programs, 0);
}

const noh_mesh *fixture_mesh_of(const fixture_morph *m, uint32_t instance)
{
    for (uint32_t i = 0; i + 1 < m->desc->mesh_count; i++) {
        if (instance < noh_gl_morph_instance(m->morph, i + 1, 0)) {
            return &m->desc->meshes[i];
        }
    }
    return &m->desc->meshes[m->desc->mesh_count - 1];
}

noh_mesh fixture_view_of(const fixture_morph *m, uint32_t instance)
{
    const noh_mesh *mesh = fixture_mesh_of(m, instance);
    return m->levels[instance] > mesh->header->level ? noh_mesh_at_lod(mesh, m->levels[instance]) : *mesh;
}

void fixture_set_level(fixture_morph *m, uint32_t instance, uint32_t level)
{
    m->levels[instance] = level;
    noh_gl_morph_set_lod(m->morph, instance, level);
}

void fixture_set(fixture_morph *m, uint32_t instance, const float *weights)
{
    memcpy(m->weights[instance], weights, 4u * (size_t)fixture_mesh_of(m, instance)->header->target_count);
    assert_int_equal(noh_gl_morph_set_weights(m->morph, instance, weights, NULL), NOH_OK);
}

void fixture_set_random(fixture_morph *m, uint32_t instance, test_random *r)
{
    float weights[NOH_TARGETS_MAX];
    test_random_weights(r, weights, fixture_mesh_of(m, instance)->header->target_count);
    fixture_set(m, instance, weights);
}

float *fixture_reference(const fixture_morph *m, uint32_t instance, int *exact)
{
    const noh_mesh view = fixture_view_of(m, instance), *mesh = &view;
    noh_morph_layers layers = test_layers(mesh);
    int blended = m->plan.path != NOH_MORPH_CPU && m->plan.path != NOH_MORPH_GATHER && m->plan.path != NOH_MORPH_DIRECT;
    noh_half_mode mode = blended                         ? m->caps.f16_blend_mode
                         : m->plan.path == NOH_MORPH_CPU ? NOH_HALF_RNE
                                                         : m->caps.f16_store_mode;
    float *block = layers.position;                                    /* test_layers: never NULL, even for no texels */
    layers.tangent = m->plan.layer_count == 3 ? layers.tangent : NULL; /* else zeros, as readback_layers gives */
    if (m->plan.accumulate == NOH_ACCUMULATE_F32) {
        noh_morph_accumulate_scalar(mesh, m->weights[instance], &layers);
        *exact = !blended || m->caps.blend_f32_exact;
    } else if (blended) {
        noh_morph_accumulate_f16(mesh, m->weights[instance], mode, &layers);
        *exact = mode != NOH_HALF_UNKNOWN;
    } else {
        noh_morph_accumulate_scalar(mesh, m->weights[instance], &layers);
        noh_morph_round_f16(mesh, mode, &layers);
        *exact = mode != NOH_HALF_UNKNOWN;
    }
    return block;
}

static void compare_layers(const fixture_morph *m, uint32_t instance, const float *got, const float *expected,
                           int exact)
{
    const noh_mesh view = fixture_view_of(m, instance), *mesh = &view;
    size_t texels = (size_t)mesh->header->morph_height << mesh->header->morph_width_log2;
    for (size_t layer = 0; layer < 3; layer++) {
        double bound = layer ? (double)mesh->header->f16_direction_bound : (double)mesh->header->f16_position_bound;
        for (size_t i = 0; i < 3 * (size_t)mesh->header->touched_count; i++) {
            size_t at = layer * texels * 3 + i;
            int same = got[at] == expected[at]; /* -0 equals 0; a NaN differs from all */
            if (!same && (exact || !(fabs((double)got[at] - (double)expected[at]) <= 2.0 * bound))) {
                fail_msg("%s %s: instance %u, layer %zu, value %zu is %a, not %a", noh_morph_path_name(m->plan.path),
                         noh_accumulate_name(m->plan.accumulate), (unsigned)instance, layer, i, (double)got[at],
                         (double)expected[at]);
            }
        }
    }
}

float *fixture_layers(const fixture_morph *m, uint32_t instance)
{
    const noh_mesh mesh = fixture_view_of(m, instance);
    noh_gl_morph_binding binding = noh_gl_morph_binding_of(m->morph, instance);
    float *got = test_zeros(noh_morph_layers_size(&mesh));
    readback r;
    assert_int_equal(readback_open(&r, &shared, binding.is_uint), 0);
    assert_int_equal(readback_layers(&r, &mesh, &binding, got), 0);
    readback_close(&r);
    return got;
}

void fixture_expect_instance(const fixture_morph *m, uint32_t instance)
{
    float *got = fixture_layers(m, instance);
    int exact;
    float *expected = fixture_reference(m, instance, &exact);
    compare_layers(m, instance, got, expected, exact);
    free(got);
    free(expected);
}

void fixture_expect_all(const fixture_morph *m)
{
    for (uint32_t i = 0; i < m->plan.instance_count; i++) {
        fixture_expect_instance(m, i);
    }
}

/* ---- pictures ---- */

void fixture_frame_open(fixture_frame *f, uint32_t side)
{
    const noh_gl_api *gl = &fixture_gpu()->gl;
    memset(f, 0, sizeof *f);
    f->side = side;
    assert_int_equal(noh_gl_renderbuffer_create(gl, &f->ledger, GL_RGBA8, side, side, 0, &f->color, NULL), NOH_OK);
    assert_int_equal(noh_gl_renderbuffer_create(gl, &f->ledger, GL_DEPTH_COMPONENT24, side, side, 0, &f->depth, NULL),
                     NOH_OK);
    assert_int_equal(noh_gl_framebuffer_create(gl, &f->ledger, &f->framebuffer, NULL), NOH_OK);
    gl->BindFramebuffer(GL_FRAMEBUFFER, f->framebuffer);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, f->color.name);
    gl->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, f->depth.name);
    gl->Viewport(0, 0, (GLsizei)side, (GLsizei)side);
    gl->ClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    gl->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

uint8_t *fixture_frame_read(const fixture_frame *f)
{
    uint8_t *rgba = test_zeros((size_t)f->side * f->side * 4u);
    fixture_gpu()->gl.ReadPixels(0, 0, (GLsizei)f->side, (GLsizei)f->side, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    return rgba;
}

void fixture_frame_close(fixture_frame *f)
{
    const noh_gl_api *gl = &fixture_gpu()->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
    noh_gl_framebuffer_delete(gl, &f->ledger, &f->framebuffer);
    noh_gl_renderbuffer_delete(gl, &f->ledger, &f->depth);
    noh_gl_renderbuffer_delete(gl, &f->ledger, &f->color);
    assert_true(noh_gl_ledger_bytes(&f->ledger) == 0 && f->ledger.programs == 0);
}

/* ---- texts ---- */

char *test_shader_body(const char *path)
{
    FILE *file = fopen(path, "rb");
    char *text = test_zeros(1u << 16), *start;
    if (!file) test_skip("%s is not here: run in the repository's root", path);
    assert_in_range(fread(text, 1, (1u << 16) - 1u, file), 100, (1u << 16) - 2u);
    fclose(file);
    assert_true(strncmp(text, "#version", 8) == 0);
    start = strchr(text, '\n');
    memmove(text, start, strlen(start) + 1);
    return text;
}

char *test_example(const char *path, int n)
{
    FILE *file = fopen(path, "rb");
    char *text = test_zeros(1u << 16), *start, *end;
    if (!file) test_skip("%s is not here: run in the repository's root", path);
    assert_in_range(fread(text, 1, (1u << 16) - 1u, file), 1000, (1u << 16) - 2u);
    fclose(file);
    for (start = text; n >= 0; n--) {
        start = strstr(start, "```glsl\n");
        assert_non_null(start);
        start += 8;
    }
    end = strstr(start, "```");
    assert_non_null(end);
    *end = 0;
    memmove(text, start, strlen(start) + 1);
    return text;
}
