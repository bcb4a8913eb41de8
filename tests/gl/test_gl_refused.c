/* A driver that refuses one call of a create: for every create of the library and every GL function, the first call of
 * that function fails, then the second, until a create passes without a refusal. Until then none may return NOH_OK,
 * nothing is left behind in GL or in the ledger, and a second attempt in the same memory succeeds. Runs on the null
 * platform, which counts the objects that exist. For a stage and what is made with it, calls 0, 1, 2, 4, 8 and so on of
 * each function, all with NOH_LONG set and fewer under sanitizers. */
#include "support/renderer.h"
#include "support/stage_fixture.h"
#include "support/support.h"

#include "gpu/gpu.h"
#include "gl/draw/gl_light_internal.h"
#include "gl/device/gl_timer_internal.h"
#include "gl/device/gl_memory_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "null.h"

#include <stdlib.h>
#include <string.h>

/* ---- what is made ---- */

typedef struct maker {
    uint64_t room[1u << 16]; /* an object's memory; first, because a block of calloc's is aligned to 16 */
    gpu g;
    noh_pack pack;
    noh_mesh meshes[2];
    /* skins of headers only: nothing but palettes is read */
    noh_mesh_header headers[2];
    noh_palette palette;
    uint16_t joints[2];
    noh_mesh skinned[2];
    /* what the case makes */
    noh_morph_path path;
    noh_accumulate accumulate;
    noh_palette_mode mode;
    union {
        noh_gl_buffer buffer;
        noh_gl_texture texture;
        noh_gl_renderbuffer renderbuffer;
        GLuint name;
        noh_gl_mesh mesh;
        noh_gl_renderer renderer;
        noh_gl_variant variant;
        noh_gl_morph *morph;
        noh_gl_skin *skin;
        noh_gl_light light;
        noh_backdrop backdrop;
        noh_stage_floor floor;
        noh_stage_blob blob;
        noh_stage_terrain terrain;
        noh_stage_shader *shader;
        noh_stage_decals decals;
        noh_stage_patches patches;
    } made;
    const noh_reflection *reflection;
    /* a stage with what is made on it; NULL: nothing */
    cast *cast;
    noh_stage_decals decals; /* of patches */
    void *decal_memory;
    noh_null_report rest; /* what the stage itself has */
    noh_gl_ledger rest_ledger;
} maker;

static noh_gl_device device_of(maker *m)
{
    return (noh_gl_device){ &m->g.gl, &m->g.caps, &m->g.ledger, NULL, 0 };
}

typedef struct create_case {
    const char *name;
    noh_result (*make)(maker *m, noh_error *error);
    void (*unmake)(maker *m);
    noh_result (*restore)(maker *m, noh_error *error); /* after a lost context; NULL: the case has none */
    noh_morph_path path;
    noh_accumulate accumulate;
    noh_palette_mode mode;
    enum { ALONE, A_STAGE, ON_A_STAGE, ON_DECALS } where;
} create_case;

static noh_result make_buffer(maker *m, noh_error *error)
{
    static const uint8_t bytes[64];
    return noh_gl_buffer_create(&m->g.gl, &m->g.ledger, GL_ARRAY_BUFFER, sizeof bytes, bytes, GL_STATIC_DRAW,
                                &m->made.buffer, error);
}

static void unmake_buffer(maker *m)
{
    noh_gl_buffer_delete(&m->g.gl, &m->g.ledger, &m->made.buffer);
}

static noh_result make_texture(maker *m, noh_error *error)
{
    const noh_gl_texture_desc desc = { GL_RGBA8, 8, 8, 3, 2, GL_LINEAR, 0 };
    return noh_gl_texture_create(&m->g.gl, &m->g.ledger, &desc, &m->made.texture, error);
}

