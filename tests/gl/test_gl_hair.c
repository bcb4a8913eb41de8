/* Hair, lashes and brows with alpha from 8 angles (NOH_LONG: 24): the opaque core and the blended fringe of
 * noh_gl_draw_mesh against what blends in the right order at each pixel. Compared with orders of whole triangles: from
 * the farthest, from the nearest, as stored. */
#include "support/peel.h"
#include "support/renderer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model_build.h"
#include "draw/camera.h"

#define SIDE 256u
#define ANGLES 24u
#define WRONG 40 /* of 255 in a channel: a strand in front of what hides it */

static const float identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };

typedef struct head {
    gpu *g;
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    noh_mesh_header header; /* of `other` */
    noh_mesh other;         /* the same without what blends, or with that alone, each triangle a submesh */
    noh_gl_renderer renderer;
    noh_gl_texture pictures[16];
    peel peel;
    noh_gl_camera camera;
} head;

static int blends(const noh_pack *pack, const noh_submesh *s)
{
    return s->material != NOH_NONE && (pack->materials[s->material].flags & NOH_MATERIAL_BLEND);
}

/* ---- sorting ---- */

typedef struct ranked {
    float depth;
    noh_submesh triangle;
} ranked;

static int by_depth(const void *a, const void *b)
{
    const float x = ((const ranked *)a)->depth, y = ((const ranked *)b)->depth;
    return (x < y) - (x > y);
}

/* The clip w of a triangle's middle, three times. */
static float depth_of(const head *h, uint32_t first_index)
{
    const float *row = h->camera.view_projection;
    float depth = 0.0f;
    for (uint32_t c = 0; c < 3; c++) {
        const uint32_t vertex = ((const uint16_t *)(const void *)h->mesh.indices)[first_index + c];
        const float *p = h->mesh.positions + 3u * vertex;
        depth += row[3] * p[0] + row[7] * p[1] + row[11] * p[2];
    }
    return depth;
}

typedef enum way { AS_DRAWN, FARTHEST_FIRST, NEAREST_FIRST, AS_STORED, WAYS } way;

/* Every triangle of what blends. Returns how many. */
static uint32_t list_triangles(const head *h, way by, noh_submesh *out)
{
    ranked *list = test_zeros((h->mesh.header->index_count / 3u) * sizeof *list);
    uint32_t count = 0;
    for (uint32_t i = 0; i < h->mesh.header->submesh_count; i++) {
        const noh_submesh *s = &h->mesh.submeshes[i];
        for (uint32_t t = 0; blends(&h->pack, s) && t < s->index_count; t += 3) {
            list[count].triangle = *s;
            list[count].triangle.first_index += t;
            list[count].triangle.index_count = 3;
            list[count].depth = (by == NEAREST_FIRST ? -1.0f : 1.0f) * depth_of(h, s->first_index + t);
            count++;
        }
    }
    if (by != AS_STORED) qsort(list, count, sizeof *list, by_depth);
    for (uint32_t t = 0; t < count; t++) out[t] = list[t].triangle;
    free(list);
    return count;
}

/* The submeshes that blend, or the others. */
static uint32_t list_submeshes(const head *h, int blended, noh_submesh *out)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < h->mesh.header->submesh_count; i++) {
        if (blends(&h->pack, &h->mesh.submeshes[i]) == blended) out[count++] = h->mesh.submeshes[i];
    }
    return count;
}

/* ---- drawing ---- */

static void draw(head *h, const noh_mesh *of, int pass)
{
    noh_gl_mesh mesh;
    assert_int_equal(noh_gl_mesh_create(&h->g->gl, &h->g->ledger, of, &mesh, NULL), NOH_OK);
    noh_gl_draw_begin(&h->renderer, &h->camera);
    noh_gl_draw_mesh(&h->renderer, &mesh, identity, NULL, NULL, NULL, h->pictures, pass);
    noh_gl_draw_end(&h->renderer);
    noh_gl_mesh_delete(&h->g->gl, &h->g->ledger, &mesh);
}

/* What is opaque. h->other is then what blends, in h->other.submeshes, to be freed. */
static void draw_opaque(head *h)
{
    noh_submesh *list = test_zeros(h->mesh.header->index_count / 3u * sizeof *list);
    h->other.submeshes = list;
    h->header.submesh_count = list_submeshes(h, 0, list);
    draw(h, &h->other, NOH_DRAW_OPAQUE);
    h->header.submesh_count = list_submeshes(h, 1, list);
}

