/* Lips of real heads, measured on vertices as the library deforms them: they meet for every p, b and m, and the lower
 * one is no further from the teeth than at rest for f and v, for long enough that every phase of 30 Hz shows it,
 * between any two sounds and whatever the face feels. */
#include "face/recipe.h"
#include "face/speech.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "noh.h"
#include "support/skin_asset.h"
#include "support/support.h"

#define MS 48u
#define PAIRS 64u
#define LINKS 512u

/* A vertex of the lower lip and one of the upper lip that touch at rest. */
typedef struct seam_pair {
    uint32_t low, up;
} seam_pair;

typedef struct head {
    noh_mesh mesh;
    noh_morph_layers layers;
    void *memory;
    float *rest; /* [vertex_count][3] */
    noh_face_link links[LINKS];
    uint32_t link_count;
    seam_pair pairs[PAIRS];
    uint32_t pair_count;
    uint32_t *lower, lower_count; /* the middle of the lower lip */
    uint32_t *teeth, teeth_count; /* what no target moves and no skin is, near the mouth */
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
    const char *names[NOH_TARGETS_MAX];
    const uint32_t count = h->mesh.header->target_count;
    for (uint32_t i = 0; i < count; i++) names[i] = noh_pack_string(h->mesh.pack, h->mesh.targets[i].name);
    h->link_count = noh_face_recipe_bind(NULL, 0, names, count, h->links, LINKS);
    assert_true(h->link_count > 20 && h->link_count <= LINKS);
}

/* The submesh with the skin of the lips: whose vertices the open jaw moves the farthest. */
static int is_skin(const head *h, const float *open, uint32_t vertex)
{
    uint32_t best = 0, own = 0;
    float most = 0.0f;
    for (uint32_t s = 0; s < h->mesh.header->submesh_count; s++) {
        const noh_submesh *sub = &h->mesh.submeshes[s];
        for (uint32_t v = sub->first_vertex; v < sub->first_vertex + sub->vertex_count; v++) {
            if (apart(open + 3 * v, h->rest + 3 * v) > most) most = apart(open + 3 * v, h->rest + 3 * v), best = s;
        }
        if (vertex - sub->first_vertex < sub->vertex_count) own = s;
    }
    return own == best;
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
    for (uint32_t v = 0; v < count; v++) most = fmaxf(most, apart(open + 3 * v, h->rest + 3 * v));
    for (uint32_t v = 0; v < count; v++) {
        const float moved = apart(open + 3 * v, h->rest + 3 * v);
        if (fabsf(h->rest[3 * v]) < 0.012f) kind[v] = moved > 0.5f * most ? 1 : moved < 0.25f * most ? 2 : 0;
    }
    h->lower = test_zeros(sizeof *h->lower * count);
    h->teeth = test_zeros(sizeof *h->teeth * count);
    for (uint32_t v = 0; v < count; v++) {
        uint32_t near = NOH_NONE;
        float way = 0.002f;
        if (kind[v] != 1 || !is_skin(h, open, v)) continue;
        h->lower[h->lower_count++] = v;
        for (uint32_t u = 0; u < count; u++) {
            if (kind[u] == 2 && apart(h->rest + 3 * u, h->rest + 3 * v) < way && is_skin(h, open, u)) {
                way = apart(h->rest + 3 * u, h->rest + 3 * v);
                near = u;
            }
        }
        if (near != NOH_NONE && h->pair_count < PAIRS) h->pairs[h->pair_count++] = (seam_pair){ v, near };
    }
    for (uint32_t u = 0; u < count; u++) {
        float way = 0.03f;
        if (kind[u] != 2 || is_skin(h, open, u)) continue;
        for (uint32_t p = 0; p < h->pair_count; p++) {
            way = fminf(way, apart(h->rest + 3 * u, h->rest + 3 * h->pairs[p].low));
        }
        if (way < 0.02f) h->teeth[h->teeth_count++] = u;
    }
    free(kind);
    free(open);
}

static void open_head(head *h, const noh_pack *pack, const char *jaw)
{
    float weights[NOH_TARGETS_MAX] = { 0 };
    size_t bytes;
    memset(h, 0, sizeof *h);
    assert_int_equal(noh_pack_mesh_at(pack, 0, &h->mesh, NULL), NOH_OK);
    bytes = noh_morph_layers_size(&h->mesh);
    h->memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_morph_layers_init(h->memory, bytes, &h->mesh, &h->layers, NULL), NOH_OK);
    h->rest = positions(h, weights);
    bind(h);
    find_lips(h, jaw);
    assert_true(h->pair_count >= 4);
}

static void close_head(head *h)
{
    free(h->memory);
    free(h->rest);
    free(h->lower);
    free(h->teeth);
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

/* From the lower lip to the teeth. */
static float to_teeth(const head *h, const float *weights)
{
    float way = 1.0f;
    accumulate(h, weights);
    for (uint32_t l = 0; l < h->lower_count; l++) {
        float at[3];
        deform(h, h->lower[l], at);
        for (uint32_t t = 0; t < h->teeth_count; t++) way = fminf(way, apart(at, h->rest + 3 * h->teeth[t]));
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
    static const noh_face_desc desc = { .eyes = { { 0.03f, 0.1f, 0.1f }, { -0.03f, 0.1f, 0.1f } } };
    float visemes[NOH_VISEME_COUNT], channels[NOH_CHANNEL_COUNT];
    noh_face_pose pose;
    memset(&pose, 0, sizeof pose);
    memset(weights, 0, NOH_TARGETS_MAX * sizeof *weights);
    pose.head[3] = 1.0f;
    pose.breath = 1.0f;
    if (emotion < NOH_EMOTION_COUNT) pose.emotions[emotion] = 1.0f;
    noh_speech_visemes(s, tick, visemes);
    noh_face_channels(&pose, &desc, visemes, rule, channels);
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
                    for (int i = 0; i < 34; i++)
                        if (closes == NOH_VISEME_PP) w.gap = fmaxf(w.gap, lip_gap(h, weights));
                    if (closes == NOH_VISEME_FF && h->teeth_count) w.teeth = fmaxf(w.teeth, to_teeth(h, weights));
                }
                weigh(h, &s, 240 * (int64_t)MS, emotion, (noh_mouth_rule)rule, weights);
                w.open = fmaxf(w.open, lip_gap(h, weights));
            }
        }
    }
    return w;
}

static void check(const char *name, const head *h)
{
    const worst shut = measure(h, NOH_VISEME_PP), bite = measure(h, NOH_VISEME_FF);
    const float rest[NOH_TARGETS_MAX] = { 0 }, at_rest = h->teeth_count ? to_teeth(h, rest) : 0.0f;
    print_message("%s: lips at most %.2f mm apart at p, b, m (%u pairs), open up to %.1f mm; lower lip to teeth at "
                  "most %.2f mm at f, v, %.2f at rest\n",
                  name, (double)shut.gap * 1e3, h->pair_count, (double)shut.open * 1e3, (double)bite.teeth * 1e3,
                  (double)at_rest * 1e3);
    assert_true(shut.gap <= 0.0005f && shut.open > 0.005f);
    assert_true(!h->teeth_count || bite.teeth <= at_rest);
}

static void lips_of_a_head_meet(void **state)
{
    skin_asset asset;
    skin_options options;
    head h;
    (void)state;
    memset(&options, 0, sizeof options);
    skin_asset_open(&asset, "hero/head.glb", &options);
    open_head(&h, &asset.pack, "mouth-open");
    assert_true(h.teeth_count > 10);
    check("head", &h);
    close_head(&h);
    skin_asset_close(&asset);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lips_of_a_head_meet),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
