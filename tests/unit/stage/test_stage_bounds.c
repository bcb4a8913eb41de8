/* Where an actor is, as a stage takes it: what it shows lies in its sphere, whatever the weights, the pose and the
 * level; a view that looks at it sees it, a ray that meets it hits it; and how finely it is shown follows from its
 * distance. */
#include "support/stage_fixture.h"

#include <math.h>

#include "convert/model/model_build.h"
#include "deform/morph/morph_internal.h"
#include "noh/base.h"
#include "noh/deform.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "stage/cast/stage_internal.h"

#define HALF_ROOT 0.70710678f

/* ---- a figure: a tube with joints and targets, and next to it a rigid head without joints ---- */

typedef struct figure {
    model *m, *moves; /* of the meshes, of the clips */
    lod_pack pack;
    uint8_t *clips;
    cast c; /* of one kind */
} figure;

static void add_head(model *m, const float at[3], float scale)
{
    const lod_face shape = { 14, 10, 6, 0, 1 };
    model *face = lod_face_model(&shape);
    model_node *node = &m->nodes[m->node_count++];
    model_mesh *meshes = test_zeros(2u * sizeof *meshes);
    meshes[0] = m->meshes[0];
    meshes[1] = face->meshes[0];
    for (uint32_t i = 0; i < meshes[1].submesh_count; i++) meshes[1].submeshes[i].material = MODEL_NONE;
    free(m->meshes);
    m->meshes = meshes;
    m->mesh_count = 2;
    face->mesh_count = 0;
    free(face->meshes);
    face->meshes = NULL;
    model_free(face);
    node->name = model_string("head");
    node->parent = node->skin = MODEL_NONE;
    node->mesh = 1;
    node->rotation[1] = node->rotation[3] = HALF_ROOT; /* a quarter turn about y */
    memcpy(node->translation, at, sizeof node->translation);
    for (int i = 0; i < 3; i++) {
        node->scale[i] = scale;
        node->world[12 + i] = (double)at[i];
    }
    node->world[8] = node->world[5] = (double)scale;
    node->world[2] = -(double)scale;
    node->world[15] = 1.0;
}

/* A second clip moves joint `joint` far along x, from `from` to `to`. */
static void add_way(model *m, uint32_t joint, float from, float to)
{
    model_clip *clips = test_zeros(2u * sizeof *clips);
    model_channel *way = test_zeros(sizeof *way);
    clips[0] = m->clips[0];
    free(m->clips);
    m->clips = clips;
    m->clip_count = 2;
    clips[1].name = model_string("way");
    clips[1].channel_count = 1;
    clips[1].channels = way;
    clips[1].duration_s = 1.0f;
    way->node = joint;
    way->path = MODEL_PATH_TRANSLATION;
    way->key_count = 2;
    way->width = 3;
    way->times = test_zeros(2u * sizeof(float));
    way->values = test_zeros(6u * sizeof(float));
    way->times[1] = 1.0f;
    way->values[0] = from, way->values[3] = to;
    way->values[1] = way->values[4] = joint ? 0.2f : 0.0f;
}

static void figure_open(figure *f, const float *head, float head_scale, uint32_t way_joint, float way)
{
    const skin_cylinder tube = { 12, 33, 8, 2, 3, 1, 1.5f, 0.2f };
    lod_settings levels;
    size_t count;
    memset(f, 0, sizeof *f);
    memset(&levels, 0, sizeof levels);
    levels.level_count = 3;
    levels.mode = LOD_FAST;
    f->m = lod_tube_model(&tube);
    f->moves = lod_tube_model(&tube);
    if (head) add_head(f->m, head, head_scale);
    if (way != 0.0f) add_way(f->moves, way_joint, way, way);
    lod_pack_make(f->m, &levels, 0, &f->pack);
    f->clips = skin_pack_with_clips(f->moves, 10.0f, &count);
    f->c.packs[0] = f->pack.pack;
    f->c.packs[1] = test_open(f->clips, count);
    f->c.kinds[0].mesh = &f->c.packs[0];
    f->c.kinds[0].clips = &f->c.packs[1];
    f->c.kinds[0].actor_count = 2;
    f->c.kinds[0].held_float_count = 16;
    f->c.desc.kinds = f->c.kinds;
    f->c.desc.kind_count = 1;
}

static void figure_close(figure *f)
{
    cast_close_stage(&f->c);
    lod_pack_free(&f->pack);
    free(f->clips);
    model_free(f->m);
    model_free(f->moves);
}

static noh_actor come(const cast *c, uint32_t kind, const float at[3], float turn_rad, float scale)
{
    noh_place place = { { at[0], at[1], at[2] }, { 0, 0, 0, 1 }, scale };
    noh_actor actor;
    place.rotation[1] = sinf(0.5f * turn_rad);
    place.rotation[3] = cosf(0.5f * turn_rad);
    assert_int_equal(noh_stage_spawn(c->stage, kind, &place, &actor, NULL), NOH_OK);
    return actor;
}

