/* test_clip_packs.c: several packs of clips in one clip bank: equal to one pack of them all; what a later pack
 * replaces, leaves alone or breaks.
 * cross: long, encodes clips */
#include "support/set_fixture.h"

#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/low_core.h"
#include "noh/low_stage.h"
#include "noh/pack.h"

#define JOINTS 6u
#define FRAMES 90u /* four segments */
#define SAMPLES 100
#define IN_PACK(pack, index) ((uint64_t)(pack) << 32 | (index))

static noh_clip_bank_desc desc_of(const noh_pack *const *packs, uint32_t count)
{
    noh_clip_bank_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.clip_packs = packs;
    desc.clip_pack_count = count;
    return desc;
}

static noh_clip_bank *bank_of(const noh_pack *const *packs, uint32_t count)
{
    const noh_clip_bank_desc desc = desc_of(packs, count);
    return test_clip_bank(&desc);
}

/* A key whose payload says which clip it is of, and a marker. */
static void add_keys(raw_clip *clip, uint8_t payload)
{
    raw_event event;
    memset(&event, 0, sizeof event);
    event.name = model_string("key");
    event.time_s = 0.01 * (double)payload;
    event.payload[0] = payload;
    assert_int_equal(raw_clip_add_event(clip, &event), 0);
    event.is_marker = 1;
    assert_int_equal(raw_clip_add_event(clip, &event), 0);
    free(event.name);
}

static void rename_to(char **name, const char *to)
{
    free(*name);
    *name = model_string(to);
}

/* The clips of these numbers, named "clip" and the number; their motion and floats follow from it too. */
static raw_set *raw_of(uint32_t joints, const uint32_t *numbers, uint32_t count)
{
    raw_set *raw = raw_set_new(joints, count);
    set_fixture_joints(&raw->skeleton);
    for (uint32_t i = 0; i < count; i++) {
        set_fixture_clip(&raw->skeleton, &raw->clips[i], numbers[i], FRAMES + 7u * numbers[i]);
        add_keys(&raw->clips[i], (uint8_t)(numbers[i] + 1u));
    }
    return raw;
}

static set_fixture pack_of(const uint32_t *numbers, uint32_t count)
{
    return set_fixture_of(raw_of(JOINTS, numbers, count));
}

/* One clip, of another number's motion and floats under the name "clip1". */
static set_fixture pack_of_another_clip1(uint32_t joints, uint32_t number)
{
    raw_set *raw = raw_of(joints, &number, 1);
    rename_to(&raw->clips[0].name, "clip1");
    return set_fixture_of(raw);
}

/* ---- comparing ---- */

static void expect_same_clip(noh_clip_bank *a, uint32_t clip_a, noh_clip_bank *b, uint32_t clip_b)
{
    test_random r = test_random_from(7);
    const uint32_t joints = a->clips.joint_count, floats = a->clips.float_count;
    noh_transform *poses = test_zeros(2u * JOINTS * sizeof *poses);
    float *values = test_zeros(2u * (size_t)floats * sizeof *values);
    assert_int_equal(a->clips.clips[clip_a].duration_ticks, b->clips.clips[clip_b].duration_ticks);
    assert_int_equal(joints, b->clips.joint_count);
    for (int i = 0; i < SAMPLES; i++) {
        const uint32_t tick = test_random_below(&r, a->clips.clips[clip_a].duration_ticks + 1u);
        a->clips.sample(a->clips.user, clip_a, tick, joints, poses, floats, values);
        b->clips.sample(b->clips.user, clip_b, tick, joints, poses + joints, b->clips.float_count, values + floats);
        assert_memory_equal(poses, poses + joints, joints * sizeof *poses);
        if (b->clips.float_count == floats) assert_memory_equal(values, values + floats, floats * sizeof *values);
    }
    free(poses);
    free(values);
}

