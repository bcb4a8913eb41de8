/* Lips of real heads, measured on vertices as the library deforms them: they meet for every p, b and m, and the lower
 * one is at the upper teeth for f and v, for long enough that every phase of 30 Hz shows it, between any two sounds,
 * whatever the emotion and whatever the face. */
#include "deform/morph/morph_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/face.h"
#include "noh/pack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "support/support.h"

#define MS 48u
#define PAIRS 64u
#define LINKS 512u

/* A vertex of the lower lip and one of the upper lip that touch at rest. */
typedef struct seam_pair {
    uint32_t low, up;
} seam_pair;

typedef struct head {
    uint8_t *bytes;
    noh_pack pack;
    noh_mesh mesh;
    noh_morph_layers layers;
    void *memory;
    float *rest; /* [vertex_count][3] */
    uint32_t *island, skin;
    noh_face_link links[LINKS];
    uint32_t link_count;
    seam_pair pairs[PAIRS];
    uint32_t pair_count;
    uint32_t (*teeth)[3], tooth_count; /* triangles that the jaw does not move and no skin is, near the mouth */
    noh_identity identity;
    void *people;
} head;

static void accumulate(const head *h, const float *weights)
{
    noh_morph_layers layers;
    (void)noh_morph_layers_init(h->memory, noh_morph_layers_size(&h->mesh), &h->mesh, &layers, NULL); /* cleared */
    noh_morph_accumulate(&h->mesh, weights, &h->layers);
}

static void deform(const head *h, uint32_t vertex, float out[3])
{
    noh_morph_position(&h->mesh, &h->layers, vertex, out);
}

