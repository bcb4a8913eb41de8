/* Tests of runtime/face/identity*.c: what belongs together is found, people are whole, and their lids shut. */
#include "deform/morph/morph_internal.h"
#include "life/face/identity_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/face.h"
#include "noh/low_core.h"
#include "noh/pack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "convert/convert.h"
#include "support/support.h"

typedef struct people {
    noh_pack pack;
    noh_mesh mesh;
    noh_identity identity;
    uint8_t *bytes;
    void *memory;
} people;

static void make_people(people *p, const noh_identity_desc *desc)
{
    const size_t bytes = noh_identity_size(&p->mesh), working = noh_identity_scratch_size(&p->mesh);
    void *scratch = test_zeros(working);
    noh_error error;
    p->memory = test_zeros(bytes);
    if (noh_identity_init(p->memory, bytes, scratch, working, &p->mesh, desc, &p->identity, &error)) {
        fail_msg("%s", error.what);
    }
    free(scratch);
}

static void drop_people(people *p)
{
    free(p->memory);
    free(p->bytes);
}

/* ---- a small face ---- */

static const char *const names[] = { "nose-width-decr", "nose-width-incr", "l-ear-tall", "r-ear-tall", "l-ear-short",
                                     "r-ear-short",     "face-move-up",    "face-oval",  "noseAside",  "jawOpen" };
enum { NARROW, WIDE, LEFT_TALL, RIGHT_TALL, LEFT_SHORT, RIGHT_SHORT, SHIFT, OVAL, ASIDE, JAW, COUNT };

static void move(uint32_t target, float x, float y, float to[3])
{
    const float side = x > 0.5f ? 1.0f : x < -0.5f ? -1.0f : 0.0f, nose = fabsf(x) < 0.4f ? 0.1f : 0.0f;
    to[0] = to[1] = to[2] = 0.0f;
    switch (target) {
    case NARROW: to[0] = -nose * x; break;
    case WIDE: to[0] = nose * x; break;
    case LEFT_TALL: to[1] = side > 0.0f ? 0.1f * y : 0.0f; break;
    case RIGHT_TALL: to[1] = side < 0.0f ? 0.1f * y : 0.0f; break;
    case LEFT_SHORT: to[1] = side > 0.0f ? -0.1f * y : 0.0f; break;
    case RIGHT_SHORT: to[1] = side < 0.0f ? -0.1f * y : 0.0f; break;
    case SHIFT: to[1] = 0.5f; break;
    case OVAL: to[2] = 0.1f * y * y; break;
    case ASIDE: to[0] = nose; break;
    default: to[1] = y < 0.0f ? 0.2f * y : 0.0f; break;
    }
}

/* with_lids: the last target shuts eyes: row 4 of 13 comes to lie on row 7, and row 12 on row 9. */
static void small_face_of(people *p, int with_lids)
{
    const test_model_desc desc = { .side = 13, .targets = COUNT, .seed = 3 };
    model *m = test_model(&desc);
    model_mesh *mesh = &m->meshes[0];
    size_t bytes;
    for (uint32_t t = 0; t < COUNT; t++) {
        free(mesh->targets[t].name);
        mesh->targets[t].name = test_zeros(32);
        (void)snprintf(mesh->targets[t].name, 32, "%s", with_lids && t == JAW ? "eyeBlinkRight" : names[t]);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float x = (float)(v % 13) / 6.0f - 1.0f, y = (float)(v / 13) / 6.0f - 1.0f;
        mesh->position[3 * v] = x;
        mesh->position[3 * v + 1] = y;
        mesh->position[3 * v + 2] = 0.0f;
        for (uint32_t t = 0; t < COUNT; t++) move(t, x, y, mesh->targets[t].position + 3 * (size_t)v);
        if (with_lids) mesh->targets[JAW].position[3 * v + 1] = v / 13 == 4 ? 0.5f : v / 13 == 12 ? -0.5f : 0.0f;
    }
    p->bytes = test_pack_of(m, &bytes, NULL);
    p->pack = test_open(p->bytes, bytes);
    p->mesh = test_mesh(&p->pack, 0);
    model_free(m);
    make_people(p, NULL);
}