static void expect_same_set(noh_clip_bank *a, noh_clip_bank *b)
{
    const noh_clip_set *x = &a->clips, *y = &b->clips;
    assert_int_equal(x->clip_count, y->clip_count);
    assert_int_equal(x->event_count, y->event_count);
    assert_int_equal(x->marker_count, y->marker_count);
    assert_int_equal(x->float_count, y->float_count);
    assert_int_equal(a->group_count, b->group_count);
    assert_memory_equal(x->clips, y->clips, x->clip_count * sizeof *x->clips);
    assert_memory_equal(x->events, y->events, x->event_count * sizeof *x->events);
    assert_memory_equal(x->markers, y->markers, x->marker_count * sizeof *x->markers);
    assert_memory_equal(a->groups, b->groups, a->group_count * sizeof *a->groups);
    assert_memory_equal(x->roots, y->roots, x->clip_count * sizeof *x->roots);
    for (uint32_t i = 0; i < x->clip_count; i++) {
        expect_same_clip(a, i, b, i);
    }
}

static void expect_same_tables(const noh_clip_bank *a, const noh_clip_bank_desc *of_a, const noh_clip_bank *b,
                               const noh_clip_bank_desc *of_b)
{
    noh_lod_pack_desc descs[2];
    noh_lod_pack made[2];
    uint8_t *memory[2];
    memset(descs, 0, sizeof descs);
    descs[0].set = a, descs[0].set_desc = of_a;
    descs[1].set = b, descs[1].set_desc = of_b;
    for (int i = 0; i < 2; i++) {
        const size_t bytes = noh_lod_pack_size(&descs[i]);
        memory[i] = test_aligned(NULL, bytes);
        assert_int_equal(noh_lod_pack_init(memory[i], bytes, &descs[i], &made[i], NULL), NOH_OK);
    }
    assert_true(made[0].table.joint_level_count > 0);
    assert_int_equal(made[0].table.joint_level_count, made[1].table.joint_level_count);
    assert_memory_equal(made[0].table.joints, made[1].table.joints,
                        made[0].table.joint_level_count * sizeof *made[0].table.joints);
    assert_memory_equal(made[0].table.update_error_m, made[1].table.update_error_m,
                        a->clips.clip_count * (size_t)NOH_UPDATE_RATE_COUNT * sizeof(float));
    free(memory[0]);
    free(memory[1]);
}

/* ---- equal to one pack ---- */

static void several_packs_equal_one_of_all_their_clips(void **state)
{
    static const uint32_t numbers[] = { 0, 1, 2, 3 };
    set_fixture merged = pack_of(numbers, 4), parts[3];
    const noh_pack *packs[3];
    noh_clip_bank_desc one, several;
    noh_clip_bank_needs needs[2];
    noh_clip_bank *a, *b;
    (void)state;
    parts[0] = pack_of(numbers, 2);
    parts[1] = pack_of(numbers + 2, 1);
    parts[2] = pack_of(numbers + 3, 1);
    for (int i = 0; i < 3; i++) {
        packs[i] = &parts[i].pack;
    }
    several = desc_of(packs, 3);
    several.root_axes = NOH_ROOT_GROUND;
    several.root_up = 1;
    one = several;
    one.clip_packs = NULL;
    one.clip_pack_count = 0;
    one.clips = &merged.pack;
    assert_int_equal(noh_clip_bank_measure(&one, &needs[0], NULL), NOH_OK);
    assert_int_equal(noh_clip_bank_measure(&several, &needs[1], NULL), NOH_OK);
    assert_int_equal(needs[0].bytes, needs[1].bytes);
    assert_int_equal(needs[0].view_bytes, needs[1].view_bytes);
    assert_int_equal(needs[0].segment_count, needs[1].segment_count);
    a = test_clip_bank(&one);
    b = test_clip_bank(&several);
    expect_same_set(a, b);
    expect_same_tables(a, &one, b, &several);
    for (uint32_t i = 0; i < 4; i++) {
        assert_int_equal(a->packs[i], 0);
        assert_int_equal(a->pack_clips[i], i);
        assert_int_equal(b->packs[i], i < 2 ? 0 : i - 1);
        assert_int_equal(b->pack_clips[i], i < 2 ? i : 0);
    }
    free(a);
    free(b);
    free(merged.bytes);
    for (int i = 0; i < 3; i++) {
        free(parts[i].bytes);
    }
}

