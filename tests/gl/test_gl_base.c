/* The base of runtime/gl/draw: halves, the function table, the capability probe, programs,
 * counted objects, timers; and platform/, which it stands on.
 *
 *   test_gl_base                  the tests
 *   test_gl_base --caps DRIVER    print what the probe finds, one `name=value` per line
 *
 * The tests run the second form as child processes, with capabilities taken away
 * by Mesa's environment variables, and read what the probe said. */
#define _POSIX_C_SOURCE 200809L

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../../platform/platform.h"
#include "gl/device/gl_api_internal.h"
#include "gl/device/gl_quirks_internal.h"
#include "gl/device/gl_timer_internal.h"
#include "core/base/half_internal.h"
#include "gl/device/gl_memory_internal.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/low_core.h"
#include "noh/low_gl.h"
#include "shaders.gen.h"

#define SWEEP 10000000u
#define NO_CONTEXT 77 /* exit code of --caps if the driver is missing */

static const char *self; /* this program's path */

/* --- halves --- */

static float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The value of a half from its definition, in double precision. */
static double half_value(uint16_t half)
{
    int exponent = (half >> 10) & 31;
    double mantissa = (double)(half & 1023) / 1024.0;
    double value = exponent ? ldexp(1.0 + mantissa, exponent - 15) : ldexp(mantissa, -14);
    return half & 0x8000 ? -value : value;
}

/* Rounding to half by its definition: the multiple of the half's last place. */
static double half_rounded(float value, noh_half_mode mode)
{
    int exponent;
    double size = fabs((double)value);
    frexp(size, &exponent);
    double place = ldexp(1.0, exponent - 11 > -24 ? exponent - 11 : -24);
    double steps = size / place;
    double result = place * (mode == NOH_HALF_RTZ ? floor(steps) : rint(steps));
    if (result > 65504.0) result = mode == NOH_HALF_RTZ ? 65504.0 : (double)INFINITY;
    return value < 0.0f ? -result : result;
}

static void check_half(uint32_t bits)
{
    static const noh_half_mode modes[] = { NOH_HALF_RTZ, NOH_HALF_RNE, NOH_HALF_RTZ_RNE };
    float value = float_of(bits);
    if (value != value || isinf(value)) return;
    for (int i = 0; i < 3; i++) {
        uint16_t half = noh_half_from_float(value, modes[i]);
        double want = half_rounded(value, modes[i]);
        double got = (half & 0x7fff) == 0x7c00 ? (half & 0x8000 ? -(double)INFINITY : (double)INFINITY)
                                               : half_value(half);
        int sign_kept = (half >> 15) == (bits >> 31);
        if (got != want || !sign_kept) {
            print_error("float 0x%08x mode %d: half 0x%04x is %g, not %g\n", bits, (int)modes[i], half, got, want);
            fail();
        }
    }
}

static void half_round_trip(void **state)
{
    (void)state;
    for (uint32_t half = 0; half < 65536; half++) {
        float value = noh_half_to_float((uint16_t)half);
        if ((half & 0x7c00u) != 0x7c00u) assert_true((double)value == half_value((uint16_t)half));
        uint32_t want = half;
        if ((half & 0x7fffu) > 0x7c00u) want |= 0x200u; /* a signalling NaN turns quiet */
        assert_int_equal(noh_half_from_float(value, NOH_HALF_RTZ), want);
        assert_int_equal(noh_half_from_float(value, NOH_HALF_RNE), want);
        assert_int_equal(bits_of(value) >> 31, half >> 15);
    }
}

static void half_midpoints(void **state)
{
    (void)state;
    for (uint32_t half = 0; half < 0x7c00; half++) {
        /* Below and above every boundary between two halves, and on it. */
        uint32_t low = bits_of(noh_half_to_float((uint16_t)half));
        double middle = 0.5 *
                        (half_value((uint16_t)half) + (half == 0x7bff ? 65536.0 : half_value((uint16_t)(half + 1))));
        uint32_t tie = bits_of((float)middle);
        const uint32_t around[] = { low ? low - 1 : 0, low, low + 1, tie - 1, tie, tie + 1 };
        for (size_t i = 0; i < sizeof around / sizeof *around; i++) {
            check_half(around[i]);
            check_half(around[i] | 0x80000000u);
        }
    }
}

static void half_sweep(void **state)
{
    (void)state;
    uint32_t random = 0x6e6f6821u;
    for (uint32_t i = 0; i < SWEEP; i++) {
        random ^= random << 13;
        random ^= random >> 17;
        random ^= random << 5;
        /* every second one in the range of halves */
        uint32_t bits = random;
        if (i & 1u) bits = (bits & 0x807fffffu) | ((100u + (random >> 24) % 46u) << 23);
        check_half(bits);
    }
}

static void half_specials(void **state)
{
    (void)state;
    static const noh_half_mode modes[] = { NOH_HALF_RTZ, NOH_HALF_RNE };
    for (int i = 0; i < 2; i++) {
        assert_int_equal(noh_half_from_float(float_of(0x7f800000u), modes[i]), 0x7c00);
        assert_int_equal(noh_half_from_float(float_of(0xff800000u), modes[i]), 0xfc00);
        assert_int_equal(noh_half_from_float(float_of(0x7fc12345u), modes[i]) & 0x7e00, 0x7e00);
        assert_int_equal(noh_half_from_float(float_of(0x7f800001u), modes[i]) & 0x7e00, 0x7e00);
        assert_int_equal(noh_half_from_float(float_of(0x80000000u), modes[i]), 0x8000);
        assert_int_equal(noh_half_from_float(65504.0f, modes[i]), 0x7bff);
        assert_int_equal(noh_half_from_float(float_of(0x33000000u), modes[i]), 0); /* 2^-25, a tie */
    }
    assert_int_equal(noh_half_from_float(float_of(0x33000001u), NOH_HALF_RNE), 1);
    assert_int_equal(noh_half_from_float(65520.0f, NOH_HALF_RTZ), 0x7bff);
    assert_int_equal(noh_half_from_float(65520.0f, NOH_HALF_RNE), 0x7c00);
    assert_int_equal(noh_half_from_float(3.0e38f, NOH_HALF_RTZ), 0x7bff);
    assert_int_equal(noh_half_from_float(-3.0e38f, NOH_HALF_RNE), 0xfc00);
}

/* --- a context for the tests below --- */

typedef struct context {
    const noh_platform *platform;
    noh_platform_context *made;
    noh_gl_api gl;
    noh_gl_caps caps;
    unsigned debug_errors;
    char why_not[2048];
} context;

