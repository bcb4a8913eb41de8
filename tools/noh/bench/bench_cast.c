/* bench_cast.c: rows stage/: the CPU cost of a frame of a stage (runtime/stage/cast), on a GL that does nothing.
 *
 * stage/cpu/N-actors  against the same work joined by hand: a loop that calls the library's parts for one
 *                      actor after another. It works on a second stage, from the state and with the slots of this stage
 *                      after some frames. Both must give the same palettes and weights, bit for bit; otherwise nothing
 *                      is printed.
 * stage/lod/N-actors  at one pixel of allowed error, against the same stage with actors that allow a millionth of a
 *                     pixel: all joints, all targets, every frame. Meshes stay as fine as the slots of the plan allow.
 *
 * Actors stand in the view of one camera that does not move, over 100 m, and play clips of the pack on the first
 * layer. None where a pack has no skinned mesh with levels, or no clips. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "cli/message.h"
#include "gl/draw/gl_skin_internal.h"
#include "stage/character/lod_internal.h"
#include "noh/base.h"
#include "noh/clip.h"
#include "noh/format.h"
#include "noh/gl_device.h"
#include "noh/low_gl.h"
#include "noh/low_motion.h"
#include "noh/low_stage.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/noh_gl.h"
#include "noh/pack.h"
#include "gl/stage/stage_gl_internal.h"

#define SAMPLE_NS 2e7
#define SETTLE_FRAMES 90u
#define CHECK_FRAMES 60u
#define FRAME_TICKS 800u /* 60 frames a second */
#define ACTORS_MAX 1000u
#define WIDTH 1280u
#define HEIGHT 720u

typedef struct cast {
    noh_kind_desc kind;
    noh_stage_desc desc;
    noh_stage_plan plan;
    noh_stage *stage;
    void *memory;
    noh_stage_view view;
} cast;

/* ---- a stage ---- */

static uint32_t clip_count(const noh_stage *s)
{
    uint32_t n = 0;
    while (noh_stage_name(s, 0, NOH_NAME_CLIP, n)) n++;
    return n;
}

/* -1: no row, as the actors do not fit the GPU, or no clip moves them. */
static int open_stage(cast *c, gpu *g, const noh_pack *pack, uint32_t actors)
{
    static char log[4096];
    const noh_gl_device device = { &g->gl, &g->caps, &g->ledger, log, sizeof log };
    noh_error e = { NOH_OK, "", 0, 0 };
    memset(c, 0, sizeof *c);
    c->kind.mesh = pack;
    c->kind.actor_count = actors;
    c->kind.springs = noh_springs_module(NULL);
    c->desc.kinds = &c->kind;
    c->desc.kind_count = 1;
    c->desc.lod.pixels = 1.0f;
    c->desc.height_px = HEIGHT;
    c->desc.gpu = &noh_stage_on_gl;
    if (noh_stage_plan_make(&c->desc, &g->caps, &c->plan, &e)) return -1;
    c->memory = malloc((size_t)c->plan.cpu_bytes);
    if (!c->memory) return tool_fail("bench", "out of memory");
    if (noh_stage_init(c->memory, (size_t)c->plan.cpu_bytes, &device, &c->desc, &c->plan, &c->stage, &e)) {
        c->stage = NULL;
        return tool_fail_error("bench: stage", &e);
    }
    return clip_count(c->stage) ? 0 : -1;
}

static void close_stage(cast *c)
{
    if (c->stage) noh_stage_delete(c->stage);
    free(c->memory);
    memset(c, 0, sizeof *c);
}

/* Rows of ten, within the view of a camera in front of them: the nearest 3 m away, of a thousand the last 100 m. */
static int enter(cast *c, uint32_t index, float pixels)
{
    const uint32_t row = index / 10u, column = index % 10u, clips = clip_count(c->stage);
    const float depth = 3.0f + (float)row;
    const noh_place place = { .position = { (0.09f * (float)column - 0.4f) * depth, 0.0f, -depth }, .scale = 1.0f };
    const noh_play play = { .fade_ticks = 1,
                            .speed = 60000 + 11 * (int32_t)index,
                            .start_ticks = 7001 * (int64_t)index,
                            .loop = NOH_LOOP_REPEAT };
    const noh_appearance look = { .pixels = pixels };
    noh_actor actor;
    noh_error e = { NOH_OK, "", 0, 0 };
    if (noh_stage_spawn(c->stage, 0, &place, &actor, &e) || noh_actor_set_appearance(c->stage, actor, &look, &e) ||
        noh_actor_play(c->stage, actor, 0, noh_stage_name(c->stage, 0, NOH_NAME_CLIP, index % clips), &play, &e))
        return tool_fail_error("bench: actor", &e);
    return 0;
}

