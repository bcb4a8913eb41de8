/* Tests of tools/convert/texture/texture_trim.c: what triangles read of a texture is there when the rest is taken out,
 * at the texture coordinates that were moved, with what filters reach; and what must stay whole does. */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "convert/lod/lod_levels.h"
#include "convert/model/model_build.h"
#include "convert/pack/texture_levels.h"
#include "convert/texture/texture_trim.h"

#define CLAMP 33071u
#define REACH 4 /* texels of a map's own, on each side, that are to stay */

/* A quad of two triangles, a submesh of its own: its corners in texture coordinates. */
typedef struct quad {
    float low[2], high[2];
    uint32_t material;
} quad;

static void add_texture(model *m, const char *name, uint32_t width, uint32_t height)
{
    model_texture *t = &m->textures[m->texture_count++];
    t->name = model_string(name);
    t->width = width;
    t->height = height;
    t->rgba = test_zeros((size_t)width * height * 4);
    for (uint32_t i = 0; i < width * height; i++) { /* no two are the same */
        const uint8_t texel[4] = { (uint8_t)i, (uint8_t)(i >> 8), (uint8_t)(i >> 16), 255 };
        memcpy(t->rgba + 4 * (size_t)i, texel, 4);
    }
}

static void add_quad(model_mesh *mesh, uint32_t i, const quad *q)
{
    static const uint32_t corners[6] = { 0, 1, 2, 2, 1, 3 };
    for (uint32_t k = 0; k < 4; k++) {
        mesh->uv[8 * i + 2 * k] = k & 1 ? q->high[0] : q->low[0];
        mesh->uv[8 * i + 2 * k + 1] = k & 2 ? q->high[1] : q->low[1];
    }
    for (uint32_t k = 0; k < 6; k++) mesh->indices[6 * i + k] = 4 * i + corners[k];
    mesh->submeshes[i] = (model_submesh){ 6 * i, 6, q->material, 4 * i, 4, 0 };
}

/* One mesh of the quads; materials without textures. */
static model *model_of(const quad *quads, uint32_t count, uint32_t material_count)
{
    model *m = model_new();
    model_mesh *mesh = test_zeros(sizeof *mesh);
    m->meshes = mesh;
    m->mesh_count = 1;
    m->textures = test_zeros(4 * sizeof *m->textures);
    m->materials = test_zeros(material_count * sizeof *m->materials);
    m->material_count = material_count;
    for (uint32_t i = 0; i < material_count; i++) m->materials[i] = model_material_default();
    mesh->vertex_count = 4 * count;
    mesh->index_count = 6 * count;
    mesh->submesh_count = count;
    mesh->uv = test_zeros(8 * sizeof *mesh->uv * count);
    mesh->indices = test_zeros(6 * sizeof *mesh->indices * count);
    mesh->submeshes = test_zeros(count * sizeof *mesh->submeshes);
    for (uint32_t i = 0; i < count; i++) add_quad(mesh, i, &quads[i]);
    return m;
}

static float *copy_of_uv(const model *m)
{
    const size_t bytes = 2 * sizeof *m->meshes[0].uv * m->meshes[0].vertex_count;
    float *uv = test_zeros(bytes);
    memcpy(uv, m->meshes[0].uv, bytes);
    return uv;
}

static texture_trimmed trim_it(model *m)
{
    texture_trimmed done;
    assert_int_equal(texture_trim(m, NULL, &done), 0);
    return done;
}

static int is_whole(const model_texture *t)
{
    return !t->cells[0] && !t->cells[1] && !texture_trim_word(t);
}

static uint32_t in_turn(int64_t at, uint32_t side)
{
    const int64_t in = at % (int64_t)side;
    return (uint32_t)(in < 0 ? in + (int64_t)side : in);
}

/* The trimmed texture, read about where the vertex is now, is the whole one about where it was. */
static void expect_same_about(const model_texture *t, const uint8_t *trimmed, const uint32_t side[2], const float *was,
                              const float *is)
{
    int64_t from[2], to[2];
    const uint32_t whole[2] = { t->width, t->height };
    for (size_t axis = 0; axis < 2; axis++) {
        const double old = (double)was[axis] * whole[axis], now = (double)is[axis] * side[axis];
        const double by = old - now; /* whole texels, but for rounding, so that filters weigh the same */
        assert_true(fabs(by - floor(by + 0.5)) < 1e-3);
        from[axis] = (int64_t)floor(old);
        to[axis] = from[axis] - (int64_t)floor(by + 0.5);
    }
    for (int64_t y = -REACH; y <= REACH; y++) {
        for (int64_t x = -REACH; x <= REACH; x++) {
            const size_t a = (size_t)in_turn(from[1] + y, whole[1]) * whole[0] + in_turn(from[0] + x, whole[0]);
            const size_t b = (size_t)in_turn(to[1] + y, side[1]) * side[0] + in_turn(to[0] + x, side[0]);
            assert_memory_equal(t->rgba + 4 * a, trimmed + 4 * b, 4);
        }
    }
}