static void small_face(people *p)
{
    small_face_of(p, 0);
}

static void groups_are_found_from_names_and_deltas(void **state)
{
    people p;
    const noh_identity_target *t;
    (void)state;
    small_face(&p);
    t = p.identity.targets;
    assert_int_equal(p.identity.used_count, COUNT - 1u);
    assert_false(t[JAW].used); /* a recipe names it */
    assert_int_equal(t[NARROW].opposite, WIDE);
    assert_int_equal(t[WIDE].opposite, NARROW);
    assert_int_equal(t[LEFT_TALL].opposite, LEFT_SHORT);
    assert_int_equal(t[RIGHT_SHORT].opposite, RIGHT_TALL);
    assert_int_equal(t[LEFT_TALL].mirror, RIGHT_TALL);
    assert_int_equal(t[RIGHT_SHORT].mirror, LEFT_SHORT);
    assert_int_equal(t[NARROW].mirror, NOH_IDENTITY_NONE);
    assert_int_equal(t[OVAL].opposite, NOH_IDENTITY_NONE);
    assert_true(t[SHIFT].range == 0.0f && t[NARROW].range > 0.0f && t[OVAL].range > 0.0f);
    assert_true(t[ASIDE].range > 0.0f && t[ASIDE].range < 0.2f * t[WIDE].range);
    drop_people(&p);
}

/* Of 26 pairs, six at each side come apart by 0.05 where that ear grows tall, a tenth of the way that closing moves
 * them: least squares over all pairs. */
static void lids_follow_every_pair_of_the_rim(void **state)
{
    static const uint32_t tall[2] = { LEFT_TALL, RIGHT_TALL }, small[2] = { LEFT_SHORT, RIGHT_SHORT };
    people p;
    (void)state;
    small_face_of(&p, 1);
    assert_true(p.mesh.positions[1] == 1.0f && p.mesh.positions[0] > 0.5f); /* the first vertex is in a pair */
    assert_int_equal(p.identity.closing_count, 1);
    assert_int_equal(p.identity.closings[0], JAW);
    for (uint32_t i = 0; i < 2; i++) {
        assert_float_equal(p.identity.targets[tall[i]].closing[0], 3.0f / 13.0f * 0.1f, 1e-4f);
        assert_float_equal(p.identity.targets[small[i]].closing[0], -3.0f / 13.0f * 0.1f, 1e-4f);
    }
    assert_float_equal(p.identity.targets[SHIFT].closing[0], 0.0f, 1e-4f);
    drop_people(&p);
}

static void a_person_has_one_of_two_opposites_on_both_sides(void **state)
{
    people p;
    double difference = 0.0, sum = 0.0;
    (void)state;
    small_face(&p);
    for (uint32_t seed = 0; seed < 500; seed++) {
        float w[COUNT] = { 0.0f };
        w[JAW] = 0.25f;
        noh_identity_random(&p.identity, seed, 1.0f, w);
        assert_true(w[JAW] == 0.25f && w[SHIFT] == 0.0f);
        assert_true(w[NARROW] == 0.0f || w[WIDE] == 0.0f);
        assert_true(w[LEFT_TALL] == 0.0f || w[LEFT_SHORT] == 0.0f);
        difference += fabs((double)(w[LEFT_TALL] - w[LEFT_SHORT] - w[RIGHT_TALL] + w[RIGHT_SHORT]));
        sum += fabs((double)(w[LEFT_TALL] - w[LEFT_SHORT]));
        for (uint32_t t = 0; t < COUNT; t++) assert_true(w[t] >= 0.0f && w[t] <= 1.0f);
    }
    print_message("sides differ by %.3f of what they have\n", difference / sum);
    assert_true(difference > 0.02 * sum && difference < 0.4 * sum);
    drop_people(&p);
}

