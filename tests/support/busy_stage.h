/* busy_stage.h: a stage with all modules that save something: graphs, faces, gazes, feet, hands, springs, ragdolls and
 * motion matching, in the middle of walks, falls, staggers and fades. */
#ifndef NOH_TESTS_BUSY_STAGE_H
#define NOH_TESTS_BUSY_STAGE_H

#include "support/stage_fixture.h"

#include "noh/body.h"
#include "noh/low_life.h"
#include "noh/modules.h"

enum { GAZE, FEET, REACH, PARTS };
enum { WALKERS, MATCHED, KINDS };
#define ROAM 1u /* the second file and pack of the cast */
#define BODIES 4u
#define ACTORS (BODIES + 1u)
#define BEFORE 130u /* frames before the state is saved */

typedef struct busy_stage {
    cast c;
    noh_gaze_rig gaze;
    noh_kind_feet feet;
    noh_reach_rig arms;
    noh_modifier parts[PARTS];
    noh_kind_ragdoll ragdoll;
    noh_kind_face face;
    noh_kind_match match;
    noh_world world;
    noh_plane floor;
    noh_actor actors[ACTORS];
} busy_stage;

static inline void make_parts(busy_stage *s)
{
    noh_ragdoll_source source = { .pack = &s->c.packs[PUPPETS], .metres = 1.0f };
    assert_int_equal(noh_pack_skeleton_at(source.pack, 0, &source.joints, NULL, NULL), NOH_OK);
    assert_int_equal(noh_gaze_rig_make(source.pack, 0, &s->gaze, NULL), NOH_OK);
    assert_int_equal(noh_feet_rig_make(&source, &s->feet.rig, NULL), NOH_OK);
    assert_int_equal(noh_reach_rig_make(&source, &s->arms, NULL), NOH_OK);
    s->floor.normal[1] = 1.0f;
    s->world.planes = &s->floor;
    s->world.plane_count = 1;
    s->feet.ground.world = &s->world;
    s->parts[GAZE] = noh_gaze_modifier(&s->gaze);
    s->parts[FEET] = noh_feet_modifier(&s->feet);
    s->parts[REACH] = noh_reach_modifier(&s->arms);
    s->ragdoll.count = 2;
    s->ragdoll.world = &s->world;
    for (int e = 0; e < 2; e++) { /* of the puppet's mask */
        s->face.face.eyes[e][0] = e ? -0.035f : 0.035f;
        s->face.face.eyes[e][1] = 1.55f;
        s->face.face.eyes[e][2] = 0.11f;
    }
}

static inline void busy_stage_open(busy_stage *s, uint32_t jobs)
{
    cast *c = &s->c;
    noh_kind_desc *k = c->kinds;
    memset(s, 0, sizeof *s);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    cast_map(c, ROAM, "demo/roam.noh");
    make_parts(s);
    for (uint32_t i = 0; i < KINDS; i++) {
        k[i].mesh = &c->packs[PUPPETS];
        k[i].root_axes = NOH_ROOT_GROUND;
        k[i].inertia = 1;
    }
    k[WALKERS].actor_count = BODIES;
    k[WALKERS].graphs = noh_graph_module("moves");
    k[WALKERS].face = noh_face_module(&s->face);
    k[WALKERS].ragdoll = noh_ragdoll_module(&s->ragdoll);
    k[WALKERS].springs = noh_springs_module(&s->world);
    k[WALKERS].modifiers = s->parts;
    k[WALKERS].modifier_count = PARTS;
    k[MATCHED].actor_count = 1;
    k[MATCHED].clips = &c->packs[ROAM];
    k[MATCHED].match = noh_match_module(&s->match);
    c->desc.kinds = k;
    c->desc.kind_count = KINDS;
    c->desc.job_count = jobs;
    cast_make(c, NULL);
}

static inline void busy_stage_close(busy_stage *s)
{
    cast_close_stage(&s->c);
    for (int i = 0; i < 2; i++) noh_file_unmap(&s->c.files[i]);
}

static inline void busy_stage_frame(const busy_stage *s, uint32_t f)
{
    const noh_stage_view view = cast_view(f, 5.0f);
    assert_int_equal(noh_stage_frame(s->c.stage, CAST_STEP, &view, NULL, NULL, NULL), NOH_OK);
}

static inline void busy_stage_enter(busy_stage *s)
{
    const noh_match_goal goal = { .velocity = { 0.3f, 0.0f, 0.8f } };
    const noh_appearance posed = { .posed = 1 };
    noh_stage *stage = s->c.stage;
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_place place = { { 1.2f * (float)i - 2.0f, 0.0f, -0.4f * (float)i }, { 0, 0, 0, 1 }, 1.0f };
        assert_int_equal(noh_stage_spawn(stage, i < BODIES ? WALKERS : MATCHED, &place, &s->actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(stage, s->actors[i], &posed, NULL), NOH_OK);
    }
    for (uint32_t i = 0; i + 1u < BODIES; i++)
        assert_int_equal(noh_actor_play(stage, s->actors[i], 0, i ? "walk" : "dance", NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_play_graph(stage, s->actors[BODIES - 1u], 0, "moves", NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_match(stage, s->actors[BODIES], &goal, NULL), NOH_OK);
    assert_int_equal(noh_actor_hold_float(stage, s->actors[0], 1, 0.5f, 0.5f, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_emotion(stage, s->actors[0], "joy", 0.8f, 9000, 0, 9000, NULL), NOH_OK);
}

/* Until one lies or falls, one staggers, one looks, reaches and changes its clip by inertia. */
static inline void busy_stage_play(busy_stage *s)
{
    const noh_play leap = { .fade_ticks = 24000, .flags = NOH_PLAY_INERTIA };
    const float ahead[3] = { 0.4f, 1.3f, 2.0f };
    noh_stage *stage = s->c.stage;
    for (uint32_t f = 0; f < BEFORE; f++) {
        noh_gaze *gaze = noh_actor_modifier(stage, s->actors[2], GAZE);
        noh_reach *reach = noh_actor_modifier(stage, s->actors[2], REACH);
        memcpy(gaze->point, ahead, sizeof ahead);
        memcpy(reach->hands[0].point, ahead, sizeof ahead);
        gaze->looks = 1;
        reach->hands[0].wants = 1;
        if (f == 60) assert_int_equal(noh_actor_look_at(stage, s->actors[0], ahead, NULL), NOH_OK);
        if (f == 90) assert_int_equal(noh_actor_fall(stage, s->actors[1], NULL), NOH_OK);
        if (f == BEFORE - 6u) {
            const float push[3] = { 4.0f, 0.0f, 6.0f };
            noh_place at;
            assert_int_equal(noh_actor_place(stage, s->actors[2], &at, NULL), NOH_OK);
            at.position[1] += 1.1f;
            assert_int_equal(noh_actor_hit(stage, s->actors[2], at.position, push, NULL), NOH_OK);
            assert_int_equal(noh_actor_play(stage, s->actors[0], 0, "bow", &leap, NULL), NOH_OK);
        }
        busy_stage_frame(s, f);
    }
}

#endif