static void a_view_of_several_packs_gives_the_bits_of_the_bank(void **state)
{
    static const uint32_t numbers[] = { 0, 1 };
    set_fixture x = pack_of(numbers, 1), y = pack_of(numbers + 1, 1);
    const noh_pack *packs[2];
    noh_clip_bank *bank;
    noh_clip_bank_view *view;
    uint8_t *memory;
    size_t bytes;
    (void)state;
    packs[0] = &x.pack, packs[1] = &y.pack;
    bank = bank_of(packs, 2);
    bytes = noh_clip_bank_view_size(bank);
    memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_clip_bank_view_init(memory, bytes, bank, &view, NULL), NOH_OK);
    for (uint32_t clip = 0; clip < 2; clip++) {
        for (uint32_t tick = 0; tick < 90000; tick += 7919) {
            noh_transform a[JOINTS], b[JOINTS];
            float f[3], g[3];
            bank->clips.sample(bank->clips.user, clip, tick, JOINTS, a, 3, f);
            view->clips.sample(view->clips.user, clip, tick, JOINTS, b, 3, g);
            assert_memory_equal(a, b, sizeof a);
            assert_memory_equal(f, g, sizeof f);
        }
    }
    free(memory);
    free(bank);
    free(x.bytes);
    free(y.bytes);
}

/* ---- clips of one name ---- */

static void a_later_pack_replaces_a_clip_in_its_place(void **state)
{
    static const uint32_t numbers[] = { 0, 1, 2 };
    static const uint32_t from[2][4] = { { 0, 1, 0, 2 }, { 0, 0, 2, 0 } }; /* pack, index in it */
    const uint32_t added = 5;
    set_fixture game = pack_of(numbers, 3), mended = pack_of_another_clip1(JOINTS, 4), more = pack_of(&added, 1);
    const noh_pack *packs[3];
    noh_clip_bank *bank, *alone;
    (void)state;
    packs[0] = &game.pack, packs[1] = &mended.pack, packs[2] = &more.pack;
    bank = bank_of(packs, 3);
    alone = bank_of(packs + 1, 1);
    assert_int_equal(bank->clips.clip_count, 4);
    assert_int_equal(bank->replaced_count, 1);
    assert_int_equal(bank->foreign_count, 0);
    for (uint32_t i = 0; i < 4; i++) {
        assert_int_equal(bank->packs[i], from[0][i]);
        assert_int_equal(bank->pack_clips[i], from[1][i]);
    }
    assert_int_equal(noh_clip_bank_find(bank, "clip1"), 1);
    assert_int_equal(noh_clip_bank_find(bank, "clip2"), 2);
    assert_int_equal(noh_clip_bank_find(bank, "clip5"), 3);
    expect_same_clip(bank, 1, alone, 0);
    assert_int_equal(bank->clips.events[bank->clips.clips[1].first_event].payload[0], 5);
    assert_int_equal(bank->clips.event_count, 4);
    /* glow and one of each clip that is played, none of the clip that was replaced */
    assert_int_equal(bank->clips.float_count, 5);
    for (uint32_t g = 0; g < bank->group_count; g++) {
        assert_int_not_equal(bank->groups[g].name_hash, noh_hash_name("clip1"));
    }
    free(bank);
    free(alone);
    free(game.bytes);
    free(mended.bytes);
    free(more.bytes);
}