static void seeds_and_amounts_do_what_they_say(void **state)
{
    people p;
    float a[COUNT] = { 0.0f }, b[COUNT] = { 0.0f }, none[COUNT] = { 0.0f };
    (void)state;
    small_face(&p);
    noh_identity_random(&p.identity, 7, 1.0f, a);
    noh_identity_random(&p.identity, 7, 1.0f, b);
    test_same_floats(b, a, COUNT, "one seed");
    noh_identity_random(&p.identity, 8, 1.0f, b);
    assert_memory_not_equal(a, b, sizeof a);
    noh_identity_random(&p.identity, 7, 0.0f, a);
    test_same_floats(a, none, COUNT, "the mesh itself");
    drop_people(&p);
}

static void bad_descs_and_memory_are_refused(void **state)
{
    static const uint8_t nothing[COUNT] = { 0 };
    const noh_identity_desc bad[] = {
        { .range = 1.5f }, { .strain = -1.0f }, { .asymmetry = NAN }, { .is_identity = nothing }
    };
    people p;
    noh_identity before, identity;
    noh_error error;
    size_t bytes, working;
    void *scratch;
    (void)state;
    small_face(&p);
    bytes = noh_identity_size(&p.mesh);
    working = noh_identity_scratch_size(&p.mesh);
    scratch = test_zeros(working);
    memset(&before, 0x5a, sizeof before);
    identity = before;
    for (size_t i = 0; i < TEST_COUNT(bad); i++) {
        assert_int_equal(noh_identity_init(p.memory, bytes, scratch, working, &p.mesh, &bad[i], &identity, &error),
                         NOH_ERR_ARG);
    }
    assert_int_equal(noh_identity_init(p.memory, bytes - 1u, scratch, working, &p.mesh, NULL, &identity, &error),
                     NOH_ERR_MEMORY);
    assert_int_equal(error.need, bytes);
    assert_int_equal(noh_identity_init(p.memory, bytes, scratch, working - 1u, &p.mesh, NULL, &identity, &error),
                     NOH_ERR_MEMORY);
    assert_int_equal(error.need, working);
    assert_memory_equal(&identity, &before, sizeof identity);
    free(scratch);
    drop_people(&p);
}

/* ---- complexions ---- */

static double byte_of(float three, uint32_t which)
{
    return (double)(int8_t)((uint32_t)three >> 8u * which & 255u);
}

/* Skin, hair and eyes belong together: the darker the skin, the darker the hair; blue eyes and freckles are of light
 * skin. Seeds repeat; an amount of 0 changes no density. */
static void complexions_are_of_one_piece(void **state)
{
    enum { PEOPLE = 4096 };
    double sum[5] = { 0.0 }, blue_melanin = -100.0;
    uint32_t freckled[2] = { 0 }, many[2] = { 0 }, blues = 0;
    (void)state;
    for (uint32_t seed = 0; seed < PEOPLE; seed++) {
        float user[4], again[4], none[4];
        noh_complexion_random(seed, 1.0f, user);
        noh_complexion_random(seed, 1.0f, again);
        noh_complexion_random(seed, 0.0f, none);
        assert_memory_equal(user, again, sizeof user);
        assert_true(none[0] == 0.0f && none[1] == 0.0f && ((uint32_t)none[3] & 0xff00ffu) == 0);
        for (int i = 0; i < 4; i++) {
            assert_true(user[i] >= 0.0f && user[i] < 16777216.0f && user[i] == (float)(uint32_t)user[i]);
        }
        const double melanin = byte_of(user[0], 0), hair = byte_of(user[1], 0);
        const int dark = melanin > 12.0, is_blue = ((uint32_t)user[2] & 255u) + 20u < (uint32_t)user[2] >> 16;
        sum[0] += melanin, sum[1] += hair, sum[2] += melanin * hair, sum[3] += melanin * melanin, sum[4] += hair * hair;
        many[dark]++;
        freckled[dark] += (uint32_t)user[0] >> 16 > 0;
        blues += (uint32_t)is_blue;
        if (is_blue) blue_melanin = fmax(blue_melanin, melanin);
    }
    const double covariance = sum[2] / PEOPLE - sum[0] / PEOPLE * sum[1] / PEOPLE;
    const double spread = sqrt((sum[3] / PEOPLE - sum[0] * sum[0] / PEOPLE / PEOPLE) *
                               (sum[4] / PEOPLE - sum[1] * sum[1] / PEOPLE / PEOPLE));
    print_message("skin and hair correlate by %.2f; %u of %d with blue eyes\n", covariance / spread, blues, PEOPLE);
    assert_true(covariance / spread > 0.6 && blues > PEOPLE / 20 && blue_melanin < 20.0);
    assert_true(many[0] > PEOPLE / 4 && many[1] > PEOPLE / 4 && 8u * freckled[1] < freckled[0]);
}

