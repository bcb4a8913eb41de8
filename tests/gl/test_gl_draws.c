/* The list of draws for renderers of the game's own: it is what the library's renderer draws, call by call, in crowds and
 * alone, fading, with what is hidden, opaque and blended; and there without a GPU, too. */
#include "support/stage_fixture.h"
#include "support/gl_fixture.h"

#define DRAWS_MAX 512u

typedef struct call {
    GLsizei count, instances;
    uintptr_t offset;
} call;

static call made[DRAWS_MAX];
static uint32_t made_count;
static noh_gl_api real;

static void GL_APIENTRY one(GLenum mode, GLsizei count, GLenum type, const void *offset)
{
    assert_true(made_count < DRAWS_MAX);
    made[made_count++] = (call){ count, 1, (uintptr_t)offset };
    real.DrawElements(mode, count, type, offset);
}

static void GL_APIENTRY several(GLenum mode, GLsizei count, GLenum type, const void *offset, GLsizei instances)
{
    assert_true(made_count < DRAWS_MAX);
    made[made_count++] = (call){ count, instances, (uintptr_t)offset };
    real.DrawElementsInstanced(mode, count, type, offset, instances);
}

static noh_actor first_of(const cast *c, const noh_draw *d)
{
    return noh_stage_actor_at(c->stage, d->first_actor + d->actors[0]);
}

/* The calls that a list asks for. */
static uint32_t expect_calls(cast *c, const noh_draw *draws, uint32_t count, call *out)
{
    uint32_t calls = 0;
    for (uint32_t i = 0; i < count; i++) {
        const noh_draw *d = &draws[i];
        noh_stage_drawn drawn;
        noh_actor_mesh own;
        noh_mesh level;
        size_t first;
        assert_true(d->actor_count && d->material && d->from < d->to);
        assert_int_equal(noh_actor_on_gl(c->stage, first_of(c, d), d->index, &drawn, NULL), NOH_OK);
        assert_int_equal(noh_actor_mesh_at(c->stage, first_of(c, d), d->index, &own, NULL, NULL), NOH_OK);
        assert_int_equal(own.mesh, d->mesh);
        level = noh_gl_mesh_lod(drawn.mesh, d->level, &first);
        assert_ptr_equal(d->submesh, &level.submeshes[d->submesh - level.submeshes]);
        assert_true((uint32_t)(d->submesh - level.submeshes) < level.header->submesh_count);
        out[calls++] = (call){ (GLsizei)d->submesh->index_count, (GLsizei)d->actor_count,
                               first + (uintptr_t)d->submesh->first_index * drawn.mesh->room->index_bytes };
    }
    return calls;
}

static void check_pass(cast *c, int blended, uint32_t *most)
{
    static noh_draw draws[DRAWS_MAX];
    static call want[DRAWS_MAX];
    const uint32_t count = noh_stage_list_draws(c->stage, 0, blended, draws, DRAWS_MAX);
    assert_true(count <= DRAWS_MAX);
    assert_int_equal(noh_stage_list_draws(c->stage, 0, blended, NULL, 0), count);
    assert_int_equal(noh_stage_list_draws(c->stage, 1, blended, draws, DRAWS_MAX), 0); /* no such view */
    made_count = 0;
    assert_int_equal(noh_stage_draw(c->stage, blended ? NOH_PASS_BLENDED : NOH_PASS_OPAQUE, 0, NULL, NULL), NOH_OK);
    (void)noh_stage_list_draws(c->stage, 0, blended, draws, DRAWS_MAX);
    assert_int_equal(expect_calls(c, draws, count, want), made_count);
    assert_memory_equal(want, made, made_count * sizeof *made);
    for (uint32_t i = 0; i < count; i++) {
        if (draws[i].actor_count > *most) *most = draws[i].actor_count;
    }
}

static void the_list_is_what_is_drawn(void **state)
{
    gpu *g = fixture_gpu();
    (void)state;
    real = g->gl;
    for (int alone = 0; alone < 2; alone++) {
        const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, NULL, 0 };
        noh_actor actors[CAST_ACTORS];
        uint32_t most = 0, faded = 0;
        cast c;
        cast_open(&c);
        for (uint32_t k = 0; k < CAST_KINDS && alone; k++) c.kinds[k].actor_count = 1;
        c.desc.gpu = &noh_stage_on_gl;
        cast_make(&c, &device);
        cast_enter(&c, actors);
        g->gl.DrawElements = one;
        g->gl.DrawElementsInstanced = several;
        for (uint32_t f = 0; f < 24; f++) {
            const noh_stage_view view = cast_view(4u * f,
                                                  f < 12 ? 4.0f + 3.0f * (float)f : 40.0f - 3.0f * (float)(f - 12));
            const noh_appearance look = { .hidden_meshes = f % 5u };
            assert_int_equal(noh_actor_set_appearance(c.stage, actors[0], &look, NULL), NOH_OK);
            assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
            check_pass(&c, 0, &most);
            check_pass(&c, 1, &most);
            faded += noh_stage_stats_of(c.stage)->fading;
        }
        g->gl = real;
        assert_true(alone ? most == 1 : most > 3);
        assert_true(faded > 0);
        cast_close(&c);
    }
    fixture_expect_no_errors();
}

/* The same frames without a GPU: the same list, where there are slots for all; matrices and weights are there. */
static void it_needs_no_gpu(void **state)
{
    static noh_draw draws[2][DRAWS_MAX];
    static float matrices[12 * 256];
    gpu *g = fixture_gpu();
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, NULL, 0 };
    cast c[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        noh_actor actors[CAST_ACTORS];
        cast_open(&c[i]);
        c[i].desc.gpu = i ? NULL : &noh_stage_on_gl;
        cast_make(&c[i], i ? NULL : &device);
        cast_enter(&c[i], actors);
    }
    for (uint32_t f = 0; f < 6; f++) {
        const noh_stage_view view = cast_view(9u * f, 5.0f + (float)f);
        uint32_t count[2];
        for (int i = 0; i < 2; i++) {
            assert_int_equal(noh_stage_frame(c[i].stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
            count[i] = noh_stage_list_draws(c[i].stage, 0, 0, draws[i], DRAWS_MAX);
        }
        assert_true(count[0] > 3 && count[0] == count[1]);
        for (uint32_t d = 0; d < count[0]; d++) {
            const noh_draw *a = &draws[0][d], *b = &draws[1][d];
            noh_actor_mesh mesh;
            assert_true(a->kind == b->kind && a->index == b->index && a->level == b->level);
            assert_int_equal(a->actor_count, b->actor_count);
            assert_memory_equal(a->actors, b->actors, a->actor_count * sizeof *a->actors);
            assert_true(a->submesh->first_index == b->submesh->first_index && a->alpha_cutoff == b->alpha_cutoff);
            assert_int_equal(noh_actor_mesh_at(c[1].stage, first_of(&c[1], b), b->index, &mesh, matrices, NULL),
                             NOH_OK);
            assert_true(mesh.joint_count <= 256u);
        }
    }
    for (int i = 0; i < 2; i++) cast_close(&c[i]);
    fixture_expect_no_errors();
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_list_is_what_is_drawn),
    cmocka_unit_test(it_needs_no_gpu),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