static float apart(const float *a, const float *b)
{
    return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static float *positions(const head *h, const float *weights)
{
    float *out = test_zeros(3u * sizeof *out * h->mesh.header->vertex_count);
    accumulate(h, weights);
    for (uint32_t v = 0; v < h->mesh.header->vertex_count; v++) deform(h, v, out + 3 * v);
    return out;
}

static void bind(head *h)
{
    const noh_face_recipe own = noh_face_recipe_in_pack(&h->pack);
    const noh_face_recipe *const recipes[2] = { &own, &noh_face_recipe_units };
    const char *names[NOH_TARGETS_MAX];
    const uint32_t count = h->mesh.header->target_count;
    for (uint32_t i = 0; i < count; i++) names[i] = noh_pack_string(h->mesh.pack, h->mesh.targets[i].name);
    h->link_count = noh_face_recipe_bind(recipes, 2, names, count, h->links, LINKS);
    assert_true(h->link_count > 20 && h->link_count <= LINKS);
}

static uint32_t index_at(const head *h, uint32_t i)
{
    return h->mesh.header->index_bytes == 2 ? ((const uint16_t *)h->mesh.indices)[i]
                                            : ((const uint32_t *)h->mesh.indices)[i];
}

static uint32_t root_of(const uint32_t *parent, uint32_t v)
{
    while (parent[v] != v) v = parent[v];
    return v;
}

static void unite(uint32_t *parent, uint32_t a, uint32_t b)
{
    parent[root_of(parent, a)] = root_of(parent, b);
}

/* What hangs together, by triangles and by place. */
static void find_islands(head *h)
{
    const uint32_t count = h->mesh.header->vertex_count;
    h->island = test_zeros(count * sizeof *h->island);
    for (uint32_t v = 0; v < count; v++) h->island[v] = v;
    for (uint32_t i = 0; i < h->mesh.header->index_count; i++)
        unite(h->island, index_at(h, i), index_at(h, i - i % 3u));
    for (uint32_t v = 0; v < count; v++) {
        for (uint32_t u = 0; u < v; u++) {
            if (memcmp(h->rest + 3 * u, h->rest + 3 * v, 12) == 0) unite(h->island, u, v);
        }
    }
    for (uint32_t v = 0; v < count; v++) h->island[v] = root_of(h->island, v);
}

/* The island with the vertex that the open jaw moves the farthest. */
static int is_skin(const head *h, uint32_t vertex)
{
    return h->island[vertex] == h->skin;
}

/* A corner of a tooth: no skin, does not move, and is at most 20 mm from the lips. */
static int is_tooth(const head *h, const float *open, float most, uint32_t v)
{
    float way = 1.0f;
    if (is_skin(h, v) || apart(open + 3 * v, h->rest + 3 * v) > 0.02f * most) return 0;
    for (uint32_t p = 0; p < h->pair_count; p++)
        way = fminf(way, apart(h->rest + 3 * v, h->rest + 3 * h->pairs[p].low));
    return way < 0.02f;
}

/* Lower lip: what an open jaw takes along, in the middle of the mouth; upper lip: what stays. Pairs are each other's
 * nearest across the mouth, and touch at rest. */
static void find_lips(head *h, const char *jaw)
{
    const uint32_t count = h->mesh.header->vertex_count, target = noh_mesh_find_target(&h->mesh, jaw);
    float weights[NOH_TARGETS_MAX] = { 0 }, *open, most = 0.0f;
    uint8_t *kind = test_zeros(count);
    assert_true(target != NOH_NONE);
    weights[target] = 1.0f;
    open = positions(h, weights);
    find_islands(h);
    for (uint32_t v = 0; v < count; v++) {
        const float moved = apart(open + 3 * v, h->rest + 3 * v);
        if (moved > most) most = moved, h->skin = h->island[v];
    }
    for (uint32_t v = 0; v < count; v++) {
        const float moved = apart(open + 3 * v, h->rest + 3 * v);
        if (fabsf(h->rest[3 * v]) < 0.012f) kind[v] = moved > 0.5f * most ? 1 : moved < 0.25f * most ? 2 : 0;
    }
    for (uint32_t v = 0; v < count; v++) {
        uint32_t near = NOH_NONE;
        float way = 0.002f;
        if (kind[v] != 1 || !is_skin(h, v)) continue;
        for (uint32_t u = 0; u < count; u++) {
            if (kind[u] == 2 && apart(h->rest + 3 * u, h->rest + 3 * v) < way && is_skin(h, u)) {
                way = apart(h->rest + 3 * u, h->rest + 3 * v);
                near = u;
            }
        }
        if (near != NOH_NONE && h->pair_count < PAIRS) h->pairs[h->pair_count++] = (seam_pair){ v, near };
    }
    h->teeth = test_zeros(h->mesh.header->index_count * sizeof(uint32_t));
    for (uint32_t i = 0; i + 2 < h->mesh.header->index_count; i += 3) {
        uint32_t corners = 0;
        for (uint32_t k = 0; k < 3; k++) {
            h->teeth[h->tooth_count][k] = index_at(h, i + k);
            corners += is_tooth(h, open, most, index_at(h, i + k)) != 0;
        }
        h->tooth_count += corners == 3u;
    }
    free(kind);
    free(open);
}

static void open_people(head *h)
{
    const size_t bytes = noh_identity_size(&h->mesh), working = noh_identity_scratch_size(&h->mesh);
    void *scratch = test_zeros(working);
    h->people = test_zeros(bytes);
    assert_int_equal(noh_identity_init(h->people, bytes, scratch, working, &h->mesh, NULL, &h->identity, NULL), NOH_OK);
    free(scratch);
}

/* A head as `noh build --lips --identity` makes it. */
static void open_head(head *h, const char *asset, const char *identity, const char *jaw)
{
    static char files[2][512];
    const char *inputs[1] = { files[0] };
    float weights[NOH_TARGETS_MAX] = { 0 };
    convert_options options;
    convert_failure failure;
    byte_buffer pack = { NULL, 0, 0, 0 };
    size_t bytes;
    memset(h, 0, sizeof *h);
    memset(&options, 0, sizeof options);
    (void)snprintf(files[0], sizeof files[0], "%s", test_asset(asset));
    if (identity) (void)snprintf(files[1], sizeof files[1], "%s", test_asset(identity));
    options.source.identity = identity ? files[1] : NULL;
    options.source.lips = 1;
    options.only = CONVERT_MESH;
    options.source.skin.influences = 8;
    options.source.skin.palette = 256;
    if (convert_files(inputs, 1, &options, &pack, &failure)) fail_msg("%s", failure.error.what);
    h->bytes = test_aligned(pack.bytes, pack.count);
    h->pack = test_open(h->bytes, pack.count);
    buffer_free(&pack);
    h->mesh = test_mesh(&h->pack, 0);
    bytes = noh_morph_layers_size(&h->mesh);
    h->memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_morph_layers_init(h->memory, bytes, &h->mesh, &h->layers, NULL), NOH_OK);
    h->rest = positions(h, weights);
    bind(h);
    find_lips(h, jaw);
    assert_true(h->pair_count >= 4);
    if (identity) open_people(h);
}

static void close_head(head *h)
{
    free(h->memory);
    free(h->rest);
    free(h->island);
    free(h->teeth);
    free(h->people);
    free(h->bytes);
}

/* How much further apart lips are than where they touch at rest. */
static float lip_gap(const head *h, const float *weights)
{
    float gap = 0.0f;
    accumulate(h, weights);
    for (uint32_t p = 0; p < h->pair_count; p++) {
        const float *low = h->rest + 3 * h->pairs[p].low, *up = h->rest + 3 * h->pairs[p].up;
        float a[3], b[3];
        deform(h, h->pairs[p].low, a);
        deform(h, h->pairs[p].up, b);
        gap = fmaxf(gap, (b[1] - a[1]) - (up[1] - low[1]));
    }
    return gap;
}