/* ---- a head with 290 identity targets ---- */

/* The head is converted, opened and grouped once for all tests, which only read it. */
static people shared_head;

static void make_head(byte_buffer *pack)
{
    static char head[512], identity[512];
    const char *inputs[1] = { head };
    convert_options o;
    convert_failure failure;
    (void)snprintf(head, sizeof head, "%s", test_asset("hero/head.glb"));
    (void)snprintf(identity, sizeof identity, "%s", test_asset("hero/identity.glb"));
    memset(&o, 0, sizeof o);
    o.source.identity = identity;
    o.only = CONVERT_MESH;
    o.source.skin.influences = 8;
    o.source.skin.palette = 256;
    if (convert_files(inputs, 1, &o, pack, &failure)) fail_msg("%s", failure.error.what);
}

static int drop_head(void **state)
{
    (void)state;
    free(shared_head.memory);
    free(shared_head.bytes);
    return 0;
}

static void open_head(people *p)
{
    if (!shared_head.bytes) {
        byte_buffer pack = { 0 };
        make_head(&pack);
        shared_head.bytes = test_aligned(pack.bytes, pack.count);
        shared_head.pack = test_open(shared_head.bytes, pack.count);
        shared_head.mesh = test_mesh(&shared_head.pack, 0);
        make_people(&shared_head, NULL);
        buffer_free(&pack);
    }
    *p = shared_head;
}

static void positions(const people *p, const float *weights, float *out)
{
    noh_morph_layers layers = test_layers(&p->mesh);
    noh_morph_accumulate(&p->mesh, weights, &layers);
    for (uint32_t v = 0; v < p->mesh.header->vertex_count; v++) noh_morph_position(&p->mesh, &layers, v, out + 3u * v);
    free(layers.position);
}

static double distance(const float *p, uint32_t a, uint32_t b)
{
    double square = 0.0;
    for (uint32_t c = 0; c < 3; c++) square += pow((double)p[3 * a + c] - (double)p[3 * b + c], 2.0);
    return sqrt(square);
}

static void a_head_is_grouped(void **state)
{
    people p;
    uint32_t opposite = 0, mirrored = 0, sides = 0;
    (void)state;
    open_head(&p);
    assert_int_equal(p.identity.used_count, 290);
    assert_int_equal(p.identity.closing_count, 2);
    for (uint32_t t = 0; t < p.identity.target_count; t++) {
        const noh_identity_target *target = &p.identity.targets[t];
        const char *name = noh_pack_string(&p.pack, p.mesh.targets[t].name);
        if (!target->used) continue;
        opposite += target->opposite != NOH_IDENTITY_NONE;
        mirrored += target->mirror != NOH_IDENTITY_NONE;
        sides += strncmp(name, "l-", 2) == 0 || strncmp(name, "r-", 2) == 0;
    }
    print_message("%u have an opposite, %u a mirror of %u that are of one side\n", opposite, mirrored, sides);
    assert_true(opposite >= 250);
    assert_int_equal(mirrored, sides);
}