static uint8_t *picture(head *h, way by)
{
    peel_begin(&h->peel);
    if (by == AS_DRAWN) {
        draw(h, &h->mesh, NOH_DRAW_OPAQUE);
        draw(h, &h->mesh, NOH_DRAW_BLENDED);
    } else { /* each triangle by itself, so that no core is drawn */
        draw_opaque(h);
        h->header.submesh_count = list_triangles(h, by, (noh_submesh *)(uintptr_t)h->other.submeshes);
        draw(h, &h->other, NOH_DRAW_BLENDED);
        free((void *)(uintptr_t)h->other.submeshes);
    }
    return peel_read(&h->peel);
}

/* In the right order at each pixel. */
static uint8_t *reference(head *h)
{
    uint8_t *rgba;
    peel_begin(&h->peel);
    draw_opaque(h);
    rgba = peel_picture(&h->peel, &h->other, &h->camera, h->pictures);
    free((void *)(uintptr_t)h->other.submeshes);
    return rgba;
}

/* ---- the head ---- */

static void open_head(head *h, model *m)
{
    noh_gl_renderer_desc desc;
    size_t count;
    memset(h, 0, sizeof *h);
    h->g = fixture_gpu();
    const noh_gl_device device = { &h->g->gl, &h->g->caps, &h->g->ledger, NULL, 0 };
    h->bytes = test_pack_of(m, &count, NULL);
    model_free(m);
    h->pack = test_open(h->bytes, count);
    h->mesh = h->other = test_mesh(&h->pack, 0);
    h->header = *h->mesh.header;
    h->other.header = &h->header;
    assert_int_equal(h->header.index_bytes, 2);
    memset(&desc, 0, sizeof desc);
    desc.meshes = &h->mesh;
    desc.mesh_count = 1;
    assert_int_equal(renderer_create(&device, &desc, &h->renderer, NULL), NOH_OK);
    assert_in_range(h->pack.runs[NOH_CHUNK_TEXTURE].count, 1, 16);
    for (uint32_t i = 0; i < h->pack.runs[NOH_CHUNK_TEXTURE].count; i++) {
        noh_texture texture;
        assert_int_equal(noh_pack_texture_at(&h->pack, i, &texture, NULL), NOH_OK);
        assert_int_equal(noh_gl_picture_create(&h->g->gl, &h->g->ledger, &texture, &h->pictures[i], NULL), NOH_OK);
    }
    peel_open(&h->peel, h->g, &h->mesh, SIDE);
}

static void close_head(head *h)
{
    peel_close(&h->peel);
    noh_gl_renderer_delete(&h->renderer);
    for (uint32_t i = 0; i < h->pack.runs[NOH_CHUNK_TEXTURE].count; i++) {
        noh_gl_texture_delete(&h->g->gl, &h->g->ledger, &h->pictures[i]);
    }
    free(h->bytes);
}

/* Eight around, from below, level and above. */
static void look(head *h, uint32_t angle)
{
    const noh_mesh_header *m = h->mesh.header;
    bounds box;
    orbit o;
    for (int i = 0; i < 3; i++) {
        box.low[i] = (double)m->bounds_min[i];
        box.high[i] = (double)m->bounds_max[i];
    }
    o = orbit_fit(&box, 1.0, 0.0);
    o.azimuth = 0.7853981633974483 * (angle % 8u);
    o.elevation = 0.5 * ((double)(angle / 8u) - 1.0);
    o.distance *= 0.8;
    orbit_camera(&o, &h->camera);
}

typedef struct tally {
    uint32_t wrong[WAYS]; /* pixels of all angles that are off by more than WRONG */
    int worst[WAYS];
    uint32_t layers; /* the most at any pixel */
    uint32_t every;  /* one of how many of the angles was drawn */
} tally;

