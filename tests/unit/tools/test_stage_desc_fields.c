/* Every field of a stage's description has a key in the text of `noh budget --desc`, or a reason: no byte of a plan
 * depends on it, which is planned here, or another option sets it. The headers are read for their fields. */
#include "support/support.h"

#include <ctype.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "budget/stage_desc_file.h"
#include "cli/message.h"
#include "noh/base.h"
#include "noh/gl_device.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"

#define PUPPET "mesh puppet.noh\nactor_count 4\n"
#define CAST                                                                                                   \
    "kind a\n" PUPPET "clips roam.noh\ninertia 1\nroot_axes ground\nmatch 1\nragdolls 2\nlayer body floats=\n" \
    "face 0.035 1.55 0.11 -0.035 1.55 0.11\n"

/* Whose field it is. */
typedef enum owner {
    OF_STAGE,
    OF_LOD,
    OF_KIND,
    OF_LAYER,
    OF_SET,
    OF_RAGDOLL,
    OF_MATCH,
    OF_LIGHT,
    OF_FACE,
    OWNERS
} owner;

static const struct {
    const char *name, *header;
} structs[OWNERS] = { { "noh_stage_desc", "noh" },     { "noh_lod_settings", "noh" },
                      { "noh_kind_desc", "noh" },      { "noh_layer_desc", "noh" },
                      { "noh_texture_set", "noh" },    { "noh_kind_ragdoll", "modules" },
                      { "noh_kind_match", "modules" }, { "noh_gl_light_desc", "noh_gl" },
                      { "noh_kind_face", "modules" } };

/* A line that sets the field, "" if the cast has one; or a value that changes no byte; or who else sets it. */
typedef struct row {
    owner of;
    const char *field;
    size_t at, bytes;
    const char *line;
    uint64_t value; /* little-endian, of a field without a line */
    const char *why;
} row;

#define AT(type, field) offsetof(type, field), sizeof(((type *)0)->field)
#define STAGE(field, line)                                         \
    {                                                              \
        OF_STAGE, #field, AT(noh_stage_desc, field), line, 0, NULL \
    }
#define KIND(field, line)                                        \
    {                                                            \
        OF_KIND, #field, AT(noh_kind_desc, field), line, 0, NULL \
    }
#define SAME(of, type, field, value)                   \
    {                                                  \
        of, #field, AT(type, field), NULL, value, NULL \
    }
#define OTHER(of, type, field, why)               \
    {                                             \
        of, #field, AT(type, field), NULL, 0, why \
    }
#define QUARTER 0x3e800000u /* of a float */
#define HALF 0x3f000000u
#define EIGHTY 0x42a00000u

static const char *const by_kinds = "the lines of kinds", *const by_code = "what the game computes: planned in C";