static void of_three_packs_the_last_gives_the_clip(void **state)
{
    static const uint32_t numbers[] = { 0, 1 };
    set_fixture game = pack_of(numbers, 2), first = pack_of_another_clip1(JOINTS, 4),
                second = pack_of_another_clip1(JOINTS, 6);
    const noh_pack *packs[3];
    noh_clip_bank_desc desc;
    noh_clip_bank_needs needs;
    noh_clip_bank *bank, *alone;
    (void)state;
    packs[0] = &game.pack, packs[1] = &first.pack, packs[2] = &second.pack;
    desc = desc_of(packs, 3);
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
    assert_int_equal(needs.replaced_count, 2);
    bank = bank_of(packs, 3);
    alone = bank_of(packs + 2, 1);
    assert_int_equal(bank->clips.clip_count, 2);
    assert_int_equal(bank->packs[1], 2);
    expect_same_clip(bank, 1, alone, 0);
    free(bank);
    free(alone);
    free(game.bytes);
    free(first.bytes);
    free(second.bytes);
}

static void a_clip_of_another_skeleton_replaces_none_and_is_counted(void **state)
{
    static const uint32_t numbers[] = { 0, 1 };
    set_fixture game = pack_of(numbers, 2), other = pack_of_another_clip1(JOINTS + 1u, 4);
    const noh_pack *packs[2];
    noh_clip_bank_desc desc;
    noh_clip_bank_needs needs;
    noh_clip_bank *bank;
    (void)state;
    packs[0] = &game.pack, packs[1] = &other.pack;
    desc = desc_of(packs, 2);
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, NULL), NOH_OK);
    assert_int_equal(needs.foreign_count, 1);
    assert_int_equal(needs.replaced_count, 0);
    bank = bank_of(packs, 2);
    assert_int_equal(bank->clips.clip_count, 2);
    assert_int_equal(bank->foreign_count, 1);
    assert_int_equal(bank->packs[1], 0);
    free(bank);
    desc.mesh = &other.pack; /* now the first pack's clips are the foreign ones */
    bank = test_clip_bank(&desc);
    assert_int_equal(bank->clips.clip_count, 1);
    assert_int_equal(bank->foreign_count, 2);
    assert_int_equal(bank->packs[0], 1);
    free(bank);
    free(game.bytes);
    free(other.bytes);
}

/* ---- clips of another skeleton, through a map ---- */

#define OWN "clip1"

/* The source has a joint more, which the target leaves out. */
static void leave_out_last(const noh_clip_map *map, const noh_transform *from, uint32_t joint_count, noh_transform *to)
{
    assert_in_range(joint_count, 1, map->target->joint_count);
    memcpy(to, from, joint_count * sizeof *to);
}

static noh_skeleton skeleton_of(const noh_pack *pack, uint32_t index)
{
    noh_skeleton s;
    assert_int_equal(noh_pack_skeleton_at(pack, index, &s, NULL, NULL), NOH_OK);
    return s;
}

static raw_set *own_clip1(uint32_t number)
{
    raw_set *raw = raw_of(JOINTS, &number, 1);
    rename_to(&raw->clips[0].name, OWN);
    return raw;
}

/* Both skeletons in one pack, in either order: the source's clips "clip0" and "clip1", and an own "clip1". */
static set_fixture pack_of_both(int own_is_first)
{
    static const uint32_t numbers[] = { 0, 1 };
    raw_set *theirs = raw_of(JOINTS + 1u, numbers, 2), *ours = own_clip1(4);
    raw_set *raws[] = { own_is_first ? ours : theirs, own_is_first ? theirs : ours };
    return set_fixture_of_sets(raws, 2, NULL);
}

/* Where the bank's clip of this name is from, and how many joints it has. */
static void expect_from(const noh_clip_bank *bank, const noh_pack *const *packs, const char *name, uint32_t pack,
                        uint32_t joints)
{
    const uint32_t clip = noh_clip_bank_find(bank, name);
    noh_pack_clip found;
    assert_int_not_equal(clip, NOH_NONE);
    assert_int_equal(bank->packs[clip], pack);
    assert_int_equal(noh_pack_clip_at(packs[pack], bank->pack_clips[clip], &found, NULL), NOH_OK);
    assert_int_equal(found.header->joint_count, joints);
}

