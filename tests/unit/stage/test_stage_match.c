/* Motion matching on a stage: a puppet follows a stick by clips alone, soon enough and calmly; saved, restored and
 * forked in the middle it goes on to the bit, for any number of jobs; tables and descs that do not fit are refused. */
#include <math.h>

#include "support/pack_walk.h"
#include "support/stage_fixture.h"
#include "motion/match/match_internal.h"
#include "noh/low_core.h"
#include "noh/low_life.h"
#include "noh/modules.h"

#define PI 3.14159265358979
#define ROAM 1u /* the second file and pack of the cast */

static noh_error said;
static const noh_kind_match plain;

static void describe(cast *c, const noh_kind_match *match)
{
    memset(c, 0, sizeof *c);
    cast_map(c, PUPPETS, "demo/puppet_levels.noh");
    cast_map(c, ROAM, "demo/roam.noh");
    c->kinds[0].mesh = &c->packs[0];
    c->kinds[0].clips = &c->packs[ROAM];
    c->kinds[0].actor_count = 2;
    c->kinds[0].root_axes = NOH_ROOT_GROUND;
    c->kinds[0].inertia = 1;
    c->kinds[0].match = noh_match_module(match);
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
}

static noh_actor spawn(cast *c)
{
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, 0, NULL, &actor, NULL), NOH_OK);
    return actor;
}

static void cast_end(cast *c)
{
    cast_close_stage(c);
    for (int i = 0; i < 2; i++) noh_file_unmap(&c->files[i]);
}

static void push(cast *c, noh_actor actor, double angle, double speed)
{
    const noh_match_goal goal = { .velocity = { (float)(speed * sin(angle)), 0.0f, (float)(speed * cos(angle)) } };
    if (noh_actor_match(c->stage, actor, &goal, &said) != NOH_OK) fail_msg("%s", said.what);
}

/* Where an actor is and faces, and what it plays. */
typedef struct seen {
    double x, z, heading;
    const noh_track *track;
} seen;

static seen see(const cast *c, noh_actor actor)
{
    noh_place place;
    seen out;
    assert_int_equal(noh_actor_place(c->stage, actor, &place, NULL), NOH_OK);
    out.x = (double)place.position[0];
    out.z = (double)place.position[2];
    out.heading = 2.0 * atan2((double)place.rotation[1], (double)place.rotation[3]);
    out.track = noh_actor_track(c->stage, actor, 0);
    return out;
}

