/* Tests of pick.c in closed form: a flat sheet and a folded one. Real bodies over their clips, against a
 * search through all triangles, are in test_bounds_pick. */
#include "support/skin_asset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "core/pack/pack_internal.h"
#include "noh/low_core.h"

#define SIDE 5u /* vertices; the sheet covers 0..4 in x and y */

typedef struct sheet {
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    noh_pick_surface surface;
} sheet;

/* folded: the part beyond x = 2 is folded back over the rest, up to 1 above it. */
static void sheet_open(sheet *s, int folded)
{
    const test_model_desc desc = { 1, SIDE, 0, TEST_SCENE, 1 };
    model *m = test_model(&desc);
    size_t count;
    memset(s, 0, sizeof *s);
    for (uint32_t v = 0; v < SIDE * SIDE; v++) {
        float *p = m->meshes[0].position + 3 * v;
        p[2] = folded && p[0] > 2.0f ? 1.0f : 0.0f;
        p[0] = folded && p[0] > 2.0f ? 4.0f - p[0] : p[0];
    }
    s->bytes = test_pack_of(m, &count, NULL);
    s->pack = test_open(s->bytes, count);
    s->mesh = test_mesh(&s->pack, 0);
    s->surface.mesh = &s->mesh;
    model_free(m);
}

static noh_result pick(const sheet *s, float ox, float oy, float oz, float dx, float dy, float dz, float distance_max,
                       noh_pick_hit *hit)
{
    const float o[3] = { ox, oy, oz }, d[3] = { dx, dy, dz };
    return noh_pick(&s->surface, o, d, distance_max, NULL, 0, hit, NULL);
}

/* Distance, point, triangle, its submesh and the place in it agree with each other and with the ray. */
static void a_hit_says_where_it_is(void **state)
{
    sheet s;
    test_random r = test_random_from(21);
    uint32_t submeshes = 0;
    (void)state;
    sheet_open(&s, 0);
    assert_int_equal(s.mesh.header->submesh_count, 2);
    for (int k = 0; k < 500; k++) {
        const float at[3] = { test_random_float(&r, 0.01f, 3.99f), test_random_float(&r, 0.01f, 3.99f), 0.0f };
        const float from[3] = { test_random_float(&r, -2.0f, 6.0f), test_random_float(&r, -2.0f, 6.0f),
                                test_random_float(&r, 1.0f, 4.0f) };
        noh_pick_hit hit;
        float sum = 0.0f;
        assert_int_equal(pick(&s, from[0], from[1], from[2], at[0] - from[0], at[1] - from[1], -from[2], 2.0f, &hit),
                         NOH_OK);
        assert_true(fabsf(hit.distance - 1.0f) < 1e-5f);
        assert_true(3 * hit.triangle >= s.mesh.submeshes[hit.submesh].first_index);
        assert_true(3 * hit.triangle <
                    s.mesh.submeshes[hit.submesh].first_index + s.mesh.submeshes[hit.submesh].index_count);
        assert_int_equal(hit.joint, NOH_NONE);
        submeshes |= 1u << hit.submesh;
        for (uint32_t i = 0; i < 3; i++) {
            float mixed = 0.0f;
            for (uint32_t c = 0; c < 3; c++) {
                mixed += hit.barycentric[c] * s.mesh.positions[3 * noh_mesh_index(&s.mesh, 3 * hit.triangle + c) + i];
            }
            assert_true(hit.barycentric[i] > -1e-5f);
            assert_true(fabsf(mixed - at[i]) < 1e-5f && fabsf(hit.point[i] - at[i]) < 1e-5f &&
                        fabsf(hit.bind_point[i] - at[i]) < 1e-5f);
            sum += hit.barycentric[i];
        }
        assert_true(fabsf(sum - 1.0f) < 1e-6f);
    }
    assert_int_equal(submeshes, 3);
    free(s.bytes);
}

