/* Marks as triangles: which ones, coordinates, folds, levels, room. */
#include "support/stage_fixture.h"

#include "stage/actors/decal_grow_internal.h"
#include "noh/base.h"
#include "noh/format.h"
#include "noh/marks.h"
#include "noh/pack.h"

#include <math.h>

#define SIDE 16u

/* A mesh of sheets, made here: positions and indices alone. */
typedef struct sheet {
    noh_mesh mesh;
    noh_mesh_header header;
    float positions[4 * (SIDE + 1) * (SIDE + 1) * 3];
    uint16_t indices[4 * SIDE * SIDE * 6];
} sheet;

static void sheet_open(sheet *s)
{
    memset(s, 0, sizeof *s);
    s->mesh.header = &s->header;
    s->mesh.positions = s->positions;
    s->mesh.indices = s->indices;
    s->header.index_bytes = 2;
}

/* A square of 1 by 1 at a depth, in n by n squares of two triangles. */
static void sheet_add(sheet *s, uint32_t n, float z)
{
    const uint32_t first = s->header.vertex_count;
    for (uint32_t y = 0; y <= n; y++) {
        for (uint32_t x = 0; x <= n; x++) {
            float *p = s->positions + 3u * s->header.vertex_count++;
            p[0] = (float)x / (float)n - 0.5f, p[1] = (float)y / (float)n - 0.5f, p[2] = z;
        }
    }
    for (uint32_t y = 0; y < n; y++) {
        for (uint32_t x = 0; x < n; x++) {
            const uint32_t a = first + y * (n + 1u) + x, b = a + n + 1u;
            const uint32_t quad[6] = { a, a + 1u, b, b, a + 1u, b + 1u };
            for (uint32_t i = 0; i < 6; i++) s->indices[s->header.index_count++] = (uint16_t)quad[i];
        }
    }
}

/* A patch with room for `room` triangles, up to ROOM. One patch at a time. */
#define ROOM 400u
static noh_decal_patch with_room(uint32_t room)
{
    static uint32_t triangles[ROOM];
    const noh_decal_patch patch = { triangles, room, 0, 0, 0 };
    return patch;
}

static const noh_decal at_front = {
    .centre = { 0.05f, 0.1f, 0.0f }, .normal = { 0.0f, 0.0f, 1.0f }, .right = { 1.0f, 0.0f, 0.0f }, .size = 0.1f
};

/* The source takes a triangle if one of its corners is within reach of the hit: of a mark within one large triangle
 * there is nothing. */
static void a_mark_within_a_large_triangle_is_there(void **state)
{
    static sheet s;
    noh_decal_patch patch = with_room(ROOM);
    noh_decal mark = at_front;
    uint32_t book = 0;
    (void)state;
    sheet_open(&s);
    sheet_add(&s, 1, 0.0f);
    mark.centre[0] = -0.2f, mark.centre[1] = -0.2f;
    for (uint32_t t = 0; t < 2; t++) {
        uint32_t within = 0;
        for (uint32_t i = 0; i < 3; i++) {
            const float *p = s.positions + 3u * noh_mesh_index(&s.mesh, 3u * t + i);
            const float x = p[0] - mark.centre[0], y = p[1] - mark.centre[1];
            within |= x * x + y * y < mark.size * mark.size;
        }
        book += within;
    }
    noh_decal_grow(&mark, &s.mesh, 0, &patch);
    assert_int_equal(book, 0);
    assert_int_equal(patch.count, 1);
    assert_int_equal(patch.triangles[0], 0);
    mark.centre[0] = mark.centre[1] = -0.05f; /* across the diagonal */
    noh_decal_grow(&mark, &s.mesh, 0, &patch);
    assert_int_equal(patch.count, 2);
}

/* The source's u = dot (2 s) / (s / 4) is right for one size alone. */
static void coordinates_for_any_size(void **state)
{
    static const float sizes[3] = { 0.01f, 0.0625f, 0.1f };
    (void)state;
    for (int i = 0; i < 3; i++) {
        noh_decal mark = at_front;
        const float s = sizes[i];
        const float corner[3] = { mark.centre[0] + s, mark.centre[1] - s, 0.03f };
        const float book = s * (2.0f * s / (s / 4.0f)) + 0.5f;
        float uv[2];
        mark.size = s;
        noh_decal_uv(&mark, corner, uv);
        assert_float_equal(uv[0], 1.0f, 1e-5f);
        assert_float_equal(uv[1], 1.0f, 1e-5f);
        assert_true(i == 1 ? fabsf(book - 1.0f) < 1e-5f : fabsf(book - 1.0f) > 0.2f);
    }
}

/* The source takes the first triangle of the patch for the one that was hit, and sorts triangles by number: its mark is
 * about another place. Ours begins with the hit one, and its coordinates ask the hit alone. */
