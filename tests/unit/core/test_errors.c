/* Every function that takes a noh_error fills it when it fails: with its result, and with a phrase that says what is
 * wrong. Each row of the table is one call that must fail. */
#include "support/support.h"

#include <stdlib.h>
#include <string.h>

#include "stage/character/joint_lod_internal.h"
#include "stage/character/lod_internal.h"
#include "stage/character/lod_pools_internal.h"
#include "stage/character/scheduler_internal.h"
#include "stage/character/time_lod_internal.h"
#include "motion/graph/graph_internal.h"
#include "stage/character/character_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/graph.h"
#include "noh/low_core.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/noh.h"
#include "noh/pack.h"

/* What the calls work on: zeroed descs, a few bytes of memory, and a pack of one mesh. */
typedef struct subject {
    uint8_t *bytes;
    size_t count;
    noh_pack pack;
    noh_mesh mesh;
    union {
        uint8_t bytes[64];
        uint64_t align[8];
    } memory;
    float zero[16];
} subject;

static subject s;

/* The results of functions that return a size: 0 is failure. */
static noh_result of_size(size_t size, const noh_error *error)
{
    return size ? NOH_OK : error->result;
}

#define DESC(type) \
    type desc;     \
    memset(&desc, 0, sizeof desc)

static noh_result arena_null(noh_error *e)
{
    noh_arena a;
    return noh_arena_open(&a, NULL, 64, 16, e);
}
static noh_result arena_misaligned(noh_error *e)
{
    noh_arena a;
    return noh_arena_open(&a, s.bytes + 4, 64, 16, e);
}
static noh_result arena_small(noh_error *e)
{
    noh_arena a;
    return noh_arena_open(&a, s.bytes, 15, 16, e);
}
static noh_result open_null(noh_error *e)
{
    noh_pack p;
    return noh_pack_open(NULL, 0, &p, e);
}
static noh_result open_cut(noh_error *e)
{
    noh_pack p;
    return noh_pack_open(s.bytes, s.count - 64, &p, e);
}
static noh_result pack_mesh(noh_error *e)
{
    noh_mesh m;
    return noh_pack_mesh_at(&s.pack, 1, &m, e);
}
static noh_result pack_skin(noh_error *e)
{
    noh_skin k;
    return noh_pack_skin_at(&s.pack, 0, &k, e);
}
static noh_result pack_rigid(noh_error *e)
{
    noh_skin k;
    return noh_pack_skin_at(&s.pack, NOH_NONE, &k, e);
}
static noh_result pack_texture(noh_error *e)
{
    noh_texture t;
    return noh_pack_texture_at(&s.pack, 0, &t, e);
}
static noh_result pack_skeleton(noh_error *e)
{
    noh_skeleton k;
    return noh_pack_skeleton_at(&s.pack, 0, &k, NULL, e);
}
static noh_result pack_clip(noh_error *e)
{
    noh_pack_clip m;
    return noh_pack_clip_at(&s.pack, 0, &m, e);
}

static noh_result bind_clip(noh_error *e)
{
    noh_clip_header header;
    noh_pack_clip clip;
    noh_skeleton skeleton;
    memset(&header, 0, sizeof header);
    memset(&clip, 0, sizeof clip);
    clip.header = &header;
    return noh_pack_bind_clip(&s.pack, &clip, &skeleton, NULL, e);
}

static noh_result layers_null(noh_error *e)
{
    noh_morph_layers l;
    return noh_morph_layers_init(NULL, 0, &s.mesh, &l, e);
}
static noh_result layers_small(noh_error *e)
{
    noh_morph_layers l;
    return noh_morph_layers_init(s.bytes, 1, &s.mesh, &l, e);
}

static noh_result pick_along(const float direction[3], noh_error *e)
{
    const float origin[3] = { 1e6f, 1e6f, 1e6f };
    const noh_pick_surface surface = { &s.mesh, NULL, NULL, NULL, NULL, NULL, NULL };
    noh_pick_hit hit;
    return noh_pick(&surface, origin, direction, 1.0f, NULL, 0, &hit, e);
}

static noh_result pick_nowhere(noh_error *e)
{
    return pick_along(s.zero, e);
}
static noh_result pick_nothing(noh_error *e)
{
    const float d[3] = { 1.0f, 0.0f, 0.0f };
    return pick_along(d, e);
}

