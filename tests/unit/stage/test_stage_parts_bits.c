/* Feet, gazes, hands, springs and ragdolls of a stage have the same bits on every processor: puppets walk over steps
 * and rough ground, look, reach, are hit, fall and get up; each frame's state is hashed. As in test_stage_bits the
 * build for this machine writes the hashes next to its packs, and builds for other processors (make cross) compare. */
#include "support/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "life/reach/feet_internal.h"
#include "stage/modules/springs_internal.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_life.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"
#include "platform.h"

#define FRAMES 300u
#define ACTORS 4u
#define FRAME_TICKS (NOH_TICKS_PER_SECOND / 60)
#define FIELD 33u
#define CHAINS 4u
enum { GAZE, FEET, REACH, SPRINGS, PARTS };

#if defined(__x86_64__)
#define WRITES 1
#else
#define WRITES 0
#endif

typedef struct show {
    noh_file file;
    noh_pack pack;
    noh_kind_desc kind;
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    void *memory;
    noh_gaze_rig gaze;
    noh_kind_feet feet;
    noh_reach_rig arms;
    noh_spring_row rows[CHAINS];
    noh_spring_chain chains[CHAINS];
    noh_spring_capsule capsule;
    noh_springs *springs;
    void *springs_memory;
    noh_modifier parts[PARTS];
    noh_kind_ragdoll ragdoll;
    noh_world world;
    noh_obb steps[3];
    noh_field field;
    uint16_t heights[FIELD * FIELD];
} show;

static void path_of(const char *name, char path[1024])
{
    const char *build = getenv("NOH_BUILD");
    snprintf(path, 1024, "%s/%s", build ? build : "build", name);
}

/* Waves of up to 0.1 m by whole numbers alone, and three steps on them. */
static void lay_ground(show *s)
{
    for (uint32_t i = 0; i < FIELD * FIELD; i++) {
        const uint32_t x = i % FIELD, z = i / FIELD;
        s->heights[i] = (uint16_t)((x * x * 37u + z * z * 53u + x * z * 19u) % 1000u);
    }
    s->field.heights = s->heights;
    s->field.width = s->field.depth = FIELD;
    s->field.origin[0] = s->field.origin[2] = -8.0f;
    s->field.spacing = 0.5f;
    s->field.scale = 1e-4f;
    for (uint32_t i = 0; i < 3; i++) {
        noh_obb *b = &s->steps[i];
        b->half[0] = 4.0f, b->half[1] = 0.1f * (float)(i + 1u), b->half[2] = 3.0f;
        b->centre[2] = 3.6f + 0.35f * (float)i;
        b->rotation[3] = 1.0f;
    }
    s->world.field = &s->field;
    s->world.boxes = s->steps;
    s->world.box_count = 3;
    s->world.friction = 0.6f;
    assert_int_equal(noh_world_check(&s->world, NULL), NOH_OK);
}

/* Sleeves and hem hang, each from one joint, next to a ball round the hips. */
static void hang_cloth(show *s, const noh_skeleton *joints)
{
    noh_springs_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.skeleton = *joints;
    desc.metres = 1.0f;
    desc.rows = s->rows;
    desc.chains = s->chains;
    desc.colliders = &s->capsule;
    desc.collider_count = 1;
    for (uint32_t i = 0; i < joints->joint_count; i++) {
        const char *name = noh_pack_joint_name(&s->pack, 0, i);
        if (!strcmp(name, "hips")) {
            s->capsule.joint = i;
            s->capsule.radius = 0.15f;
        }
        if (desc.chain_count == CHAINS || (!strstr(name, "sleeve") && !strstr(name, "skirt"))) continue;
        noh_spring_row *row = &s->rows[desc.row_count++];
        noh_spring_chain *chain = &s->chains[desc.chain_count];
        *row = (noh_spring_row){ i, 0.4f, 0.2f, 0.02f, { 0.0f, -0.6f, 0.0f } };
        chain->first_row = desc.chain_count++;
        chain->row_count = 1;
        chain->collides = 1;
        chain->end[1] = 0.15f;
    }
    assert_true(desc.chain_count >= 2u);
    s->springs_memory = malloc(noh_springs_size(&desc));
    assert_int_equal(noh_springs_init(s->springs_memory, noh_springs_size(&desc), &desc, &s->springs, NULL), NOH_OK);
    s->parts[SPRINGS] = noh_springs_modifier(s->springs);
}