static void GL_APIENTRY count_debug(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                    const GLchar *message, const void *user)
{
    (void)id;
    (void)severity;
    (void)length;
    (void)message;
    /* The callback's type has a const user pointer; the counter is ours. */
    unsigned *count;
    memcpy(&count, &user, sizeof count);
    /* Compilers and linkers report their own errors here too: not those. */
    if (type == GL_DEBUG_TYPE_ERROR && source == GL_DEBUG_SOURCE_API) (*count)++;
}

static int open_context(context *c, const char *driver)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    memset(c, 0, sizeof *c);
    c->platform = noh_platform_find(driver);
    if (!c->platform) return 0;
    if (c->platform->create(NULL, &c->made, c->why_not, sizeof c->why_not) != NOH_OK) return 0;
    if (noh_gl_api_load(&c->gl, c->platform->get_proc, c->made, &error) != NOH_OK) {
        snprintf(c->why_not, sizeof c->why_not, "table: %s", error.what);
        return 0;
    }
    if (c->gl.DebugMessageCallback) {
        c->gl.Enable(GL_DEBUG_OUTPUT);
        c->gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        c->gl.DebugMessageCallback(count_debug, &c->debug_errors);
    }
    if (noh_gl_caps_probe(&c->gl, &c->caps, &error) != NOH_OK) {
        snprintf(c->why_not, sizeof c->why_not, "probe: %s", error.what);
        return 0;
    }
    return 1;
}

static void close_context(context *c)
{
    if (c->platform) c->platform->destroy(c->made);
}

static context shared; /* EGL, for all tests that draw here */
static int shared_works;

static int set_up(void **state)
{
    (void)state;
    shared_works = open_context(&shared, "egl");
    if (!shared_works) print_message("no EGL context:\n%s", shared.why_not);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    close_context(&shared);
    return 0;
}

static context *need_context(void)
{
    if (!shared_works) {
        print_message("SKIP: no EGL context here\n");
        skip();
    }
    shared.debug_errors = 0;
    return &shared;
}

static void expect_no_errors(context *c)
{
    assert_int_equal(noh_gl_error_take(&c->gl), GL_NO_ERROR);
    assert_int_equal(c->debug_errors, 0);
}

/* --- the function table --- */

typedef struct refusing {
    context *c;
    const char *refused;
} refusing;

static noh_gl_proc get_but_one(void *user, const char *name)
{
    const refusing *r = user;
    if (strcmp(name, r->refused) == 0) return NULL;
    return r->c->platform->get_proc(r->c->made, name);
}

static void api_names_what_is_missing(void **state)
{
    (void)state;
    context *c = need_context();
    static const char *const names[] = { "glEnable", "glTexStorage3D", "glVertexAttribDivisor", "glGetError" };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        refusing r = { c, names[i] };
        noh_gl_api table;
        noh_gl_api before;
        noh_error error = { NOH_OK, NULL, 0, 0 };
        memset(&table, 0x5a, sizeof table);
        before = table;
        assert_int_equal(noh_gl_api_load(&table, get_but_one, &r, &error), NOH_ERR_UNSUPPORTED);
        assert_non_null(strstr(error.what, names[i]));
        assert_memory_equal(&table, &before, sizeof table);
    }
    expect_no_errors(c);
}

static void api_takes_optional_ones_or_not(void **state)
{
    (void)state;
    context *c = need_context();
    const char *name = c->gl.version >= 320 ? "glFramebufferTexture" : "glFramebufferTextureEXT";
    refusing r = { c, name };
    noh_gl_api table;
    assert_int_equal(noh_gl_api_load(&table, get_but_one, &r, NULL), NOH_OK);
    assert_true(table.FramebufferTexture == NULL);
    noh_gl_caps caps;
    assert_int_equal(noh_gl_caps_probe(&table, &caps, NULL), NOH_OK);
    assert_int_equal(caps.layered, 0);
    assert_int_equal(caps.mrt3, c->caps.mrt3);
    expect_no_errors(c);
}