static noh_result make_picture(maker *m, noh_error *error)
{
    noh_texture texture;
    assert_int_equal(noh_pack_texture_at(&m->pack, 0, &texture, NULL), NOH_OK);
    return noh_gl_picture_create(&m->g.gl, &m->g.ledger, &texture, &m->made.texture, error);
}

static void unmake_texture(maker *m)
{
    noh_gl_texture_delete(&m->g.gl, &m->g.ledger, &m->made.texture);
}

static noh_result make_renderbuffer(maker *m, noh_error *error)
{
    return noh_gl_renderbuffer_create(&m->g.gl, &m->g.ledger, GL_RGBA8, 8, 8, 4, &m->made.renderbuffer, error);
}

static void unmake_renderbuffer(maker *m)
{
    noh_gl_renderbuffer_delete(&m->g.gl, &m->g.ledger, &m->made.renderbuffer);
}

static noh_result make_framebuffer(maker *m, noh_error *error)
{
    return noh_gl_framebuffer_create(&m->g.gl, &m->g.ledger, &m->made.name, error);
}

static void unmake_framebuffer(maker *m)
{
    noh_gl_framebuffer_delete(&m->g.gl, &m->g.ledger, &m->made.name);
}

static noh_result make_mesh(maker *m, noh_error *error)
{
    return noh_gl_mesh_create(&m->g.gl, &m->g.ledger, &m->meshes[1], &m->made.mesh, error);
}

static void unmake_mesh(maker *m)
{
    noh_gl_mesh_delete(&m->g.gl, &m->g.ledger, &m->made.mesh);
}

static noh_result make_renderer(maker *m, noh_error *error)
{
    noh_gl_renderer_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = m->meshes;
    desc.mesh_count = 2;
    desc.fades = 1;
    return renderer_create(&(noh_gl_device){ &m->g.gl, NULL, &m->g.ledger, NULL, 0 }, &desc, &m->made.renderer, error);
}

static void unmake_renderer(maker *m)
{
    noh_gl_renderer_delete(&m->made.renderer);
}

static noh_result make_variant(maker *m, noh_error *error)
{
    static const char *const varyings[] = { "v_world" };
    noh_gl_variant_key key = noh_gl_variant_key_of(&m->meshes[0], NULL, 0, 0, NOH_VIEW_LIT);
    return noh_gl_variant_create(&(noh_gl_device){ &m->g.gl, NULL, &m->g.ledger, NULL, 0 }, key, NULL, varyings, 1,
                                 &m->made.variant, error);
}

static void unmake_variant(maker *m)
{
    noh_gl_variant_delete(&m->g.gl, &m->g.ledger, &m->made.variant);
}

static noh_result make_morph(maker *m, noh_error *error)
{
    static const uint32_t counts[2] = { 2, 1 };
    noh_gl_morph_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = m->meshes;
    desc.mesh_count = 2;
    desc.instance_counts = counts;
    desc.path = m->path;
    desc.accumulate = m->accumulate;
    return noh_gl_morph_init(m->room, sizeof m->room, &(noh_gl_device){ &m->g.gl, &m->g.caps, &m->g.ledger, NULL, 0 },
                             &desc, &m->made.morph, error);
}

static void unmake_morph(maker *m)
{
    noh_gl_morph_delete(m->made.morph);
}

static noh_result make_skin(maker *m, noh_error *error)
{
    noh_gl_skin_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.meshes = m->skinned;
    desc.mesh_count = 2;
    desc.mode = m->mode;
    return noh_gl_skin_init(m->room, sizeof m->room, &(noh_gl_device){ &m->g.gl, &m->g.caps, &m->g.ledger, NULL, 0 },
                            &desc, &m->made.skin, error);
}

static void unmake_skin(maker *m)
{
    noh_gl_skin_delete(m->made.skin);
}

static noh_result make_light(maker *m, noh_error *error)
{
    const noh_gl_device d = device_of(m);
    const noh_gl_light_desc desc = { m->reflection, 64 };
    return noh_gl_light_create(&d, &desc, &m->made.light, error);
}

