/* Feet on the ground: a walking puppet on stairs, slopes and rough terrain; its soles are measured against the ground
 * itself, out of the joints that are shown. */
#include "support/stage_fixture.h"

#include <math.h>

#include "life/reach/feet_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"

#define STEPS 14u
#define FRAMES 420u
#define FIELD 257u

/* What a walk came to; metres. */
typedef struct measures {
    float slide, penetration, gap, acceleration, held; /* held: the least share of frames that a foot stood */
} measures;

typedef struct walk {
    cast cast;
    noh_kind_feet feet;
    noh_modifier part;
    noh_world world;
    noh_obb boxes[STEPS];
    noh_plane planes[1];
    noh_field field;
    uint16_t *heights;
    float top[3]; /* the pelvis, of the last three frames */
    float from[NOH_FEET_LEGS_MAX][2];
    uint32_t was_part[NOH_FEET_LEGS_MAX], held[NOH_FEET_LEGS_MAX], total[NOH_FEET_LEGS_MAX];
} walk;

static void open_walk(walk *w)
{
    noh_ragdoll_source source;
    noh_error said;
    memset(w, 0, sizeof *w);
    cast_map(&w->cast, PUPPETS, "demo/puppet_levels.noh");
    memset(&source, 0, sizeof source);
    source.pack = &w->cast.packs[0];
    source.metres = 1.0f;
    assert_int_equal(noh_pack_skeleton_at(source.pack, 0, &source.joints, NULL, NULL), NOH_OK);
    if (noh_feet_rig_make(&source, &w->feet.rig, &said) != NOH_OK) fail_msg("rig: %s", said.what);
    assert_int_equal(w->feet.rig.leg_count, 2);
    w->feet.ground.world = &w->world;
    w->part = noh_feet_modifier(&w->feet);
    w->planes[0].normal[1] = 1.0f;
    w->world.planes = w->planes;
    w->world.plane_count = 1;
}

static void make_walk(walk *w, uint32_t actors, uint32_t jobs)
{
    cast *c = &w->cast;
    assert_int_equal(noh_world_check(&w->world, NULL), NOH_OK);
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].actor_count = actors;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    c->kinds[0].modifiers = &w->part;
    c->kinds[0].modifier_count = 1;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
}

static void close_walk(walk *w)
{
    cast_close_stage(&w->cast);
    noh_file_unmap(&w->cast.files[0]);
    free(w->heights);
}

/* ---- grounds ---- */

/* Steps from z = 1 on, each as wide as the world. */
static void lay_stairs(walk *w, float height)
{
    for (uint32_t i = 0; i < STEPS; i++) {
        noh_obb *b = &w->boxes[i];
        memset(b, 0, sizeof *b);
        b->half[0] = 5.0f, b->half[1] = 0.5f * height * (float)(i + 1u), b->half[2] = 10.0f;
        b->centre[1] = b->half[1];
        b->centre[2] = 1.0f + 0.32f * (float)i + b->half[2];
        b->rotation[3] = 1.0f;
    }
    w->world.boxes = w->boxes;
    w->world.box_count = STEPS;
}

static void lay_slope(walk *w, float degrees)
{
    const float angle = degrees * 0.01745329252f;
    w->planes[0].normal[1] = cosf(angle);
    w->planes[0].normal[2] = -sinf(angle);
}

/* Heights at random places, smoothed over `cells` of 5 cm. */
static void lay_noise(walk *w, float height, uint32_t cells)
{
    uint32_t seed = 7u;
    float knots[64][64];
    for (int i = 0; i < 64 * 64; i++) {
        seed = seed * 1664525u + 1013904223u;
        knots[i / 64][i % 64] = (float)(seed >> 8) / 16777216.0f;
    }
    w->heights = malloc(sizeof *w->heights * FIELD * FIELD);
    for (uint32_t i = 0; i < FIELD * FIELD; i++) {
        const float x = (float)(i % FIELD) / (float)cells, z = (float)(i / FIELD) / (float)cells;
        const uint32_t a = (uint32_t)x % 63u, b = (uint32_t)z % 63u;
        const float u = x - floorf(x), v = z - floorf(z), s = u * u * (3 - 2 * u), t = v * v * (3 - 2 * v);
        const float low = knots[b][a] + (knots[b][a + 1u] - knots[b][a]) * s;
        const float high = knots[b + 1u][a] + (knots[b + 1u][a + 1u] - knots[b + 1u][a]) * s;
        w->heights[i] = (uint16_t)(65535.0f * (low + (high - low) * t));
    }
    w->field.heights = w->heights;
    w->field.width = w->field.depth = FIELD;
    w->field.origin[0] = -6.4f, w->field.origin[2] = -2.0f;
    w->field.spacing = 0.05f;
    w->field.scale = height / 65535.0f;
    w->world.field = &w->field;
    w->world.plane_count = 0;
}