static void api_checks_arguments(void **state)
{
    (void)state;
    context *c = need_context();
    noh_gl_api table;
    assert_int_equal(noh_gl_api_load(NULL, c->platform->get_proc, c->made, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_gl_api_load(&table, NULL, c->made, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_gl_caps_probe(NULL, &c->caps, NULL), NOH_ERR_ARG);
    assert_int_equal(noh_gl_caps_probe(&c->gl, NULL, NULL), NOH_ERR_ARG);
}

static void api_finds_extensions_whole(void **state)
{
    (void)state;
    context *c = need_context();
    const char *first = (const char *)c->gl.GetStringi(GL_EXTENSIONS, 0);
    char cut[256];
    assert_non_null(first);
    assert_true(noh_gl_has_extension(&c->gl, first));
    snprintf(cut, sizeof cut, "%.*s", (int)strlen(first) - 1, first);
    assert_false(noh_gl_has_extension(&c->gl, cut));
    assert_false(noh_gl_has_extension(&c->gl, ""));
}

/* --- the probe --- */

static void caps_limits_keep_the_promise_of_es3(void **state)
{
    (void)state;
    const noh_gl_caps *caps = &need_context()->caps;
    assert_in_range(caps->version, 300, 320);
    assert_int_equal(caps->is_es, 1);
    assert_true(caps->texture_size_max >= 2048);
    assert_true(caps->array_layers_max >= 256);
    assert_true(caps->draw_buffers_max >= 4);
    assert_true(caps->color_attachments_max >= 4);
    assert_true(caps->vertex_textures_max >= 16);
    assert_true(caps->vertex_attributes_max >= 16);
    assert_true(caps->uniform_block_bytes_max >= 16384);
    assert_in_range(caps->uniform_offset_align, 1, 256);
    assert_int_equal(caps->render_u32, 1);
    assert_int_equal(caps->mrt3, 1);
    assert_true(caps->renderer[0] != 0);
}

static void caps_of_llvmpipe(void **state)
{
    (void)state;
    context *c = need_context();
    const noh_gl_caps *caps = &c->caps;
    if (!strstr(caps->renderer, "llvmpipe")) {
        print_message("SKIP: the renderer is %s, not llvmpipe\n", caps->renderer);
        skip();
    }
    assert_int_equal(caps->render_f32, 1);
    assert_int_equal(caps->render_f16, 1);
    assert_int_equal(caps->blend_f32, 1);
    assert_int_equal(caps->blend_f32_exact, 1);
    assert_int_equal(caps->blend_f16, 1);
    assert_int_equal(caps->layered, 1);
    assert_int_equal(caps->f16_store_mode, NOH_HALF_RTZ);
    assert_int_equal(caps->f16_blend_mode, NOH_HALF_RTZ);
}

static void caps_leave_the_state_alone(void **state)
{
    (void)state;
    context *c = need_context();
    static const GLenum bindings[] = { GL_DRAW_FRAMEBUFFER_BINDING, GL_READ_FRAMEBUFFER_BINDING,
                                       GL_CURRENT_PROGRAM,          GL_VERTEX_ARRAY_BINDING,
                                       GL_TEXTURE_BINDING_2D,       GL_TEXTURE_BINDING_2D_ARRAY,
                                       GL_ARRAY_BUFFER_BINDING };
    GLint viewport[4], value;
    noh_gl_caps again;
    c->gl.Viewport(3, 5, 70, 90);
    c->gl.ActiveTexture(GL_TEXTURE3); /* whatever unit a game has left active */
    assert_int_equal(noh_gl_caps_probe(&c->gl, &again, NULL), NOH_OK);
    assert_memory_equal(&again, &c->caps, sizeof again);
    c->gl.ActiveTexture(GL_TEXTURE3);
    c->gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &value);
    assert_int_equal(value, 0);
    c->gl.ActiveTexture(GL_TEXTURE0);
    for (size_t i = 0; i < sizeof bindings / sizeof *bindings; i++) {
        value = -1;
        c->gl.GetIntegerv(bindings[i], &value);
        assert_int_equal(value, 0);
    }
    c->gl.GetIntegerv(GL_VIEWPORT, viewport);
    assert_int_equal(viewport[0], 3);
    assert_int_equal(viewport[1], 5);
    assert_int_equal(viewport[2], 70);
    assert_int_equal(viewport[3], 90);
    assert_false(c->gl.IsEnabled(GL_BLEND));
    c->gl.GetIntegerv(GL_BLEND_SRC_RGB, &value);
    assert_int_equal(value, GL_ONE);
    c->gl.GetIntegerv(GL_BLEND_DST_RGB, &value);
    assert_int_equal(value, GL_ZERO);
    expect_no_errors(c);
}

static void print_caps(const context *c)
{
    const noh_gl_caps *caps = &c->caps;
    printf("version=%d\nis_es=%d\nvendor=%s\nrenderer=%s\nversion_text=%s\n", caps->version, caps->is_es, caps->vendor,
           caps->renderer, caps->version_text);
    printf("mrt3=%d\nrender_f32=%d\nrender_f16=%d\nrender_u32=%d\n", caps->mrt3, caps->render_f32, caps->render_f16,
           caps->render_u32);
    printf("blend_f32=%d\nblend_f32_exact=%d\nblend_f16=%d\nlayered=%d\n", caps->blend_f32, caps->blend_f32_exact,
           caps->blend_f16, caps->layered);
    printf("timer_query=%d\nf16_store_mode=%d\nf16_blend_mode=%d\n", caps->timer_query, (int)caps->f16_store_mode,
           (int)caps->f16_blend_mode);
    printf("uniform_offset_align=%u\ncolor_attachments_max=%u\n", caps->uniform_offset_align,
           caps->color_attachments_max);
}

/* The second form of this program. */
static int caps_main(const char *driver)
{
    static context c;
    if (!open_context(&c, driver)) {
        fprintf(stderr, "%s", c.why_not);
        return NO_CONTEXT;
    }
    print_caps(&c);
    printf("debug_errors=%u\ngl_error=%u\n", c.debug_errors, noh_gl_error_take(&c.gl));
    close_context(&c);
    return 0;
}

/* Run `ENVIRONMENT self --caps driver` and keep what it printed. */
static int run_child(const char *environment, const char *driver, char *output, size_t room)
{
    char command[4096];
    snprintf(command, sizeof command, "%s '%s' --caps %s 2>/dev/null", environment, self, driver);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    size_t length = fread(output, 1, room - 1, pipe);
    output[length] = 0;
    int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* The number in one line of the child's output. */
static int said(const char *output, const char *name)
{
    char key[64];
    snprintf(key, sizeof key, "%s=", name);
    size_t length = strlen(key);
    for (const char *line = output; line; line = strchr(line, '\n')) {
        if (*line == '\n') line++;
        if (strncmp(line, key, length) == 0) return atoi(line + length);
    }
    print_error("the child did not print %s:\n%s", name, output);
    fail();
    return -1;
}

static void need_mesa(void)
{
    context *c = need_context();
    if (!strstr(c->caps.version_text, "Mesa")) {
        print_message("SKIP: not Mesa, whose capabilities can be taken away: %s\n", c->caps.version_text);
        skip();
    }
}

static void without_version_3_2(void **state)
{
    (void)state;
    char output[4096];
    need_mesa();
    assert_int_equal(run_child("MESA_GLES_VERSION_OVERRIDE=3.0", "egl", output, sizeof output), 0);
    assert_int_equal(said(output, "version"), 300);
    assert_int_equal(said(output, "layered"), 0);
    assert_int_equal(said(output, "blend_f32"), 1);
    assert_int_equal(said(output, "mrt3"), 1);
    assert_int_equal(said(output, "render_u32"), 1);
    assert_int_equal(said(output, "debug_errors"), 0);
    assert_int_equal(said(output, "gl_error"), 0);
}

static void without_float_blend(void **state)
{
    (void)state;
    char output[4096];
    need_mesa();
    const char *environment = "MESA_EXTENSION_OVERRIDE=-GL_EXT_float_blend";
    assert_int_equal(run_child(environment, "egl", output, sizeof output), 0);
    assert_int_equal(said(output, "render_f32"), 1);
    assert_int_equal(said(output, "blend_f32"), 0);
    assert_int_equal(said(output, "blend_f32_exact"), 0);
    assert_int_equal(said(output, "blend_f16"), 1);
    assert_int_equal(said(output, "f16_blend_mode"), NOH_HALF_RTZ);
    assert_int_equal(said(output, "debug_errors"), 1); /* the refused draw, which the probe provokes */
    assert_int_equal(said(output, "gl_error"), 0);
}

static void without_geometry_shaders(void **state)
{
    (void)state;
    char output[4096];
    need_mesa();
    const char *environment = "MESA_EXTENSION_OVERRIDE='-GL_EXT_geometry_shader -GL_OES_geometry_shader'";
    assert_int_equal(run_child(environment, "egl", output, sizeof output), 0);
    assert_int_equal(said(output, "version"), 310);
    assert_int_equal(said(output, "layered"), 0);
    assert_int_equal(said(output, "blend_f32"), 1);
    assert_int_equal(said(output, "debug_errors"), 0);
    assert_int_equal(said(output, "gl_error"), 0);
}

static void with_geometry_as_extension(void **state)
{
    (void)state;
    char output[4096];
    need_mesa();
    assert_int_equal(run_child("MESA_GLES_VERSION_OVERRIDE=3.1", "egl", output, sizeof output), 0);
    assert_int_equal(said(output, "version"), 310);
    assert_int_equal(said(output, "layered"), 1);
    assert_int_equal(said(output, "debug_errors"), 0);
    const char *only_oes = "MESA_GLES_VERSION_OVERRIDE=3.1 MESA_EXTENSION_OVERRIDE=-GL_EXT_geometry_shader";
    assert_int_equal(run_child(only_oes, "egl", output, sizeof output), 0);
    assert_int_equal(said(output, "version"), 310);
    assert_int_equal(said(output, "debug_errors"), 0);
}

static void without_float_targets(void **state)
{
    (void)state;
    char output[4096];
    need_mesa();
    const char *environment = "MESA_EXTENSION_OVERRIDE=-GL_EXT_color_buffer_float";
    assert_int_equal(run_child(environment, "egl", output, sizeof output), 0);
    assert_int_equal(said(output, "render_f32"), 0);
    assert_int_equal(said(output, "blend_f32"), 0);
    assert_int_equal(said(output, "render_u32"), 1);
    assert_int_equal(said(output, "mrt3"), 1);
    assert_int_equal(said(output, "gl_error"), 0);
}

/* Mesa renders RGBA16F whatever it lists, so a table that lies represents phones
 * without any float format. */
static PFNGLTEXSTORAGE3DPROC real_storage;

static void GL_APIENTRY storage_without_floats(GLenum target, GLsizei levels, GLenum format, GLsizei width,
                                               GLsizei height, GLsizei depth)
{
    if (format != GL_RGBA16F && format != GL_RGBA32F) real_storage(target, levels, format, width, height, depth);
}

static void without_any_float_target(void **state)
{
    (void)state;
    context *c = need_context();
    noh_gl_api table = c->gl;
    noh_gl_caps caps;
    real_storage = table.TexStorage3D;
    table.TexStorage3D = storage_without_floats;
    assert_int_equal(noh_gl_caps_probe(&table, &caps, NULL), NOH_OK);
    assert_int_equal(caps.render_f32 + caps.blend_f32 + caps.blend_f32_exact, 0);
    assert_int_equal(caps.render_f16 + caps.blend_f16, 0);
    assert_int_equal(caps.f16_store_mode, NOH_HALF_UNKNOWN);
    assert_int_equal(caps.f16_blend_mode, NOH_HALF_UNKNOWN);
    assert_int_equal(caps.render_u32, 1);
    assert_int_equal(caps.mrt3, 1);
    assert_int_equal(caps.layered, c->caps.layered);
    expect_no_errors(c);
}

/* A driver that blends by replacing, as if the function were never set. */
static void GL_APIENTRY no_blend_function(GLenum source, GLenum destination)
{
    (void)source;
    (void)destination;
}

static void without_real_blending(void **state)
{
    (void)state;
    context *c = need_context();
    noh_gl_api table = c->gl;
    noh_gl_caps caps;
    table.BlendFunc = no_blend_function;
    assert_int_equal(noh_gl_caps_probe(&table, &caps, NULL), NOH_OK);
    assert_int_equal(caps.render_f32, c->caps.render_f32);
    assert_int_equal(caps.blend_f32 + caps.blend_f32_exact + caps.blend_f16, 0);
    assert_int_equal(caps.f16_store_mode, c->caps.f16_store_mode);
    assert_int_equal(caps.f16_blend_mode, NOH_HALF_UNKNOWN);
    expect_no_errors(c);
}

/* A driver of another name: the quirks that the probe obeys. */
static PFNGLGETSTRINGPROC real_string;

static const GLubyte *GL_APIENTRY string_of_swiftshader(GLenum what)
{
    static const char name[] = "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero)))";
    return what == GL_RENDERER ? (const GLubyte *)name : real_string(what);
}

static void a_quirk_unsettles_the_half_modes(void **state)
{
    (void)state;
    context *c = need_context();
    noh_gl_api table = c->gl;
    noh_gl_caps caps;
    real_string = table.GetString;
    table.GetString = string_of_swiftshader;
    assert_int_equal(noh_gl_caps_probe(&table, &caps, NULL), NOH_OK);
    assert_int_equal(caps.f16_store_mode, NOH_HALF_UNKNOWN);
    assert_int_equal(caps.f16_blend_mode, NOH_HALF_UNKNOWN);
    assert_int_equal(caps.blend_f16, c->caps.blend_f16);
    expect_no_errors(c);
}

static void every_quirk_has_a_reason_and_a_source(void **state)
{
    uint32_t count;
    const noh_gl_quirk *quirks = noh_gl_quirk_table(&count);
    (void)state;
    assert_true(count > 0);
    for (uint32_t i = 0; i < count; i++) {
        char renderer[128];
        assert_true(strlen(quirks[i].reason) > 20);
        assert_true(strlen(quirks[i].source) > 10);
        snprintf(renderer, sizeof renderer, "a %s b", quirks[i].renderer);
        assert_ptr_equal(noh_gl_quirk_find(renderer, quirks[i].quirk), &quirks[i]);
    }
    assert_null(noh_gl_quirk_find("a GPU", NOH_QUIRK_SOFTWARE));
    assert_null(noh_gl_quirk_find("", NOH_QUIRK_BLEND_DEAR));
    assert_null(noh_gl_quirk_find("llvmpip", NOH_QUIRK_SOFTWARE));
    assert_null(noh_gl_quirk_find("llvmpipe", NOH_QUIRK_BLEND_DEAR));
}

static void on_osmesa(void **state)
{
    (void)state;
    char output[4096];
    /* libOSMesa itself leaks 480 bytes per context. */
    int code = run_child("ASAN_OPTIONS=detect_leaks=0", "osmesa", output, sizeof output);
    if (code == NO_CONTEXT) {
        print_message("SKIP: no libOSMesa here\n");
        skip();
    }
    assert_int_equal(code, 0);
    assert_int_equal(said(output, "is_es"), 0);
    assert_int_equal(said(output, "render_f32"), 1);
    assert_int_equal(said(output, "blend_f32_exact"), 1);
    assert_int_equal(said(output, "layered"), 1);
    assert_int_equal(said(output, "f16_store_mode"), NOH_HALF_RTZ);
    assert_int_equal(said(output, "f16_blend_mode"), NOH_HALF_RTZ);
    assert_int_equal(said(output, "debug_errors"), 0);
    assert_int_equal(said(output, "gl_error"), 0);
}

static void on_angle(void **state)
{
    (void)state;
    char output[4096];
    int code = run_child("", "angle", output, sizeof output);
    if (code == NO_CONTEXT) {
        print_message("SKIP: no ANGLE here (NOH_ANGLE may name its folder)\n");
        skip();
    }
    assert_int_equal(code, 0);
    assert_int_equal(said(output, "layered"), 0);
    assert_int_equal(said(output, "blend_f32_exact"), 1);
    assert_int_equal(said(output, "f16_blend_mode"), NOH_HALF_UNKNOWN); /* gl_quirks.c */
    assert_int_equal(said(output, "gl_error"), 0);
}

/* --- programs --- */

static const char *const broken_pieces[] = { "#line 1 0\n", "void main() {\n    wrong;\n}\n" };
static const noh_gl_source broken = { "#version 300 es\n", broken_pieces, 2 };

static noh_gl_program_desc good_desc(void)
{
    noh_gl_program_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.name = "good";
    desc.vertex = &noh_shader_probe_triangle_vert;
    desc.fragment = &noh_shader_probe_floats_frag;
    return desc;
}

static void program_counts_and_dies(void **state)
{
    (void)state;
    context *c = need_context();
    noh_gl_ledger ledger;
    noh_gl_program_desc desc = good_desc();
    char log[256] = "old";
    GLuint program = 0;
    GLint in_use = -1;
    memset(&ledger, 0, sizeof ledger);
    desc.ledger = &ledger;
    assert_int_equal(noh_gl_program_create(&c->gl, &desc, &program, log, sizeof log, NULL), NOH_OK);
    c->gl.GetIntegerv(GL_CURRENT_PROGRAM, &in_use);
    assert_int_equal(in_use, 0);
    assert_string_equal(log, "");
    assert_true(program != 0);
    assert_int_equal(ledger.programs, 1);
    noh_gl_program_delete(&c->gl, &ledger, &program);
    noh_gl_program_delete(&c->gl, &ledger, &program);
    assert_int_equal(program, 0);
    assert_int_equal(ledger.programs, 0);
    expect_no_errors(c);
}

static void program_says_what_is_wrong(void **state)
{
    (void)state;
    context *c = need_context();
    noh_error error = { NOH_OK, NULL, 0, 0 };
    noh_gl_program_desc desc = good_desc();
    char log[1024];
    GLuint program = 12345;
    desc.name = "bad one";
    desc.fragment = &broken;
    assert_int_equal(noh_gl_program_create(&c->gl, &desc, &program, log, sizeof log, &error), NOH_ERR_DATA);
    assert_int_equal(error.where, GL_FRAGMENT_SHADER);
    assert_ptr_equal(strstr(log, "bad one: fragment: "), log);
    assert_non_null(strstr(log, "wrong"));
    /* the line, counted from the piece's #line, as Mesa writes it or NVIDIA */
    assert_true(strstr(log, ":2") || strstr(log, "(2)"));
    assert_int_equal(program, 12345);
    /* In too little room the log is cut and zero-terminated, and what lies behind is untouched. */
    for (size_t room = 0; room < 32; room++) {
        memset(log, '#', sizeof log);
        assert_int_equal(noh_gl_program_create(&c->gl, &desc, &program, log, room, NULL), NOH_ERR_DATA);
        assert_int_equal(log[room], '#');
        if (room) assert_true(memchr(log, 0, room) != NULL);
    }
    desc.fragment = NULL;
    assert_int_equal(noh_gl_program_create(&c->gl, &desc, &program, NULL, 0, &error), NOH_ERR_ARG);
    assert_non_null(strstr(error.what, "fragment"));
    desc = good_desc();
    desc.vertex = NULL;
    assert_int_equal(noh_gl_program_create(&c->gl, &desc, &program, NULL, 0, &error), NOH_ERR_ARG);
    noh_gl_source empty = broken;
    empty.piece_count = 0;
    desc.vertex = &empty;
    assert_int_equal(noh_gl_program_create(&c->gl, &desc, &program, NULL, 0, &error), NOH_ERR_ARG);
    empty.piece_count = NOH_GL_PIECES_MAX + 1;
    assert_int_equal(noh_gl_program_create(&c->gl, &desc, &program, NULL, 0, &error), NOH_ERR_ARG);
    expect_no_errors(c);
}

/* A vertex shader that reads what a vertex array does not have links, draws, and shows what nobody wrote. */
static void a_program_reads_what_is_there(void **state)
{
    static const struct {
        const char *declares;
        noh_result result;
        const char *says;
    } cases[] = {
        { "layout(location = 1) in vec3 a;\nvoid main() { gl_Position = vec4(a, 1.0); }\n", NOH_OK, NULL },
        { "layout(location = 1) in vec4 a;\nvoid main() { gl_Position = a; }\n", NOH_OK, NULL }, /* w is 1 */
        { "layout(location = 1) in vec2 a;\nvoid main() { gl_Position = vec4(a, 0.0, float(gl_VertexID)); }\n", NOH_OK,
          NULL },
        { "layout(location = 1) in highp ivec3 a;\nvoid main() { gl_Position = vec4(a, 1.0); }\n", NOH_ERR_DATA,
          "another kind" },
        { "layout(location = 2) in highp uvec2 a;\nvoid main() { gl_Position = vec4(a, 1.0, 1.0); }\n", NOH_ERR_DATA,
          "another kind" },
        { "layout(location = 2) in highp ivec4 a;\nvoid main() { gl_Position = vec4(a); }\n", NOH_ERR_DATA,
          "more components" },
        { "layout(location = 3) in vec3 a;\nvoid main() { gl_Position = vec4(a, 1.0); }\n", NOH_ERR_DATA,
          "is not in the desc" },
        { "layout(location = 3) in vec3 a;\nvoid main() { gl_Position = vec4(1.0); }\n", NOH_OK, NULL }, /* not read */
    };
    static const char *const white[] = { "out mediump vec4 o;\nvoid main() { o = vec4(1.0); }\n" };
    static const noh_gl_source fragment = { "#version 300 es\n", white, 1 };
    static const noh_gl_input inputs[] = { { 1, GL_FLOAT_VEC3 }, { 2, GL_INT_VEC2 } };
    context *c = need_context();
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *pieces[] = { cases[i].declares };
        const noh_gl_source vertex = { "#version 300 es\n", pieces, 1 };
        noh_gl_program_desc desc = good_desc();
        noh_error error = { NOH_OK, "", 0, 0 };
        char log[256];
        GLuint program = 0;
        desc.vertex = &vertex;
        desc.fragment = &fragment;
        desc.inputs = inputs;
        desc.input_count = 2;
        const noh_result got = noh_gl_program_create(&c->gl, &desc, &program, log, sizeof log, &error);
        if (got != cases[i].result) fail_msg("%zu: %s", i, log);
        assert_int_equal(program != 0, cases[i].result == NOH_OK);
        if (cases[i].says) {
            assert_non_null(strstr(error.what, cases[i].says));
            assert_int_equal(error.where, i < 4 ? 1 : i < 6 ? 2 : 3);
            assert_ptr_equal(strstr(log, "good: vertex: a: a vertex shader reads"), log);
        }
        noh_gl_program_delete(&c->gl, NULL, &program);
        desc.input_count = 0; /* not asked, not checked */
        assert_int_equal(noh_gl_program_create(&c->gl, &desc, &program, NULL, 0, NULL), NOH_OK);
        noh_gl_program_delete(&c->gl, NULL, &program);
    }
    expect_no_errors(c);
}

static const char *const blocks_pieces[] = {
    "precision highp float;\n",
    "layout(std140) uniform first { vec4 a; };\nlayout(std140) uniform second { vec4 b; };\n",
    "#ifndef SCALE\n#error no SCALE\n#endif\nout vec4 sum;\nvoid main() { sum = (a + b) * SCALE; }\n"
};
static const noh_gl_source blocks_source = { "#version 300 es\n", blocks_pieces, 3 };

static void program_takes_defines_and_binds_blocks(void **state)
{
    (void)state;
    context *c = need_context();
    static const char *const blocks[] = { "absent", "second", "first" };
    noh_gl_program_desc desc = good_desc();
    GLuint program = 0;
    desc.fragment = &blocks_source;
    desc.blocks = blocks;
    desc.block_count = 3;
    assert_int_equal(noh_gl_program_create(&c->gl, &desc, &program, NULL, 0, NULL), NOH_ERR_DATA);
    desc.defines = "#define SCALE 2.0\n";
    assert_int_equal(noh_gl_program_create(&c->gl, &desc, &program, NULL, 0, NULL), NOH_OK);
    for (GLint i = 1; i < 3; i++) {
        GLint binding = -1;
        GLuint block = c->gl.GetUniformBlockIndex(program, blocks[i]);
        c->gl.GetActiveUniformBlockiv(program, block, GL_UNIFORM_BLOCK_BINDING, &binding);
        assert_int_equal(binding, i);
    }
    noh_gl_program_delete(&c->gl, NULL, &program);
    expect_no_errors(c);
}

static const char *const feedback_pieces[] = {
    "flat out highp int doubled;\n", "void main() { doubled = gl_VertexID * 2; gl_Position = vec4(0.0); }\n"
};
static const noh_gl_source feedback_source = { "#version 300 es\n", feedback_pieces, 2 };

static void program_feeds_back(void **state)
{
    (void)state;
    context *c = need_context();
    const noh_gl_api *gl = &c->gl;
    static const char *const varyings[] = { "doubled" };
    noh_gl_program_desc desc = good_desc();
    noh_gl_ledger ledger;
    noh_gl_buffer buffer;
    GLuint program = 0, array = 0;
    memset(&ledger, 0, sizeof ledger);
    desc.vertex = &feedback_source;
    desc.fragment = &blocks_source;
    desc.defines = "#define SCALE 1.0\n";
    desc.varyings = varyings;
    desc.varying_count = 1;
    assert_int_equal(noh_gl_program_create(gl, &desc, &program, NULL, 0, NULL), NOH_OK);
    assert_int_equal(noh_gl_buffer_create(gl, &ledger, GL_ARRAY_BUFFER, 16, NULL, GL_STREAM_READ, &buffer, NULL),
                     NOH_OK);
    gl->GenVertexArrays(1, &array);
    gl->BindVertexArray(array);
    gl->UseProgram(program);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer.name);
    gl->Enable(GL_RASTERIZER_DISCARD);
    gl->BeginTransformFeedback(GL_POINTS);
    gl->DrawArrays(GL_POINTS, 0, 4);
    gl->EndTransformFeedback();
    gl->Disable(GL_RASTERIZER_DISCARD);
    const GLint *got = gl->MapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 16, GL_MAP_READ_BIT);
    assert_non_null(got);
    for (int i = 0; i < 4; i++) assert_int_equal(got[i], i * 2);
    gl->UnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
    gl->BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
    gl->UseProgram(0);
    gl->BindVertexArray(0);
    gl->DeleteVertexArrays(1, &array);
    noh_gl_buffer_delete(gl, &ledger, &buffer);
    noh_gl_program_delete(gl, NULL, &program);
    expect_no_errors(c);
}