/* The target that shuts an eye, alone: its furthest vertices, and what they come to lie on. */
static uint32_t rim(const people *p, uint32_t closing, uint32_t (*pairs)[2], uint32_t most)
{
    const uint32_t vertices = p->mesh.submeshes[0].vertex_count, first = p->mesh.submeshes[0].first_vertex;
    float *rest = test_zeros(p->mesh.header->vertex_count * 12u),
          *shut = test_zeros(p->mesh.header->vertex_count * 12u);
    float weights[NOH_TARGETS_MAX] = { 0.0f };
    uint32_t count = 0;
    positions(p, weights, rest);
    weights[closing] = 1.0f;
    positions(p, weights, shut);
    for (uint32_t v = first; v < first + vertices; v++) {
        double way = 0.0, nearest = 0.0015;
        for (uint32_t c = 0; c < 3; c++) way += pow((double)shut[3 * v + c] - (double)rest[3 * v + c], 2.0);
        if (sqrt(way) < 0.005) continue;
        for (uint32_t u = first; u < first + vertices; u++) {
            const int stays = memcmp(rest + 3 * u, shut + 3 * u, 12) == 0;
            if (!stays || distance(shut, v, u) >= nearest || distance(rest, v, u) < 0.005) continue;
            nearest = distance(shut, v, u);
            pairs[count][0] = v;
            pairs[count][1] = u;
        }
        count += nearest < 0.0015 && count + 1u < most;
    }
    free(rest);
    free(shut);
    return count;
}

/* How much further apart lids are than on the mesh's own face, on average, metres; below 0: they overlap. */
static double gap(const people *p, const float *weights, uint32_t (*pairs)[2], uint32_t count)
{
    float *shut = test_zeros(p->mesh.header->vertex_count * 12u);
    double sum = 0.0;
    positions(p, weights, shut);
    for (uint32_t i = 0; i < count; i++) sum += (double)shut[3 * pairs[i][0] + 1] - (double)shut[3 * pairs[i][1] + 1];
    free(shut);
    return sum / count;
}

static void lids_shut_on_all_people(void **state)
{
    uint32_t pairs[256][2], count;
    const char *target_names[NOH_TARGETS_MAX];
    double worst = 0.0, worst_plain = 0.0, own;
    float weights[NOH_TARGETS_MAX] = { 0.0f };
    people p;
    (void)state;
    open_head(&p);
    count = rim(&p, p.identity.closings[0], pairs, 256);
    assert_true(count >= 6);
    for (uint32_t t = 0; t < p.identity.target_count; t++) {
        target_names[t] = noh_pack_string(&p.pack, p.mesh.targets[t].name);
    }
    weights[p.identity.closings[0]] = 1.0f;
    own = gap(&p, weights, pairs, count);
    for (uint32_t seed = 1; seed <= 64; seed++) {
        noh_face_link links[256];
        float channels[NOH_CHANNEL_COUNT] = { 1.0f, 1.0f };
        uint32_t link_count = noh_face_recipe_bind(NULL, 0, target_names, p.identity.target_count, links, 256);
        memset(weights, 0, sizeof weights);
        noh_identity_random(&p.identity, seed, 1.0f, weights);
        weights[p.identity.closings[0]] = 1.0f;
        worst_plain = fmax(worst_plain, fabs(gap(&p, weights, pairs, count) - own));
        weights[p.identity.closings[0]] = 0.0f;
        noh_identity_bind(&p.identity, weights, links, link_count);
        noh_face_apply(links, link_count, channels, weights);
        worst = fmax(worst, fabs(gap(&p, weights, pairs, count) - own));
    }
    print_message("%u pairs; lids are off by %.2f mm at most, %.2f mm without the correction\n", count, 1e3 * worst,
                  1e3 * worst_plain);
    assert_true(worst < 0.0007 && worst < 0.4 * worst_plain);
}

/* The source passes over targets of another topology without a word. */
static void another_topology_fails_the_build(void **state)
{
    static char mask[512], identity[512];
    const char *build = getenv("NOH_BUILD"), *inputs[1] = { mask };
    convert_options o;
    convert_failure failure;
    byte_buffer none = { 0 };
    (void)state;
    (void)snprintf(identity, sizeof identity, "%s", test_asset("hero/identity.glb"));
    (void)snprintf(mask, sizeof mask, "%s/mask.glb", build ? build : "build");
    memset(&o, 0, sizeof o);
    o.source.identity = identity;
    assert_int_not_equal(convert_files(inputs, 1, &o, &none, &failure), 0);
    assert_non_null(strstr(failure.error.what, "the same vertex order"));
    buffer_free(&none);
}