static tally all_angles(head *h)
{
    static const char *const names[] = { "as drawn", "from the farthest", "from the nearest", "as stored" };
    tally t;
    memset(&t, 0, sizeof t);
    t.every = getenv("NOH_LONG") ? 1 : 3; /* every third looks from each side and from each height */
    for (uint32_t angle = 0; angle < ANGLES; angle += t.every) {
        uint8_t *right;
        look(h, angle);
        right = reference(h);
        t.layers = h->peel.layers > t.layers ? h->peel.layers : t.layers;
        for (int by = 0; by < WAYS; by++) {
            uint8_t *rgba = picture(h, (way)by);
            t.wrong[by] += peel_wrong(&h->peel, rgba, right, WRONG, &t.worst[by]);
            free(rgba);
        }
        free(right);
    }
    printf("# %u layers; of %u pixels off by more than %d of 255:", t.layers, ANGLES / t.every * SIDE * SIDE, WRONG);
    for (int by = 0; by < WAYS; by++)
        printf("%s %s %u, at most %d", by ? ";" : "", names[by], t.wrong[by], t.worst[by]);
    printf("\n");
    return t;
}

/* ---- a wig ---- */

#define CARDS 160u
#define STRAND_PX 64u

/* Strands side by side, opaque along their middle, clear between, thinner towards the tip: narrower, or soft all
 * over. */
static void fill_strands(model *m, int soft)
{
    model_texture *t = m->textures = test_zeros(sizeof *m->textures);
    m->texture_count = 1;
    t->name = model_string("strands");
    t->width = t->height = STRAND_PX;
    t->rgba = test_zeros(4u * STRAND_PX * STRAND_PX);
    t->with_alpha = 1;
    t->wrap_s = t->wrap_t = 33071;
    for (uint32_t i = 0; i < STRAND_PX * STRAND_PX; i++) {
        const double x = (i % STRAND_PX + 0.5) / STRAND_PX, y = (double)(i / STRAND_PX) / STRAND_PX;
        const double middle = 0.5 - 0.5 * cos(6.283185307179586 * 4.0 * x); /* of a strand: 1 */
        const double alpha = soft ? 1.6 * middle * (1.0 - 0.6 * y) : 4.0 * (middle - 0.2 - 0.5 * y);
        memset(t->rgba + 4u * i, 255, 3);
        t->rgba[4u * i + 3u] = (uint8_t)(255.0 * fmax(fmin(alpha, 1.0), 0.0));
    }
}

static void fill_materials(model *m)
{
    m->material_count = 2;
    m->materials = test_zeros(2 * sizeof *m->materials);
    for (uint32_t i = 0; i < 2; i++) {
        m->materials[i] = model_material_default();
        m->materials[i].name = model_string(i ? "hair" : "scalp");
        m->materials[i].double_sided = 1;
        m->materials[i].roughness = 0.8f;
    }
    m->materials[1].base_color_texture = 0;
    m->materials[1].alpha = MODEL_ALPHA_BLEND;
}

/* A card about a direction of the ball, at its own height and turned its own way, so that cards cross. */
static void fill_card(model_mesh *mesh, uint32_t card, test_random *r)
{
    const float up = test_random_float(r, -0.9f, 0.9f), around = test_random_float(r, 0.0f, 6.2832f);
    const float side = sqrtf(1.0f - up * up), turn = test_random_float(r, -0.7f, 0.7f);
    const float out[3] = { side * cosf(around), up, side * sinf(around) };
    const float east[3] = { -sinf(around), 0.0f, cosf(around) };
    const float north[3] = { -up * cosf(around), side, -up * sinf(around) };
    const float height = test_random_float(r, 1.03f, 1.35f), tint = test_random_float(r, 0.03f, 0.6f);
    for (uint32_t c = 0; c < 4; c++) {
        const uint32_t v = 4u * card + c;
        const float x = c % 2u ? 0.25f : -0.25f, y = c / 2u ? 0.5f : -0.5f;
        const float e = x * cosf(turn) - y * sinf(turn), n = x * sinf(turn) + y * cosf(turn);
        mesh->uv[2u * v] = c % 2u ? 1.0f : 0.0f;
        mesh->uv[2u * v + 1u] = c / 2u ? 0.0f : 1.0f;
        for (uint32_t k = 0; k < 3; k++) {
            mesh->position[3u * v + k] = height * out[k] + e * east[k] + n * north[k];
            mesh->normal[3u * v + k] = out[k];
            mesh->color[4u * v + k] = tint * (1.0f - 0.25f * (float)k);
        }
    }
}