/* The nearest of points strewn over a triangle, half a millimetre apart at most for teeth. */
static float to_triangle(const float *p, const float *a, const float *b, const float *c)
{
    float way = 1.0f;
    for (int i = 0; i <= 8; i++) {
        for (int k = 0; k <= 8 - i; k++) {
            float q[3];
            for (int x = 0; x < 3; x++) q[x] = a[x] + (float)i / 8.0f * (b[x] - a[x]) + (float)k / 8.0f * (c[x] - a[x]);
            way = fminf(way, apart(p, q));
        }
    }
    return way;
}

/* From the middle of the lower lip to the teeth of this person. */
static float to_teeth(const head *h, const float *weights)
{
    float way = 1.0f;
    accumulate(h, weights);
    for (uint32_t t = 0; t < h->tooth_count; t++) {
        float corner[3][3];
        for (int k = 0; k < 3; k++) deform(h, h->teeth[t][k], corner[k]);
        for (uint32_t p = 0; p < h->pair_count; p++) {
            float at[3];
            deform(h, h->pairs[p].low, at);
            if (apart(at, corner[0]) < way + 0.01f) way = fminf(way, to_triangle(at, corner[0], corner[1], corner[2]));
        }
    }
    return way;
}

typedef struct worst {
    float gap, teeth, open;
} worst;

/* What a face with this emotion shows at a tick. */
static void weigh(const head *h, const noh_speech *s, int64_t tick, uint32_t emotion, noh_mouth_rule rule,
                  float *weights)
{
    float visemes[NOH_VISEME_COUNT], channels[NOH_CHANNEL_COUNT];
    noh_face_pose pose;
    memset(&pose, 0, sizeof pose);
    memset(weights, 0, NOH_TARGETS_MAX * sizeof *weights);
    pose.head[3] = 1.0f;
    pose.breath = 1.0f;
    if (emotion < NOH_EMOTION_COUNT) pose.emotions[emotion] = 1.0f;
    noh_speech_visemes(s, tick, visemes);
    noh_face_channels(&pose, visemes, rule, channels);
    noh_face_apply(h->links, h->link_count, channels, weights);
}

/* A short p, b, m, f or v between any two sounds. */
static worst measure(const head *h, noh_viseme closes)
{
    worst w = { 0.0f, 0.0f, 0.0f };
    for (uint32_t first = NOH_VISEME_TH; first < NOH_VISEME_COUNT; first++) {
        const noh_phone phones[] = { { 0, first }, { 120 * MS, closes }, { 150 * MS, NOH_VISEME_AA + first % 5u } };
        const noh_speech s = { phones, 3, 300 * MS };
        for (uint32_t emotion = 0; emotion <= NOH_EMOTION_COUNT; emotion++) {
            for (int rule = NOH_MOUTH_BLEND; rule <= NOH_MOUTH_NONE; rule++) {
                float weights[NOH_TARGETS_MAX];
                for (int ms = -17; ms <= 17; ms += 17) {
                    weigh(h, &s, (135 + ms) * (int64_t)MS, emotion, (noh_mouth_rule)rule, weights);
                    if (closes == NOH_VISEME_PP) w.gap = fmaxf(w.gap, lip_gap(h, weights));
                    if (closes == NOH_VISEME_FF && h->tooth_count) w.teeth = fmaxf(w.teeth, to_teeth(h, weights));
                }
                weigh(h, &s, 240 * (int64_t)MS, emotion, (noh_mouth_rule)rule, weights);
                w.open = fmaxf(w.open, lip_gap(h, weights));
            }
        }
    }
    return w;
}

static void lips_of_a_head_meet(void **state)
{
    const float rest[NOH_TARGETS_MAX] = { 0 };
    worst shut, bite;
    head h;
    (void)state;
    open_head(&h, "hero/head.glb", NULL, "mouth-open");
    assert_true(h.tooth_count > 10);
    shut = measure(&h, NOH_VISEME_PP);
    bite = measure(&h, NOH_VISEME_FF);
    print_message("lips at most %.2f mm apart at p, b, m (%u pairs), open up to %.1f mm; lower lip to %u triangles of "
                  "teeth at most %.2f mm at f, v, %.2f at rest\n",
                  (double)shut.gap * 1e3, h.pair_count, (double)shut.open * 1e3, h.tooth_count,
                  (double)bite.teeth * 1e3, (double)to_teeth(&h, rest) * 1e3);
    assert_true(shut.gap <= 0.0005f && shut.open > 0.005f);
    assert_true(bite.teeth <= 0.001f && to_teeth(&h, rest) > 0.002f);
    close_head(&h);
}

