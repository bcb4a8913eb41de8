/* Haircuts: what the checker refuses, what grows out of a text, where strips lie, and how the control hairs of a wig
 * move. */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "life/hair/hair_internal.h"
#include "life/hair/haircut_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/pack.h"
#include "convert/model/hair_grow.h"
#include "core/pack/check_internal.h"

#define POINT_MAX (NOH_HAIRS_MAX * NOH_HAIR_POINTS_MAX)

typedef struct wig {
    hair_text text;
    hair_grown grown;
    uint8_t *bytes; /* of the chunk */
    uint32_t count;
    noh_pack_chunk chunk; /* at the pack's first byte */
    noh_pack pack;
    noh_haircut cut;
} wig;

static uint32_t append(wig *w, const void *data, size_t bytes)
{
    const uint32_t at = w->count;
    memcpy(w->bytes + at, data, bytes);
    w->count = (uint32_t)((at + bytes + 15u) & ~(size_t)15u);
    return at;
}

/* A head with hair to the shoulders, as a pack has it. */
static void open_wig(wig *w)
{
    static const hair_text text = { .skull = { 0.0f, 1.6f, 0.01f, 0.08f, 0.11f, 0.1f },
                                    .hairline = { 45.0f, 90.0f, 115.0f },
                                    .comb = { 0.0f, -0.5f, -0.85f },
                                    .length = { 0.35f, 0.3f },
                                    .lift = 0.01f,
                                    .around = 14.0f,
                                    .rows = 4.0f,
                                    .points = 12.0f,
                                    .sphere_count = 1,
                                    .spheres = { { 0.0f, 1.5f, -0.01f, 0.06f } } };
    noh_pack_hair_header h;
    memset(w, 0, sizeof *w);
    w->text = text;
    assert_int_equal(hair_grow(&w->text, &w->grown), 0);
    memset(&h, 0, sizeof h);
    h.joint_hash = noh_hash_name("");
    h.hair_count = w->grown.hair_count, h.point_count = w->grown.point_count;
    h.patch_count = w->grown.patch_count, h.sphere_count = w->grown.sphere_count;
    h.strip_count = 500, h.segment_count = 8, h.seed = 5;
    h.metres = 1.0f, h.pull = 0.4f, h.pull_at_tip = 0.02f, h.damping = 3.0f, h.gravity = 1.0f;
    h.width_root = h.width_tip = 0.004f, h.gloss = 1.0f;
    w->bytes = test_aligned(NULL, 1u << 20);
    memset(w->bytes, 0, 1u << 20);
    (void)append(w, &h, sizeof h);
    h.points_offset = append(w, w->grown.points, (size_t)h.hair_count * h.point_count * 12u);
    h.patches_offset = append(w, w->grown.patches, h.patch_count * 16u);
    h.spheres_offset = append(w, w->grown.spheres, h.sphere_count * 16u);
    memcpy(w->bytes, &h, sizeof h);
    w->pack.strings = "";
    w->pack.string_bytes = 1;
    w->pack.bytes = w->bytes;
    w->pack.chunks = &w->chunk;
    w->pack.runs[NOH_CHUNK_HAIR].count = 1;
    assert_int_equal(noh_haircut_open(&w->pack, &w->cut, NULL), NOH_OK);
}

static void close_wig(wig *w)
{
    free(w->bytes);
    hair_grown_free(&w->grown);
}

static noh_result checked(const wig *w, noh_error *error)
{
    noh_check check;
    memset(&check, 0, sizeof check);
    check.pack = &w->pack, check.bytes = w->bytes, check.count = w->count, check.error = error;
    return noh_check_hair(&check);
}

/* A damaged word of the chunk is reported at its offset. */
static void expect_refused(const wig *w, uint32_t at, uint32_t value)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    uint32_t before;
    memcpy(&before, w->bytes + at, 4);
    memcpy(w->bytes + at, &value, 4);
    if (checked(w, &error) != NOH_ERR_DATA || !error.what) fail_msg("word %u as %u is let through", at, value);
    memcpy(w->bytes + at, &before, 4);
}

