/* Lips are found from corner to corner, in whatever order a file has the vertices, and soon where there are none. */
#include "convert/model/lip_rim.h"

#include <math.h>
#include <stdlib.h>

#include "convert/model/model_build.h"
#include "support/support.h"

#define COLUMNS 300u
#define ROWS 60u
#define HALF 0.35  /* of what goes along with the jaw by more than half */
#define JAW 0.3f   /* how far it goes */
#define STEP 0.004 /* between rows */

/* How far a vertex of the plain between -0.5 and 0.5 goes: what is below its middle, less from 0.25 to 0.45. */
static float share_at(double x, uint32_t row)
{
    return row >= ROWS / 2u ? 0.0f : (float)fmin(fmax((0.45 - fabs(x)) / 0.2, 0.0), 1.0);
}

static model *face_of(int by_columns)
{
    model *m = model_new();
    model_mesh *mesh = m->meshes = test_zeros(sizeof *m->meshes);
    model_target *jaw = mesh->targets = test_zeros(sizeof *mesh->targets);
    m->mesh_count = mesh->target_count = 1;
    mesh->name = model_string("head");
    mesh->vertex_count = COLUMNS * ROWS;
    mesh->position = test_zeros(3u * COLUMNS * ROWS * sizeof *mesh->position);
    mesh->indices = test_zeros(6u * COLUMNS * ROWS * sizeof *mesh->indices);
    jaw->name = model_string("jawOpen");
    jaw->position = test_zeros(3u * COLUMNS * ROWS * sizeof *jaw->position);
    for (uint32_t v = 0; v < COLUMNS * ROWS; v++) {
        const uint32_t column = by_columns ? v / ROWS : v % COLUMNS, row = by_columns ? v % ROWS : v / COLUMNS;
        const uint32_t right = by_columns ? v + ROWS : v + 1u, up = by_columns ? v + 1u : v + COLUMNS;
        const double x = (column + 0.5) / COLUMNS - 0.5;
        mesh->position[3u * v] = (float)x;
        mesh->position[3u * v + 1u] = (float)(STEP * row);
        jaw->position[3u * v + 1u] = -JAW * share_at(x, row);
        if (column + 1u == COLUMNS || row + 1u == ROWS) continue;
        const uint32_t corners[6] = { v, right, up, right, right + up - v, up };
        for (int i = 0; i < 6; i++) mesh->indices[mesh->index_count++] = corners[i];
    }
    return m;
}

static void lips_are_found_in_any_order(void **state)
{
    (void)state;
    for (int by_columns = 0; by_columns < 2; by_columns++) {
        model *m = face_of(by_columns);
        lip_rim *h = test_zeros(sizeof *h);
        const char *why = "";
        float rest = 0.0f;
        assert_int_equal(lip_rim_find(m->meshes, h, &why), 0);
        assert_null(why);
        assert_int_equal(h->rim_count, LIP_RIM_MAX);
        assert_true(fabs(h->half - HALF) < 0.01);
        for (uint32_t r = 0; r < h->rim_count; r++) {
            const float *lower = m->meshes->position + 3u * h->rim[r], *upper = m->meshes->position + 3u * h->upper[r];
            assert_true(lower[0] == upper[0] && fabs((double)upper[1] - STEP * (ROWS / 2u)) < 1e-6);
        }
        lip_rim_free(h);
        free(h);
        assert_int_equal(lip_gaps_find(m, 10.0f, &rest), 0);
        assert_true(fabsf(m->meshes->targets->lips - 0.5f * JAW * 10.0f) < 1e-3f);
        model_free(m);
    }
}

/* A joint may open lips, too, and no target then says how far: their light is as if they were a little apart. */
static void a_jaw_that_is_a_joint_keeps_lips_lit(void **state)
{
    (void)state;
    for (uint16_t jaw = 0; jaw < 2; jaw++) {
        model *m = face_of(0);
        model_mesh *mesh = m->meshes;
        const size_t slots = (size_t)mesh->vertex_count * MODEL_INFLUENCES_MAX;
        float rest = 0.24f;
        mesh->joints = test_zeros(slots * sizeof *mesh->joints);
        mesh->joint_weights = test_zeros(slots * sizeof *mesh->joint_weights);
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            const size_t slot = (size_t)v * MODEL_INFLUENCES_MAX;
            mesh->joints[slot] = v / COLUMNS < ROWS / 2u ? jaw : 0;
            mesh->joint_weights[slot] = 1.0f;
        }
        assert_int_equal(lip_gaps_find(m, 10.0f, &rest), 0);
        if (jaw)
            assert_true(rest > 0.09f && rest < 0.15f); /* 0.24: a white slit between closed lips */
        else
            assert_true(rest < 0.05f);
        model_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(lips_are_found_in_any_order),
                                        cmocka_unit_test(a_jaw_that_is_a_joint_keeps_lips_lit) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
