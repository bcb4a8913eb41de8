/* Tests of tools/lod_compare/principal.c: the attributes that the comparison with meshoptimizer hands over in place of a
 * mesh's targets. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lod_compare/principal.c"

#define VERTICES 200u
#define TARGETS 9u
#define FIELDS 3u /* of displacements; targets are mixes of them */

void *compare_zeros(size_t count, size_t bytes)
{
    return test_zeros(count * bytes);
}

static struct {
    float position[VERTICES * 3u], deltas[TARGETS][VERTICES * 3u];
    model_target targets[TARGETS];
    model_mesh mesh;
} made;

static double random_of(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / 8388608.0 - 1.0;
}

/* Each field moves vertices along one direction, the next one half as far. The mesh is `size` large. */
static void make_mesh(float size)
{
    static const double axes[FIELDS][3] = { { 1, 0, 0 }, { 0, 0.6, 0.8 }, { 0.5, -0.5, 0.7 } };
    double along[FIELDS][VERTICES], shares[TARGETS][FIELDS];
    uint32_t state = 5;
    memset(&made, 0, sizeof made);
    for (uint32_t f = 0; f < FIELDS; f++) {
        for (uint32_t v = 0; v < VERTICES; v++) along[f][v] = random_of(&state) / (double)(1u << f);
        for (uint32_t t = 0; t < TARGETS; t++) shares[t][f] = random_of(&state);
    }
    for (uint32_t i = 0; i < VERTICES * 3u; i++) {
        made.position[i] = size * (float)(0.5 + 0.5 * (i < 6u ? (i < 3u ? -1.0 : 1.0) : random_of(&state)));
        for (uint32_t t = 0; t < TARGETS; t++) {
            for (uint32_t f = 0; f < FIELDS; f++)
                made.deltas[t][i] += size * (float)(shares[t][f] * along[f][i / 3u] * axes[f][i % 3u]);
        }
    }
    for (uint32_t t = 0; t < TARGETS; t++) made.targets[t].position = made.deltas[t];
    made.mesh.vertex_count = VERTICES;
    made.mesh.target_count = TARGETS;
    made.mesh.position = made.position;
    made.mesh.targets = made.targets;
}

/* How far two vertices are from each other in all targets, in sizes of the mesh. */
static double apart(uint32_t a, uint32_t b, float size)
{
    double square = 0.0;
    for (uint32_t t = 0; t < TARGETS; t++) {
        for (uint32_t c = 0; c < 3u; c++) {
            const double d = (double)(made.deltas[t][3u * a + c] - made.deltas[t][3u * b + c]) / (double)size;
            square += d * d;
        }
    }
    return sqrt(square);
}

/* Three fields are three numbers a vertex: distances between vertices are those in all 27 deltas. */
static void as_many_numbers_as_there_are_fields_hold_all(void **state)
{
    static const float sizes[] = { 1.0f, 250.0f, 0.01f };
    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        float kept, *out;
        make_mesh(sizes[s]);
        out = principal_of(&made.mesh, FIELDS, &kept);
        assert_true(fabsf(kept - 1.0f) < 1e-5f);
        for (uint32_t v = 1; v < VERTICES; v++) {
            double square = 0.0;
            for (uint32_t k = 0; k < FIELDS; k++) {
                const double d = (double)(out[FIELDS * v + k] - out[FIELDS * (v - 1u) + k]);
                square += d * d;
            }
            assert_true(fabs(sqrt(square) - apart(v, v - 1u, sizes[s])) < 1e-4 * (1.0 + sqrt(square)));
        }
        free(out);
    }
}

static void fewer_hold_the_most_that_they_can(void **state)
{
    float kept[FIELDS + 2u], *out;
    (void)state;
    make_mesh(1.0f);
    for (uint32_t count = 1; count < FIELDS + 2u; count++) {
        double sums[FIELDS + 2u] = { 0.0 }, products = 0.0, all = 0.0;
        out = principal_of(&made.mesh, count, &kept[count]);
        for (uint32_t v = 0; v < VERTICES; v++) {
            for (uint32_t k = 0; k < count; k++) sums[k] += (double)out[count * v + k] * (double)out[count * v + k];
            if (count > 1u) products += (double)out[count * v] * (double)out[count * v + 1u];
        }
        for (uint32_t k = 0; k < count; k++) {
            all += sums[k];
            if (k) assert_true(sums[k] <= sums[k - 1u] * 1.0001 + 1e-9); /* the most first */
        }
        assert_true(fabs(products) < 1e-3 * all); /* no two say the same */
        if (count > 1u) assert_true(kept[count] >= kept[count - 1u] - 1e-6f);
        free(out);
    }
    assert_true(kept[1] > 0.4f && kept[1] < 0.99f && kept[2] > kept[1] + 0.01f);
    assert_true(fabsf(kept[FIELDS + 1u] - 1.0f) < 1e-5f); /* a number too many is zero */
}

static void targets_that_move_nothing_are_zeros(void **state)
{
    float kept, *out;
    (void)state;
    make_mesh(1.0f);
    memset(made.deltas, 0, sizeof made.deltas);
    out = principal_of(&made.mesh, 2, &kept);
    assert_true(kept >= 1.0f && kept <= 1.0f);
    for (uint32_t i = 0; i < 2u * VERTICES; i++) assert_true(out[i] >= 0.0f && out[i] <= 0.0f);
    free(out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_many_numbers_as_there_are_fields_hold_all),
        cmocka_unit_test(fewer_hold_the_most_that_they_can),
        cmocka_unit_test(targets_that_move_nothing_are_zeros),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