/* --- counted objects --- */

static void sizes_are_exact(void **state)
{
    (void)state;
    noh_gl_texture_desc desc;
    memset(&desc, 0, sizeof desc);
    assert_int_equal(noh_gl_texture_bytes(&desc), 0);
    desc.format = GL_RGBA32F;
    desc.width = 128;
    desc.height = 64;
    assert_int_equal(noh_gl_texture_bytes(&desc), 128 * 64 * 16);
    desc.layers = 3;
    assert_int_equal(noh_gl_texture_bytes(&desc), 128 * 64 * 16 * 3);
    desc.levels = 8; /* 128 64 32 16 8 4 2 1 by 64 32 16 8 4 2 1 1 */
    assert_int_equal(noh_gl_texture_bytes(&desc), (8192 + 2048 + 512 + 128 + 32 + 8 + 2 + 1) * 16 * 3);
    desc.levels = 9;
    assert_int_equal(noh_gl_texture_bytes(&desc), 0);
    desc.levels = 0;
    desc.format = GL_RGBA; /* not a sized format */
    assert_int_equal(noh_gl_texture_bytes(&desc), 0);
    desc.format = GL_RGBA32F;
    desc.width = desc.height = desc.layers = 65536;
    assert_true(noh_gl_texture_bytes(&desc) == (uint64_t)1 << 52);
    desc.width++;
    assert_int_equal(noh_gl_texture_bytes(&desc), 0);
    assert_int_equal(noh_gl_renderbuffer_bytes(GL_RGBA8, 10, 20, 0), 800);
    assert_int_equal(noh_gl_renderbuffer_bytes(GL_RGBA8, 10, 20, 1), 800);
    assert_int_equal(noh_gl_renderbuffer_bytes(GL_DEPTH_COMPONENT24, 10, 20, 4), 3200);
    assert_int_equal(noh_gl_renderbuffer_bytes(GL_RGBA8, 0, 20, 0), 0);
    assert_int_equal(noh_gl_renderbuffer_bytes(GL_RGBA, 10, 20, 0), 0);
}