/* A surface behind the origin or beyond distance_max is not hit, nor is one that the ray misses. */
static void a_ray_ends_at_its_distance(void **state)
{
    sheet s;
    noh_pick_hit hit;
    (void)state;
    sheet_open(&s, 0);
    assert_int_equal(pick(&s, 1.2f, 1.7f, 3, 0, 0, 1, 100, &hit), NOH_ERR_NOT_FOUND);
    assert_int_equal(pick(&s, 1.2f, 1.7f, 3, 0, 0, -1, 2.99f, &hit), NOH_ERR_NOT_FOUND);
    assert_int_equal(pick(&s, 1.2f, 1.7f, 3, 0, 0, -1, 3.01f, &hit), NOH_OK);
    assert_int_equal(pick(&s, 1.2f, 1.7f, -3, 0, 0, 1, 3.01f, &hit), NOH_OK); /* both sides count */
    assert_int_equal(pick(&s, -0.003f, 1.7f, 3, 0, 0, -1, 100, &hit), NOH_ERR_NOT_FOUND);
    assert_int_equal(pick(&s, 4.003f, 1.7f, 3, 0, 0, -1, 100, &hit), NOH_ERR_NOT_FOUND);
    assert_int_equal(pick(&s, -5, 2, 0, 1, 0, 0, 100, &hit),
                     NOH_ERR_NOT_FOUND); /* in the plane of the sheet, which has no thickness */
    assert_int_equal(pick(&s, -5, 2, 1, 1, 0, 0, 100, &hit), NOH_ERR_NOT_FOUND);
    free(s.bytes);
}

/* Rays at edges and corners inside the sheet, from any side: none slips between two triangles. */
static void no_ray_slips_through_an_edge(void **state)
{
    sheet s;
    test_random r = test_random_from(22);
    (void)state;
    sheet_open(&s, 0);
    for (int k = 0; k < 4000; k++) {
        const float along = k % 4 ? test_random_float(&r, 0.1f, 3.9f) : (float)(1u + test_random_below(&r, 3)),
                    edge = (float)(1u + test_random_below(&r, 3));
        const float x = k % 2 ? along : edge, y = k % 2 ? edge : along;
        const float from[3] = { test_random_float(&r, -9.0f, 9.0f), test_random_float(&r, -9.0f, 9.0f),
                                test_random_float(&r, 0.5f, 9.0f) };
        noh_pick_hit hit;
        assert_int_equal(pick(&s, from[0], from[1], from[2], x - from[0], y - from[1], -from[2], 2.0f, &hit), NOH_OK);
    }
    free(s.bytes);
}

/* The same under a transform that leaves no corner at a round number, on the inner edges of every direction: the two
 * triangles of an edge round the ray's place differently. */
static void no_ray_slips_through_an_edge_askew(void **state)
{
    static const float world[12] = { 0.83f,  -0.29f, 0.41f,  0.37f, 0.31f, 0.91f,
                                     -0.17f, -0.23f, -0.27f, 0.33f, 0.87f, 0.11f };
    sheet s;
    test_random r = test_random_from(25);
    (void)state;
    sheet_open(&s, 0);
    s.surface.world = world;
    for (int k = 0; k < 20000; k++) {
        const uint32_t triangle = test_random_below(&r, s.mesh.header->index_count / 3u),
                       edge = test_random_below(&r, 3);
        const float t = test_random_float(&r, 0.05f, 0.95f);
        float rest[3], at[3], from[3];
        noh_pick_hit hit;
        for (uint32_t i = 0; i < 3; i++) {
            const float a = s.mesh.positions[3 * noh_mesh_index(&s.mesh, 3 * triangle + edge) + i],
                        b = s.mesh.positions[3 * noh_mesh_index(&s.mesh, 3 * triangle + (edge + 1u) % 3u) + i];
            rest[i] = a + t * (b - a);
        }
        if (rest[0] < 0.01f || rest[0] > 3.99f || rest[1] < 0.01f || rest[1] > 3.99f) {
            continue; /* at the rim a ray may miss */
        }
        for (uint32_t i = 0; i < 3; i++) {
            const float *row = world + 4 * i;
            at[i] = row[0] * rest[0] + row[1] * rest[1] + row[2] * rest[2] + row[3];
            from[i] = at[i] + test_random_float(&r, -1.0f, 1.0f) + (i == 2 ? 3.0f : 0.0f);
        }
        assert_int_equal(
            pick(&s, from[0], from[1], from[2], at[0] - from[0], at[1] - from[1], at[2] - from[2], 2.0f, &hit), NOH_OK);
    }
    free(s.bytes);
}