static void unmake_light(maker *m)
{
    noh_gl_light_delete(&m->made.light);
}

static noh_result make_backdrop(maker *m, noh_error *error)
{
    const noh_gl_device d = device_of(m);
    return noh_backdrop_create(&d, 0, &m->made.backdrop, error);
}

static void unmake_backdrop(maker *m)
{
    noh_backdrop_delete(&m->made.backdrop);
}

static noh_result make_floor(maker *m, noh_error *error)
{
    const noh_gl_device d = device_of(m);
    return noh_stage_floor_create(&d, 1, &m->made.floor, error);
}

static void unmake_floor(maker *m)
{
    noh_stage_floor_delete(&m->made.floor);
}

static noh_result make_blob(maker *m, noh_error *error)
{
    const noh_gl_device d = device_of(m);
    return noh_stage_blob_create(&d, &m->made.blob, error);
}

static void unmake_blob(maker *m)
{
    noh_stage_blob_delete(&m->made.blob);
}

static noh_result make_terrain(maker *m, noh_error *error)
{
    static const uint16_t heights[9];
    const noh_field field = { heights, 3, 3, { 0.0f, 0.0f, 0.0f }, 1.0f, 1.0f };
    const noh_gl_device d = device_of(m);
    return noh_stage_terrain_create(&d, &field, NULL, m->room, sizeof m->room, &m->made.terrain, error);
}

static void unmake_terrain(maker *m)
{
    noh_stage_terrain_delete(&m->made.terrain);
}

static noh_result make_stage(maker *m, noh_error *error)
{
    const noh_gl_device d = device_of(m);
    cast *c = m->cast;
    return noh_stage_init(c->memory, (size_t)c->plan.cpu_bytes, &d, &c->desc, &c->plan, &c->stage, error);
}

static void unmake_stage(maker *m)
{
    noh_stage_delete(m->cast->stage);
}

static noh_result make_shader(maker *m, noh_error *error)
{
    const noh_gl_shader_desc desc = { .name = "plain",
                                      .vertex = "void main() { gl_Position = vec4(noh_fetch().position, 1.0); }\n",
                                      .fragment = "out vec4 color;\nvoid main() { noh_fade(); color = vec4(1.0); }\n" };
    return noh_stage_shader_create(m->cast->stage, m->room, sizeof m->room, &desc, NULL, 0, &m->made.shader, error);
}

static void unmake_shader(maker *m)
{
    noh_stage_shader_delete(m->made.shader);
}

static noh_result make_decals(maker *m, noh_error *error)
{
    const noh_gl_device d = device_of(m);
    return noh_stage_decals_create(m->cast->stage, &d, m->room, sizeof m->room, NULL, &m->made.decals, error);
}

static void unmake_decals(maker *m)
{
    noh_stage_decals_delete(&m->made.decals);
}

static noh_result make_patches(maker *m, noh_error *error)
{
    return noh_stage_patches_create(&m->decals, 4, 256, m->room, sizeof m->room, &m->made.patches, error);
}

static void unmake_patches(maker *m)
{
    noh_stage_patches_delete(&m->made.patches);
}

/* ---- made again ---- */

static noh_result restore_picture(maker *m, noh_error *error)
{
    noh_texture texture;
    assert_int_equal(noh_pack_texture_at(&m->pack, 0, &texture, error), NOH_OK);
    return noh_gl_picture_restore(&m->g.gl, &m->g.ledger, &texture, &m->made.texture, error);
}

static noh_result restore_mesh(maker *m, noh_error *error)
{
    return noh_gl_mesh_restore(&m->g.gl, &m->g.ledger, &m->made.mesh, error);
}

static noh_result restore_renderer(maker *m, noh_error *error)
{
    return noh_gl_renderer_restore(&m->made.renderer, NULL, 0, error);
}

static noh_result restore_morph(maker *m, noh_error *error)
{
    return noh_gl_morph_restore(m->made.morph, NULL, 0, error);
}