/* All over triangles, of vertices whose texture coordinates were `was`. */
static void expect_same_over(const model *m, uint32_t texture, const float *was, const uint32_t *indices,
                             uint32_t count)
{
    const model_texture *t = &m->textures[texture];
    const model_mesh *mesh = &m->meshes[0];
    const size_t bytes = (size_t)t->width * t->height * 4;
    uint8_t *texels = test_zeros(bytes);
    uint32_t side[2] = { t->width, t->height };
    memcpy(texels, t->rgba, bytes);
    texture_trim_texels(t, texels, 4, &side[0], &side[1]);
    for (uint32_t i = 0; i < count; i += 3) {
        for (uint32_t k = 0; k < 36; k++) { /* fifths of the way between the corners */
            const uint32_t row = k / 6;
            const float a = (float)(k % 6) / 5.0f, b = (1.0f - a) * (float)row / 5.0f;
            const float share[3] = { a, b, 1.0f - a - b };
            float old[2] = { 0 }, now[2] = { 0 };
            for (size_t c = 0; c < 6; c++) {
                const size_t at = 2 * (size_t)indices[i + c / 2] + c % 2;
                old[c % 2] += share[c / 2] * was[at];
                now[c % 2] += share[c / 2] * mesh->uv[at];
            }
            expect_same_about(t, texels, side, old, now);
        }
    }
    free(texels);
}

static void expect_same_texels(const model *m, uint32_t texture, const float *was)
{
    expect_same_over(m, texture, was, m->meshes[0].indices, m->meshes[0].index_count);
}

static quad random_quad(test_random *r)
{
    quad q = { { 0 }, { 0 }, 0 };
    for (int axis = 0; axis < 2; axis++) {
        q.low[axis] = test_random_float(r, 0.0f, 0.95f);
        q.high[axis] = q.low[axis] + test_random_float(r, 0.0f, fminf(0.2f, 1.0f - q.low[axis]));
    }
    return q;
}

/* Three quads anywhere, with a large and a small map of different sides. */
static void what_triangles_read_stays(void **state)
{
    test_random r = test_random_from(1);
    uint32_t trimmed = 0;
    (void)state;
    for (int round = 0; round < 60; round++) {
        const quad quads[3] = { random_quad(&r), random_quad(&r), random_quad(&r) };
        model *m = model_of(quads, 3, 1);
        float *was = copy_of_uv(m);
        add_texture(m, "color", 512, 256);
        add_texture(m, "normal", 128, 128);
        m->materials[0].base_color_texture = 0;
        m->materials[0].normal_texture = 1;
        if (round & 1) m->textures[1].wrap_s = CLAMP;
        trimmed += trim_it(m).count;
        assert_int_equal(texture_trim_word(&m->textures[0]), texture_trim_word(&m->textures[1]));
        for (uint32_t t = 0; t < 2; t++) expect_same_texels(m, t, was);
        free(was);
        model_free(m);
    }
    assert_true(trimmed > 60);
}

/* One quad in a corner: little is left, and the report says how much. */
static void a_corner_is_all_that_is_left(void **state)
{
    static const quad quads[1] = { { { 0.26f, 0.51f }, { 0.49f, 0.74f }, 0 } };
    texture_trimmed done;
    model *m = model_of(quads, 1, 1);
    (void)state;
    add_texture(m, "color", 512, 512);
    m->materials[0].base_color_texture = 0;
    done = trim_it(m);
    assert_int_equal(done.count, 1);
    assert_true(done.whole == 512 * 512);
    assert_true(done.texels == 128 * 128); /* sixteen cells of eight texels each way, margins included */
    assert_float_equal(m->meshes[0].uv[0], 0.04f, 1e-5f);
    assert_float_equal(m->meshes[0].uv[1], 0.04f, 1e-5f);
    model_free(m);
}