static void ledger_balances(void **state)
{
    (void)state;
    context *c = need_context();
    const noh_gl_api *gl = &c->gl;
    noh_gl_ledger ledger, zero;
    noh_gl_buffer buffer;
    noh_gl_texture flat, array;
    noh_gl_renderbuffer depth;
    GLuint framebuffer = 0;
    memset(&ledger, 0, sizeof ledger);
    memset(&zero, 0, sizeof zero);
    noh_gl_texture_desc desc = { GL_RGBA8, 16, 16, 0, 5, GL_LINEAR, GL_REPEAT };
    assert_int_equal(noh_gl_buffer_create(gl, &ledger, GL_ARRAY_BUFFER, 1000, NULL, GL_STATIC_DRAW, &buffer, NULL),
                     NOH_OK);
    assert_int_equal(noh_gl_texture_create(gl, &ledger, &desc, &flat, NULL), NOH_OK);
    assert_int_equal(flat.target, GL_TEXTURE_2D);
    desc.layers = 3;
    assert_int_equal(noh_gl_texture_create(gl, &ledger, &desc, &array, NULL), NOH_OK);
    assert_int_equal(array.target, GL_TEXTURE_2D_ARRAY);
    assert_int_equal(noh_gl_renderbuffer_create(gl, &ledger, GL_DEPTH_COMPONENT24, 8, 8, 4, &depth, NULL), NOH_OK);
    assert_int_equal(noh_gl_framebuffer_create(gl, &ledger, &framebuffer, NULL), NOH_OK);
    assert_int_equal(ledger.buffer_bytes, 1000);
    assert_int_equal(ledger.texture_bytes, (256 + 64 + 16 + 4 + 1) * 4 * 4);
    assert_int_equal(ledger.renderbuffer_bytes, 8 * 8 * 4 * 4);
    assert_int_equal(noh_gl_ledger_bytes(&ledger), 1000 + 341 * 16 + 1024);
    assert_int_equal(ledger.textures, 2);
    for (int i = 0; i < 2; i++) { /* twice does nothing */
        noh_gl_buffer_delete(gl, &ledger, &buffer);
        noh_gl_texture_delete(gl, &ledger, &flat);
        noh_gl_texture_delete(gl, &ledger, &array);
        noh_gl_renderbuffer_delete(gl, &ledger, &depth);
        noh_gl_framebuffer_delete(gl, &ledger, &framebuffer);
    }
    assert_memory_equal(&ledger, &zero, sizeof ledger);
    expect_no_errors(c);
}