/* Of two layers the nearer one is hit, from above and from below, whatever the order of their triangles. */
static void the_nearest_layer_is_hit(void **state)
{
    sheet s;
    test_random r = test_random_from(23);
    (void)state;
    sheet_open(&s, 1);
    for (int k = 0; k < 200; k++) {
        const float x = test_random_float(&r, 0.05f, 0.95f), y = test_random_float(&r, 0.05f, 3.95f);
        noh_pick_hit hit;
        assert_int_equal(pick(&s, x, y, 3, 0, 0, -1, 100, &hit), NOH_OK);
        assert_true(fabsf(hit.distance - 2.0f) < 1e-5f && fabsf(hit.point[2] - 1.0f) < 1e-5f);
        assert_int_equal(pick(&s, x, y, -3, 0, 0, 1, 100, &hit), NOH_OK);
        assert_true(fabsf(hit.distance - 3.0f) < 1e-5f && fabsf(hit.point[2]) < 1e-5f);
        assert_int_equal(pick(&s, x, y, 0.6f, 0, 0, 1, 100, &hit),
                         NOH_OK); /* from between them: the layer behind does not count */
        assert_true(fabsf(hit.distance - 0.4f) < 1e-5f);
        assert_int_equal(pick(&s, x, y, 0.6f, 0, 0, -1, 100, &hit), NOH_OK);
        assert_true(fabsf(hit.distance - 0.6f) < 1e-5f);
    }
    free(s.bytes);
}

/* A placed sheet is hit where it stands; the bind point stays in the mesh's own space. */
static void placed_surfaces_are_hit_where_they_stand(void **state)
{
    static const float world[12] = { 0, -2, 0, 10, 2, 0, 0, 20, 0, 0, 2, 30 }; /* a quarter about z, twice as large */
    sheet s;
    noh_pick_hit hit;
    (void)state;
    sheet_open(&s, 0);
    s.surface.world = world;
    assert_int_equal(pick(&s, 10 - 2 * 1.7f, 20 + 2 * 1.2f, 40, 0, 0, -1, 100, &hit), NOH_OK);
    assert_true(fabsf(hit.distance - 10.0f) < 1e-4f);
    assert_true(fabsf(hit.bind_point[0] - 1.2f) < 1e-5f && fabsf(hit.bind_point[1] - 1.7f) < 1e-5f);
    assert_true(fabsf(hit.point[0] - 6.6f) < 1e-4f && fabsf(hit.point[1] - 22.4f) < 1e-4f &&
                fabsf(hit.point[2] - 30.0f) < 1e-4f);
    free(s.bytes);
}