static noh_result restore_skin(maker *m, noh_error *error)
{
    return noh_gl_skin_restore(m->made.skin, error);
}

static noh_result restore_light(maker *m, noh_error *error)
{
    return noh_gl_light_restore(&m->made.light, error);
}

static noh_result restore_backdrop(maker *m, noh_error *error)
{
    return noh_backdrop_restore(&m->made.backdrop, NULL, 0, error);
}

static noh_result restore_floor(maker *m, noh_error *error)
{
    return noh_stage_floor_restore(&m->made.floor, NULL, 0, error);
}

static noh_result restore_blob(maker *m, noh_error *error)
{
    return noh_stage_blob_restore(&m->made.blob, NULL, 0, error);
}

static noh_result restore_terrain(maker *m, noh_error *error)
{
    return noh_stage_terrain_restore(&m->made.terrain, NULL, 0, error);
}

static noh_result restore_stage(maker *m, noh_error *error)
{
    return noh_stage_restore(m->cast->stage, error);
}

static noh_result restore_shader(maker *m, noh_error *error)
{
    return noh_stage_shader_restore(m->made.shader, NULL, 0, error);
}

static noh_result restore_decals(maker *m, noh_error *error)
{
    return noh_stage_decals_restore(&m->made.decals, NULL, NULL, 0, error);
}

static noh_result restore_patches(maker *m, noh_error *error)
{
    return noh_stage_patches_restore(&m->made.patches, error);
}

#define MORPH(path, format)                                                                    \
    {                                                                                          \
        "morph " #path " " #format, make_morph, unmake_morph, restore_morph, NOH_MORPH_##path, \
            NOH_ACCUMULATE_##format, 0, ALONE                                                  \
    }
#define CASE(name, where)                                                 \
    {                                                                     \
#name, make_##name, unmake_##name, restore_##name, 0, 0, 0, where \
    }
static const create_case cases[] = {
    { "buffer", make_buffer, unmake_buffer, NULL, 0, 0, 0, ALONE },
    { "texture", make_texture, unmake_texture, NULL, 0, 0, 0, ALONE },
    { "picture", make_picture, unmake_texture, restore_picture, 0, 0, 0, ALONE },
    { "renderbuffer", make_renderbuffer, unmake_renderbuffer, NULL, 0, 0, 0, ALONE },
    { "framebuffer", make_framebuffer, unmake_framebuffer, NULL, 0, 0, 0, ALONE },
    { "mesh", make_mesh, unmake_mesh, restore_mesh, 0, 0, 0, ALONE },
    { "renderer", make_renderer, unmake_renderer, restore_renderer, 0, 0, 0, ALONE },
    { "variant", make_variant, unmake_variant, NULL, 0, 0, 0, ALONE },
    { "skin uniform", make_skin, unmake_skin, restore_skin, 0, 0, NOH_PALETTE_UNIFORM, ALONE },
    { "skin texture", make_skin, unmake_skin, restore_skin, 0, 0, NOH_PALETTE_TEXTURE, ALONE },
    MORPH(LAYERED, F32),
    MORPH(LAYERED, F16),
    MORPH(MRT, F32),
    MORPH(MRT, F16),
    MORPH(PER_LAYER, F32),
    MORPH(PER_LAYER, F16),
    MORPH(GATHER, F32),
    MORPH(GATHER, F16),
    MORPH(CPU, F32),
    MORPH(CPU, F16),
    CASE(light, ALONE),
    CASE(backdrop, ALONE),
    CASE(floor, ALONE),
    CASE(blob, ALONE),
    CASE(terrain, ALONE),
    CASE(stage, A_STAGE),
    CASE(shader, ON_A_STAGE),
    CASE(decals, ON_A_STAGE),
    CASE(patches, ON_DECALS),
};

/* ---- the platform ---- */