static void the_mark_grows_from_the_triangle_that_was_hit(void **state)
{
    static sheet s;
    static const uint32_t hit = 300;
    noh_decal_patch patch = with_room(ROOM);
    noh_decal mark = at_front;
    float book[3] = { 0.0f, 0.0f, 0.0f }, uv[2];
    uint32_t first = hit;
    (void)state;
    sheet_open(&s);
    sheet_add(&s, SIDE, 0.0f);
    memset(mark.centre, 0, sizeof mark.centre);
    for (uint32_t i = 0; i < 9; i++)
        mark.centre[i % 3u] += s.positions[3u * noh_mesh_index(&s.mesh, 3u * hit + i / 3u) + i % 3u] / 3.0f;
    noh_decal_grow(&mark, &s.mesh, hit, &patch);
    assert_int_equal(patch.triangles[0], hit);
    noh_decal_uv(&mark, mark.centre, uv);
    assert_true(uv[0] == 0.5f && uv[1] == 0.5f);
    for (uint32_t i = 0; i < patch.count; i++) first = patch.triangles[i] < first ? patch.triangles[i] : first;
    for (uint32_t i = 0; i < 9; i++)
        book[i % 3u] += s.positions[3u * noh_mesh_index(&s.mesh, 3u * first + i / 3u) + i % 3u] / 3.0f;
    noh_decal_uv(&mark, book, uv);
    assert_true(hypotf(uv[0] - 0.5f, uv[1] - 0.5f) > 0.25f);
}

/* Every place of the square on the sheet is in the patch, once; all else of it touches the sphere. */
static void the_square_is_covered_once(void **state)
{
    static sheet s;
    noh_decal_patch patch = with_room(ROOM);
    (void)state;
    sheet_open(&s);
    sheet_add(&s, SIDE, 0.0f);
    noh_decal_grow(&at_front, &s.mesh, NOH_NONE, &patch);
    assert_int_equal(patch.left_out + patch.lone, 0);
    for (int y = -10; y <= 10; y++) {
        for (int x = -10; x <= 10; x++) {
            const float px = at_front.centre[0] + 0.00999f * (float)x, py = at_front.centre[1] + 0.00997f * (float)y;
            uint32_t found = 0;
            for (uint32_t i = 0; i < patch.count; i++) {
                const float *p[3];
                int inside = 1;
                for (uint32_t k = 0; k < 3; k++) {
                    p[k] = s.positions + 3u * noh_mesh_index(&s.mesh, 3u * patch.triangles[i] + k);
                }
                for (int k = 0; k < 3; k++) {
                    const float *a = p[k], *b = p[(k + 1) % 3];
                    inside &= (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]) > 0.0f;
                }
                found += (uint32_t)inside;
            }
            assert_int_equal(found, 1);
        }
    }
}

/* Two sheets that face the same way, a millimetre apart: a mark looked up by place would be on both. */
static void a_fold_that_touches_stays_clean(void **state)
{
    static sheet s;
    noh_decal_patch patch = with_room(ROOM);
    (void)state;
    sheet_open(&s);
    sheet_add(&s, SIDE, 0.0f);
    sheet_add(&s, SIDE, -0.001f);
    noh_decal_grow(&at_front, &s.mesh, NOH_NONE, &patch);
    assert_true(patch.count > 20);
    assert_int_equal(patch.lone, patch.count); /* as many of the other */
    for (uint32_t i = 0; i < patch.count; i++) assert_true(patch.triangles[i] < SIDE * SIDE * 2u);
}

/* Two sheets that cross as levels do: at the coarse one the other sheet is nearer to the middle of the mark. The
 * corners that both levels have say which sheet it is on. */
static void a_mark_keeps_its_fold_when_levels_change(void **state)
{
    static sheet s;
    noh_decal_patch before = with_room(ROOM);
    uint32_t fine[ROOM], other, again;
    noh_mesh_header coarse_header;
    noh_mesh coarse;
    noh_decal mark = at_front;
    (void)state;
    sheet_open(&s);
    sheet_add(&s, SIDE, 0.0f);
    sheet_add(&s, SIDE, -0.001f);
    before.triangles = fine;
    noh_decal_grow(&mark, &s.mesh, NOH_NONE, &before);
    assert_true(before.count > 20 && before.triangles[0] < SIDE * SIDE * 2u);
    coarse = s.mesh; /* the same vertices; the first sheet's have moved on */
    coarse_header = s.header;
    coarse.header = &coarse_header;
    for (uint32_t v = 0; v < (SIDE + 1u) * (SIDE + 1u); v++) s.positions[3u * v + 2u] = -0.003f;
    {
        noh_decal_patch nearest = with_room(ROOM);
        noh_decal_grow(&mark, &coarse, NOH_NONE, &nearest);
        other = nearest.triangles[0];
    }
    again = noh_decal_again(&mark, &before, &s.mesh, &coarse);
    assert_true(other >= SIDE * SIDE * 2u);
    assert_true(again < SIDE * SIDE * 2u);
    before.count = 0;
    assert_int_equal(noh_decal_again(&mark, &before, &s.mesh, &coarse), NOH_NONE);
}

