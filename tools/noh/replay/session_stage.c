/* session_stage.c: the stage of a session, and the hashes of its frames. */
#include <stdlib.h>
#include <string.h>

#include "session.h"
#include "noh/base.h"
#include "noh/body.h"
#include "noh/clip.h"
#include "noh/deform.h"
#include "noh/low_core.h"
#include "noh/modules.h"
#include "noh/noh.h"
#include "noh/pack.h"

#define VERTEX_FRAMES 30u /* frames between two hashes of an actor's vertices */

static const noh_plane floor_plane = { { 0.0f, 1.0f, 0.0f }, 0.0f };
static const noh_world floor_world = { .planes = &floor_plane, .plane_count = 1, .friction = 0.6f };
static const noh_kind_ragdoll ragdoll = { .count = SESSION_ACTORS_MAX, .world = &floor_world };

/* ---- opening ---- */

static void find_face(session_stage *s)
{
    const size_t bytes = noh_kind_find_eyes_size(&s->kind);
    void *scratch = malloc(bytes + NOH_MEMORY_ALIGN);
    s->has_face = scratch && !noh_kind_find_eyes(&s->kind, scratch, bytes, s->face.face.eyes, NULL);
    if (s->has_face) s->kind.face = noh_face_module(&s->face);
    free(scratch);
}

static void fill_desc(session_stage *s, uint32_t actor_count)
{
    s->kind.mesh = s->pack;
    s->kind.actor_count = actor_count;
    s->kind.skeleton = s->pack->runs[NOH_CHUNK_SKELETON].count ? 0u : NOH_NONE;
    s->kind.inertia = s->pack->runs[NOH_CHUNK_SKELETON].count != 0;
    if (s->pack->runs[NOH_CHUNK_SKELETON].count) s->kind.root_axes = NOH_ROOT_GROUND;
    s->kind.graphs = noh_graph_module(s->pack->runs[NOH_CHUNK_GRAPH].count ? "*" : NULL);
    s->kind.springs = noh_springs_module(NULL);
    s->desc.kinds = &s->kind;
    s->desc.kind_count = 1;
    find_face(s);
    s->kind.ragdoll = noh_ragdoll_module(s->pack->runs[NOH_CHUNK_SKELETON].count ? &ragdoll : NULL);
}

/* A skeleton that cannot have a ragdoll goes without. */
static int plan(session_stage *s, noh_error *error)
{
    s->has_ragdoll = s->kind.ragdoll.type != NULL;
    if (!noh_stage_plan_make(&s->desc, NULL, &s->plan, error)) return 0;
    if (!s->has_ragdoll) return 1;
    s->kind.ragdoll = noh_ragdoll_module(NULL);
    return plan(s, error);
}

/* The largest memory that the sums of a mesh of the pack take. */
static size_t sums_of(const noh_pack *pack)
{
    size_t most = 0;
    for (uint32_t i = 0; i < pack->runs[NOH_CHUNK_MESH].count; i++) {
        noh_mesh mesh;
        size_t bytes = 0;
        if (noh_pack_mesh_at(pack, i, &mesh, NULL) == NOH_OK) bytes = noh_morph_layers_size(&mesh);
        most = bytes > most ? bytes : most;
    }
    return most;
}

/* malloc aligns to less than the library needs on some processors. */
static void *aligned(void *block)
{
    return (char *)block + (NOH_MEMORY_ALIGN - (uintptr_t)block % NOH_MEMORY_ALIGN) % NOH_MEMORY_ALIGN;
}

int session_open(session_stage *s, const noh_pack *pack, uint32_t actor_count, noh_error *error)
{
    memset(s, 0, sizeof *s);
    s->pack = pack;
    s->actor_count = actor_count;
    s->ticks = SESSION_FRAME_TICKS;
    s->view[2] = 8.0f;
    fill_desc(s, actor_count);
    if (plan(s, error)) return 1;
    s->sum_bytes = sums_of(pack);
    s->memory = malloc((size_t)s->plan.cpu_bytes + NOH_MEMORY_ALIGN);
    s->sums = malloc(s->sum_bytes + NOH_MEMORY_ALIGN);
    s->matrices = malloc(NOH_SKIN_JOINTS_MAX * 12u * sizeof(float));
    if (!s->memory || !s->sums || !s->matrices) {
        const noh_error none = { NOH_ERR_MEMORY, "out of memory", 0, s->plan.cpu_bytes };
        *error = none;
    } else if (!noh_stage_init(aligned(s->memory), (size_t)s->plan.cpu_bytes, NULL, &s->desc, &s->plan, &s->stage,
                               error)) {
        return 0;
    }
    session_close(s);
    return 1;
}

void session_close(session_stage *s)
{
    if (s->stage) noh_stage_delete(s->stage);
    free(s->memory);
    free(s->sums);
    free(s->matrices);
    memset(s, 0, sizeof *s);
}

/* ---- hashes ---- */