static void make_parts(show *s)
{
    noh_ragdoll_source source;
    memset(&source, 0, sizeof source);
    source.pack = &s->pack;
    source.metres = 1.0f;
    assert_int_equal(noh_pack_skeleton_at(source.pack, 0, &source.joints, NULL, NULL), NOH_OK);
    assert_int_equal(noh_gaze_rig_make(source.pack, 0, &s->gaze, NULL), NOH_OK);
    assert_int_equal(noh_feet_rig_make(&source, &s->feet.rig, NULL), NOH_OK);
    assert_int_equal(noh_reach_rig_make(&source, &s->arms, NULL), NOH_OK);
    s->feet.ground.world = &s->world;
    s->parts[GAZE] = noh_gaze_modifier(&s->gaze);
    s->parts[FEET] = noh_feet_modifier(&s->feet);
    s->parts[REACH] = noh_reach_modifier(&s->arms);
    hang_cloth(s, &source.joints);
}

static void open_show(show *s)
{
    noh_error error;
    char path[1024];
    memset(s, 0, sizeof *s);
    path_of("demo/puppet_levels.noh", path);
    if (noh_file_map(path, &s->file, NULL) != NOH_OK) test_skip("no %s: `make check` makes it", path);
    s->pack = test_open(s->file.data, s->file.bytes);
    lay_ground(s);
    make_parts(s);
    s->ragdoll.count = 2;
    s->ragdoll.world = &s->world;
    s->kind.mesh = &s->pack;
    s->kind.actor_count = ACTORS;
    s->kind.root_axes = NOH_ROOT_GROUND;
    s->kind.inertia = 1;
    s->kind.modifiers = s->parts;
    s->kind.modifier_count = PARTS;
    s->kind.ragdoll = noh_ragdoll_module(&s->ragdoll);
    s->desc.kinds = &s->kind;
    s->desc.kind_count = 1;
    s->desc.job_count = 2;
    if (noh_stage_plan_make(&s->desc, NULL, &s->plan, &error) != NOH_OK) fail_msg("%s", error.what);
    s->memory = test_aligned(NULL, (size_t)s->plan.cpu_bytes);
    if (noh_stage_init(s->memory, (size_t)s->plan.cpu_bytes, NULL, &s->desc, &s->plan, &s->stage, &error) != NOH_OK) {
        fail_msg("%s", error.what);
    }
}

static void close_show(show *s)
{
    free(s->memory);
    free(s->springs_memory);
    noh_file_unmap(&s->file);
}