/* The ball inside, of the vertices that are left. */
static void fill_ball(model_mesh *mesh, uint32_t first, uint32_t side)
{
    for (uint32_t i = 0; i < side * side; i++) {
        const float a = 6.2832f * (float)(i % side) / (float)(side - 1u);
        const float b = 3.1416f * (float)(i / side) / (float)(side - 1u);
        const float at[3] = { sinf(b) * cosf(a), cosf(b), sinf(b) * sinf(a) };
        memcpy(mesh->position + 3u * (first + i), at, sizeof at);
        memcpy(mesh->normal + 3u * (first + i), at, sizeof at);
    }
}

/* Quads of four vertices, or of a grid. Returns behind the last index. */
static uint32_t *add_quad(uint32_t *to, uint32_t v, uint32_t row)
{
    const uint32_t quad[6] = { v, v + 1u, v + row, v + row, v + 1u, v + row + 1u };
    memcpy(to, quad, sizeof quad);
    return to + 6;
}

/* A ball with crossing cards of dark and light strands, in an order that has nothing to do with where they are. */
static model *make_wig(int soft)
{
    const test_model_desc desc = { 1, 32, 0, TEST_UVS | TEST_COLORS, 1 };
    const uint32_t first = 4u * CARDS, side = 19;
    test_random r = test_random_from(24);
    model *m = test_model(&desc);
    model_mesh *mesh = &m->meshes[0];
    uint32_t *at = mesh->indices;
    mesh->vertex_count = first + side * side;
    for (uint32_t v = 0; v < 4u * mesh->vertex_count; v++) mesh->color[v] = 1.0f;
    for (uint32_t c = 0; c < CARDS; c++) fill_card(mesh, c, &r);
    fill_ball(mesh, first, side);
    for (uint32_t i = 0; i < (side - 1u) * (side - 1u); i++) {
        at = add_quad(at, first + i / (side - 1u) * side + i % (side - 1u), side);
    }
    free(mesh->submeshes);
    mesh->submesh_count = 2;
    mesh->submeshes = test_zeros(2 * sizeof *mesh->submeshes);
    mesh->submeshes[0].index_count = mesh->submeshes[1].first_index = (uint32_t)(at - mesh->indices);
    mesh->submeshes[0].first_vertex = first;
    mesh->submeshes[0].vertex_count = mesh->vertex_count - first;
    for (uint32_t c = 0; c < CARDS; c++) at = add_quad(at, 4u * c, 2);
    mesh->submeshes[1].index_count = 6u * CARDS;
    mesh->submeshes[1].vertex_count = first;
    mesh->submeshes[1].material = 1;
    mesh->submeshes[0].material = 0;
    mesh->index_count = (uint32_t)(at - mesh->indices);
    fill_strands(m, soft);
    fill_materials(m);
    return m;
}

/* Pixels of all angles. An order of triangles that is wrong, from the nearest or as stored, has to fail clearly. */
static void check_orders(const tally *t, uint32_t wrong_of_all, uint32_t times)
{
    const uint32_t wrong_max = wrong_of_all / t->every;
    assert_true(t->wrong[AS_DRAWN] <= wrong_max);
    assert_true(t->wrong[AS_STORED] >= times * wrong_max);
    assert_true(t->wrong[NEAREST_FIRST] >= times * wrong_max);
}

static tally wig_from_all_angles(int soft)
{
    head h;
    tally t;
    open_head(&h, make_wig(soft));
    t = all_angles(&h);
    close_head(&h);
    fixture_expect_no_errors();
    return t;
}

static void cards_that_cross_are_in_order(void **state)
{
    const tally t = wig_from_all_angles(0);
    (void)state;
    check_orders(&t, 4500, 3);
}

/* Towards their tips they have no core, and the order is the stored one. */
static void soft_cards_are_nearly_in_order(void **state)
{
    const tally t = wig_from_all_angles(1);
    (void)state;
    check_orders(&t, 5500, 2);
}

static void strands_are_in_order_from_all_sides(void **state)
{
    const char *path = test_asset("hero/head_skin.glb");
    model_error error;
    model *m;
    head h;
    tally t;
    (void)state;
    if (model_read_gltf(path, &m, &error)) fail_msg("%s: %s", error.where, error.what);
    open_head(&h, m);
    t = all_angles(&h);
    close_head(&h);
    fixture_expect_no_errors();
    check_orders(&t, 16, 10);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(cards_that_cross_are_in_order),
    cmocka_unit_test(soft_cards_are_nearly_in_order),
    cmocka_unit_test(strands_are_in_order_from_all_sides),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