static void maker_open(maker *m)
{
    assert_int_equal(gpu_open(&m->g, "null"), 0);
    m->g.caps.mrt3 = m->g.caps.layered = 1;
    m->g.caps.render_f32 = m->g.caps.render_f16 = m->g.caps.render_u32 = 1;
    m->g.caps.blend_f32 = m->g.caps.blend_f16 = m->g.caps.blend_f32_exact = 1;
    m->joints[1] = 1;
    m->palette.joint_count = 2;
    for (uint32_t i = 0; i < 2; i++) {
        m->meshes[i] = test_mesh(&m->pack, i);
        m->headers[i].palette_count = 1;
        m->headers[i].flags = i ? NOH_MESH_DUAL_QUATERNION : 0u;
        m->skinned[i].header = &m->headers[i];
        m->skinned[i].palettes = &m->palette;
        m->skinned[i].palette_joints = m->joints;
    }
}

/* The stage, or the stage and the decals, that a case is made on. */
static void place_open(maker *m, const create_case *c, cast *on)
{
    const noh_gl_device d = device_of(m);
    noh_error error;
    m->cast = on;
    if (noh_stage_plan_make(&on->desc, &m->g.caps, &on->plan, &error)) fail_msg("plan: %s", error.what);
    on->memory = test_aligned(NULL, (size_t)on->plan.cpu_bytes);
    if (c->where >= ON_A_STAGE) assert_int_equal(make_stage(m, &error), NOH_OK);
    if (c->where == ON_DECALS) {
        const size_t bytes = noh_stage_decals_size(on->stage);
        m->decal_memory = test_aligned(NULL, bytes);
        assert_int_equal(noh_stage_decals_create(on->stage, &d, m->decal_memory, bytes, NULL, &m->decals, NULL),
                         NOH_OK);
    }
    noh_null_report_of(m->g.context, &m->rest);
    m->rest_ledger = m->g.ledger;
}

static void place_close(maker *m, const create_case *c)
{
    if (c->where == ON_DECALS) noh_stage_decals_delete(&m->decals);
    if (c->where >= ON_A_STAGE) noh_stage_delete(m->cast->stage);
    free(m->decal_memory);
    free(m->cast->memory);
    m->cast->stage = NULL;
    m->cast->memory = NULL;
}

static void place_restore(maker *m, const create_case *c)
{
    if (c->where >= ON_A_STAGE) assert_int_equal(noh_stage_restore(m->cast->stage, NULL), NOH_OK);
    if (c->where == ON_DECALS) assert_int_equal(noh_stage_decals_restore(&m->decals, NULL, NULL, 0, NULL), NOH_OK);
}

static uint32_t next_call(const create_case *c, uint32_t k)
{
    return c->where == ALONE || k < 2u || getenv("NOH_LONG") ? k + 1u : (test_is_sanitized() ? 8u : 2u) * k;
}

static void expect_nothing(maker *m, const char *name, const char *function, uint32_t k)
{
    noh_null_report report;
    noh_null_report_of(m->g.context, &report);
    for (int kind = 0; kind < NOH_NULL_KINDS; kind++) {
        if (report.live[kind] != m->rest.live[kind])
            fail_msg("%s, %s %u: %u objects of kind %d are left, of %u", name, function, k, report.live[kind], kind,
                     m->rest.live[kind]);
    }
    if (memcmp(&m->g.ledger, &m->rest_ledger, sizeof m->rest_ledger) != 0)
        fail_msg("%s, %s %u: the ledger still counts", name, function, k);
}

