/* Hair, lashes and brows with alpha from 24 angles: the opaque core and the blended fringe of noh_gl_draw_mesh against
 * triangles sorted on the CPU, back to front, at each angle. */
#include "support/gl_fixture.h"
#include "support/renderer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/model/model.h"
#include "draw/camera.h"
#include "gpu/canvas.h"

#define SIDE 256u
#define ANGLES 24u
#define WRONG 40 /* of 255 in a channel: a strand in front of what hides it */
/* Of 24 pictures. Triangles that cross have no order as wholes, so sorting them breaks strands that a depth test does
 * not: these pixels are the reference's. */
#define WRONG_PIXELS 300u

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
    canvas canvas;
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

/* Every triangle of what blends, the farthest first; in stored order without `sorted`. Returns how many. */
static uint32_t list_triangles(const head *h, int sorted, noh_submesh *out)
{
    ranked *list = test_zeros((h->mesh.header->index_count / 3u) * sizeof *list);
    uint32_t count = 0;
    for (uint32_t i = 0; i < h->mesh.header->submesh_count; i++) {
        const noh_submesh *s = &h->mesh.submeshes[i];
        for (uint32_t t = 0; blends(&h->pack, s) && t < s->index_count; t += 3) {
            list[count].triangle = *s;
            list[count].triangle.first_index += t;
            list[count].triangle.index_count = 3;
            list[count].depth = depth_of(h, s->first_index + t);
            count++;
        }
    }
    if (sorted) qsort(list, count, sizeof *list, by_depth);
    for (uint32_t t = 0; t < count; t++) out[t] = list[t].triangle;
    free(list);
    return count;
}

static uint32_t list_opaque(const head *h, noh_submesh *out)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < h->mesh.header->submesh_count; i++) {
        if (!blends(&h->pack, &h->mesh.submeshes[i])) out[count++] = h->mesh.submeshes[i];
    }
    return count;
}

/* ---- drawing ---- */

static void draw(head *h, const noh_mesh *of, int pass)
{
    noh_gl_mesh mesh;
    assert_int_equal(noh_gl_mesh_create(&h->g->gl, &h->g->ledger, of, &mesh, NULL), NOH_OK);
    h->g->gl.BindFramebuffer(GL_FRAMEBUFFER, h->canvas.framebuffer);
    noh_gl_draw_begin(&h->renderer, &h->camera);
    noh_gl_draw_mesh(&h->renderer, &mesh, identity, NULL, NULL, NULL, h->pictures, pass);
    noh_gl_draw_end(&h->renderer);
    noh_gl_mesh_delete(&h->g->gl, &h->g->ledger, &mesh);
}

typedef enum way { AS_DRAWN, SORTED, STORED_ORDER } way;

/* By hand: what is opaque, then each triangle of what blends by itself, so that no core is drawn. */
static void draw_by_hand(head *h, way by)
{
    noh_submesh *list = test_zeros(h->mesh.header->index_count / 3u * sizeof *list);
    h->other.submeshes = list;
    h->header.submesh_count = list_opaque(h, list);
    draw(h, &h->other, NOH_DRAW_OPAQUE);
    h->header.submesh_count = list_triangles(h, by == SORTED, list);
    draw(h, &h->other, NOH_DRAW_BLENDED);
    free(list);
}

static uint8_t *picture(head *h, way by)
{
    uint8_t *rgba = test_zeros(SIDE * SIDE * 4u);
    canvas_begin(&h->canvas);
    if (by == AS_DRAWN) {
        draw(h, &h->mesh, NOH_DRAW_OPAQUE);
        draw(h, &h->mesh, NOH_DRAW_BLENDED);
    } else {
        draw_by_hand(h, by);
    }
    canvas_resolve(&h->canvas);
    assert_int_equal(canvas_read(&h->canvas, rgba), 0);
    return rgba;
}

/* ---- the head ---- */

static void open_head(head *h, const char *path)
{
    const noh_gl_device device = { &h->g->gl, &h->g->caps, &h->g->ledger, NULL, 0 };
    noh_gl_renderer_desc desc;
    model_error error;
    model *m;
    size_t count;
    if (model_read_gltf(path, &m, &error)) fail_msg("%s: %s", error.where, error.what);
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
    assert_in_range(h->pack.texture_count, 1, 16);
    for (uint32_t i = 0; i < h->pack.texture_count; i++) {
        noh_texture texture;
        assert_int_equal(noh_pack_texture_at(&h->pack, i, &texture, NULL), NOH_OK);
        assert_int_equal(noh_gl_picture_create(&h->g->gl, &h->g->ledger, &texture, &h->pictures[i], NULL), NOH_OK);
    }
    assert_int_equal(canvas_open(&h->canvas, h->g, SIDE, SIDE), 0);
}

static void close_head(head *h)
{
    canvas_close(&h->canvas);
    noh_gl_renderer_delete(&h->renderer);
    for (uint32_t i = 0; i < h->pack.texture_count; i++) {
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
    o = orbit_fit(&box, 1.0);
    o.azimuth = 0.7853981633974483 * (angle % 8u);
    o.elevation = 0.5 * ((double)(angle / 8u) - 1.0);
    o.distance *= 0.8;
    orbit_camera(&o, &h->camera);
}

/* Pixels with a channel that is off by more than WRONG; *worst: the largest difference. */
static uint32_t wrong_pixels(const uint8_t *a, const uint8_t *b, int *worst)
{
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        int off = 0;
        for (int c = 0; c < 3; c++) {
            const int d = abs(a[4u * i + (uint32_t)c] - b[4u * i + (uint32_t)c]);
            off = d > off ? d : off;
        }
        wrong += off > WRONG;
        *worst = off > *worst ? off : *worst;
    }
    return wrong;
}

static void strands_are_in_order_from_24_angles(void **state)
{
    const char *path = test_asset("hero/head_skin.glb");
    head h;
    uint32_t wrong = 0, stored = 0;
    int worst = 0, worst_stored = 0;
    (void)state;
    memset(&h, 0, sizeof h);
    h.g = fixture_gpu();
    open_head(&h, path);
    for (uint32_t angle = 0; angle < ANGLES; angle++) {
        uint8_t *two, *sorted, *as_stored;
        look(&h, angle);
        two = picture(&h, AS_DRAWN);
        sorted = picture(&h, SORTED);
        as_stored = picture(&h, STORED_ORDER);
        wrong += wrong_pixels(two, sorted, &worst);
        stored += wrong_pixels(as_stored, sorted, &worst_stored);
        free(two);
        free(sorted);
        free(as_stored);
    }
    printf("# off by more than %d of 255: %u pixels, at most %d; in stored order %u, at most %d\n", WRONG, wrong, worst,
           stored, worst_stored);
    close_head(&h);
    fixture_expect_no_errors();
    assert_true(wrong <= WRONG_PIXELS);
    assert_true(2u * wrong < stored);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(strands_are_in_order_from_24_angles),
};

TEST_MAIN(tests, NULL, fixture_tear_down)