static const row rows[] = {
    OTHER(OF_STAGE, noh_stage_desc, kinds, by_kinds),
    OTHER(OF_STAGE, noh_stage_desc, kind_count, by_kinds),
    STAGE(cpu_bytes_max, "cpu_bytes_max 900000000"),
    STAGE(gpu_bytes_max, "gpu_bytes_max 900000000"),
    STAGE(bytes_max, "bytes_max 900000000"),
    OTHER(OF_STAGE, noh_stage_desc, lod, "its own rows"),
    STAGE(height_px, "height_px 720"),
    STAGE(job_count, "jobs 3"),
    STAGE(event_count, "event_count 5"),
    STAGE(load_bytes, "load_bytes 4096"),
    SAME(OF_STAGE, noh_stage_desc, update_budget_ns, 1000),
    SAME(OF_STAGE, noh_stage_desc, slot_moves, 3),
    STAGE(tangents, "tangents 1"),
    STAGE(halves, "halves never"),
    SAME(OF_STAGE, noh_stage_desc, encode_srgb, 1),
    STAGE(full_detail, "full_detail 1"),
    STAGE(shading, "shading phone"),
    STAGE(without_depth, "without_depth 1"),
    STAGE(user_values, "user_values 2"),
    STAGE(motion, "motion 1"),
    STAGE(sort_blended, "sort_blended 1"),
    STAGE(without_shader, "without_shader 1"),
    STAGE(without_transfer, "without_transfer 1"),
    OTHER(OF_STAGE, noh_stage_desc, morph_path, "--path"),
    STAGE(morph_sums, "morph_sums 1"),
    STAGE(light, "light 32 64"),
    STAGE(texture_reserve, "texture_reserve 4000000"),
    OTHER(OF_STAGE, noh_stage_desc, gpu, "--no-gpu"),
    STAGE(share, "share 1"),
    { OF_LOD, "pixels", AT(noh_lod_settings, pixels), "pixels 3", 0, NULL },
    SAME(OF_LOD, noh_lod_settings, shares, HALF),
    SAME(OF_LOD, noh_lod_settings, hysteresis, HALF),
    SAME(OF_LOD, noh_lod_settings, lead, QUARTER),
    SAME(OF_LOD, noh_lod_settings, fade_ticks, 100),
    OTHER(OF_KIND, noh_kind_desc, name, "kind NAME"),
    KIND(mesh, ""),
    KIND(finer, "finer puppet.noh"),
    OTHER(OF_KIND, noh_kind_desc, clips, "a list of one pack: clips PATH"),
    KIND(clip_packs, ""),
    KIND(clip_pack_count, ""),
    KIND(clip_reserve, "clip_reserve 900000"),
    KIND(map, "map puppet.noh"),
    KIND(nodes, "nodes 0"),
    KIND(node_count, "nodes 0"),
    KIND(skeleton, "skeleton none"),
    KIND(actor_count, ""),
    KIND(visible_max, "visible_max 2"),
    KIND(near_count, "near_count 1"),
    KIND(middle_count, "middle_count 1"),
    KIND(finest_level, "finest_level 1"),
    KIND(levels_by_number, "levels_by_number 1"),
    KIND(layers, ""),
    KIND(layer_count, "layer nod add"),
    OTHER(OF_KIND, noh_kind_desc, graphs, "graphs NAMES"),
    KIND(face, ""),
    KIND(ragdoll, ""),
    KIND(springs, "springs world"),
    KIND(match, ""),
    KIND(modifiers, "modifier feet"),
    KIND(modifier_count, "modifier feet"),
    KIND(weight_rules, "weight_rules 1"),
    KIND(change_count, "change_count 7"),
    KIND(held_float_count, "held_float_count 3"),
    KIND(root_axes, ""),
    KIND(sample_rate_needed, "sample_rate_needed 15"),
    KIND(inertia, ""),
    KIND(unpickable, "unpickable 1"),
    KIND(texture_sets, "texture_set red suffix=_red pack=puppet.noh"),
    KIND(texture_set_count, "texture_set red"),
    KIND(worn_by, "worn_by 2"),
    KIND(cover_count, "cover_count 3"),
    KIND(changes, "changes 1"),
    KIND(others, "changes 1\nkind b\n" PUPPET "other_of a\n"),
    KIND(other_count, "changes 1\nkind b\n" PUPPET "other_of a"),
    OTHER(OF_LAYER, noh_layer_desc, name, "layer NAME"),
    OTHER(OF_LAYER, noh_layer_desc, mode, "base, over or add"),
    OTHER(OF_LAYER, noh_layer_desc, joints, "joints="),
    OTHER(OF_LAYER, noh_layer_desc, floats, "floats="),
    OTHER(OF_LAYER, noh_layer_desc, track_count, "tracks="),
    OTHER(OF_SET, noh_texture_set, name, "texture_set NAME"),
    OTHER(OF_SET, noh_texture_set, pack, "pack="),
    OTHER(OF_SET, noh_texture_set, suffix, "suffix="),
    { OF_RAGDOLL, "count", AT(noh_kind_ragdoll, count), NULL, 0, "ragdolls N" },
    SAME(OF_RAGDOLL, noh_kind_ragdoll, substeps, 20),
    SAME(OF_RAGDOLL, noh_kind_ragdoll, mass, EIGHTY),
    { OF_RAGDOLL, "world", AT(noh_kind_ragdoll, world), "ragdoll_world physics", 0, NULL },
    SAME(OF_RAGDOLL, noh_kind_ragdoll, stagger_speed, HALF),
    OTHER(OF_MATCH, noh_kind_match, layer, "a place in the list of layers, which has no bytes"),
    SAME(OF_MATCH, noh_kind_match, search_ticks, 9600),
    SAME(OF_MATCH, noh_kind_match, blend_ticks, 9600),
    SAME(OF_MATCH, noh_kind_match, response_s, HALF),
    SAME(OF_MATCH, noh_kind_match, bias, HALF),
    SAME(OF_MATCH, noh_kind_match, steer, QUARTER),
    { OF_LIGHT, "reflection", AT(noh_gl_light_desc, reflection), NULL, 0, "light SIDE" },
    { OF_LIGHT, "shadow_px", AT(noh_gl_light_desc, shadow_px), NULL, 0, "light SIDE SHADOW" },
    { OF_FACE, "face", AT(noh_kind_face, face), NULL, 0, "face joints, or the centres of the eyes" },
    OTHER(OF_FACE, noh_kind_face, recipes, by_code),
    OTHER(OF_FACE, noh_kind_face, recipe_count, by_code),
    OTHER(OF_FACE, noh_kind_face, head, by_code),
    OTHER(OF_FACE, noh_kind_face, neck, by_code),
    OTHER(OF_FACE, noh_kind_face, chest, by_code),
    OTHER(OF_FACE, noh_kind_face, eyes, by_code),
    SAME(OF_FACE, noh_kind_face, flags, NOH_FACE_CALM),
    OTHER(OF_FACE, noh_kind_face, rules, by_code),
};