/* The joint of a hit is the one that weighs most at the point: the corners' weights, each by its share of the point. */
static void the_joint_is_that_of_the_point(void **state)
{
    const skin_cylinder c = { 12, 6, 4, 2, 0, 0, 3.0f, 0.5f };
    model *m = skin_cylinder_model(&c);
    test_random r = test_random_from(24);
    float matrices[4 * 12], scratch[4 * 12];
    noh_pick_surface surface;
    uint32_t told = 0;
    size_t count;
    uint8_t *bytes = skin_pack_of(m, NULL, 1.0f, &count, NULL);
    noh_pack pack = test_open(bytes, count);
    noh_mesh mesh = test_mesh(&pack, 0);
    (void)state;
    memset(&surface, 0, sizeof surface);
    surface.mesh = &mesh;
    surface.matrices = matrices;
    for (uint32_t e = 0; e < 4 * 12; e++) {
        matrices[e] = e % 12u % 5u == 0 ? 1.0f : 0.0f;
    }
    assert_true(noh_pick_scratch_size(&mesh) <= sizeof scratch);
    for (int k = 0; k < 500; k++) {
        const float o[3] = { 4, test_random_float(&r, 0.05f, 2.95f), test_random_float(&r, -0.4f, 0.4f) },
                    d[3] = { -1, 0, 0 };
        double sums[4] = { 0, 0, 0, 0 };
        uint32_t best = 0;
        noh_pick_hit hit;
        assert_int_equal(noh_pick(&surface, o, d, 100.0f, scratch, sizeof scratch, &hit, NULL), NOH_OK);
        for (uint32_t corner = 0; corner < 3; corner++) {
            uint32_t joints[NOH_INFLUENCES_MAX];
            float weights[NOH_INFLUENCES_MAX];
            const uint32_t n = noh_mesh_influences(&mesh, noh_mesh_index(&mesh, 3 * hit.triangle + corner), joints,
                                                   weights);
            for (uint32_t i = 0; i < n; i++) {
                sums[joints[i]] += (double)hit.barycentric[corner] * (double)weights[i];
            }
        }
        for (uint32_t j = 1; j < 4; j++) {
            best = sums[j] > sums[best] ? j : best;
        }
        assert_true(sums[hit.joint] >= sums[best] - 1e-5);
        told |= 1u << hit.joint;
    }
    assert_int_equal(told, 15);
    free(bytes);
    model_free(m);
}

/* Where on a triangle a ray is sent: near one corner. */
static void near_corner(float corners[3][3], uint32_t corner, float at[3], float normal[3])
{
    float ab[3], ac[3], length = 0.0f;
    for (int i = 0; i < 3; i++) {
        at[i] = 0.05f * (corners[0][i] + corners[1][i] + corners[2][i]) + 0.85f * corners[corner][i];
        ab[i] = corners[1][i] - corners[0][i];
        ac[i] = corners[2][i] - corners[0][i];
    }
    for (int i = 0; i < 3; i++) {
        normal[i] = ab[(i + 1) % 3] * ac[(i + 2) % 3] - ab[(i + 2) % 3] * ac[(i + 1) % 3];
        length += normal[i] * normal[i];
    }
    for (int i = 0; i < 3; i++) {
        normal[i] /= sqrtf(length);
    }
}

/* Every corner of every triangle is hit from closely above it while one joint is far from where its neighbours are: a
 * vertex lies outside the box of its strongest joint, and the corners of a triangle in boxes of different joints. */
static void what_a_far_joint_pulls_is_hit(void **state)
{
    (void)state;
    for (uint32_t rings = 4; rings <= 9; rings++) {
        const skin_cylinder c = { 12, rings, 5, 2, 0, 0, 4.0f, 0.5f };
        model *m = skin_cylinder_model(&c);
        float matrices[5 * 12], scratch[5 * 12];
        noh_pick_surface surface;
        size_t count;
        uint8_t *bytes = skin_pack_of(m, NULL, 1.0f, &count, NULL);
        noh_pack pack = test_open(bytes, count);
        noh_mesh mesh = test_mesh(&pack, 0);
        memset(&surface, 0, sizeof surface);
        surface.mesh = &mesh;
        surface.matrices = matrices;
        assert_true(noh_pick_scratch_size(&mesh) <= sizeof scratch);
        for (uint32_t moved = 0; moved < 5; moved++) {
            for (uint32_t e = 0; e < 5 * 12; e++) {
                matrices[e] = e % 12u % 5u == 0 ? 1.0f : 0.0f;
            }
            matrices[12u * moved + 3u] = 20.0f;
            for (uint32_t k = 0; k < mesh.header->index_count; k++) {
                float corners[3][3], at[3], d[3], o[3];
                noh_pick_hit hit;
                for (uint32_t corner = 0; corner < 3; corner++) {
                    noh_skin_position(&mesh, matrices, NULL, noh_mesh_index(&mesh, k / 3u * 3u + corner),
                                      corners[corner]);
                }
                near_corner(corners, k % 3u, at, d);
                for (int i = 0; i < 3; i++) {
                    o[i] = at[i] + 0.01f * d[i];
                    d[i] = -d[i];
                }
                assert_int_equal(noh_pick(&surface, o, d, 0.02f, scratch, sizeof scratch, &hit, NULL), NOH_OK);
            }
        }
        free(bytes);
        model_free(m);
    }
}