static float ground_at(const walk *w, float x, float z)
{
    const float from[3] = { x, 50.0f, z };
    float normal[3];
    const float distance = noh_ground_below(&w->feet.ground, from, 100.0f, normal);
    assert_true(distance >= 0.0f);
    return 50.0f - distance;
}

/* ---- measuring ---- */

static void sole_at(const walk *w, noh_actor actor, const noh_feet_leg *leg, float out[NOH_FEET_POINTS][3])
{
    for (uint32_t p = 0; p < NOH_FEET_POINTS; p++) {
        const float *at = leg->points[p].at;
        float m[12];
        assert_int_equal(noh_actor_joint(w->cast.stage, actor, leg->points[p].joint, m, NULL), NOH_OK);
        for (int i = 0; i < 3; i++) {
            out[p][i] = m[4 * i] * at[0] + m[4 * i + 1] * at[1] + m[4 * i + 2] * at[2] + m[4 * i + 3];
        }
    }
}

/* The least height over the ground of all of a sole, between its points, too. */
static float height_of(const walk *w, float points[NOH_FEET_POINTS][3])
{
    float least = 1e9f;
    for (uint32_t i = 0; i < 2u * 8u * 3u; i++) {
        const uint32_t part = i / 24u;
        const float t = (float)(i / 3u % 8u) / 7.0f, u = (float)(i % 3u) / 2.0f;
        float p[3];
        for (int k = 0; k < 3; k++) {
            const float back = points[2u * part][k] * (1 - u) + points[2u * part + 1u][k] * u;
            const float front = points[2u * part + 2u][k] * (1 - u) + points[2u * part + 3u][k] * u;
            p[k] = back * (1 - t) + front * t;
        }
        least = fminf(least, p[1] - ground_at(w, p[0], p[2]));
    }
    return least;
}

static void measure_slide(walk *w, uint32_t l, const noh_foot *f, float points[NOH_FEET_POINTS][3], measures *m)
{
    const float x = 0.5f * (points[2u * f->part][0] + points[2u * f->part + 1u][0]);
    const float z = 0.5f * (points[2u * f->part][2] + points[2u * f->part + 1u][2]);
    if (!f->is_held) {
        w->held[l] = 0;
        return;
    }
    if (!w->held[l] || w->was_part[l] != f->part) w->from[l][0] = x, w->from[l][1] = z;
    w->held[l]++;
    w->total[l]++;
    w->was_part[l] = f->part;
    m->slide = fmaxf(m->slide, hypotf(x - w->from[l][0], z - w->from[l][1]));
}

static void measure_frame(walk *w, noh_actor actor, uint32_t frame, measures *m)
{
    const noh_feet *feet = noh_actor_modifier(w->cast.stage, actor, 0);
    for (uint32_t l = 0; l < 2; l++) {
        float points[NOH_FEET_POINTS][3];
        sole_at(w, actor, &w->feet.rig.legs[l], points);
        measure_slide(w, l, &feet->feet[l], points, m);
        const float least = height_of(w, points);
        m->penetration = fmaxf(m->penetration, -least);
        if (w->held[l] > 4) m->gap = fmaxf(m->gap, least);
    }
    w->top[frame % 3u] = feet->pelvis;
    if (frame > 40) {
        const float second = w->top[frame % 3u] - 2.0f * w->top[(frame + 2u) % 3u] + w->top[(frame + 1u) % 3u];
        m->acceleration = fmaxf(m->acceleration, fabsf(second) * 3600.0f);
    }
}