static void refused_objects_leave_nothing(void **state)
{
    (void)state;
    context *c = need_context();
    const noh_gl_api *gl = &c->gl;
    noh_gl_ledger ledger, zero;
    noh_gl_buffer buffer;
    noh_gl_texture texture;
    noh_gl_renderbuffer renderbuffer;
    noh_error error = { NOH_OK, NULL, 0, 0 };
    memset(&ledger, 0, sizeof ledger);
    memset(&zero, 0, sizeof zero);
    noh_gl_texture_desc desc = { GL_RGBA8, 16, 0, 0, 0, 0, 0 };
    assert_int_equal(noh_gl_texture_create(gl, &ledger, &desc, &texture, &error), NOH_ERR_ARG);
    assert_int_equal(noh_gl_buffer_create(gl, &ledger, GL_ARRAY_BUFFER, 0, NULL, GL_STATIC_DRAW, &buffer, &error),
                     NOH_ERR_ARG);
    assert_int_equal(
        noh_gl_buffer_create(gl, &ledger, GL_ARRAY_BUFFER, UINT64_MAX, NULL, GL_STATIC_DRAW, &buffer, &error),
        NOH_ERR_LIMIT);
    assert_int_equal(noh_gl_renderbuffer_create(gl, &ledger, GL_RGBA8, 0, 0, 0, &renderbuffer, &error), NOH_ERR_ARG);
    assert_int_equal(c->debug_errors, 0);
    /* Refused by the driver itself. */
    desc.height = 1;
    desc.width = 65536;
    if (c->caps.texture_size_max < desc.width) {
        assert_int_equal(noh_gl_texture_create(gl, &ledger, &desc, &texture, &error), NOH_ERR_GL);
        assert_int_equal(error.where, GL_INVALID_VALUE);
    }
    noh_result huge = noh_gl_buffer_create(gl, &ledger, GL_ARRAY_BUFFER, (uint64_t)1 << 50, NULL, GL_STATIC_DRAW,
                                           &buffer, &error);
    assert_int_equal(huge, NOH_ERR_MEMORY);
    assert_true(error.need == (uint64_t)1 << 50);
    assert_memory_equal(&ledger, &zero, sizeof ledger);
    assert_int_equal(noh_gl_error_take(gl), GL_NO_ERROR);
}