/* An expression moves a person's vertices by the deltas that it moves the mesh's own by: nothing has to be copied. */
static void people_share_the_deltas_of_expressions(void **state)
{
    float weights[NOH_TARGETS_MAX] = { 0.0f };
    float *at[4];
    uint32_t smile, count;
    double worst = 0.0;
    people p;
    (void)state;
    open_head(&p);
    count = 3u * p.mesh.header->vertex_count;
    smile = noh_mesh_find_target(&p.mesh, "mouth-corner-puller");
    for (int i = 0; i < 4; i++) {
        at[i] = test_zeros(count * sizeof **at);
        memset(weights, 0, sizeof weights);
        if (i >= 2) noh_identity_random(&p.identity, 5, 1.0f, weights);
        weights[smile] = i % 2 ? 1.0f : 0.0f;
        positions(&p, weights, at[i]);
    }
    for (uint32_t i = 0; i < count; i++) {
        worst = fmax(worst, fabs((double)at[3][i] - (double)at[2][i] - ((double)at[1][i] - (double)at[0][i])));
    }
    assert_true(worst < 1e-6);
    for (int i = 0; i < 4; i++) free(at[i]);
}

/* The share of edges that are half as long or half as long again. */
static double torn(const people *p, const float *weights)
{
    float *rest = test_zeros(p->mesh.header->vertex_count * 12u),
          *shaped = test_zeros(p->mesh.header->vertex_count * 12u);
    const float none[NOH_TARGETS_MAX] = { 0.0f };
    uint32_t count = 0, edges = 0;
    positions(p, none, rest);
    positions(p, weights, shaped);
    for (uint32_t i = 0; i < p->mesh.header->index_count; i++) {
        const uint32_t a = noh_mesh_index(&p->mesh, i), b = noh_mesh_index(&p->mesh, i % 3u == 2u ? i - 2u : i + 1u);
        const double from = distance(rest, a, b), to = distance(shaped, a, b);
        if (from < 0.001) continue;
        edges++;
        count += to < 0.5 * from || to > 1.5 * from;
    }
    free(rest);
    free(shaped);
    return (double)count / edges;
}

/* Granberg's faces (chapter 9): each target at rand() % 1000 / 1000, whatever the others are. */
static void weights_that_know_each_other_keep_a_face_whole(void **state)
{
    double ours = 0.0, even = 0.0;
    people p;
    (void)state;
    open_head(&p);
    srand(1);
    for (uint32_t seed = 1; seed <= 8; seed++) {
        float weights[NOH_TARGETS_MAX] = { 0.0f };
        noh_identity_random(&p.identity, seed, 1.0f, weights);
        ours += torn(&p, weights) / 8.0;
        for (uint32_t t = 0; t < p.identity.target_count; t++) {
            weights[t] = p.identity.targets[t].used ? (float)(rand() % 1000) / 1000.0f : 0.0f;
        }
        even += torn(&p, weights) / 8.0;
    }
    print_message("edges torn: %.2f %% of ours, %.1f %% of even ones\n", 100.0 * ours, 100.0 * even);
    assert_true(ours < 0.002 && even > 0.05);
}

/* dest = source + sum of (morph - base) w, for normals too: what comes out is no normal, where the vertex as drawn has
 * a unit one. */