static void forged_haircuts_are_refused(void **state)
{
    wig w;
    const uint32_t nan = 0x7fc00000u;
    (void)state;
    open_wig(&w);
    assert_int_equal(checked(&w, NULL), NOH_OK);
    expect_refused(&w, offsetof(noh_pack_hair_header, hair_count), 0);
    expect_refused(&w, offsetof(noh_pack_hair_header, hair_count), NOH_HAIRS_MAX + 1u);
    expect_refused(&w, offsetof(noh_pack_hair_header, point_count), 1);
    expect_refused(&w, offsetof(noh_pack_hair_header, strip_count), NOH_HAIR_STRIPS_MAX + 1u);
    expect_refused(&w, offsetof(noh_pack_hair_header, segment_count), 0);
    expect_refused(&w, offsetof(noh_pack_hair_header, points_offset), 64);
    expect_refused(&w, offsetof(noh_pack_hair_header, joint_hash), 1);
    for (uint32_t at = offsetof(noh_pack_hair_header, metres); at < sizeof(noh_pack_hair_header); at += 4u) {
        expect_refused(&w, at, nan);
    }
    expect_refused(&w, w.cut.header->points_offset + 4u, nan);
    expect_refused(&w, w.cut.header->patches_offset + 8u, w.cut.header->hair_count);
    expect_refused(&w, w.cut.header->spheres_offset + 12u, nan);
    memcpy(w.bytes + w.cut.header->points_offset + 12u, w.bytes + w.cut.header->points_offset, 12);
    assert_int_equal(checked(&w, NULL), NOH_ERR_DATA); /* two points at one place */
    close_wig(&w);
}

/* Counts are words of four bytes, low byte first, on every processor. The source's `long` has eight where most programs
 * are built today, and takes the word behind the count into it. */
static void counts_have_four_bytes(void **state)
{
    wig w;
    uint64_t as_long = 0;
    (void)state;
    open_wig(&w);
    const uint8_t *at = w.bytes + offsetof(noh_pack_hair_header, hair_count);
    for (uint32_t i = 8; i-- > 0;) as_long = as_long << 8 | at[i];
    assert_int_equal(at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24, w.grown.hair_count);
    assert_int_equal(w.cut.desc.hair_count, w.grown.hair_count);
    assert_int_equal(w.cut.desc.point_count, w.grown.point_count);
    assert_true(as_long != w.grown.hair_count && as_long > NOH_HAIRS_MAX);
    close_wig(&w);
}

/* Roots are within the skull's surface, all else is above it, and no hair is shorter or longer than the text says. */
static void hair_grows_on_the_skull(void **state)
{
    wig w;
    (void)state;
    open_wig(&w);
    const noh_pack_hair_header *h = w.cut.header;
    for (uint32_t i = 0; i < h->hair_count; i++) {
        double length = 0.0;
        for (uint32_t k = 0; k < h->point_count; k++) {
            const float *p = w.cut.desc.rest + 3u * (size_t)(i * h->point_count + k), *s = w.text.skull;
            double size = 0.0, way = 0.0;
            for (int c = 0; c < 3; c++) {
                size += pow((p[c] - s[c]) / s[3 + c], 2.0);
                if (k) way += pow(p[c] - p[c - 3], 2.0);
            }
            length += sqrt(way);
            assert_true(k ? sqrt(size) > 0.975 : fabs(sqrt(size) - 0.98) < 1e-4);
        }
        const double wanted = 0.35 - 0.05 * (double)(i / 14u) / 3.0;
        assert_true(length > 0.93 * wanted && length < 1.001 * wanted);
    }
    close_wig(&w);
}

