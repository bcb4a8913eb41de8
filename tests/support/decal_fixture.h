/* decal_fixture.h: an actor with a ring of marks, drawn; and the surface that is drawn, for rays of the CPU. */
#ifndef NOH_TESTS_SUPPORT_DECAL_FIXTURE_H
#define NOH_TESTS_SUPPORT_DECAL_FIXTURE_H

#include "gl_fixture.h"
#include "stage_fixture.h"

#include "noh/base.h"
#include "noh/deform.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/marks.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gpu/canvas.h"

#define WIDTH 240u
#define HEIGHT 240u
#define PIXELS (WIDTH * HEIGHT)

typedef struct shot {
    cast c;
    gpu *g;
    canvas to;
    noh_actor actor;
    noh_stage_view view;
    noh_stage_decals decals;
    noh_stage_patches patches; /* of open_patches */
    void *memory, *patch_memory;
    void *unlit; /* bytes of make_unlit */
    noh_decals ring;
    float size; /* of the actor's sphere */
} shot;

static inline noh_gl_device device_of(gpu *g)
{
    static char log[4096];
    const noh_gl_device d = { &g->gl, &g->caps, &g->ledger, log, sizeof log };
    return d;
}

static inline void frame(shot *s)
{
    assert_int_equal(noh_stage_frame(s->c.stage, 0, &s->view, NULL, NULL, NULL), NOH_OK);
}

static inline void set_level(shot *s, uint32_t level)
{
    const noh_appearance look = { .level = 1u + level };
    assert_int_equal(noh_actor_set_appearance(s->c.stage, s->actor, &look, NULL), NOH_OK);
    s->view.cut = 1;
    frame(s);
}

/* The pack of a kind, copied, with no light on its materials. */
static inline void make_unlit(shot *s, uint32_t kind)
{
    const noh_file *file = &s->c.files[kind == PUPPETS ? 0 : 1];
    s->unlit = test_aligned(file->data, file->bytes);
    s->c.packs[kind] = test_open(s->unlit, file->bytes);
    for (uint32_t i = 0; i < s->c.packs[kind].material_count; i++) {
        ((noh_material *)(uintptr_t)s->c.packs[kind].materials)[i].flags |= NOH_MATERIAL_UNLIT;
    }
}

static inline void open_shot_as(shot *s, uint32_t kind, int unlit)
{
    const noh_appearance posed = { .posed = 1 };
    noh_gl_device d;
    size_t bytes;
    float sphere[4];
    memset(s, 0, sizeof *s);
    s->g = fixture_gpu();
    d = device_of(s->g);
    cast_open(&s->c);
    if (unlit) make_unlit(s, kind);
    s->c.desc.gpu = &noh_stage_on_gl;
    cast_make(&s->c, &d);
    assert_int_equal(noh_stage_spawn(s->c.stage, kind, NULL, &s->actor, NULL), NOH_OK);
    assert_int_equal(noh_actor_set_appearance(s->c.stage, s->actor, &posed, NULL), NOH_OK);
    assert_int_equal(noh_stage_frame(s->c.stage, 0, NULL, NULL, NULL, NULL), NOH_OK);
    assert_int_equal(noh_actor_sphere(s->c.stage, s->actor, sphere, NULL), NOH_OK);
    s->size = sphere[3];
    noh_view_orbit(&s->view, sphere, 0.3f, 0.1f, (kind == MASKS ? 1.0f : 2.0f) * sphere[3], WIDTH, HEIGHT);
    set_level(s, 0);
    bytes = noh_stage_decals_size(s->c.stage);
    s->memory = test_aligned(NULL, bytes);
    noh_decals_init(&s->ring, 0, 0, 0);
    assert_int_equal(noh_stage_decals_create(s->c.stage, &d, s->memory, bytes - 1u, NULL, &s->decals, NULL),
                     NOH_ERR_MEMORY);
    assert_int_equal(noh_stage_decals_create(s->c.stage, &d, s->memory, bytes, NULL, &s->decals, NULL), NOH_OK);
    assert_int_equal(canvas_open(&s->to, s->g, WIDTH, HEIGHT), 0);
}

static inline void open_shot(shot *s, uint32_t kind)
{
    open_shot_as(s, kind, 0);
}

static inline void close_shot(shot *s)
{
    canvas_close(&s->to);
    if (s->patches.decals) noh_stage_patches_delete(&s->patches);
    noh_stage_decals_delete(&s->decals);
    free(s->memory);
    free(s->patch_memory);
    cast_close_stage(&s->c);
    cast_close(&s->c);
    free(s->unlit);
    fixture_expect_no_errors();
}

/* Room for the triangles of its ring. triangles: as noh_stage_patches_create */
static inline void open_patches(shot *s, uint32_t triangles)
{
    const size_t bytes = noh_stage_patches_size(0, triangles);
    s->patch_memory = test_aligned(NULL, bytes);
    assert_int_equal(noh_stage_patches_create(&s->decals, 0, triangles, s->patch_memory, bytes - 1u, &s->patches, NULL),
                     NOH_ERR_MEMORY);
    assert_int_equal(noh_stage_patches_create(&s->decals, 0, triangles, s->patch_memory, bytes, &s->patches, NULL),
                     NOH_OK);
}