static void enter(show *s)
{
    for (uint32_t i = 0; i < ACTORS; i++) {
        const noh_place place = { { 1.1f * (float)i - 1.6f, 0.1f, -0.3f * (float)i }, { 0, 0, 0, 1 }, 1.0f };
        const noh_play play = { .speed = 60000 + 4000 * (int32_t)i, .start_ticks = 9001 * (int64_t)i };
        noh_actor actor;
        assert_int_equal(noh_stage_spawn(s->stage, 0, &place, &actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_play(s->stage, actor, 0, i == 3 ? "dance" : "walk", &play, NULL), NOH_OK);
    }
}

/* What the game does in a frame. Adds up what there was of it, so that the hashes are of something. */
static void act(show *s, uint32_t f, uint32_t seen[4])
{
    const noh_actor actor = noh_stage_actor_at(s->stage, f % ACTORS);
    const noh_body_state body = noh_actor_body(s->stage, actor);
    noh_gaze *gaze = noh_actor_modifier(s->stage, actor, GAZE);
    noh_reach *reach = noh_actor_modifier(s->stage, actor, REACH);
    const noh_feet *feet = noh_actor_modifier(s->stage, actor, FEET);
    noh_place place;
    assert_int_equal(noh_actor_place(s->stage, actor, &place, NULL), NOH_OK);
    for (int i = 0; i < 3; i++) {
        gaze->point[i] = place.position[i] + (i == 1 ? 1.2f : 0.02f * (float)(f * (uint32_t)(i + 3) % 90u));
        reach->hands[0].point[i] = place.position[i] + (i == 1 ? 0.8f : 0.2f);
    }
    gaze->looks = f / 60u % 2u;
    reach->hands[0].wants = f / 45u % 2u;
    if (f % 100u == 40u) { /* two of the four */
        const float point[3] = { place.position[0], place.position[1] + 0.9f, place.position[2] + 0.1f };
        const float push[3] = { 12.0f, 2.0f, f == 40u ? -40.0f : 25.0f };
        assert_int_equal(noh_actor_fall(s->stage, actor, NULL), NOH_OK);
        assert_int_equal(noh_actor_hit(s->stage, actor, point, push, NULL), NOH_OK);
    }
    const char *const none = "";
    if (body == NOH_BODY_LIES || (body == NOH_BODY_FALLS && f > 230u)) {
        assert_int_equal(noh_actor_get_up(s->stage, actor, &(noh_get_up){ .clips = &none }, NULL, NULL), NOH_OK);
    }
    seen[0] += body == NOH_BODY_FALLS;
    seen[1] += body == NOH_BODY_GETS_UP;
    seen[2] += feet->feet[0].is_held + feet->feet[1].is_held;
    seen[3] += reach->hands[0].part > 0.5f;
}

static void frames(show *s, uint32_t first, uint32_t end, uint64_t *hashes, uint32_t seen[4])
{
    static const float middle[3] = { 0.0f, 0.8f, 1.0f };
    for (uint32_t f = first; f < end; f++) {
        noh_stage_view view;
        act(s, f, seen);
        noh_view_orbit(&view, middle, 0.05f * (float)f, 0.3f, 5.0f, 640, 360);
        assert_int_equal(noh_stage_frame(s->stage, FRAME_TICKS + f % 7u, &view, NULL, NULL, NULL), NOH_OK);
        hashes[f] = noh_stage_hash(s->stage);
    }
}

static void every_processor_has_the_same_bits(void **state)
{
    static uint64_t hashes[FRAMES], again[FRAMES], others[FRAMES];
    static show s;
    uint32_t seen[4] = { 0, 0, 0, 0 }, unused[4] = { 0, 0, 0, 0 };
    char path[1024];
    uint8_t *saved;
    size_t bytes, count;
    FILE *file;
    (void)state;
    open_show(&s);
    enter(&s);
    frames(&s, 0, FRAMES / 2u, hashes, seen);
    saved = test_aligned(noh_stage_state(s.stage, &bytes), (size_t)s.plan.state_bytes);
    frames(&s, FRAMES / 2u, FRAMES, hashes, seen);
    assert_int_equal(noh_stage_set_state(s.stage, saved, bytes, NULL), NOH_OK);
    frames(&s, FRAMES / 2u, FRAMES, again, unused);
    assert_memory_equal(hashes + FRAMES / 2u, again + FRAMES / 2u, sizeof hashes / 2u);
    print_message("falls %u, gets up %u, stands %u, reaches %u\n", seen[0], seen[1], seen[2], seen[3]);
    for (int i = 0; i < 4; i++) assert_true(seen[i] > 5u);
    free(saved);
    close_show(&s);
    path_of("stage_parts_bits", path);
    file = fopen(path, WRITES ? "wb" : "rb");
    if (!file) test_skip("no %s: `make check` on x86-64 writes it", path);
    count = WRITES ? fwrite(hashes, sizeof *hashes, FRAMES, file) : fread(others, sizeof *others, FRAMES, file);
    fclose(file);
    assert_int_equal(count, FRAMES);
    for (uint32_t f = 0; f < FRAMES && !WRITES; f++) {
        if (hashes[f] != others[f]) fail_msg("the state differs from x86-64 from frame %u on", (unsigned)f);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(every_processor_has_the_same_bits) };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