/* One refusal after the other until none comes; returns how many there were. */
static uint32_t refuse_each(const create_case *c, maker *m, const char *function, GLenum code)
{
    const noh_result expected = code == GL_OUT_OF_MEMORY ? NOH_ERR_MEMORY : NOH_ERR_GL;
    uint32_t refused = 0;
    for (uint32_t k = 0;; k = next_call(c, k), refused++) {
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_result result;
        memset(&m->made, 0, sizeof m->made);
        assert_true(noh_null_refuse(m->g.context, function, k, code));
        result = c->make(m, &error);
        if (!noh_null_refused(m->g.context)) {
            noh_null_refuse(m->g.context, NULL, 0, 0);
            if (result) fail_msg("%s fails without a refusal: %s", c->name, error.what);
            c->unmake(m);
            expect_nothing(m, c->name, function, k);
            return refused;
        }
        if (!result) fail_msg("%s says OK though call %u of %s was refused", c->name, k, function);
        if (result != expected || error.where != code || !error.what) {
            fail_msg("%s, call %u of %s: result %d, where 0x%x", c->name, k, function, (int)result,
                     (unsigned)error.where);
        }
        expect_nothing(m, c->name, function, k);
        assert_int_equal(c->make(m, &error), NOH_OK); /* a second attempt succeeds */
        c->unmake(m);
        expect_nothing(m, c->name, function, k);
    }
}

/* ---- the same after a lost context ---- */

static void lose(maker *m)
{
    char message[256];
    m->g.platform->destroy(m->g.context);
    assert_int_equal(m->g.platform->create(NULL, &m->g.context, message, sizeof message), NOH_OK);
    assert_int_equal(noh_gl_api_load(&m->g.gl, m->g.platform->get_proc, m->g.context, NULL), NOH_OK);
}

static uint32_t refuse_each_restore(const create_case *c, maker *m, const char *function, GLenum code)
{
    uint32_t count = 0;
    for (uint32_t k = 0;; k = next_call(c, k), count++) {
        noh_error error = { NOH_OK, NULL, 0, 0 };
        noh_result result;
        int refused;
        memset(&m->made, 0, sizeof m->made);
        assert_int_equal(c->make(m, &error), NOH_OK);
        lose(m);
        place_restore(m, c);
        assert_true(noh_null_refuse(m->g.context, function, k, code));
        result = c->restore(m, &error);
        refused = noh_null_refused(m->g.context);
        noh_null_refuse(m->g.context, NULL, 0, 0);
        if (refused) {
            if (!result) fail_msg("%s is restored though call %u of %s was refused", c->name, k, function);
            expect_nothing(m, c->name, function, k);
            result = c->restore(m, &error); /* it may be restored again */
        }
        if (result) fail_msg("%s is not restored: %s", c->name, error.what);
        c->unmake(m);
        expect_nothing(m, c->name, function, k);
        if (!refused) return count;
    }
}

/* ---- the test ---- */

static const char *const functions[] = {
#define NAME(field, result, parameters) "gl" #field,
    NOH_GL_REQUIRED(NAME)
#undef NAME
        "glFramebufferTexture",
    "glObjectLabel", "glPushDebugGroup", "glPopDebugGroup"
};

/* glGetError raises no error, and creates do not delete or read before an object is complete. */
static int may_be_refused(const char *function)
{
    return strcmp(function, "glGetError") != 0;
}

static void *reflection_open(noh_reflection *reflection)
{
    const noh_environment *room = noh_environment_at(noh_environment_find("room"));
    const noh_reflection_desc desc = { 0, noh_reflection_of_environment, room };
    const size_t bytes = noh_reflection_size(0), scratch_bytes = noh_reflection_scratch_size(0);
    void *texels = malloc(bytes), *scratch = malloc(scratch_bytes);
    assert_int_equal(noh_reflection_init(texels, bytes, scratch, scratch_bytes, &desc, reflection, NULL), NOH_OK);
    free(scratch);
    return texels;
}