enum { WITHOUT, RESTING, GROWN };

static inline uint8_t *picture(shot *s, int with_marks)
{
    uint8_t *rgba = test_zeros(PIXELS * 4u);
    const unsigned lookups = fixture_uniform_lookups();
    canvas_begin(&s->to);
    assert_int_equal(noh_stage_draw(s->c.stage, NOH_PASS_OPAQUE, 0, NULL, NULL), NOH_OK);
    if (with_marks == RESTING) {
        assert_int_equal(noh_stage_decals_draw(&s->decals, 0, s->actor, &s->ring, NULL), NOH_OK);
    } else if (with_marks == GROWN) {
        assert_int_equal(noh_stage_patches_draw(&s->patches, 0, s->actor, &s->ring, NULL), NOH_OK);
    }
    assert_int_equal(noh_stage_draw(s->c.stage, NOH_PASS_BLENDED, 0, NULL, NULL), NOH_OK);
    assert_int_equal(fixture_uniform_lookups(), lookups);
    assert_int_equal(canvas_read(&s->to, rgba), 0);
    return rgba;
}

static inline int pick(shot *s, double x, double y, noh_stage_hit *hit)
{
    float origin[3], direction[3];
    assert_int_equal(noh_view_ray(&s->view, (float)x, (float)y, WIDTH, HEIGHT, origin, direction), 1);
    return noh_stage_pick(s->c.stage, origin, direction, 1e6f, hit, NULL) == NOH_OK;
}

/* Marks on a lattice over the picture, as the actor stands now. */
static inline uint32_t strike(shot *s, uint32_t step, float share, uint32_t most)
{
    noh_decal_desc look = { .size = share * s->size, .color = { 255, 0, 0, 255 } };
    uint32_t count = 0;
    for (uint32_t y = step / 2u; y < HEIGHT; y += step) {
        for (uint32_t x = step / 2u; x < WIDTH && count < most; x += step) {
            noh_stage_hit hit;
            if (!pick(s, x, y, &hit)) continue;
            look.roll_rad = 0.3f * (float)count;
            assert_int_equal(noh_decals_strike(&s->ring, s->c.stage, &hit, &look, NULL, NULL), NOH_OK);
            count++;
        }
    }
    return count;
}

/* The surface as it is drawn, for rays of the CPU. */
typedef struct surface {
    noh_mesh mesh;
    noh_actor_mesh drawn;
    noh_morph_layers layers;
    noh_pick_surface of;
    float matrices[NOH_SKIN_JOINTS_MAX * 12u];
    void *sums, *scratch;
    size_t scratch_bytes;
} surface;

static inline void open_surface(const shot *s, uint32_t kind, uint32_t index, surface *u)
{
    noh_mesh full;
    size_t bytes;
    memset(u, 0, sizeof *u);
    assert_int_equal(noh_actor_mesh_at(s->c.stage, s->actor, index, &u->drawn, u->matrices, NULL), NOH_OK);
    assert_int_equal(noh_pack_mesh_at(&s->c.packs[kind], u->drawn.mesh, &full, NULL), NOH_OK);
    u->mesh = noh_mesh_at_lod(&full, u->drawn.level);
    bytes = noh_morph_layers_size(&u->mesh);
    u->sums = test_aligned(NULL, bytes);
    assert_int_equal(noh_morph_layers_init(u->sums, bytes, &u->mesh, &u->layers, NULL), NOH_OK);
    noh_morph_accumulate(&u->mesh, u->drawn.weights, &u->layers);
    u->of.mesh = &u->mesh;
    u->of.world = u->drawn.joint_count ? NULL : u->drawn.world;
    u->of.matrices = u->drawn.joint_count ? u->matrices : NULL;
    u->of.layers = &u->layers;
    u->of.weights = u->drawn.weights;
    u->scratch_bytes = noh_pick_scratch_size(&u->mesh);
    u->scratch = test_aligned(NULL, u->scratch_bytes + 16u);
}

static inline void close_surface(surface *u)
{
    free(u->sums);
    free(u->scratch);
}

/* The nearest of several meshes' rest positions. 0: nothing there. */
static inline uint32_t rest_at(const shot *s, surface *meshes, uint32_t count, double x, double y,
                               noh_pick_hit *nearest)
{
    float origin[3], direction[3];
    uint32_t found = 0;
    nearest->distance = 1e6f;
    assert_int_equal(noh_view_ray(&s->view, (float)x, (float)y, WIDTH, HEIGHT, origin, direction), 1);
    for (uint32_t m = 0; m < count; m++) {
        noh_pick_hit hit;
        if (noh_pick(&meshes[m].of, origin, direction, nearest->distance, meshes[m].scratch, meshes[m].scratch_bytes,
                     &hit, NULL) == NOH_OK) {
            *nearest = hit;
            found = 1u + m;
        }
    }
    return found;
}

#endif