static void step(cast *c)
{
    assert_int_equal(noh_stage_frame(c->stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
}

/* Whether another moment plays than the one that follows the last. */
static int has_leapt(const noh_track *before, const noh_track *after)
{
    return before->clip != after->clip ||
           llabs(after->position - before->position - (int64_t)CAST_STEP * 65536) > 65536;
}

static double middle(double *values, int count)
{
    for (int i = 1; i < count; i++) {
        for (int k = i; k > 0 && values[k] < values[k - 1]; k--) {
            const double kept = values[k];
            values[k] = values[k - 1];
            values[k - 1] = kept;
        }
    }
    return values[count / 2];
}

#define TURNS 24

/* A stick that is turned by 180 degrees every 4 s. */
static void a_turned_stick_is_followed(void **state)
{
    double speeds[TURNS], faces[TURNS], angle = 0.0;
    int leaps = 0, steps = 0;
    cast c;
    noh_actor actor;
    noh_track before;
    (void)state;
    describe(&c, &plain);
    cast_make(&c, NULL);
    actor = spawn(&c);
    push(&c, actor, angle, 0.9);
    for (int i = 0; i < 4 * 60; i++) step(&c);
    for (int n = 0; n < TURNS; n++) {
        speeds[n] = faces[n] = 9.0;
        angle += PI;
        push(&c, actor, angle, 0.9);
        for (int i = 0; i < 4 * 60; i++, steps++) {
            const seen a = see(&c, actor);
            seen b;
            double along;
            before = *a.track;
            step(&c);
            b = see(&c, actor);
            leaps += has_leapt(&before, b.track);
            along = 60.0 * ((b.x - a.x) * sin(angle) + (b.z - a.z) * cos(angle));
            if (speeds[n] > 8.0 && along >= 0.45) speeds[n] = (i + 1) / 60.0;
            if (faces[n] > 8.0 && fabs(remainder(b.heading - angle, 2.0 * PI)) < PI / 4.0) faces[n] = (i + 1) / 60.0;
        }
    }
    print_message("# half speed after %.2f s, facing after %.2f s, %.2f transitions a second\n", middle(speeds, TURNS),
                  middle(faces, TURNS), 60.0 * leaps / steps);
    assert_true(middle(speeds, TURNS) <= 0.9);
    assert_true(middle(faces, TURNS) <= 0.8);
    assert_true(60.0 * leaps / steps <= 3.0);
    cast_end(&c);
}

/* ---- feet ---- */

#define FRAMES_MAX 6000u
#define CLIPS_MAX 16u
#define SECONDS 120

/* Whether a foot of a clip that plays alone is on the ground and slower than a third of a leg length a second. */
typedef struct soles {
    noh_kind_feet feet;
    noh_plane planes[1];
    noh_world world;
    noh_modifier part;
    uint8_t stands[CLIPS_MAX][FRAMES_MAX][2];
    double was[2][3][2];
} soles;

/* How far the lowest part of a foot went along the ground in a frame, and its ball; *lift: height of that part. */
static void follow_sole(soles *s, const cast *c, noh_actor actor, uint32_t l, double *went, double *ball, double *lift)
{
    const noh_feet_leg *leg = &s->feet.rig.legs[l];
    double at[3][2], low[3];
    uint32_t lowest = 0;
    for (uint32_t p = 0; p < 3; p++) {
        low[p] = 1e9;
        at[p][0] = at[p][1] = 0.0;
        for (uint32_t q = 2 * p; q < 2 * p + 2; q++) {
            float m[12], v[3];
            assert_int_equal(noh_actor_joint(c->stage, actor, leg->points[q].joint, m, &said), NOH_OK);
            for (int i = 0; i < 3; i++) {
                const float *row = m + 4 * i, *point = leg->points[q].at;
                v[i] = row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
            }
            low[p] = fmin(low[p], (double)v[1]);
            at[p][0] += 0.5 * (double)v[0];
            at[p][1] += 0.5 * (double)v[2];
        }
        if (low[p] < low[lowest]) lowest = p;
    }
    *went = hypot(at[lowest][0] - s->was[l][lowest][0], at[lowest][1] - s->was[l][lowest][1]);
    *ball = hypot(at[1][0] - s->was[l][1][0], at[1][1] - s->was[l][1][1]);
    *lift = low[lowest];
    memcpy(s->was[l], at, sizeof at);
}

static uint32_t frame_of(const noh_track *track)
{
    return (uint32_t)(track->position / 65536 / (int64_t)CAST_STEP);
}

/* Of a cast that is described. */
static void add_feet(cast *c, soles *s)
{
    noh_ragdoll_source source;
    memset(&source, 0, sizeof source);
    source.pack = &c->packs[0];
    source.metres = 1.0f;
    assert_int_equal(noh_pack_skeleton_at(source.pack, 0, &source.joints, NULL, NULL), NOH_OK);
    assert_int_equal(noh_feet_rig_make(&source, &s->feet.rig, &said), NOH_OK);
    s->planes[0].normal[1] = 1.0f;
    s->world.planes = s->planes;
    s->world.plane_count = 1;
    s->feet.ground.world = &s->world;
    s->part = noh_feet_modifier(&s->feet);
    c->kinds[0].modifiers = &s->part;
    c->kinds[0].modifier_count = 1;
}

static void open_soles(cast *c, soles *s, int with_feet)
{
    describe(c, &plain);
    add_feet(c, s);
    c->kinds[0].modifier_count = with_feet ? 1u : 0u;
    cast_make(c, NULL);
}

static noh_actor spawn_posed(const cast *c)
{
    const noh_appearance look = { .posed = 1 };
    noh_actor actor;
    assert_int_equal(noh_stage_spawn(c->stage, 0, NULL, &actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(c->stage, actor, &look, NULL), NOH_OK);
    return actor;
}

/* Each clip alone. Returns the share of the feet's way that they go while they stand. */
static double find_standing(soles *s)
{
    double slid = 0.0, all = 0.0;
    cast c;
    open_soles(&c, s, 0);
    for (uint32_t i = 0; i < c.packs[ROAM].runs[NOH_CHUNK_CLIP].count; i++) {
        const noh_actor actor = spawn_posed(&c);
        const char *name = noh_pack_chunk_name(&c.packs[ROAM], c.packs[ROAM].runs[NOH_CHUNK_CLIP].first + i);
        assert_int_equal(noh_actor_play(c.stage, actor, 0, name, NULL, &said), NOH_OK);
        int64_t last = -1;
        const noh_track *t = noh_actor_track(c.stage, actor, 0);
        for (uint32_t n = 0; t && t->position > last && frame_of(t) < FRAMES_MAX - 1u; n++) {
            last = t->position;
            step(&c);
            t = noh_actor_track(c.stage, actor, 0);
            for (uint32_t l = 0; t && l < 2; l++) {
                double went, ball, lift;
                follow_sole(s, &c, actor, l, &went, &ball, &lift);
                const int stands = n && 60.0 * went < 0.35 * (double)s->feet.rig.length &&
                                   lift < 0.045 * (double)s->feet.rig.length;
                assert_in_range(t->clip, 0, CLIPS_MAX - 1u);
                s->stands[t->clip][frame_of(t)][l] = stands != 0;
                slid += stands ? went : 0.0;
                all += n ? ball : 0.0;
            }
        }
        assert_int_equal(noh_stage_despawn(c.stage, actor, NULL), NOH_OK);
    }
    cast_end(&c);
    return slid / all;
}

/* A stick that is turned and pushed again every 2 s: the share of the feet's way that they go while the clip that plays
 * has them standing. */
static double slide_of(soles *s, int with_feet)
{
    static const double speeds[4] = { 0.9, 0.0, 1.4, 0.9 };
    double slid = 0.0, all = 0.0, angle = 0.0;
    test_random r = test_random_from(3);
    cast c;
    open_soles(&c, s, with_feet);
    const noh_actor actor = spawn_posed(&c);
    for (int n = 0; n < SECONDS * 60; n++) {
        if (n % 120 == 0) {
            angle += (double)test_random_float(&r, -3.14f, 3.14f);
            push(&c, actor, angle, speeds[n / 120 % 4]);
        }
        step(&c);
        const noh_track *t = noh_actor_track(c.stage, actor, 0);
        for (uint32_t l = 0; l < 2; l++) {
            double went, ball, lift;
            follow_sole(s, &c, actor, l, &went, &ball, &lift);
            if (n && t && frame_of(t) < FRAMES_MAX && s->stands[t->clip][frame_of(t)][l]) slid += went;
            if (n) all += ball;
        }
    }
    cast_end(&c);
    return slid / all;
}

/* Nine tenths of the slide are in the blends between clips, which move a foot that stands in the next clip from where it
 * stood in the last. The feet's modifier holds it. */
static void standing_feet_stay(void **state)
{
    soles *s = test_zeros(sizeof *s);
    (void)state;
    const double alone = find_standing(s), free_feet = slide_of(s, 0), held = slide_of(s, 1);
    print_message("# standing feet slide by %.1f %% of the way that feet go, held %.1f %%, a clip alone %.1f %%\n",
                  100.0 * free_feet, 100.0 * held, 100.0 * alone);
    assert_true(alone < 0.03);
    assert_true(held < 0.05);
    assert_true(held < 0.5 * free_feet);
    free(s);
}

/* It goes as fast as the stick says, and there, and stops. */
static void it_goes_and_stops(void **state)
{
    cast c;
    noh_actor actor;
    seen from, to;
    (void)state;
    describe(&c, &plain);
    cast_make(&c, NULL);
    actor = spawn(&c);
    for (int n = 0; n < 4; n++) {
        const double angle = n * PI / 2.0, speed = n % 2 ? 0.5 : 0.9;
        push(&c, actor, angle, speed);
        for (int i = 0; i < 2 * 60; i++) step(&c);
        from = see(&c, actor);
        for (int i = 0; i < 4 * 60; i++) step(&c);
        to = see(&c, actor);
        const double along = ((to.x - from.x) * sin(angle) + (to.z - from.z) * cos(angle)) / 4.0;
        const double across = ((to.x - from.x) * cos(angle) - (to.z - from.z) * sin(angle)) / 4.0;
        print_message("# asked for %.2f: %.2f along, %.2f across\n", speed, along, across);
        assert_true(fabs(along - speed) < 0.15);
        assert_true(fabs(across) < 0.15);
    }
    push(&c, actor, 0.0, 0.0);
    for (int i = 0; i < 2 * 60; i++) step(&c);
    from = see(&c, actor);
    for (int i = 0; i < 2 * 60; i++) step(&c);
    to = see(&c, actor);
    assert_true(hypot(to.x - from.x, to.z - from.z) < 0.05);
    cast_end(&c);
}

/* ---- tags ---- */

/* A clip with the tag plays, and no other. */
static void tags_are_kept(void **state)
{
    noh_match_goal goal = { .velocity = { 0.0f, 0.0f, 0.5f }, .tags = "first" };
    cast c;
    noh_actor actor;
    (void)state;
    describe(&c, &plain);
    cast_make(&c, NULL);
    actor = spawn(&c);
    for (int n = 0; n < 8; n++) {
        goal.velocity[n % 2 ? 0 : 2] = n % 4 ? 0.9f : -0.5f;
        assert_int_equal(noh_actor_match(c.stage, actor, &goal, NULL), NOH_OK);
        for (int i = 0; i < 90; i++) {
            step(&c);
            assert_string_equal(noh_stage_name(c.stage, 0, NOH_NAME_CLIP, see(&c, actor).track->clip), "roam_0");
        }
    }
    cast_end(&c);
}

/* ---- state ---- */

static void drive(cast *c, const noh_actor *actors, int from, int to)
{
    for (int i = from; i < to; i++) {
        if (i % 45 == 0) push(c, actors[i / 45 % 2], i * 0.7, i % 90 ? 0.9 : 0.5);
        step(c);
    }
}

static void it_is_saved_and_forked(void **state)
{
    cast a, b;
    noh_actor actors[2], others[2];
    const void *now;
    size_t bytes;
    void *kept;
    uint64_t end;
    soles *s = test_zeros(sizeof *s);
    (void)state;
    describe(&a, &plain);
    describe(&b, &plain);
    add_feet(&a, s);
    add_feet(&b, s);
    b.desc.job_count = 3;
    cast_make(&a, NULL);
    cast_make(&b, NULL);
    for (int i = 0; i < 2; i++) {
        actors[i] = spawn_posed(&a);
        others[i] = spawn_posed(&b);
    }
    drive(&a, actors, 0, 200);
    now = noh_stage_state(a.stage, &bytes);
    kept = test_aligned(now, bytes);
    drive(&a, actors, 200, 500);
    end = noh_stage_hash(a.stage);
    assert_int_equal(noh_stage_set_state(a.stage, kept, bytes, NULL), NOH_OK);
    drive(&a, actors, 200, 500);
    assert_true(noh_stage_hash(a.stage) == end);
    assert_int_equal(noh_stage_set_state(b.stage, kept, bytes, NULL), NOH_OK);
    drive(&b, others, 200, 500);
    assert_true(noh_stage_hash(b.stage) == end);
    free(kept);
    free(s);
    cast_end(&a);
    cast_end(&b);
}

/* Whatever bits a state has, it is refused, or stepped without harm. */
static void damaged_states_do_no_harm(void **state)
{
    test_random r = test_random_from(5);
    cast c;
    noh_actor actors[2];
    const void *now;
    size_t bytes;
    uint8_t *kept;
    int opened = 0;
    (void)state;
    describe(&c, &plain);
    cast_make(&c, NULL);
    for (int i = 0; i < 2; i++) actors[i] = spawn(&c);
    drive(&c, actors, 0, 100);
    now = noh_stage_state(c.stage, &bytes);
    kept = test_aligned(now, bytes);
    for (int i = 0; i < test_rounds(400); i++) {
        const uint32_t at = test_random_below(&r, (uint32_t)bytes), bit = test_random_below(&r, 8);
        kept[at] = (uint8_t)(kept[at] ^ 1u << bit);
        if (noh_stage_set_state(c.stage, kept, bytes, NULL) == NOH_OK) {
            step(&c);
            opened++;
        }
        kept[at] = (uint8_t)(kept[at] ^ 1u << bit);
    }
    assert_true(opened > 0);
    free(kept);
    cast_end(&c);
}

/* ---- what is refused ---- */

static void refused(cast *c, const char *what)
{
    noh_stage_plan plan;
    if (noh_stage_plan_make(&c->desc, NULL, &plan, &said) == NOH_OK || !strstr(said.what, what)) {
        fail_msg("'%s', not '%s'", said.what, what);
    }
}

static void bad_descs_are_refused(void **state)
{
    noh_kind_match match = { 0 };
    cast c;
    (void)state;
    describe(&c, &match);
    c.kinds[0].inertia = 0;
    refused(&c, "room for inertia");
    c.kinds[0].inertia = 1;
    c.kinds[0].root_axes = NOH_ROOT_X;
    refused(&c, "root_axes");
    c.kinds[0].root_axes = NOH_ROOT_GROUND;
    c.kinds[0].clips = NULL;
    refused(&c, "noh build --match");
    c.kinds[0].clips = &c.packs[ROAM];
    match.layer = 3;
    refused(&c, "layer");
    match.layer = 0;
    match.response_s = 11.0f;
    refused(&c, "response_s");
    match.response_s = 0.0f;
    match.bias = -1.0f;
    refused(&c, "bias");
    match.bias = 0.0f;
    match.steer = 1.5f;
    refused(&c, "steer");
    match.steer = 0.0f;
    c.kinds[0].match.type = NULL;
    c.kinds[0].springs = noh_match_module(&match);
    refused(&c, "module of another field");
    for (int i = 0; i < 2; i++) noh_file_unmap(&c.files[i]);
}

/* A copy of a pack whose clips have a callback key each, named by an offset of its strings. */
static uint8_t *with_keys(const noh_pack *from, uint32_t name, noh_pack *pack)
{
    const noh_chunk_run run = from->runs[NOH_CHUNK_CLIP];
    const size_t most = from->byte_count + run.count * 128u, room = 32; /* a key and its padding */
    const noh_clip_event key = { .name = name, .name_hash = noh_hash_name("") };
    uint8_t *out = test_aligned(NULL, most);
    noh_pack_chunk *chunks = (noh_pack_chunk *)(void *)(out + sizeof(noh_pack_header));
    size_t at = from->chunks[0].offset;
    memset(out, 0, most);
    memcpy(out, from->bytes, at);
    for (uint32_t i = 0; i < from->chunk_count; i++) {
        const uint8_t *bytes = from->bytes + from->chunks[i].offset;
        noh_clip_header *h = (noh_clip_header *)(void *)(out + at);
        memcpy(out + at, bytes, chunks[i].bytes);
        chunks[i].offset = (uint32_t)at;
        if (i - run.first < run.count) {
            const uint32_t head = h->events_offset;
            assert_int_equal(h->event_count, 0);
            memcpy(out + at + head + room, bytes + head, chunks[i].bytes - head);
            memset(out + at + head, 0, room);
            memcpy(out + at + head, &key, sizeof key);
            h->event_count = 1;
            h->markers_offset += (uint32_t)room;
            h->joint_errors_offset += (uint32_t)room;
            h->clip_offset += (uint32_t)room;
            chunks[i].bytes += (uint32_t)room;
        }
        at = (at + chunks[i].bytes + 63u) & ~(size_t)63u;
    }
    ((noh_pack_header *)(void *)out)->byte_count = (uint32_t)at;
    pack_repair(out, at);
    *pack = test_open(out, at);
    return out;
}

/* A table's pack, and another with the same clips and without a table; clips have keys. */
typedef struct two_packs {
    cast c;
    noh_pack own, other;
    uint8_t *bytes[2]; /* of each */
    const noh_pack *packs[2];
} two_packs;

static void two_open(two_packs *t)
{
    describe(&t->c, NULL);
    t->bytes[0] = with_keys(&t->c.packs[ROAM], 0, &t->own);
    t->bytes[1] = with_keys(&t->c.packs[ROAM], t->own.string_bytes - 1u, &t->other);
    t->other.runs[NOH_CHUNK_MATCH].count = 0;
    t->c.kinds[0].clips = NULL;
    t->c.kinds[0].clip_packs = t->packs;
    t->c.kinds[0].clip_pack_count = 2;
}

static void two_close(two_packs *t)
{
    for (int i = 0; i < 2; i++) {
        free(t->bytes[i]);
        noh_file_unmap(&t->c.files[i]);
    }
}

static void opens(two_packs *t, int later, int refused)
{
    noh_stage_plan plan;
    noh_stage *stage;
    void *memory;
    t->packs[later] = &t->own;
    t->packs[!later] = &t->other;
    assert_int_equal(noh_stage_plan_make(&t->c.desc, NULL, &plan, NULL), NOH_OK);
    memory = malloc((size_t)plan.cpu_bytes);
    const noh_result made = noh_stage_init(memory, (size_t)plan.cpu_bytes, NULL, &t->c.desc, &plan, &stage, &said);
    assert_int_equal(made, refused ? NOH_ERR_DATA : NOH_OK);
    if (refused) assert_non_null(strstr(said.what, "a later pack replaces a clip"));
    free(memory);
}

static noh_pack_chunk *clip_chunk(const noh_pack *pack, uint32_t clip)
{
    return (noh_pack_chunk *)(uintptr_t)&pack->chunks[pack->runs[NOH_CHUNK_CLIP].first + clip];
}

/* A later pack may have a clip of the table again, whatever the offsets of its keys' names. A clip of that name that
 * moves otherwise than the rows of the table say is refused. */
static void replaced_clips_are_refused(void **state)
{
    two_packs t;
    noh_pack_chunk *first, *second, kept;
    const noh_skeleton_header *h;
    (void)state;
    two_open(&t);
    for (int later = 0; later < 2; later++) opens(&t, later, 0); /* whether the table's pack comes later */
    first = clip_chunk(&t.other, 0);
    second = clip_chunk(&t.other, 1);
    kept = *first;
    first->name = second->name, first->name_hash = second->name_hash;
    second->name = kept.name, second->name_hash = kept.name_hash;
    for (int later = 0; later < 2; later++) opens(&t, later, !later);
    two_close(&t);
    two_open(&t);
    h = noh_pack_chunk_at(&t.other, NOH_CHUNK_SKELETON, 0);
    t.bytes[1][(const uint8_t *)h - t.bytes[1] + h->bind_offset + 44u] ^= 1u; /* of a joint below the root */
    for (int later = 0; later < 2; later++) opens(&t, later, !later);
    two_close(&t);
}

/* Each pack in turn has the second clip's name also for a clip of another skeleton, which comes first and does not
 * play. */
static void clips_of_other_skeletons_replace_nothing(void **state)
{
    (void)state;
    for (int which = 0; which < 2; which++) {
        two_packs t;
        noh_pack *pack = which ? &t.other : &t.own;
        noh_pack_chunk *first;
        two_open(&t);
        first = clip_chunk(pack, 0);
        first->name = clip_chunk(pack, 1)->name;
        first->name_hash = clip_chunk(pack, 1)->name_hash;
        ((noh_clip_header *)(void *)(t.bytes[which] + first->offset))->skeleton_hash ^= 1u;
        opens(&t, 0, 0);
        two_close(&t);
    }
}

static void bad_goals_are_refused(void **state)
{
    noh_match_goal goal = { .velocity = { NAN, 0, 0 } };
    const noh_actor nobody = { 0 };
    cast c;
    noh_actor actor;
    (void)state;
    describe(&c, NULL);
    cast_make(&c, NULL);
    actor = spawn(&c);
    assert_int_equal(noh_actor_match(c.stage, actor, &goal, &said), NOH_ERR_ARG);
    goal.velocity[0] = 0.0f;
    assert_int_equal(noh_actor_match(c.stage, nobody, &goal, &said), NOH_ERR_NOT_FOUND);
    goal.tags = "nowhere";
    assert_int_equal(noh_actor_match(c.stage, actor, &goal, &said), NOH_ERR_NOT_FOUND);
    goal.tags = "";
    assert_int_equal(noh_actor_match(c.stage, actor, &goal, &said), NOH_OK);
    step(&c);
    assert_non_null(see(&c, actor).track);
    assert_int_equal(noh_actor_match(c.stage, actor, NULL, &said), NOH_OK);
    cast_end(&c);
}

/* Clips by need: where the table's choice is absent the actor keeps what it plays, and what it would play is wanted. */
static void an_absent_choice_leaves_what_plays(void **state)
{
    const noh_stage_stats *stats;
    uint32_t kept = 0;
    cast c;
    noh_actor actor;
    (void)state;
    describe(&c, &plain);
    c.kinds[0].clip_reserve = 1u << 20;
    cast_make(&c, NULL);
    stats = noh_stage_stats_of(c.stage);
    actor = spawn(&c);
    push(&c, actor, 0.0, 0.9);
    for (int i = 0; i < 30; i++) step(&c);
    assert_null(see(&c, actor).track);
    assert_true(stats->wanted_count > 0);
    for (int n = 0; n < 12; n++) {
        push(&c, actor, PI * (double)n, n % 3 == 2 ? 0.0 : 0.9);
        for (int i = 0; i < 30; i++) {
            const noh_track *track = see(&c, actor).track;
            const uint32_t before = track ? track->clip : NOH_NONE, asked = stats->wanted_count;
            step(&c);
            track = see(&c, actor).track;
            if (stats->wanted_count == asked) continue;
            assert_int_equal(track ? track->clip : NOH_NONE, before);
            kept += before != NOH_NONE;
        }
        while (stats->wanted_count) {
            const noh_wanted_clip w = stats->wanted[0];
            const uint8_t *chunk = (const uint8_t *)c.files[ROAM].data + w.offset;
            if (noh_stage_load_clip(c.stage, w.kind, w.clip, chunk, &said) != NOH_OK) fail_msg("%s", said.what);
        }
    }
    assert_non_null(see(&c, actor).track);
    assert_true(kept > 0);
    cast_end(&c);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(an_absent_choice_leaves_what_plays),
    cmocka_unit_test(a_turned_stick_is_followed),
    cmocka_unit_test(standing_feet_stay),
    cmocka_unit_test(it_goes_and_stops),
    cmocka_unit_test(tags_are_kept),
    cmocka_unit_test(it_is_saved_and_forked),
    cmocka_unit_test(damaged_states_do_no_harm),
    cmocka_unit_test(bad_descs_are_refused),
    cmocka_unit_test(bad_goals_are_refused),
    cmocka_unit_test(replaced_clips_are_refused),
    cmocka_unit_test(clips_of_other_skeletons_replace_nothing),
};

TEST_MAIN(tests, NULL, NULL)