static void no_create_hides_a_refusal(void **state)
{
    const test_model_desc desc = { 2, 7, 5, TEST_TANGENTS | TEST_UVS | TEST_COLORS | TEST_SCENE, 3 };
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    const noh_pack pack = test_open(bytes, count);
    uint32_t refusals = 0, restored = 0;
    noh_reflection reflection;
    void *texels = reflection_open(&reflection);
    cast on;
    (void)state;
    cast_open(&on);
    on.kinds[0] = on.kinds[MASKS];
    on.kinds[1] = on.kinds[TUBES];
    on.kinds[0].actor_count = on.kinds[1].actor_count = 1;
    on.desc.kind_count = 2;
    on.desc.gpu = &noh_stage_on_gl;
    for (size_t i = 0; i < TEST_COUNT(cases); i++) {
        maker *m = test_zeros(sizeof *m);
        m->pack = pack;
        m->path = cases[i].path;
        m->accumulate = cases[i].accumulate;
        m->mode = cases[i].mode;
        m->reflection = &reflection;
        maker_open(m);
        if (cases[i].where) place_open(m, &cases[i], &on);
        for (size_t f = 0; f < TEST_COUNT(functions); f++) {
            const GLenum code = f % 2 ? GL_OUT_OF_MEMORY : GL_INVALID_VALUE;
            const uint32_t refused = may_be_refused(functions[f]) ? refuse_each(&cases[i], m, functions[f], code) : 0;
            refusals += refused;
            if (refused && cases[i].restore) restored += refuse_each_restore(&cases[i], m, functions[f], code);
        }
        if (cases[i].where) place_close(m, &cases[i]);
        gpu_close(&m->g);
        free(m);
    }
    cast_close(&on);
    free(texels);
    print_message("# %u refused calls in %u creates, %u in their restores\n", refusals, (unsigned)TEST_COUNT(cases),
                  restored);
    assert_true(restored > 500);
    assert_true(refusals > 500);
    free(bytes);
}

/* ---- timers: the null platform has none, so these stand in ---- */

static GLenum timer_error;
static int timer_live, timer_refuses;

static void GL_APIENTRY gen_queries(GLsizei count, GLuint *names)
{
    for (GLsizei i = 0; i < count; i++) names[i] = (GLuint)i + 1u;
    timer_live += count;
    if (timer_refuses) timer_error = GL_OUT_OF_MEMORY;
}

static void GL_APIENTRY delete_queries(GLsizei count, const GLuint *names)
{
    for (GLsizei i = 0; i < count; i++) timer_live -= names[i] != 0;
}

static GLenum GL_APIENTRY timer_get_error(void)
{
    GLenum code = timer_error;
    timer_error = GL_NO_ERROR;
    return code;
}

static void GL_APIENTRY get_disjoint(GLenum what, GLint *value)
{
    (void)what;
    *value = 0;
}

static void a_refused_timer_is_not_available(void **state)
{
    (void)state;
    for (timer_refuses = 0; timer_refuses < 2; timer_refuses++) {
        noh_gl_api gl;
        noh_gl_caps caps;
        noh_gl_timer timer;
        uint64_t ns;
        memset(&gl, 0, sizeof gl);
        memset(&caps, 0, sizeof caps);
        gl.is_es = 1;
        gl.GetError = timer_get_error;
        gl.GetIntegerv = get_disjoint;
        gl.TimeGenQueries = gen_queries;
        gl.TimeDeleteQueries = delete_queries;
        caps.timer_query = 1;
        timer_error = GL_INVALID_ENUM; /* an error from before is not the timer's */
        noh_gl_timer_init(&timer, &gl, &caps);
        assert_int_equal(timer.available, !timer_refuses);
        assert_int_equal(timer_live, timer_refuses ? 0 : (int)NOH_GL_TIMER_FLIGHT);
        assert_int_equal(noh_gl_timer_poll(&timer, &gl, &ns), timer_refuses ? NOH_ERR_UNSUPPORTED : NOH_ERR_NOT_FOUND);
        noh_gl_timer_delete(&timer, &gl);
        assert_int_equal(timer_live, 0);
    }
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_create_hides_a_refusal),
        cmocka_unit_test(a_refused_timer_is_not_available),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