static noh_result clip_measure(noh_error *e)
{
    DESC(noh_clip_desc);
    desc.bytes = s.memory.bytes;
    return noh_clip_measure(&desc, NULL, NULL, e);
}
static noh_result clip_size(noh_error *e)
{
    DESC(noh_clip_desc);
    desc.bytes = s.memory.bytes;
    return of_size(noh_clip_size(&desc, e), e);
}
static noh_result clip_init(noh_error *e)
{
    noh_clip *c;
    DESC(noh_clip_desc);
    desc.bytes = s.memory.bytes;
    return noh_clip_init(s.memory.bytes, 64, &desc, &c, e);
}
static noh_result cache_size(noh_error *e)
{
    DESC(noh_clip_cache_desc);
    return of_size(noh_clip_cache_size(&desc, e), e);
}
static noh_result cache_init(noh_error *e)
{
    noh_clip_cache *c;
    DESC(noh_clip_cache_desc);
    return noh_clip_cache_init(s.memory.bytes, 64, &desc, &c, e);
}
static noh_result set_size(noh_error *e)
{
    DESC(noh_clip_bank_desc);
    return of_size(noh_clip_bank_size(&desc, e), e);
}
static noh_result set_init(noh_error *e)
{
    noh_clip_bank *m;
    DESC(noh_clip_bank_desc);
    return noh_clip_bank_init(s.memory.bytes, 64, &desc, &m, e);
}
static noh_result clip_set_check(noh_error *e)
{
    DESC(noh_clip_set);
    return noh_clip_set_check(&desc, e);
}
static noh_result schedule_init(noh_error *e)
{
    noh_schedule q;
    return noh_schedule_init(NULL, 0, 4, &q, e);
}
static noh_result settings_check(noh_error *e)
{
    DESC(noh_lod_settings);
    desc.pixels = -1.0f;
    return noh_lod_settings_check(&desc, e);
}
static noh_result table_check(noh_error *e)
{
    DESC(noh_lod_table);
    desc.mesh_level_count = NOH_LOD_LEVELS_MAX + 1u;
    return noh_lod_table_check(&desc, e);
}
static noh_result pools_init(noh_error *e)
{
    noh_lod_pools *p;
    DESC(noh_lod_pools_desc);
    return noh_lod_pools_init(s.memory.bytes, 64, &desc, &p, e);
}

static noh_result triangulate(noh_error *e)
{
    uint8_t triangles[3 * NOH_BLEND_SPACE_TRIANGLES_MAX];
    uint32_t count;
    return noh_blend_space_2d_triangulate(2, s.zero, triangles, &count, e);
}

static noh_result controller_init(noh_error *e)
{
    noh_controller *c;
    DESC(noh_controller_desc);
    return noh_controller_init(s.memory.bytes, 64, &desc, &c, e);
}
static noh_result character_init(noh_error *e)
{
    noh_character *c;
    DESC(noh_character_desc);
    return noh_character_init(s.memory.bytes, 64, &desc, &c, e);
}
static noh_result character_scratch_init(noh_error *e)
{
    noh_character_scratch c;
    DESC(noh_character_desc);
    return noh_character_scratch_init(s.memory.bytes, 64, &desc, &c, e);
}
static noh_result graph_check(noh_error *e)
{
    noh_clip_set set;
    DESC(noh_graph);
    memset(&set, 0, sizeof set);
    return noh_graph_check(&desc, &set, e);
}
static noh_result lod_pack_init(noh_error *e)
{
    noh_lod_pack made;
    DESC(noh_lod_pack_desc);
    return noh_lod_pack_init(s.memory.bytes, 64, &desc, &made, e);
}
static noh_result schedule_of_none(noh_error *e)
{
    noh_schedule q;
    return noh_schedule_init(s.memory.bytes, 64, 0, &q, e);
}
static noh_result time_measure(noh_error *e)
{
    float errors[NOH_UPDATE_RATE_COUNT];
    DESC(noh_time_probe);
    return noh_time_lod_measure(s.memory.bytes, 64, &desc, 0, errors, e);
}
static noh_result joint_measure(noh_error *e)
{
    const uint32_t counts[1] = { 1 };
    float errors[1];
    DESC(noh_time_probe);
    return noh_joint_lod_measure(s.memory.bytes, 64, &desc, 0, counts, 1, errors, e);
}
static noh_result shares_check(noh_error *e)
{
    DESC(noh_lod_settings);
    for (int i = 0; i < NOH_LOD_KIND_COUNT; i++) desc.shares[i] = 0.5f;
    return noh_lod_settings_check(&desc, e);
}
static noh_result hysteresis_check(noh_error *e)
{
    DESC(noh_lod_settings);
    desc.hysteresis = 1.0f;
    return noh_lod_settings_check(&desc, e);
}
static noh_result lead_check(noh_error *e)
{
    DESC(noh_lod_settings);
    desc.lead = 0.9f;
    return noh_lod_settings_check(&desc, e);
}