static uint32_t hash_events(const session_stage *s)
{
    uint32_t count, crc = s->returned;
    const noh_stage_event *events = noh_stage_events(s->stage, &count);
    for (uint32_t i = 0; i < count; i++) {
        const noh_stage_event *e = &events[i];
        const uint32_t words[6] = { e->actor.id, e->layer, e->clip, e->name_hash, e->index, e->backward };
        crc = noh_crc32c(crc, words, sizeof words);
        crc = noh_crc32c(crc, &e->clock, sizeof e->clock);
        crc = noh_crc32c(crc, &e->weight, sizeof e->weight);
        crc = noh_crc32c(crc, e->payload, sizeof e->payload);
    }
    return crc;
}

static uint32_t hash_joints(const session_stage *s, noh_actor actor, uint32_t crc)
{
    float matrix[12];
    for (uint32_t j = 0; noh_actor_joint(s->stage, actor, j, matrix, NULL) == NOH_OK; j++) {
        crc = noh_crc32c(crc, matrix, sizeof matrix);
    }
    return crc;
}

static uint32_t hash_vertices(session_stage *s, const noh_actor_mesh *drawn, uint32_t crc)
{
    noh_morph_layers layers;
    noh_vertex vertex;
    noh_mesh mesh;
    if (noh_pack_mesh_at(s->pack, drawn->mesh, &mesh, NULL) ||
        noh_morph_layers_init(aligned(s->sums), s->sum_bytes, &mesh, &layers, NULL)) {
        return ~crc;
    }
    noh_morph_accumulate(&mesh, drawn->weights, &layers);
    for (uint32_t v = 0; v < mesh.header->vertex_count; v++) {
        if (drawn->joint_count)
            noh_skin_vertex(&mesh, s->matrices, &layers, v, &vertex);
        else
            noh_morph_vertex(&mesh, &layers, v, &vertex);
        crc = noh_crc32c(crc, vertex.position, sizeof vertex.position);
        crc = noh_crc32c(crc, vertex.normal, sizeof vertex.normal);
    }
    return crc;
}

static void hash_meshes(session_stage *s, noh_actor actor, int vertices, session_hashes *h)
{
    noh_actor_mesh drawn;
    for (uint32_t m = 0; noh_actor_mesh_at(s->stage, actor, m, &drawn, s->matrices, NULL) == NOH_OK; m++) {
        h->part[SESSION_PALETTES] = noh_crc32c(h->part[SESSION_PALETTES], s->matrices,
                                               12u * sizeof(float) * drawn.joint_count);
        h->part[SESSION_PALETTES] = noh_crc32c(h->part[SESSION_PALETTES], drawn.world, sizeof drawn.world);
        if (vertices) h->part[SESSION_VERTICES] = hash_vertices(s, &drawn, h->part[SESSION_VERTICES]);
    }
}

void session_hash(session_stage *s, uint32_t frame, session_hashes *h)
{
    const uint64_t state = noh_stage_hash(s->stage);
    const uint32_t float_count = s->plan.kinds[0].float_count;
    memset(h, 0, sizeof *h);
    h->part[SESSION_STATE] = noh_crc32c(0, &state, sizeof state);
    h->part[SESSION_EVENTS] = hash_events(s);
    for (uint32_t a = 0; a < s->actor_count; a++) {
        const int turn = frame % VERTEX_FRAMES == 0 && frame / VERTEX_FRAMES % s->actor_count == a;
        const float *floats = noh_actor_floats(s->stage, s->actors[a]);
        noh_place place;
        if (noh_actor_place(s->stage, s->actors[a], &place, NULL)) continue;
        h->part[SESSION_PLACES] = noh_crc32c(h->part[SESSION_PLACES], &place, sizeof place);
        if (floats) h->part[SESSION_FLOATS] = noh_crc32c(h->part[SESSION_FLOATS], floats, sizeof(float) * float_count);
        h->part[SESSION_JOINTS] = hash_joints(s, s->actors[a], h->part[SESSION_JOINTS]);
        hash_meshes(s, s->actors[a], turn, h);
    }
}

/* ---- playing ---- */

int session_step(session_stage *s, noh_error *error)
{
    static const float middle[3] = { 0.0f, 0.8f, 0.0f };
    noh_stage_view view;
    noh_view_orbit(&view, middle, s->view[0], s->view[1], s->view[2], 640, 360);
    return noh_stage_frame(s->stage, s->ticks, &view, NULL, NULL, error) != NOH_OK;
}

void session_give(const session *s, session_stage *stage, uint32_t frame, uint32_t *next)
{
    stage->returned = 0;
    for (; *next < s->input_count && s->inputs[*next].frame == frame; ++*next) {
        session_do(stage, &s->inputs[*next], *next);
    }
}

int session_run(const session *s, session_stage *stage, session_hashes *hashes, noh_error *error)
{
    uint32_t next = 0;
    for (uint32_t f = 0; f < s->frame_count; f++) {
        session_give(s, stage, f, &next);
        if (session_step(stage, error)) return 1;
        session_hash(stage, f, &hashes[f]);
    }
    return 0;
}