/* Beyond 1 a texture that repeats comes in again on the other side; one that does not is left whole on that axis. */
static void beyond_one(void **state)
{
    static const quad across[1] = { { { 0.95f, -3.45f }, { 1.05f, -3.35f }, 0 } };
    static const quad wide[1] = { { { 0.2f, 0.2f }, { 1.3f, 0.3f }, 0 } };
    (void)state;
    for (int clamped = 0; clamped < 2; clamped++) {
        model *m = model_of(across, 1, 1);
        float *was = copy_of_uv(m);
        add_texture(m, "color", 256, 256);
        m->materials[0].base_color_texture = 0;
        if (clamped) m->textures[0].wrap_s = CLAMP;
        assert_int_equal(trim_it(m).count, 1);
        assert_int_equal(m->textures[0].cells[0] == 0, clamped);
        assert_int_not_equal(m->textures[0].cells[1], 0);
        if (clamped) assert_float_equal(m->meshes[0].uv[0], was[0], 0.0f);
        expect_same_texels(m, 0, was);
        free(was);
        model_free(m);
    }
    model *m = model_of(wide, 1, 1);
    add_texture(m, "color", 256, 256);
    m->materials[0].base_color_texture = 0;
    (void)trim_it(m);
    assert_int_equal(m->textures[0].cells[0], 0);
    assert_float_equal(m->meshes[0].uv[2], 1.3f, 0.0f);
    model_free(m);
}

/* Specular maps and masks of wrinkle regions lose what the other maps lose, though masks are read texel by texel. */
static void all_maps_are_trimmed(void **state)
{
    static const quad quads[1] = { { { 0.1f, 0.1f }, { 0.2f, 0.2f }, 0 } };
    model *m = model_of(quads, 1, 1);
    float *was = copy_of_uv(m);
    (void)state;
    add_texture(m, "specular", 256, 256);
    add_texture(m, "wrinkles", 256, 256);
    add_texture(m, "regions", 128, 128);
    m->materials[0].specular_texture = 0;
    m->materials[0].wrinkle_texture = 1;
    m->materials[0].more_textures[0] = 2;
    m->textures[2].use = MODEL_TEXTURE_CODES;
    m->textures[2].mag_filter = 9728;
    assert_int_equal(trim_it(m).count, 3);
    for (uint32_t t = 0; t < 3; t++) expect_same_texels(m, t, was);
    free(was);
    model_free(m);
}

/* A matcap is read by normals: it stays whole, whatever shares its name. */
static void a_matcap_stays_whole(void **state)
{
    static const quad quads[1] = { { { 0.1f, 0.1f }, { 0.2f, 0.2f }, 0 } };
    model *m = model_of(quads, 1, 1);
    (void)state;
    add_texture(m, "color", 256, 256);
    add_texture(m, "cap", 256, 256);
    m->materials[0].surface = NOH_SURFACE_TOON;
    m->materials[0].base_color_texture = 0;
    m->materials[0].more_textures[NOH_TOON_MATCAP] = 1;
    assert_int_equal(trim_it(m).count, 1);
    assert_int_equal(m->textures[1].cells[0], 0);
    model_free(m);
}

/* What one material reads of a common texture stays for the other, too; and so with a common vertex. */
static void materials_that_share_lose_the_same(void **state)
{
    static const quad quads[2] = { { { 0.1f, 0.1f }, { 0.2f, 0.2f }, 0 }, { { 0.7f, 0.8f }, { 0.8f, 0.9f }, 1 } };
    (void)state;
    for (int by_vertex = 0; by_vertex < 2; by_vertex++) {
        model *m = model_of(quads, 2, 2);
        float *was;
        if (by_vertex) m->meshes[0].indices[6] = 0; /* a triangle of the second goes over to the first */
        was = copy_of_uv(m);
        add_texture(m, "color", 256, 256);
        add_texture(m, "other", 256, 256);
        m->materials[0].base_color_texture = 0;
        m->materials[1].base_color_texture = by_vertex ? 1 : 0;
        m->materials[1].emissive_texture = 1;
        assert_int_equal(trim_it(m).count, 2);
        assert_int_equal(texture_trim_word(&m->textures[0]), texture_trim_word(&m->textures[1]));
        for (uint32_t t = 0; t < 2; t++) expect_same_texels(m, t, was);
        free(was);
        model_free(m);
    }
    model *m = model_of(quads, 2, 2);
    add_texture(m, "color", 256, 256);
    add_texture(m, "other", 256, 256);
    m->materials[0].base_color_texture = 0;
    m->materials[1].base_color_texture = 1;
    assert_int_equal(trim_it(m).count, 2);
    assert_int_not_equal(texture_trim_word(&m->textures[0]), texture_trim_word(&m->textures[1]));
    model_free(m);
}