/* ---- the headers ---- */

static char *text_of(const char *path)
{
    FILE *file = fopen(path, "rb");
    char *text = test_zeros(1u << 20);
    if (!file) fail_msg("%s: run this test in the folder of the sources", path);
    assert_true(fread(text, 1, (1u << 20) - 1u, file) > 0);
    (void)fclose(file);
    return text;
}

static void strip_comments(char *text)
{
    for (char *at = strstr(text, "/*"); at; at = strstr(at, "/*")) {
        const char *end = strstr(at, "*/");
        assert_non_null(end);
        memset(at, ' ', (size_t)(end - at) + 2u);
    }
}

static int has_row(owner of, const char *field)
{
    int found = 0;
    for (size_t i = 0; i < TEST_COUNT(rows); i++) found += rows[i].of == of && strcmp(rows[i].field, field) == 0;
    return found;
}

/* Each name before a comma or semicolon, without its brackets. Returns how many. */
static int check_fields(owner of, char *body)
{
    int count = 0;
    for (char *at = strtok(body, ",;"); at; at = strtok(NULL, ",;")) {
        char name[64], *end = strchr(at, '[');
        if (!end) end = at + strlen(at);
        while (end > at && !isalnum((unsigned char)end[-1])) end--;
        const char *from = end;
        while (from > at && (isalnum((unsigned char)from[-1]) || from[-1] == '_')) from--;
        if (from == end) continue;
        (void)snprintf(name, sizeof name, "%.*s", (int)(end - from), from);
        if (has_row(of, name) != 1)
            fail_msg(
                "%s.%s has %d rows here: give it a key in tools/noh/budget/stage_desc_keys.c, or say why it needs none",
                structs[of].name, name, has_row(of, name));
        count++;
    }
    return count;
}

static void every_field_has_a_key_or_a_reason(void **state)
{
    int all = 0;
    (void)state;
    for (owner of = 0; of < OWNERS; of++) {
        char path[64], line[64], *text, *from, *to;
        (void)snprintf(path, sizeof path, "runtime/noh/%s.h", structs[of].header);
        text = text_of(path);
        strip_comments(text);
        (void)snprintf(line, sizeof line, "typedef struct %s {", structs[of].name);
        from = strstr(text, line);
        assert_non_null(from);
        from += strlen(line);
        to = strchr(from, '}');
        assert_non_null(to);
        *to = '\0';
        all += check_fields(of, from);
        free(text);
    }
    assert_int_equal(all, TEST_COUNT(rows));
}

/* ---- the keys ---- */

static stage_desc_file *read_cast(const char *of_stage, const char *of_kind)
{
    stage_desc_file *f = NULL;
    const char *path = test_path("cast.txt");
    char text[1024];
    const int length = snprintf(text, sizeof text, "%s\n" CAST "%s\n", of_stage, of_kind);
    assert_in_range(length, 1, sizeof text - 1u);
    test_write_file(path, text, (size_t)length);
    if (stage_desc_file_read(path, &f)) fail_msg("%s: %s", text, tool_last_failure());
    return f;
}