static void in_one_pack_own_clips_hide_mapped_ones(void **state)
{
    (void)state;
    for (int own_is_first = 0; own_is_first < 2; own_is_first++) {
        set_fixture both = pack_of_both(own_is_first), ours = set_fixture_of(own_clip1(5));
        const noh_pack *packs[] = { &ours.pack, &both.pack };
        const uint32_t own = own_is_first ? 0u : 1u;
        const noh_skeleton source = skeleton_of(&both.pack, 1u - own), target = skeleton_of(&both.pack, own);
        const noh_clip_map map = { &source, &target, 1.0f, leave_out_last, 0 };
        noh_clip_bank_desc desc = { .clips = &both.pack, .skeleton = own, .map = &map };
        noh_clip_bank *bank = test_clip_bank(&desc);
        assert_int_equal(bank->clips.clip_count, 2);
        assert_int_equal(bank->replaced_count, 1);
        expect_from(bank, packs + 1, OWN, 0, JOINTS);
        expect_from(bank, packs + 1, "clip0", 0, JOINTS + 1u);
        free(bank);
        /* the same in a pack that replaces an earlier one's */
        desc = desc_of(packs, 2);
        desc.map = &map;
        bank = test_clip_bank(&desc);
        assert_int_equal(bank->clips.clip_count, 2);
        assert_int_equal(bank->replaced_count, 2);
        expect_from(bank, packs, OWN, 1, JOINTS);
        expect_from(bank, packs, "clip0", 1, JOINTS + 1u);
        free(bank);
        free(both.bytes);
        free(ours.bytes);
    }
}

static void of_two_packs_the_last_gives_own_and_mapped_clips(void **state)
{
    static const uint32_t numbers[] = { 0, 1 };
    set_fixture ours = set_fixture_of(own_clip1(4)), theirs = set_fixture_of(raw_of(JOINTS + 1u, numbers, 2));
    const noh_skeleton source = skeleton_of(&theirs.pack, 0), target = skeleton_of(&ours.pack, 0);
    const noh_clip_map map = { &source, &target, 1.0f, leave_out_last, 0 };
    (void)state;
    for (uint32_t own_at = 0; own_at < 2; own_at++) {
        const noh_pack *packs[] = { own_at ? &theirs.pack : &ours.pack, own_at ? &ours.pack : &theirs.pack };
        noh_clip_bank_desc desc = desc_of(packs, 2);
        desc.mesh = &ours.pack;
        desc.map = &map;
        noh_clip_bank *bank = test_clip_bank(&desc);
        assert_int_equal(bank->clips.clip_count, 2);
        expect_from(bank, packs, OWN, 1, own_at ? JOINTS : JOINTS + 1u);
        expect_from(bank, packs, "clip0", 1u - own_at, JOINTS + 1u);
        free(bank);
    }
    free(ours.bytes);
    free(theirs.bytes);
}

/* ---- what is refused ---- */

static void expect_error(const noh_clip_bank_desc *desc, noh_result result, const char *word, uint64_t where)
{
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_clip_bank *bank = NULL;
    uint8_t *memory = test_aligned(NULL, 1u << 20);
    assert_int_equal(noh_clip_bank_init(memory, 1u << 20, desc, &bank, &error), result);
    if (!strstr(error.what, word)) {
        fail_msg("'%s' does not say '%s'", error.what, word);
    }
    assert_true(error.where == where);
    assert_null(bank);
    free(memory);
}