/* A set for actors to wear goes with the texture that it replaces; what nothing reads else is whole. */
static void sets_go_with_their_namesakes(void **state)
{
    static const quad quads[1] = { { { 0.1f, 0.1f }, { 0.2f, 0.2f }, 0 } };
    model *m = model_of(quads, 1, 2);
    (void)state;
    add_texture(m, "coat", 256, 256);
    add_texture(m, "coat_red", 256, 256);
    add_texture(m, "sign", 256, 256);
    m->materials[0].base_color_texture = 0;
    m->materials[1].base_color_texture = 1;
    assert_int_equal(trim_it(m).count, 2);
    assert_int_equal(texture_trim_word(&m->textures[0]), texture_trim_word(&m->textures[1]));
    assert_true(is_whole(&m->textures[2]));
    model_free(m);
}

/* A model that is left as it is, after `change`. */
static void expect_whole(void (*change)(model *m))
{
    static const quad quads[1] = { { { 0.1f, 0.1f }, { 0.2f, 0.2f }, 0 } };
    for (int changed = 0; changed < 2; changed++) {
        model *m = model_of(quads, 1, 1);
        float *was;
        add_texture(m, "color", 256, 256);
        m->materials[0].base_color_texture = 0;
        if (changed) change(m);
        was = copy_of_uv(m);
        assert_int_equal(trim_it(m).count, changed ? 0 : 1); /* it is the change that does it */
        assert_int_equal(is_whole(&m->textures[0]), changed);
        if (changed) assert_memory_equal(was, m->meshes[0].uv, 8 * sizeof *was);
        free(was);
        model_free(m);
    }
}

static void move_uv(model *m)
{
    m->meshes[0].targets = test_zeros(sizeof *m->meshes[0].targets);
    m->meshes[0].targets[0].uv = test_zeros(8 * sizeof(float));
    m->meshes[0].target_count = 1;
}

static void make_eye(model *m)
{
    m->materials[0].surface = NOH_SURFACE_EYE;
}

static void make_nearest(model *m)
{
    m->textures[0].mag_filter = 9728;
}

static void make_no_number(model *m)
{
    m->meshes[0].uv[0] = m->meshes[0].uv[3] = NAN;
}

static void make_far(model *m)
{
    m->meshes[0].uv[0] = 1e30f;
    m->meshes[0].uv[1] = -INFINITY;
}

static void make_odd(model *m)
{
    m->textures[0].width = m->textures[0].height = 255; /* of 256 x 256 bytes */
}

static void make_large(model *m)
{
    m->meshes[0].uv[0] = m->meshes[0].uv[1] = 0.0f;
    m->meshes[0].uv[6] = m->meshes[0].uv[7] = 0.96f;
}

static void make_unread(model *m)
{
    m->meshes[0].submeshes[0].material = MODEL_NONE;
}

static void what_must_stay_whole(void **state)
{
    (void)state;
    expect_whole(move_uv);
    expect_whole(make_eye);
    expect_whole(make_nearest);
    expect_whole(make_no_number);
    expect_whole(make_far);
    expect_whole(make_odd);
    expect_whole(make_large);
    expect_whole(make_unread);
}

/* A triangle of a coarser level between two quads reads what lies between them. */
static void levels_count(void **state)
{
    static const quad quads[2] = { { { 0.1f, 0.1f }, { 0.15f, 0.15f }, 0 }, { { 0.8f, 0.1f }, { 0.85f, 0.15f }, 0 } };
    static uint32_t indices[3] = { 0, 5, 7 }, first[2] = { 0, 3 }, count[2] = { 3, 0 };
    static lod built;
    mesh_levels levels = { .count = 2, .built = &built, .which = { 0, 0 } };
    texture_trimmed done[2];
    (void)state;
    built.levels[0] = (lod_level){
        .indices = indices, .index_count = 3, .submesh_first = first, .submesh_count = count
    };
    for (int with = 0; with < 2; with++) {
        model *m = model_of(quads, 2, 1);
        add_texture(m, "color", 256, 256);
        m->materials[0].base_color_texture = 0;
        assert_int_equal(texture_trim(m, with ? &levels : NULL, &done[with]), 0);
        model_free(m);
    }
    assert_int_equal(done[1].count, 1);
    assert_true(done[1].texels > 4 * done[0].texels);
}

