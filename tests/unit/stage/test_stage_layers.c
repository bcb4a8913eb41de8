/* Layers by names of floats: a layer moves the floats of its list and no others. */
#include "support/stage_fixture.h"

typedef struct list_case {
    const char *list, *names[3]; /* as in noh_layer_desc; names, or beginnings of names with a '*' */
    int takes_out;               /* the names are what the list leaves out */
    const char *but;             /* an exception to the names */
} list_case;

static const list_case lists[] = {
    { NULL, { NULL }, 1, NULL },
    { "", { NULL }, 0, NULL },
    { "jawOpen", { "jawOpen" }, 0, NULL },
    { " mouth*  jawOpen ", { "mouth*", "jawOpen" }, 0, NULL },
    { "-mouth*", { "mouth*" }, 1, NULL },
    { "-mouth* mouthFunnel", { "mouth*" }, 1, "mouthFunnel" },
    { "mouth* -mouthFunnel", { "mouth*" }, 0, "mouthFunnel" },
    { "*", { NULL }, 1, NULL },
};

#define LISTS (sizeof lists / sizeof *lists)

static void open_stage(cast *c, noh_layer_desc layers[LISTS])
{
    memset(c, 0, sizeof *c);
    cast_map(c, MASKS, "mask_levels.noh");
    for (size_t i = 0; i < LISTS; i++) {
        static const char names[] = "abcdefgh\0";
        layers[i] = (noh_layer_desc){ .name = names + i, .mode = NOH_LAYER_OVER, .floats = lists[i].list };
    }
    c->kinds[0].mesh = &c->packs[MASKS];
    c->kinds[0].actor_count = LISTS + 1u;
    c->kinds[0].layers = layers;
    c->kinds[0].layer_count = LISTS;
    c->desc.kinds = c->kinds;
    c->desc.kind_count = 1;
}

static int is_named(const char *pattern, const char *name)
{
    const size_t length = strlen(pattern);
    if (length && pattern[length - 1u] == '*') return !strncmp(pattern, name, length - 1u);
    return !strcmp(pattern, name);
}

static int is_moved(const list_case *l, const char *name)
{
    int named = 0;
    for (int i = 0; i < 3 && l->names[i]; i++) named |= is_named(l->names[i], name);
    if (l->but && !strcmp(l->but, name)) return l->takes_out;
    return named != l->takes_out;
}

/* Each actor plays the same clip on a layer of its own; one plays nothing. */
static void a_layer_moves_what_it_names(void **state)
{
    noh_layer_desc layers[LISTS];
    noh_actor actors[LISTS + 1u];
    const float *rest, *all;
    uint32_t moving = 0;
    cast c;
    (void)state;
    open_stage(&c, layers);
    cast_make(&c, NULL);
    for (uint32_t i = 0; i <= LISTS; i++) {
        const noh_play play = { .fade_ticks = 1, .speed = 1, .start_ticks = 20000 };
        const noh_appearance posed = { .posed = 1 };
        assert_int_equal(noh_stage_spawn(c.stage, 0, NULL, &actors[i], NULL), NOH_OK);
        assert_int_equal(noh_actor_set_appearance(c.stage, actors[i], &posed, NULL), NOH_OK);
        if (i < LISTS) assert_int_equal(noh_actor_play(c.stage, actors[i], i, "speak", &play, NULL), NOH_OK);
    }
    for (int f = 0; f < 2; f++) assert_int_equal(noh_stage_frame(c.stage, CAST_STEP, NULL, NULL, NULL, NULL), NOH_OK);
    rest = noh_actor_floats(c.stage, actors[LISTS]);
    all = noh_actor_floats(c.stage, actors[0]);
    for (uint32_t i = 0; i < LISTS; i++) {
        const float *floats = noh_actor_floats(c.stage, actors[i]);
        for (uint32_t f = 0; f < c.plan.kinds[0].float_count; f++) {
            const char *name = noh_stage_name(c.stage, 0, NOH_NAME_FLOAT, f);
            const float expected = is_moved(&lists[i], name) ? all[f] : rest[f];
            moving += i == 0 && all[f] != rest[f] && (is_named("mouth*", name) || is_named("jawOpen", name));
            if (floats[f] != expected) fail_msg("\"%s\": %s is %g, not %g", lists[i].list, name, floats[f], expected);
        }
    }
    assert_true(moving > 3u);
    cast_close_stage(&c);
    noh_file_unmap(&c.files[MASKS]);
}

static void unknown_names_are_refused(void **state)
{
    static const char *const bad[] = { "jawOpe", "jawOpenn", "-nobody", "mouthFunnel nobody*", "jaw* -" };
    static const uint64_t bytes[TEST_COUNT(bad)] = { 0, 0, 1, 12, 6 };
    noh_layer_desc layers[LISTS];
    (void)state;
    for (size_t i = 0; i < TEST_COUNT(bad); i++) {
        noh_error said = { NOH_OK, "", 0, 0 };
        noh_stage *stage;
        cast c;
        open_stage(&c, layers);
        layers[2].floats = bad[i];
        assert_int_equal(noh_stage_plan_make(&c.desc, NULL, &c.plan, NULL), NOH_OK);
        c.memory = test_aligned(NULL, (size_t)c.plan.cpu_bytes);
        assert_int_equal(noh_stage_init(c.memory, (size_t)c.plan.cpu_bytes, NULL, &c.desc, &c.plan, &stage, &said),
                         NOH_ERR_NOT_FOUND);
        assert_non_null(strstr(said.what, "floats of a layer"));
        assert_true(said.where == (uint64_t)2 << 32 && said.need == bytes[i]);
        free(c.memory);
        noh_file_unmap(&c.files[MASKS]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_layer_moves_what_it_names),
        cmocka_unit_test(unknown_names_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