static void blended_normals_are_made_unit(void **state)
{
    float weights[NOH_TARGETS_MAX] = { 0.0f };
    double worst = 0.0;
    noh_morph_layers layers;
    people p;
    size_t bytes;
    void *memory;
    (void)state;
    small_face(&p);
    for (uint32_t t = 0; t < COUNT; t++) weights[t] = t == SHIFT ? 0.0f : 1.0f;
    bytes = noh_morph_layers_size(&p.mesh);
    memory = test_zeros(bytes);
    assert_int_equal(noh_morph_layers_init(memory, bytes, &p.mesh, &layers, NULL), NOH_OK);
    for (uint32_t v = 0; v < p.mesh.header->vertex_count; v++) {
        noh_vertex rest, drawn;
        double literal = 0.0, ours = 0.0;
        float sum[3];
        noh_morph_vertex(&p.mesh, &layers, v, &rest);
        memcpy(sum, rest.normal, sizeof sum);
        for (uint32_t t = 0; t < COUNT; t++) { /* as the source adds them, one after another */
            float one[NOH_TARGETS_MAX] = { 0.0f };
            noh_vertex moved;
            if (weights[t] == 0.0f) continue;
            one[t] = 1.0f;
            memset(memory, 0, bytes);
            noh_morph_accumulate(&p.mesh, one, &layers);
            noh_morph_vertex(&p.mesh, &layers, v, &moved);
            for (int k = 0; k < 3; k++) sum[k] += (moved.normal[k] - rest.normal[k]) * weights[t];
        }
        memset(memory, 0, bytes);
        noh_morph_accumulate(&p.mesh, weights, &layers);
        noh_morph_vertex(&p.mesh, &layers, v, &drawn);
        memset(memory, 0, bytes);
        for (int k = 0; k < 3; k++) {
            literal += (double)sum[k] * (double)sum[k];
            ours += (double)drawn.normal[k] * (double)drawn.normal[k];
        }
        worst = fmax(worst, fabs(sqrt(literal) - 1.0));
        assert_true(fabs(sqrt(ours) - 1.0) < 1e-5);
    }
    print_message("the source's normals are up to %.2f too long or short\n", worst);
    assert_true(worst > 0.02);
    free(memory);
    drop_people(&p);
}

/* w = rand() % 1000 / 1000 is 0.999 at most, and never below 0: no target is ever shown whole, and none leaves the
 * range that the artist modelled, though people do. */
static void weights_reach_both_their_ends(void **state)
{
    float listing = 0.0f, most = 0.0f;
    people p;
    (void)state;
    for (int i = 0; i < 100000; i++) listing = fmaxf(listing, (float)(i % 1000) / 1000.0f);
    assert_true(listing < 1.0f);
    small_face(&p);
    for (uint32_t seed = 1; seed <= 3000; seed++) {
        float weights[NOH_TARGETS_MAX] = { 0.0f };
        noh_identity_random(&p.identity, seed, 1.0f, weights);
        for (uint32_t t = 0; t < COUNT; t++) most = fmaxf(most, weights[t]);
    }
    print_message("the largest weight of 3,000 people: %.2f\n", (double)most);
    assert_true(most >= 1.0f);
    drop_people(&p);
}

static void people_are_the_same_everywhere(void **state)
{
    float weights[NOH_TARGETS_MAX] = { 0.0f };
    people p;
    (void)state;
    small_face(&p);
    for (uint32_t seed = 1; seed <= 16; seed++) {
        noh_identity_random(&p.identity, seed, 1.0f, weights + COUNT * seed);
    }
    assert_int_equal(noh_crc32c(0, weights, sizeof weights), 0xefd08ada);
    drop_people(&p);
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(groups_are_found_from_names_and_deltas),
        cmocka_unit_test(lids_follow_every_pair_of_the_rim),
        cmocka_unit_test(a_person_has_one_of_two_opposites_on_both_sides),
        cmocka_unit_test(seeds_and_amounts_do_what_they_say),
        cmocka_unit_test(people_are_the_same_everywhere),
        cmocka_unit_test(bad_descs_and_memory_are_refused),
        cmocka_unit_test(complexions_are_of_one_piece),
        cmocka_unit_test(a_head_is_grouped),
        cmocka_unit_test(lids_shut_on_all_people),
        cmocka_unit_test(people_share_the_deltas_of_expressions),
        cmocka_unit_test(another_topology_fails_the_build),
        cmocka_unit_test(weights_that_know_each_other_keep_a_face_whole),
        cmocka_unit_test(blended_normals_are_made_unit),
        cmocka_unit_test(weights_reach_both_their_ends),
    };
    if (argument_count > 1) cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, drop_head);
}