/* Walk on. The game has its place on the ground, step by step. */
static void walk_frame(walk *w, noh_actor actor)
{
    noh_place place;
    noh_stage_view view;
    assert_int_equal(noh_actor_place(w->cast.stage, actor, &place, NULL), NOH_OK);
    place.position[1] = ground_at(w, place.position[0], place.position[2]);
    assert_int_equal(noh_actor_set_place(w->cast.stage, actor, &place, NULL), NOH_OK);
    noh_view_orbit(&view, place.position, 0.5f, 0.2f, 3.0f, 640, 360);
    assert_int_equal(noh_stage_frame(w->cast.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
}

static measures walk_on(walk *w, const char *name, float turned, float x, float z)
{
    const noh_place place = { { x, ground_at(w, x, z), z }, { 0, sinf(0.5f * turned), 0, cosf(0.5f * turned) }, 1.0f };
    measures m = { 0 };
    noh_actor actor;
    make_walk(w, 1, 1);
    assert_int_equal(noh_stage_spawn(w->cast.stage, 0, &place, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_play(w->cast.stage, actor, 0, "walk", NULL, NULL), NOH_OK);
    for (uint32_t f = 0; f < FRAMES; f++) {
        walk_frame(w, actor);
        measure_frame(w, actor, f, &m);
    }
    m.held = fminf((float)w->total[0], (float)w->total[1]) / (float)FRAMES;
    printf("  %-12s slide %.2f mm, penetration %.2f mm, gap %.2f mm, pelvis %.1f m/s2, stands %.0f %%\n", name,
           1e3 * m.slide, 1e3 * m.penetration, 1e3 * m.gap, m.acceleration, 100.0 * m.held);
    close_walk(w);
    return m;
}

static void expect(const measures *m)
{
    assert_true(m->slide <= 0.002f);
    assert_true(m->penetration <= 0.005f);
    assert_true(m->gap <= 0.010f);
    assert_true(m->acceleration <= 20.0f);
    assert_true(m->held > 0.3f);
}

static void soles_meet_stairs(void **state)
{
    static const float heights[] = { 0.15f, 0.2f };
    (void)state;
    for (int i = 0; i < 4; i++) {
        const int is_down = i >= 2;
        walk w;
        open_walk(&w);
        lay_stairs(&w, heights[i % 2]);
        const measures m = walk_on(&w, is_down ? "stairs down" : "stairs up", is_down ? 3.14159265f : 0.0f, 0.0f,
                                   is_down ? 6.5f : 0.0f);
        expect(&m);
    }
}

static void soles_meet_slopes(void **state)
{
    static const float degrees[] = { 0.0f, 15.0f, 30.0f };
    (void)state;
    for (int i = 0; i < 9; i++) {
        walk w;
        open_walk(&w);
        lay_slope(&w, degrees[i % 3]);
        const measures m = walk_on(&w,
                                   i < 3   ? "slope up"
                                   : i < 6 ? "slope across"
                                           : "slope down",
                                   1.57079633f * (float)(i / 3), 0.0f, 0.0f);
        expect(&m);
    }
}

static void soles_meet_noise(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        walk w;
        open_walk(&w);
        lay_noise(&w, i ? 0.12f : 0.3f, i ? 3 : 10);
        const measures m = walk_on(&w, i ? "rubble" : "terrain", 0.0f, 0.0f, 0.0f);
        expect(&m);
    }
}

/* ---- bits ---- */

/* Any number of jobs gives the same bits, as does a state that is put back; one that is no state of feet is refused. */
static void feet_are_state_of_the_stage(void **state)
{
    static const uint32_t jobs[] = { 1, 3 };
    uint64_t hashes[60];
    (void)state;
    for (int j = 0; j < 2; j++) {
        uint8_t *saved;
        noh_feet *forged;
        size_t bytes;
        noh_error said;
        walk w;
        open_walk(&w);
        lay_stairs(&w, 0.18f);
        make_walk(&w, 5, jobs[j]);
        for (uint32_t i = 0; i < 5; i++) {
            const noh_place place = { { 0.8f * (float)i - 2.0f, 0.0f, 0.1f * (float)i }, { 0, 0, 0, 0 }, 0.0f };
            noh_actor actor;
            assert_int_equal(noh_stage_spawn(w.cast.stage, 0, &place, &actor, NULL), NOH_OK);
            assert_int_equal(noh_actor_play(w.cast.stage, actor, 0, "walk", NULL, NULL), NOH_OK);
        }
        for (uint32_t f = 0; f < 60; f++) walk_frame(&w, noh_stage_actor_at(w.cast.stage, f % 5u));
        saved = test_aligned(noh_stage_state(w.cast.stage, &bytes), (size_t)w.cast.plan.state_bytes);
        for (int again = 0; again < 2; again++) {
            for (uint32_t f = 0; f < 60; f++) {
                walk_frame(&w, noh_stage_actor_at(w.cast.stage, f % 5u));
                if (j + again == 0) hashes[f] = noh_stage_hash(w.cast.stage);
                if (noh_stage_hash(w.cast.stage) != hashes[f]) fail_msg("%u jobs: frame %u", jobs[j], (unsigned)f);
            }
            assert_int_equal(noh_stage_set_state(w.cast.stage, saved, bytes, NULL), NOH_OK);
        }
        forged = noh_actor_modifier(w.cast.stage, noh_stage_actor_at(w.cast.stage, 3), 0);
        forged = (noh_feet *)(void *)(saved +
                                      ((uint8_t *)forged - (const uint8_t *)noh_stage_state(w.cast.stage, &bytes)));
        forged->feet[0].part = 3;
        assert_int_equal(noh_stage_set_state(w.cast.stage, saved, bytes, &said), NOH_ERR_DATA);
        assert_non_null(strstr(said.what, "feet"));
        free(saved);
        close_walk(&w);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(soles_meet_stairs),
        cmocka_unit_test(soles_meet_slopes),
        cmocka_unit_test(soles_meet_noise),
        cmocka_unit_test(feet_are_state_of_the_stage),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