static void errors_say_which_pack(void **state)
{
    static const uint32_t numbers[] = { 0, 1, 2 };
    set_fixture game = pack_of(numbers, 1), more = pack_of(numbers + 1, 2);
    const noh_pack *packs[2];
    noh_clip_bank_desc desc;
    noh_pack_clip clip;
    noh_clip_event *event;
    uint32_t tick;
    uint8_t *codec;
    (void)state;
    packs[0] = &game.pack, packs[1] = &more.pack;
    desc = desc_of(packs, 2);
    (void)noh_pack_clip_at(&more.pack, 1, &clip, NULL);
    event = (noh_clip_event *)(void *)(more.bytes + ((const uint8_t *)(const void *)clip.events - more.bytes));
    tick = event->tick;
    event->tick = 1u << 30;
    expect_error(&desc, NOH_ERR_DATA, "event's tick is after the end", IN_PACK(1, 1));
    event->tick = tick;
    codec = more.bytes + (clip.bytes - more.bytes);
    codec[1] ^= 0x80u; /* a flag that does not exist */
    expect_error(&desc, NOH_ERR_DATA, "", IN_PACK(1, 1));
    free(game.bytes);
    free(more.bytes);
}

static void another_unit_in_a_later_pack_is_refused(void **state)
{
    static const uint32_t numbers[] = { 0, 1 };
    set_fixture game = pack_of(numbers, 1), inches;
    raw_set *raw = raw_of(JOINTS, numbers + 1, 1);
    const noh_pack *packs[2];
    noh_clip_bank_desc desc;
    (void)state;
    raw->skeleton.unit_cm = 2.54;
    inches = set_fixture_of(raw);
    packs[0] = &game.pack, packs[1] = &inches.pack;
    desc = desc_of(packs, 2);
    expect_error(&desc, NOH_ERR_NOT_FOUND, "unit", IN_PACK(1, 0));
    free(game.bytes);
    free(inches.bytes);
}

static void maps_are_checked(void **state)
{
    static const uint32_t numbers[] = { 0, 1 };
    set_fixture ours = set_fixture_of(own_clip1(4)), theirs = set_fixture_of(raw_of(JOINTS + 1u, numbers, 2));
    const noh_skeleton source = skeleton_of(&theirs.pack, 0), target = skeleton_of(&ours.pack, 0);
    noh_skeleton fewer = target;
    fewer.joint_count = JOINTS - 1u;
    const noh_clip_map good = { &source, &target, 1.0f, leave_out_last, 0 };
    const noh_clip_map bad[] = { { NULL, NULL, 0.0f, NULL, 0 },
                                 { NULL, &target, 1.0f, leave_out_last, 0 },
                                 { &source, NULL, 1.0f, leave_out_last, 0 },
                                 { &source, &target, 1.0f, NULL, 0 },
                                 { &source, &source, 1.0f, leave_out_last, 0 },
                                 { &source, &fewer, 1.0f, leave_out_last, 0 },
                                 { &source, &target, 1.0f, leave_out_last, JOINTS + 1u } };
    const noh_pack *packs[] = { &ours.pack, &theirs.pack };
    noh_clip_bank_desc desc = desc_of(packs, 2);
    (void)state;
    desc.map = &good;
    free(test_clip_bank(&desc));
    for (uint32_t i = 0; i < TEST_COUNT(bad); i++) {
        desc.map = &bad[i];
        assert_int_equal(noh_clip_bank_size(&desc, NULL), 0);
        expect_error(&desc, NOH_ERR_ARG, "map", JOINTS);
    }
    free(ours.bytes);
    free(theirs.bytes);
}

static void lists_of_packs_are_checked(void **state)
{
    const uint32_t number = 0;
    set_fixture game = pack_of(&number, 1);
    const noh_pack *packs[2];
    noh_clip_bank_desc desc;
    (void)state;
    packs[0] = &game.pack, packs[1] = NULL;
    desc = desc_of(packs, 2);
    expect_error(&desc, NOH_ERR_ARG, "clip_packs", 1);
    desc = desc_of(packs, 0);
    expect_error(&desc, NOH_ERR_ARG, "clip_pack_count above 0", 0);
    desc = desc_of(NULL, 1);
    expect_error(&desc, NOH_ERR_ARG, "clip_packs", 0);
    desc = desc_of(packs, 1), desc.clips = &game.pack;
    expect_error(&desc, NOH_ERR_ARG, "both", 0);
    free(game.bytes);
}