/* clang-format off */
#define ROW(call, result) { #call, call, NOH_ERR_##result }
/* clang-format on */

static const struct {
    const char *name;
    noh_result (*call)(noh_error *error);
    noh_result expected;
} calls[] = {
    ROW(arena_null, ARG),         ROW(arena_misaligned, ARG),
    ROW(arena_small, MEMORY),     ROW(open_null, ARG),
    ROW(open_cut, DATA),          ROW(pack_mesh, NOT_FOUND),
    ROW(pack_skin, NOT_FOUND),    ROW(pack_rigid, NOT_FOUND),
    ROW(pack_texture, NOT_FOUND), ROW(pack_skeleton, NOT_FOUND),
    ROW(pack_clip, NOT_FOUND),    ROW(bind_clip, NOT_FOUND),
    ROW(layers_null, ARG),        ROW(layers_small, MEMORY),
    ROW(pick_nowhere, ARG),       ROW(pick_nothing, NOT_FOUND),
    ROW(clip_measure, VERSION),   ROW(clip_size, VERSION),
    ROW(clip_init, VERSION),      ROW(cache_size, ARG),
    ROW(cache_init, ARG),         ROW(set_size, ARG),
    ROW(set_init, ARG),           ROW(clip_set_check, ARG),
    ROW(schedule_init, ARG),      ROW(settings_check, ARG),
    ROW(table_check, ARG),        ROW(pools_init, ARG),
    ROW(triangulate, DATA),       ROW(controller_init, ARG),
    ROW(character_init, ARG),     ROW(character_scratch_init, ARG),
    ROW(graph_check, ARG),        ROW(lod_pack_init, ARG),
    ROW(schedule_of_none, ARG),   ROW(time_measure, ARG),
    ROW(joint_measure, ARG),      ROW(shares_check, ARG),
    ROW(hysteresis_check, ARG),   ROW(lead_check, ARG),
};

/* Two words or more, as a message goes on after "error: ": no full stop, no line break. */
static int is_phrase(const char *what)
{
    const size_t length = strlen(what);
    const char *space = strchr(what, ' ');
    return space && space != what && space[1] && what[length - 1] != '.' && !strchr(what, '\n');
}

static void expect_failure(const char *name, noh_result (*call)(noh_error *), noh_result expected)
{
    noh_error error = { NOH_OK, NULL, 0, 0 };
    const noh_result result = call(&error);
    if (result != expected) {
        fail_msg("%s: %s, expected %s", name, noh_result_text(result), noh_result_text(expected));
    }
    if (error.result != result || !error.what) {
        fail_msg("%s: result %d, error %d, '%s'", name, (int)result, (int)error.result,
                 error.what ? error.what : "(null)");
    }
    if (!is_phrase(error.what)) fail_msg("%s: '%s' is no phrase", name, error.what);
    if (call != clip_size && call != cache_size && call != set_size) { /* these tell failure by the error */
        assert_int_equal(call(NULL), result);
    }
}

static void a_failure_says_what(void **state)
{
    const test_model_desc desc = { 1, 5, 3, 0, 4 };
    (void)state;
    s.bytes = test_pack(&desc, &s.count);
    s.pack = test_open(s.bytes, s.count);
    s.mesh = test_mesh(&s.pack, 0);
    for (size_t i = 0; i < TEST_COUNT(calls); i++) expect_failure(calls[i].name, calls[i].call, calls[i].expected);
    free(s.bytes);
}

static void every_result_has_words(void **state)
{
    (void)state;
    for (int r = NOH_OK; r <= NOH_ERR_GL; r++) {
        assert_string_not_equal(noh_result_text((noh_result)r), "unknown result");
    }
    assert_string_equal(noh_result_text((noh_result)99), "unknown result");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_failure_says_what),
    cmocka_unit_test(every_result_has_words),
};

TEST_MAIN(tests, NULL, NULL)