static void hold_all(const cast *c, noh_actor actor, test_random *r, float low, float high)
{
    for (uint32_t i = 0; noh_stage_name(c->stage, 0, NOH_NAME_FLOAT, i); i++) {
        const float weight = test_random_below(r, 3) ? test_random_float(r, low, high) : 0.0f;
        assert_int_equal(noh_actor_hold_float(c->stage, actor, i, weight, 1.0f, NULL), NOH_OK);
    }
}

/* What is done with each vertex that an actor shows, in the world. */
typedef void (*each_vertex)(void *user, const double at[3]);

static void walk_vertices(const cast *c, noh_actor actor, each_vertex each, void *user)
{
    static float matrices[256 * 12];
    noh_actor_mesh shown;
    for (uint32_t m = 0; noh_actor_mesh_at(c->stage, actor, m, &shown, matrices, NULL) == NOH_OK; m++) {
        const noh_mesh full = test_mesh(&c->packs[0], shown.mesh), mesh = noh_mesh_at_lod(&full, shown.level);
        lod_layers layers = lod_layers_make(&mesh);
        noh_morph_accumulate(&mesh, shown.weights, &layers.layers);
        for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
            float own[3];
            double at[3];
            if (shown.joint_count) {
                noh_skin_position(&mesh, matrices, &layers.layers, v, own);
            } else {
                noh_morph_position(&mesh, &layers.layers, v, own);
            }
            for (int i = 0; i < 3; i++) {
                const float *row = shown.world + 4 * i;
                at[i] = (double)row[0] * (double)own[0] + (double)row[1] * (double)own[1] +
                        (double)row[2] * (double)own[2] + (double)row[3];
            }
            each(user, at);
        }
        lod_layers_free(&layers);
    }
}

typedef struct farthest {
    double middle[3], most;
} farthest;

static void find_farthest(void *user, const double at[3])
{
    farthest *f = user;
    double square = 0.0;
    for (int i = 0; i < 3; i++) square += (at[i] - f->middle[i]) * (at[i] - f->middle[i]);
    f->most = fmax(f->most, sqrt(square));
}