/* ---- what alpha leaves ---- */

#define PICTURE_SIDE 16u

typedef struct cut {
    model_alpha alpha;
    uint32_t wrap;           /* a glTF enum value */
    int nearest, blocks;     /* unfiltered; compressed, 2: with alphas of one bit */
    float uv_scale, uv_from; /* over the sheet */
    float base_alpha, cutoff;
} cut;

/* Both halves of the sheet with a picture of random alpha, in patches of 4 x 4 texels. */
static void cut_sheet_open(sheet *s, const cut *c, int folded)
{
    const test_model_desc desc = { 1, SIDE, 0, TEST_SCENE | TEST_UVS, 1 };
    test_random r = test_random_from(27);
    model *m = test_model(&desc);
    model_texture *t = &m->textures[0];
    size_t count;
    memset(s, 0, sizeof *s);
    for (uint32_t v = 0; v < SIDE * SIDE; v++) {
        float *p = m->meshes[0].position + 3 * v;
        for (uint32_t k = 0; k < 2; k++) m->meshes[0].uv[2 * v + k] = c->uv_from + c->uv_scale * p[k] / 4.0f;
        p[2] = folded && p[0] > 2.0f ? 1.0f : 0.0f;
        p[0] = folded && p[0] > 2.0f ? 4.0f - p[0] : p[0];
    }
    free(t->rgba);
    t->width = t->height = PICTURE_SIDE;
    t->rgba = test_zeros(4u * PICTURE_SIDE * PICTURE_SIDE);
    for (uint32_t i = 0; i < PICTURE_SIDE * PICTURE_SIDE; i++) {
        const uint32_t alpha = i % 4u || i / PICTURE_SIDE % 4u ? test_random_below(&r, 256) : 0;
        t->rgba[4u * i + 3u] = (uint8_t)(c->blocks < 2 ? alpha : alpha < 128u ? 0u : 255u);
    }
    t->wrap_s = t->wrap_t = c->wrap;
    t->mag_filter = t->min_filter = c->nearest ? 9728 : 9729;
    t->with_alpha = 1;
    t->blocks = c->blocks ? MODEL_BLOCKS_ETC2 : MODEL_BLOCKS_NONE;
    t->cut_alone = c->blocks == 2;
    t->alpha_cutoff = c->cutoff;
    m->materials[0].alpha = c->alpha;
    m->materials[0].alpha_cutoff = c->cutoff;
    m->materials[0].base_color[3] = c->base_alpha;
    m->meshes[0].submeshes[1].material = 0;
    s->bytes = test_pack_of(m, &count, NULL);
    s->pack = test_open(s->bytes, count);
    s->mesh = test_mesh(&s->pack, 0);
    s->surface.mesh = &s->mesh;
    model_free(m);
}

/* The first level's alpha, decoded: 0..255. */
static void alphas_of(const sheet *s, const cut *c, uint8_t alphas[PICTURE_SIDE * PICTURE_SIDE])
{
    uint8_t rows[4 * PICTURE_SIDE * 4];
    noh_texture t;
    assert_int_equal(noh_pack_texture_at(&s->pack, 0, &t, NULL), NOH_OK);
    for (uint32_t y = 0; y < PICTURE_SIDE; y += 4) {
        const noh_texture_level level = noh_texture_level_at(&t, 0);
        if (t.header->format == NOH_TEXTURE_RGBA8) {
            memcpy(rows, level.pixels + 4u * PICTURE_SIDE * y, sizeof rows);
        } else {
            const uint32_t row = noh_texture_bytes(t.header->format, PICTURE_SIDE, y);
            assert_int_equal(t.header->format, c->blocks == 2 ? NOH_TEXTURE_ETC2_RGBA1 : NOH_TEXTURE_ETC2_RGBA);
            noh_etc2_decode(t.header->format, level.pixels + row, PICTURE_SIDE / 4u, rows);
        }
        for (uint32_t i = 0; i < 4 * PICTURE_SIDE; i++) alphas[PICTURE_SIDE * y + i] = rows[4u * i + 3u];
    }
}

