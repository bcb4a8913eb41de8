/* The viewer's pictures of the accumulators: every texel of every layer of an instance's tile is grey plus gain times
 * the delta that is accumulated there, in float layers and in integer ones. */
#include "support/gl_fixture.h"

#include "noh/base.h"
#include "noh/deform.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "tool_shaders.gen.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static GLuint layer_program(int is_uint)
{
    static const char *const samplers[] = { "noh_layers" };
    noh_gl_program_desc desc;
    GLuint program = 0;
    memset(&desc, 0, sizeof desc);
    desc.vertex = &noh_shader_full_screen_vert;
    desc.fragment = &noh_shader_view_layer_frag;
    desc.defines = is_uint ? "#define NOH_LAYERS_UINT\n" : NULL;
    desc.samplers = samplers;
    desc.sampler_count = 1;
    assert_int_equal(noh_gl_program_create(&fixture_gpu()->gl, &desc, &program, NULL, 0, NULL), NOH_OK);
    return program;
}

/* rgba[side][side][4] of the atlas's first texels, to be freed. */
static uint8_t *picture_of(const noh_gl_morph_binding *binding, GLuint program, int layer, float gain, uint32_t side)
{
    const noh_gl_api *gl = &fixture_gpu()->gl;
    fixture_frame frame;
    GLuint array = 0;
    uint8_t *rgba;
    fixture_frame_open(&frame, side);
    gl->GenVertexArrays(1, &array);
    gl->BindVertexArray(array);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, binding->texture);
    gl->UseProgram(program);
    gl->Uniform1i(gl->GetUniformLocation(program, "u_layer"), layer);
    gl->Uniform1f(gl->GetUniformLocation(program, "u_gain"), gain);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->UseProgram(0);
    gl->BindTexture(GL_TEXTURE_2D_ARRAY, 0);
    gl->BindVertexArray(0);
    gl->DeleteVertexArrays(1, &array);
    rgba = fixture_frame_read(&frame);
    fixture_frame_close(&frame);
    return rgba;
}

static float largest(const float *values, size_t count)
{
    float most = 0.0f;
    for (size_t i = 0; i < count; i++) most = fmaxf(most, fabsf(values[i]));
    return most;
}

/* A tile of one instance lies at (0, 0) and is narrower than the picture. */
static void expect_layer(const uint8_t *rgba, uint32_t side, const noh_mesh *mesh, const float *deltas, float gain,
                         int layer)
{
    const uint32_t log2 = mesh->header->morph_width_log2;
    double spread = 0.0;
    for (uint32_t v = 0; v < mesh->header->touched_count; v++) {
        const uint32_t x = v & ((1u << log2) - 1u), y = v >> log2;
        assert_true(x < side && y < side);
        for (uint32_t c = 0; c < 3; c++) {
            const double want = 255.0 * fmin(fmax(0.5 + (double)gain * (double)deltas[3u * v + c], 0.0), 1.0);
            const uint8_t got = rgba[4u * ((size_t)y * side + x) + c];
            if (fabs((double)got - want) > 1.0)
                fail_msg("layer %d, vertex %u, axis %u: %u, not %.1f", layer, v, c, got, want);
            spread = fmax(spread, fabs(want - 127.5));
        }
    }
    assert_true(spread > 100.0); /* the gain is so high that plain grey would fail */
}

static void check_layers(noh_morph_path path, int is_uint)
{
    const test_model_desc model_desc = { 1, 9, 6, TEST_TANGENTS | TEST_UVS, 31 };
    const uint32_t side = 64;
    test_random r = test_random_from(91);
    noh_gl_caps caps = fixture_gpu()->caps;
    noh_gl_morph_desc desc;
    fixture_morph m;
    size_t count, floats;
    uint8_t *bytes = test_pack(&model_desc, &count);
    const noh_pack pack = test_open(bytes, count);
    const noh_mesh mesh = test_mesh(&pack, 0);
    GLuint program;
    float *deltas;
    if (is_uint) caps.render_f32 = caps.blend_f32 = 0;
    memset(&desc, 0, sizeof desc);
    desc.meshes = &mesh;
    desc.mesh_count = 1;
    desc.path = path;
    fixture_morph_open(&m, &desc, &caps);
    fixture_set_random(&m, 0, &r);
    noh_gl_morph_update(m.morph, NULL);
    deltas = fixture_layers(&m, 0);
    floats = noh_morph_layers_size(&mesh) / 12u; /* of one layer */
    const noh_gl_morph_binding binding = noh_gl_morph_binding_of(m.morph, 0);
    assert_int_equal(binding.is_uint, is_uint);
    assert_true(binding.tile_x == 0 && binding.tile_y == 0);
    program = layer_program(is_uint);
    for (int layer = 0; layer < 3; layer++) {
        const float *own = deltas + (size_t)layer * floats, gain = 0.5f / largest(own, floats);
        uint8_t *rgba = picture_of(&binding, program, layer, gain, side);
        expect_layer(rgba, side, &mesh, own, gain, layer);
        free(rgba);
    }
    noh_gl_program_delete(&fixture_gpu()->gl, NULL, &program);
    free(deltas);
    fixture_morph_close(&m);
    free(bytes);
    fixture_expect_no_errors();
}

static void each_layer_is_shown(void **state)
{
    (void)state;
    check_layers(NOH_MORPH_CPU, 0);
}

static void integer_layers_are_shown(void **state)
{
    (void)state;
    if (!fixture_gpu()->caps.render_u32) test_skip("no renderable RGBA32UI here");
    check_layers(NOH_MORPH_GATHER, 1);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(each_layer_is_shown),
                                        cmocka_unit_test(integer_layers_are_shown) };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, fixture_tear_down);
}