/* A level whose vertices are its own: no triangle of the full mesh has them. */
static void vertices_of_levels_move_too(void **state)
{
    static const quad quads[2] = { { { 0.30f, 0.40f }, { 0.35f, 0.45f }, 0 },
                                   { { 0.60f, 0.70f }, { 0.64f, 0.75f }, 0 } };
    static uint32_t indices[3] = { 4, 5, 6 }, first[1] = { 0 }, count[1] = { 3 };
    static lod built;
    mesh_levels levels = { .count = 2, .built = &built, .which = { 0, 0 } };
    model *m = model_of(quads, 2, 1);
    texture_trimmed done;
    float *was = copy_of_uv(m);
    (void)state;
    m->meshes[0].index_count = 6;
    m->meshes[0].submesh_count = 1;
    built.levels[0] = (lod_level){
        .indices = indices, .index_count = 3, .submesh_first = first, .submesh_count = count
    };
    add_texture(m, "color", 256, 256);
    m->materials[0].base_color_texture = 0;
    assert_int_equal(texture_trim(m, &levels, &done), 0);
    assert_int_equal(done.count, 1);
    expect_same_texels(m, 0, was);
    expect_same_over(m, 0, was, indices, 3);
    free(was);
    model_free(m);
}

static byte_buffer levels_of(const model_texture *t, noh_texture_header *h)
{
    byte_buffer out = { NULL, 0, 0, 0 };
    memset(h, 0, sizeof *h);
    assert_int_equal(texture_levels_write(t, h, &out), 0);
    return out;
}

/* Columns and rows of 8 texels have the mip levels of the whole texture down to one texel; so has a texture that is
 * halved first. */
static void mip_levels_are_those_of_the_whole_texture(void **state)
{
    static const quad quads[1] = { { { 0.26f, 0.51f }, { 0.49f, 0.74f }, 0 } };
    (void)state;
    for (uint32_t halvings = 0; halvings < 2; halvings++) {
        model *m = model_of(quads, 1, 1);
        noh_texture_header whole, trimmed;
        byte_buffer a, b;
        size_t at[2] = { 0, 0 };
        add_texture(m, "color", 512u << halvings, 512u << halvings);
        m->materials[0].base_color_texture = 0;
        m->textures[0].size_max = 512;
        a = levels_of(&m->textures[0], &whole);
        assert_int_equal(trim_it(m).count, 1);
        b = levels_of(&m->textures[0], &trimmed);
        assert_int_equal(whole.trim, 0);
        assert_int_not_equal(trimmed.trim, 0);
        assert_int_equal(trimmed.whole_width, 512);
        assert_int_equal(trimmed.whole_height, 512);
        assert_int_equal(trimmed.width, 128);
        assert_int_equal(trimmed.height, 128);
        for (uint32_t k = 0; k < 4; k++) { /* from 128, 256 on, the picture of the first cells */
            const size_t side = 128u >> k, row = 512u >> k, x = 128u >> k, y = 256u >> k;
            for (size_t i = 0; i < side; i++) {
                assert_memory_equal(a.bytes + at[0] + 4 * ((y + i) * row + x), b.bytes + at[1] + 4 * i * side,
                                    4 * side);
            }
            at[0] += 4 * row * row;
            at[1] += 4 * side * side;
        }
        buffer_free(&a);
        buffer_free(&b);
        model_free(m);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_triangles_read_stays),
    cmocka_unit_test(a_corner_is_all_that_is_left),
    cmocka_unit_test(beyond_one),
    cmocka_unit_test(all_maps_are_trimmed),
    cmocka_unit_test(a_matcap_stays_whole),
    cmocka_unit_test(materials_that_share_lose_the_same),
    cmocka_unit_test(sets_go_with_their_namesakes),
    cmocka_unit_test(what_must_stay_whole),
    cmocka_unit_test(levels_count),
    cmocka_unit_test(vertices_of_levels_move_too),
    cmocka_unit_test(mip_levels_are_those_of_the_whole_texture),
};

TEST_MAIN(tests, NULL, NULL)