/* --- timers --- */

static void timer_tells_or_says_that_it_cannot(void **state)
{
    (void)state;
    context *c = need_context();
    noh_gl_timer timer;
    uint64_t elapsed = 0;
    noh_gl_timer_init(&timer, &c->gl, &c->caps);
    assert_int_equal(timer.available, c->caps.timer_query);
    noh_result idle = noh_gl_timer_poll(&timer, &c->gl, &elapsed);
    assert_int_equal(idle, timer.available ? NOH_ERR_NOT_FOUND : NOH_ERR_UNSUPPORTED);
    for (unsigned i = 0; i < NOH_GL_TIMER_FLIGHT + 2; i++) { /* two more than can be in flight */
        noh_gl_timer_begin(&timer, &c->gl);
        noh_gl_timer_begin(&timer, &c->gl);
        c->gl.Finish();
        noh_gl_timer_end(&timer, &c->gl);
        noh_gl_timer_end(&timer, &c->gl);
    }
    c->gl.Finish();
    unsigned told = 0;
    for (unsigned i = 0; i < 1000 && timer.available; i++)
        told += noh_gl_timer_poll(&timer, &c->gl, &elapsed) == NOH_OK;
    assert_int_equal(told, timer.available ? NOH_GL_TIMER_FLIGHT : 0);
    noh_gl_timer_begin(&timer, &c->gl);
    noh_gl_timer_delete(&timer, &c->gl); /* while open */
    expect_no_errors(c);
}

static void timer_without_queries(void **state)
{
    (void)state;
    context *c = need_context();
    noh_gl_caps without = c->caps;
    noh_gl_timer timer;
    uint64_t elapsed = 0;
    without.timer_query = 0;
    noh_gl_timer_init(&timer, &c->gl, &without);
    noh_gl_timer_begin(&timer, &c->gl);
    noh_gl_timer_end(&timer, &c->gl);
    assert_int_equal(noh_gl_timer_poll(&timer, &c->gl, &elapsed), NOH_ERR_UNSUPPORTED);
    noh_gl_timer_delete(&timer, &c->gl);
    expect_no_errors(c);
}