static uint32_t mixed(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/* A strip is the mean of its corners' curves, by the weights of the same place in the patch all along; every patch has
 * places of its own. */
static void strips_lie_within_their_patch(void **state)
{
    wig w;
    (void)state;
    open_wig(&w);
    const noh_pack_hair_header *h = w.cut.header;
    for (uint32_t strip = 0; strip < h->strip_count; strip++) {
        const uint32_t patch = strip % h->patch_count, turn = strip / h->patch_count, own = mixed(patch + 1u);
        const uint32_t *corner = w.cut.patches + 4u * patch;
        const float u = (float)((turn * 0xc13fa9a9u + own) >> 8) / 16777216.0f;
        const float v = (float)((turn * 0x91e10da6u + mixed(own)) >> 8) / 16777216.0f;
        const float share[4] = { (1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v };
        float at[3], tangent[3], root[3] = { 0.0f, 0.0f, 0.0f };
        noh_haircut_vertex(&w.cut, w.cut.desc.rest, strip, 0.0f, at, tangent);
        for (int k = 0; k < 4; k++) {
            float p[3];
            noh_hair_curve(w.cut.desc.rest + 3u * (size_t)corner[k] * h->point_count, h->point_count, 0.0f, p);
            for (int c = 0; c < 3; c++) root[c] += share[k] * p[c];
        }
        for (int c = 0; c < 3; c++) assert_true(fabsf(at[c] - root[c]) < 1e-5f);
        assert_true(fabsf(tangent[0] * tangent[0] + tangent[1] * tangent[1] + tangent[2] * tangent[2] - 1.0f) < 1e-5f);
    }
    close_wig(&w);
}

/* The tangent is where the strip goes. */
static void tangents_follow_their_strips(void **state)
{
    wig w;
    (void)state;
    open_wig(&w);
    for (uint32_t strip = 0; strip < 200u; strip++) {
        float a[3], b[3], t[3], unused[3];
        double way = 0.0, along = 0.0;
        noh_haircut_vertex(&w.cut, w.cut.desc.rest, strip, 0.499f, a, unused);
        noh_haircut_vertex(&w.cut, w.cut.desc.rest, strip, 0.501f, b, unused);
        noh_haircut_vertex(&w.cut, w.cut.desc.rest, strip, 0.5f, unused, t);
        for (int c = 0; c < 3; c++) way += pow(b[c] - a[c], 2.0), along += (double)(b[c] - a[c]) * t[c];
        assert_true(along > 0.999 * sqrt(way));
    }
    close_wig(&w);
}

/* Strips stray across their line, evenly to all sides: a curl by its radius all round, scatter by no more than itself
 * each way; both grow from nothing at the root. */
static void strips_stray_across_their_line(void **state)
{
    wig w;
    (void)state;
    open_wig(&w);
    noh_pack_hair_header h = *w.cut.header;
    double sum[3] = { 0.0, 0.0, 0.0 }, most = 0.0;
    for (uint32_t i = 0; i < 2u * h.strip_count; i++) {
        const uint32_t strip = i / 2u;
        const float along = 0.1f * (float)(strip % 11u), amount = 0.02f;
        float line[3], at[3], t[3], off[3], length = 0.0f, lean = 0.0f;
        h.scatter = h.curl_radius = 0.0f;
        memcpy(w.bytes, &h, sizeof h);
        noh_haircut_vertex(&w.cut, w.cut.desc.rest, strip, along, line, t);
        h.scatter = i % 2u ? 0.0f : amount, h.curl_radius = i % 2u ? amount : 0.0f, h.curl_turns = 2.0f;
        memcpy(w.bytes, &h, sizeof h);
        noh_haircut_vertex(&w.cut, w.cut.desc.rest, strip, along, at, t);
        for (int c = 0; c < 3; c++) {
            off[c] = at[c] - line[c];
            length += off[c] * off[c], lean += off[c] * t[c];
            if (i % 2u == 0) sum[c] += (double)(off[c] / amount);
        }
        length = sqrtf(length);
        assert_true(fabsf(lean) < 2e-6f);
        if (i % 2u) assert_true(fabsf(length - amount * along) < 2e-6f);
        if (i % 2u == 0) assert_true(length < 1.4143f * amount * along + 2e-6f);
        if (i % 2u == 0 && along > 0.0f) most = fmax(most, (double)(length / (amount * along)));
    }
    for (int c = 0; c < 3; c++) assert_true(fabs(sum[c]) < 0.1 * h.strip_count);
    assert_true(most > 1.2);
    close_wig(&w);
}

static void fewer_strips_are_wider(void **state)
{
    wig w;
    uint32_t before = 0;
    (void)state;
    open_wig(&w);
    assert_int_equal(noh_haircut_strips(&w.cut, 0.0f), 0);
    assert_int_equal(noh_haircut_strips(&w.cut, 25.0f), 0);
    assert_int_equal(noh_haircut_strips(&w.cut, 1e9f), w.cut.header->strip_count);
    for (float pixels = 26.0f; pixels < 600.0f; pixels += 1.0f) {
        const uint32_t strips = noh_haircut_strips(&w.cut, pixels);
        assert_true(strips >= before && strips >= 1u && strips <= w.cut.header->strip_count);
        before = strips;
    }
    close_wig(&w);
}

/* The head turns twice about in two seconds: hair keeps its lengths and stays out of the head, and comes along. */
static void a_wig_comes_along(void **state)
{
    static float points[3u * POINT_MAX];
    noh_hair_carrier at = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }, { 0.0f, 0.0f, 0.0f } };
    double stretch = 0.0, depth = 0.0, off = 0.0;
    noh_hair *hair;
    wig w;
    (void)state;
    open_wig(&w);
    const noh_hair_desc *d = &w.cut.desc;
    void *memory = test_aligned(NULL, noh_hair_size(d));
    assert_int_equal(noh_hair_init(memory, noh_hair_size(d), d, &at, &hair, NULL), NOH_OK);
    for (uint32_t f = 1; f <= 600u; f++) {
        const double angle = f <= 120u ? 6.283185307179586 * 2.0 * f / 120.0 : 0.0;
        at.rotation[1] = (float)sin(0.5 * angle), at.rotation[3] = (float)cos(0.5 * angle);
        (void)noh_hair_step(hair, d, &at, 800u);
        noh_hair_points(hair, d, points);
        for (uint32_t i = 0; i < d->hair_count * d->point_count; i++) {
            double way = 0.0, rest = 0.0, apart = 0.0;
            for (uint32_t c = 0; c < 3u && i % d->point_count; c++) {
                way += pow(points[3u * i + c] - points[3u * (i - 1u) + c], 2.0);
                rest += pow(d->rest[3u * i + c] - d->rest[3u * (i - 1u) + c], 2.0);
            }
            for (uint32_t c = 0; c < 3u; c++) apart += pow(points[3u * i + c] - d->rest[3u * i + c], 2.0);
            if (rest > 0.0) stretch = fmax(stretch, fabs(sqrt(way / rest) - 1.0));
            if (f == 600u) off = fmax(off, sqrt(apart));
            for (uint32_t s = 0; s < d->sphere_count && i % d->point_count; s++) {
                const float *p = points + 3u * (size_t)i, *m = d->spheres[s].centre;
                const float *root = d->rest + 3u * (size_t)(i - i % d->point_count);
                const double r = fmin(d->spheres[s].radius,
                                      sqrt(pow(root[0] - m[0], 2) + pow(root[1] - m[1], 2) + pow(root[2] - m[2], 2)));
                depth = fmax(depth, r - sqrt(pow(p[0] - m[0], 2) + pow(p[1] - m[1], 2) + pow(p[2] - m[2], 2)));
            }
        }
    }
    printf("# stretch %.2e, deepest %.3f mm, off its rest after eight seconds %.1f mm\n", stretch, 1e3 * depth,
           1e3 * off);
    assert_true(stretch <= 1e-3);
    assert_true(depth <= 1e-3);
    assert_true(off < 0.08);
    free(memory);
    close_wig(&w);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(counts_have_four_bytes),
    cmocka_unit_test(forged_haircuts_are_refused),
    cmocka_unit_test(hair_grows_on_the_skull),
    cmocka_unit_test(strips_lie_within_their_patch),
    cmocka_unit_test(tangents_follow_their_strips),
    cmocka_unit_test(strips_stray_across_their_line),
    cmocka_unit_test(fewer_strips_are_wider),
    cmocka_unit_test(a_wig_comes_along),
};

TEST_MAIN(tests, NULL, NULL)