static void run_stage(void *self, uint32_t frame)
{
    cast *c = self;
    (void)frame;
    (void)noh_stage_frame(c->stage, FRAME_TICKS, &c->view, NULL, NULL, NULL);
}

static int open_cast(cast *c, gpu *g, const noh_pack *pack, uint32_t actors, float pixels)
{
    const float middle[3] = { 0.0f, 1.0f, -3.0f };
    int status = open_stage(c, g, pack, actors);
    if (status) return status;
    noh_view_orbit(&c->view, middle, 0.0f, 0.05f, 3.0f, WIDTH, HEIGHT);
    for (uint32_t i = 0; i < actors && !status; i++) status = enter(c, i, pixels);
    for (uint32_t f = 0; f < SETTLE_FRAMES && !status; f++) run_stage(c, f);
    return status;
}

/* ---- the same by hand ---- */

typedef struct by_hand {
    cast *of; /* whose parts these are */
    const noh_stage_kind *kind;
    noh_character_scratch scratch;
    float *weights; /* of one actor */
} by_hand;

static int open_hand(by_hand *h, cast *of)
{
    const noh_stage_kind *k = &of->stage->kinds[0];
    const noh_character_desc desc = noh_stage_character_desc(k, 0);
    memset(h, 0, sizeof *h);
    h->of = of;
    h->kind = k;
    h->weights = malloc((k->weight_count + 1u) * sizeof *h->weights);
    return !h->weights || noh_character_scratch_init(of->stage->jobs[0].scratch, of->stage->scratch_bytes, &desc,
                                                     &h->scratch, NULL)
               ? tool_fail("bench", "out of memory")
               : 0;
}

static void close_hand(by_hand *h)
{
    free(h->weights);
    memset(h, 0, sizeof *h);
}

/* Pixels per unit at the nearest point of what an actor shows; 0: outside of the view. */
static float scale_of(by_hand *h, uint32_t index)
{
    noh_stage *s = h->of->stage;
    const noh_stage_kind *k = h->kind;
    noh_stage_shown *shown = &s->shown[k->first_actor + index];
    float own[4], reach[4];
    if (k->weight_count) noh_stage_take_floats(k, index);
    noh_stage_sphere(k, index, own);
    noh_place_matrix(&k->actors[index].place, shown->world);
    noh_stage_reach(k, own, reach);
    noh_stage_sphere_in_world(shown->world, reach, reach);
    for (int p = 0; p < 4; p++) {
        const float *plane = s->planes[0].planes[p];
        if (plane[0] * reach[0] + plane[1] * reach[1] + plane[2] * reach[2] + plane[3] < -reach[3]) return 0.0f;
    }
    shown->views = 1;
    noh_stage_measure(s, k, index, own, s->jobs[0].matrices);
    return shown->scale;
}

/* The weights of both sources of floats: clips, and defaults where no clip moves a target. */
static void take_weights(by_hand *h, noh_character *ch, uint32_t index)
{
    const noh_stage_kind *k = h->kind;
    const float *floats = k->floats + (size_t)index * k->float_count;
    noh_stage_take_floats(k, index);
    for (uint32_t m = 0; m < k->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &k->meshes[m];
        memcpy(h->weights + mesh->first_weight, floats + mesh->first_float,
               mesh->mesh.header->target_count * sizeof *h->weights);
    }
    if (k->weight_count) {
        (void)noh_lod_targets(&ch->lod, &h->of->stage->desc.lod, h->weights, k->target_radii, k->weight_count,
                              h->weights);
    }
}

static int is_moved(const float *weights, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        if (weights[i] != 0.0f) return 1;
    }
    return 0;
}