static uint8_t *field_of(stage_desc_file *f, const row *r)
{
    switch (r->of) {
    case OF_STAGE: return (uint8_t *)&f->desc + r->at;
    case OF_LOD: return (uint8_t *)&f->desc.lod + r->at;
    case OF_KIND: return (uint8_t *)&f->kinds[0] + r->at;
    case OF_RAGDOLL: return (uint8_t *)&f->ragdolls[0] + r->at;
    case OF_FACE: return (uint8_t *)&f->faces[0] + r->at;
    default: fail_msg("%s.%s is checked otherwise", structs[r->of].name, r->field);
    }
    return NULL;
}

static void every_key_sets_its_field(void **state)
{
    char *help = text_of("tools/noh/help/help_formats.c");
    stage_desc_file *without = read_cast("", "");
    static const uint8_t zeros[256];
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(rows); i++) {
        const row *r = &rows[i];
        const int of_stage = r->of == OF_STAGE || r->of == OF_LOD;
        char key[64];
        if (!r->line) continue;
        assert_in_range(r->bytes, 1, sizeof zeros);
        stage_desc_file *with = read_cast(of_stage ? r->line : "", of_stage ? "" : r->line);
        if (!memcmp(field_of(with, r), *r->line ? field_of(without, r) : zeros, r->bytes))
            fail_msg("'%s' does not set %s.%s", r->line, structs[r->of].name, r->field);
        (void)snprintf(key, sizeof key, " %.*s ", (int)strcspn(r->line, " "), r->line);
        if (*r->line && !strstr(help, key)) fail_msg("noh help FORMATS lacks '%s'", key);
        stage_desc_file_free(with);
    }
    stage_desc_file_free(without);
    free(help);
}

static noh_stage_plan plan_of(stage_desc_file *f)
{
    noh_gl_caps caps;
    noh_stage_plan plan;
    noh_error error = { NOH_OK, "", 0, 0 };
    noh_gl_caps_nominal(&caps);
    f->desc.gpu = &noh_stage_on_gl;
    if (noh_stage_plan_make(&f->desc, &caps, &plan, &error) != NOH_OK) fail_msg("%s", error.what);
    return plan;
}

static void other_fields_change_no_byte(void **state)
{
    stage_desc_file *f = read_cast("", "");
    const noh_stage_plan plan = plan_of(f);
    noh_kind_match match = { 0 }; /* the kind keeps its address */
    (void)state;
    f->kinds[0].match = noh_match_module(&match);
    for (size_t i = 0; i < TEST_COUNT(rows); i++) {
        const row *r = &rows[i];
        uint8_t kept[64], *at = r->of == OF_MATCH ? (uint8_t *)&match + r->at : NULL;
        if (r->line || r->why) continue;
        if (!at) at = field_of(f, r);
        assert_in_range(r->bytes, 4, sizeof kept);
        memcpy(kept, at, r->bytes);
        memcpy(at, &r->value, r->bytes < sizeof r->value ? r->bytes : sizeof r->value);
        assert_memory_not_equal(at, kept, r->bytes);
        const noh_stage_plan changed = plan_of(f);
        if (changed.cpu_bytes != plan.cpu_bytes || changed.gpu_bytes != plan.gpu_bytes ||
            changed.state_bytes != plan.state_bytes || changed.pack_bytes != plan.pack_bytes)
            fail_msg("%s.%s changes bytes: give it a key", structs[r->of].name, r->field);
        memcpy(at, kept, r->bytes);
    }
    f->kinds[0].root_axes |= NOH_ROOT_BY_GAME; /* a bit without a key: it is no axis */
    const noh_stage_plan by_game = plan_of(f);
    assert_true(by_game.cpu_bytes == plan.cpu_bytes && by_game.hash == plan.hash);
    stage_desc_file_free(f);
}

/* ---- to the byte ---- */

static noh_pack dressed; /* with springs */

static void no_rays(void *user, const noh_world_ray *r, uint32_t count, noh_world_hit *hits)
{
    (void)user, (void)r, (void)count, (void)hits;
}

static void no_touches(void *user, const noh_world_body *bodies, uint32_t count, noh_touches *touches)
{
    (void)user, (void)bodies, (void)count, (void)touches;
}