/* A mark that is too large for its room says so, and is smaller. */
static void what_has_no_room_is_told(void **state)
{
    static sheet s;
    noh_decal_patch patch = with_room(96);
    noh_decal mark = at_front;
    double farthest = 0.0;
    (void)state;
    sheet_open(&s);
    sheet_add(&s, SIDE, 0.0f);
    mark.size = 0.4f;
    noh_decal_grow(&mark, &s.mesh, NOH_NONE, &patch);
    assert_true(patch.count > 30 && patch.count <= 96);
    assert_true(patch.left_out > 100);
    for (uint32_t i = 0; i < patch.count; i++) { /* round about the middle, not a strip of the first that came */
        const float *p = s.positions + 3u * noh_mesh_index(&s.mesh, 3u * patch.triangles[i]);
        farthest = fmax(farthest, hypot((double)(p[0] - mark.centre[0]), (double)(p[1] - mark.centre[1])));
    }
    assert_true(farthest < 0.4);
    noh_decal_grow(&mark, &s.mesh, 300, &patch);
    assert_int_equal(patch.triangles[0], 300);
    patch.room = 1;
    noh_decal_grow(&mark, &s.mesh, 300, &patch);
    assert_int_equal(patch.count, 1);
    patch.room = 0;
    noh_decal_grow(&mark, &s.mesh, 300, &patch);
    assert_int_equal(patch.count, 0);
    patch.room = 96;
    mark.normal[2] = -1.0f;
    noh_decal_grow(&mark, &s.mesh, NOH_NONE, &patch);
    assert_int_equal(patch.count, 0);
}

/* Grown again at each level of a real face, a patch begins with a triangle that has the middle of the picture, to a
 * texel of 256, and its corners are vertices of that level. */
static void levels_carry_the_mark(void **state)
{
    noh_decal_patch finest = with_room(ROOM);
    cast c;
    noh_mesh mesh;
    uint32_t grown = 0;
    (void)state;
    cast_open(&c);
    assert_int_equal(noh_pack_mesh_at(&c.packs[MASKS], 0, &mesh, NULL), NOH_OK);
    for (uint32_t i = 0; i < 24; i++) {
        const uint32_t triangle = (i * 977u) % (mesh.header->index_count / 3u);
        noh_decal mark = at_front;
        float a[3], b[3], length;
        const float *p[3];
        for (uint32_t k = 0; k < 3; k++) p[k] = mesh.positions + 3u * noh_mesh_index(&mesh, 3u * triangle + k);
        for (int k = 0; k < 3; k++) {
            mark.centre[k] = (p[0][k] + p[1][k] + p[2][k]) / 3.0f;
            a[k] = p[1][k] - p[0][k], b[k] = p[2][k] - p[0][k];
        }
        for (int k = 0; k < 3; k++) mark.normal[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        length = sqrtf(mark.normal[0] * mark.normal[0] + mark.normal[1] * mark.normal[1] +
                       mark.normal[2] * mark.normal[2]);
        if (!(length > 0.0f)) continue;
        for (int k = 0; k < 3; k++) mark.normal[k] /= length;
        length = sqrtf(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        for (int k = 0; k < 3; k++) mark.right[k] = a[k] / length;
        mark.size = 0.004f;
        noh_decal_grow(&mark, &mesh, triangle, &finest);
        assert_int_equal(finest.triangles[0], triangle);
        for (uint32_t k = 0; k < mesh.header->level_count; k++) {
            const noh_mesh level = noh_mesh_at_lod(&mesh, k);
            float low[2] = { 1e9f, 1e9f }, high[2] = { -1e9f, -1e9f };
            noh_decal_patch patch = with_room(ROOM);
            noh_decal_grow(&mark, &level, NOH_NONE, &patch);
            if (!patch.count) continue;
            for (uint32_t n = 0; n < 3; n++) {
                const uint32_t vertex = noh_mesh_index(&level, 3u * patch.triangles[0] + n);
                float uv[2];
                assert_true(vertex < level.header->vertex_count);
                noh_decal_uv(&mark, mesh.positions + 3u * (size_t)vertex, uv);
                for (int x = 0; x < 2; x++) low[x] = fminf(low[x], uv[x]), high[x] = fmaxf(high[x], uv[x]);
            }
            for (int x = 0; x < 2; x++) assert_true(low[x] < 0.5f + 1.0f / 256.0f && high[x] > 0.5f - 1.0f / 256.0f);
            grown++;
        }
    }
    assert_true(grown > 60);
    cast_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mark_within_a_large_triangle_is_there),
        cmocka_unit_test(coordinates_for_any_size),
        cmocka_unit_test(the_mark_grows_from_the_triangle_that_was_hit),
        cmocka_unit_test(the_square_is_covered_once),
        cmocka_unit_test(a_fold_that_touches_stays_clean),
        cmocka_unit_test(a_mark_keeps_its_fold_when_levels_change),
        cmocka_unit_test(what_has_no_room_is_told),
        cmocka_unit_test(levels_carry_the_mark),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