static void hand_over(by_hand *h, noh_character *ch, const noh_stage_shown *at, const float world[12])
{
    const noh_stage_gl *gl = h->of->stage->gpu;
    const noh_skin_header *ready = NULL; /* meshes of one skin take the same matrices */
    for (uint32_t m = 0; m < h->kind->plan->mesh_count; m++) {
        const noh_stage_mesh *mesh = &h->kind->meshes[m];
        const noh_gl_item *item = &gl->kinds[0].items[m];
        const float *weights = h->weights + mesh->first_weight;
        noh_gl_morph *morph = item->model->morph;
        noh_gl_morph_binding binding;
        noh_mesh level;
        float placed[12];
        int moved = 0;
        memcpy(placed, world, sizeof placed);
        if (!mesh->skinned && mesh->node_world) noh_matrix_multiply(world, mesh->node_world, placed);
        if (morph) {
            const uint32_t tile = noh_gl_morph_instance(morph, item->first_pool + at->slot.pool, at->slot.slot);
            moved = is_moved(weights, mesh->mesh.header->target_count);
            (void)noh_gl_morph_set_weights(morph, tile, weights, NULL);
            binding = noh_gl_morph_binding_of(morph, tile);
        }
        if (!noh_stage_is_mirrored(mesh, &h->kind->actors[0], &h->of->stage->shown[0])) {
            (void)noh_gl_skin_set_place(item->skin, at->place, placed, moved ? &binding : NULL, NULL);
            noh_gl_upload_regions(mesh, item, at->place, weights);
        }
        if (mesh->skinned) {
            if (mesh->skin.header != ready) noh_character_skin(ch, &mesh->skin, h->of->stage->jobs[0].matrices);
            ready = mesh->skin.header;
            level = noh_mesh_at_lod(&mesh->mesh, h->kind->plan->levels[at->level].mesh_levels[m]);
            noh_mesh_move_far_joints(&level, weights, h->of->stage->jobs[0].matrices);
            noh_gl_skin_set_matrices(item->skin, at->place, h->of->stage->jobs[0].matrices);
        }
    }
}

static void send(const by_hand *h)
{
    const noh_stage_gl *gl = h->of->stage->gpu;
    for (uint32_t m = 0; m < h->kind->plan->mesh_count; m++) noh_gl_skin_update(gl->kinds[0].items[m].skin);
    for (uint32_t i = 0; i < gl->model_count; i++) {
        if (gl->models[i].morph) noh_gl_morph_update(gl->models[i].morph, NULL);
    }
}

static void run_by_hand(void *self, uint32_t frame)
{
    by_hand *h = self;
    const noh_stage_kind *k = h->kind;
    (void)frame;
    noh_clip_cache_begin_frame(k->bank->cache);
    for (uint32_t i = 0; i < k->desc->actor_count; i++) {
        noh_character *ch = noh_stage_character(k, i);
        noh_stage *stage = h->of->stage;
        float scale;
        (void)noh_character_step(ch, &k->set, FRAME_TICKS, NULL, NULL);
        scale = scale_of(h, i);
        if (scale <= 0.0f) continue;
        if (noh_character_select_lod(ch, &k->table, &stage->desc.lod, scale * k->actors[i].place.scale) !=
            NOH_DUE_NOT) {
            noh_character_update(ch, &k->set, &k->skeleton, k->joint_radii, &h->scratch);
            noh_stage_measure_shown(stage, k, i, stage->jobs[0].matrices);
        }
        take_weights(h, ch, i);
        memcpy(k->weights + (size_t)i * k->weight_count, h->weights, k->weight_count * sizeof *h->weights);
        hand_over(h, ch, &stage->shown[i], stage->shown[i].world);
    }
    send(h);
}

/* ---- checks ---- */

static int equal_skins(const noh_stage *a, const noh_stage *b)
{
    const noh_stage_gl *x = a->gpu, *y = b->gpu;
    for (uint32_t m = 0; m < a->kinds[0].plan->mesh_count; m++) {
        const noh_gl_skin *s = x->kinds[0].items[m].skin, *t = y->kinds[0].items[m].skin;
        if (s->plan.texel_count != t->plan.texel_count ||
            memcmp(s->rows, t->rows, (size_t)s->plan.texel_count * 16u) != 0)
            return 0;
    }
    return 1;
}