/* A texel's place after wrapping, as OpenGL ES 3.0 has it (3.8.10). */
static uint32_t texel_of(double at, uint32_t wrap)
{
    const int n = (int)PICTURE_SIDE, i = (int)floor(at), turn = (i % (2 * n) + 2 * n) % (2 * n);
    if (wrap == 33071) return (uint32_t)(i < 0 ? 0 : i >= n ? n - 1 : i);
    if (wrap == 33648) return (uint32_t)(turn < n ? turn : 2 * n - 1 - turn);
    return (uint32_t)(turn % n);
}

static double alpha_of(const cut *c, const uint8_t *alphas, double x, double y)
{
    const double u = PICTURE_SIDE * (c->uv_from + c->uv_scale * x / 4.0) - (c->nearest ? 0.0 : 0.5);
    const double v = PICTURE_SIDE * (c->uv_from + c->uv_scale * y / 4.0) - (c->nearest ? 0.0 : 0.5);
    double sum = 0.0;
    for (int k = 0; k < 4; k++) {
        const double share_u = k % 2 ? u - floor(u) : 1.0 - (u - floor(u));
        const double share_v = k / 2 ? v - floor(v) : 1.0 - (v - floor(v));
        const uint32_t at = texel_of(v + k / 2, c->wrap) * PICTURE_SIDE + texel_of(u + k % 2, c->wrap);
        if (c->nearest && k) break;
        sum += (c->nearest ? 1.0 : share_u * share_v) * alphas[at] / 255.0;
    }
    return sum * c->base_alpha;
}

static void rays_go_through_what_is_cut_away(void **state)
{
    static const cut cuts[] = {
        { MODEL_ALPHA_MASK, 10497, 1, 0, 2.5f, -0.7f, 1.0f, 0.5f },
        { MODEL_ALPHA_MASK, 10497, 0, 0, 2.5f, -0.7f, 0.8f, 0.4f },
        { MODEL_ALPHA_MASK, 33071, 0, 1, 1.5f, -0.2f, 1.0f, 0.5f },
        { MODEL_ALPHA_MASK, 33648, 0, 1, 3.5f, -1.2f, 0.9f, 0.3f },
        { MODEL_ALPHA_MASK, 10497, 0, 2, 2.5f, -0.7f, 1.0f, 0.5f },
        { MODEL_ALPHA_BLEND, 10497, 1, 0, 2.5f, -0.7f, 0.9f, 0.5f },
        { MODEL_ALPHA_OPAQUE, 10497, 1, 0, 2.5f, -0.7f, 0.9f, 0.5f },
    };
    test_random r = test_random_from(28);
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(cuts); i++) {
        const cut *c = &cuts[i];
        uint8_t alphas[PICTURE_SIDE * PICTURE_SIDE];
        uint32_t hits = 0, sure = 0;
        sheet s;
        cut_sheet_open(&s, c, 0);
        alphas_of(&s, c, alphas);
        for (int k = 0; k < 4000; k++) {
            const float x = test_random_float(&r, 0.01f, 3.99f), y = test_random_float(&r, 0.01f, 3.99f);
            const double alpha = alpha_of(c, alphas, x, y);
            const double most = c->alpha == MODEL_ALPHA_MASK    ? c->cutoff
                                : c->alpha == MODEL_ALPHA_BLEND ? 0.5 / 255
                                                                : 0;
            const double u = PICTURE_SIDE * (c->uv_from + c->uv_scale * x / 4.0);
            const double v = PICTURE_SIDE * (c->uv_from + c->uv_scale * y / 4.0);
            noh_pick_hit hit;
            const int is_hit = pick(&s, x, y, 3, 0, 0, -1, 100, &hit) == NOH_OK;
            if (c->nearest && (fabs(u - nearbyint(u)) < 0.01 || fabs(v - nearbyint(v)) < 0.01)) continue;
            if (fabs(alpha - most) < 0.01 * most) continue;
            assert_int_equal(is_hit, alpha >= most);
            hits += (uint32_t)is_hit;
            sure++;
        }
        assert_true(sure > 3500);
        if (c->alpha == MODEL_ALPHA_MASK) assert_in_range(hits, sure / 5u, 4u * sure / 5u);
        if (c->alpha == MODEL_ALPHA_BLEND) assert_in_range(hits, sure / 2u, sure - sure / 40u);
        free(s.bytes);
    }
}