static void packs_without_clips_are_passed_over_or_not_found(void **state)
{
    const test_model_desc bare = { 1, 3, 2, 0, 1 };
    const uint32_t number = 0;
    size_t count;
    uint8_t *made = test_pack(&bare, &count);
    noh_pack empty = test_open(made, count);
    set_fixture game = pack_of(&number, 1);
    const noh_pack *packs[3];
    noh_clip_bank_desc desc;
    noh_clip_bank *bank;
    (void)state;
    packs[0] = &empty, packs[1] = &game.pack, packs[2] = &empty;
    desc = desc_of(packs, 3);
    desc.mesh = &game.pack;
    bank = test_clip_bank(&desc);
    assert_int_equal(bank->clips.clip_count, 1);
    assert_int_equal(bank->packs[0], 1);
    free(bank);
    packs[1] = &empty;
    expect_error(&desc, NOH_ERR_NOT_FOUND, "no clips", 0);
    free(game.bytes);
    free(made);
}

/* A pack of `count` clips without joints, with names that begin with this letter. */
static set_fixture pack_of_many(uint32_t count, char letter)
{
    raw_set *raw = raw_set_new(0, count);
    raw->skeleton.unit_cm = 1.0;
    for (uint32_t i = 0; i < count; i++) {
        raw_clip *clip = &raw->clips[i];
        char name[16];
        snprintf(name, sizeof name, "%c%u", letter, (unsigned)i);
        clip->name = model_string(name);
        clip->sample_rate_hz = 30.0;
        assert_int_equal(raw_clip_alloc(clip, 2, 0), 0);
        clip->floats = test_zeros(sizeof *clip->floats);
        clip->float_count = 1;
        set_fixture_floats(clip, 0, "glow");
    }
    return set_fixture_of(raw);
}

static void more_clips_than_a_bank_holds_are_refused(void **state)
{
    set_fixture x = pack_of_many(2048, 'a'), y = pack_of_many(2049, 'b');
    const noh_pack *packs[2];
    noh_clip_bank_desc desc;
    noh_clip_bank_needs needs;
    noh_error error = { NOH_OK, "", 0, 0 };
    (void)state;
    packs[0] = packs[1] = &x.pack;
    desc = desc_of(packs, 2);
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, &error), NOH_OK);
    assert_int_equal(needs.shape.clip_count, 2048);
    assert_int_equal(needs.replaced_count, 2048);
    packs[1] = &y.pack;
    assert_int_equal(noh_clip_bank_measure(&desc, &needs, &error), NOH_ERR_LIMIT);
    assert_true(error.where == IN_PACK(1, 2048));
    assert_int_equal(error.need, 4097);
    free(x.bytes);
    free(y.bytes);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(several_packs_equal_one_of_all_their_clips),
    cmocka_unit_test(a_view_of_several_packs_gives_the_bits_of_the_bank),
    cmocka_unit_test(a_later_pack_replaces_a_clip_in_its_place),
    cmocka_unit_test(of_three_packs_the_last_gives_the_clip),
    cmocka_unit_test(a_clip_of_another_skeleton_replaces_none_and_is_counted),
    cmocka_unit_test(errors_say_which_pack),
    cmocka_unit_test(another_unit_in_a_later_pack_is_refused),
    cmocka_unit_test(in_one_pack_own_clips_hide_mapped_ones),
    cmocka_unit_test(of_two_packs_the_last_gives_own_and_mapped_clips),
    cmocka_unit_test(maps_are_checked),
    cmocka_unit_test(lists_of_packs_are_checked),
    cmocka_unit_test(packs_without_clips_are_passed_over_or_not_found),
    cmocka_unit_test(more_clips_than_a_bank_holds_are_refused),
};

TEST_MAIN(tests, NULL, NULL)