/* How a target at weight 1 moves the upper lip from the lower one, on average. */
static void parted_by(const head *h, uint32_t target, float out[3])
{
    float weights[NOH_TARGETS_MAX] = { 0 };
    weights[target] = 1.0f;
    accumulate(h, weights);
    memset(out, 0, 3 * sizeof *out);
    for (uint32_t p = 0; p < h->pair_count; p++) {
        const float *low = h->rest + 3 * h->pairs[p].low, *up = h->rest + 3 * h->pairs[p].up;
        float a[3], b[3];
        deform(h, h->pairs[p].low, a);
        deform(h, h->pairs[p].up, b);
        for (int i = 0; i < 3; i++) out[i] += ((b[i] - a[i]) - (up[i] - low[i])) / (float)h->pair_count;
    }
}

/* What a target says of the lips' gap is what it does to vertices in the middle of the mouth. */
static void targets_tell_how_far_lips_open(void **state)
{
    float slope = 0.0f, widest = 0.0f, worst_by = 0.0f, up[3], parted[3], length;
    head h;
    (void)state;
    open_head(&h, "hero/head.glb", NULL, "mouth-open");
    for (uint32_t i = 0; i < h.pack.material_count; i++) {
        const noh_material *m = &h.pack.materials[i];
        if (m->surface != NOH_SURFACE_SKIN) continue;
        slope = m->surface_more[2];
        assert_true(m->surface_more[3] > 0.0f && m->surface_more[3] < 0.05f); /* shut at rest */
    }
    assert_true(slope > 0.0f);
    parted_by(&h, noh_mesh_find_target(&h.mesh, "mouth-open"), up);
    length = sqrtf(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]);
    for (uint32_t t = 0; t < h.mesh.header->target_count; t++) {
        const float told = (float)h.mesh.targets[t].lips / 4096.0f;
        parted_by(&h, t, parted);
        const float along = (parted[0] * up[0] + parted[1] * up[1] + parted[2] * up[2]) / length;
        const float gap = 0.5f * slope * along;
        widest = fmaxf(widest, gap);
        worst_by = fmaxf(worst_by, fabsf(told - gap));
        if (fabsf(told - gap) > 0.15f * fabsf(gap) + 0.02f) {
            fail_msg("%s: %.3f of the mouth's depth, told %.3f", noh_pack_string(h.mesh.pack, h.mesh.targets[t].name),
                     (double)gap, (double)told);
        }
    }
    print_message("half the gap is at most %.3f of the mouth's depth, told %.3f off at most\n", (double)widest,
                  (double)worst_by);
    assert_true(widest > 0.25f);
    close_head(&h);
}

/* 64 people by seed, in the middle of a closure, with every emotion. */
static void lips_of_all_people_meet(void **state)
{
    static const noh_phone phones[2][3] = {
        { { 0, NOH_VISEME_AA }, { 120 * MS, NOH_VISEME_PP }, { 150 * MS, NOH_VISEME_OU } },
        { { 0, NOH_VISEME_AA }, { 120 * MS, NOH_VISEME_FF }, { 150 * MS, NOH_VISEME_OU } }
    };
    float gap = 0.0f, teeth = 0.0f;
    uint32_t apart_count = 0, off_count = 0;
    head h;
    (void)state;
    open_head(&h, "hero/head.glb", "hero/identity.glb", "mouth-open");
    for (uint32_t seed = 1; seed <= 64; seed++) {
        float person[NOH_TARGETS_MAX] = { 0 }, own_gap = 0.0f, own_teeth = 0.0f;
        noh_identity_random(&h.identity, seed, 1.0f, person);
        for (uint32_t emotion = 0; emotion <= NOH_EMOTION_COUNT; emotion++) {
            float weights[NOH_TARGETS_MAX];
            for (int closes = 0; closes < 2; closes++) {
                const noh_speech s = { phones[closes], 3, 300 * MS };
                weigh(&h, &s, 135 * (int64_t)MS, emotion, NOH_MOUTH_BLEND, weights);
                for (uint32_t t = 0; t < h.mesh.header->target_count; t++) weights[t] += person[t];
                if (closes) own_teeth = fmaxf(own_teeth, to_teeth(&h, weights));
                if (!closes) own_gap = fmaxf(own_gap, lip_gap(&h, weights));
            }
        }
        apart_count += own_gap > 0.0005f;
        off_count += own_teeth > 0.001f;
        gap = fmaxf(gap, own_gap);
        teeth = fmaxf(teeth, own_teeth);
    }
    print_message("64 people: lips at most %.2f mm apart at p, b, m (%u above 0.5); to their teeth at most %.2f mm at "
                  "f, v (%u above 1)\n",
                  (double)gap * 1e3, apart_count, (double)teeth * 1e3, off_count);
    assert_true(gap <= 0.0005f && teeth <= 0.001f);
    close_head(&h);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lips_of_a_head_meet),
        cmocka_unit_test(targets_tell_how_far_lips_open),
        cmocka_unit_test(lips_of_all_people_meet),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