/* --- platform --- */

static void platforms_by_name(void **state)
{
    (void)state;
    static const char *const names[] = { "egl", "angle", "osmesa", "glfw", "null" };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_non_null(noh_platform_find(names[i]));
        assert_string_equal(noh_platform_find(names[i])->name, names[i]);
        assert_non_null(strstr(noh_platform_names(), names[i]));
    }
    assert_null(noh_platform_find("none"));
    assert_null(noh_platform_find(""));
}

static void failure_says_what_was_tried(void **state)
{
    (void)state;
    noh_platform_context *made = NULL;
    char message[2048];
    const noh_platform *angle = noh_platform_find("angle");
    setenv("NOH_ANGLE", "/nonexistent", 1);
    assert_int_equal(angle->create(NULL, &made, message, sizeof message), NOH_ERR_UNSUPPORTED);
    unsetenv("NOH_ANGLE");
    assert_non_null(strstr(message, "/nonexistent/libGLESv2.so"));
    assert_non_null(strstr(message, "set NOH_ANGLE"));
    assert_null(made);
    char small[8] = "#######";
    setenv("NOH_ANGLE", "/nonexistent", 1);
    assert_int_equal(angle->create(NULL, &made, small, 4), NOH_ERR_UNSUPPORTED);
    unsetenv("NOH_ANGLE");
    assert_int_equal(strlen(small), 3);
    assert_int_equal(small[4], '#');
}

static void version_can_be_asked_for(void **state)
{
    (void)state;
    context *c = need_context();
    noh_platform_desc desc;
    noh_platform_context *made = NULL;
    noh_gl_api table;
    char message[2048];
    memset(&desc, 0, sizeof desc);
    desc.es_version = 300;
    assert_int_equal(c->platform->create(&desc, &made, message, sizeof message), NOH_OK);
    assert_string_equal(message, "");
    assert_int_equal(noh_gl_api_load(&table, c->platform->get_proc, made, NULL), NOH_OK);
    /* a driver may give any later version that is compatible */
    assert_true(table.version >= 300);
    c->platform->destroy(made);
    assert_int_equal(c->platform->make_current(c->made), NOH_OK);
    expect_no_errors(c);
}

static void files(void **state)
{
    (void)state;
    char folder[] = "/tmp/noh_gl_base_XXXXXX";
    char path[128];
    noh_file file = { NULL, 0 };
    noh_error error = { NOH_OK, NULL, 0, 0 };
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/file", folder);
    assert_int_equal(noh_file_map(path, &file, &error), NOH_ERR_NOT_FOUND);
    assert_non_null(error.what);
    assert_int_equal(noh_file_write(path, "first", 5, NULL), NOH_OK);
    assert_int_equal(noh_file_map(path, &file, NULL), NOH_OK);
    assert_int_equal(noh_file_write(path, "second!", 7, NULL), NOH_OK);
    assert_int_equal(file.bytes, 5);
    assert_memory_equal(file.data, "first", 5); /* a mapping of the old file keeps its content */
    noh_file_unmap(&file);
    noh_file_unmap(&file);
    assert_int_equal(noh_file_map(path, &file, NULL), NOH_OK);
    assert_int_equal(file.bytes, 7);
    noh_file_unmap(&file);
    assert_int_equal(noh_file_write(path, NULL, 0, NULL), NOH_OK);
    assert_int_equal(noh_file_map(path, &file, NULL), NOH_OK);
    assert_int_equal(file.bytes, 0);
    noh_file_unmap(&file);
    assert_int_equal(noh_file_map(folder, &file, &error), NOH_ERR_ARG);
    assert_int_equal(noh_file_write(folder, "x", 1, &error), NOH_ERR_DATA);
    assert_int_equal(noh_file_write("/nonexistent/folder/file", "x", 1, &error), NOH_ERR_DATA);
    unlink(path);
    assert_int_equal(rmdir(folder), 0); /* nothing temporary was left */
}

static void clocks(void **state)
{
    (void)state;
    uint64_t wall = noh_clock_ns(), cpu = noh_cpu_clock_ns();
    while (noh_cpu_clock_ns() == cpu) continue;
    assert_true(noh_cpu_clock_ns() > cpu);
    assert_true(noh_clock_ns() > wall);
}

int main(int argument_count, char **arguments)
{
    if (argument_count == 3 && strcmp(arguments[1], "--caps") == 0) return caps_main(arguments[2]);
    static char path[4096];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    self = length > 0 ? path : arguments[0];
    if (argument_count == 2) cmocka_set_test_filter(arguments[1]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_round_trip),
        cmocka_unit_test(half_midpoints),
        cmocka_unit_test(half_sweep),
        cmocka_unit_test(half_specials),
        cmocka_unit_test(api_names_what_is_missing),
        cmocka_unit_test(api_takes_optional_ones_or_not),
        cmocka_unit_test(api_checks_arguments),
        cmocka_unit_test(api_finds_extensions_whole),
        cmocka_unit_test(caps_limits_keep_the_promise_of_es3),
        cmocka_unit_test(caps_of_llvmpipe),
        cmocka_unit_test(caps_leave_the_state_alone),
        cmocka_unit_test(without_version_3_2),
        cmocka_unit_test(without_float_blend),
        cmocka_unit_test(without_geometry_shaders),
        cmocka_unit_test(with_geometry_as_extension),
        cmocka_unit_test(without_float_targets),
        cmocka_unit_test(without_any_float_target),
        cmocka_unit_test(without_real_blending),
        cmocka_unit_test(a_quirk_unsettles_the_half_modes),
        cmocka_unit_test(every_quirk_has_a_reason_and_a_source),
        cmocka_unit_test(on_osmesa),
        cmocka_unit_test(on_angle),
        cmocka_unit_test(program_counts_and_dies),
        cmocka_unit_test(program_says_what_is_wrong),
        cmocka_unit_test(a_program_reads_what_is_there),
        cmocka_unit_test(program_takes_defines_and_binds_blocks),
        cmocka_unit_test(program_feeds_back),
        cmocka_unit_test(sizes_are_exact),
        cmocka_unit_test(ledger_balances),
        cmocka_unit_test(refused_objects_leave_nothing),
        cmocka_unit_test(timer_tells_or_says_that_it_cannot),
        cmocka_unit_test(timer_without_queries),
        cmocka_unit_test(platforms_by_name),
        cmocka_unit_test(failure_says_what_was_tried),
        cmocka_unit_test(version_can_be_asked_for),
        cmocka_unit_test(files),
        cmocka_unit_test(clocks),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