/* Behind a hole is the layer below; a tint that leaves nothing leaves nothing to hit. */
static void what_lies_behind_a_hole_is_hit(void **state)
{
    static const cut hole = { MODEL_ALPHA_MASK, 33071, 1, 0, 1.0f, 0.0f, 1.0f, 0.5f };
    static const cut veil = { MODEL_ALPHA_BLEND, 33071, 1, 0, 1.0f, 0.0f, 1.0f, 0.5f };
    static const uint8_t thin[4] = { 255, 255, 255, 128 }, gone[4] = { 255, 255, 255, 0 };
    uint8_t alphas[PICTURE_SIDE * PICTURE_SIDE];
    uint32_t layers[3] = { 0 };
    sheet s;
    noh_pick_hit hit;
    (void)state;
    cut_sheet_open(&s, &hole, 1);
    alphas_of(&s, &hole, alphas);
    for (uint32_t y = 0; y < PICTURE_SIDE; y++) {
        for (uint32_t x = 0; x < PICTURE_SIDE / 2u; x++) {
            const float at[2] = { 0.25f * ((float)x + 0.4f), 0.25f * ((float)y + 0.4f) };
            const int over = alphas[y * PICTURE_SIDE + PICTURE_SIDE - 1u - x] >= 128;
            const int under = alphas[y * PICTURE_SIDE + x] >= 128;
            const noh_result result = pick(&s, at[0], at[1], 3, 0, 0, -1, 100, &hit);
            if (at[0] > 0.99f) continue; /* steeper near the fold */
            assert_int_equal(result, over || under ? NOH_OK : NOH_ERR_NOT_FOUND);
            if (result == NOH_OK) assert_true(fabsf(hit.distance - (over ? 2.0f : 3.0f)) < 1e-5f);
            layers[over ? 0 : under ? 1 : 2]++;
        }
    }
    for (int i = 0; i < 3; i++) assert_true(layers[i] > 3);
    free(s.bytes);
    cut_sheet_open(&s, &veil, 0);
    assert_int_equal(pick(&s, 0.4f, 0.4f, 3, 0, 0, -1, 100, &hit), NOH_OK);
    s.surface.tint = thin;
    assert_int_equal(pick(&s, 0.4f, 0.4f, 3, 0, 0, -1, 100, &hit), NOH_OK);
    s.surface.tint = gone;
    assert_int_equal(pick(&s, 0.4f, 0.4f, 3, 0, 0, -1, 100, &hit), NOH_ERR_NOT_FOUND);
    free(s.bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rays_go_through_what_is_cut_away), cmocka_unit_test(what_lies_behind_a_hole_is_hit),
    cmocka_unit_test(a_hit_says_where_it_is),           cmocka_unit_test(a_ray_ends_at_its_distance),
    cmocka_unit_test(no_ray_slips_through_an_edge),     cmocka_unit_test(no_ray_slips_through_an_edge_askew),
    cmocka_unit_test(the_nearest_layer_is_hit),         cmocka_unit_test(placed_surfaces_are_hit_where_they_stand),
    cmocka_unit_test(the_joint_is_that_of_the_point),   cmocka_unit_test(what_a_far_joint_pulls_is_hit),
};

TEST_MAIN(tests, NULL, NULL)