/* The stage and the hand come to the same rows and weights, after frames in which actors moved. -1: the camera does not
 * see them all. */
static int check(cast *c, by_hand *h)
{
    const noh_stage_kind *k = &c->stage->kinds[0];
    if (!equal_skins(c->stage, h->of->stage)) return tool_fail("bench", "stage: two equal stages differ");
    for (uint32_t f = 0; f < CHECK_FRAMES; f++) {
        run_stage(c, f);
        run_by_hand(h, f);
        if (noh_stage_seen(k) != k->desc->actor_count) return -1;
        if (!equal_skins(c->stage, h->of->stage) ||
            memcmp(k->weights, h->kind->weights, (size_t)k->desc->actor_count * k->weight_count * sizeof *k->weights) !=
                0)
            return tool_fail("bench", "stage: frame %u differs from the frame joined by hand", f);
    }
    return 0;
}

/* ---- rows ---- */

/* ours against theirs, in turn; a row is added. */
static int measure(bench_job *job, const char *part, const char *baseline, uint32_t actors, cast *ours,
                   void (*run)(void *, uint32_t), void *theirs)
{
    bench_cells cells;
    char name[64];
    int status;
    memset(&cells, 0, sizeof cells);
    snprintf(name, sizeof name, "stage/%s/%u-actor%s", part, actors, actors > 1u ? "s" : "");
    bench_add_cell(&cells, run_stage, ours);
    bench_add_cell(&cells, run, theirs);
    status = bench_run_cells(&cells, &job->cpu_clock, job->rounds, SAMPLE_NS, name);
    if (!status) {
        bench_add_row(&job->rows, name, baseline, 1e-3 * bench_median(&cells, 1), 1e-3 * bench_median(&cells, 0),
                      "us/frame", cells.rounds);
    }
    bench_free_cells(&cells);
    return status;
}

static int against_hand(bench_job *job, gpu *g, uint32_t actors)
{
    cast casts[2];
    by_hand hand;
    int status;
    memset(casts, 0, sizeof casts);
    memset(&hand, 0, sizeof hand);
    status = open_cast(&casts[0], g, &job->files[0].pack, actors, 0.0f);
    if (!status) status = open_cast(&casts[1], g, &job->files[0].pack, actors, 0.0f);
    if (!status) status = open_hand(&hand, &casts[1]);
    if (!status) status = check(&casts[0], &hand);
    if (!status) status = measure(job, "cpu", "by-hand", actors, &casts[0], run_by_hand, &hand);
    close_hand(&hand);
    for (int i = 0; i < 2; i++) close_stage(&casts[i]);
    return status < 0 ? 0 : status;
}

static int against_full(bench_job *job, gpu *g, uint32_t actors)
{
    cast casts[2];
    int status;
    memset(casts, 0, sizeof casts);
    status = open_cast(&casts[0], g, &job->files[0].pack, actors, 0.0f);
    if (!status) status = open_cast(&casts[1], g, &job->files[0].pack, actors, 1e-6f);
    if (!status) status = measure(job, "lod", "without-detail", actors, &casts[0], run_stage, &casts[1]);
    for (int i = 0; i < 2; i++) close_stage(&casts[i]);
    return status < 0 ? 0 : status;
}

int bench_has_cast(const noh_pack *pack)
{
    int found = 0;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        noh_pack_mesh_at(pack, i, &mesh, NULL);
        found |= mesh.header->skin != NOH_NONE && mesh.header->level_count > 1u;
    }
    return found && pack->runs[NOH_CHUNK_CLIP].count;
}

int bench_cast(bench_job *job)
{
    static const uint32_t counts[] = { 1u, 20u, ACTORS_MAX };
    const size_t steps = job->quick ? 2u : 3u; /* for tests: few actors */
    gpu g;
    int status;
    if (!bench_has_cast(&job->files[0].pack)) {
        return 0;
    }
    status = gpu_open(&g, "null");
    if (status) {
        return status;
    }
    g.caps.blend_f32 = g.caps.blend_f32_exact = 1; /* or the CPU would accumulate */
    for (size_t i = 0; i < steps && !status; i++) status = against_hand(job, &g, counts[i]);
    if (!status) status = against_full(job, &g, counts[steps - 1u]);
    gpu_close(&g);
    return status;
}