/* The farthest vertex from the middle of an actor's sphere, over the radius. */
static double filled(const cast *c, noh_actor actor)
{
    farthest f = { { 0.0 }, 0.0 };
    float sphere[4];
    assert_int_equal(noh_actor_sphere(c->stage, actor, sphere, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) f.middle[i] = (double)sphere[i];
    walk_vertices(c, actor, find_farthest, &f);
    return f.most / (double)sphere[3];
}

static void everything_shown_lies_in_the_sphere(void **state)
{
    static const float head[3] = { 3.0f, 0.5f, -1.0f };
    test_random r = test_random_from(37);
    double least = 1.0;
    figure f;
    (void)state;
    figure_open(&f, head, 2.0f, 0, 0.0f);
    cast_make(&f.c, NULL);
    for (uint32_t round = 0; round < 60; round++) {
        const float at[3] = { test_random_float(&r, -9, 9), test_random_float(&r, -1, 1),
                              test_random_float(&r, -9, 9) };
        const noh_actor actor = come(&f.c, 0, at, test_random_float(&r, 0, 6), test_random_float(&r, 0.1f, 4.0f));
        const noh_appearance look = { .posed = 1, .level = 1u + test_random_below(&r, 3) };
        const noh_play play = { .start_ticks = test_random_below(&r, 30000), .fade_ticks = 1 };
        assert_int_equal(noh_actor_set_appearance(f.c.stage, actor, &look, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(f.c.stage, actor, 0, "bend", &play, NULL), NOH_OK);
        for (int frame = 0; frame < 3; frame++) {
            double part;
            if (round % 6u) hold_all(&f.c, actor, &r, -4.0f, 6.0f);
            assert_int_equal(noh_stage_frame(f.c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
            part = filled(&f.c, actor);
            if (!(part <= 1.00001)) fail_msg("round %u: a vertex at %g of the radius", (unsigned)round, part);
            least = fmin(least, part);
        }
        assert_int_equal(noh_stage_despawn(f.c.stage, actor, NULL), NOH_OK);
    }
    printf("the farthest vertex is at %.2f of the radius or farther\n", least);
    assert_true(least > 0.5);
    figure_close(&f);
}

/* Before the first frame the sphere has room for any pose: all bones in a line, and not more than twice that. */
static void unposed_figures_have_spheres_of_their_length(void **state)
{
    static const float here[3] = { 0.0f, 0.0f, 0.0f };
    figure f;
    (void)state;
    figure_open(&f, NULL, 1.0f, 0, 0.0f);
    cast_make(&f.c, NULL);
    for (int i = 0; i < 3; i++) {
        const float scale = 0.5f * (float)(1 << i);
        const noh_actor actor = come(&f.c, 0, here, 0.0f, scale);
        float sphere[4];
        assert_int_equal(noh_actor_sphere(f.c.stage, actor, sphere, NULL), NOH_OK);
        print_message("scale %g: %g\n", (double)scale, (double)sphere[3]);
        assert_true(sphere[3] > 1.5f * scale && sphere[3] < 2.0f * 1.7320508f * 1.7f * scale);
        assert_int_equal(noh_stage_despawn(f.c.stage, actor, NULL), NOH_OK);
    }
    figure_close(&f);
}

/* ---- a view of a vertex sees it; a ray at it hits ---- */

typedef struct some {
    test_random *r;
    uint32_t seen;
    double at[3];
} some;

/* Each vertex with the same chance. */
static void take_one(void *user, const double at[3])
{
    some *s = user;
    if (test_random_below(s->r, ++s->seen) == 0) memcpy(s->at, at, sizeof s->at);
}

static some one_vertex(const cast *c, noh_actor actor, test_random *r)
{
    some s;
    memset(&s, 0, sizeof s);
    s.r = r;
    walk_vertices(c, actor, take_one, &s);
    assert_true(s.seen > 0);
    return s;
}

static noh_stage_view look_closely(const double at[3], uint32_t seed)
{
    const float target[3] = { (float)at[0], (float)at[1], (float)at[2] };
    noh_stage_view view;
    noh_view_orbit(&view, target, 0.7f * (float)seed, 0.1f, 0.3f, 400, 300);
    view.cut = 1;
    return view;
}

/* Weights that are in no clip, which the game sets before the first frame. */
static void a_view_of_any_vertex_sees_it_in_the_first_frame(void **state)
{
    static const float head[3] = { 3.0f, 0.5f, -1.0f }, origin[3] = { 1.0f, 2.0f, 3.0f };
    const noh_appearance posed = { .posed = 1 }, usual = { 0 };
    test_random r = test_random_from(6);
    figure f;
    (void)state;
    figure_open(&f, head, 2.0f, 0, 0.0f);
    cast_make(&f.c, NULL);
    for (uint32_t round = 0; round < 60; round++) {
        test_random again = r;
        noh_actor actor = come(&f.c, 0, origin, 0.5f, 1.5f);
        noh_stage_view view, shadow;
        float sphere[4];
        some s;
        hold_all(&f.c, actor, &r, -90.0f, 90.0f);
        assert_int_equal(noh_actor_set_appearance(f.c.stage, actor, &posed, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame(f.c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
        s = one_vertex(&f.c, actor, &r);
        view = look_closely(s.at, round);
        for (int i = 0; i < 3; i++) sphere[i] = (float)s.at[i];
        sphere[3] = 0.05f;
        noh_view_shadow(&shadow, sphere, view.light); /* a shadow map of the place alone */
        assert_int_equal(noh_stage_despawn(f.c.stage, actor, NULL), NOH_OK);
        actor = come(&f.c, 0, origin, 0.5f, 1.5f);
        hold_all(&f.c, actor, &again, -90.0f, 90.0f);
        assert_int_equal(noh_actor_set_appearance(f.c.stage, actor, &usual, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame(f.c.stage, CAST_STEP, round & 1u ? &view : &shadow, NULL, NULL, NULL), NOH_OK);
        if (noh_stage_stats_of(f.c.stage)->seen != 1) fail_msg("round %u: it is not seen", (unsigned)round);
        assert_int_equal(noh_stage_despawn(f.c.stage, actor, NULL), NOH_OK);
    }
    figure_close(&f);
}

static void a_ray_at_any_vertex_hits(void **state)
{
    static const float head[3] = { 3.0f, 0.5f, -1.0f }, origin[3] = { 1.0f, 2.0f, 3.0f };
    uint32_t hits = 0, rays = 0;
    test_random r = test_random_from(7);
    figure f;
    (void)state;
    figure_open(&f, head, 2.0f, 0, 0.0f);
    cast_make(&f.c, NULL);
    for (uint32_t round = 0; round < 40; round++) {
        const noh_actor actor = come(&f.c, 0, origin, 0.5f, 1.5f);
        const noh_appearance look = { .level = 1 };
        const double middle[3] = { 1.0, 2.0, 3.0 };
        noh_stage_view view = look_closely(middle, round);
        view.height_px = 300;
        assert_int_equal(noh_actor_set_appearance(f.c.stage, actor, &look, NULL), NOH_OK);
        if (round & 1u) hold_all(&f.c, actor, &r, -3.0f, 4.0f);
        for (int i = 0; i < 2; i++)
            assert_int_equal(noh_stage_frame(f.c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        for (uint32_t k = 0; k < 8; k++, rays++) {
            const some s = one_vertex(&f.c, actor, &r);
            noh_stage_hit hit;
            float from[3], way[3], sphere[4];
            assert_int_equal(noh_actor_sphere(f.c.stage, actor, sphere, NULL), NOH_OK);
            for (int i = 0; i < 3;
                 i++) { /* from outside, a hair inwards of the vertex as seen from the head's middle */
                way[i] = test_random_float(&r, -1.0f, 1.0f);
                from[i] = (float)s.at[i] - 30.0f * way[i];
            }
            hits += noh_stage_pick(f.c.stage, from, way, 1000.0f, &hit, NULL) == NOH_OK;
        }
        assert_int_equal(noh_stage_despawn(f.c.stage, actor, NULL), NOH_OK);
    }
    printf("%u of %u rays at vertices hit\n", (unsigned)hits, (unsigned)rays);
    assert_true(hits >= rays * 9u / 10u); /* a vertex of a silhouette may be missed by rounding */
    figure_close(&f);
}

/* A clip whose weight goes to 5 and back: the view follows, and sees it in each frame. */
static void a_weight_of_a_clip_takes_nobody_out_of_view(void **state)
{
    static const float times[3] = { 0.0f, 1.0f, 2.0f };
    const lod_face shape = { 14, 10, 2, 0, 1 };
    const noh_play play = { .fade_ticks = 1 };
    const float at[3] = { 0.0f, 0.0f, 0.0f };
    model *m = lod_face_model(&shape);
    model_channel *c;
    size_t count;
    uint8_t *bytes;
    noh_actor actor;
    cast stage;
    (void)state;
    memset(&stage, 0, sizeof stage);
    for (uint32_t v = 0; v < m->meshes[0].vertex_count; v++) { /* the first target carries all of it along z */
        float *d = m->meshes[0].targets[0].position + 3u * v;
        d[0] = d[1] = 0.0f, d[2] = 1.0f;
    }
    m->nodes = test_zeros(sizeof *m->nodes);
    m->node_count = 1;
    m->nodes[0].name = model_string("head");
    m->nodes[0].parent = m->nodes[0].skin = MODEL_NONE;
    m->nodes[0].rotation[3] = 1.0f;
    for (int i = 0; i < 3; i++) m->nodes[0].scale[i] = 1.0f;
    for (int i = 0; i < 4; i++) m->nodes[0].world[5 * i] = 1.0;
    m->clips = test_zeros(sizeof *m->clips);
    m->clip_count = 1;
    m->clips[0].name = model_string("jump");
    m->clips[0].channel_count = 1;
    m->clips[0].duration_s = 2.0f;
    c = m->clips[0].channels = test_zeros(sizeof *c);
    c->path = MODEL_PATH_WEIGHTS;
    c->key_count = 3;
    c->width = 2;
    c->times = test_zeros(sizeof times);
    memcpy(c->times, times, sizeof times);
    c->values = test_zeros(6u * sizeof(float));
    c->values[2] = 5.0f;
    c->values[3] = -2.0f;
    bytes = skin_pack_with_clips(m, 10.0f, &count);
    stage.packs[0] = test_open(bytes, count);
    stage.kinds[0].mesh = &stage.packs[0];
    stage.kinds[0].actor_count = 1;
    stage.desc.kinds = stage.kinds;
    stage.desc.kind_count = 1;
    cast_make(&stage, NULL);
    actor = come(&stage, 0, at, 0.0f, 1.0f);
    assert_int_equal(noh_actor_play(stage.stage, actor, 1, "jump", &play, NULL), NOH_OK);
    for (int q = 0; q <= 8; q++) {
        const float w = 5.0f * (1.0f - fabsf(1.0f - 0.25f * (float)q));
        const double there[3] = { 0.0, 0.0, (double)w };
        const noh_stage_view view = look_closely(there, 1);
        float sphere[4];
        if (q) assert_int_equal(noh_stage_step(stage.stage, 12000, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame_begin(stage.stage, &view, 1, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame_end(stage.stage, NULL), NOH_OK);
        assert_int_equal(noh_stage_stats_of(stage.stage)->seen, 1);
        assert_int_equal(noh_actor_sphere(stage.stage, actor, sphere, NULL), NOH_OK);
        assert_true(filled(&stage, actor) <= 1.00001);
        assert_true(sphere[3] < 0.2f + 0.7f * w); /* it moves along */
    }
    cast_close_stage(&stage);
    free(bytes);
    model_free(m);
}

/* A joint that is no root, which a clip takes twenty units away: a view of that place sees it, though it was never
 * posed. */
static void a_joint_that_travels_is_seen_where_it_is(void **state)
{
    const float at[3] = { 0.0f, 0.0f, 0.0f };
    const double there[3] = { 20.0, 0.5, 0.0 };
    (void)state;
    for (uint32_t joint = 0; joint < 3; joint++) {
        noh_stage_view view = look_closely(there, 0);
        noh_actor_detail d;
        noh_actor actor;
        figure f;
        figure_open(&f, NULL, 1.0f, joint, 20.0f);
        cast_make(&f.c, NULL);
        actor = come(&f.c, 0, at, 0.0f, 1.0f);
        assert_int_equal(noh_actor_play(f.c.stage, actor, 0, "way", NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame(f.c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_stats_of(f.c.stage)->seen, 1);
        view.cut = 0; /* the first frame knew no pose: the next one chooses by it, and nothing fades */
        assert_int_equal(noh_stage_frame(f.c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_detail_of(f.c.stage, actor, &d, NULL), NOH_OK);
        assert_true(d.level == 0 && d.fade >= 1.0f);
        figure_close(&f);
    }
}

/* ---- distances ---- */

typedef struct nearest {
    const noh_stage_view *view;
    double w; /* of clip space, at the nearest vertex in the picture */
} nearest;

static void find_nearest(void *user, const double at[3])
{
    nearest *n = user;
    const float *m = n->view->view_projection;
    double clip[4];
    for (int r = 0; r < 4; r++) {
        clip[r] = (double)m[12 + r];
        for (int c = 0; c < 3; c++) clip[r] += (double)m[4 * c + r] * at[c];
    }
    if (clip[3] > 0.0 && fabs(clip[0]) <= clip[3] && fabs(clip[1]) <= clip[3] && clip[2] >= -clip[3]) {
        n->w = fmin(n->w, clip[3]);
    }
}

/* Pixels a metre at a distance, in a view of noh_view_orbit. */
static double pixels_at(const noh_stage_view *view, double distance)
{
    return 0.5 * view->height_px / (tan(0.349066) * distance);
}

/* From outside the sphere: its nearest point, and no nearer where it stands level with the eye. From inside: of what is
 * in the picture, no less than at the nearest vertex, and within a few times of it. Close outside: between the two. */
static void pixels_a_metre_are_those_of_the_nearest_point(void **state)
{
    static const float head[3] = { 0.6f, 0.5f, 0.2f }, origin[3] = { 0.0f, 0.0f, 0.0f };
    uint32_t inside = 0, outside = 0, exact = 0;
    double worst = 1.0;
    test_random r = test_random_from(1);
    noh_actor actor;
    figure f;
    (void)state;
    figure_open(&f, head, 2.0f, 0, 0.0f);
    cast_make(&f.c, NULL);
    actor = come(&f.c, 0, origin, 0.0f, 1.5f);
    assert_int_equal(noh_actor_play(f.c.stage, actor, 0, "bend", NULL, NULL), NOH_OK);
    for (uint32_t round = 0; round < 400; round++) {
        const float target[3] = { test_random_float(&r, -1, 1), test_random_float(&r, 0, 3),
                                  test_random_float(&r, -1, 1) };
        nearest n = { NULL, 1e30 };
        noh_actor_detail d;
        noh_stage_view view;
        double apart = 0.0, pixels;
        float sphere[4];
        noh_view_orbit(&view, target, test_random_float(&r, 0, 6), test_random_float(&r, -1, 1),
                       test_random_float(&r, 0.2f, 9.0f), 800, 600);
        n.view = &view;
        if (round % 5u == 0) hold_all(&f.c, actor, &r, -2.0f, 3.0f);
        assert_int_equal(noh_stage_frame(f.c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        if (noh_actor_detail_of(f.c.stage, actor, &d, NULL) != NOH_OK) continue; /* out of view */
        walk_vertices(&f.c, actor, find_nearest, &n);
        assert_int_equal(noh_actor_sphere(f.c.stage, actor, sphere, NULL), NOH_OK);
        for (int i = 0; i < 3; i++) apart += pow((double)(sphere[i] - view.eye[i]), 2.0);
        apart = sqrt(apart) - (double)sphere[3];
        pixels = (double)d.pixels_per_metre / 1.5;
        if (n.w < 1e29) assert_true(pixels * 1.0001 >= pixels_at(&view, n.w));
        assert_true(fabs((double)noh_stage_stats_of(f.c.stage)->error_pixels -
                         (double)d.error_m * (double)d.pixels_per_metre) < 1e-3);
        if (apart > 0.0) {
            double depth = (double)view.view_projection[15];
            for (int i = 0; i < 3; i++) depth += (double)view.view_projection[4 * i + 3] * (double)sphere[i];
            depth -= (double)sphere[3];
            assert_true(pixels <= pixels_at(&view, apart) * 1.26); /* 1 / the cosine of the picture's corner */
            if (depth > apart * 0.9 && apart > 1.25 * (double)sphere[3]) {
                assert_true(fabs(pixels / pixels_at(&view, depth) - 1.0) < 1e-3);
                exact++;
            }
            outside++;
        } else if (n.w < 1e29) {
            worst = fmax(worst, pixels * n.w / pixels_at(&view, 1.0));
            inside++;
        }
    }
    printf("%u views from outside, %u from inside of the sphere, these up to %.1f of what the nearest vertex has\n",
           (unsigned)outside, (unsigned)inside, worst);
    assert_true(inside > 40 && outside > 40 && exact > 20);
    figure_close(&f);
}

/* Wherever it stands, and however it is turned, a camera before it sees it. */
static void a_turned_actor_is_seen_anywhere(void **state)
{
    test_random r = test_random_from(3);
    cast c;
    (void)state;
    cast_open(&c);
    c.desc.kind_count = 1;
    cast_make(&c, NULL);
    for (uint32_t round = 0; round < 40; round++) {
        const float at[3] = { test_random_float(&r, -400, 400), test_random_float(&r, -100, 100),
                              test_random_float(&r, -400, 400) };
        const float middle[3] = { at[0], at[1] + 1.0f, at[2] };
        const noh_actor actor = come(&c, PUPPETS, at, test_random_float(&r, -3, 3), 1.0f);
        noh_stage_view view;
        noh_view_orbit(&view, middle, test_random_float(&r, 0, 6), 0.2f, 4.0f, 640, 480);
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_stage_stats_of(c.stage)->seen, 1);
        assert_int_equal(noh_stage_despawn(c.stage, actor, NULL), NOH_OK);
    }
    cast_close(&c);
}

/* Two figures that play the same: the nearer one is never coarser, from the first frame on; with the eye inside the
 * sphere of one and barely outside of the other's, too. */
static void the_nearer_of_two_has_the_finer_level(void **state)
{
    static const char *const clips[] = { "walk", "dance", "bow", "idle" };
    test_random r = test_random_from(12);
    cast c;
    (void)state;
    cast_open(&c);
    c.desc.kind_count = 1;
    c.kinds[PUPPETS].actor_count = 2;
    c.kinds[PUPPETS].near_count = 1;
    c.kinds[PUPPETS].root_axes |= NOH_ROOT_BY_GAME;
    for (uint32_t round = 0; round < 60; round++) {
        const int close = round & 1u;
        const float near = test_random_float(&r, 1.0f, close ? 1.4f : 12.0f);
        const float far = near + test_random_float(&r, 0.1f, close ? 0.4f : 12.0f);
        const uint32_t first = test_random_below(&r, 2);
        const noh_play play = { .start_ticks = test_random_below(&r, 90000) };
        static const float middle[3] = { 0.0f, 1.0f, -1.0f };
        noh_actor actors[2];
        noh_stage_view view;
        noh_view_orbit(&view, middle, 0.0f, 0.0f, 1.0f, 1920, 1080); /* from 0 1 0 along -z */
        cast_make(&c, NULL);
        for (uint32_t i = 0; i < 2; i++) {
            const uint32_t who = first ^ i; /* 0: the nearer one */
            const float at[3] = { test_random_float(&r, -0.02f, 0.02f), 0.0f, who ? -far : -near };
            actors[who] = come(&c, PUPPETS, at, 0.0f, 1.0f);
            assert_int_equal(noh_actor_play(c.stage, actors[who], 0, clips[round % 4u], &play, NULL), NOH_OK);
        }
        for (uint32_t frame = 0; frame < 20; frame++) {
            noh_actor_detail d[2];
            assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
            for (int i = 0; i < 2; i++) assert_int_equal(noh_actor_detail_of(c.stage, actors[i], &d[i], NULL), NOH_OK);
            if (d[0].level > d[1].level || !(d[0].pixels_per_metre > d[1].pixels_per_metre)) {
                fail_msg("round %u, frame %u: level %u at %g m and %u at %g m", (unsigned)round, (unsigned)frame,
                         (unsigned)d[0].level, (double)near, (unsigned)d[1].level, (double)far);
            }
            assert_true(noh_stage_stats_of(c.stage)->error_pixels < 100.0f);
        }
        cast_close_stage(&c);
    }
    cast_close(&c);
}

/* A view of light from a sphere sets all fields, whatever was there. */
static void a_view_of_light_is_whole(void **state)
{
    static const float sphere[4] = { 1.0f, 2.0f, 3.0f, 0.5f }, light[3] = { 0.0f, 0.6f, 0.8f };
    noh_stage_view view;
    (void)state;
    memset(&view, 0xa5, sizeof view);
    noh_view_shadow(&view, sphere, light);
    assert_true(view.height_px == 0 && view.cut == 0);
    for (int i = 0; i < 4; i++) assert_true(view.column_rest[i] == 0.0f);
    for (int i = 0; i < 3; i++) assert_true(view.eye_rest[i] == 0.0f && view.light[i] == light[i]);
}

/* Of more meshes than a kind may draw, all are counted and as many listed as there is room for. */
static void more_meshes_than_fit_are_counted(void **state)
{
    const test_model_desc desc = { .meshes = NOH_STAGE_MESHES_MAX + 2u, .side = 2 };
    noh_stage_item items[NOH_STAGE_MESHES_MAX + 1u];
    size_t count;
    uint8_t *bytes = test_pack(&desc, &count);
    const noh_pack pack = test_open(bytes, count);
    const noh_kind_desc kind = { .mesh = &pack };
    (void)state;
    memset(items, 0xa5, sizeof items);
    assert_int_equal(noh_stage_items(&kind, items), NOH_STAGE_MESHES_MAX + 2u);
    assert_int_equal(items[NOH_STAGE_MESHES_MAX - 1u].mesh, NOH_STAGE_MESHES_MAX - 1u);
    assert_int_equal(items[NOH_STAGE_MESHES_MAX].mesh, 0xa5a5a5a5u);
    free(bytes);
}

static uint32_t targets_shown(const noh_stage *s, uint32_t kind)
{
    const noh_stage_kind *k = &s->kinds[kind];
    uint32_t count = 0;
    for (uint32_t i = 0; i < k->weight_count; i++) count += k->weights[i] != 0.0f;
    return count;
}

/* The larger the error that the stage allows, the fewer targets are left of an expression that is far away; an actor
 * that asks for an error of its own has that. */
static void targets_too_small_to_see_are_left_out(void **state)
{
    static const float middle[3] = { 0.0f, 0.0f, 0.0f }, pixels[3] = { 0.01f, 1.0f, 50.0f };
    uint32_t before = UINT32_MAX;
    (void)state;
    for (int i = 0; i < 3; i++) {
        const noh_place place = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f, 1.0f }, 1.0f };
        const noh_appearance finest = { .pixels = 1e-4f };
        noh_stage_view view;
        noh_actor actor;
        cast c;
        cast_open(&c);
        c.desc.lod.pixels = pixels[i];
        cast_make(&c, NULL);
        noh_view_orbit(&view, middle, 0.0f, 0.0f, 12.0f, 640, 360);
        assert_int_equal(noh_stage_spawn(c.stage, MASKS, &place, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(c.stage, actor, 1, "speak", NULL, NULL), NOH_OK);
        for (int f = 0; f < 20; f++) {
            assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        }
        const uint32_t shown = targets_shown(c.stage, MASKS);
        assert_true(shown < before);
        before = shown;
        assert_int_equal(noh_actor_set_appearance(c.stage, actor, &finest, NULL), NOH_OK);
        for (int f = 0; f < 2; f++) {
            assert_int_equal(noh_stage_frame(c.stage, 0, &view, NULL, NULL, NULL), NOH_OK);
        }
        assert_true(targets_shown(c.stage, MASKS) > shown);
        cast_close(&c);
    }
}

/* A parallel view shows all of them in the same size: the slot goes to the nearest. */
static void of_equal_sizes_the_nearer_has_the_slot(void **state)
{
    static const float ends[4] = { 0.0f, 1.0f, 0.0f, 9.0f };
    const float light[3] = { 0.0f, 0.0f, 1.0f };
    cast c;
    (void)state;
    cast_open(&c);
    c.desc.kind_count = 1;
    c.kinds[PUPPETS].near_count = 1;
    c.desc.lod.pixels = 0.01f; /* all ask for the finest */
    cast_make(&c, NULL);
    for (uint32_t nearest_of = 0; nearest_of < 5; nearest_of++) {
        noh_stage_view view;
        noh_actor actors[5];
        noh_view_shadow(&view, ends, light);
        view.height_px = 300;
        for (uint32_t i = 0; i < 5; i++) {
            const float at[3] = { 1.5f * (float)i - 3.0f, 0.0f, i == nearest_of ? 2.0f : -(float)i };
            actors[i] = come(&c, PUPPETS, at, 0.0f, 1.0f);
        }
        for (int f = 0; f < 3; f++) {
            assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
            for (uint32_t i = 0; i < 5; i++) {
                noh_actor_detail d;
                assert_int_equal(noh_actor_detail_of(c.stage, actors[i], &d, NULL), NOH_OK);
                assert_int_equal(d.level == 0, i == nearest_of);
            }
        }
        for (uint32_t i = 0; i < 5; i++) assert_int_equal(noh_stage_despawn(c.stage, actors[i], NULL), NOH_OK);
    }
    cast_close(&c);
}

/* After a cut of the camera, or when it was away, the slots follow the new place: holding one counts nothing. */
static void a_cut_gives_the_slot_to_whoever_is_nearer_now(void **state)
{
    static const float middle[3] = { 0.0f, 1.0f, -1.0f };
    noh_actor actors[2];
    cast c;
    (void)state;
    cast_open(&c);
    c.desc.kind_count = 1;
    c.kinds[PUPPETS].actor_count = 2;
    c.kinds[PUPPETS].near_count = 1;
    c.desc.lod.pixels = 0.01f;
    cast_make(&c, NULL);
    for (uint32_t i = 0; i < 2; i++) {
        const float at[3] = { i ? 0.5f : -0.5f, 0.0f, -8.0f };
        actors[i] = come(&c, PUPPETS, at, 0.0f, 1.0f);
    }
    for (uint32_t round = 0; round < 6; round++) {
        const uint32_t near = round & 1u;
        const noh_place place = { { near ? 0.5f : -0.5f, 0.0f, -7.9f }, { 0, 0, 0, 1 }, 1.0f };
        const noh_place other = { { near ? -0.5f : 0.5f, 0.0f, -8.0f }, { 0, 0, 0, 1 }, 1.0f };
        noh_actor_detail d;
        noh_stage_view view;
        noh_view_orbit(&view, middle, 0.0f, 0.0f, 1.0f, 1920, 1080);
        view.cut = 1;
        assert_int_equal(noh_actor_set_place(c.stage, actors[near], &place, NULL), NOH_OK);
        assert_int_equal(noh_actor_set_place(c.stage, actors[!near], &other, NULL), NOH_OK);
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_detail_of(c.stage, actors[near], &d, NULL), NOH_OK);
        assert_int_equal(d.level, 0);
    }
    cast_close(&c);
}

/* An attached actor is as large and as near as it is drawn. */
static void what_hangs_on_a_scaled_figure_is_measured_where_it_hangs(void **state)
{
    static const float origin[3] = { 0.0f, 0.0f, 0.0f };
    noh_actor on, mask;
    cast c;
    (void)state;
    cast_open(&c);
    cast_make(&c, NULL);
    on = come(&c, PUPPETS, origin, 0.0f, 3.0f);
    mask = come(&c, MASKS, origin, 0.0f, 0.5f);
    assert_int_equal(noh_actor_attach(c.stage, mask, on, 20, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(c.stage, on, 0, "dance", NULL, NULL), NOH_OK);
    for (uint32_t f = 0; f < 60; f++) {
        const noh_stage_view view = cast_view(5u * f, 14.0f);
        double depth = (double)view.view_projection[15];
        noh_actor_detail d;
        float sphere[4];
        assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_int_equal(noh_actor_detail_of(c.stage, mask, &d, NULL), NOH_OK);
        assert_int_equal(noh_actor_sphere(c.stage, mask, sphere, NULL), NOH_OK);
        for (int i = 0; i < 3; i++) depth += (double)view.view_projection[4 * i + 3] * (double)sphere[i];
        depth -= (double)sphere[3];
        assert_true(fabs((double)d.pixels_per_metre / (1.5 * pixels_at(&view, depth)) - 1.0) < 0.02);
    }
    cast_close(&c);
}

/* On a joint that a clip stretches along one axis: rays at its vertices hit it, its sphere holds them. */
static void what_hangs_on_a_stretched_joint_is_held_and_hit(void **state)
{
    static const float origin[3] = { 0.0f, 0.0f, 0.0f };
    const noh_appearance look = { .level = 1 };
    uint32_t hits = 0, rays = 0;
    test_random r = test_random_from(8);
    noh_actor on, hung;
    figure f;
    (void)state;
    figure_open(&f, NULL, 1.0f, 2, 0.2f);
    {
        model_channel *c = &f.moves->clips[1].channels[0];
        size_t count;
        c->path = MODEL_PATH_SCALE;
        for (int i = 0; i < 6; i++) c->values[i] = i % 3 == 1 ? 4.0f : 0.5f;
        free(f.clips);
        f.clips = skin_pack_with_clips(f.moves, 10.0f, &count);
        f.c.packs[1] = test_open(f.clips, count);
    }
    cast_make(&f.c, NULL);
    on = come(&f.c, 0, origin, 0.0f, 1.0f);
    hung = come(&f.c, 0, origin, 0.7f, 0.5f);
    assert_int_equal(noh_actor_attach(f.c.stage, hung, on, 4, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(f.c.stage, hung, &look, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(f.c.stage, on, 0, "way", NULL, NULL), NOH_OK);
    for (uint32_t round = 0; round < 20; round++) {
        noh_stage_view view;
        noh_view_orbit(&view, (const float[3]){ 0.0f, 2.0f, 0.0f }, 0.3f * (float)round, 0.1f, 12.0f, 400, 300);
        assert_int_equal(noh_stage_frame(f.c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
        assert_true(filled(&f.c, hung) <= 1.00001 && filled(&f.c, on) <= 1.00001);
        for (uint32_t k = 0; k < 8; k++, rays++) {
            const some s = one_vertex(&f.c, hung, &r);
            noh_stage_hit hit;
            float from[3], way[3];
            for (int i = 0; i < 3; i++) {
                way[i] = test_random_float(&r, -1.0f, 1.0f);
                from[i] = (float)s.at[i] - 30.0f * way[i];
            }
            hits += noh_stage_pick(f.c.stage, from, way, 1000.0f, &hit, NULL) == NOH_OK;
        }
    }
    printf("%u of %u rays at vertices hit\n", (unsigned)hits, (unsigned)rays);
    assert_true(hits >= rays * 9u / 10u);
    figure_close(&f);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_shown_lies_in_the_sphere),
        cmocka_unit_test(unposed_figures_have_spheres_of_their_length),
        cmocka_unit_test(a_view_of_any_vertex_sees_it_in_the_first_frame),
        cmocka_unit_test(a_ray_at_any_vertex_hits),
        cmocka_unit_test(a_weight_of_a_clip_takes_nobody_out_of_view),
        cmocka_unit_test(a_joint_that_travels_is_seen_where_it_is),
        cmocka_unit_test(pixels_a_metre_are_those_of_the_nearest_point),
        cmocka_unit_test(a_turned_actor_is_seen_anywhere),
        cmocka_unit_test(the_nearer_of_two_has_the_finer_level),
        cmocka_unit_test(a_view_of_light_is_whole),
        cmocka_unit_test(more_meshes_than_fit_are_counted),
        cmocka_unit_test(targets_too_small_to_see_are_left_out),
        cmocka_unit_test(of_equal_sizes_the_nearer_has_the_slot),
        cmocka_unit_test(a_cut_gives_the_slot_to_whoever_is_nearer_now),
        cmocka_unit_test(what_hangs_on_a_scaled_figure_is_measured_where_it_hangs),
        cmocka_unit_test(what_hangs_on_a_stretched_joint_is_held_and_hit),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