/* What lines say of worlds, modifiers and light takes the bytes of real ones. */
static void what_lies_behind_a_key_has_its_bytes(void **state)
{
    static const noh_world_physics physics = { no_rays, no_touches, NULL, 1 };
    static const noh_plane floor = { { 0, 1, 0 }, 0 };
    static const noh_world solid = { .planes = &floor, .plane_count = 1, .friction = 0.5f };
    static const noh_world asking = { .planes = &floor, .plane_count = 1, .physics = &physics };
    static const char *const lines[] = { "springs world\nragdoll_world physics", "springs world\nragdoll_world shapes",
                                         "springs free", "springs none" };
    uint64_t bytes[TEST_COUNT(lines)];
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(lines); i++) {
        stage_desc_file *text = read_cast("light 32 128", lines[i]), *code = read_cast("", "");
        noh_kind_ragdoll ragdoll = { .count = 2, .world = i == 0 ? &asking : i == 1 ? &solid : NULL };
        noh_kind_desc *k = code->kinds;
        noh_reflection reflection = { 32, NULL };
        noh_gl_light_desc light = { &reflection, 128 };
        code->desc.light = &light;
        k->ragdoll = noh_ragdoll_module(&ragdoll);
        k->springs = i == 3 ? (noh_module){ NULL, NULL }
                            : noh_springs_module(i == 0   ? &asking
                                                 : i == 1 ? &solid
                                                          : NULL);
        k->mesh = text->kinds[0].mesh = &dressed;
        const noh_stage_plan by_text = plan_of(text), in_code = plan_of(code);
        assert_int_equal(by_text.cpu_bytes, in_code.cpu_bytes);
        assert_int_equal(by_text.gpu_bytes, in_code.gpu_bytes);
        assert_int_equal(by_text.hash, in_code.hash);
        bytes[i] = by_text.cpu_bytes;
        stage_desc_file_free(text);
        stage_desc_file_free(code);
    }
    assert_int_equal(bytes[0] - bytes[1], 20480);
    assert_true(bytes[1] > bytes[2] && bytes[2] > bytes[3]);
}

static void modifiers_have_their_bytes(void **state)
{
    stage_desc_file *f = read_cast("", "modifier gaze\nmodifier feet\nmodifier hands\nmodifier stand\n"
                                       "modifier hair state=528 scratch=96");
    static const noh_gaze_rig gaze;
    static const noh_kind_feet feet;
    static const noh_reach_rig hands;
    const noh_modifier *m = f->kinds[0].modifiers;
    (void)state;
    assert_int_equal(f->kinds[0].modifier_count, 5);
    assert_int_equal(m[0].state_bytes, noh_gaze_modifier(&gaze).state_bytes);
    assert_int_equal(m[1].state_bytes, noh_feet_modifier(&feet).state_bytes);
    assert_int_equal(m[2].state_bytes, noh_reach_modifier(&hands).state_bytes);
    assert_int_equal(m[3].state_bytes, 0);
    assert_int_equal(m[4].state_bytes, 528);
    assert_int_equal(m[4].scratch_bytes, 96);
    const noh_stage_plan with = plan_of(f);
    f->kinds[0].modifier_count = 4;
    assert_int_equal(with.state_bytes - plan_of(f).state_bytes, 528u * 4u);
    stage_desc_file_free(f);
}

static noh_file files[3];

static int set_up(void **state)
{
    static const char *const from[] = { "demo/puppet_levels.noh", "demo/roam.noh", "demo/puppet.noh" };
    static const char *const to[] = { "puppet.noh", "roam.noh" };
    const char *build = getenv("NOH_BUILD");
    (void)state;
    for (uint32_t i = 0; i < 3; i++) {
        char path[4096];
        (void)snprintf(path, sizeof path, "%s/%s", build ? build : "build", from[i]);
        if (noh_file_map(path, &files[i], NULL) != NOH_OK) return 1;
        if (i < 2) test_write_file(test_path(to[i]), files[i].data, files[i].bytes);
    }
    dressed = test_open(files[2].data, files[2].bytes);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 3; i++) noh_file_unmap(&files[i]);
    return 0;
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_field_has_a_key_or_a_reason), cmocka_unit_test(every_key_sets_its_field),
    cmocka_unit_test(other_fields_change_no_byte),       cmocka_unit_test(what_lies_behind_a_key_has_its_bytes),
    cmocka_unit_test(modifiers_have_their_bytes),
};

TEST_MAIN(tests, set_up, tear_down)
